// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/quadric.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::geometry {
namespace {

constexpr std::size_t kCoefficients = 10;  // xx yy zz xy xz yz x y z 1
constexpr double kNormalWeight = 0.1;

using Row = std::array<double, kCoefficients>;
using Matrix = std::array<Row, kCoefficients>;

void addRow(Matrix& sum, const Row& row, double weight) {
  for (std::size_t i = 0; i < kCoefficients; ++i)
    for (std::size_t j = 0; j < kCoefficients; ++j) sum[i][j] += weight * row[i] * row[j];
}

/// Derivatives of the ten terms along axis k.
Row derivative(const dvec3& x, int k) {
  Row row{};
  row[std::size_t(k)] = 2 * x[k];
  const std::array<std::array<int, 2>, 3> mixed{{{0, 1}, {0, 2}, {1, 2}}};
  for (std::size_t m = 0; m < 3; ++m) {
    if (mixed[m][0] == k) row[3 + m] += x[mixed[m][1]];
    if (mixed[m][1] == k) row[3 + m] += x[mixed[m][0]];
  }
  row[6 + std::size_t(k)] = 1;
  return row;
}

Row subtract(const Row& a, double s, const Row& b, double t) {
  Row row;
  for (std::size_t i = 0; i < kCoefficients; ++i) row[i] = a[i] * s - b[i] * t;
  return row;
}

/// Eigenvector of the smallest eigenvalue, by Jacobi rotations.
Row findSmallest(Matrix m) {
  Matrix vectors{};
  for (std::size_t i = 0; i < kCoefficients; ++i) vectors[i][i] = 1;
  for (int sweep = 0; sweep < 40; ++sweep) {
    double off = 0, diagonal = 0;
    for (std::size_t p = 0; p < kCoefficients; ++p) {
      diagonal += m[p][p] * m[p][p];
      for (std::size_t q = p + 1; q < kCoefficients; ++q) off += m[p][q] * m[p][q];
    }
    if (!(off > 1e-40 * diagonal)) break;
    for (std::size_t p = 0; p < kCoefficients; ++p)
      for (std::size_t q = p + 1; q < kCoefficients; ++q) {
        if (m[p][q] == 0) continue;
        const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
        const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (std::size_t k = 0; k < kCoefficients; ++k) {
          const double kp = m[k][p], kq = m[k][q];
          m[k][p] = c * kp - s * kq, m[k][q] = s * kp + c * kq;
        }
        for (std::size_t k = 0; k < kCoefficients; ++k) {
          const double pk = m[p][k], qk = m[q][k];
          m[p][k] = c * pk - s * qk, m[q][k] = s * pk + c * qk;
          const double vp = vectors[k][p], vq = vectors[k][q];
          vectors[k][p] = c * vp - s * vq, vectors[k][q] = s * vp + c * vq;
        }
      }
  }
  std::size_t smallest = 0;
  for (std::size_t i = 1; i < kCoefficients; ++i)
    if (m[i][i] < m[smallest][smallest]) smallest = i;
  Row row;
  for (std::size_t i = 0; i < kCoefficients; ++i) row[i] = vectors[i][smallest];
  return row;
}

Quadric makeQuadric(const Row& f, const dvec3& origin, double scale) {
  Quadric quadric;
  quadric.origin = origin;
  quadric.scale = scale;
  quadric.a = dmat3(f[0], 0.5 * f[3], 0.5 * f[4], 0.5 * f[3], f[1], 0.5 * f[5], 0.5 * f[4], 0.5 * f[5], f[2]);
  quadric.b = {f[6], f[7], f[8]};
  quadric.c = f[9];
  return quadric;
}

/// Step 1.
Quadric solveQuadric(const MeshView& mesh, const dvec3& origin, double scale) {
  Matrix sum{};
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const dvec3 x = (dvec3(mesh.positions[i]) - origin) / scale, n(mesh.normals[i]);
    addRow(sum, {x.x * x.x, x.y * x.y, x.z * x.z, x.x * x.y, x.x * x.z, x.y * x.z, x.x, x.y, x.z, 1}, 1);
    const Row dx = derivative(x, 0), dy = derivative(x, 1), dz = derivative(x, 2);
    addRow(sum, subtract(dy, n.z, dz, n.y), kNormalWeight);
    addRow(sum, subtract(dz, n.x, dx, n.z), kNormalWeight);
    addRow(sum, subtract(dx, n.y, dy, n.x), kNormalWeight);
  }
  return makeQuadric(findSmallest(sum), origin, scale);
}

}  // namespace

std::optional<QuadricFit> fitQuadric(const MeshView& mesh) {
  if (mesh.positions.size() < kCoefficients) return std::nullopt;
  dvec3 origin(0);
  for (const vec3& p : mesh.positions) origin += dvec3(p) / double(mesh.positions.size());
  double square = 0;
  for (const vec3& p : mesh.positions) {
    const dvec3 d = dvec3(p) - origin;
    square += glm::dot(d, d) / double(mesh.positions.size());
  }
  if (!(square > 0)) return std::nullopt;
  QuadricFit fit{solveQuadric(mesh, origin, std::sqrt(square)), {}};
  // 2
  double along = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    along += glm::dot(dvec3(mesh.normals[i]), fit.quadric.gradient(dvec3(mesh.positions[i])));
  if (along < 0) fit.quadric = fit.quadric.flipped();
  // 3
  const auto deviation = measureDeviation(fit.quadric, mesh);
  if (!deviation) return std::nullopt;
  fit.deviation = *deviation;
  return fit;
}

}  // namespace catoptric::geometry

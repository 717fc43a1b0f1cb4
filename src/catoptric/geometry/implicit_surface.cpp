// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/implicit_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catoptric::geometry {
namespace {

constexpr std::size_t kMostPoints = 400;
constexpr int kMostSteps = 40;
constexpr double kDifference = 1e-6;  // of a parameter
constexpr double kRounding = 6e-8;    // of a coordinate

using Vector = std::vector<double>;

/// Step 1.
Vector computeResiduals(const SurfaceFamily& family, const Vector& parameters,
                        std::span<const dvec3> points) {
  const auto surface = family(parameters);
  Vector residuals;
  residuals.reserve(points.size());
  for (const dvec3& p : points) {
    const auto [value, gradient] = surface->sampleAt(p);
    residuals.push_back(value / std::max(glm::length(gradient), 1e-300));
  }
  return residuals;
}

double sumSquares(const Vector& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return sum;
}

/// a x = b by Cholesky, a symmetric and positive (row by row, n x n); false where it is not.
bool solveInPlace(Vector a, Vector& b) {
  const std::size_t n = b.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
      if (i == j && !(sum > 0)) return false;
      a[i * n + j] = i == j ? std::sqrt(sum) : sum / a[j * n + j];
    }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= a[i * n + k] * b[k];
    b[i] /= a[i * n + i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) b[i] -= a[k * n + i] * b[k];
    b[i] /= a[i * n + i];
  }
  return true;
}

/// The normal equations of a step: JtJ (row by row) and Jt r.
struct NormalEquations {
  Vector matrix, right;
};

NormalEquations differentiate(const SurfaceFamily& family, const Vector& at, const Vector& residuals,
                              std::span<const dvec3> points) {
  const std::size_t n = at.size(), count = points.size();
  Vector jacobian(n * count);  // by columns
  for (std::size_t k = 0; k < n; ++k) {
    Vector moved = at;
    moved[k] += kDifference;
    const Vector there = computeResiduals(family, moved, points);
    for (std::size_t i = 0; i < count; ++i) jacobian[k * count + i] = (there[i] - residuals[i]) / kDifference;
  }
  NormalEquations equations{Vector(n * n), Vector(n)};
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t m = 0; m < n; ++m)
      for (std::size_t i = 0; i < count; ++i)
        equations.matrix[k * n + m] += jacobian[k * count + i] * jacobian[m * count + i];
    for (std::size_t i = 0; i < count; ++i) equations.right[k] -= jacobian[k * count + i] * residuals[i];
  }
  return equations;
}

/// What rounding of the coordinates leaves of `points.size()` residuals, squared and added.
double sumRounding(std::span<const dvec3> points) {
  double largest = 0;
  for (const dvec3& p : points) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return double(points.size()) * kRounding * kRounding * largest * largest;
}

std::vector<dvec3> spread(std::span<const vec3> points) {
  const std::size_t count = std::min(points.size(), kMostPoints);
  std::vector<dvec3> chosen(count);
  for (std::size_t i = 0; i < count; ++i) chosen[i] = dvec3(points[i * points.size() / count]);
  return chosen;
}

}  // namespace

dvec3 ImplicitSurface::project(dvec3 p, double close) const {
  for (int i = 0; i < 4; ++i) {
    const auto [f, g] = sampleAt(p);
    const double square = std::max(glm::dot(g, g), 1e-300);
    p -= g * (f / square);
    if (f * f <= close * close * square) break;
  }
  return p;
}

std::optional<FitDeviation> measureDeviation(const ImplicitSurface& surface, const MeshView& mesh) {
  FitDeviation deviation;
  double largest = 0, smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const auto [value, g] = surface.sampleAt(dvec3(mesh.positions[i]));
    const dvec3 n(mesh.normals[i]);
    const double length = glm::length(g);
    largest = std::max(largest, length);
    smallest = std::min(smallest, length);
    if (!(length > 0)) return std::nullopt;
    deviation.distance = std::max(deviation.distance, std::abs(value) / length);
    deviation.angleRadians =
        std::max(deviation.angleRadians, std::atan2(glm::length(glm::cross(n, g)), glm::dot(n, g)));
  }
  if (!(smallest > 1e-9 * largest)) return std::nullopt;
  return deviation;
}

std::optional<PolishedSurface> polishSurface(const SurfaceFamily& family, std::vector<double> start,
                                             std::span<const vec3> points) {
  const std::vector<dvec3> chosen = spread(points);
  Vector at = std::move(start), residuals = computeResiduals(family, at, chosen);
  double sum = sumSquares(residuals);
  if (!(sum < 1e300) || chosen.empty()) return std::nullopt;
  const double rounding = sumRounding(chosen);
  double damping = 1e-4, gain = 1;
  for (int step = 0; step < kMostSteps && gain > 1e-4 && sum > rounding; ++step) {
    const NormalEquations equations = differentiate(family, at, residuals, chosen);
    gain = 0;
    for (; damping < 1e8 && gain == 0; damping *= gain > 0 ? 0.1 : 10) {
      Vector damped = equations.matrix, next = equations.right;
      for (std::size_t k = 0; k < at.size(); ++k)
        damped[k * at.size() + k] += damping * (damped[k * at.size() + k] + 1e-12 * double(chosen.size()));
      if (!solveInPlace(std::move(damped), next)) continue;
      for (std::size_t k = 0; k < at.size(); ++k) next[k] += at[k];
      Vector there = computeResiduals(family, next, chosen);
      const double nextSum = sumSquares(there);
      if (!(nextSum < sum)) continue;
      gain = 1 - nextSum / sum;
      at = std::move(next), residuals = std::move(there), sum = nextSum;
    }
    damping = std::max(damping, 1e-12);
  }
  return PolishedSurface{std::move(at), sum / double(chosen.size()), sum <= rounding};
}

}  // namespace catoptric::geometry

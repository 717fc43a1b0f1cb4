// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/bezier_patch.h"

#include <algorithm>
#include <cmath>

namespace catoptric::geometry {
namespace {

std::array<double, 4> bernstein(double t) {
  const double s = 1 - t;
  return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}

std::array<double, 4> bernsteinDerivative(double t) {
  const double s = 1 - t;
  return {-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t};
}

dvec3 combine(const BicubicPatch& patch, const std::array<double, 4>& weightsU,
              const std::array<double, 4>& weightsV) {
  dvec3 sum(0);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) sum += weightsV[i] * weightsU[j] * patch.control[4 * i + j];
  return sum;
}

dvec3 crossOfDerivatives(const BicubicPatch& patch, double u, double v) {
  return glm::cross(combine(patch, bernsteinDerivative(u), bernstein(v)),
                    combine(patch, bernstein(u), bernsteinDerivative(v)));
}

double controlExtent(const BicubicPatch& patch) {
  core::Box box;
  for (const dvec3& p : patch.control) box.add(p);
  return 2 * box.radius();
}

/// dS/du x dS/dv is a polynomial in (u, v). Where it vanishes, its direction a little way inside the patch
/// differs from the limit by O(step); combining two steps (Richardson) cancels the first order.
dvec3 limitNormal(const BicubicPatch& patch, double u, double v) {
  const auto inside = [&](double step) {
    const double du = u < 0.5 ? step : -step, dv = v < 0.5 ? step : -step;
    const bool uAtEdge = u < 1e-9 || u > 1 - 1e-9, vAtEdge = v < 1e-9 || v > 1 - 1e-9;
    // At a corner step along both; on an edge only away from it.
    return glm::normalize(
        crossOfDerivatives(patch, u + (uAtEdge || !vAtEdge ? du : 0), v + (vAtEdge || !uAtEdge ? dv : 0)));
  };
  constexpr double kStep = 1e-4;
  return glm::normalize(2.0 * inside(kStep) - inside(2 * kStep));
}

}  // namespace

PatchPoint evaluatePatch(const BicubicPatch& patch, double u, double v) {
  const dvec3 cross = crossOfDerivatives(patch, u, v);
  const double extent = controlExtent(patch), length = glm::length(cross);
  const bool isRegular = length > 1e-8 * extent * extent;
  return {combine(patch, bernstein(u), bernstein(v)), isRegular ? cross / length : limitNormal(patch, u, v)};
}

Mesh tessellatePatch(const BicubicPatch& patch, int cellsU, int cellsV, bool turnedOver) {
  Mesh mesh;
  for (int row = 0; row <= cellsV; ++row)
    for (int column = 0; column <= cellsU; ++column) {
      const double u = double(column) / cellsU, v = double(row) / cellsV;
      const PatchPoint point = evaluatePatch(patch, u, v);
      mesh.positions.push_back(vec3(point.position));
      mesh.normals.push_back(vec3(turnedOver ? -point.normal : point.normal));
      mesh.uv.push_back(vec2(u, v));
    }
  const double tiny = 1e-7 * controlExtent(patch);
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const auto isSame = [&](std::uint32_t i, std::uint32_t j) {
      return glm::distance(dvec3(mesh.positions[i]), dvec3(mesh.positions[j])) <= tiny;
    };
    if (isSame(a, b) || isSame(b, c) || isSame(c, a)) return;
    if (turnedOver) std::swap(b, c);
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
  };
  for (int row = 0; row < cellsV; ++row)
    for (int column = 0; column < cellsU; ++column) {
      const auto a = std::uint32_t(row * (cellsU + 1) + column), below = a + std::uint32_t(cellsU) + 1;
      add(a, a + 1, below + 1);
      add(a, below + 1, below);
    }
  return mesh;
}

BicubicPatch makeTranslationalPatch(const std::array<dvec3, 4>& alongU, const std::array<dvec3, 4>& alongV) {
  BicubicPatch patch;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) patch.control[4 * i + j] = alongU[j] + alongV[i];
  return patch;
}

}  // namespace catoptric::geometry

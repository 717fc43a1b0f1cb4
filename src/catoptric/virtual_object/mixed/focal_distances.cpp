// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/mixed/focal_distances.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catoptric::virtual_object {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

double determinant(const dvec3& a, const dvec3& b, const dvec3& c) {
  return glm::dot(a, glm::cross(b, c));
}

}  // namespace

dvec3 reflectAt(const MirrorTriangle& t, double u, double v, const dvec3& eye) {
  return core::reflectDirection(glm::normalize(t.position(u, v) - eye), glm::normalize(t.normal(u, v)));
}

Pencil findPencil(const MirrorTriangle& t, const dvec3& eye, double u, double v) {
  const dvec3 r0 = reflectAt(t, 0, 0, eye), d1 = reflectAt(t, 1, 0, eye) - r0,
              d2 = reflectAt(t, 0, 1, eye) - r0;
  const dvec3 r = r0 + u * d1 + v * d2;
  return {determinant(t.edge1, t.edge2, r), determinant(d1, t.edge2, r) + determinant(t.edge1, d2, r),
          determinant(d1, d2, r)};
}

std::array<double, 2> findFocalDistances(const MirrorTriangle& t, const dvec3& eye, double u, double v) {
  const auto [c0, c1, c2] = findPencil(t, eye, u, v);
  std::array<double, 2> roots{kInfinite, kInfinite};
  const double discriminant = c1 * c1 - 4.0 * c0 * c2;
  if (discriminant < 0) return roots;
  // Without cancellation: q / c2 and c0 / q; the first is infinite where the quadratic is a line.
  const double q = -0.5 * (c1 + std::copysign(std::sqrt(discriminant), c1));
  for (const double root : {q / c2, c0 / q})
    if (root > 0 && std::isfinite(root)) (roots[0] == kInfinite ? roots[0] : roots[1]) = root;
  std::sort(roots.begin(), roots.end());
  return roots;
}

dvec2 predictPlace(const MirrorTriangle& t, const dvec3& eye, const dvec3& point) {
  const dvec3 r0 = reflectAt(t, 0, 0, eye), r = reflectAt(t, 1.0 / 3, 1.0 / 3, eye);
  const dvec3 away = point - t.position(1.0 / 3, 1.0 / 3);
  const double distance = glm::dot(away, r);
  const dvec3 a = t.edge1 + distance * (reflectAt(t, 1, 0, eye) - r0),
              b = t.edge2 + distance * (reflectAt(t, 0, 1, eye) - r0), beside = away - distance * r;
  const double aa = glm::dot(a, a), ab = glm::dot(a, b), bb = glm::dot(b, b), ad = glm::dot(a, beside),
               bd = glm::dot(b, beside), determinant = aa * bb - ab * ab;
  return dvec2((bb * ad - ab * bd) / determinant, (aa * bd - ab * ad) / determinant) + 1.0 / 3;
}

std::size_t findInterval(const MirrorTriangle& t, const dvec3& eye, double u, double v, double distance) {
  const std::array<double, 2> focal = findFocalDistances(t, eye, u, v);
  return (focal[0] < distance ? 1u : 0u) + (focal[1] < distance ? 1u : 0u);
}

}  // namespace catoptric::virtual_object

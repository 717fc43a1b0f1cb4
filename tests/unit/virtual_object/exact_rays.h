// SPDX-License-Identifier: Apache-2.0
// Mirrors' rays and triangles by chance for the tests of solver `exact`, and a ray against a triangle in
// double.
#pragma once

#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <span>
#include <vector>

#include "catoptric/geometry/triangle_hierarchy.h"
#include "catoptric/virtual_object/exact/tile_cover.h"

namespace catoptric::virtual_object {

inline constexpr int kEdge = 48;
inline constexpr std::uint32_t kWord = 7;

/// Distance along the ray, by the same signs as the shader but in double; infinity for a miss.
inline double meet(const vec4& origin, const vec4& direction, const HierarchyTriangle& t) {
  const dvec3 o(vec3{origin}), d(vec3{direction});
  const dvec3 a = dvec3(t.a) - o, b = dvec3(t.b) - o, c = dvec3(t.c) - o;
  const double x = glm::dot(d, glm::cross(b, c)), y = glm::dot(d, glm::cross(c, a)),
               z = glm::dot(d, glm::cross(a, b));
  const dvec3 n = glm::cross(b - a, c - a);
  const double across = glm::dot(d, n);
  const bool inside = (x <= 0 && y <= 0 && z <= 0) || (x >= 0 && y >= 0 && z >= 0);
  const bool turnedAway = across > 0 && (t.flags & kCoverSingleSided) != 0;
  const double distance = glm::dot(a, n) / across;
  return inside && across != 0 && !turnedAway && distance > 1e-5 ? distance
                                                                 : std::numeric_limits<double>::infinity();
}

/// Rays off a patch z = f(x, y) lit from above; `bend` > 0: concave, with a focus; < 0: convex; `twist`:
/// saddle.
inline RayImages makeRays(double bend, double twist, double shift = 0.0) {
  RayImages rays;
  rays.widthPx = rays.heightPx = kEdge;
  const dvec3 eye(0.3, 0.1, 3.0);
  for (int y = 0; y < kEdge; ++y)
    for (int x = 0; x < kEdge; ++x) {
      const double u = 2.0 * (x + 0.5) / kEdge - 1.0, v = 2.0 * (y + 0.5) / kEdge - 1.0;
      const dvec3 p(u, v, 0.5 * bend * (u * u + v * v) + 0.5 * twist * (u * u - v * v));
      const dvec3 n = glm::normalize(dvec3(-(bend + twist) * u, -(bend - twist) * v, 1.0));
      const dvec3 d = glm::normalize(core::reflectDirection(glm::normalize(p - eye), n) + dvec3(shift, 0, 0));
      rays.origins.emplace_back(vec3(p), 1.0f);
      rays.directions.emplace_back(vec3(glm::normalize(d)), 0.0f);
      const bool isMirror = u * u + v * v < 0.95;  // a round edge: tiles that are half empty
      rays.words.emplace_back(0u, isMirror ? kWord : 0u);
    }
  return rays;
}

inline std::vector<HierarchyTriangle> makeTriangles(std::uint32_t count, double size, std::mt19937& random) {
  std::uniform_real_distribution<double> place(-4.0, 4.0), offset(-size, size);
  std::vector<HierarchyTriangle> triangles;
  for (std::uint32_t i = 0; i < count; ++i) {
    const dvec3 centre(place(random), place(random), 2.5 + 0.6 * place(random));
    const auto corner = [&] { return vec3(centre + dvec3(offset(random), offset(random), offset(random))); };
    triangles.push_back({corner(), corner(), corner(), i, i % 5, i % 3 == 0 ? kCoverSingleSided : 0u});
  }
  return triangles;
}

/// By pixel, the items of the rectangles that cover it.
inline std::vector<std::set<std::uint32_t>> findOffered(const RayImages& rays,
                                                        std::span<const CoverRect> rects) {
  std::vector<std::set<std::uint32_t>> offered(rays.origins.size());
  for (const CoverRect& r : rects)
    for (int y = r.y; y < r.y + r.height; ++y)
      for (int x = r.x; x < r.x + r.width; ++x)
        offered[std::size_t(y) * std::size_t(rays.widthPx) + std::size_t(x)].insert(r.item);
  return offered;
}

inline CoverQuery wholePicture() {
  CoverQuery query;
  query.width = query.height = kEdge;
  query.word = kWord;
  query.reach = 30.0;
  return query;
}

struct Mirror {
  const char* name;
  double bend, twist;
};

inline constexpr Mirror kMirrors[] = {{"convex", -0.6, 0.0},
                                      {"concave", 0.7, 0.0},
                                      {"saddle", 0.0, 0.6},
                                      {"flat", 0.0, 0.0},
                                      {"wild", -1.5, 1.0}};

}  // namespace catoptric::virtual_object

// SPDX-License-Identifier: Apache-2.0
// Steps: 1 edges that only one triangle has, 2 strung together to one ring, 3 corners on straight edges left
// out, 4 convex or nothing.
#include "catoptric/planar_mirror/mirror_outline.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

namespace catoptric::planar_mirror {
namespace {

using Corner = std::tuple<float, float, float>;  // vertices at one place are one corner

Corner cornerOf(const vec3& p) {
  return {p.x, p.y, p.z};
}

dvec3 pointOf(const Corner& c) {
  return {std::get<0>(c), std::get<1>(c), std::get<2>(c)};
}

/// The one ring of all the edges, empty if there are several or none.
std::vector<dvec3> findRing(const std::set<std::pair<Corner, Corner>>& edges) {
  std::map<Corner, Corner> next;
  for (const auto& [from, to] : edges)
    if (!edges.contains({to, from}) && !next.emplace(from, to).second) return {};
  std::vector<dvec3> ring;
  if (next.empty()) return ring;
  Corner at = next.begin()->first;
  do {
    ring.push_back(pointOf(at));
    const auto found = next.find(at);
    if (found == next.end() || ring.size() > next.size()) return {};
    at = found->second;
  } while (at != next.begin()->first);
  return ring.size() == next.size() ? ring : std::vector<dvec3>();
}

/// At corner `i`, twice the area of the triangle with its neighbours, along the normal.
double turnAt(const std::vector<dvec3>& ring, std::size_t i, const dvec3& normal) {
  const std::size_t n = ring.size();
  return glm::dot(glm::cross(ring[i] - ring[(i + n - 1) % n], ring[(i + 1) % n] - ring[i]), normal);
}

}  // namespace

std::vector<dvec3> findConvexOutline(const scene::WorldGeometry& world, std::uint32_t reflector,
                                     std::size_t mostCorners) {
  // 1
  const scene::Part& part = world.parts[world.reflectors[reflector].part];
  std::set<std::pair<Corner, Corner>> edges;
  for (std::uint32_t i = part.firstIndex; i < part.firstIndex + part.indexCount; i += 3)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Corner from = cornerOf(world.positions[world.indices[i + k]]);
      const Corner to = cornerOf(world.positions[world.indices[i + (k + 1) % 3]]);
      if (from != to && !edges.emplace(from, to).second) return {};  // triangles upon each other
    }
  // 2
  std::vector<dvec3> ring = findRing(edges);
  // 3
  dvec3 normal(0);
  for (std::size_t i = 1; i + 1 < ring.size(); ++i)
    normal += glm::cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
  const double area = glm::length(normal);
  if (area == 0.0) return {};
  normal /= area;
  for (std::size_t i = 0; i < ring.size() && ring.size() > 3;)
    if (std::abs(turnAt(ring, i, normal)) <= 1e-7 * area)
      ring.erase(ring.begin() + std::ptrdiff_t(i));
    else
      ++i;
  // 4
  if (ring.size() > mostCorners) return {};
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (turnAt(ring, i, normal) <= 0.0) return {};
  return ring;
}

std::vector<vec4> makeEdgePlanes(std::span<const dvec3> outline, const raster::PinholeView& view) {
  dvec3 middle(0);
  for (const dvec3& corner : outline) middle += corner / double(outline.size());
  const dvec3 inward = glm::normalize(middle - view.eye);
  // A pixel is seen under the largest angle where the ray through it is shortest.
  const dvec3 axis = glm::normalize(glm::cross(view.rayDx, view.rayDy));
  const double pixel = glm::length(view.rayDx) / std::abs(glm::dot(axis, view.rayOrigin));
  std::vector<vec4> planes;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const dvec3 edge = glm::cross(outline[i] - view.eye, outline[(i + 1) % outline.size()] - view.eye);
    if (glm::length(edge) == 0.0) continue;
    dvec3 normal = glm::normalize(edge);
    if (glm::dot(normal, inward) < 0.0) normal = -normal;
    normal += pixel * inward;
    planes.emplace_back(vec3(normal), float(-glm::dot(normal, view.eye)));
  }
  return planes;
}

bool coverOtherMirror(std::span<const vec4> edgePlanes, const raster::PinholeView& view,
                      const raster::Chain& chain, std::span<const uvec2> parentIds, int widthPx) {
  const gl::Scissor& bounds = chain.bounds;
  for (int y = bounds.y; y < bounds.y + bounds.height; ++y)
    for (int x = bounds.x; x < bounds.x + bounds.width; ++x) {
      const std::uint32_t word = parentIds[std::size_t(y) * std::size_t(widthPx) + std::size_t(x)].y;
      if ((word & 0xffffu) == 0 || word == chain.parentWord()) continue;
      const dvec3 ray = view.rayOrigin + (x + 0.5) * view.rayDx + (y + 0.5) * view.rayDy;
      if (std::all_of(edgePlanes.begin(), edgePlanes.end(),
                      [&](const vec4& plane) { return glm::dot(dvec3(vec3(plane)), ray) >= 0.0; }))
        return true;
    }
  return false;
}

}  // namespace catoptric::planar_mirror

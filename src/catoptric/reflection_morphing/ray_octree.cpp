// SPDX-License-Identifier: Apache-2.0
// Which rays of a trace pass near a point?
//
// In: the ray map of a trace, a box around the scene (world). Out: an octree whose leaves list rays.
//   1. Every fourth ray of the map in each direction, in Morton order.
//   2. From the root down: a node with more than one ray is split (rays of one trace are in conflict) until
//      the last level; a child gets the rays that pass through its box.
//   3. A child that no ray passes through gets the ray of its parent that passes nearest to its centre. So
//      every point finds a ray, also one in the mirror's shadow or between two rays far out.
//   4. A leaf at the last level keeps at most mostLeafRays, every k-th in Morton order.
//
// Departures from 2004: rays are found from the top down and not inserted one by one, with the same tree as
// result; there is an octree for each trace; the rays are a sixteenth of the map's, since find_ray.cpp goes
// on from the one found; rays are not cut off at the next mirror, whose own depth hides what lies behind it,
// only at static objects where these are kept.
// Cost: 20 ms for 4,000 rays and depth 5. Source: Martin & Popescu 2004, section 4.2.
#include "catoptric/reflection_morphing/ray_octree.h"

#include <algorithm>
#include <limits>

namespace catoptric::reflection_morphing {
namespace {

constexpr int kStride = 4;  // of the map's rays that the octree holds

std::uint32_t spreadBits(std::uint32_t x) {
  x = (x | (x << 8)) & 0x00ff00ffu;
  x = (x | (x << 4)) & 0x0f0f0f0fu;
  x = (x | (x << 2)) & 0x33333333u;
  return (x | (x << 1)) & 0x55555555u;
}

/// Step 1.
std::vector<std::uint32_t> pickRays(const RayMap& map) {
  const auto pick = [&](int stride) {
    std::vector<std::uint32_t> rays;
    for (int y = 0; y < map.size - 1; y += stride)
      for (int x = 0; x < map.size - 1; x += stride)
        if (map.states[map.at(x, y)] == TexelState::Ray && map.isCell(x, y))
          rays.push_back(std::uint32_t(map.at(x, y)));
    return rays;
  };
  std::vector<std::uint32_t> rays = pick(kStride);
  if (rays.empty()) rays = pick(1);  // a sliver
  const auto size = std::uint32_t(map.size);
  std::sort(rays.begin(), rays.end(), [&](std::uint32_t a, std::uint32_t b) {
    return (spreadBits(a % size) | (spreadBits(a / size) << 1)) <
           (spreadBits(b % size) | (spreadBits(b / size) << 1));
  });
  return rays;
}

float squaredDistance(const OctreeRay& ray, const vec3& point) {
  const vec3 e = point - ray.origin;
  const float along = std::max(glm::dot(e, ray.direction), 0.0f);
  const vec3 across = e - along * ray.direction;
  return glm::dot(across, across);
}

bool passesThrough(const OctreeRay& ray, float length, const vec3& lower, const vec3& upper) {
  float least = 0, most = length;
  for (int axis = 0; axis < 3; ++axis) {
    const float inverse = 1 / ray.direction[axis];
    float a = (lower[axis] - ray.origin[axis]) * inverse, b = (upper[axis] - ray.origin[axis]) * inverse;
    if (a > b) std::swap(a, b);
    if (a > least) least = a;
    if (b < most) most = b;
  }
  return least <= most;
}

std::uint32_t findNearest(const RayOctree& octree, std::span<const std::uint32_t> rays, const vec3& point) {
  std::uint32_t nearest = rays[0];
  if (rays.size() == 1) return nearest;
  float least = std::numeric_limits<float>::infinity();
  for (const std::uint32_t ray : rays) {
    const float distance = squaredDistance(octree.rays[ray], point);
    if (distance < least) least = distance, nearest = ray;
  }
  return nearest;
}

class Builder {
 public:
  Builder(std::vector<float> lengths, const RayOctreeOptions& options, RayOctree& octree)
      : lengths_(std::move(lengths)), options_(options), octree_(octree) {}

  /// Steps 2 to 4 for a node and what is below it; `rays` is not empty.
  void build(std::uint32_t node, const std::vector<std::uint32_t>& rays, const vec3& lower, const vec3& upper,
             int depth) {
    if (rays.size() <= 1 || depth == options_.depth) {
      makeLeaf(node, rays);
      return;
    }
    const auto children = std::uint32_t(octree_.nodes.size());
    octree_.nodes.resize(octree_.nodes.size() + 8);
    octree_.nodes[node] = {children, 0};
    const vec3 half = 0.5f * (upper - lower);
    std::vector<std::uint32_t> passing;
    for (std::uint32_t c = 0; c < 8; ++c) {
      const vec3 low = lower + half * vec3(c & 1, (c >> 1) & 1, c >> 2), high = low + half;
      passing.clear();
      for (const std::uint32_t ray : rays)
        if (passesThrough(octree_.rays[ray], lengthOf(ray), low, high)) passing.push_back(ray);
      if (passing.empty()) passing.push_back(findNearest(octree_, rays, 0.5f * (low + high)));
      build(children + c, passing, low, high, depth + 1);
    }
  }

 private:
  [[nodiscard]] float lengthOf(std::uint32_t ray) const {
    return lengths_.empty() ? std::numeric_limits<float>::infinity() : lengths_[ray];
  }
  void makeLeaf(std::uint32_t node, const std::vector<std::uint32_t>& rays) {
    const auto most = std::size_t(options_.mostLeafRays);
    const std::size_t count = std::min(rays.size(), most);
    octree_.nodes[node] = {std::uint32_t(octree_.leafRays.size()), std::uint32_t(count)};
    for (std::size_t i = 0; i < count; ++i) octree_.leafRays.push_back(rays[i * rays.size() / count]);
  }

  std::vector<float> lengths_;  ///< by ray; empty: they do not end
  const RayOctreeOptions& options_;
  RayOctree& octree_;
};

}  // namespace

OctreeRay makeOctreeRay(const RayMap& map, std::uint32_t texel) {
  const auto size = std::uint32_t(map.size);
  const RayTexel& ray = map.texels[texel];
  const std::uint32_t row = texel / size;
  return {ray.origin, float(texel - row * size), ray.direction, float(row)};
}

RayOctree makeRayOctree(const RayMap& map, const RayOctreeOptions& options) {
  RayOctree octree;
  octree.lower = vec3(options.box.lower);
  octree.upper = vec3(options.box.upper);
  std::vector<std::uint32_t> rays;
  std::vector<float> lengths;
  for (const std::uint32_t texel : pickRays(map)) {
    rays.push_back(std::uint32_t(octree.rays.size()));
    octree.rays.push_back(makeOctreeRay(map, texel));
    if (!map.lengths.empty()) lengths.push_back(map.lengths[texel]);
  }
  if (rays.empty()) return octree;
  octree.nodes.resize(1);
  Builder(std::move(lengths), options, octree).build(0, rays, octree.lower, octree.upper, 0);
  return octree;
}

RayOctreeStatistics measure(const RayOctree& octree) {
  RayOctreeStatistics statistics;
  for (const RayOctree::Node& node : octree.nodes) {
    if (node.count == 0) continue;
    ++statistics.leaves;
    statistics.rays += node.count;
    statistics.mostRays = std::max(statistics.mostRays, std::size_t(node.count));
  }
  return statistics;
}

std::span<const std::uint32_t> RayOctree::findLeaf(const vec3& point) const {
  vec3 low = lower, half = 0.5f * (upper - lower);
  std::uint32_t node = 0;
  while (nodes[node].count == 0) {
    std::uint32_t child = nodes[node].first;
    for (int axis = 0; axis < 3; ++axis)
      if (point[axis] >= low[axis] + half[axis]) {
        child += 1u << axis;
        low[axis] += half[axis];
      }
    half *= 0.5f;
    node = child;
  }
  return std::span(leafRays).subspan(nodes[node].first, nodes[node].count);
}

const OctreeRay& findNearestRay(const RayOctree& octree, std::span<const std::uint32_t> leaf,
                                const vec3& point) {
  return octree.rays[findNearest(octree, leaf, point)];
}

}  // namespace catoptric::reflection_morphing

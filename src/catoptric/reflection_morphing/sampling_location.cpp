// SPDX-License-Identifier: Apache-2.0
// A location as bytes: which texels are rays (a bit each), their numbers as 16-bit fractions of the range
// they take in the map, the octree with 32 bits a node. 6 bytes a ray after one mirror, 14 after several. The
// rounding is worth 1/65536 of the mirror's size: under a hundredth of a pixel.
#include "catoptric/reflection_morphing/sampling_location.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "catoptric/reflection_morphing/byte_stream.h"

namespace catoptric::reflection_morphing {
namespace {

constexpr std::uint32_t kMostTraces = 4096, kMostMirrors = 64;
constexpr int kLargestMap = 4096;
constexpr std::uint32_t kCountBits = 5;  // of a node; the rest is its first child or ray

struct Range {
  float lower = 0, upper = 0;
};

std::uint16_t toFraction(float value, const Range& range) {
  if (!(range.upper > range.lower)) return 0;
  return std::uint16_t(
      std::lround(65535.0f * std::clamp((value - range.lower) / (range.upper - range.lower), 0.0f, 1.0f)));
}

float fromFraction(std::uint16_t fraction, const Range& range) {
  return range.lower + (range.upper - range.lower) * (float(fraction) / 65535.0f);
}

vec2 toOctahedral(const vec3& d) {
  const vec2 p = vec2(d) / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
  if (d.z >= 0) return p;
  return {(1 - std::abs(p.y)) * (p.x < 0 ? -1.0f : 1.0f), (1 - std::abs(p.x)) * (p.y < 0 ? -1.0f : 1.0f)};
}

vec3 fromOctahedral(const vec2& p) {
  vec3 d(p, 1 - std::abs(p.x) - std::abs(p.y));
  if (d.z < 0) {
    const vec2 folded((1 - std::abs(p.y)) * (p.x < 0 ? -1.0f : 1.0f),
                      (1 - std::abs(p.x)) * (p.y < 0 ? -1.0f : 1.0f));
    d = vec3(folded, d.z);
  }
  return glm::normalize(d);
}

constexpr Range kOctahedral{-1, 1};

/// The numbers that are stored for a ray: direction (2), distance, and after several mirrors origin (3) and
/// what lies between.
using Numbers = std::array<float, 7>;

std::size_t countNumbers(const Trace& trace) {
  return trace.size() > 1 ? 7 : 3;
}

Numbers toNumbers(const RayTexel& texel) {
  const vec2 o = toOctahedral(texel.direction);
  return {o.x, o.y, texel.distance, texel.origin.x, texel.origin.y, texel.origin.z, texel.between};
}

void packMap(const RayMap& map, ByteWriter& out) {
  std::vector<std::uint8_t> bits((map.states.size() + 7) / 8);
  std::array<Range, 7> ranges;
  ranges.fill({1e30f, -1e30f});
  for (std::size_t i = 0; i < map.states.size(); ++i) {
    if (map.states[i] != TexelState::Ray) continue;
    bits[i / 8] = std::uint8_t(bits[i / 8] | (1u << (i % 8)));
    const Numbers numbers = toNumbers(map.texels[i]);
    for (std::size_t n = 0; n < numbers.size(); ++n)
      ranges[n] = {std::min(ranges[n].lower, numbers[n]), std::max(ranges[n].upper, numbers[n])};
  }
  ranges[0] = ranges[1] = kOctahedral;
  out.put(std::uint32_t(map.trace.size()));
  out.putAll(std::span<const std::uint32_t>(map.trace));
  for (const vec3& v : {map.location, map.chart.right, map.chart.up, map.chart.axis}) out.put(v);
  out.put(map.lower);
  out.put(map.step);
  out.put(std::uint32_t(map.size));
  out.putAll(std::span<const std::uint8_t>(bits));
  const std::size_t count = countNumbers(map.trace);
  out.putAll(std::span<const Range>(ranges.data(), count));
  std::vector<std::uint16_t> fractions;
  for (std::size_t i = 0; i < map.states.size(); ++i) {
    if (map.states[i] != TexelState::Ray) continue;
    const Numbers numbers = toNumbers(map.texels[i]);
    for (std::size_t n = 0; n < count; ++n) fractions.push_back(toFraction(numbers[n], ranges[n]));
  }
  out.putAll(std::span<const std::uint16_t>(fractions));
}

template <class Vector>
Vector getFinite(ByteReader& in) {
  const auto value = in.get<Vector>();
  for (int i = 0; i < Vector::length(); ++i)
    if (!(std::abs(value[i]) < 1e18f)) refuseDamaged("a number is not finite");
  return value;
}

RayTexel fromNumbers(const RayMap& map, const vec2& p, const Numbers& n, std::size_t count) {
  RayTexel texel;
  texel.direction = fromOctahedral({n[0], n[1]});
  texel.distance = n[2];
  texel.origin = count > 3 ? vec3(n[3], n[4], n[5]) : map.location + n[2] * map.chart.directionAt(p);
  texel.between = count > 3 ? n[6] : 0;
  return texel;
}

RayMap unpackMap(ByteReader& in) {
  RayMap map;
  const auto mirrors = in.get<std::uint32_t>();
  if (mirrors == 0 || mirrors > kMostMirrors) refuseDamaged("a trace has no length or too much");
  map.trace = in.getAll<std::uint32_t>(mirrors);
  for (vec3* v : {&map.location, &map.chart.right, &map.chart.up, &map.chart.axis}) *v = getFinite<vec3>(in);
  map.lower = getFinite<vec2>(in);
  map.step = getFinite<vec2>(in);
  const auto size = in.get<std::uint32_t>();
  if (size < 2 || size > std::uint32_t(kLargestMap)) refuseDamaged("a ray map has no such size");
  map.size = int(size);
  const std::size_t texels = std::size_t(size) * size;
  const auto bits = in.getAll<std::uint8_t>((texels + 7) / 8);
  std::array<Range, 7> ranges{};
  const std::size_t count = countNumbers(map.trace);
  for (std::size_t n = 0; n < count; ++n) {
    const auto range = getFinite<vec2>(in);
    ranges[n] = {range.x, range.y};
  }
  map.states.assign(texels, TexelState::Empty);
  std::size_t rays = 0;
  for (std::size_t i = 0; i < texels; ++i)
    if ((bits[i / 8] >> (i % 8)) & 1u) map.states[i] = TexelState::Ray, ++rays;
  const auto fractions = in.getAll<std::uint16_t>(rays * count);
  map.texels.resize(texels);
  const std::uint16_t* next = fractions.data();
  for (std::size_t i = 0; i < texels; ++i) {
    if (map.states[i] != TexelState::Ray) continue;
    Numbers numbers{};
    for (std::size_t n = 0; n < count; ++n) numbers[n] = fromFraction(*next++, ranges[n]);
    map.texels[i] = fromNumbers(map, map.lower + vec2(i % size, i / size) * map.step, numbers, count);
  }
  continueRayMap(map);
  return map;
}

void packOctree(const RayOctree& octree, const RayMap& map, ByteWriter& out) {
  std::vector<std::uint32_t> nodes;
  nodes.reserve(octree.nodes.size());
  for (const RayOctree::Node& node : octree.nodes) {
    if (node.count >> kCountBits || node.first >> (32 - kCountBits))
      throw core::Error("bake.octree", "an octree is too large", {}, "use a smaller --depth");
    nodes.push_back(node.first << kCountBits | node.count);
  }
  out.put(std::uint32_t(nodes.size()));
  out.putAll(std::span<const std::uint32_t>(nodes));
  out.put(std::uint32_t(octree.leafRays.size()));
  std::vector<std::uint32_t> texels;
  texels.reserve(octree.leafRays.size());
  for (const std::uint32_t ray : octree.leafRays)
    texels.push_back(std::uint32_t(map.at(int(octree.rays[ray].x), int(octree.rays[ray].y))));
  if (map.texels.size() > 65536) {
    out.putAll(std::span<const std::uint32_t>(texels));
    return;
  }
  const std::vector<std::uint16_t> narrow(texels.begin(), texels.end());
  out.putAll(std::span<const std::uint16_t>(narrow));
}

/// Turns the texels in leafRays into indices of rays.
void nameRays(const RayMap& map, RayOctree& octree) {
  const auto size = std::uint32_t(map.size);
  std::vector<std::uint32_t> names(map.texels.size(), core::kNoId);
  for (std::uint32_t& ray : octree.leafRays) {
    if (ray % size + 1 >= size || ray / size + 1 >= size || !map.isCell(int(ray % size), int(ray / size)))
      refuseDamaged("an octree names a ray that is not there");
    if (names[ray] == core::kNoId) {
      names[ray] = std::uint32_t(octree.rays.size());
      octree.rays.push_back(makeOctreeRay(map, ray));
    }
    ray = names[ray];
  }
}

RayOctree unpackOctree(ByteReader& in, const RayMap& map, const core::Box& box) {
  RayOctree octree;
  octree.lower = vec3(box.lower);
  octree.upper = vec3(box.upper);
  const auto nodes = in.getAll<std::uint32_t>(in.get<std::uint32_t>());
  const auto rayCount = in.get<std::uint32_t>();
  if (map.texels.size() > 65536) {
    octree.leafRays = in.getAll<std::uint32_t>(rayCount);
  } else {
    const auto narrow = in.getAll<std::uint16_t>(rayCount);
    octree.leafRays.assign(narrow.begin(), narrow.end());
  }
  nameRays(map, octree);
  if (nodes.empty()) refuseDamaged("an octree is empty");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const RayOctree::Node node{nodes[i] >> kCountBits, nodes[i] & ((1u << kCountBits) - 1)};
    // Children lie behind their parent: a search ends.
    const bool isGood = node.count == 0 ? node.first > i && std::size_t(node.first) + 8 <= nodes.size()
                                        : std::size_t(node.first) + node.count <= octree.leafRays.size();
    if (!isGood) refuseDamaged("an octree leads nowhere");
    octree.nodes.push_back(node);
  }
  return octree;
}

}  // namespace

const SampledTrace* SamplingLocation::findTrace(const Trace& trace) const {
  const auto at = std::lower_bound(traces.begin(), traces.end(), trace,
                                   [](const SampledTrace& s, const Trace& t) { return s.table.trace < t; });
  return at != traces.end() && at->table.trace == trace ? &*at : nullptr;
}

std::vector<std::byte> bakeLocation(const MirrorRays& rays, const dvec3& position,
                                    const BakeOptions& options) {
  ByteWriter out;
  out.put(position);
  std::uint32_t count = 0;
  const std::size_t countAt = out.bytes().size();
  out.put(count);
  for (RayMap& map : traceRayMaps(rays, position, options.map)) {
    continueRayMap(map);
    const RayOctree octree = makeRayOctree(map, options.octree);
    if (octree.nodes.empty() || count == kMostTraces) continue;
    packMap(map, out);
    packOctree(octree, map, out);
    ++count;
  }
  std::memcpy(out.bytes().data() + countAt, &count, sizeof count);
  return std::move(out.bytes());
}

std::shared_ptr<const SamplingLocation> unpackLocation(std::span<const std::byte> bytes,
                                                       const core::Box& box) {
  ByteReader in(bytes);
  auto location = std::make_shared<SamplingLocation>();
  location->position = in.get<dvec3>();
  const auto count = in.get<std::uint32_t>();
  if (count > kMostTraces) refuseDamaged("a location has too many traces");
  for (std::uint32_t i = 0; i < count; ++i) {
    const RayMap map = unpackMap(in);
    SampledTrace sampled{makeRayTable(map), unpackOctree(in, map, box), makeRayShaft(map)};
    if (i > 0 && !(location->traces.back().table.trace < sampled.table.trace))
      refuseDamaged("traces are not in order");
    location->traces.push_back(std::move(sampled));
  }
  if (!in.isAtEnd()) refuseDamaged("a location is longer than what is in it");
  return location;
}

}  // namespace catoptric::reflection_morphing

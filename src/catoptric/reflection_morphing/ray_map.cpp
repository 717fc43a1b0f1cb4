// SPDX-License-Identifier: Apache-2.0
// Which rays leave the mirrors of a trace, as a function of the direction of view?
//
// In: mirrors, a location (world, metres). Out: for each trace a grid of rays.
//   1. For each mirror a chart around its bounding sphere; a coarse grid of rays over the sphere's disc finds
//      the traces that begin there, and the window of the chart in which each of them is seen.
//   2. A window a little larger is traced with size x size rays; those with another trace are left empty.
//   3. continueRayMap(): two rings of texels past the edge, extrapolated from the two texels before it.
//
// Departures from 2004: a stereographic window for each trace instead of six faces of a cube for all, so that
// no ray is spent on directions without mirrors and no seam has to be crossed by interpolation; each window
// is a layer of its own. Traces of reflectors that the user has environment-mapped (hybrid reflectors,
// section 7) and traces that fewer than 8 of 4,096 coarse rays meet are left out. Cost: about 1 us a ray and
// mirror. Source: Martin & Popescu 2004, section 4.1.
#include "catoptric/reflection_morphing/ray_map.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace catoptric::reflection_morphing {
namespace {

constexpr int kCoarseSize = 64;           // rays along an edge of step 1
constexpr std::size_t kMostLinks = 64;    // of a trace
constexpr int kMostTotalShare = 50;       // 1 / the share of a trace's rays that may be reflected totally
constexpr int kLeastRays = 8;             // of them for a trace; smaller ones are left to environment maps
constexpr double kWidestHalfAngle = 2.6;  // radians; from inside a mirror's bounding sphere

struct Window {
  vec2 lower{1e30f}, upper{-1e30f};
  int rays = 0, totalRays = 0;
};

struct FirstMirror {
  Chart chart;
  float extent = 1;  ///< the chart's window is [-extent, extent]^2
};

FirstMirror aimAt(const scene::Reflector& mirror, const dvec3& location) {
  const dvec3 offset = mirror.centre - location;
  const double distance = glm::length(offset);
  FirstMirror first;
  first.chart = makeChart(distance > 1e-6 * mirror.radius ? offset / distance : dvec3(0, 0, 1));
  const double halfAngle =
      distance > 1.0001 * mirror.radius ? std::asin(mirror.radius / distance) : kWidestHalfAngle;
  first.extent = float(1.01 * std::tan(0.5 * std::min(halfAngle, kWidestHalfAngle)));
  return first;
}

/// Is there anything to morph?
bool isWanted(const Trace& trace, const scene::WorldGeometry& world, const RayMapOptions& options) {
  for (const std::uint32_t mapped : options.mapped)
    if (std::find(trace.begin(), trace.end(), mapped) != trace.end()) return false;
  return std::any_of(trace.begin(), trace.end(),
                     [&](std::uint32_t reflector) { return !world.reflectors[reflector].isPlanarMirror(); });
}

/// Step 1 for one mirror.
std::map<Trace, Window> findWindows(const MirrorRays& rays, const dvec3& location, std::uint32_t reflector,
                                    const FirstMirror& first, const RayMapOptions& options) {
  std::map<Trace, Window> windows;
  const float step = 2.0f * first.extent / float(kCoarseSize);
  for (int y = 0; y < kCoarseSize; ++y)
    for (int x = 0; x < kCoarseSize; ++x) {
      const vec2 p = (vec2(x, y) + 0.5f) * step - first.extent;
      rays.follow(location, glm::normalize(dvec3(first.chart.directionAt(p))), options.bounces, kMostLinks,
                  [&](const ReflectedRay& ray) {
                    if (ray.trace.front() != reflector || !isWanted(ray.trace, rays.world(), options)) return;
                    Window& window = windows[ray.trace];
                    if (ray.isTotal) {
                      ++window.totalRays;
                      return;
                    }
                    ++window.rays;
                    window.lower = glm::min(window.lower, p - step);
                    window.upper = glm::max(window.upper, p + step);
                  });
    }
  return windows;
}

/// Step 2.
RayMap traceWindow(const MirrorRays& rays, const dvec3& location, const Chart& chart, const Trace& trace,
                   const Window& window, const RayMapOptions& options) {
  const int size = options.size;
  RayMap map;
  map.trace = trace;
  map.location = vec3(location);
  map.chart = chart;
  map.size = size;
  // A margin, so that what continueRayMap() adds stays inside.
  const vec2 margin = float(kContinuedTexels) * (window.upper - window.lower) / float(size);
  map.lower = window.lower - margin;
  map.step = (window.upper - window.lower + 2.0f * margin) / float(size - 1);
  map.texels.resize(std::size_t(size) * std::size_t(size));
  map.states.assign(map.texels.size(), TexelState::Empty);
  if (options.keepStatic) map.lengths.resize(map.texels.size());
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const vec2 p = map.lower + vec2(x, y) * map.step;
      rays.follow(location, glm::normalize(dvec3(chart.directionAt(p))), options.bounces, trace.size(),
                  [&](const ReflectedRay& ray) {
                    if (ray.trace != trace || ray.isTotal) return;
                    map.texels[map.at(x, y)] = {vec3(ray.origin), float(ray.distance), vec3(ray.direction),
                                                float(ray.between)};
                    map.states[map.at(x, y)] = TexelState::Ray;
                    if (!map.lengths.empty()) map.lengths[map.at(x, y)] = float(rays.findObstacle(ray));
                  });
    }
  return map;
}

RayTexel extrapolate(const RayTexel& a, const RayTexel& b) {
  return {2.0f * a.origin - b.origin, 2.0f * a.distance - b.distance, 2.0f * a.direction - b.direction,
          2.0f * a.between - b.between};
}

void addTexel(RayTexel& sum, const RayTexel& t, float weight) {
  sum.origin += weight * t.origin;
  sum.distance += weight * t.distance;
  sum.direction += weight * t.direction;
  sum.between += weight * t.between;
}

}  // namespace

Chart makeChart(const dvec3& axis) {
  const dvec3 side = std::abs(axis.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
  const dvec3 right = glm::normalize(glm::cross(side, axis));
  return {vec3(right), vec3(glm::cross(axis, right)), vec3(axis)};
}

std::size_t RayMap::countRays() const {
  return std::size_t(std::count(states.begin(), states.end(), TexelState::Ray));
}

std::vector<std::uint32_t> listMapped(const scene::WorldGeometry& world) {
  std::vector<std::uint32_t> mapped;
  for (std::uint32_t r = 0; r < world.reflectors.size(); ++r)
    if (!world.reflectors[r].morphed.value_or(!world.reflectors[r].isRefractor())) mapped.push_back(r);
  return mapped;
}

std::vector<RayMap> traceRayMaps(const MirrorRays& rays, const dvec3& location,
                                 const RayMapOptions& options) {
  std::vector<RayMap> maps;
  const auto& reflectors = rays.world().reflectors;
  for (std::uint32_t r = 0; r < reflectors.size(); ++r) {
    const FirstMirror first = aimAt(reflectors[r], location);
    for (const auto& [trace, window] : findWindows(rays, location, r, first, options))
      if (window.rays >= kLeastRays && window.totalRays * kMostTotalShare <= window.rays)
        maps.push_back(traceWindow(rays, location, first.chart, trace, window, options));
  }
  std::sort(maps.begin(), maps.end(), [](const RayMap& a, const RayMap& b) { return a.trace < b.trace; });
  return maps;
}

void continueRayMap(RayMap& map) {
  for (int ring = 0; ring < kContinuedTexels; ++ring) {
    std::vector<std::pair<std::size_t, RayTexel>> added;
    for (int y = 0; y < map.size; ++y)
      for (int x = 0; x < map.size; ++x) {
        if (map.states[map.at(x, y)] != TexelState::Empty) continue;
        RayTexel sum;
        float weights = 0;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            const int bx = x + 2 * dx, by = y + 2 * dy;
            if ((dx == 0 && dy == 0) || bx < 0 || by < 0 || bx >= map.size || by >= map.size) continue;
            const std::size_t a = map.at(x + dx, y + dy), b = map.at(bx, by);
            if (map.states[a] == TexelState::Empty || map.states[b] == TexelState::Empty) continue;
            const float weight = dx == 0 || dy == 0 ? 1.0f : 0.5f;
            addTexel(sum, extrapolate(map.texels[a], map.texels[b]), weight);
            weights += weight;
          }
        if (weights == 0) continue;
        RayTexel mean;
        addTexel(mean, sum, 1 / weights);
        added.emplace_back(map.at(x, y), mean);
      }
    for (const auto& [at, texel] : added) {
      map.texels[at] = texel;
      map.states[at] = TexelState::Continued;
    }
  }
}

}  // namespace catoptric::reflection_morphing

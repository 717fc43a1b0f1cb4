// SPDX-License-Identifier: Apache-2.0
// The ray map of one trace at one sampling location (2004, section 4.1): which reflected ray leaves the
// mirrors for each direction of view, on a regular grid of directions, so that it can be interpolated.
//
// Directions are charted stereographically around the direction of the trace's first mirror, and the grid is
// fitted to where the trace is seen: all rays fall on mirrors, and there are no seams.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/reflection_morphing/mirror_rays.h"

namespace catoptric::reflection_morphing {

/// Stereographic chart of the directions from a point; chart points run to infinity opposite to the axis.
struct Chart {
  vec3 right{1, 0, 0}, up{0, 1, 0}, axis{0, 0, 1};  ///< unit, orthogonal

  [[nodiscard]] vec3 directionAt(const vec2& p) const {
    const float pp = glm::dot(p, p);
    return (2.0f * p.x * right + 2.0f * p.y * up + (1.0f - pp) * axis) / (1.0f + pp);
  }
};

[[nodiscard]] Chart makeChart(const dvec3& axis);

struct RayTexel {
  vec3 origin{0};      ///< last mirror point
  float distance = 0;  ///< from the location to the first mirror point
  vec3 direction{0};   ///< in which the ray leaves
  float between = 0;   ///< from the first mirror point to the last
};

/// What a texel is: nothing, continued past the edge of the trace, or a ray.
enum class TexelState : std::uint8_t { Empty, Continued, Ray };

struct RayMap {
  Trace trace;
  vec3 location{0};
  Chart chart;
  vec2 lower{0}, step{0};  ///< chart point of texel (0, 0), and per texel
  int size = 0;            ///< texels along an edge
  std::vector<RayTexel> texels;
  std::vector<TexelState> states;
  std::vector<float> lengths;  ///< of each ray, where static objects are kept; while it is being baked

  [[nodiscard]] std::size_t at(int x, int y) const {
    return std::size_t(y) * std::size_t(size) + std::size_t(x);
  }
  /// Can the map be interpolated between (x, y) and (x + 1, y + 1)? Needs x, y < size - 1.
  [[nodiscard]] bool isCell(int x, int y) const {
    const TexelState* s = &states[at(x, y)];
    return s[0] != TexelState::Empty && s[1] != TexelState::Empty && s[size] != TexelState::Empty &&
           s[size + 1] != TexelState::Empty;
  }
  [[nodiscard]] std::size_t countRays() const;
};

struct RayMapOptions {
  int size = 256;  ///< rays along an edge of a map
  int bounces = 1;
  bool keepStatic = false;  ///< rays end at diffuse objects, which then must not move
  /// Reflectors that other methods will draw (2004, section 7): their traces are left out.
  std::vector<std::uint32_t> mapped{};
};

/// The reflectors that the user has not morphed, and the refractors that he has not asked to be: what stands
/// near the focus of a lens cannot be drawn by moving its vertices.
[[nodiscard]] std::vector<std::uint32_t> listMapped(const scene::WorldGeometry& world);

/// The maps of all traces with a curved mirror that are seen from `location`; sorted by trace. Only the Ray
/// texels are filled.
[[nodiscard]] std::vector<RayMap> traceRayMaps(const MirrorRays& rays, const dvec3& location,
                                               const RayMapOptions& options);

/// Continues a map by `kContinuedTexels` past its edges, linearly, so that points at the rim can be
/// interpolated.
void continueRayMap(RayMap& map);
inline constexpr int kContinuedTexels = 2;

}  // namespace catoptric::reflection_morphing

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
};

/// The maps of all traces with a curved mirror that are seen from `location`; sorted by trace. Only the Ray
/// texels are filled.
[[nodiscard]] std::vector<RayMap> traceRayMaps(const MirrorRays& rays, const dvec3& location,
                                               const RayMapOptions& options);

/// Continues a map by `kContinuedTexels` past its edges, linearly, so that points at the rim can be
/// interpolated.
void continueRayMap(RayMap& map);
inline constexpr int kContinuedTexels = 2;

/// Where a scene point is seen.
struct FoundRay {
  vec3 mirrorPoint{0};    ///< the first mirror point, as seen from the location
  float rest = 0;         ///< from there over the other mirrors to the scene point
  bool isInside = false;  ///< false: continued past the edge of the trace, the point is not reflected
};

/// Solves origin(p) + t direction(p) = scenePoint on the interpolated map, step by step, so that many
/// searches can be led side by side: most of the time goes by waiting for memory, and each step asks for what
/// the next one needs.
class RaySearch {
 public:
  /// From the texel `seed`, which must be the lower corner of a cell.
  void start(const RayMap& map, const vec3& scenePoint, std::uint32_t seed);
  /// True when the search has ended.
  [[nodiscard]] bool advance(const RayMap& map);
  [[nodiscard]] const FoundRay& found() const { return found_; }

 private:
  vec3 point_{0};
  vec2 p_{0};
  int steps_ = 0, shortened_ = 0;
  FoundRay found_;
};

/// One search from its start to its end.
[[nodiscard]] FoundRay findRay(const RayMap& map, const vec3& scenePoint, std::uint32_t seed);

}  // namespace catoptric::reflection_morphing

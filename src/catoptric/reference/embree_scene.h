// SPDX-License-Identifier: Apache-2.0
// The one place that calls Embree 3: closest hits for batches of rays.
//
// Back faces of single-sided materials and cut-out texels are rejected while Embree traverses (an
// intersection filter), because tracing on from behind them would miss the other half of two faces that lie
// back to back. Triangles that are always there (double-sided, opaque, no mirror) live in a geometry without
// a filter and cost nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "catoptric/core/seen.h"
#include "catoptric/reference/surface_shading.h"

namespace catoptric::reference {

/// A ray for the closest-hit query, and what it must not hit.
struct TraceRequest {
  const Ray* ray = nullptr;
  float tNear = 0;
  std::uint32_t ignoredTriangle = core::kNoId;  ///< the one it starts on
  std::uint32_t ignoredPart = core::kNoId;
  std::uint32_t passedTriangle = core::kNoId;  ///< blended layer at tNear, already accounted for
};

struct TraceAnswer {
  std::uint32_t triangle = core::kNoId;  ///< kNoId: nothing was hit
  float t = 0, u = 0, v = 0;             ///< u, v: weights of the second and third vertex
};

class EmbreeScene {
 public:
  /// Throws core::Error("embree.*"). Triangles with non-finite or gigantic coordinates are left out.
  /// packetWidth: 4 or 8 rays at once; 0 = what the processor does best.
  EmbreeScene(const scene::WorldGeometry& geometry, const SurfaceShader& shader, int packetWidth = 0);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// Closest hits of a batch; rays near each other in the batch should be near each other in space. Requests
  /// with a non-finite ray are answered with "nothing" (Debian's Embree would abort).
  void intersect(std::span<const TraceRequest> requests, std::span<TraceAnswer> answers) const;

  [[nodiscard]] std::string describe() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catoptric::reference

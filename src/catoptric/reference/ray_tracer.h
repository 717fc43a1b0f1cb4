// SPDX-License-Identifier: Apache-2.0
// Ray-traced truth with Embree: the judge of every other method, and what a CPU user would pick instead, so
// written to be fast (tiles over all cores, rays of a tile traced as one stream). Shades with
// shaders/lib/*.glsl compiled as C++, filters textures by ray differentials carried through the mirrors
// (Igehy 1999).
//
// Rules it shares with the rasterizer, so that their pictures can agree: the same world-space floats; back
// faces of single-sided materials are not there; alpha-masked texels are not there; blended surfaces let the
// rest through; the normal is interpolated from the vertices and normal-mapped; a mirror met after the last
// allowed bounce shows the environment in its mirror direction; lights cast no shadows.
#pragma once

#include <atomic>
#include <memory>

#include "catoptric/core/image.h"
#include "catoptric/core/seen.h"
#include "catoptric/scene/camera_frame.h"
#include "catoptric/scene/environment.h"
#include "catoptric/scene/scene.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::reference {

struct TraceOptions {
  int bounces =
      1;  ///< mirror bounces; 0 = mirrors show the environment only. See scene::kMostCrossings, too.
  int samples = 1;  ///< rays per pixel, on the same sub-pixel pattern as the rasterizer (samplePattern())
  bool withSeen = true;        ///< fill `seen` (always from the pixel centre)
  bool withFootprints = true;  ///< fill `footprints`
  /// Once it is true, which any thread may make it, no new tile is begun and the result is of no use.
  const std::atomic<bool>* cancel = nullptr;
};

struct TraceResult {
  core::ImageRgbaF radiance;        ///< linear, alpha 1
  core::SeenImage seen;             ///< empty unless asked for
  core::FootprintImage footprints;  ///< empty unless asked for
  std::uint64_t rays = 0;           ///< rays traced, primary and mirrored
  double seconds = 0;               ///< wall time of the tracing alone
  /// The part of it that goes on from mirrors and through glass, if all threads are equally busy with it.
  double reflectionSeconds = 0;
};

class RayTracer {
 public:
  /// Builds the acceleration structure. All arguments must outlive the tracer. Triangles with a non-finite
  /// vertex are left out (Debian's Embree aborts on them). Throws core::Error("embree.*").
  RayTracer(const scene::Scene& scene, const scene::WorldGeometry& geometry,
            const scene::Environment& environment);
  ~RayTracer();
  RayTracer(const RayTracer&) = delete;
  RayTracer& operator=(const RayTracer&) = delete;

  /// The same bytes on every run and with any number of threads. Throws core::Error("camera.not_finite").
  [[nodiscard]] TraceResult trace(const scene::CameraFrame& camera, const TraceOptions& options) const;
  /// The same into a result that may be used again for the next frame: its images keep their memory.
  void trace(const scene::CameraFrame& camera, const TraceOptions& options, TraceResult& result) const;

  /// "Embree 3.13.5 (Debian build, asserts on), ISA ..., N threads"
  [[nodiscard]] std::string describe() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catoptric::reference

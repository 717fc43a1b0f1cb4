// SPDX-License-Identifier: Apache-2.0
#include "catoptric/reference/ray_tracer.h"

#include <immintrin.h>

#include <atomic>
#include <chrono>
#include <cmath>

#include "catoptric/core/error.h"
#include "catoptric/core/parallel.h"
#include "catoptric/reference/embree_scene.h"
#include "catoptric/reference/surface_shading.h"
#include "catoptric/reference/tile_tracer.h"

namespace catoptric::reference {
namespace {

/// Embree asks for denormals to be flushed while it traces; restored afterwards.
class FlushDenormals {
 public:
  FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040u); }
  ~FlushDenormals() { _mm_setcsr(before_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned before_;
};

bool isFinite(const dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void checkCamera(const scene::CameraFrame& camera) {
  const dvec3 corner = camera.rayDirection(0, 0);
  if (!isFinite(camera.eye) || !isFinite(corner) || !(glm::length(corner) > 0))
    throw core::Error("camera.not_finite", "the camera has no finite position or direction", {},
                      "eye and target must be finite and apart");
}

/// Every pixel is written by its tile, so that an image of the right size is left as it is.
template <class Pixel>
void resize(core::Image<Pixel>& image, const scene::CameraFrame& camera, bool isWanted) {
  const int width = isWanted ? camera.widthPx : 0, height = isWanted ? camera.heightPx : 0;
  if (image.width() != width || image.height() != height) image = core::Image<Pixel>(width, height);
}

}  // namespace

struct RayTracer::Impl {
  Impl(const scene::Scene& scene, const scene::WorldGeometry& world, const scene::Environment& light)
      : geometry(world), environment(light), shader(scene, world, light), embree(world, shader) {}

  const scene::WorldGeometry& geometry;
  const scene::Environment& environment;
  SurfaceShader shader;
  EmbreeScene embree;
};

RayTracer::RayTracer(const scene::Scene& scene, const scene::WorldGeometry& geometry,
                     const scene::Environment& environment)
    : impl_(std::make_unique<Impl>(scene, geometry, environment)) {}

RayTracer::~RayTracer() = default;

TraceResult RayTracer::trace(const scene::CameraFrame& camera, const TraceOptions& options) const {
  TraceResult result;
  trace(camera, options, result);
  return result;
}

void RayTracer::trace(const scene::CameraFrame& camera, const TraceOptions& options,
                      TraceResult& result) const {
  checkCamera(camera);
  const auto start = std::chrono::steady_clock::now();
  resize(result.radiance, camera, true);
  resize(result.seen, camera, options.withSeen);
  resize(result.footprints, camera, options.withFootprints);

  const TracedScene scene{impl_->geometry, impl_->environment, impl_->shader, impl_->embree};
  const int columns = (camera.widthPx + kTileEdgePx - 1) / kTileEdgePx;
  const int rows = (camera.heightPx + kTileEdgePx - 1) / kTileEdgePx;
  std::atomic<std::uint64_t> rays{0};
  std::atomic<double> reflectionSeconds{0};
  core::parallelFor(std::size_t(columns) * std::size_t(rows), 4, [&](std::size_t begin, std::size_t end) {
    if (options.cancel && *options.cancel) return;
    const FlushDenormals flush;
    TileTracer tracer(scene, camera, options, result);
    for (std::size_t tile = begin; tile < end; ++tile)
      tracer.traceTile(int(tile % std::size_t(columns)) * kTileEdgePx,
                       int(tile / std::size_t(columns)) * kTileEdgePx);
    rays += tracer.rays();
    reflectionSeconds += tracer.reflectionSeconds();
  });
  result.rays = rays;
  result.reflectionSeconds = reflectionSeconds / core::threadCount();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string RayTracer::describe() const {
  return impl_->embree.describe();
}

}  // namespace catoptric::reference

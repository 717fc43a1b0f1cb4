// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "catoptric/core/error.h"
#include "catoptric/reference/ray_tracer.h"
#include "catoptric/renderer/frame.h"
#include "catoptric/renderer/raster_frame.h"

namespace catoptric::renderer {

struct Renderer::Impl {
  const scene::Scene& scene;
  const scene::WorldGeometry& geometry;
  const scene::Environment& environment;
  std::shared_ptr<gl::Context> context;
  std::unique_ptr<RasterFrame> raster;  // after the context: its buffers go first
  std::unique_ptr<reference::RayTracer> tracer;
  reference::TraceResult traced;

  gl::Context& getContext() {
    if (!context) context = makeSharedContext();
    return *context;
  }
  reference::RayTracer& getTracer() {
    if (!tracer) tracer = std::make_unique<reference::RayTracer>(scene, geometry, environment);
    return *tracer;
  }

  Frame trace(const scene::CameraFrame& camera, const FrameOptions& options) {
    getTracer().trace(camera,
                      {.bounces = options.bounces,
                       .samples = options.samples,
                       .withSeen = options.withSeen,
                       .withFootprints = options.withSeen,
                       .cancel = options.cancel},
                      traced);
    Frame frame;
    frame.radiance = traced.radiance;
    frame.seen = traced.seen;
    frame.footprints = traced.footprints;
    frame.counters.rays = traced.rays;
    frame.timings.totalMs = traced.seconds * 1e3;
    frame.timings.reflectionMs = traced.reflectionSeconds * 1e3;
    frame.timings.primaryMs = frame.timings.totalMs - frame.timings.reflectionMs;
    return frame;
  }
};

std::shared_ptr<gl::Context> makeSharedContext() {
  return std::make_shared<gl::Context>(
      gl::ContextOptions{.debug = std::getenv("CATOPTRIC_GL_DEBUG") != nullptr});
}

Renderer::Renderer(const scene::Scene& scene, const scene::WorldGeometry& geometry,
                   const scene::Environment& environment, std::shared_ptr<gl::Context> context)
    : impl_(new Impl{scene, geometry, environment, std::move(context), nullptr, nullptr, {}}) {}

Renderer::~Renderer() {
  try {
    if (impl_->context) impl_->context->makeCurrent();
  } catch (const core::Error&) {  // lost, and all that it held with it
  }
}

Frame Renderer::render(const scene::Camera& camera, const FrameOptions& options) {
  const scene::CameraFrame view = scene::makeCameraFrame(camera, options.widthPx, options.heightPx);
  if (options.method == Method::RayTrace) return impl_->trace(view, options);
  gl::Context& context = impl_->getContext();
  context.makeCurrent();
  if (!impl_->raster)
    impl_->raster = std::make_unique<RasterFrame>(context, impl_->scene, impl_->geometry, impl_->environment);
  return impl_->raster->render(view, options);
}

core::ImageRgbaF Renderer::renderElsewhere(const scene::Camera& camera, const ElsewhereOptions& options) {
  const scene::CameraFrame view = scene::makeCameraFrame(camera, options.widthPx, options.heightPx);
  gl::Context& context = impl_->getContext();
  context.makeCurrent();
  if (!impl_->raster)
    impl_->raster = std::make_unique<RasterFrame>(context, impl_->scene, impl_->geometry, impl_->environment);
  return impl_->raster->renderElsewhere(view, options);
}

void Renderer::updateGeometry(std::span<const std::uint32_t> movedParts) {
  impl_->tracer.reset();  // its tree is built anew when it is needed
  if (!impl_->raster) return;
  impl_->getContext().makeCurrent();
  impl_->raster->updateGeometry(movedParts);
}

void Renderer::updateMaterials() {
  impl_->tracer.reset();
  if (!impl_->raster) return;
  impl_->getContext().makeCurrent();
  impl_->raster->updateMaterials();
}

void Renderer::saveReferenceImages() {
  if (!impl_->raster) return;
  impl_->getContext().makeCurrent();
  impl_->raster->saveReferenceImages();
}

std::string Renderer::describeGl() {
  return impl_->getContext().description();
}

Backend Renderer::chooseBackend() {
  return impl_->getContext().isSoftware() ? Backend::Cpu : Backend::Gpu;
}

std::string Renderer::describeRayTracer() {
  return impl_->getTracer().describe();
}

}  // namespace catoptric::renderer

// SPDX-License-Identifier: Apache-2.0
// What a method works with, seen from elsewhere. Steps: 1 the scene without the mirror that is looked at, 2
// the mirror's virtual object, 3 the marks of the method that has drawn it, 4 composed without reflections
// and read back.
#include "catoptric/renderer/near_plane.h"
#include "catoptric/renderer/raster_frame.h"

namespace catoptric::renderer {

core::ImageRgbaF RasterFrame::renderElsewhere(const scene::CameraFrame& camera,
                                              const ElsewhereOptions& options) {
  if (!elsewhere_ || elsewhere_->widthPx != camera.widthPx || elsewhere_->heightPx != camera.heightPx)
    elsewhere_ = std::make_unique<raster::Level>(camera.widthPx, camera.heightPx);
  if (!marksPass_) marksPass_ = std::make_unique<raster::MarksPass>();
  raster::Level& level = *elsewhere_;
  level.withSeen = false;
  const auto last = lastMethods_.find(options.reflector);
  const bool hasMethod = last != lastMethods_.end();
  raster::MethodCounters counters;
  raster::FrameContext context{.scene = scene_,
                               .camera = camera,
                               .surfaces = surfaces_,
                               .primary = primary_,
                               .compose = compose_,
                               .nearPlane = chooseNearPlane(geometry_, camera),
                               .counters = counters};
  // 1
  primary_.draw(scene_, camera, context.nearPlane, context.jitterPx, level,
                hasMethod ? options.reflector : core::kNoId);
  const dmat4 clipFromWorld = raster::makeClipFromWorld(camera, context.nearPlane, context.jitterPx);
  if (hasMethod) {
    // 2
    raster::SurfaceView view;
    view.clipFromDraw = clipFromWorld;
    view.eye = view.drawEye = camera.eye;
    if (options.marks.virtualObject && last->second == &virtual_)
      virtual_.drawFromElsewhere(context, options.reflector, view, level);
    // 3
    raster::Marks marks;
    last->second->collectMarks(geometry_, options.reflector, options.marks, marks);
    marksPass_->draw(marks, clipFromWorld, level);
  }
  // 4
  compose_.draw(level, nullptr);
  core::ImageRgbaF picture(camera.widthPx, camera.heightPx);
  readFlipped(level.composed, 0, picture);
  return picture;
}

}  // namespace catoptric::renderer

// SPDX-License-Identifier: Apache-2.0
// Steps: 1 drop parts wholly behind the mirror, 2 draw the rest mirrored, 3 the environment behind it.
#include "catoptric/planar_mirror/planar_mirror_method.h"

namespace catoptric::planar_mirror {
namespace {

/// Does this box lie behind the plane, or in it?
bool isWhollyBehind(const core::Box& box, const vec4& plane) {
  const dvec3 normal = dvec3(vec3(plane));
  const dvec3 foremost = glm::mix(box.lower, box.upper, glm::greaterThan(normal, dvec3(0)));
  return glm::dot(normal, foremost) + double(plane.w) <= 0.0;
}

}  // namespace

void PlanarMirrorMethod::render(raster::FrameContext& frame, const raster::Chain& chain,
                                const raster::Level& parent, raster::Level& target) {
  // 1. The side of the mirror on which the last-but-one image of the eye lies is the bright one.
  const scene::WorldGeometry& world = frame.scene.geometry();
  const scene::Reflector& mirror = world.reflectors[chain.last];
  const dmat4 drawFromScreen = glm::inverse(chain.screenFromDraw);
  const dvec3 drawEye = dvec3(drawFromScreen * dvec4(frame.camera.eye, 1.0));
  // The mirrored eye is behind the last mirror; what it shows lies on the other side.
  const double side = mirror.plane.signedDistance(drawEye) < 0.0 ? 1.0 : -1.0;
  raster::SurfaceView view;
  view.clipFromDraw =
      raster::makeClipFromWorld(frame.camera, frame.nearPlane, frame.jitterPx) * chain.screenFromDraw;
  view.eye = view.drawEye = drawEye;
  view.windingFlipped = chain.level % 2 == 1;
  view.chain = &chain;
  view.parent = &parent;
  view.clipPlane = vec4(vec3(side * mirror.plane.normal), float(side * mirror.plane.offset));
  view.excludedReflector = chain.last;
  ranges_.clear();
  for (const raster::DrawRange& range : frame.scene.opaqueRanges())
    if (!isWhollyBehind(frame.scene.partBox(range.part), view.clipPlane)) ranges_.push_back(range);

  // 2
  raster::sortNearFirst(frame.scene, drawEye, ranges_);
  frame.surfaces.draw(frame.scene, frame.scene.world(), ranges_, view, target);
  // 3
  background_.draw(frame.scene, chain, parent, target);
  for (const raster::DrawRange& range : ranges_) frame.counters.virtualTriangles += range.indexCount / 3;
  if (frame.scene.blendedRanges().empty()) return;
  if (!blendedStreams_) blendedStreams_ = std::make_unique<raster::VertexStreams>(world);
  raster::sortBlendedTriangles(frame.scene.blendedRanges(), world.indices, world.positions, drawEye,
                               sortedIndices_, sortedRanges_);
  blendedStreams_->setIndices(sortedIndices_, true);
  frame.surfaces.drawBlended(frame.scene, *blendedStreams_, sortedRanges_, view, target);
}

}  // namespace catoptric::planar_mirror

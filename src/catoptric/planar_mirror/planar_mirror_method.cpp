// SPDX-License-Identifier: Apache-2.0
// Steps: 1 the mirrored eye, 2 drop parts wholly behind the mirror or beside what it can show, 3 draw the
// rest mirrored, kept within the mirror as Merge says, 4 the environment behind it.
#include "catoptric/planar_mirror/planar_mirror_method.h"

#include <algorithm>

#include "catoptric/planar_mirror/mirror_outline.h"
#include "catoptric/planar_mirror/mirrored_view.h"

namespace catoptric::planar_mirror {

void PlanarMirrorMethod::render(raster::FrameContext& frame, const raster::Chain& chain,
                                const raster::Level& parent, raster::Level& target) {
  // 1
  raster::PinholeView mirrored = makeMirroredView(frame, chain);
  // 2
  const vec4 plane = mirrored.clip.planes[0];
  const std::array<vec4, 4> sides = makeFrustumSides(mirrored, chain.bounds);
  ranges_.clear();
  for (const raster::DrawRange& range : frame.scene.opaqueRanges()) {
    const core::Box& box = frame.scene.partBox(range.part);
    const auto isOutside = [&](const vec4& side) { return isWhollyBehind(box, side); };
    if (!isOutside(plane) && std::none_of(sides.begin(), sides.end(), isOutside)) ranges_.push_back(range);
  }
  for (const raster::DrawRange& range : ranges_) frame.counters.virtualTriangles += range.indexCount / 3;

  // 3
  if (frame.merge == raster::Merge::Texture) {
    if (!texture_) texture_ = std::make_unique<ProjectiveTexture>();
    texture_->draw(frame, chain, mirrored, ranges_, parent, target);
    return;
  }
  raster::SurfaceView view;
  view.masking = frame.masking;
  if (frame.merge == raster::Merge::Clip && addEdgePlanes(frame, chain, mirrored))
    view.masking.testsIds = false;
  view.clipFromDraw = mirrored.clipFromWorld;
  view.eye = view.drawEye = mirrored.eye;
  view.windingFlipped = mirrored.windingFlipped;
  view.chain = &chain;
  view.parent = view.masking.testsIds ? &parent : nullptr;  // view rays come from the mirrored eye
  view.clip = mirrored.clip;
  view.excludedReflector = chain.last;
  raster::sortNearFirst(frame.scene, mirrored.eye, ranges_);
  frame.surfaces.draw(frame.scene, frame.scene.world(), ranges_, view, target);
  // 4
  background_.draw(frame.scene, chain, parent, target);
  drawBlended(frame, view, target);
}

void PlanarMirrorMethod::drawBlended(raster::FrameContext& frame, const raster::SurfaceView& view,
                                     raster::Level& target) {
  if (frame.scene.blendedRanges().empty()) return;
  const scene::WorldGeometry& world = frame.scene.geometry();
  if (!blendedStreams_) blendedStreams_ = std::make_unique<raster::VertexStreams>(world);
  raster::sortBlendedTriangles(frame.scene.blendedRanges(), world.indices, world.positions, view.drawEye,
                               sortedIndices_, sortedRanges_);
  blendedStreams_->setIndices(sortedIndices_, true);
  frame.surfaces.drawBlended(frame.scene, *blendedStreams_, sortedRanges_, view, target);
}

bool PlanarMirrorMethod::addEdgePlanes(const raster::FrameContext& frame, const raster::Chain& chain,
                                       raster::PinholeView& mirrored) {
  const std::size_t most = raster::ClipPlanes::kMost - std::size_t(mirrored.clip.count);
  auto kept = outlines_.find(chain.last);
  if (kept == outlines_.end())
    kept = outlines_.emplace(chain.last, findConvexOutline(frame.scene.geometry(), chain.last, most)).first;
  const std::vector<dvec3>& outline = kept->second;
  if (outline.empty()) return false;
  const std::vector<vec4> planes = makeEdgePlanes(outline, mirrored);
  if (coverOtherMirror(planes, mirrored, chain, frame.parentIds, frame.camera.widthPx)) return false;
  for (const vec4& plane : planes) mirrored.clip.add(plane);
  return true;
}

}  // namespace catoptric::planar_mirror

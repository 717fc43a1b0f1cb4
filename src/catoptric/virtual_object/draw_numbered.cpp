// SPDX-License-Identifier: Apache-2.0
// Virtual triangles as numbers, and each mirror pixel shaded once (virtual_object_method.h, step 2):
//   1. which triangles are worth drawing: first those that some pixel's centre may lie in, then of these the
//      ones that are what they seem to be;
//   2. their numbers, by GL or, where that is software, by the processor;
//   3. the rectangles of pixels in which each part is seen, shaded;
//   4. masked and blended parts, as surfaces.
// Only the last step needs depths. Without it the environment comes before step 3, which then tests none.
#include <algorithm>
#include <future>

#include "catoptric/virtual_object/virtual_object_method.h"

namespace catoptric::virtual_object {

/// Which triangles are drawn: the cheap question first.
void VirtualObjectMethod::markTriangles(raster::FrameContext& frame, const raster::Chain& chain,
                                        const raster::SurfaceView& view, const Prepared& p) {
  const PictureView picture{mat4(view.clipFromDraw), view.parent->widthPx, view.parent->heightPx,
                            view.windingFlipped};
  triangles_.isKept.assign(p.objects.indices.size() / 3, 1);
  projectVertices(picture, p.virtualPositions, screen_);
  frame.counters.culledTriangles += dropUnseenTriangles(p.objects, frame.scene.geometry(), picture,
                                                        chain.bounds, screen_, triangles_.isKept);
  raster::dropVirtualTriangles(p.objects, view.drawEye, p.virtualPositions, p.kinds, p.reflectionPoints,
                               triangles_.isKept, {}, findLongestChord(p));
}

void VirtualObjectMethod::drawNumbersByGl(raster::FrameContext& frame, const raster::Chain& chain,
                                          const raster::SurfaceView& view, Prepared& p) {
  if (!p.numbered) p.numbered = std::make_unique<NumberedTriangles>(p.objects);
  raster::gatherVirtualTriangles(p.objects, p.numbered->indices(), p.isNumbered, triangles_);
  frame.counters.virtualTriangles += triangles_.indices.size() / 3;
  ranges_.clear();
  for (const raster::TessellatedPart& part : triangles_.parts)
    if (part.indexCount > 0) ranges_.push_back({part.part, part.firstIndex, part.indexCount});
  shading_.beginHits(chain.bounds);
  p.numbered->draw(frame, view, numberProgram_, p.virtualPositions, triangles_.indices, ranges_);
  shading_.readHits(chain.bounds, numbers_.hits);
}

void VirtualObjectMethod::drawNumbersHere(raster::FrameContext& frame, const raster::Chain& chain,
                                          const raster::SurfaceView& view, const Prepared& p,
                                          bool withDepths) {
  const raster::Level& parent = *view.parent;
  const NumberPicture picture{.clipFromDraw = mat4(view.clipFromDraw),
                              .drawEye = view.drawEye,
                              .widthPx = parent.widthPx,
                              .heightPx = parent.heightPx,
                              .bounds = chain.bounds,
                              .mirror = shading_.inLanes().positions(),
                              .parentIds = frame.parentIds,
                              .parentWord = chain.parentWord(),
                              .screen = screen_,
                              .virtualPositions = p.virtualPositions,
                              .isKept = triangles_.isKept,
                              .isWanted = p.isNumbered,
                              .triangleParts = frame.scene.levels().triangleParts(),
                              .withDepths = withDepths};
  frame.counters.virtualTriangles += raster_.draw(p.objects, picture, numbers_);
}

bool VirtualObjectMethod::drawNumbered(raster::FrameContext& frame, const raster::Chain& chain,
                                       const raster::SurfaceView& view, Prepared& p, raster::Level& target) {
  shading_.prepare(frame.scene, *view.parent);
  // Reading keeps one core busy.
  auto marks = std::async(numbersByGl_ ? std::launch::deferred : std::launch::async,
                          [&] { markTriangles(frame, chain, view, p); });
  if (!numbersByGl_) shading_.inLanes().readParent(*view.parent, chain.bounds);
  marks.get();
  const bool hasSurfaces =
      std::any_of(p.objects.parts.begin(), p.objects.parts.end(),
                  [&](const raster::TessellatedPart& part) { return p.isDrawn[part.part] != 0; });
  const bool withDepths = hasSurfaces || frame.merge != raster::Merge::Ids;
  if (numbersByGl_)
    drawNumbersByGl(frame, chain, view, p);
  else
    drawNumbersHere(frame, chain, view, p, withDepths);
  if (!numbersByGl_ && !withDepths) {
    shading_.inLanes().shade(frame, chain, shading_.triangles(), {numbers_.hits, true}, target);
    return true;
  }
  findPartRects(frame.scene.levels().triangleParts(), chain.bounds, numbers_.hits, frame.parentIds,
                view.parent->widthPx, chain.parentWord(), rects_);
  if (!numbersByGl_) shading_.uploadHits(chain.bounds, numbers_.hits, numbers_.depths);
  if (!withDepths && !rects_.rest.empty())
    background_.draw(frame.scene, chain, *view.parent, target, true, rects_.rest);
  // Edges first: they read one more texture, and llvmpipe shades what was drawn before such a draw begins.
  shading_.shadeVirtual(frame, chain, *view.parent, target, true, rects_.edges, withDepths);
  shading_.shadeVirtual(frame, chain, *view.parent, target, false, rects_.inner, withDepths);
  if (!hasSurfaces) return !withDepths;
  raster::gatherVirtualTriangles(p.objects, p.objects.indices, p.isDrawn, triangles_);
  frame.counters.virtualTriangles += triangles_.indices.size() / 3;
  if (!triangles_.indices.empty()) p.pass.drawSelected(frame, view, p.virtualPositions, triangles_, target);
  return false;
}

}  // namespace catoptric::virtual_object

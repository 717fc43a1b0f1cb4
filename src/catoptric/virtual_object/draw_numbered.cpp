// SPDX-License-Identifier: Apache-2.0
// Virtual triangles as numbers, and each mirror pixel shaded once (virtual_object_method.h, step 2):
//   1. which triangles are worth drawing: first those that some pixel's centre may lie in, then of these the
//      ones that are what they seem to be;
//   2. their numbers, by GL or, where that is software, by the processor;
//   3. the rectangles of pixels in which each part is seen, shaded;
//   4. masked and blended parts, as surfaces.
// Only the last step needs depths. Without it the environment comes before step 3, which then tests none.
#include <algorithm>

#include "catoptric/core/parallel.h"
#include "catoptric/virtual_object/rivals.h"
#include "catoptric/virtual_object/virtual_object_method.h"

namespace catoptric::virtual_object {

/// Which triangles are drawn: the cheap questions first.
void VirtualObjectMethod::markTriangles(const raster::FrameContext& frame, NumberedMirror& m) {
  const PictureView picture{mat4(m.view.clipFromDraw), m.view.parent->widthPx, m.view.parent->heightPx,
                            m.view.windingFlipped};
  if (!m.prepared)
    makePictureBeam(m.view.clipFromDraw, m.view.drawEye, {picture.widthPx, picture.heightPx}, m.chain->bounds,
                    m.pictureBeam);
  const ReflectedBeams& beams = m.prepared ? m.prepared->solver->reflectedBeams() : m.pictureBeam;
  m.culled = m.runs->mark(beams, m.prepared ? m.chain->drawFromWorld : dmat4(1.0), m.triangles.isKept);
  projectVertices(
      picture, m.virtualPositions, m.screen,
      m.prepared ? std::span<const VertexBits>(m.prepared->mayReflect) : std::span<const VertexBits>());
  m.culled += dropUnseenTriangles(*m.objects, frame.scene.geometry(), picture, m.chain->bounds, m.screen,
                                  m.triangles.isKept);
  if (!m.prepared) return;
  const Prepared& p = *m.prepared;
  raster::dropVirtualTriangles(p.objects, m.view.drawEye, p.virtualPositions, p.kinds, p.reflectionPoints,
                               m.triangles.isKept, {}, findLongestChords(p));
}

void VirtualObjectMethod::drawNumbersByGl(raster::FrameContext& frame, NumberedMirror& m) {
  Prepared& p = *m.prepared;
  if (!p.numbered) p.numbered = std::make_unique<NumberedTriangles>(p.objects);
  raster::gatherVirtualTriangles(p.objects, p.numbered->indices(), m.isNumbered, m.triangles);
  m.drawn = m.triangles.indices.size() / 3;
  ranges_.clear();
  for (const raster::TessellatedPart& part : m.triangles.parts)
    if (part.indexCount > 0) ranges_.push_back({part.part, part.firstIndex, part.indexCount});
  shading_.beginHits(m.chain->bounds);
  p.numbered->draw(frame, m.view, numberProgram_, p.virtualPositions, m.triangles.indices, ranges_);
  shading_.readHits(m.chain->bounds, m.numbers.hits);
}

void VirtualObjectMethod::drawNumbersHere(const raster::FrameContext& frame, NumberedMirror& m,
                                          bool withDepths) const {
  const raster::Level& parent = *m.view.parent;
  const NumberPicture picture{.clipFromDraw = mat4(m.view.clipFromDraw),
                              .drawEye = m.view.drawEye,
                              .widthPx = parent.widthPx,
                              .heightPx = parent.heightPx,
                              .bounds = m.chain->bounds,
                              .mirror = m.inLanes.positions(),
                              .parentIds = frame.parentIds,
                              .parentWord = m.chain->parentWord(),
                              .screen = m.screen,
                              .virtualPositions = m.virtualPositions,
                              .isKept = m.triangles.isKept,
                              .isWanted = m.isNumbered,
                              .triangleParts = m.triangleParts,
                              .withDepths = withDepths,
                              .withRivals = m.prepared != nullptr};  // what a flat mirror shows does not sag
  m.drawn = m.raster.draw(*m.objects, picture, m.numbers);
  settleRivals(m.inLanes.images(), shading_.triangles(), m.numbers);
}

bool VirtualObjectMethod::hasSurfaces(const Prepared& p) {
  return std::any_of(p.objects.parts.begin(), p.objects.parts.end(),
                     [&](const raster::TessellatedPart& part) { return p.isDrawn[part.part] != 0; });
}

bool VirtualObjectMethod::drawNumbered(raster::FrameContext& frame, NumberedMirror& m,
                                       raster::Level& target) {
  const raster::Chain& chain = *m.chain;
  const raster::SurfaceView& view = m.view;
  shading_.prepare(frame.scene, *view.parent);
  // Reading keeps one core busy.
  core::runBeside([&] { markTriangles(frame, m); },
                  [&] {
                    if (!numbersByGl_) m.inLanes.readParent(*view.parent, chain.bounds);
                  });
  const bool isWithSurfaces = m.prepared && hasSurfaces(*m.prepared);
  const bool withDepths = isWithSurfaces || frame.merge != raster::Merge::Ids;
  if (numbersByGl_)
    drawNumbersByGl(frame, m);
  else
    drawNumbersHere(frame, m, withDepths);
  countTriangles(frame, m);
  if (!numbersByGl_ && !withDepths) {
    m.inLanes.shade(frame, chain, shading_.triangles(), {m.numbers.hits, true}, target);
    return true;
  }
  findPartRects(m.triangleParts, chain.bounds, m.numbers.hits, frame.parentIds, view.parent->widthPx,
                chain.parentWord(), rects_);
  if (!numbersByGl_) shading_.uploadHits(chain.bounds, m.numbers.hits, m.numbers.depths);
  if (!withDepths && !rects_.rest.empty())
    background_.draw(frame.scene, chain, *view.parent, target, true, rects_.rest);
  // Edges first: they read one more texture, and llvmpipe shades what was drawn before such a draw begins.
  shading_.shadeVirtual(frame, chain, *view.parent, target, true, rects_.edges, withDepths);
  shading_.shadeVirtual(frame, chain, *view.parent, target, false, rects_.inner, withDepths);
  if (!isWithSurfaces) return !withDepths;
  Prepared& p = *m.prepared;
  raster::gatherVirtualTriangles(p.objects, p.objects.indices, p.isDrawn, m.triangles);
  frame.counters.virtualTriangles += m.triangles.indices.size() / 3;
  if (!m.triangles.indices.empty()) p.pass.drawSelected(frame, view, p.virtualPositions, m.triangles, target);
  return false;
}

VirtualObjectMethod::NumberedMirror& VirtualObjectMethod::beginMirror(std::size_t index,
                                                                      const raster::FrameContext& frame,
                                                                      const raster::Chain& chain,
                                                                      const raster::SurfaceView& view,
                                                                      Prepared* prepared) {
  while (numberedMirrors_.size() <= index) numberedMirrors_.push_back(std::make_unique<NumberedMirror>());
  NumberedMirror& m = *numberedMirrors_[index];
  m.chain = &chain;
  m.view = view;
  m.prepared = prepared;
  if (prepared) {
    m.objects = &prepared->objects;
    m.runs = &prepared->triangleRuns;
    m.virtualPositions = prepared->virtualPositions;
    m.triangleParts = frame.scene.levels().triangleParts();
    m.isNumbered = prepared->isNumbered;
  } else {
    beginFlat(frame, m);
  }
  return m;
}

/// All of the scene but the mirror.
void VirtualObjectMethod::beginFlat(const raster::FrameContext& frame, NumberedMirror& m) {
  const scene::WorldGeometry& world = frame.scene.geometry();
  if (!uncut_) uncut_ = std::make_unique<Uncut>(world);
  m.objects = &uncut_->objects;
  m.runs = &uncut_->runs;
  m.virtualPositions = world.positions;
  m.triangleParts = world.triangleParts;
  m.isNumbered.assign(world.parts.size(), 1);
  m.isNumbered[world.reflectors[m.chain->last].part] = 0;
}

void VirtualObjectMethod::countTriangles(raster::FrameContext& frame, const NumberedMirror& m) {
  frame.counters.culledTriangles += m.culled;
  frame.counters.virtualTriangles += m.drawn;
}

}  // namespace catoptric::virtual_object

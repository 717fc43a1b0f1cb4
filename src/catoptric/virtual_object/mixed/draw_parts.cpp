// SPDX-License-Identifier: Apache-2.0
// Refined in mirrors that are not convex: a virtual object for each interval between foci of each part that
// bends one way, and solver `exact` for what they leave (mixed/README.md).
//
// Steps:
//   1. Which part of the mirror is seen at each pixel (part_image.h).
//   2. For each part that is worth it: virtual vertices by searches within that part, one for each interval;
//      virtual triangles drawn as numbers (number_raster.h).
//   3. Each pixel's ray is held against the triangles whose numbers are there (part_pixels.h); of those that
//      agree the nearest is shaded.
//   4. The others, and pixels of no part, are drawn by solver `exact`, as if the rest of the mirror were not
//      there.
#include <algorithm>
#include <bit>
#include <chrono>

#include "catoptric/core/parallel.h"
#include "catoptric/virtual_object/mixed/view_forecast.h"
#include "catoptric/virtual_object/virtual_object_method.h"

namespace catoptric::virtual_object {
namespace {

gl::Scissor boundsOf(const gl::Scissor& bounds, std::span<const uvec2> numbers, std::uint32_t number,
                     std::size_t& pixels) {
  int x0 = bounds.width, y0 = bounds.height, x1 = -1, y1 = -1;
  pixels = 0;
  for (int y = 0; y < bounds.height; ++y)
    for (int x = 0; x < bounds.width; ++x) {
      if (numbers[std::size_t(y) * std::size_t(bounds.width) + std::size_t(x)].x != number) continue;
      x0 = std::min(x0, x), x1 = std::max(x1, x);
      y0 = std::min(y0, y), y1 = std::max(y1, y);
      ++pixels;
    }
  return {bounds.x + x0, bounds.y + y0, x1 - x0 + 1, y1 - y0 + 1};
}

}  // namespace

bool VirtualObjectMethod::hasCutOuts(const raster::SceneBuffers& scene) {
  for (std::uint32_t part = 0; part < scene.geometry().parts.size(); ++part)
    if ((findCoverFlags(scene, part) & (kCoverMasked | kCoverBlended)) != 0) return true;
  return false;
}

bool VirtualObjectMethod::findPartVertices(raster::FrameContext& frame, const dvec3& drawEye,
                                           InParts::Part& part, Prepared& p) const {
  const auto start = std::chrono::steady_clock::now();
  const auto findReflected = [&](bool canReflect, const auto& search) {
    p.mayReflect.clear();
    if (canReflect) p.runs.findReflected(search.reflectedBeams(), dmat4(1.0), p.mayReflect);
    return canReflect;
  };
  if (part.shape.bend == Bend::Convex) {
    part.setEye(*part.shape.mesh, frame.scene.geometry().bounds, drawEye, solverOptions());
    if (!findReflected(part.solver->canReflect(), *part.solver)) return false;
    part.solver->compute(Solver::Refined, p.objects.positions, p.virtualPositions, p.kinds,
                         p.reflectionPoints, p.mayReflect, &part.places);
  } else {
    if (!part.intervals)
      part.intervals = std::make_unique<IntervalSearch>(*part.shape.mesh, drawEye);
    else if (part.intervals->eye() != drawEye)
      part.intervals->setEye(drawEye);
    if (!findReflected(part.intervals->canReflect(), *part.intervals)) return false;
    part.intervals->compute(p.objects.positions, p.mayReflect, part.isWorthIt, part.found);
  }
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  frame.counters.virtualVerticesMs += spent.count();
  const std::size_t culled = p.runs.countLeftOut(p.mayReflect);
  frame.counters.virtualVertices += p.objects.positions.size() - culled;
  frame.counters.culledVertices += culled;
  return true;
}

void VirtualObjectMethod::drawInterval(raster::FrameContext& frame, const raster::SurfaceView& view,
                                       const RayImages& rays, const PartView& part, std::size_t interval,
                                       const Prepared& p) {
  const scene::WorldGeometry& world = frame.scene.geometry();
  const bool isConvex = part.part.shape.bend == Bend::Convex;
  const IntervalVertices& vertices = part.part.found[interval];
  const std::span<const vec3> positions = isConvex ? p.virtualPositions : vertices.positions;
  if (isConvex)
    raster::markVirtualTriangles(p.objects, view.drawEye, positions, p.kinds, p.reflectionPoints, triangles_);
  else
    markIntervalTriangles(p.objects, vertices, triangles_.isKept);
  // Behind one focus images stand reversed: left is right along one direction only.
  const PictureView picture{mat4(view.clipFromDraw), view.parent->widthPx, view.parent->heightPx,
                            view.windingFlipped != (interval == 1)};
  std::vector<vec3>& screen = intervalScreens_[interval];
  projectVertices(picture, positions, screen);
  const gl::Scissor& bounds = part.bounds;
  frame.counters.culledTriangles +=
      dropUnseenTriangles(p.objects, world, picture, bounds, screen, triangles_.isKept);
  mirrorPositions_.clear();
  for (int y = bounds.y; y < bounds.y + bounds.height; ++y) {
    const auto row = rays.origins.begin() + std::ptrdiff_t(y) * rays.widthPx + bounds.x;
    mirrorPositions_.insert(mirrorPositions_.end(), row, row + bounds.width);
  }
  const NumberPicture numbers{.clipFromDraw = picture.clipFromDraw,
                              .drawEye = view.drawEye,
                              .widthPx = picture.widthPx,
                              .heightPx = picture.heightPx,
                              .bounds = bounds,
                              .mirror = mirrorPositions_,
                              .parentIds = rays.words,
                              .parentWord = partPixels_.word,
                              .screen = screen,
                              .virtualPositions = positions,
                              .isKept = triangles_.isKept,
                              .isWanted = p.isNumbered,
                              .triangleParts = world.triangleParts};
  frame.counters.virtualTriangles += raster_.draw(p.objects, numbers, numbers_);
  // 3
  confirmPixels(world, rays, {bounds, numbers_, part.number}, partPixels_);
}

/// Which parts are worth a virtual object, for a new eye. True if any is.
bool VirtualObjectMethod::forecastParts(const raster::FrameContext& frame, const raster::Chain& chain,
                                        const dvec3& drawEye, Prepared& p) {
  if (!p.inParts) p.inParts = std::make_unique<InParts>(p.mesh);
  InParts& inParts = *p.inParts;
  const double pixelsPerTangent = 0.5 * frame.camera.heightPx / frame.camera.tanHalfFovY;
  const InParts::Judged now{drawEye, pixelsPerTangent, frame.allParts};
  const auto isAnyWorthIt = [&] {
    return std::any_of(inParts.parts.begin(), inParts.parts.end(),
                       [](const InParts::Part& part) { return part.isAnyWorthIt(); });
  };
  if (inParts.judged == now) return isAnyWorthIt();
  inParts.judged = now;
  const scene::WorldGeometry& world = frame.scene.geometry();
  std::vector<const MirrorPart*> shapes;
  for (const InParts::Part& part : inParts.parts) shapes.push_back(&part.shape);
  const SceneRays rays{exact_.findHierarchy(frame), world.triangleParts, world.reflectors[chain.last].part};
  const std::vector<PartForecast> forecasts = forecastView(shapes, rays, drawEye, pixelsPerTangent);
  const auto isChosen = chooseParts(shapes, forecasts, p.objects.positions.size(), frame.allParts);
  for (std::size_t k = 0; k < shapes.size(); ++k)
    for (std::size_t i = 0; i < kIntervals; ++i)
      inParts.parts[k].isWorthIt[i] = isChosen[k] != 0 && forecasts[k].shows(i);
  return isAnyWorthIt();
}

/// Steps 1 to 3.
void VirtualObjectMethod::drawPartNumbers(raster::FrameContext& frame, const raster::Chain& chain,
                                          const raster::SurfaceView& view, const RayImages& rays,
                                          Prepared& p) {
  if (!partImage_ || !partImage_->fits(view.parent->widthPx, view.parent->heightPx))
    partImage_ = std::make_unique<PartImage>(view.parent->widthPx, view.parent->heightPx);
  // 1
  partImage_->drawParts(p.inParts->buffers, mat4(view.clipFromDraw), chain.bounds);
  partImage_->readParts(chain.bounds, partNumbers_);
  partPixels_.bounds = chain.bounds;
  partPixels_.word = chain.parentWord();
  partPixels_.partNumbers = partNumbers_;
  partPixels_.confirmed.hits.assign(partNumbers_.size(), uvec2(0));
  partPixels_.confirmed.depths.assign(partNumbers_.size(), 1.0f);
  // 2
  for (std::size_t k = 0; k < p.inParts->parts.size(); ++k) {
    InParts::Part& part = p.inParts->parts[k];
    if (!part.isAnyWorthIt()) continue;
    std::size_t pixels = 0;
    const auto number = std::uint32_t(k + 1);
    const gl::Scissor bounds = boundsOf(chain.bounds, partNumbers_, number, pixels);
    if (pixels == 0 || !findPartVertices(frame, view.drawEye, part, p)) continue;
    for (std::size_t i = 0; i < kIntervals; ++i)
      if (part.isWorthIt[i]) drawInterval(frame, view, rays, {part, number, bounds}, i, p);
    if (part.shape.bend != Bend::Convex)
      drawIncomplete(p.objects, frame.scene.geometry(), rays,
                     {part.isWorthIt, part.found, intervalScreens_, *part.shape.mesh, view.clipFromDraw,
                      view.drawEye, view.parent->widthPx, view.parent->heightPx,
                      0.5 * frame.camera.heightPx / frame.camera.tanHalfFovY, bounds, number},
                     partPixels_);
  }
}

void VirtualObjectMethod::drawInParts(raster::FrameContext& frame, const raster::Chain& chain,
                                      const raster::SurfaceView& view, const raster::Level& parent,
                                      raster::Level& target, Prepared& p) {
  if (!forecastParts(frame, chain, view.drawEye, p)) {
    frame.counters.boundedPixels += chain.pixels;
    exact_.render(frame, chain, parent, target);
    return;
  }
  const scene::WorldGeometry& world = frame.scene.geometry();
  const RayImages& rays = exact_.findRays(frame, chain, parent);
  drawPartNumbers(frame, chain, view, rays, p);
  const std::vector<uvec2>& hits = partPixels_.confirmed.hits;
  isDone_.resize(hits.size());
  for (std::size_t i = 0; i < hits.size(); ++i) isDone_[i] = hits[i].x != 0 ? 1 : 0;
  const auto done = std::size_t(std::count(isDone_.begin(), isDone_.end(), std::uint8_t(1)));
  frame.counters.virtualPixels += done;
  frame.counters.boundedPixels += chain.pixels - done;
  // 4
  if (const HitImage* rest = exact_.findHits(frame, chain, isDone_)) {
    LaneShading& lanes = shading_.inLanes();  // findRays() has read the level
    std::vector<uvec2>& all = partPixels_.confirmed.hits;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const uvec2 hit = rest->hits[i];
      if (isDone_[i] != 0 || hit.x == 0) continue;
      const float path = lanes.positions()[i].w + std::bit_cast<float>(hit.y);
      all[i] = uvec2(hit.x, std::bit_cast<std::uint32_t>(path));
    }
    lanes.shade(frame, chain, shading_.triangles(), {all, true}, target);
    return;
  }
  partImage_->setDone(chain.bounds, isDone_);
  shading_.uploadHits(chain.bounds, hits, partPixels_.confirmed.depths);
  findPartRects(world.triangleParts, chain.bounds, hits, frame.parentIds, parent.widthPx, chain.parentWord(),
                rects_);
  shading_.shadeVirtual(frame, chain, parent, target, false, rects_.inner);
  shading_.shadeVirtual(frame, chain, parent, target, true, rects_.edges);
  exact_.drawRest(frame, chain, parent, target, partImage_.get());
}

}  // namespace catoptric::virtual_object

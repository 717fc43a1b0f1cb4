// SPDX-License-Identifier: Apache-2.0
// Refined in mirrors that are not convex: a virtual object for each part that bends one way, and solver
// `exact` for what they leave (mixed/README.md).
//
// Steps:
//   1. Which part of the mirror is seen at each pixel (part_image.h).
//   2. For each part that is worth it: virtual vertices by a search within that part, virtual triangles drawn
//      as numbers at that part's pixels.
//   3. Each pixel's ray is held against the triangle whose number is there (part_pixels.h); those that agree
//      are shaded.
//   4. The others, and pixels of no part, are drawn by solver `exact`, as if the rest of the mirror were not
//      there.
#include <algorithm>
#include <chrono>

#include "catoptric/core/parallel.h"
#include "catoptric/virtual_object/virtual_object_method.h"

namespace catoptric::virtual_object {
namespace {

constexpr int kPartsUnit = raster::kUnitFirstFree + 4;  // behind the images of the level before

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

/// Does the triangle turn a face that is seen to where its corners are reflected?
bool facesMirror(const vec3 q[3], const vec3 j[3]) {
  const vec3 normal = glm::cross(q[1] - q[0], q[2] - q[0]);
  return glm::dot(normal, j[0] - q[0]) > 0 || glm::dot(normal, j[1] - q[1]) > 0 ||
         glm::dot(normal, j[2] - q[2]) > 0;
}

}  // namespace

bool VirtualObjectMethod::hasCutOuts(const raster::SceneBuffers& scene) {
  for (std::uint32_t part = 0; part < scene.geometry().parts.size(); ++part)
    if ((findCoverFlags(scene, part) & (kCoverMasked | kCoverBlended)) != 0) return true;
  return false;
}

void VirtualObjectMethod::markPartTriangles(const scene::WorldGeometry& world, const Prepared& p) {
  triangles_.isKept.resize(p.objects.indices.size() / 3);
  for (const raster::TessellatedPart& part : p.objects.parts) {
    const bool isTwoSided = world.parts[part.part].isSeenFromBehind;
    core::parallelFor(part.indexCount / 3, 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = part.firstIndex / 3 + begin; t < part.firstIndex / 3 + end; ++t) {
        const std::uint32_t* v = &p.objects.indices[3 * t];
        int reflected = 0, none = 0;
        vec3 q[3], j[3];
        for (int k = 0; k < 3; ++k) {
          reflected += p.kinds[v[k]] == VertexKind::Reflected;
          none += p.kinds[v[k]] == VertexKind::None;
          q[k] = p.objects.positions[v[k]], j[k] = p.reflectionPoints[v[k]];
        }
        triangles_.isKept[t] = none == 0 && reflected > 0 && (isTwoSided || facesMirror(q, j));
      }
    });
  }
}

void VirtualObjectMethod::findPartVertices(raster::FrameContext& frame, const dvec3& drawEye,
                                           InParts::Part& part, Prepared& p) const {
  part.setEye(*part.shape.mesh, frame.scene.geometry().bounds, drawEye, solverOptions());
  p.mayReflect.clear();
  if (part.solver->canReflect())
    findReflectedRuns(p.runs, part.solver->reflectedCone(), dmat4(1.0), p.mayReflect);
  part.solver->compute(Solver::Refined, p.objects.positions, p.virtualPositions, p.kinds, p.reflectionPoints,
                       p.mayReflect, &part.places);
  const std::size_t culled = p.runs.countLeftOut(p.mayReflect);
  frame.counters.virtualVertices += p.objects.positions.size() - culled;
  frame.counters.culledVertices += culled;
}

void VirtualObjectMethod::drawPart(raster::FrameContext& frame, const raster::SurfaceView& view,
                                   const gl::Scissor& bounds, std::uint32_t number, InParts::Part& part,
                                   Prepared& p) {
  const scene::WorldGeometry& world = frame.scene.geometry();
  const bool isConvex = part.shape.bend == Bend::Convex;
  if (isConvex)
    raster::markVirtualTriangles(p.objects, view.drawEye, p.virtualPositions, p.kinds, p.reflectionPoints,
                                 triangles_);
  else
    markPartTriangles(world, p);
  const PictureView picture{mat4(view.clipFromDraw), view.parent->widthPx, view.parent->heightPx,
                            view.windingFlipped, !isConvex};
  projectVertices(picture, p.virtualPositions, screen_);
  frame.counters.culledTriangles +=
      dropUnseenTriangles(p.objects, world, picture, bounds, screen_, triangles_.isKept);
  raster::gatherVirtualTriangles(p.objects, p.numbered->indices(), p.isNumbered, triangles_);
  frame.counters.virtualTriangles += triangles_.indices.size() / 3;
  ranges_.clear();
  for (const raster::TessellatedPart& run : triangles_.parts)
    if (run.indexCount > 0) ranges_.push_back({run.part, run.firstIndex, run.indexCount});
  partNumberProgram_->use();
  partImage_->numbers().bind(kPartsUnit);
  partNumberProgram_->set("u_parts", kPartsUnit);
  partNumberProgram_->set("u_part", number);
  gl::setScissor(bounds);
  p.numbered->draw(frame, view, *partNumberProgram_, p.virtualPositions, triangles_.indices, ranges_,
                   !isConvex);
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
                       [](const InParts::Part& part) { return part.isWorthIt; });
  };
  if (inParts.judged == now) return isAnyWorthIt();
  inParts.judged = now;
  const scene::WorldGeometry& world = frame.scene.geometry();
  std::vector<const MirrorPart*> shapes;
  for (const InParts::Part& part : inParts.parts) shapes.push_back(&part.shape);
  const SceneRays rays{exact_.findHierarchy(frame), world.triangleParts, world.reflectors[chain.last].part};
  const std::vector<PartForecast> forecasts = forecastView(shapes, rays, drawEye, pixelsPerTangent);
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    const PartCosts costs = expectCosts(forecasts[k], shapes[k]->bend, p.objects.positions.size(),
                                        shapes[k]->mesh->ordinaryCount());
    inParts.parts[k].isWorthIt =
        forecasts[k].suitsVirtualObject() && (frame.allParts || costs.virtualMs < costs.boundMs);
  }
  return isAnyWorthIt();
}

/// Steps 1 and 2.
void VirtualObjectMethod::drawPartNumbers(raster::FrameContext& frame, const raster::Chain& chain,
                                          const raster::SurfaceView& view, Prepared& p) {
  if (!partImage_ || !partImage_->fits(view.parent->widthPx, view.parent->heightPx))
    partImage_ = std::make_unique<PartImage>(view.parent->widthPx, view.parent->heightPx);
  if (!partNumberProgram_)
    partNumberProgram_ = std::make_unique<gl::Program>("virtual_object/virtual_triangle.vert",
                                                       "virtual_object/virtual_triangle.frag",
                                                       std::vector<std::string>{"PART"});
  if (!p.numbered) p.numbered = std::make_unique<NumberedTriangles>(p.objects);
  // 1
  partImage_->drawParts(p.inParts->buffers, mat4(view.clipFromDraw), chain.bounds);
  partImage_->readParts(chain.bounds, partNumbers_);
  // 2
  shading_.beginHits(chain.bounds);
  for (std::size_t k = 0; k < p.inParts->parts.size(); ++k) {
    InParts::Part& part = p.inParts->parts[k];
    if (!part.isWorthIt) continue;
    std::size_t pixels = 0;
    const gl::Scissor bounds = boundsOf(chain.bounds, partNumbers_, std::uint32_t(k + 1), pixels);
    if (pixels == 0) continue;
    const auto start = std::chrono::steady_clock::now();
    findPartVertices(frame, view.drawEye, part, p);
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
    frame.counters.virtualVerticesMs += spent.count();
    if (!part.solver->canReflect()) continue;
    shading_.continueHits(bounds);
    drawPart(frame, view, bounds, std::uint32_t(k + 1), part, p);
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
  drawPartNumbers(frame, chain, view, p);
  // 3
  shading_.readHits(chain.bounds, numbers_.hits);
  isDone_.resize(numbers_.hits.size());
  const std::size_t done = checkPixels(world, rays, chain.bounds, chain.parentWord(), numbers_.hits, isDone_);
  frame.counters.virtualPixels += done;
  frame.counters.boundedPixels += chain.pixels - done;
  partImage_->setDone(chain.bounds, isDone_);
  shading_.continueHits(chain.bounds);
  partImage_->dropHits(chain.bounds);
  findPartRects(world.triangleParts, chain.bounds, numbers_.hits, frame.parentIds, parent.widthPx,
                chain.parentWord(), rects_);
  shading_.shadeVirtual(frame, chain, parent, target, false, rects_.inner);
  shading_.shadeVirtual(frame, chain, parent, target, true, rects_.edges);
  // 4
  exact_.renderRest(frame, chain, parent, target, isDone_, *partImage_);
}

}  // namespace catoptric::virtual_object

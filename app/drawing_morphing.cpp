// SPDX-License-Identifier: Apache-2.0
// What reflection morphing works with (2004). Sampling locations are baked around the eye, as far apart as
// --spacing says: those that the method chooses by itself are too near to each other to be seen.
#include "catoptric/core/error.h"
#include "catoptric/raster/tessellation.h"
#include "catoptric/sketch/morphing_sketch.h"
#include "drawing.h"

namespace catoptric::app {
namespace {

using namespace reflection_morphing;

/// One cell, the eye a third of the way into it.
std::unique_ptr<OnTheFly> bakeAround(const Drawing& drawing) {
  BakePlan plan;
  const double spacing = drawing.options.spacing;
  const dvec3 lower = drawing.camera.eye - spacing * dvec3(0.35, 0.4, 0.3);
  plan.grid = {{lower, lower + spacing}, glm::uvec3(2)};
  plan.options.octree.box = makeLookUpBox(drawing.world());
  return std::make_unique<OnTheFly>(drawing.world(), plan);
}

dvec3 choosePoint(const Drawing& drawing, const scene::Reflector& reflector) {
  if (!drawing.options.points.empty()) return drawing.options.points.front();
  const dvec3 towards = glm::normalize(drawing.camera.eye - reflector.centre);
  return reflector.centre + 2.0 * reflector.radius * glm::normalize(towards + drawing.viewer().right);
}

}  // namespace

core::ImageRgba8 drawCameraRays(Drawing& drawing) {
  const MirrorRays rays(drawing.world(), true);
  const std::uint32_t first = findReflector(drawing, false);
  const auto sketch =
      sketch::sketchCameraRays(rays, drawing.viewer(), drawing.options.count, drawing.frame.bounces);
  return drawFromAside(drawing, sketch, drawing.world().reflectors[first].centre);
}

core::ImageRgba8 drawSamplingCell(Drawing& drawing) {
  const std::uint32_t reflector = findReflector(drawing, false);
  const scene::Reflector& mirror = drawing.world().reflectors[reflector];
  const auto source = bakeAround(drawing);
  const auto loaded = sketch::loadCell(*source, drawing.camera.eye);
  const dvec3 point = choosePoint(drawing, mirror);
  return drawFromAside(drawing, sketch::sketchMorphedVertex(loaded, {reflector}, drawing.camera.eye, point),
                       mirror.centre);
}

core::ImageRgba8 drawRayOctree(Drawing& drawing) {
  const std::uint32_t reflector = findReflector(drawing, false);
  const scene::Reflector& mirror = drawing.world().reflectors[reflector];
  const auto source = bakeAround(drawing);
  const auto loaded = sketch::loadCell(*source, drawing.camera.eye);
  const SampledTrace* trace = loaded.locations[0]->findTrace({reflector});
  if (trace == nullptr)
    throw core::Error("draw.not_seen", "the mirror is not seen from the sampling location", {},
                      "try another --eye");
  const RayOctreeStatistics statistics = measure(trace->octree);
  drawing.facts["leaves"] = statistics.leaves;
  drawing.facts["rays"] = statistics.rays;
  drawing.facts["most_rays"] = statistics.mostRays;
  return drawFromAside(drawing, sketch::sketchRayOctree(*trace, choosePoint(drawing, mirror)), mirror.centre);
}

core::ImageRgba8 drawReflectionMesh(Drawing& drawing) {
  const std::uint32_t reflector = findReflector(drawing, false);
  const auto source = bakeAround(drawing);
  const auto loaded = sketch::loadCell(*source, drawing.camera.eye);
  const raster::TessellatedObjects objects = raster::tessellateForReflector(
      drawing.world(), reflector,
      {.maxErrorPx = drawing.frame.maxErrorPx,
       .reflectorDiameterPx = raster::findTessellationSize(drawing.world().reflectors[reflector],
                                                           drawing.camera.eye, drawing.viewer())});
  const auto sketch = sketch::sketchReflectionMesh(loaded, {reflector}, drawing.camera.eye, objects);
  drawing.facts["virtual_triangles"] = sketch.lines.size() / 3;
  return drawOverView(drawing, sketch, renderer::Method::Morphing, 0.4f);
}

}  // namespace catoptric::app

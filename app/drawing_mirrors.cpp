// SPDX-License-Identifier: Apache-2.0
// What virtual objects work with (1998, 1999).
#include <algorithm>
#include <array>
#include <limits>

#include "catoptric/core/error.h"
#include "catoptric/raster/tessellation.h"
#include "catoptric/sketch/mirror_sketch.h"
#include "catoptric/sketch/section.h"
#include "catoptric/virtual_object/mixed/interval_search.h"
#include "catoptric/virtual_object/mixed/mirror_parts.h"
#include "drawing.h"

namespace catoptric::app {
namespace {

using virtual_object::ReflectorMesh;
using virtual_object::VirtualObjectSolver;

/// The mesh and the maps of one curved mirror. With a skirt only where it is drawn for what it is.
struct MirrorMaps {
  MirrorMaps(const Drawing& drawing, std::uint32_t reflector, double farRadius = 0)
      : mesh(drawing.world(), reflector),
        solver(mesh, drawing.camera.eye, farRadius > 0 ? farRadius : wholeScene(drawing)) {}

  [[nodiscard]] double wholeScene(const Drawing& drawing) const {
    const core::Box& bounds = drawing.world().bounds;
    return glm::length(bounds.centre() - mesh.centre()) + bounds.radius();
  }

  ReflectorMesh mesh;
  VirtualObjectSolver solver;
};

sketch::Section makeSection(const Drawing& drawing, const ReflectorMesh& mesh) {
  const scene::CameraFrame viewer = drawing.viewer();
  return sketch::makeSection(mesh, drawing.camera.eye, -viewer.right, drawing.options.width,
                             2 * drawing.frame.widthPx, 2 * drawing.frame.heightPx);
}

/// In the plane of the section: up is to the viewer's left.
core::ImageRgba8 drawInSection(const sketch::Section& section, sketch::Sketch sketch,
                               core::ImageRgba8 picture) {
  for (sketch::Line& line : sketch.lines) line.widthPx *= 2;
  for (sketch::Dot& dot : sketch.dots) dot.radiusPx *= 2;
  sketch::DistanceImage distances(picture.width(), picture.height(), std::numeric_limits<float>::infinity());
  sketch::drawSketch(sketch, section.makeCamera(), picture, distances);
  return sketch::halve(picture);
}

/// The point asked about, in the plane; without one beside and before the mirror.
dvec3 choosePoint(const Drawing& drawing, const ReflectorMesh& mesh, const sketch::Section& section) {
  if (!drawing.options.points.empty()) return section.project(drawing.options.points.front());
  return mesh.centre() + mesh.bodyRadius() * (-1.3 * section.right + 1.5 * section.up);
}

/// The far sphere is drawn round what the picture shows; round the whole scene it would lie outside of it.
double findShownRadius(const sketch::Section& section) {
  return 0.45 * section.width * section.heightPx / section.widthPx;
}

/// Without rays.
sketch::Sketch sketchOutline(const ReflectorMesh& mesh, const dvec3& eye, const sketch::Section& section) {
  sketch::Sketch sketch = sketch::sketchProfile(mesh, eye, section, 0);
  std::erase_if(sketch.lines, [](const sketch::Line& line) { return line.colour != sketch::kBlack; });
  return sketch;
}

core::ImageRgba8 drawLookUps(Drawing& drawing, bool withFarMap) {
  const ReflectorMesh mesh(drawing.world(), findReflector(drawing, false));
  const sketch::Section section = makeSection(drawing, mesh);
  const VirtualObjectSolver solver(mesh, drawing.camera.eye, findShownRadius(section));
  const dvec3 point = choosePoint(drawing, mesh, section);
  sketch::Sketch sketch = sketchOutline(mesh, drawing.camera.eye, section);
  sketch.add(sketch::sketchLookUp(solver, point, section, withFarMap));
  core::ImageRgba8 picture(section.widthPx, section.heightPx, glm::u8vec4(255));
  return drawInSection(section, std::move(sketch), std::move(picture));
}

/// By part: whether one of the objects asked for belongs to it.
std::vector<std::uint8_t> chooseParts(const Drawing& drawing) {
  const scene::WorldGeometry& world = drawing.world();
  std::vector<std::uint8_t> parts(world.parts.size(), drawing.options.objects.empty() ? 1 : 0);
  for (const std::string& name : drawing.options.objects) {
    bool isThere = false;
    for (std::size_t p = 0; p < world.parts.size(); ++p)
      if (drawing.loaded.scene.instances[world.parts[p].object].name == name) parts[p] = 1, isThere = true;
    if (!isThere)
      throw core::Error("draw.no_object", "'" + drawing.loaded.source + "' has no object '" + name + "'", {},
                        "objects have the names of the scene's nodes");
  }
  return parts;
}

}  // namespace

core::ImageRgba8 drawExplosionMaps(Drawing& drawing) {
  const MirrorMaps maps(drawing, findReflector(drawing, false));
  drawing.facts["triangles"] = maps.mesh.ordinaryCount();
  drawing.facts["near_radius"] = maps.solver.nearMap().radius;
  drawing.facts["far_radius"] = maps.solver.farMap().radius;
  return sketch::drawMaps(maps.solver);
}

core::ImageRgba8 drawSubdivision(Drawing& drawing) {
  const MirrorMaps maps(drawing, findReflector(drawing, false));
  const sketch::Section section = makeSection(drawing, maps.mesh);
  sketch::Sketch sketch =
      sketch::sketchProfile(maps.mesh, drawing.camera.eye, section, drawing.options.count);
  for (const dvec3& point : drawing.options.points)
    sketch.add(sketch::sketchReflectedPoint(maps.solver, section.project(point)));
  sketch::Section asked = section;  // a cell a final pixel: asking is what takes time
  asked.widthPx /= 2, asked.heightPx /= 2;
  const core::ImageRgba8 cells = sketch::drawCells(maps.mesh, drawing.camera.eye, asked);
  return drawInSection(section, std::move(sketch), sketch::enlarge(cells, 2));
}

core::ImageRgba8 drawMapping(Drawing& drawing) {
  constexpr double kShare = 0.72;  // which point of the front
  const ReflectorMesh mesh(drawing.world(), findReflector(drawing, false));
  const sketch::Section section = makeSection(drawing, mesh);
  const VirtualObjectSolver solver(mesh, drawing.camera.eye, findShownRadius(section));
  sketch::Sketch sketch = sketchOutline(mesh, drawing.camera.eye, section);
  sketch.add(sketch::sketchMapping(mesh, drawing.camera.eye, solver.farMap(), section, kShare));
  core::ImageRgba8 picture(section.widthPx, section.heightPx, glm::u8vec4(255));
  return drawInSection(section, std::move(sketch), std::move(picture));
}

core::ImageRgba8 drawNearLookUp(Drawing& drawing) {
  return drawLookUps(drawing, false);
}

core::ImageRgba8 drawLookUp(Drawing& drawing) {
  return drawLookUps(drawing, true);
}

core::ImageRgba8 drawCell(Drawing& drawing) {
  const MirrorMaps maps(drawing, findReflector(drawing, false));
  const dvec3 towards = glm::normalize(drawing.camera.eye - maps.mesh.centre());
  const dvec3 point = drawing.options.points.empty()
                          ? maps.mesh.centre() + 3.0 * maps.mesh.bodyRadius() *
                                                     glm::normalize(towards + drawing.viewer().right)
                          : drawing.options.points.front();
  const auto triangle = sketch::findTriangleOf(maps.solver, point);
  const double length = drawing.options.width > 0 ? drawing.options.width : 2.5 * maps.mesh.bodyRadius();
  const auto cell =
      triangle ? sketch::sketchCell(maps.mesh, drawing.camera.eye, *triangle, length) : std::nullopt;
  if (!cell)
    throw core::Error("draw.not_reflected", "the eye does not see that point in the mirror", {},
                      "try another --point");
  drawing.facts["triangle"] = *triangle;
  return drawFromAside(drawing, *cell, maps.mesh.centre());
}

namespace {

/// Of a mirror that is not convex: a virtual object for each part and each interval between foci.
sketch::Sketch sketchIntervals(Drawing& drawing, const ReflectorMesh& mesh,
                               const raster::TessellatedObjects& objects) {
  using namespace virtual_object;
  sketch::Sketch sketch;
  std::array<std::size_t, kIntervals> counts{};
  const std::vector<std::uint8_t> isWanted(drawing.world().parts.size(), 1);
  for (const MirrorPart& part : cutIntoParts(mesh).parts) {
    const IntervalSearch search(*part.mesh, drawing.camera.eye);
    if (!search.canReflect()) continue;
    std::array<IntervalVertices, kIntervals> found;
    search.compute(objects.positions, {}, {true, true, true}, found);
    for (std::size_t k = 0; k < kIntervals; ++k) {
      raster::VirtualTriangles triangles;
      markIntervalTriangles(objects, found[k], triangles.isKept);
      raster::gatherVirtualTriangles(objects, objects.indices, isWanted, triangles);
      counts[k] += triangles.indices.size() / 3;
      sketch.add(sketch::sketchVirtualTriangles(found[k].positions, triangles, true));
    }
  }
  drawing.facts["virtual_triangles"] = counts[0] + counts[1] + counts[2];
  drawing.facts["by_interval"] = counts;
  return sketch;
}

sketch::Sketch sketchVirtualObject(Drawing& drawing, const VirtualObjectSolver& solver,
                                   const raster::TessellatedObjects& objects) {
  std::vector<vec3> drawn(objects.positions.size()), points(drawn.size());
  std::vector<raster::VertexKind> kinds(drawn.size());
  solver.compute(virtual_object::Solver::Refined, objects.positions, drawn, kinds, points);
  raster::VirtualTriangles triangles;
  raster::selectVirtualTriangles(objects, drawing.camera.eye, drawn, kinds, points, triangles);
  drawing.facts["virtual_triangles"] = triangles.indices.size() / 3;
  return sketch::sketchVirtualTriangles(drawn, triangles, true);
}

}  // namespace

core::ImageRgba8 drawVirtualObject(Drawing& drawing) {
  const std::uint32_t reflector = findReflector(drawing, false);
  const MirrorMaps maps(drawing, reflector);
  const std::vector<std::uint8_t> parts = chooseParts(drawing);
  const raster::TessellatedObjects objects = raster::tessellateForReflector(
      drawing.world(), reflector,
      {.maxErrorPx = drawing.frame.maxErrorPx, .reflectorDiameterPx = 175, .parts = parts});
  sketch::Sketch sketch = maps.mesh.isConvex() ? sketchVirtualObject(drawing, maps.solver, objects)
                                               : sketchIntervals(drawing, maps.mesh, objects);
  sketch.add(
      sketch::sketchRays(maps.mesh, drawing.camera.eye, drawing.options.count, 2.0 * maps.mesh.bodyRadius()));
  for (const dvec3& point : drawing.options.points)
    sketch.add(sketch::sketchReflectedPoint(maps.solver, point));
  return drawFromAside(drawing, sketch, maps.mesh.centre());
}

}  // namespace catoptric::app

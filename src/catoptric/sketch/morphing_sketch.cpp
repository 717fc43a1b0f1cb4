// SPDX-License-Identifier: Apache-2.0
#include "catoptric/sketch/morphing_sketch.h"

#include <algorithm>
#include <cmath>

#include "catoptric/core/error.h"
#include "catoptric/sketch/mirror_sketch.h"

namespace catoptric::sketch {

using namespace reflection_morphing;

namespace {

constexpr Colour kBounceColours[] = {kGrey, kRed, kBlue, kGreen, kOrange, kViolet};

const Colour& colourOfBounce(std::size_t bounce) {
  return kBounceColours[std::min(bounce, std::size(kBounceColours) - 1)];
}

/// Length of the ray inside of the box, from a point in it.
double findExit(const core::Box& box, const dvec3& from, const dvec3& direction) {
  double exit = 1e300;
  for (int axis = 0; axis < 3; ++axis) {
    const double side = direction[axis] > 0 ? box.upper[axis] : box.lower[axis];
    if (direction[axis] != 0) exit = std::min(exit, (side - from[axis]) / direction[axis]);
  }
  return std::max(exit, 0.0);
}

/// Calls visit(box, node) for each leaf.
template <class Visit>
void visitLeaves(const RayOctree& octree, std::size_t node, const core::Box& box, const Visit& visit) {
  const RayOctree::Node& n = octree.nodes[node];
  if (n.count > 0) return visit(box, n);
  for (std::uint32_t k = 0; k < 8; ++k) {
    const dvec3 side(k & 1, (k >> 1) & 1, k >> 2), half = 0.5 * (box.upper - box.lower);
    visitLeaves(octree, n.first + k, {box.lower + side * half, box.lower + (side + 1.0) * half}, visit);
  }
}

}  // namespace

Sketch sketchCameraRays(const MirrorRays& rays, const scene::CameraFrame& camera, int count, int bounces) {
  Sketch sketch;
  const core::Box& bounds = rays.world().bounds;
  for (int i = 0; i < count; ++i) {
    const dvec3 direction =
        glm::normalize(camera.rayDirection((i + 0.5) * camera.widthPx / count, 0.5 * camera.heightPx));
    ReflectedRay last;
    last.origin = camera.eye, last.direction = direction;
    std::size_t bounce = 0;
    rays.follow(camera.eye, direction, bounces, std::size_t(bounces), [&](const ReflectedRay& ray) {
      sketch.addLine(last.origin, ray.origin, colourOfBounce(bounce++), 1.5f);
      sketch.addDot(ray.origin, kBlack, 2.5f);
      last = ray;
    });
    const double length = std::min(rays.findObstacle(last), findExit(bounds, last.origin, last.direction));
    sketch.addLine(last.origin, last.origin + length * last.direction, colourOfBounce(bounce), 1.5f);
  }
  return sketch;
}

CellTrace LoadedCell::findTrace(const Trace& trace) const {
  CellTrace found{};
  for (std::size_t k = 0; k < 8; ++k) found[k] = locations[k]->findTrace(trace);
  return found;
}

LoadedCell loadCell(const LocationSource& source, const dvec3& eye) {
  const auto cell = source.grid().findCell(eye);
  if (!cell) throw core::Error("sketch.outside", "the eye is outside of the grid of sampling locations");
  LoadedCell loaded{*cell, {}};
  for (std::size_t k = 0; k < 8; ++k) loaded.locations[k] = source.load(cell->locations[k]);
  return loaded;
}

Sketch sketchMorphedVertex(const LoadedCell& loaded, const Trace& trace, const dvec3& eye,
                           const dvec3& vertex) {
  Sketch sketch;
  core::Box box;
  for (const auto& location : loaded.locations) box.add(location->position);
  sketch.addBox(box, kBlack, 2);
  const CellTrace corners = loaded.findTrace(trace);
  const vec3 point(vertex);
  const std::uint32_t triangle[] = {0, 0, 0};
  CornerPoints found;
  lookUpCorners(corners, {&point, 1}, triangle, found);
  sketch.addDot(vertex, kRed, 6);
  sketch.addDot(eye, kBlack, 6);
  if (found.kinds[0] == raster::VertexKind::None) return sketch;
  for (std::size_t k = 0; k < 8; ++k) {
    sketch.addDot(loaded.locations[k]->position, kOrange, 4);
    if (corners[k] == nullptr) continue;
    const dvec3 mirror = dvec3(vec3(found.points[0][k]));
    sketch.addLine(loaded.locations[k]->position, mirror, kOrange, 1.2f);
    sketch.addLine(mirror, vertex, kOrange, 1.2f);
    sketch.addDot(mirror, kOrange, 3);
  }
  vec3 drawn, mirror;
  morphVertices(vec3(eye), weighTrace(corners, loaded.cell.weights), found, {&drawn, 1}, {&mirror, 1});
  sketch.addLine(eye, mirror, kBlack);
  sketch.addLine(mirror, vertex, kRed);
  sketch.addLine(mirror, drawn, kBlue);
  sketch.addDot(mirror, kBlack, 4);
  sketch.addDot(drawn, kBlue, 6);
  return sketch;
}

Sketch sketchRayOctree(const SampledTrace& trace, const dvec3& point) {
  Sketch sketch;
  const RayOctree& octree = trace.octree;
  if (octree.nodes.empty()) return sketch;
  const core::Box root{dvec3(octree.lower), dvec3(octree.upper)};
  visitLeaves(octree, 0, root, [&](const core::Box& box, const RayOctree::Node& node) {
    const bool isOf =
        glm::all(glm::greaterThanEqual(point, box.lower)) && glm::all(glm::lessThanEqual(point, box.upper));
    if (isOf) sketch.addBox(box, kRed, 3);
    // Leaves of the whole depth only, near the point's own height: all of them would hide each other.
    const double height = box.upper.y - box.lower.y;
    if (!isOf && std::abs(point.y - 0.5 * (box.lower.y + box.upper.y)) <= 0.5 * height)
      sketch.addBox(box, colourOfNumber(node.count, 0.8f), 1);
  });
  const vec3 at(point);
  const vec3& location = trace.table.location;
  for (const std::uint32_t index : octree.findLeaf(at)) {
    const OctreeRay& ray = octree.rays[index];
    const double length = glm::length(dvec3(ray.origin) - point) * 1.1;
    sketch.addLine(location, ray.origin, kGrey, 1.2f);
    sketch.addLine(ray.origin, dvec3(ray.origin) + length * dvec3(ray.direction), kRed, 1.2f);
  }
  sketch.addDot(findNearestRay(octree, octree.findLeaf(at), at).origin, kBlack, 4);
  sketch.addDot(location, kBlack, 6);
  sketch.addDot(point, kRed, 6);
  return sketch;
}

Sketch sketchReflectionMesh(const LoadedCell& loaded, const Trace& trace, const dvec3& eye,
                            const raster::TessellatedObjects& objects) {
  const CellTrace corners = loaded.findTrace(trace);
  CornerPoints found;
  lookUpCorners(corners, objects.positions, objects.indices, found);
  std::vector<vec3> drawn(objects.positions.size()), mirror(objects.positions.size());
  morphVertices(vec3(eye), weighTrace(corners, loaded.cell.weights), found, drawn, mirror);
  raster::VirtualTriangles triangles;
  raster::selectVirtualTriangles(objects, eye, drawn, found.kinds, mirror, triangles);
  return sketchVirtualTriangles(drawn, triangles, false);
}

}  // namespace catoptric::sketch

// SPDX-License-Identifier: Apache-2.0
// The explosion maps of one mirror for one eye (1998, section 4.1), as pictures: a colour for each triangle,
// dimmer where an extension polygon of it stands in, black outside the circle.
#include <functional>

#include "catoptric/sketch/mirror_sketch.h"
#include "catoptric/virtual_object/virtual_object_solver.h"
#include "viewer/jobs.h"

namespace catoptric::viewer {
namespace {

/// As VirtualObjectSolver looks a point up; copies what it needs, the solver does not stay.
std::function<MapPlaces(const dvec3&)> makeFinder(const virtual_object::VirtualObjectSolver& solver) {
  using virtual_object::computeMapCoords;
  const virtual_object::HiddenMap& map = solver.hiddenMap();
  return [centre = solver.mesh().centre(), frame = solver.nearMap().frame, hidden = map.frame, eye = map.eye,
          lower = map.lower, perUnit = map.pixelsPerUnit,
          sizePx = dvec2(map.ids.width(), map.ids.height())](const dvec3& point) {
    const dvec2 onSphere = computeMapCoords(frame, glm::normalize(point - centre));
    const dvec2 fromEye = computeMapCoords(hidden, glm::normalize(point - eye));
    return MapPlaces{0.5 * (onSphere + 1.0), (fromEye - lower) * perUnit / sizePx};
  };
}

/// Meshes are kept: they do not depend on the eye.
struct KeptMesh {
  GeometryPointer geometry;
  std::uint32_t reflector = core::kNoId;
  std::unique_ptr<virtual_object::ReflectorMesh> mesh;
};

}  // namespace

MapsWorker::Work makeMapsWork() {
  return [kept = std::make_shared<KeptMesh>()](const MapsRequest& request) {
    const scene::WorldGeometry& world = *request.geometry;
    MapsResult result;
    result.request = request;
    if (request.reflector >= world.reflectors.size() ||
        world.reflectors[request.reflector].shape == scene::ReflectorShape::Plane)
      return result;
    if (kept->geometry != request.geometry || kept->reflector != request.reflector) {
      kept->mesh = std::make_unique<virtual_object::ReflectorMesh>(world, request.reflector,
                                                                   virtual_object::ReflectorMeshOptions{});
      kept->geometry = request.geometry;
      kept->reflector = request.reflector;
    }
    const double farRadius =
        glm::length(world.bounds.centre() - kept->mesh->centre()) + world.bounds.radius();
    const virtual_object::VirtualObjectSolver solver(*kept->mesh, request.eye, farRadius);
    result.canReflect = solver.canReflect();
    result.triangles = kept->mesh->triangles().size();
    const std::vector<sketch::Colour> colours = sketch::colourTriangles(*kept->mesh);
    result.nearMap = sketch::drawMap(solver.nearMap().ids, true, colours);
    result.farMap = sketch::drawMap(solver.farMap().ids, true, colours);
    result.hiddenMap = sketch::drawMap(solver.hiddenMap().ids, false, colours);
    result.findPlaces = makeFinder(solver);
    return result;
  };
}

}  // namespace catoptric::viewer

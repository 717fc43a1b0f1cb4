// SPDX-License-Identifier: Apache-2.0
// The explosion maps of one mirror for one eye (1998, section 4.1), as pictures: a colour for each triangle,
// dimmer where an extension polygon of it stands in, black outside the circle.
#include "catoptric/sketch/mirror_sketch.h"
#include "viewer/jobs.h"

namespace catoptric::viewer {
namespace {

/// Meshes are kept: they do not depend on the eye.
struct KeptMesh {
  ScenePointer scene;
  std::uint32_t reflector = core::kNoId;
  std::unique_ptr<virtual_object::ReflectorMesh> mesh;
};

}  // namespace

MapsWorker::Work makeMapsWork() {
  return [kept = std::make_shared<KeptMesh>()](const MapsRequest& request) {
    const scene::WorldGeometry& world = request.scene->geometry;
    MapsResult result;
    result.request = request;
    if (request.reflector >= world.reflectors.size() ||
        world.reflectors[request.reflector].shape == scene::ReflectorShape::Plane)
      return result;
    if (kept->scene != request.scene || kept->reflector != request.reflector) {
      kept->mesh = std::make_unique<virtual_object::ReflectorMesh>(world, request.reflector,
                                                                   virtual_object::ReflectorMeshOptions{});
      kept->scene = request.scene;
      kept->reflector = request.reflector;
    }
    const double farRadius =
        glm::length(world.bounds.centre() - kept->mesh->centre()) + world.bounds.radius();
    const virtual_object::VirtualObjectSolver solver(*kept->mesh, request.eye, farRadius);
    result.canReflect = solver.canReflect();
    result.triangles = kept->mesh->triangles().size();
    result.nearMap = sketch::drawMap(solver.nearMap().ids, true);
    result.farMap = sketch::drawMap(solver.farMap().ids, true);
    result.hiddenMap = sketch::drawMap(solver.hiddenMap().ids, false);
    return result;
  };
}

}  // namespace catoptric::viewer

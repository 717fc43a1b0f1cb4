// SPDX-License-Identifier: Apache-2.0
// The explosion maps of one mirror for one eye (1998, section 4.1), as pictures: a colour for each triangle,
// dimmer where an extension polygon of it stands in, black outside the circle.
#include <array>
#include <functional>

#include "catoptric/virtual_object/virtual_object_solver.h"
#include "viewer/jobs.h"

namespace catoptric::viewer {
namespace {

/// Colours of neighbouring ids differ: steps of the golden angle round the hue circle, three brightnesses.
glm::u8vec4 colourOf(std::uint32_t id, float strength) {
  const float hue = float(id % 4096u) * 0.61803399f;
  const float value = strength * (0.6f + 0.2f * float(id % 3u));
  glm::u8vec4 colour(0, 0, 0, 255);
  for (int c = 0; c < 3; ++c) {
    const float phase = hue + float(c) / 3.0f;
    const float wave = std::abs((phase - std::floor(phase)) * 6.0f - 3.0f) - 1.0f;
    colour[c] = std::uint8_t(255.0f * value * (0.25f + 0.75f * glm::clamp(wave, 0.0f, 1.0f)));
  }
  return colour;
}

core::ImageRgba8 drawIds(const core::Image<std::uint32_t>& ids, bool hasExtensionBit) {
  core::ImageRgba8 picture(ids.width(), ids.height(), glm::u8vec4(0, 0, 0, 255));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::uint32_t id = ids.pixels()[i];
    if (id == core::kNoId) continue;
    const bool isExtension = hasExtensionBit && (id & virtual_object::kExtensionBit) != 0;
    picture.pixels()[i] = colourOf(hasExtensionBit ? id / 2 : id, isExtension ? 0.4f : 1.0f);
  }
  return picture;
}

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
    result.nearMap = drawIds(solver.nearMap().ids, true);
    result.farMap = drawIds(solver.farMap().ids, true);
    result.hiddenMap = drawIds(solver.hiddenMap().ids, false);
    result.findPlaces = makeFinder(solver);
    return result;
  };
}

}  // namespace catoptric::viewer

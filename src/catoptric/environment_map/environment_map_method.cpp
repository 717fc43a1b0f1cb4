// SPDX-License-Identifier: Apache-2.0
#include "catoptric/environment_map/environment_map_method.h"

namespace catoptric::environment_map {

EnvironmentMapMethod::EnvironmentMapMethod()
    : program_("raster/screen.vert", "environment_map/environment_map.frag") {}

void EnvironmentMapMethod::setOptions(int sizeTexels, bool boxCorrected) {
  constexpr std::size_t kMostBytes = std::size_t(2) << 30;
  cubes_.setLimits(sizeTexels, kMostBytes);
  boxCorrected_ = boxCorrected;
}

void EnvironmentMapMethod::render(raster::FrameContext& frame, const raster::Chain& chain,
                                  const raster::Level& parent, raster::Level& target) {
  const dvec3 centre = frame.scene.geometry().reflectors[chain.last].centre;
  const raster::SceneCube& cube = cubes_.take(frame, {chain.last, 0}, centre);
  const core::Box box = findRoomBox(frame.scene.geometry(), centre);
  target.surfaces.bind();
  gl::setScissor(chain.bounds);
  gl::setDrawState({.depthTest = false, .depthWrite = false});
  program_.use();
  parent.bindAsParent(program_);
  const int unit = raster::kUnitFirstFree + 4;
  cube.color.bind(unit);
  cube.position.bind(unit + 1);
  cube.ids.bind(unit + 2);
  program_.set("u_cubeColor", unit);
  program_.set("u_cubePosition", unit + 1);
  program_.set("u_cubeIds", unit + 2);
  program_.set("u_cubeMaxLod", float(cube.color.levels() - 1));
  program_.set("u_parentWord", chain.parentWord());
  program_.set("u_chain", chain.id);
  program_.set("u_centre", vec3(centre));
  program_.set("u_boxLower", vec3(box.lower));
  program_.set("u_boxUpper", vec3(box.upper));
  program_.set("u_boxCorrected", boxCorrected_ ? 1 : 0);
  nothing_.bind();
  gl::drawScreen();
}

core::Box findRoomBox(const scene::WorldGeometry& world, const dvec3& point) {
  core::Box shell;
  for (const scene::Part& part : world.parts)
    if (part.shell)
      for (std::uint32_t v = part.firstVertex; v < part.firstVertex + part.vertexCount; ++v)
        shell.add(dvec3(world.positions[v]));
  const bool holds = !shell.isEmpty() && glm::all(glm::greaterThan(point, shell.lower)) &&
                     glm::all(glm::lessThan(point, shell.upper));
  return holds ? shell : world.bounds;
}

}  // namespace catoptric::environment_map

// SPDX-License-Identifier: Apache-2.0
#include "catoptric/environment_map/environment_map_method.h"

#include <array>
#include <cmath>

namespace catoptric::environment_map {
namespace {

struct FaceAxes {
  dvec3 forward, up;
};

/// GL's cube faces, as cameras whose picture has its top row at the face's largest t (rows are stored bottom
/// first).
constexpr std::array<FaceAxes, 6> kFaces{{{{1, 0, 0}, {0, -1, 0}},
                                          {{-1, 0, 0}, {0, -1, 0}},
                                          {{0, 1, 0}, {0, 0, 1}},
                                          {{0, -1, 0}, {0, 0, -1}},
                                          {{0, 0, 1}, {0, -1, 0}},
                                          {{0, 0, -1}, {0, -1, 0}}}};

int levelCount(int size) {
  return 1 + int(std::floor(std::log2(double(size))));
}

gl::SamplerState smooth() {
  return {gl::TextureWrap::ClampToEdge, gl::TextureWrap::ClampToEdge, false, false, true};
}

}  // namespace

EnvironmentMapMethod::Cube::Cube(int size)
    : color(gl::TextureKind::Cube, gl::Format::Rgba32F, size, size, 1, levelCount(size), smooth()),
      position(gl::TextureKind::Cube, gl::Format::Rgba32F, size, size, 1, 1, gl::SamplerState{}),
      ids(gl::TextureKind::Cube, gl::Format::Rg32Ui, size, size, 1, 1, gl::SamplerState{}) {}

EnvironmentMapMethod::EnvironmentMapMethod()
    : program_("raster/screen.vert", "environment_map/environment_map.frag") {}

void EnvironmentMapMethod::setOptions(int sizeTexels, bool boxCorrected) {
  if (sizeTexels != sizeTexels_) {
    cubes_.clear();
    face_.reset();
  }
  sizeTexels_ = sizeTexels;
  boxCorrected_ = boxCorrected;
}

void EnvironmentMapMethod::prepare(raster::FrameContext&) {
  for (auto& [reflector, cube] : cubes_) cube->isFresh = false;
}

EnvironmentMapMethod::Cube& EnvironmentMapMethod::takeCube(raster::FrameContext& frame,
                                                           std::uint32_t reflector) {
  std::unique_ptr<Cube>& cube = cubes_[reflector];
  if (!cube) cube = std::make_unique<Cube>(sizeTexels_);
  if (cube->isFresh) return *cube;
  if (!face_) face_ = std::make_unique<raster::Level>(sizeTexels_, sizeTexels_);
  const scene::Reflector& mirror = frame.scene.geometry().reflectors[reflector];
  for (int i = 0; i < 6; ++i) {
    scene::CameraFrame camera;
    camera.eye = mirror.centre;
    camera.forward = kFaces[std::size_t(i)].forward;
    camera.up = kFaces[std::size_t(i)].up;
    camera.right = glm::cross(camera.forward, camera.up);
    camera.tanHalfFovY = 1.0;
    camera.widthPx = camera.heightPx = sizeTexels_;
    frame.primary.draw(frame.scene, camera, 1e-3 * std::max(mirror.radius, 1e-3), {0.5, 0.5}, *face_,
                       reflector);
    frame.compose.draw(frame.scene, *face_, nullptr);
    face_->composed.copyToCubeFace(0, cube->color, i);
    face_->composed.copyToCubeFace(1, cube->position, i);
    face_->composed.copyToCubeFace(2, cube->ids, i);
  }
  cube->color.generateMipmaps();
  cube->isFresh = true;
  return *cube;
}

void EnvironmentMapMethod::render(raster::FrameContext& frame, const raster::Chain& chain,
                                  const raster::Level& parent, raster::Level& target) {
  const Cube& cube = takeCube(frame, chain.last);
  const dvec3 centre = frame.scene.geometry().reflectors[chain.last].centre;
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

// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/scene_cube.h"

#include <array>
#include <bit>

namespace catoptric::raster {
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

gl::SamplerState smooth() {
  return {gl::TextureWrap::ClampToEdge, gl::TextureWrap::ClampToEdge, false, false, true};
}

}  // namespace

SceneCube::SceneCube(int size)
    : color(gl::TextureKind::Cube, gl::Format::Rgba32F, size, size, 1, std::bit_width(unsigned(size)),
            smooth()),
      position(gl::TextureKind::Cube, gl::Format::Rgba32F, size, size, 1, 1, gl::SamplerState{}),
      ids(gl::TextureKind::Cube, gl::Format::Rg32Ui, size, size, 1, 1, gl::SamplerState{}) {}

std::size_t SceneCube::bytes() const {
  const std::size_t texels = 6 * std::size_t(color.width()) * std::size_t(color.width());
  return texels * (16 + 16 + 8) + texels * 16 / 3;
}

void SceneCubeCapture::draw(FrameContext& frame, const dvec3& centre, double nearPlane,
                            std::uint32_t excludedReflector, SceneCube& cube) {
  const int size = cube.color.width();
  if (!face_ || face_->widthPx != size) face_ = std::make_unique<Level>(size, size);
  cube.centre = centre;
  for (int i = 0; i < 6; ++i) {
    scene::CameraFrame camera;
    camera.eye = centre;
    camera.forward = kFaces[std::size_t(i)].forward;
    camera.up = kFaces[std::size_t(i)].up;
    camera.right = glm::cross(camera.forward, camera.up);
    camera.tanHalfFovY = 1.0;
    camera.widthPx = camera.heightPx = size;
    frame.primary.draw(frame.scene, camera, nearPlane, {0.5, 0.5}, *face_, excludedReflector);
    frame.compose.draw(frame.scene, *face_, nullptr);
    face_->composed.copyToCubeFace(0, cube.color, i);
    face_->composed.copyToCubeFace(1, cube.position, i);
    face_->composed.copyToCubeFace(2, cube.ids, i);
  }
  cube.color.generateMipmaps();
}

}  // namespace catoptric::raster

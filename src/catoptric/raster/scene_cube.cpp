// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/scene_cube.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>

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
    frame.compose.draw(*face_, nullptr);
    face_->composed.copyToCubeFace(0, cube.color, i);
    face_->seen.copyToCubeFace(0, cube.position, i);
    face_->seen.copyToCubeFace(1, cube.ids, i);
  }
  cube.color.generateMipmaps();
}

void SceneCubeCache::setLimits(int sizeTexels, std::size_t maxBytes) {
  if (sizeTexels != sizeTexels_) cubes_.clear();
  sizeTexels_ = sizeTexels;
  maxBytes_ = maxBytes;
}

void SceneCubeCache::geometryChanged() {
  for (auto& [key, kept] : cubes_) kept.isFresh = false;
}

void SceneCubeCache::makeRoom() {
  while (cubes_.size() > 1 && (cubes_.size() + 1) * cubes_.begin()->second.cube->bytes() > maxBytes_)
    cubes_.erase(std::min_element(cubes_.begin(), cubes_.end(), [](const auto& a, const auto& b) {
      return a.second.lastUse < b.second.lastUse;
    }));
}

const SceneCube& SceneCubeCache::take(FrameContext& frame, const Key& key, const dvec3& centre) {
  if (!cubes_.contains(key)) makeRoom();
  Kept& kept = cubes_[key];
  kept.lastUse = ++uses_;
  if (kept.isFresh && kept.cube->centre == centre) return *kept.cube;
  const auto start = std::chrono::steady_clock::now();
  if (!kept.cube) kept.cube = std::make_unique<SceneCube>(sizeTexels_);
  const double nearPlane = 1e-3 * std::max(frame.scene.geometry().reflectors[key.first].radius, 1e-3);
  capture_.draw(frame, centre, nearPlane, key.first, *kept.cube);
  kept.isFresh = true;
  ++captures_;
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  frame.counters.captureMs += spent.count();
  return *kept.cube;
}

}  // namespace catoptric::raster

// SPDX-License-Identifier: Apache-2.0
// The scene all around a point, as cube maps: radiance with mip levels, and at full size what is seen.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <utility>

#include "catoptric/raster/reflection_method.h"

namespace catoptric::raster {

struct SceneCube {
  explicit SceneCube(int sizeTexels);
  [[nodiscard]] std::size_t bytes() const;

  gl::Texture color;
  gl::Texture position;  ///< world point and its distance from the centre; direction and kSkyPath at the sky
  gl::Texture ids;       ///< r as in shaders/raster/level_pixels.glsl
  dvec3 centre{0};
};

/// Draws the scene six times.
class SceneCubeCapture {
 public:
  void draw(FrameContext& frame, const dvec3& centre, double nearPlane, std::uint32_t excludedReflector,
            SceneCube& cube);

 private:
  std::unique_ptr<Level> face_;
};

/// Cubes of reflectors, kept until something moves; those not used for longest make room.
class SceneCubeCache {
 public:
  using Key = std::pair<std::uint32_t, int>;  ///< reflector, which of its cubes

  /// Cubes of another size are forgotten. The last two that were used are kept whatever `maxBytes` says.
  void setLimits(int sizeTexels, std::size_t maxBytes);
  void geometryChanged();
  /// The scene around `centre` without the reflector. Stays valid while no more than one other cube is taken.
  [[nodiscard]] const SceneCube& take(FrameContext& frame, const Key& key, const dvec3& centre);
  [[nodiscard]] int sizeTexels() const { return sizeTexels_; }
  [[nodiscard]] std::uint64_t captures() const { return captures_; }  ///< cubes drawn so far

 private:
  struct Kept {
    std::unique_ptr<SceneCube> cube;
    bool isFresh = false;
    std::uint64_t lastUse = 0;
  };
  void makeRoom();

  int sizeTexels_ = 512;
  std::size_t maxBytes_ = 0;
  SceneCubeCapture capture_;
  std::map<Key, Kept> cubes_;
  std::uint64_t uses_ = 0, captures_ = 0;
};

}  // namespace catoptric::raster

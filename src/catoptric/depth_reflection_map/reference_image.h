// SPDX-License-Identifier: Apache-2.0
// Depth-preserving reflection maps as they are taken and kept (Bastos & Stuerzlinger 1998, section 4): colour
// and disparity of a view through a mirror. What the warp needs is read back once, when the image is taken.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <tuple>

#include "catoptric/depth_reflection_map/reference_camera.h"
#include "catoptric/depth_reflection_map/zexel_map.h"
#include "catoptric/raster/reflection_method.h"

namespace catoptric::depth_reflection_map {

struct ReferenceImage {
  explicit ReferenceImage(const ReferenceCamera& referenceCamera);
  [[nodiscard]] std::size_t bytes() const;

  ReferenceCamera camera;
  gl::Texture color;   ///< linear radiance, with mip levels
  gl::Texture zexels;  ///< shaders/depth_reflection_map/zexel_capture.frag
  ZexelMap map;
  std::uint64_t lastUse = 0;
};

/// Which reference image of a scene.
struct ReferenceKey {
  std::uint32_t reflector = 0;
  bool isFromBehind = false;  ///< of a double-sided mirror
  int shell = 0;  ///< twice the step of the ladder of radii; odd: of eyes outside of the scene's box
  int index = 0;

  friend bool operator==(const ReferenceKey& a, const ReferenceKey& b) { return a.order() == b.order(); }
  friend bool operator<(const ReferenceKey& a, const ReferenceKey& b) { return a.order() < b.order(); }

 private:
  [[nodiscard]] std::tuple<std::uint32_t, bool, int, int> order() const {
    return {reflector, isFromBehind, shell, index};
  }
};

/// Takes reference images when they are asked for and keeps them, the ones used last, under a bound.
class ReferenceCache {
 public:
  ReferenceCache();

  /// The two most recent ones stay whatever the bound is.
  void setMaxBytes(std::size_t bytes) { maxBytes_ = bytes; }
  /// Everything is taken anew: something moved.
  void clear() { images_.clear(); }
  [[nodiscard]] std::size_t bytes() const;
  [[nodiscard]] std::size_t count() const { return images_.size(); }

  /// Valid until the next call but one.
  [[nodiscard]] ReferenceImage& take(raster::FrameContext& frame, const ReferenceKey& key,
                                     const ReferenceCamera& camera);
  /// One that take() has just given.
  [[nodiscard]] const ReferenceImage& get(const ReferenceKey& key) const { return *images_.at(key); }

 private:
  void capture(raster::FrameContext& frame, std::uint32_t reflector, ReferenceImage& image);
  void evict();

  gl::Program program_;
  gl::VertexArray nothing_;
  std::unique_ptr<raster::Level> level_;
  std::map<ReferenceKey, std::unique_ptr<ReferenceImage>> images_;
  std::size_t maxBytes_ = std::size_t(512) << 20;
  std::uint64_t now_ = 0;
};

}  // namespace catoptric::depth_reflection_map

// SPDX-License-Identifier: Apache-2.0
// Depth-preserving reflection maps as they are taken and kept (Bastos & Stuerzlinger 1998, section 4): colour
// and disparity of a view through a mirror. What the warp needs is read back once, when the image is taken.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>

#include "catoptric/depth_reflection_map/reference_camera.h"
#include "catoptric/depth_reflection_map/reference_file.h"
#include "catoptric/depth_reflection_map/reference_key.h"
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

/// Takes reference images when they are asked for and keeps them, the ones used last, under a bound.
class ReferenceCache {
 public:
  ReferenceCache();

  /// The two most recent ones stay whatever the bound is.
  void setMaxBytes(std::size_t bytes) { maxBytes_ = bytes; }
  /// Images that are not in memory are taken from this file, where it exists, and save() writes to it. Throws
  /// as unpackReferences() and core::readFile() do.
  void useFile(const std::filesystem::path& path, std::uint64_t fingerprint);
  /// Writes the file, whole or not at all, when images have been taken that are not in it. Needs a context.
  void save();
  /// Everything is taken anew: something moved. The file is of no use any more, and stays as it is.
  void clear();
  [[nodiscard]] std::size_t bytes() const;
  [[nodiscard]] std::size_t count() const { return images_.size(); }

  /// Valid until the next call but one.
  [[nodiscard]] ReferenceImage& take(raster::FrameContext& frame, const ReferenceKey& key,
                                     const ReferenceCamera& camera);
  /// Null where it is not kept any more.
  [[nodiscard]] const ReferenceImage* find(const ReferenceKey& key) const {
    const auto found = images_.find(key);
    return found == images_.end() ? nullptr : found->second.get();
  }
  /// One that take() has just given.
  [[nodiscard]] const ReferenceImage& get(const ReferenceKey& key) const { return *images_.at(key); }

 private:
  void capture(raster::FrameContext& frame, std::uint32_t reflector, ReferenceImage& image);
  [[nodiscard]] bool loadFromFile(const ReferenceKey& key, ReferenceImage& image) const;
  void evict();

  gl::Program program_;
  gl::VertexArray nothing_;
  std::unique_ptr<raster::Level> level_;
  std::map<ReferenceKey, std::unique_ptr<ReferenceImage>> images_;
  std::size_t maxBytes_ = std::size_t(512) << 20;
  std::uint64_t now_ = 0;
  std::filesystem::path path_;  ///< empty: no file
  std::uint64_t fingerprint_ = 0;
  std::map<ReferenceKey, std::vector<std::byte>> records_;  ///< of the file
  bool hasNew_ = false;                                     ///< images that are not in the file
};

}  // namespace catoptric::depth_reflection_map

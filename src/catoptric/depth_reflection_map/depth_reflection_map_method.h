// SPDX-License-Identifier: Apache-2.0
// Mirrors from depth-preserving reflection maps (Bastos & Stuerzlinger 1998). Flat ones: at most two
// reference images of a hemisphere behind the mirror are warped to the mirrored eye, on the processor. Curved
// ones: by inverse warping, on the GPU. The scene itself is drawn only when a reference image is taken.
// README.md has the limits and the figures.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "catoptric/depth_reflection_map/exposures.h"
#include "catoptric/depth_reflection_map/forward_warp.h"
#include "catoptric/depth_reflection_map/inverse_warp.h"
#include "catoptric/depth_reflection_map/reference_image.h"

namespace catoptric::depth_reflection_map {

class DepthReflectionMapMethod : public raster::ReflectionMethod {
 public:
  DepthReflectionMapMethod();
  [[nodiscard]] std::string_view name() const override { return "zexel"; }
  [[nodiscard]] bool supports(const raster::Chain&) const override { return true; }
  /// Reference images are kept unless hemisphere or size differ.
  void setOptions(const ZexelOptions& options);
  /// See ReferenceCache. What has moved since the start is in no file.
  void useCacheFile(const std::filesystem::path& path, std::uint64_t fingerprint) {
    cache_.useFile(path, fingerprint);
  }
  void saveCacheFile() { cache_.save(); }
  void prepare(raster::FrameContext&) override {}
  /// Something moved: all reference images are taken anew.
  void geometryChanged() override {
    cache_.clear();
    windows_.clear();
    inverse_.geometryChanged();
  }
  void materialsChanged() override { geometryChanged(); }
  void render(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
              raster::Level& target) override;
  void collectMarks(const scene::WorldGeometry& world, std::uint32_t reflector,
                    const raster::MarkOptions& options, raster::Marks& marks) const override;

 private:
  /// The hemispheres behind one side of a mirror.
  struct Window {
    MirrorWindow window;
    std::map<int, Hemisphere> shells;  ///< see ReferenceKey::shell
    WinnerImage lastWinners;           ///< of the frame before, and which references they are of
    std::vector<ReferenceKey> lastKeys;
  };
  /// One of the (at most two) reference images nearest to the mirrored eye.
  struct Nearest {
    ReferenceKey key;
    dvec3 centre{0};
    double distance = 0;  ///< from the mirrored eye
  };
  Window& findNearest(const raster::FrameContext& frame, const raster::Chain& chain,
                      const dvec3& mirroredEye);
  void pickPair(const dvec3& eye);
  void warpReferences(raster::FrameContext& frame, const Pinhole& view, const PixelRectangle& rectangle);
  void closeExposures(raster::FrameContext& frame, const raster::Chain& chain, const Pinhole& view,
                      Window& window);
  void resolve(const raster::Chain& chain, const raster::Level& parent, const raster::Level& target);

  ZexelOptions options_;
  raster::MirrorBackgroundPass background_;
  gl::Program program_;
  gl::VertexArray nothing_;
  std::unique_ptr<gl::Texture> winnersTexture_;
  ReferenceCache cache_;
  std::map<std::pair<std::uint32_t, bool>, Window> windows_;  ///< reflector, seen from behind
  std::vector<Nearest> nearest_;
  double spacing_ = 0;  ///< of the images of its hemisphere
  ForwardWarp warp_;
  InverseWarp inverse_;
  WinnerImage winners_, secondWinners_;
  int level_ = 0;  ///< of the hierarchical map
};

}  // namespace catoptric::depth_reflection_map

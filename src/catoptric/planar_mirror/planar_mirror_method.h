// SPDX-License-Identifier: Apache-2.0
// Planar mirrors (McReynolds & Blythe 2005, section 17.1.2; 1998, section 2.3): the scene is drawn again
// through the product of the mirrors' reflection matrices, winding turned round, cut at the plane of the last
// mirror, only where the level before shows that mirror.
#pragma once

#include <map>
#include <vector>

#include "catoptric/planar_mirror/projective_texture.h"
#include "catoptric/raster/reflection_method.h"

namespace catoptric::planar_mirror {

class PlanarMirrorMethod : public raster::ReflectionMethod {
 public:
  [[nodiscard]] std::string_view name() const override { return "planar"; }
  [[nodiscard]] bool supports(const raster::Chain& chain) const override { return !chain.curved; }
  void prepare(raster::FrameContext&) override {}
  void geometryChanged() override {
    blendedStreams_.reset();
    outlines_.clear();
  }
  void render(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
              raster::Level& target) override;

 private:
  void drawBlended(raster::FrameContext& frame, const raster::SurfaceView& view, raster::Level& target);
  /// Adds the planes through the eye and the mirror's edges, if they keep everything within its pixels and
  /// out of the other mirrors'.
  [[nodiscard]] bool addEdgePlanes(const raster::FrameContext& frame, const raster::Chain& chain,
                                   raster::PinholeView& mirrored);

  raster::MirrorBackgroundPass background_;
  std::map<std::uint32_t, std::vector<dvec3>> outlines_;  ///< by mirror, made when first needed
  std::unique_ptr<ProjectiveTexture> texture_;            ///< made when first needed
  std::unique_ptr<raster::VertexStreams> blendedStreams_;
  std::vector<std::uint32_t> sortedIndices_;
  std::vector<raster::DrawRange> ranges_, sortedRanges_;
};

}  // namespace catoptric::planar_mirror

// SPDX-License-Identifier: Apache-2.0
// Solver `exact`: reflections in any curved mirror, or chain of mirrors, that agree with ray tracing.
//
// In:  the level before, which holds at each mirror pixel the point, the mirror direction and the ids.
// Out: the next level at the pixels of one mirror, as every ReflectionMethod.
// Steps:
//   1. The reflected ray of every mirror pixel goes into two textures, once a level (exact_rays.frag).
//   2. On the CPU: rectangles of pixels in which a triangle may be seen (tile_cover.h).
//   3. Each rectangle is drawn; a fragment meets its ray with the real triangle, the depth buffer keeps the
//      nearest one by the length of the ray (exact_hit.frag). Where GL is software the processor does the
//      same in step 2, tile by tile (tile_hits.h), and GL draws only what a texture may cut out.
//   4. Part by part, what was met is shaded once at each pixel, with the functions that shade directly seen
//      surfaces (exact_shade.frag). Derivatives of texture coordinates are those of the rays (Igehy 1999),
//      not of the fragments.
//      Where GL is software and nothing is masked or blended, by the processor (lane_shading.h).
//   5. The environment behind it; blended triangles over it, from far to near as seen from the mirror's
//      centre.
// Departures: methods.md bounds a virtual triangle by its three reflection points; tiles need none, so
// chains, saddles
//   and foci are no special cases.
// Known failures: whether a double-sided convex mirror shows its back is decided for the whole mirror.
// Blended triangles
//   that pass through each other are ordered by their centres.
// Cost: virtual_object/README.md.
// Source: our own; the fragment's test after Hou 2006 and Liu 2011.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "catoptric/raster/reflection_method.h"
#include "catoptric/virtual_object/exact/tile_cover.h"
#include "catoptric/virtual_object/exact/tile_hits.h"
#include "catoptric/virtual_object/hit_shading.h"
#include "catoptric/virtual_object/mixed/part_image.h"

namespace catoptric::virtual_object {

class ExactMethod : public raster::ReflectionMethod {
 public:
  /// `shading` must outlive the method.
  explicit ExactMethod(HitShading& shading) : shading_(shading) {}
  /// Whether GL tests opaque triangles; else the processor does.
  void testByGl(bool byGl) { testsByGl_ = byGl; }
  [[nodiscard]] std::string_view name() const override { return "virtual"; }
  [[nodiscard]] bool supports(const raster::Chain& chain) const override { return chain.curved.has_value(); }
  void prepare(raster::FrameContext&) override {}
  void geometryChanged() override {
    tiles_.reset();
    tileHits_.reset();
    hierarchy_.reset();
  }
  void render(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
              raster::Level& target) override;

  /// Of the scene's triangles, kept until they move.
  [[nodiscard]] const TriangleHierarchy& findHierarchy(const raster::FrameContext& frame) {
    prepareScene(frame);
    return *hierarchy_;
  }
  /// The rays of a mirror's pixels, and what shades them in lanes; the images are the level's, and hold
  /// nothing outside of chain.bounds.
  [[nodiscard]] const RayImages& findRays(const raster::FrameContext& frame, const raster::Chain& chain,
                                          const raster::Level& parent);
  /// What the rays of findRays() meet at pixels of chain.bounds that have a 0 in `isDone` (row by row; empty:
  /// at all). Null where GL has to draw, and to shade: drawRest().
  [[nodiscard]] const HitImage* findHits(raster::FrameContext& frame, const raster::Chain& chain,
                                         std::span<const std::uint8_t> isDone);
  /// What findHits() did not do. `image`: was told which pixels are done; null: none.
  void drawRest(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
                raster::Level& target, PartImage* image);

  /// What was offered by the last render(), and the rays it was offered to; for tests of conservativeness.
  [[nodiscard]] const Cover& cover() const { return cover_; }
  [[nodiscard]] const RayImages& rays() const { return rays_; }

 private:
  void prepareScene(const raster::FrameContext& frame);
  void readRays(const raster::Level& parent, const gl::Scissor& bounds);
  [[nodiscard]] CoverQuery makeQuery(const raster::FrameContext& frame, const raster::Chain& chain) const;
  [[nodiscard]] bool showsBack(const scene::WorldGeometry& world, const scene::Part& part,
                               const CoverQuery& query) const;
  void findCover(raster::FrameContext& frame, const CoverQuery& query);
  /// `image`: closes the pixels that are done; may be null.
  void drawHits(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
                PartImage* image);
  void shadeHits(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
                 const raster::Level& target);
  void drawBlended(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
                   raster::Level& target);

  HitShading& shading_;
  raster::MirrorBackgroundPass background_;
  std::unique_ptr<gl::Program> hitProgram_;  ///< made when first needed
  std::unique_ptr<TriangleHierarchy> hierarchy_;
  std::optional<TileCover> tiles_;
  std::optional<TileHits> tileHits_;
  RayImages rays_;
  Cover cover_;
  HitImage hits_;
  CoverQuery query_;
  bool testsByGl_ = true;
};

}  // namespace catoptric::virtual_object

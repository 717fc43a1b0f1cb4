// SPDX-License-Identifier: Apache-2.0
// Shades, once at each mirror pixel, what its reflected (or refracted) ray meets.
//
// In:  a level, which holds at each mirror pixel the point, the direction in which its ray goes on and the
//      ids; and rectangles of pixels with what may be seen there.
// Out: the next level at those pixels.
// Steps:
//   1. The ray of every mirror pixel goes into two textures (exact_rays.frag).
//   2. Which triangle a pixel's ray meets goes into the image of hits: the methods' work.
//   3. Part by part, the ray meets that triangle itself, and the point is shaded with the functions that
//      shade directly seen surfaces (exact_shade.frag). Derivatives of texture coordinates are those of the
//      rays (Igehy 1999), not of the fragments.
// Solver `exact` finds the triangles by testing rays; virtual objects by drawing triangles' numbers. Position
// and texture coordinates are those of ray tracing in both.
// Cost: one shading a pixel, however small the triangles are.
// Source: our own; the fragment's test after Hou 2006 and Liu 2011.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "catoptric/raster/reflection_method.h"
#include "catoptric/virtual_object/lane_shading.h"
#include "catoptric/virtual_object/scene_triangles.h"

namespace catoptric::virtual_object {

/// Pixels [x, x + width) x [y, y + height) and what may be seen there.
struct CoverRect {
  std::uint16_t x = 0, y = 0, width = 0, height = 0;
  std::uint32_t item = 0;  ///< triangle, or part
};

/// Rays, hits and programs that the solvers of this folder share; one for each renderer.
class HitShading {
 public:
  enum class Pass : std::uint8_t {
    MaskedHits,       ///< item: triangle of an alpha-masked part. Writes hits
    Blend,            ///< item: triangle of a blended part
    Shade,            ///< item: part
    ShadeVirtual,     ///< item: part, see shadeVirtual()
    ShadeVirtualEdge  ///< item: part, see there
  };

  HitShading();
  void partsMoved(const raster::SceneBuffers& scene, std::span<const std::uint32_t> parts) {
    if (triangles_) triangles_->update(scene, parts);
  }
  /// Makes targets of the parent's size and the scene's textures, when there are none.
  void prepare(const raster::SceneBuffers& scene, const raster::Level& parent);

  /// Step 1.
  void drawRays(const raster::Level& parent, const gl::Scissor& bounds);
  /// Each pixel to where it would be if all of the level were read.
  void readRays(const gl::Scissor& bounds, std::span<vec4> origins, std::span<vec4> directions) const;

  /// Binds the target of step 2, cut to `bounds` and cleared there.
  void beginHits(const gl::Scissor& bounds) const;
  /// The same without clearing it.
  void continueHits(const gl::Scissor& bounds) const;
  /// Triangle + 1 and bits of a length at each pixel of `bounds`, row by row.
  void readHits(const gl::Scissor& bounds, std::vector<uvec2>& hits) const;
  /// Step 2 done by the processor (number_raster.h): the hits of `bounds` and, unless there are none, their
  /// depths, row by row.
  void uploadHits(const gl::Scissor& bounds, std::span<const uvec2> hits, std::span<const float> depths);
  /// The rays, hits and triangles, for a program in use.
  void bindInputs(gl::Program& program, const raster::Level& parent, const raster::Chain& chain) const;

  /// Step 3: rectangles of one part after another, each with the program for its material, into the target
  /// that is bound. `isLast`: Level::isLast of it.
  void drawParts(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
                 Pass pass, std::span<const CoverRect> rects, bool isLast = false) {
    drawVariants(frame, chain, parent, pass, rects, isLast ? kEnvironment : 0u);
  }
  /// Step 3 for hits that are those of virtual triangles, with the length of the path to them; item: part.
  /// `isEdge`: pixels that are not of this mirror lie in between. `withDepths`: depths of the hits are tested
  /// and stored; else what the target has there is covered, whatever its depth, which it keeps.
  void shadeVirtual(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
                    const raster::Level& target, bool isEdge, std::span<const CoverRect> rects,
                    bool withDepths = true);
  /// The same by the processor.
  [[nodiscard]] LaneShading& inLanes() { return inLanes_; }
  [[nodiscard]] const SceneTriangles& triangles() const { return *triangles_; }
  /// All rectangles with the program in use; item: triangle.
  void drawRects(std::span<const CoverRect> rects);

  /// Distance along a ray to depth: 1 is a little beyond the scene's far end.
  void setReach(double reach);
  /// The depth at which exact_hit.frag stores a hit, over its distance.
  [[nodiscard]] float depthFromDistance() const { return depthFromDistance_; }

 private:
  /// Rays and hits of a picture of one size.
  struct Targets {
    Targets(int width, int height);
    int widthPx, heightPx;
    gl::Texture origins, directions, hits, depth;
    gl::Framebuffer rays, hitTests;
  };
  /// Bits of the textures (SceneBuffers::textureBits()), of VertexAttribute and of these.
  enum Target : unsigned { kMirror = 128, kSeen = 256, kEnvironment = 512, kDepth = 1024 };
  static constexpr unsigned kVariants = 2048;
  [[nodiscard]] gl::Program& findProgram(const raster::SceneBuffers& scene, Pass pass, unsigned variant);
  /// The same as bindInputs() for virtual_shade.frag, which takes its rays from the parent.
  void bindVirtualInputs(gl::Program& program, const raster::Level& parent, const raster::Chain& chain) const;
  void bindHits(gl::Program& program, const raster::Level& parent, const raster::Chain& chain) const;
  void uploadRects(std::span<const CoverRect> rects, bool withItems);
  /// `output`: bits of Target.
  void drawVariants(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
                    Pass pass, std::span<const CoverRect> rects, unsigned output);

  gl::Program rayProgram_;
  /// Passes that read a material's textures: programs made when first used.
  std::array<std::array<std::unique_ptr<gl::Program>, kVariants>, 5> partPrograms_;
  gl::VertexArray nothing_, rectArray_;
  gl::Buffer rectCorners_, rectIndices_;
  std::size_t indexedRects_ = 0;
  std::vector<vec4> corners_;
  std::vector<std::uint32_t> indices_;
  std::vector<CoverRect> mirrorRects_, otherRects_;
  std::unique_ptr<SceneTriangles> triangles_;
  std::unique_ptr<Targets> targets_;
  float depthFromDistance_ = 1;
  LaneShading inLanes_;
};

}  // namespace catoptric::virtual_object

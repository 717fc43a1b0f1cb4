// SPDX-License-Identifier: Apache-2.0
// The interface of every rasterised way of making reflections. Adding one: a folder, and a row in
// renderer.cpp.
#pragma once

#include <cstdint>
#include <string_view>

#include "catoptric/raster/marks.h"
#include "catoptric/raster/mirror_mask.h"
#include "catoptric/raster/surface_pass.h"

namespace catoptric::raster {

struct MethodCounters {
  std::uint64_t virtualVertices = 0;
  std::uint64_t culledVertices = 0;
  std::uint64_t virtualTriangles = 0;
  std::uint64_t culledTriangles = 0;      ///< in which no pixel has its centre, or that turn their back
  std::uint64_t simplifiedTriangles = 0;  ///< TessellatedObjects::simplifiedTriangles
  std::uint64_t fragmentTests = 0;
  std::uint64_t virtualPixels = 0;  ///< of mirrors drawn in parts: shown by virtual objects
  std::uint64_t boundedPixels = 0;  ///< likewise: left to solver `exact`
  double virtualVerticesMs = 0;
  double coverMs = 0;                  ///< of solver `exact`: where triangles may be seen
  std::uint64_t lookedUpVertices = 0;  ///< of morphing: searched in the octrees, the others were kept
  double lookUpMs = 0;
  std::uint64_t morphedTraces = 0;    ///< how many traces the vertices were morphed for
  std::uint64_t zexels = 0;           ///< warped
  std::uint64_t zexelPixels = 0;      ///< mirror pixels that zexels were warped to show
  std::uint64_t uncoveredPixels = 0;  ///< of which no zexel reached
  std::uint64_t zexelCaptures = 0;    ///< reference images taken
  double warpMs = 0, captureMs = 0;
};

/// What a method gets to work with in one frame.
struct FrameContext {
  const SceneBuffers& scene;
  const scene::CameraFrame& camera;
  SurfacePass& surfaces;
  PrimaryPass& primary;
  ComposePass& compose;
  double nearPlane = 0.01;
  dvec2 jitterPx{0.5, 0.5};
  double maxErrorPx = 0.5;
  Merge merge = Merge::Ids;
  double textureScale = 1;  ///< of Merge::Texture: its pixels along an edge : the picture's
  bool allParts = false;    ///< of virtual objects in parts: whatever they cost
  MethodCounters& counters;
  /// Of the chain that render() gets: surfaces are drawn so, or by looking up ids.
  Masking masking{};
  /// Ids of the level that render() gets as `parent`, bottom row first.
  std::span<const uvec2> parentIds{};
  /// The level that render() gets as `parent`, where a method may add what mirrors show to its radiance at
  /// once, instead of drawing it into `target`: in the last level, when it need not say what is seen. Else
  /// null.
  Level* addsTo = nullptr;
  bool hasAdded = false;  ///< set by a method that did so
};

class ReflectionMethod {
 public:
  virtual ~ReflectionMethod() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  [[nodiscard]] virtual bool supports(const Chain& chain) const = 0;
  /// Once a frame, before the first render().
  virtual void prepare(FrameContext& frame) = 0;
  /// Vertices or reflectors of the scene have moved: whatever was made from them is out of date.
  virtual void geometryChanged() {}
  /// The same, but nothing else has changed than vertices of these parts, and what follows from them.
  virtual void partsMoved(const scene::WorldGeometry&, std::span<const std::uint32_t> /*parts*/) {
    geometryChanged();
  }
  /// Materials look different: the same of pictures that were taken.
  virtual void materialsChanged() {}
  /// Draws what the last mirror of the chain shows into `target`, at the pixels of `parent` that show that
  /// mirror.
  virtual void render(FrameContext& frame, const Chain& chain, const Level& parent, Level& target) = 0;

  /// What the last frame worked with for a mirror that is seen directly; of use until the geometry changes.
  virtual void collectMarks(const scene::WorldGeometry&, std::uint32_t /*reflector*/, const MarkOptions&,
                            Marks&) const {}
};

/// The environment in the mirror direction, behind what has been drawn into the target with its depth.
class MirrorBackgroundPass {
 public:
  MirrorBackgroundPass();
  /// `isFollowed`: false for a mirror that no method draws. What is seen there is the mirror. `rects`: where
  /// it may show; empty: anywhere in the chain's bounds.
  void draw(const SceneBuffers& scene, const Chain& chain, const Level& parent, const Level& target,
            bool isFollowed = true, std::span<const gl::Scissor> rects = {});

 private:
  gl::Program program_, programSeen_;
  gl::VertexArray nothing_;
};

}  // namespace catoptric::raster

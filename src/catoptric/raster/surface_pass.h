// SPDX-License-Identifier: Apache-2.0
// Draws surfaces of the scene, seen directly or through a chain of mirrors, into a level.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "catoptric/gl/program.h"
#include "catoptric/raster/chain.h"
#include "catoptric/raster/level.h"
#include "catoptric/raster/scene_buffers.h"
#include "catoptric/scene/camera_frame.h"

namespace catoptric::raster {

/// Half spaces that keep what lies before all of them: dot(xyz, p) + w >= 0, world.
struct ClipPlanes {
  static constexpr int kMost = gl::kMostClipDistances;
  std::array<vec4, kMost> planes{};
  int count = 0;

  void add(const vec4& plane) { planes[std::size_t(count++)] = plane; }
  [[nodiscard]] std::span<const vec4> span() const { return {planes.data(), std::size_t(count)}; }
};

/// How fragments are kept within the pixels that show the last mirror; MirrorMask says.
struct Masking {
  bool testsIds = true;  ///< they look it up in the level before
  gl::StencilRule stencil = gl::StencilRule::None;
  std::uint8_t stencilValue = 0;
};

/// How points of draw space get to the screen.
struct SurfaceView {
  dmat4 clipFromDraw{1.0};
  dvec3 eye{0};      ///< world (level 0)
  dvec3 drawEye{0};  ///< the eye in draw space
  bool windingFlipped = false;
  const Chain* chain = nullptr;   ///< null: seen directly
  const Level* parent = nullptr;  ///< where the last view ray of each pixel starts; null: at `eye`
  Masking masking;                ///< ids are tested only with `parent`
  ClipPlanes clip;                ///< with `parent` at most one
  std::uint32_t excludedReflector = core::kNoId;
  /// What the pass's own vertex shader needs besides, for a program in use; empty: nothing.
  std::function<void(gl::Program&)> bindVertexShader{};
};

class SurfacePass {
 public:
  SurfacePass() = default;
  /// With another vertex shader, which finds virtual vertices by itself (defines PLACED and `vertexDefines`).
  SurfacePass(std::string vertexFile, std::vector<std::string> vertexDefines)
      : vertexFile_(std::move(vertexFile)), vertexDefines_(std::move(vertexDefines)) {
    vertexDefines_.emplace_back("PLACED");
  }
  /// Opaque and masked parts.
  void draw(const SceneBuffers& scene, const VertexStreams& streams, std::span<const DrawRange> ranges,
            const SurfaceView& view, const Level& target);
  /// Blended parts over it, in the order given (see sortBlendedTriangles()).
  void drawBlended(const SceneBuffers& scene, const VertexStreams& streams, std::span<const DrawRange> ranges,
                   const SurfaceView& view, Level& target);

 private:
  /// A program is made for each set of textures that a material has (bits of SceneBuffers::textureBits()) and
  /// each set of these, when it is first used.
  enum Feature : unsigned {
    kOverlay = 32,
    kMirror = 64,
    kSeen = 128,
    kParent = 256,
    kIds = 512,
    kClip = 1024,
    kEnvironment = 2048
  };

  void drawRanges(const SceneBuffers& scene, const VertexStreams& streams, std::span<const DrawRange> ranges,
                  const SurfaceView& view, unsigned features);
  [[nodiscard]] gl::Program& findProgram(const SceneBuffers& scene, unsigned features);

  std::string vertexFile_ = "raster/surface.vert";
  std::vector<std::string> vertexDefines_;
  std::array<std::unique_ptr<gl::Program>, 4096> programs_;
  std::vector<DrawRange> mirrors_, others_;
};

/// Uniforms of a part: shaders/raster/material_block.glsl.
struct PartConstants {
  std::uint32_t objectWord = 0, reflectorWord = 0;
  vec4 lobes{0};
};
/// `chain`: in which it is seen, null: directly.
[[nodiscard]] PartConstants findPartConstants(const SceneBuffers& scene, std::uint32_t index,
                                              const Chain* chain);
/// For programs that shade surfaces of the scene: how many lights there are, and how constants get to the
/// fragments (raster/hand_on_constants.glsl).
void addConstantsDefines(const SceneBuffers& scene, std::vector<std::string>& defines);
/// Sets what raster/surface_shading.glsl needs, for any part; the program must be in use.
void bindSurfaceShading(gl::Program& program, const SceneBuffers& scene);
/// And for one part, its material included.
void bindPart(gl::Program& program, const SceneBuffers& scene, std::uint32_t part, const Chain* chain);

/// Orders opaque ranges by the distance of their part's box from a point: what is near is drawn first, so
/// that little of what it hides is shaded.
void sortNearFirst(const SceneBuffers& scene, const dvec3& from, std::vector<DrawRange>& ranges);

/// Orders the triangles of `ranges` from far to near, as seen from `eye`, and packs them into new ranges over
/// `sortedIndices`.
void sortBlendedTriangles(std::span<const DrawRange> ranges, std::span<const std::uint32_t> indices,
                          std::span<const vec3> drawPositions, const dvec3& eye,
                          std::vector<std::uint32_t>& sortedIndices, std::vector<DrawRange>& sortedRanges);

/// A view that need not be symmetric about its axis: position (x, y) of the target, pixels from its lower
/// left corner, looks along rayOrigin + x rayDx + y rayDy.
struct PinholeView {
  dvec3 eye{0};
  dvec3 rayOrigin{0, 0, -1}, rayDx{0}, rayDy{0};
  dmat4 clipFromWorld{1.0};
  bool windingFlipped = false;  ///< seen in an odd number of mirrors
  ClipPlanes clip;
};

/// Level 0: environment and scene seen from a camera; also used for the faces of environment maps.
class PrimaryPass {
 public:
  explicit PrimaryPass(SurfacePass& surfaces);
  /// `jitterPx`: where in the pixel the sample lies, (0.5, 0.5) = centre.
  void draw(const SceneBuffers& scene, const scene::CameraFrame& camera, double nearPlane,
            const dvec2& jitterPx, Level& target, std::uint32_t excludedReflector = core::kNoId);
  void geometryChanged() { blendedStreams_.reset(); }
  /// `opaque`: which of the opaque ranges; null = all of them.
  void draw(const SceneBuffers& scene, const PinholeView& pinhole, Level& target,
            std::uint32_t excludedReflector = core::kNoId, const std::vector<DrawRange>* opaque = nullptr);

 private:
  SurfacePass& surfaces_;
  gl::Program background_, backgroundSeen_;
  gl::VertexArray nothing_;
  std::unique_ptr<VertexStreams> blendedStreams_;
  std::vector<std::uint32_t> sortedIndices_;
  std::vector<DrawRange> sortedRanges_;
};

/// A camera's view; `jitterPx` as above.
[[nodiscard]] PinholeView makePinholeView(const scene::CameraFrame& camera, double nearPlane,
                                          const dvec2& jitterPx);

/// World to clip space with the sample moved to the pixel's centre.
[[nodiscard]] dmat4 makeClipFromWorld(const scene::CameraFrame& camera, double nearPlane,
                                      const dvec2& jitterPx);

}  // namespace catoptric::raster

// SPDX-License-Identifier: Apache-2.0
// A frame by any method: primary image, one reflection image per level of mirrors, composition. The entry
// point of the library: load a scene, make a Renderer, render.
#pragma once

#include <array>
#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "catoptric/core/image.h"
#include "catoptric/core/seen.h"
#include "catoptric/depth_reflection_map/zexel_options.h"
#include "catoptric/raster/mark_options.h"
#include "catoptric/raster/merge.h"
#include "catoptric/scene/camera_frame.h"
#include "catoptric/scene/environment.h"
#include "catoptric/scene/scene.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::gl {
class Context;
}

namespace catoptric::renderer {

/// How reflections are made. None: mirrors show the environment only, as they do after the last bounce.
enum class Method { Auto, None, Environment, Virtual, Morphing, Zexel, RayTrace };
/// How the Virtual method finds reflection points on curved mirrors; Exact tests fragments instead.
enum class Solver { Auto, Explosion, Layered, Refined, Exact, Analytic, Subdivision };
/// Where the Virtual method finds virtual vertices: Auto takes a vertex shader where GL is hardware and the
/// solver has one, else the processor.
enum class Backend { Auto, Cpu, Gpu };
using raster::Merge;

/// Names as on the command line.
[[nodiscard]] std::string_view methodName(Method method);
[[nodiscard]] std::string_view solverName(Solver solver);
[[nodiscard]] std::string_view backendName(Backend backend);
[[nodiscard]] std::string_view mergeName(Merge merge);
/// Whether FrameOptions::merge has a say in this method.
[[nodiscard]] bool hasMerges(Method method);
/// Whether FrameOptions::solver has a say in this method.
[[nodiscard]] bool hasSolvers(Method method);
/// Whether a vertex shader does what the solver does (Auto: where it takes Refined).
[[nodiscard]] bool hasVertexShader(Solver solver);

struct FrameOptions {
  Method method = Method::Auto;
  Solver solver = Solver::Auto;
  Backend backend = Backend::Auto;
  int widthPx = 960, heightPx = 720;
  int bounces = 1;
  Merge merge = Merge::Ids;  ///< how pictures in mirrors are kept within them
  double textureScale = 1;   ///< Merge::Texture: resolution of the textures : the picture's, at most 1
  int samples = 1;           ///< per pixel, for radiance; what is seen is always sampled at the pixel centre
  double maxErrorPx = 0.5;   ///< aim of the tessellation of reflected objects
  /// Refined, mirrors that are not convex: a virtual object for each part where it is expected to be right,
  /// even if solver Exact is expected to be faster there.
  bool allParts = false;
  bool boxCorrected = true;      ///< Environment: parallax-corrected by the box of the room; false: plain
  int environmentMapSize = 512;  ///< Environment: edge of a cube face, texels
  std::string bakedFile{};       ///< Morphing: of `catoptric bake`; empty: baked where the eye is
  int mappedBelowPixels = 1024;  ///< Morphing: mirrors that cover fewer pixels get environment maps
  bool allDynamic = false;       ///< Morphing: every vertex counts as moving
  depth_reflection_map::ZexelOptions zexel{};  ///< Zexel only
  bool withSeen = true;                        ///< read back what is seen at each pixel
  /// Without `withSeen`: draw by the same programs all the same. Who draws both kinds of frames in turn has
  /// half as many to compile so; it costs a picture more that is written.
  bool drawsSeen = false;
  /// Others follow at once, as while the eye is led by a mouse: `auto` stays with what it picked for the last
  /// frame that was not passing, or goes by shape.
  bool isPassing = false;
  /// RayTrace: once it is true, which any thread may make it, the frame ends early and is of no use.
  const std::atomic<bool>* cancel = nullptr;
};

struct FrameTimings {
  double totalMs = 0;            ///< the frame, without reading it back
  double primaryMs = 0;          ///< the picture without reflections
  double reflectionMs = 0;       ///< everything else; RayTrace: all rays but those of the eye
  double virtualVerticesMs = 0;  ///< of which: finding reflection points
  double coverMs = 0;            ///< of which: Exact: where triangles may be seen
  double lookUpMs = 0;           ///< Morphing: look-ups in the octrees, not part of virtualVerticesMs
  double warpMs = 0;             ///< of which: warping zexels
  double captureMs = 0;          ///< of which: taking reference images
};

struct FrameCounters {
  std::uint64_t virtualVertices = 0;  ///< reflection points sought
  std::uint64_t culledTriangles = 0;  ///< virtual ones that show at no pixel
  std::uint64_t simplifiedTriangles =
      0;                               ///< of the scene, for which the fewer ones of a level of detail stood
  std::uint64_t culledVertices = 0;    ///< not sought, because no reflected ray comes near their triangles
  std::uint64_t virtualTriangles = 0;  ///< drawn into reflection images
  std::uint64_t fragmentTests = 0;     ///< Exact: pixels that met a triangle offered to them, or did not
  std::uint64_t virtualPixels = 0;     ///< Refined, mirrors not convex: shown by virtual objects
  std::uint64_t boundedPixels = 0;     ///< of the same, left to Exact
  std::uint64_t lookedUpVertices = 0;  ///< Morphing: searched in the octrees in this frame
  std::uint64_t morphedTraces = 0;     ///< Morphing: traces that the vertices went through, of one sample
  std::uint64_t reflectorsDrawn = 0, reflectorsCulled = 0;
  std::uint64_t rays = 0;             ///< RayTrace only
  std::uint64_t zexels = 0;           ///< warped
  std::uint64_t zexelPixels = 0;      ///< mirror pixels that zexels were warped to show
  std::uint64_t uncoveredPixels = 0;  ///< of which no zexel reached
  std::uint64_t zexelCaptures = 0;    ///< reference images taken
};

/// What of the last frame's method is looked at from elsewhere.
struct ElsewhereOptions {
  std::uint32_t reflector = core::kNoId;  ///< the mirror whose method is looked at; left out of the scene
  raster::MarkOptions marks;
  int widthPx = 640, heightPx = 480;

  bool operator==(const ElsewhereOptions&) const = default;
};

/// What virtual objects would show of a curved mirror (virtual_object/mixed/view_forecast.h); shares 0 to 1.
struct ViewForecast {
  std::size_t parts = 0;              ///< that bend one way
  double pixels = 0;                  ///< that show it
  double offered = 0, triangles = 0;  ///< MirrorLoad, from which times are expected
  double oneToOne = 0, nearFocus = 0, self = 0;
};

/// One way of drawing a curved mirror, and what is expected of it in a view (choose_method.h).
struct MethodCandidate {
  Method method = Method::Virtual;
  Solver solver = Solver::Auto;
  double errorPx = 0;  ///< 95th percentile, of mirror pixels or of those that show objects: the worse
  bool isErrorAtLeast = false;  ///< past the bound, by how much was not asked
  double ms = 0;                ///< of a frame in which nothing has moved, where OpenGL is software
};

/// Why a reflector is drawn the way it is; for `info`.
struct MethodChoice {
  Method method = Method::Virtual;
  Solver solver = Solver::Refined;
  std::string reason{};
  std::string analytic{};                  ///< why solver Analytic cannot serve it; empty where it can
  std::optional<ViewForecast> forecast{};  ///< of a curved mirror, where a view was asked for
  std::vector<MethodCandidate>
      candidates{};  ///< likewise: map, refined, exact; empty where there is no choice
};

struct Frame {
  core::ImageRgbaF radiance;  ///< linear; alpha 1 (0 never occurs: the environment is behind everything)
  core::SeenImage seen;       ///< empty unless asked for
  core::FootprintImage footprints;  ///< RayTrace only
  FrameTimings timings;
  FrameCounters counters;
  /// Method Auto, while nothing has moved: what was picked for curved mirrors seen directly, by reflector.
  std::map<std::uint32_t, MethodChoice> choices;
};

/// A GL context that renderers on this thread may share, one after the other. Worth making before the scene
/// is there: loading a driver takes a while. Throws core::Error("gl.unavailable").
[[nodiscard]] std::shared_ptr<gl::Context> makeSharedContext();

/// Owns the GL context (made on first need, or shared) and all buffers of one scene. Not thread-safe.
class Renderer {
 public:
  /// Arguments must outlive the renderer.
  Renderer(const scene::Scene& scene, const scene::WorldGeometry& geometry,
           const scene::Environment& environment, std::shared_ptr<gl::Context> context = nullptr);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Throws core::Error("gl.*") when there is no usable GL, with the remedy, and
  /// core::Error("renderer.backend") for Backend::Gpu with a solver that has no vertex shader.
  [[nodiscard]] Frame render(const scene::Camera& camera, const FrameOptions& options);

  /// The scene as a camera elsewhere sees it (1998, fig. 10 and 11), with what the last render() worked with
  /// for one mirror: virtual object, tessellation, cells, octree, zexels. Mirrors show the surroundings only,
  /// the mirror that is looked at its triangles. Before a render(), the scene alone. Linear radiance.
  [[nodiscard]] core::ImageRgbaF renderElsewhere(const scene::Camera& camera,
                                                 const ElsewhereOptions& options);

  /// After vertices of these parts of the geometry, or reflectors, have moved (scene::WorldMotion).
  void updateGeometry(std::span<const std::uint32_t> movedParts);

  /// After values of materials, not their textures, or reflectivities of reflectors have changed
  /// (scene::changeMaterial()).
  void updateMaterials();

  /// Writes the reference images of zexels to ZexelOptions::cacheFile, when there are new ones. Throws
  /// core::Error("file.write").
  void saveReferenceImages();

  /// What `auto` picks for a reflector by its shape; MethodChooser knows the view, too.
  [[nodiscard]] static MethodChoice chooseMethod(const scene::Reflector& reflector);

  /// "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 3.3 core, Mesa 22.3.6"; makes the context.
  [[nodiscard]] std::string describeGl();
  /// What Backend::Auto stands for here: Cpu where GL is software; makes the context.
  [[nodiscard]] Backend chooseBackend();
  [[nodiscard]] std::string describeRayTracer();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catoptric::renderer

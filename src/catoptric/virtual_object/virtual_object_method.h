// SPDX-License-Identifier: Apache-2.0
// Draws virtual objects: for a chain of mirrors with one curved link, every vertex of the tessellated scene
// is moved to its virtual vertex, and the result is rasterised into the mirror's pixels (1998, figures 1 and
// 3). Virtual vertices are found by the processor, or by a vertex shader (draw_on_gpu.cpp).
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "catoptric/raster/reflection_method.h"
#include "catoptric/raster/tessellation.h"
#include "catoptric/raster/virtual_object_pass.h"
#include "catoptric/virtual_object/exact/exact_method.h"
#include "catoptric/virtual_object/layered_finder.h"
#include "catoptric/virtual_object/mirror_textures.h"
#include "catoptric/virtual_object/mixed/incomplete_triangles.h"
#include "catoptric/virtual_object/mixed/interval_search.h"
#include "catoptric/virtual_object/mixed/part_image.h"
#include "catoptric/virtual_object/mixed/part_pixels.h"
#include "catoptric/virtual_object/number_raster.h"
#include "catoptric/virtual_object/numbered_triangles.h"
#include "catoptric/virtual_object/part_rects.h"
#include "catoptric/virtual_object/reflector_mesh.h"
#include "catoptric/virtual_object/virtual_object_solver.h"

namespace catoptric::virtual_object {

class VirtualObjectMethod : public raster::ReflectionMethod {
 public:
  /// `exact` draws what virtual objects cannot; it and `shading` must outlive the method.
  VirtualObjectMethod(Solver solver, HitShading& shading, ExactMethod& exact)
      : solver_(solver), shading_(shading), exact_(exact) {}
  [[nodiscard]] std::string_view name() const override { return "virtual"; }
  [[nodiscard]] bool supports(const raster::Chain& chain) const override {
    return chain.curved.has_value() && !chain.hasSecondCurved && !chain.hasRefractor();
  }
  /// `onGpu`: where the solver has a vertex shader and the mirror fits into textures.
  /// `numbersByGl`: where the processor finds virtual vertices, does GL draw their numbers
  /// (numbered_triangles.h), or the processor as well (number_raster.h)?
  void setSolver(Solver solver, bool onGpu = false, bool numbersByGl = true) {
    solver_ = solver;
    onGpu_ = onGpu;
    numbersByGl_ = numbersByGl;
  }
  /// Gives the mirrors that the last frame showed the new eye, all at once.
  void prepare(raster::FrameContext& frame) override;
  void geometryChanged() override {
    last_.clear();
    prepared_.clear();
    uncut_.reset();
  }
  /// Mirrors that have not moved keep their maps, and what has not moved keeps its cuts.
  void partsMoved(const scene::WorldGeometry& world, std::span<const std::uint32_t> parts) override;
  void render(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
              raster::Level& target) override;
  /// May render() and addTogether() be given chains of flat mirrors alone? The virtual object is the
  /// scene itself then, seen by the mirrored eye; it is drawn as numbers, where the processor draws and
  /// shades.
  [[nodiscard]] bool drawsFlat(const raster::FrameContext& frame) const;
  /// Adds what the last mirrors of some of the chains show to the radiance of frame.addsTo, which is not
  /// null, all at once: of flat and convex ones, where the processor draws numbers and shades. Returns the
  /// others, for render().
  [[nodiscard]] std::vector<const raster::Chain*> addTogether(raster::FrameContext& frame,
                                                              std::vector<const raster::Chain*> chains,
                                                              const raster::Level& parent);

  /// Draws the virtual object of a mirror, as the last frame has computed it, for an eye that is elsewhere.
  void drawFromElsewhere(raster::FrameContext& frame, std::uint32_t reflector,
                         const raster::SurfaceView& elsewhere, raster::Level& target);
  void collectMarks(const scene::WorldGeometry& world, std::uint32_t reflector,
                    const raster::MarkOptions& options, raster::Marks& marks) const override;

 private:
  /// How virtual triangles get into the picture. AsPublished: all of them as they are, interpolated;
  /// Interpolated: without what turns its back, with levels of detail; Numbered: besides, drawn as numbers
  /// and shaded once a pixel.
  enum class Drawing : std::uint8_t { AsPublished, Interpolated, Numbered };
  /// What the GPU backend keeps for one curved reflector.
  struct OnGpu {
    explicit OnGpu(const raster::TessellatedObjects& objects) : streams(objects) {}
    raster::VertexStreams streams;
    std::unique_ptr<LayeredFinder> layers;  ///< Layered, Refined: the maps
    std::unique_ptr<MirrorTextures> textures;
    Solver texturesOf = Solver::Refined;
    std::optional<dvec3> eye;               ///< of the textures
    std::vector<std::uint8_t> blendedRuns;  ///< by run: holds a vertex of a blended part
    bool hasBlended = false;
  };
  /// A solver that follows the eye.
  struct Search {
    /// Makes the solver, or gives it the eye. `mesh` must outlive it.
    void setEye(const ReflectorMesh& mesh, const core::Box& sceneBounds, const dvec3& eye,
                const SolverOptions& options);
    std::unique_ptr<VirtualObjectSolver> solver;
    double farRadius = 0;               ///< that it was made for
    Solver finderOf = Solver::Refined;  ///< whose finder it was given
    LanePlaces places;                  ///< of the last frame, where the next one begins
  };
  /// What is kept for a mirror that is not convex.
  struct InParts {
    explicit InParts(const ReflectorMesh& mesh);
    struct Part : Search {
      MirrorPart shape;
      std::unique_ptr<IntervalSearch> intervals;  ///< where it is not convex; made when first needed
      std::array<bool, kIntervals> isWorthIt{};   ///< a virtual object, for the last eye
      std::array<IntervalVertices, kIntervals> found;
      [[nodiscard]] bool isAnyWorthIt() const { return isWorthIt[0] || isWorthIt[1] || isWorthIt[2]; }
    };
    std::vector<Part> parts;
    PartBuffers buffers;
    /// For what parts were judged.
    struct Judged {
      dvec3 eye{0};
      double pixelsPerTangent = 0;
      bool all = false;
      bool operator==(const Judged&) const = default;
    };
    std::optional<Judged> judged;

   private:
    InParts(const ReflectorMesh& mesh, CutMirror cut);
  };
  /// Where a part is seen.
  struct PartView {
    const InParts::Part& part;
    std::uint32_t number;
    gl::Scissor bounds;
  };
  /// Everything kept for one curved reflector from frame to frame.
  struct Prepared : Search {
    Prepared(const scene::WorldGeometry& world, std::uint32_t reflector, bool flipped,
             const raster::TessellationOptions& options, bool mayBeInParts);
    /// After partsMoved(): what follows from the objects.
    void update(const scene::WorldGeometry& world);
    double maxErrorPx, sizePx;  ///< of its TessellationOptions
    bool isFromBehind;          ///< the eye is behind a double-sided mirror
    ReflectorMesh mesh;
    raster::ReflectorTessellation tessellation;
    const raster::TessellatedObjects& objects;  ///< of the tessellation
    std::vector<std::uint32_t> movedParts;      ///< since they were cut
    VertexRuns runs;
    TriangleRuns triangleRuns;
    raster::VirtualObjectPass pass;
    std::unique_ptr<NumberedTriangles> numbered;    ///< made when first needed
    std::vector<std::uint8_t> isNumbered, isDrawn;  ///< by part: how it is drawn
    std::vector<vec3> scenePoints;  ///< vertices mirrored by the planar links behind the curved one
    std::vector<vec3> virtualPositions, reflectionPoints;
    std::vector<VertexKind> kinds;
    std::vector<VertexBits> mayReflect;  ///< by run
    std::unique_ptr<OnGpu> gpu;          ///< made when first needed
    std::unique_ptr<InParts> inParts;    ///< likewise
    dvec3 eye{0};                        ///< of the last frame
    bool isFoundOnCpu = false;           ///< the arrays above are those of the solver's eye
  };
  /// A mirror that is drawn as numbers, while it is drawn; keeps its memory.
  struct NumberedMirror {
    const raster::Chain* chain = nullptr;
    raster::SurfaceView view;
    Prepared* prepared = nullptr;  ///< of a curved one; null: a flat one
    const raster::TessellatedObjects* objects = nullptr;
    const TriangleRuns* runs = nullptr;  ///< of the objects
    ReflectedBeams pictureBeam;          ///< of a flat one
    std::span<const vec3> virtualPositions;
    std::span<const std::uint32_t> triangleParts;  ///< by number
    std::vector<std::uint8_t> isNumbered;          ///< by part
    std::vector<vec3> screen;                      ///< projectVertices()
    raster::VirtualTriangles triangles;
    NumberRaster raster;  ///< where the processor draws
    NumberImage numbers;
    LaneShading inLanes;
    std::size_t culled = 0, drawn = 0;  ///< triangles
  };
  void drawPartsFromElsewhere(raster::FrameContext& frame, Prepared& prepared, raster::SurfaceView& view,
                              const std::function<void(std::span<const vec3>)>& draw);
  static void addTessellation(const scene::WorldGeometry& world, const Prepared& p, raster::Marks& marks);
  static void addCells(const Prepared& p, double rayLength, raster::Marks& marks);
  static void addPath(const Prepared& p, const dvec3& point, raster::Marks& marks);
  [[nodiscard]] static raster::LongestChords findLongestChords(const Prepared& prepared);
  /// True where the environment is there, too.
  bool drawObjects(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
                   raster::Level& target);
  static raster::SurfaceView makeView(const raster::FrameContext& frame, const raster::Chain& chain,
                                      const dvec3& drawEye, const raster::Level& parent);
  Prepared& prepareReflector(const raster::FrameContext& frame, const raster::Chain& chain,
                             const dvec3& drawEye);
  [[nodiscard]] static dvec3 findDrawEye(const raster::FrameContext& frame, const raster::Chain& chain);
  /// For the next frame.
  void noteShown(const raster::Chain& chain, Prepared& prepared, const dvec3& drawEye);
  /// For that eye, unless the GPU does so; their time is counted. False where nothing is reflected.
  bool findVertices(raster::FrameContext& frame, const raster::Chain& chain, Prepared& prepared) const;
  [[nodiscard]] SolverOptions solverOptions() const;
  /// Of all vertices that may be reflected; `wanted`: only of these runs (empty: of all).
  void computeVirtualVertices(raster::FrameContext& frame, const raster::Chain& chain, Prepared& prepared,
                              std::span<const std::uint8_t> wanted = {}) const;

  /// Gives the solver what the wanted one asks; Refined where that cannot serve the mirror.
  [[nodiscard]] Solver equipSolver(const scene::WorldGeometry& world, std::uint32_t reflector,
                                   Prepared& prepared) const;

  /// Numbers are not for flat mirrors behind the curved one, which cut triangles, nor for a scene too large
  /// for textures.
  [[nodiscard]] bool canUseNumbers(const raster::Chain& chain, const scene::WorldGeometry& world) const {
    return solver_ == Solver::Refined && chain.last == *chain.curved && SceneTriangles::fits(world);
  }
  /// Nor are they for a vertex shader.
  [[nodiscard]] Drawing findDrawing(const raster::Chain& chain, const scene::WorldGeometry& world) const {
    if (solver_ == Solver::Explosion) return Drawing::AsPublished;
    return !onGpu_ && canUseNumbers(chain, world) ? Drawing::Numbered : Drawing::Interpolated;
  }
  /// What a vertex shader has found, once more where the processor can read it.
  void completeOnCpu(const scene::WorldGeometry& world, std::uint32_t reflector, Prepared& prepared) const;
  [[nodiscard]] bool usesGpu(const Prepared& prepared) const;
  void prepareTextures(const raster::FrameContext& frame, Prepared& prepared) const;
  void drawOnGpu(raster::FrameContext& frame, const raster::Chain& chain, const raster::SurfaceView& view,
                 Prepared& prepared, raster::Level& target);
  /// What of the scene is blended is sorted by its virtual vertices, which the processor finds.
  void drawBlended(raster::FrameContext& frame, const raster::Chain& chain, const raster::SurfaceView& view,
                   Prepared& prepared, raster::Level& target);
  NumberedMirror& beginMirror(std::size_t index, const raster::FrameContext& frame,
                              const raster::Chain& chain, const raster::SurfaceView& view,
                              Prepared* prepared);
  void beginFlat(const raster::FrameContext& frame, NumberedMirror& mirror);
  static void markTriangles(const raster::FrameContext& frame, NumberedMirror& mirror);
  void drawNumbersByGl(raster::FrameContext& frame, NumberedMirror& mirror);
  void drawNumbersHere(const raster::FrameContext& frame, NumberedMirror& mirror, bool withDepths) const;
  static void countTriangles(raster::FrameContext& frame, const NumberedMirror& mirror);
  /// Is there anything that numbers do not serve?
  [[nodiscard]] static bool hasSurfaces(const Prepared& prepared);
  enum class Begun : std::uint8_t { Yes, Later, No };
  Begun beginAdding(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
                    std::size_t index);
  /// The first `count` of numberedMirrors_.
  void addBegun(raster::FrameContext& frame, const raster::Level& parent, std::size_t count);
  /// True where the environment is there, too.
  bool drawNumbered(raster::FrameContext& frame, NumberedMirror& mirror, raster::Level& target);

  /// Is the mirror drawn part by part? A scene too large for textures is drawn as if it were convex.
  [[nodiscard]] bool isInParts(const Prepared& prepared, const scene::WorldGeometry& world) const {
    return solver_ == Solver::Refined && !prepared.mesh.isConvex() && SceneTriangles::fits(world);
  }
  /// Are there surfaces that numbers do not serve?
  static bool hasCutOuts(const raster::SceneBuffers& scene);
  /// Draws what the mirror shows, environment and all.
  void drawInParts(raster::FrameContext& frame, const raster::Chain& chain, const raster::SurfaceView& view,
                   const raster::Level& parent, raster::Level& target, Prepared& prepared);
  bool forecastParts(const raster::FrameContext& frame, const raster::Chain& chain, const dvec3& drawEye,
                     Prepared& prepared);
  void drawPartNumbers(raster::FrameContext& frame, const raster::Chain& chain,
                       const raster::SurfaceView& view, const RayImages& rays, Prepared& prepared);
  /// False where the eye sees no front of the part.
  bool findPartVertices(raster::FrameContext& frame, const dvec3& drawEye, InParts::Part& part,
                        Prepared& prepared) const;
  void drawInterval(raster::FrameContext& frame, const raster::SurfaceView& view, const RayImages& rays,
                    const PartView& part, std::size_t interval, const Prepared& prepared);

  Solver solver_;
  bool onGpu_ = false, numbersByGl_ = true;
  std::map<Solver, std::unique_ptr<raster::SurfacePass>> gpuSurfaces_;  ///< by solver, made when first needed
  HitShading& shading_;
  ExactMethod& exact_;
  std::unique_ptr<PartImage> partImage_;  ///< made when first needed
  std::vector<uvec2> partNumbers_;
  MirrorPixels partPixels_;
  std::array<std::vector<vec3>, kIntervals> intervalScreens_;
  std::vector<std::uint8_t> isDone_;
  gl::Program numberProgram_{"virtual_object/virtual_triangle.vert", "virtual_object/virtual_triangle.frag"};
  raster::VirtualTriangles triangles_;
  std::vector<raster::DrawRange> ranges_;
  std::vector<std::unique_ptr<NumberedMirror>> numberedMirrors_;
  /// The scene, for flat mirrors.
  struct Uncut {
    explicit Uncut(const scene::WorldGeometry& world)
        : objects(raster::makeUncutObjects(world)), runs(world.positions, objects.indices) {}
    raster::TessellatedObjects objects;
    TriangleRuns runs;
  };
  std::unique_ptr<Uncut> uncut_;  ///< made when first needed
  std::vector<vec4> mirrorPositions_;
  NumberRaster raster_;
  NumberImage numbers_;
  PartRects rects_;
  raster::MirrorBackgroundPass background_;
  /// By reflector, whether it is seen from behind, whether flat mirrors stand behind it, size of the
  /// tessellation.
  std::map<std::tuple<std::uint32_t, bool, bool, Drawing, double>, std::unique_ptr<Prepared>> prepared_;
  std::map<std::uint32_t, Prepared*> last_;  ///< of the last frame, by reflector seen directly
};

}  // namespace catoptric::virtual_object

// SPDX-License-Identifier: Apache-2.0
// Draws virtual objects: for a chain of mirrors with one curved link, every vertex of the tessellated scene
// is moved to its virtual vertex, and the result is rasterised into the mirror's pixels (1998, figures 1 and
// 3).
#pragma once

#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "catoptric/raster/reflection_method.h"
#include "catoptric/raster/tessellation.h"
#include "catoptric/raster/virtual_object_pass.h"
#include "catoptric/virtual_object/numbered_triangles.h"
#include "catoptric/virtual_object/reflector_mesh.h"
#include "catoptric/virtual_object/virtual_object_solver.h"

namespace catoptric::virtual_object {

class VirtualObjectMethod : public raster::ReflectionMethod {
 public:
  /// `shading` must outlive the method.
  VirtualObjectMethod(Solver solver, HitShading& shading) : solver_(solver), shading_(shading) {}
  [[nodiscard]] std::string_view name() const override { return "virtual"; }
  [[nodiscard]] bool supports(const raster::Chain& chain) const override {
    return chain.curved.has_value() && !chain.hasSecondCurved && !chain.hasRefractor();
  }
  void setSolver(Solver solver) { solver_ = solver; }
  void prepare(raster::FrameContext&) override { last_.clear(); }
  void geometryChanged() override {
    last_.clear();
    prepared_.clear();
  }
  void render(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
              raster::Level& target) override;

  /// Draws the virtual object of a mirror, as the last frame has computed it, for an eye that is elsewhere.
  void drawFromElsewhere(raster::FrameContext& frame, std::uint32_t reflector,
                         const raster::SurfaceView& elsewhere, raster::Level& target);
  void collectMarks(const scene::WorldGeometry& world, std::uint32_t reflector,
                    const raster::MarkOptions& options, raster::Marks& marks) const override;

 private:
  /// Everything kept for one curved reflector from frame to frame.
  struct Prepared {
    Prepared(const scene::WorldGeometry& world, std::uint32_t reflector, bool flipped,
             const raster::TessellationOptions& tessellation);
    double maxErrorPx;
    bool isFromBehind;  ///< the eye is behind a double-sided mirror
    ReflectorMesh mesh;
    raster::TessellatedObjects objects;
    VertexRuns runs;
    raster::VirtualObjectPass pass;
    std::unique_ptr<NumberedTriangles> numbered;    ///< made when first needed
    std::vector<std::uint8_t> isNumbered, isDrawn;  ///< by part: how it is drawn
    std::unique_ptr<VirtualObjectSolver> solver;
    Solver finderOf = Solver::Refined;  ///< whose finder the solver was given
    std::vector<vec3> scenePoints;      ///< vertices mirrored by the planar links behind the curved one
    std::vector<vec3> virtualPositions, reflectionPoints;
    std::vector<VertexKind> kinds;
    std::vector<std::uint8_t> mayReflect;  ///< by run
  };
  static void addTessellation(const scene::WorldGeometry& world, const Prepared& p, raster::Marks& marks);
  static void addCells(const Prepared& p, double rayLength, raster::Marks& marks);
  static void addPath(const Prepared& p, const dvec3& point, raster::Marks& marks);
  void drawObjects(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
                   raster::Level& target);
  Prepared& prepareReflector(const raster::FrameContext& frame, const raster::Chain& chain,
                             const dvec3& drawEye);
  void computeVirtualVertices(raster::FrameContext& frame, const raster::Chain& chain, const dvec3& drawEye,
                              Prepared& prepared) const;

  /// Gives the solver what the wanted one asks; Refined where that cannot serve the mirror.
  [[nodiscard]] Solver equipSolver(const scene::WorldGeometry& world, std::uint32_t reflector,
                                   Prepared& prepared) const;

  /// Are triangles drawn as numbers, and shaded once a pixel? Not those of the method as published, nor those
  /// that a flat mirror behind the curved one cuts, nor those of a scene too large for textures.
  [[nodiscard]] bool usesNumbers(const raster::Chain& chain, const scene::WorldGeometry& world) const {
    return solver_ == Solver::Refined && chain.last == *chain.curved && SceneTriangles::fits(world);
  }
  void drawNumbered(raster::FrameContext& frame, const raster::Chain& chain, const raster::SurfaceView& view,
                    Prepared& prepared, raster::Level& target);

  Solver solver_;
  HitShading& shading_;
  gl::Program numberProgram_{"virtual_object/virtual_triangle.vert", "virtual_object/virtual_triangle.frag"};
  raster::VirtualTriangles triangles_;
  std::vector<raster::DrawRange> ranges_;
  std::vector<uvec2> hits_;
  std::vector<vec2> screen_;
  PartRects rects_;
  raster::MirrorBackgroundPass background_;
  /// By reflector, whether it is seen from behind, whether it sees the objects directly, size of the
  /// tessellation.
  std::map<std::tuple<std::uint32_t, bool, bool, double>, std::unique_ptr<Prepared>> prepared_;
  std::map<std::uint32_t, Prepared*> last_;  ///< of the last frame, by reflector seen directly
};

}  // namespace catoptric::virtual_object

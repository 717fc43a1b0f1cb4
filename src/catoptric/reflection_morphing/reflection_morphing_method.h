// SPDX-License-Identifier: Apache-2.0
// Draws morphed reflections: for each chain of mirrors that is a baked trace, the vertices of the tessellated
// scene are morphed and rasterised into the mirror's pixels (2004, section 6).
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "catoptric/raster/reflection_method.h"
#include "catoptric/raster/tessellation.h"
#include "catoptric/raster/virtual_object_pass.h"
#include "catoptric/reflection_morphing/location_source.h"
#include "catoptric/reflection_morphing/morphing.h"

namespace catoptric::reflection_morphing {

class ReflectionMorphingMethod : public raster::ReflectionMethod {
 public:
  [[nodiscard]] std::string_view name() const override { return "morphing"; }
  /// After prepare(): a trace that is seen from the cell of the eye. Mirrors without one (too small, baked
  /// with fewer bounces, eye outside the grid) are left to the next method of the table.
  [[nodiscard]] bool supports(const raster::Chain& chain) const override;
  void setSource(std::shared_ptr<const LocationSource> source);
  /// Asks for a new source: the mirrors may have moved, and then the old one is of no use.
  void geometryChanged() override {
    setSource(nullptr);
    objects_.clear();
  }
  [[nodiscard]] bool hasSource() const { return source_ != nullptr; }
  /// True: every vertex counts as moving and is looked up anew in every frame.
  void setDynamic(bool dynamic) { dynamic_ = dynamic; }
  /// Finds the cell of the eye and loads its locations.
  void prepare(raster::FrameContext& frame) override;
  void render(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
              raster::Level& target) override;

 private:
  /// What a curved mirror may reflect; kept from frame to frame.
  struct Objects {
    Objects(const scene::WorldGeometry& world, std::uint32_t reflector, double maxErrorPx);
    double maxErrorPx;
    raster::TessellatedObjects objects;
    raster::VirtualObjectPass pass;
    std::vector<vec3> virtualPositions, mirrorPoints;
  };
  Objects& getObjects(const raster::FrameContext& frame, std::uint32_t reflector);
  void drawObjects(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
                   raster::Level& target);
  [[nodiscard]] CellTrace findCellTrace(const std::vector<std::uint32_t>& trace) const;
  void morph(raster::FrameContext& frame, const raster::Chain& chain, Objects& objects);

  std::shared_ptr<const LocationSource> source_;
  bool dynamic_ = false;
  std::optional<SamplingCell> cell_;
  std::map<std::uint32_t, std::shared_ptr<const SamplingLocation>> locations_;  ///< of the cell
  raster::MirrorBackgroundPass background_;
  std::map<std::uint32_t, std::unique_ptr<Objects>> objects_;  ///< by reflector
  std::map<Trace, CornerPoints> corners_;                      ///< of the cell; static vertices
};

}  // namespace catoptric::reflection_morphing

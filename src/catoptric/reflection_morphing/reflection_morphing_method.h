// SPDX-License-Identifier: Apache-2.0
// Draws morphed reflections: for each chain of mirrors that is a baked trace, the vertices of the tessellated
// scene are morphed and rasterised into the mirror's pixels (2004, section 6).
#pragma once

#include <compare>
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
    isMoving_.clear();
  }
  /// The same, if a mirror is among the parts. Else they are looked up anew from now on after each such call,
  /// and everything else stays as it is.
  void partsMoved(const scene::WorldGeometry& world, std::span<const std::uint32_t> parts) override;
  [[nodiscard]] bool hasSource() const { return source_ != nullptr; }
  /// True: every vertex counts as moving and is looked up anew in every frame.
  void setDynamic(bool dynamic) { dynamic_ = dynamic; }
  /// Finds the cell of the eye and loads its locations.
  void prepare(raster::FrameContext& frame) override;
  void render(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
              raster::Level& target) override;
  void collectMarks(const scene::WorldGeometry& world, std::uint32_t reflector,
                    const raster::MarkOptions& options, raster::Marks& marks) const override;

 private:
  /// What a curved mirror may reflect, and at which size of the mirror; what moves is apart from the rest.
  struct ObjectsKey {
    std::uint32_t reflector = 0;
    double sizePx = 0;
    bool areMoving = false;
    bool isLast = true;  ///< of the chain: no mirror behind it shows it what lies behind it
    // NOLINTNEXTLINE(modernize-use-nullptr): of the comparison with 0 that the compiler makes.
    auto operator<=>(const ObjectsKey&) const = default;
  };
  /// Kept from frame to frame.
  struct Objects {
    Objects(const scene::WorldGeometry& world, std::uint32_t reflector,
            const raster::TessellationOptions& options);
    double maxErrorPx;
    raster::TessellatedObjects objects;
    raster::VirtualObjectPass pass;
    std::vector<vec3> virtualPositions, mirrorPoints;
  };
  Objects& getObjects(const raster::FrameContext& frame, const ObjectsKey& key);
  /// Those of the whole scene, or of it but what moves, or of what moves.
  void drawObjects(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
                   bool areMoving, raster::Level& target);
  [[nodiscard]] CellTrace findCellTrace(const std::vector<std::uint32_t>& trace) const;
  CornerPoints& morph(raster::FrameContext& frame, const raster::Chain& chain, const ObjectsKey& key,
                      Objects& objects);

  std::shared_ptr<const LocationSource> source_;
  bool dynamic_ = false;
  std::optional<SamplingCell> cell_;
  std::map<std::uint32_t, std::shared_ptr<const SamplingLocation>> locations_;  ///< of the cell
  raster::MirrorBackgroundPass background_;
  std::vector<std::uint8_t> isMoving_;  ///< by part; empty: nothing moves
  std::map<ObjectsKey, std::unique_ptr<Objects>> objects_;
  std::map<std::pair<Trace, ObjectsKey>, CornerPoints> corners_;  ///< of the cell
};

}  // namespace catoptric::reflection_morphing

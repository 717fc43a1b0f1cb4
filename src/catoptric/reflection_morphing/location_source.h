// SPDX-License-Identifier: Apache-2.0
// Where sampling locations come from: a baked file, or baked when the eye comes near.
#pragma once

#include <memory>

#include "catoptric/reflection_morphing/sampling_grid.h"
#include "catoptric/reflection_morphing/sampling_location.h"

namespace catoptric::reflection_morphing {

class LocationSource {
 public:
  virtual ~LocationSource() = default;
  [[nodiscard]] virtual const SamplingGrid& grid() const = 0;
  /// Any thread. Throws core::Error where the location cannot be had.
  [[nodiscard]] virtual std::shared_ptr<const SamplingLocation> load(std::uint32_t index) const = 0;
};

/// What a grid is baked from; the same for a file and for baking on the fly.
struct BakePlan {
  SamplingGrid grid;
  BakeOptions options;
};

/// How far apart sampling locations may be for an eye in `eyes` so that 95 % of the pixels of any curved
/// mirror of the scene keep within `maxErrorPx` where the mirror is 700 px wide; 0 without curved mirrors.
[[nodiscard]] double findSpacing(const scene::WorldGeometry& world, const core::Box& eyes, double maxErrorPx);
inline constexpr double kDefaultMaxErrorPx = 0.5;

/// A grid over the box with locations at most `spacing` metres apart, but no more than `mostCells` cells each
/// way; 1 cell each way for a spacing of 0.
[[nodiscard]] SamplingGrid makeGrid(const core::Box& box, double spacing, std::uint32_t mostCells);

/// The space around the scene for kDefaultMaxErrorPx, but at most kMostDefaultCells each way.
[[nodiscard]] BakePlan makeDefaultPlan(const scene::WorldGeometry& world);
inline constexpr std::uint32_t kMostDefaultCells = 64;

/// For baking on the fly: a grid as fine as an eye at `eye` needs it, as far as 32 bits number its locations.
[[nodiscard]] BakePlan makePlanAround(const scene::WorldGeometry& world, const dvec3& eye);

/// The box in which scene points are looked up.
[[nodiscard]] core::Box makeLookUpBox(const scene::WorldGeometry& world);

/// Bakes a location whenever it is asked for.
class OnTheFly : public LocationSource {
 public:
  /// `world` must outlive the object.
  OnTheFly(const scene::WorldGeometry& world, const BakePlan& plan)
      : rays_(world, plan.options.map.keepStatic), plan_(plan) {}
  [[nodiscard]] const SamplingGrid& grid() const override { return plan_.grid; }
  [[nodiscard]] std::shared_ptr<const SamplingLocation> load(std::uint32_t index) const override {
    return unpackLocation(bakeLocation(rays_, plan_.grid.location(index), plan_.options),
                          plan_.options.octree.box);
  }

 private:
  MirrorRays rays_;
  BakePlan plan_;
};

}  // namespace catoptric::reflection_morphing

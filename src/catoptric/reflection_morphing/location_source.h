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

/// The space around the scene in cells as large as a fifth of the smallest curved mirror's radius, but at
/// most 64 each way.
[[nodiscard]] BakePlan makeDefaultPlan(const scene::WorldGeometry& world);
/// The box in which scene points are looked up.
[[nodiscard]] core::Box makeLookUpBox(const scene::WorldGeometry& world);

/// Bakes a location whenever it is asked for.
class OnTheFly : public LocationSource {
 public:
  /// `world` must outlive the object.
  OnTheFly(const scene::WorldGeometry& world, const BakePlan& plan) : rays_(world), plan_(plan) {}
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

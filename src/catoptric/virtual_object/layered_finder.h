// SPDX-License-Identifier: Apache-2.0
// Solver `layered`: explosion maps at several radii, no search.
//
// Question: where does the eye see Q? Two spheres, as in the 1998 paper, are two samples of a smooth function
// of 1 / rho, rho = |Q - C|, in the direction of Q.
//   1. For each eye: K explosion maps at radii evenly spaced in 1 / rho, from the near to the far sphere.
//   2. Q: MapCoords of C -> Q, the same for all maps; the two maps that rho lies between.
//   3. In both: triangle and barycentrics, hence a point of the mirror. J is their blend, linear in 1 / rho.
// With K = 2 the maps are those of the 1998 method; what is blended is J, not Q'. Then the search of Refined
// is what K = 2 with Newton steps would be.
//
// Departures: everything (methods.md, section 1); the maps themselves as in explosion_map.h. Known failures:
// J leaves the mirror by the sag of the chord between the two points, which moves Q' by less than the error;
// those of the maps (concave mirrors fold). Error against K: SOLVERS.md. Cost: two random fetches a vertex,
// 0.2 to 0.3 us; 1 to 2 ms of one core for each map and eye.
#pragma once

#include <vector>

#include "catoptric/virtual_object/point_finder.h"

namespace catoptric::virtual_object {

inline constexpr int kDefaultLayers = 8;

class LayeredFinder : public PointFinder {
 public:
  /// `mesh` must outlive the finder; at least two layers.
  LayeredFinder(const ReflectorMesh& mesh, int layers = kDefaultLayers, int mapResolution = 256);

  void setEye(const EyeView& view) override;
  [[nodiscard]] bool knowsHiddenPoints() const override { return false; }
  [[nodiscard]] std::optional<FoundPoint> find(const dvec3& scenePoint) const override;

  [[nodiscard]] const std::vector<ExplosionMap>& layers() const { return layers_; }

 private:
  const ReflectorMesh* mesh_;
  std::vector<ExplosionMap> layers_;
  std::vector<MapScratch> scratch_;
  double inverseNear_ = 0, layersPerInverse_ = 0;  ///< layer = (1 / rho - 1 / near) * layersPerInverse_
};

}  // namespace catoptric::virtual_object

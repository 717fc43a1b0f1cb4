// SPDX-License-Identifier: Apache-2.0
// What solvers have in common besides Explosion and Refined, which read the maps in a loop of their own: they
// answer one question, where on the mirror the eye sees a scene point, and VirtualObjectSolver does the rest
// (hidden points, where to draw the virtual vertex, both cores).
#pragma once

#include <optional>

#include "catoptric/core/math.h"
#include "catoptric/virtual_object/explosion_map.h"
#include "catoptric/virtual_object/reflection_point.h"

namespace catoptric::virtual_object {

struct FoundPoint {
  dvec3 position{0}, normal{0, 0, 1};  ///< J and the mirror's unit normal there
  SurfacePoint at;                     ///< the same on the mesh, where the solver works on the mesh
  bool isPastBoundary = false;         ///< J lies where the mirror was continued past its boundary
  bool isHidden = false;               ///< the mirror hides the point; J is where the ray E -> Q enters
};

/// What depends on the eye and is computed once for all solvers.
struct EyeView {
  dvec3 eye{0};
  double nearRadius = 0, farRadius = 0;  ///< of spheres around the mesh's centre: mirror, whole scene
  const ReflectedRays* rays = nullptr;   ///< of the mesh
};

class PointFinder {
 public:
  PointFinder() = default;
  PointFinder(const PointFinder&) = delete;
  PointFinder& operator=(const PointFinder&) = delete;
  virtual ~PointFinder() = default;

  /// For a new eye. Not to be called while find() runs.
  virtual void setEye(const EyeView& view) = 0;

  /// Nothing where the point is not reflected. Called from several threads.
  [[nodiscard]] virtual std::optional<FoundPoint> find(const dvec3& scenePoint) const = 0;

  /// True when find() never gives a reflection point for a hidden one. Otherwise the hidden map is asked
  /// first.
  [[nodiscard]] virtual bool knowsHiddenPoints() const = 0;
};

}  // namespace catoptric::virtual_object

// SPDX-License-Identifier: Apache-2.0
// Surfaces given by an equation f = 0, and how one of a family is laid through a mesh.
//
// Any frame; lengths in its units. A family is a function that makes a surface from its parameters.
// polishSurface:
//   1. residual of a vertex: f / |grad f|, its distance to first order,
//   2. Levenberg-Marquardt from the given parameters, derivatives by differences, at most 400 vertices
//      spread over the mesh, until the residuals are the rounding of the vertices,
//   3. parameters that the vertices hardly tell apart (a shallow mirror's conic constant from its r^4) keep
//      near their start by the damping: the surface is right, the parameters then are one choice of several.
// Known failures: the start has to be near, an axis within some 10 degrees. Cost: 400 vertices times
// parameters times 3 to 40 steps, 1 to 20 ms. Sources: Marquardt 1963; Taubin 1991
// for the distance.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "catoptric/geometry/shape_recognition.h"

namespace catoptric::geometry {

/// Twice continuously differentiable near f = 0. The gradient is not zero there.
class ImplicitSurface {
 public:
  struct Sample {
    double value = 0;   ///< f; zero on the surface
    dvec3 gradient{0};  ///< towards the bright side
  };

  virtual ~ImplicitSurface() = default;
  [[nodiscard]] virtual Sample sampleAt(const dvec3& p) const = 0;
  /// The matrix of second derivatives.
  [[nodiscard]] virtual dmat3 hessian(const dvec3& p) const = 0;

  /// Of a point with f = 0: does it belong to the sheet that is meant? An equation may have others, a spindle
  /// torus and a hyperboloid two.
  [[nodiscard]] virtual bool isOnSheet(const dvec3& /*p*/) const { return true; }

  [[nodiscard]] double value(const dvec3& p) const { return sampleAt(p).value; }
  [[nodiscard]] dvec3 gradient(const dvec3& p) const { return sampleAt(p).gradient; }
  /// The surface's point near a point that is near it, along the gradient: at most four steps, the last one
  /// no longer than `close`.
  [[nodiscard]] dvec3 project(dvec3 p, double close = 0) const;

 protected:
  ImplicitSurface() = default;
  ImplicitSurface(const ImplicitSurface&) = default;
  ImplicitSurface& operator=(const ImplicitSurface&) = default;
};

/// To first order. Absent where a vertex has no gradient (a cone's apex).
[[nodiscard]] std::optional<FitDeviation> measureDeviation(const ImplicitSurface& surface,
                                                           const MeshView& mesh);

using SurfaceFamily = std::function<std::unique_ptr<ImplicitSurface>(std::span<const double> parameters)>;

struct PolishedSurface {
  std::vector<double> parameters;
  double meanSquare = 0;  ///< of the residuals
  bool isExact = false;   ///< they are the rounding of the vertices
};

/// `start`: parameters of about unit size. Absent where the start has no residuals that are numbers.
[[nodiscard]] std::optional<PolishedSurface> polishSurface(const SurfaceFamily& family,
                                                           std::vector<double> start,
                                                           std::span<const vec3> points);

}  // namespace catoptric::geometry

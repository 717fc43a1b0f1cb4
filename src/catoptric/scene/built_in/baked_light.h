// SPDX-License-Identifier: Apache-2.0
// "The shadows are pre-computed textures" (Ofek & Rappoport 1998, fig. 15): how much of the sky and of a lamp
// a point of a horizontal surface sees past a few simple solids. Lights cast no shadows in the renderers, so
// this is what makes things stand on the floor.
//
// Inputs: convex solids that stand on or float above a plane y = height; metres.
//   1. Sky: the cosine-weighted share of the hemisphere that a solid covers. Sphere: closed form (r/d)^2
//      cos. Convex polyhedron: Lambert's formula over its faces that look at the point (1760), exact.
//   2. Lamp: share of a disc of sample points around the lamp that the solids do not hide.
//   3. Solids that cover less than 0.1 % are left out. Shares of several solids are multiplied as if
//      independent.
// Departures: no interreflection; a solid partly below the plane is taken whole. Cost: about 2 microseconds a
// point and solid.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "catoptric/core/image.h"
#include "catoptric/scene/built_in/textures.h"

namespace catoptric::scene::built_in {

struct BallSolid {
  dvec3 centre;
  double radius;
};

/// A convex polyhedron: faces counter-clockwise seen from outside, and a ball around it.
struct FacedSolid {
  std::vector<std::vector<dvec3>> faces;
  std::vector<dvec3> normals;  ///< of the faces, outwards, any length
  BallSolid bounds;
};

class BakedLight {
 public:
  BakedLight() { setLamp({0, 100, 0}, 1); }
  void addBall(const dvec3& centre, double radius) { balls_.push_back({centre, radius}); }
  /// Upright box, turned around y.
  void addBox(const dvec3& centre, const dvec3& size, double turnRadians = 0);
  /// Upright cylinder or frustum from the centre of its base.
  void addColumn(const dvec3& base, double bottomRadius, double topRadius, double height);

  /// Direction to the lamp's centre, or its position; the lamp is a ball of the given radius.
  void setLamp(const dvec3& position, double radius);

  /// Share of the cosine-weighted upper hemisphere that is open, 0..1.
  [[nodiscard]] double openness(const dvec3& point) const;
  /// Share of the lamp that is seen, 0..1.
  [[nodiscard]] double lampShare(const dvec3& point) const;

  /// Factor for a base colour over the rectangle [lower, upper] of the plane y = height, on a grid that is
  /// then interpolated: 1 - strength * (1 - share) of sky and lamp multiplied. u runs along x, v along z.
  [[nodiscard]] std::function<double(dvec2 uv)> bake(const dvec2& lower, const dvec2& upper, double height,
                                                     int cellsX, int cellsZ, double skyStrength,
                                                     double lampStrength) const;

 private:
  std::vector<BallSolid> balls_;
  /// Between two level rings of equally many points, counter-clockwise seen from above.
  void addRings(const std::vector<dvec3>& bottom, const std::vector<dvec3>& top);

  std::vector<FacedSolid> solids_;
  static constexpr int kLampSamples = 24;
  [[nodiscard]] bool mayHideLamp(const dvec3& point, const BallSolid& ball) const;

  dvec3 lamp_{0};
  double lampRadius_ = 0;
  std::array<dvec3, kLampSamples> lampSamples_{};
};

/// Darkening towards the edges of a unit square of the given size in metres, where walls stand: 1 in the
/// middle.
[[nodiscard]] std::function<double(dvec2 uv)> edgeShade(const dvec2& size, double reach, double strength);

/// A grey image of a factor, for an occlusion texture (linear; the red channel counts).
[[nodiscard]] core::ImageRgba8 paintOcclusion(int widthPx, int heightPx,
                                              const std::function<double(dvec2 uv)>& factor);

}  // namespace catoptric::scene::built_in

// SPDX-License-Identifier: Apache-2.0
// Road traffic, houses and mirrors of a car. Vehicles stand on y = 0, centred, and drive towards -z.
#pragma once

#include <vector>

#include "catoptric/scene/built_in/scene_builder.h"

namespace catoptric::scene::built_in {

[[nodiscard]] std::vector<Piece> makeCar(SceneBuilder& builder, const std::string& paintName,
                                         const vec3& colour);
/// Box truck, 8 m long.
[[nodiscard]] std::vector<Piece> makeTruck(SceneBuilder& builder, const std::string& paintName,
                                           const vec3& colour);
/// House with a gabled roof along x, front to +z.
[[nodiscard]] std::vector<Piece> makeHouse(SceneBuilder& builder, const dvec3& size,
                                           const std::string& wallName, const vec3& wall);

struct WingMirrorOptions {
  double widthMetres = 0.28, heightMetres = 0.19;
  double radiusOfCurvature = 1.3;
  double asphericFrom = 0.3;   ///< share of the half width, measured outwards, where the aspheric part starts
  double asphericCubic = 2.2;  ///< z falls by this times the cube of the distance beyond that, 1/m^2
  bool isOuterLeft = true;     ///< which side bends more
  int cells = 48;
};

/// The glass of a wing mirror: convex towards +z, bulging outline, apex at the origin, exact normals. A
/// sphere on the inner side, curving more and more on the outer one (twice continuously differentiable
/// throughout).
[[nodiscard]] geometry::Mesh makeWingMirrorGlass(const WingMirrorOptions& options);

/// Flat glass of the same outline in the plane z = 0.
[[nodiscard]] geometry::Mesh makeFlatMirrorGlass(double width, double height);

/// A bowl around a glass of the given size, open towards +z, its rim 8 mm in front of z = 0.
[[nodiscard]] geometry::Mesh makeMirrorHousing(double width, double height, double depth);

}  // namespace catoptric::scene::built_in

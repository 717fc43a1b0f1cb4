// SPDX-License-Identifier: Apache-2.0
// Implicit surfaces on which the search for reflections is tried, fitted to meshes as mirrors are.
#pragma once

#include <memory>
#include <random>
#include <vector>

#include "catoptric/geometry/mesh.h"
#include "catoptric/geometry/quadric.h"
#include "catoptric/geometry/shape_recognition.h"
#include "root_judge.h"

namespace catoptric::virtual_object {

using Surface = std::shared_ptr<const geometry::ImplicitSurface>;
enum class Family { Quadric, Torus, Aspheric };

struct ImplicitCase {
  const char* name = "";
  geometry::Mesh mesh;
  SurfacePatch::Place place;  ///< the surface by two parameters, over what the mesh covers
  dvec2 lower, upper;
  bool isTurned = false;  ///< bright side: the hollow one
  double reach = 4;       ///< of eyes and points, from the middle
  Family family = Family::Quadric;
  bool isClosed = false;
  bool isWithin = false;  ///< eyes and points: only where f < 0 before it is turned
};

[[nodiscard]] std::vector<ImplicitCase> makeImplicitCases();

[[nodiscard]] inline geometry::MeshView viewMesh(const geometry::Mesh& mesh) {
  return {mesh.positions, mesh.normals, mesh.indices};
}

/// Fails the test where nothing fits.
[[nodiscard]] Surface fitSurface(const ImplicitCase& c);

struct Pair {
  dvec3 eye, point;
};
[[nodiscard]] Pair randomPair(std::mt19937& random, const ImplicitCase& c, const Surface& surface = nullptr);

/// Ellipsoid of these half axes around the origin, bright outside, and a mesh of it from one of a unit ball.
[[nodiscard]] geometry::Quadric makeEllipsoid(const dvec3& half);
[[nodiscard]] geometry::Mesh stretch(geometry::Mesh mesh, const dvec3& half);

}  // namespace catoptric::virtual_object

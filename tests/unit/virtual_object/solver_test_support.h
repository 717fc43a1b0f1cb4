// SPDX-License-Identifier: Apache-2.0
// What the tests of the solvers share.
#pragma once

#include <random>

#include "catoptric/geometry/mesh.h"
#include "catoptric/virtual_object/reflector_mesh.h"

namespace catoptric::virtual_object {

inline ReflectorMesh meshOf(const geometry::Mesh& mesh, const ReflectorMeshOptions& options = {}) {
  return ReflectorMesh(mesh.positions, mesh.normals, mesh.indices, options);
}

inline dvec3 randomDirection(std::mt19937& random) {
  std::normal_distribution<double> gauss;
  return glm::normalize(dvec3(gauss(random), gauss(random), gauss(random)));
}

}  // namespace catoptric::virtual_object

// SPDX-License-Identifier: Apache-2.0
// Eigenvalues and eigenvectors of a symmetric 3 x 3 matrix.
#pragma once

#include "catoptric/core/math.h"

namespace catoptric::geometry {

struct Eigen3 {
  dvec3 values;   ///< ascending
  dmat3 vectors;  ///< columns, orthonormal
};

/// By Jacobi rotations.
[[nodiscard]] Eigen3 computeEigen(dmat3 symmetric);

}  // namespace catoptric::geometry

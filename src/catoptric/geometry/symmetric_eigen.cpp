// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/symmetric_eigen.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::geometry {

Eigen3 computeEigen(dmat3 a) {
  dmat3 v(1.0);
  for (int sweep = 0; sweep < 32; ++sweep) {
    const double off = std::abs(a[0][1]) + std::abs(a[0][2]) + std::abs(a[1][2]);
    if (off <= 1e-300 || off < 1e-17 * (std::abs(a[0][0]) + std::abs(a[1][1]) + std::abs(a[2][2]))) break;
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (a[p][q] == 0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        dmat3 r(1.0);
        r[p][p] = r[q][q] = c;
        r[p][q] = -s;
        r[q][p] = s;
        a = glm::transpose(r) * a * r;
        v = v * r;
      }
  }
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int i, int j) { return a[i][i] < a[j][j]; });
  Eigen3 result;
  for (int i = 0; i < 3; ++i) {
    result.values[i] = a[order[i]][order[i]];
    result.vectors[i] = v[order[i]];
  }
  return result;
}

}  // namespace catoptric::geometry

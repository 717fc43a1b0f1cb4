// SPDX-License-Identifier: Apache-2.0
// All reflections in a mirror covered with Monge patches: each patch is shown to hold none, or shown to hold
// at most one that Newton's method finds, or halved.
//
// World space, double. In a patch's frame, at x = (x, y), with height h, slope g, bend K (its second
// derivatives):
//   1. With p across and w up from there to E: alpha = p + w g along the two tangents, and beta = w - g.p,
//      the distance from the tangent plane times sqrt(1 + g^2); alpha' and beta' to Q. J divides the feet of
//      E and Q on that plane as beta : beta' (special_reflector.h): F(x) = alpha beta' + alpha' beta = 0. No
//      roots, nothing to divide by, linear in E and in Q.
//   2. D alpha = w K - 1 - g g^T, D beta = -K p.
//   3. All in units of the patch's half sides. |D^2 alpha| and |D^2 beta| are bounded over the patch by
//      bounds of K and of its change; so are, from the values at the middle, alpha, beta and |D^2 F|.
//   4. No reflection: beta or beta' is below zero all over the patch. Or alpha and alpha' lie to one side of
//      a line: beta and beta' are positive, so alpha beta' and alpha' beta cannot cancel. Or |c.F| at the
//      middle is more than it can change by, for c along F (sharp near a caustic), or for the c with which
//      c^T DF is Newton's step (sharp elsewhere).
//   5. At most one, u = |DF^-1| |D^2 F| d <= 0.4 with d half the diagonal: if it is there, Newton's method
//   from
//      the middle finds it (Kantorovich asks for 1/2 of u times its first step over d, which is u + u^2 / 2).
//   6. What is left when patches are as small as kSmallest, or more than kMostPatches of one size, is
//      searched from its middle by shortest steps: reflections that touch, or a curve of them (E and Q on
//      the axis of a surface of revolution).
// Where the bounds of monge_patches.h hold, nothing is missed but by step 6: close beside such an axis, less
// than some 1e-5 of the mirror's radius but not on it, all may be.
//
// Cost: 0.1 us a patch: 10 to 40 where a shallow mirror has none, 80 to 300 where it has one, 400 outside an
// ellipsoid, 1,400 inside, 1,000 to 2,700 on a torus. Sources: Wang, Hasan & Yan 2020 (path cuts) and Walter
// et al. 2009 for leaving out parts of a mirror by bounds of position and normal; Mitchell & Hanrahan 1992
// for all roots on an implicit surface by intervals; Kantorovich 1948.
#pragma once

#include <array>

#include "catoptric/virtual_object/monge_patches.h"

namespace catoptric::virtual_object {

/// Where F = 0, or where a search for it ended: to be checked by the mirror law.
struct IsolatedRoots {
  static constexpr int kMost = 64;
  std::array<dvec3, kMost> all;
  int count = 0;

  [[nodiscard]] const dvec3* begin() const { return all.data(); }
  [[nodiscard]] const dvec3* end() const { return all.data() + count; }
};

[[nodiscard]] IsolatedRoots isolateReflections(const MongePatches& patches, const dvec3& eye,
                                               const dvec3& point);

}  // namespace catoptric::virtual_object

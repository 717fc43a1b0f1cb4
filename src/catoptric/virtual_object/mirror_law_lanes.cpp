// SPDX-License-Identifier: Apache-2.0
// One loop over the lanes, written once; the compiler makes vectors of it (core/widest_vectors.h).
#include "catoptric/virtual_object/mirror_law_lanes.h"

#include <cmath>

#include "catoptric/core/widest_vectors.h"
#include "catoptric/virtual_object/mesh_walk.h"

namespace catoptric::virtual_object {
namespace {

/// MirrorLaw and computeNewtonStep of reflection_point.h, in the same order.
CATOPTRIC_INLINE void evaluateAll(Lanes& s, const vec3& eye) {
  const float ex = eye.x, ey = eye.y, ez = eye.z;
  for (int i = 0; i < kLanes; ++i) {
    const float u = s.u[i], v = s.v[i];
    // Position, normal; unit directions to eye (wi) and point (wo).
    const float e1x = s.edge1[0][i], e1y = s.edge1[1][i], e1z = s.edge1[2][i];
    const float e2x = s.edge2[0][i], e2y = s.edge2[1][i], e2z = s.edge2[2][i];
    const float m1x = s.normal1[0][i], m1y = s.normal1[1][i], m1z = s.normal1[2][i];
    const float m2x = s.normal2[0][i], m2y = s.normal2[1][i], m2z = s.normal2[2][i];
    const float px = s.position0[0][i] + u * e1x + v * e2x, py = s.position0[1][i] + u * e1y + v * e2y,
                pz = s.position0[2][i] + u * e1z + v * e2z;
    const float nx = s.normal0[0][i] + u * m1x + v * m2x, ny = s.normal0[1][i] + u * m1y + v * m2y,
                nz = s.normal0[2][i] + u * m1z + v * m2z;
    const float ax = ex - px, ay = ey - py, az = ez - pz;
    const float bx = s.point[0][i] - px, by = s.point[1][i] - py, bz = s.point[2][i] - pz;
    const float a = std::sqrt(ax * ax + ay * ay + az * az), b = std::sqrt(bx * bx + by * by + bz * bz);
    const float inverse = 1.0f / (a * b * (a + b));
    const float inverseA = b * (a + b) * inverse, inverseB = a * (a + b) * inverse,
                inverseSum = a * b * inverse;
    const float wix = ax * inverseA, wiy = ay * inverseA, wiz = az * inverseA;
    const float wox = bx * inverseB, woy = by * inverseB, woz = bz * inverseB;
    // Half vector h and its part across the normal, q.
    const float hx = wix + wox, hy = wiy + woy, hz = wiz + woz;
    const float nn = nx * nx + ny * ny + nz * nz, hn = hx * nx + hy * ny + hz * nz;
    const float qx = nn * hx - hn * nx, qy = nn * hy - hn * ny, qz = nn * hz - hn * nz;
    s.squaredSine[i] = (qx * qx + qy * qy + qz * qz) / ((hx * hx + hy * hy + hz * hz) * nn * nn);
    s.facing[i] = hn;
    s.distance[i] = b;
    // Derivatives along both edges.
    const float both = inverseA + inverseB, eyeShare = b * inverseSum, pointShare = a * inverseSum;
    const auto derive = [&](float dx, float dy, float dz, float mx, float my, float mz, float& jx, float& jy,
                            float& jz) __attribute__((always_inline)) {
      const float ie = dx * wix + dy * wiy + dz * wiz, oe = dx * wox + dy * woy + dz * woz;
      const float ieA = ie * inverseA, oeB = oe * inverseB;
      const float dhx = wix * ieA + wox * oeB - dx * both, dhy = wiy * ieA + woy * oeB - dy * both,
                  dhz = wiz * ieA + woz * oeB - dz * both;
      const float dNn = 2.0f * (mx * nx + my * ny + mz * nz);
      const float dHn = dhx * nx + dhy * ny + dhz * nz + mx * hx + my * hy + mz * hz;
      const float dLogS = -(ieA * eyeShare + oeB * pointShare);
      jx = dNn * hx + nn * dhx - dHn * nx - hn * mx + dLogS * qx;
      jy = dNn * hy + nn * dhy - dHn * ny - hn * my + dLogS * qy;
      jz = dNn * hz + nn * dhz - dHn * nz - hn * mz + dLogS * qz;
    };
    float d1x, d1y, d1z, d2x, d2y, d2z;
    derive(e1x, e1y, e1z, m1x, m1y, m1z, d1x, d1y, d1z);
    derive(e2x, e2y, e2z, m2x, m2y, m2z, d2x, d2y, d2z);
    // Two equations e1.q = e2.q = 0 in (u, v).
    const float f1 = e1x * qx + e1y * qy + e1z * qz, f2 = e2x * qx + e2y * qy + e2z * qz;
    const float j11 = d1x * e1x + d1y * e1y + d1z * e1z, j12 = d2x * e1x + d2y * e1y + d2z * e1z;
    const float j21 = d1x * e2x + d1y * e2y + d1z * e2z, j22 = d2x * e2x + d2y * e2y + d2z * e2z;
    const float inverseDeterminant = 1.0f / (j11 * j22 - j12 * j21);
    s.stepU[i] = (j12 * f2 - j22 * f1) * inverseDeterminant;
    s.stepV[i] = (j21 * f1 - j11 * f2) * inverseDeterminant;
  }
}

struct EvaluateAll {
  CATOPTRIC_INLINE static void run(Lanes& lanes, const vec3& eye) { evaluateAll(lanes, eye); }
};

}  // namespace

std::vector<LaneTriangle> makeLaneTriangles(const ReflectorMesh& mesh) {
  std::vector<LaneTriangle> lanes;
  lanes.reserve(mesh.triangles().size());
  for (const MirrorTriangle& t : mesh.triangles())
    lanes.push_back({vec3(t.position0 - mesh.centre()), vec3(t.edge1), vec3(t.edge2), vec3(t.normal0),
                     vec3(t.normal1), vec3(t.normal2), float(t.gram11), float(t.gram12), float(t.gram22),
                     t.neighbours, t.flags});
  return lanes;
}

void Lanes::setTriangle(int lane, const LaneTriangle& t) {
  for (int k = 0; k < 3; ++k) {
    position0[k][lane] = t.position0[k], edge1[k][lane] = t.edge1[k], edge2[k][lane] = t.edge2[k];
    normal0[k][lane] = t.normal0[k], normal1[k][lane] = t.normal1[k], normal2[k][lane] = t.normal2[k];
  }
}

void evaluateLanes(Lanes& lanes, const vec3& eye) {
  core::runOnWidestVectors<EvaluateAll>(lanes, eye);
}

bool walkLane(std::span<const LaneTriangle> triangles, LanePoint& at, float du, float dv) {
  return walkOverMesh(triangles, at, du, dv, 24);
}

}  // namespace catoptric::virtual_object

// SPDX-License-Identifier: Apache-2.0
// The mirror law on a triangle with linear normals, and Newton's step: src/catoptric/virtual_object/reflection_point.h says
// what it means and where it comes from. Any frame. Real, Real2, Real3: as in lib/virtual_vertex.glsl. A vertex shader
// searches with it; the processor has versions that are faster there, and tests hold them to this one.

/// P = position0 + u edge1 + v edge2, N ~ normal0 + u normal1 + v normal2 (normal1, normal2: differences).
struct MirrorFacet {
  Real3 position0;
  Real3 edge1;
  Real3 edge2;
  Real3 normal0;
  Real3 normal1;
  Real3 normal2;
};

struct LawOnFacet {
  Real3 position;
  Real3 normal;  // not unit
  Real3 toEye;   // unit
  Real3 toPoint;
  Real distanceEye;
  Real distancePoint;
  Real nn;  // n.n
  Real hn;  // h.n > 0: eye and point lie in front
  Real3 h;  // half vector, not unit
  Real3 q;  // (n.n) h - (h.n) n
};

CATOPTRIC_FN LawOnFacet lawOnFacet(MirrorFacet t, Real2 uv, Real3 eye, Real3 point) {
  LawOnFacet law;
  law.position = t.position0 + uv.x * t.edge1 + uv.y * t.edge2;
  law.normal = t.normal0 + uv.x * t.normal1 + uv.y * t.normal2;
  Real3 awayEye = eye - law.position;
  Real3 awayPoint = point - law.position;
  law.distanceEye = sqrt(dot(awayEye, awayEye));
  law.distancePoint = sqrt(dot(awayPoint, awayPoint));
  law.toEye = awayEye / law.distanceEye;
  law.toPoint = awayPoint / law.distancePoint;
  law.h = law.toEye + law.toPoint;
  law.nn = dot(law.normal, law.normal);
  law.hn = dot(law.h, law.normal);
  law.q = law.nn * law.h - law.hn * law.normal;
  return law;
}

/// Of the sine of the angle between half vector and normal.
CATOPTRIC_FN Real squaredSineOf(LawOnFacet law) {
  return dot(law.q, law.q) / (dot(law.h, law.h) * law.nn * law.nn);
}

/// What the search makes smaller: a length squared.
CATOPTRIC_FN Real squaredMeritOf(LawOnFacet law) {
  Real s = law.distanceEye * law.distancePoint / (law.distanceEye + law.distancePoint);
  return s * s * dot(law.q, law.q) / (law.nn * law.nn);
}

/// Derivative of s q along an edge e on which the normal changes by m, divided by s = |EP||QP|/(|EP|+|QP|).
CATOPTRIC_FN Real3 lawChange(LawOnFacet law, Real3 e, Real3 m) {
  Real inverseEye = Real(1.0f) / law.distanceEye;
  Real inversePoint = Real(1.0f) / law.distancePoint;
  Real inverseSum = Real(1.0f) / (law.distanceEye + law.distancePoint);
  Real alongEye = dot(e, law.toEye) * inverseEye;
  Real alongPoint = dot(e, law.toPoint) * inversePoint;
  Real3 dh = law.toEye * alongEye + law.toPoint * alongPoint - e * (inverseEye + inversePoint);
  Real dNn = Real(2.0f) * dot(m, law.normal);
  Real dHn = dot(dh, law.normal) + dot(m, law.h);
  Real dLogS = -(alongEye * law.distancePoint + alongPoint * law.distanceEye) * inverseSum;
  return dNn * law.h + law.nn * dh - dHn * law.normal - law.hn * m + dLogS * law.q;
}

/// Newton's step (du, dv); not finite where the two equations are dependent.
CATOPTRIC_FN Real2 newtonStepOnFacet(MirrorFacet t, LawOnFacet law) {
  Real3 d1 = lawChange(law, t.edge1, t.normal1);
  Real3 d2 = lawChange(law, t.edge2, t.normal2);
  Real f1 = dot(t.edge1, law.q);
  Real f2 = dot(t.edge2, law.q);
  Real a = dot(d1, t.edge1);
  Real b = dot(d2, t.edge1);
  Real c = dot(d1, t.edge2);
  Real d = dot(d2, t.edge2);
  Real determinant = a * d - b * c;
  return Real2((b * f2 - d * f1) / determinant, (c * f1 - a * f2) / determinant);
}

// SPDX-License-Identifier: Apache-2.0
// Follows a ray through one cube of points seen from a centre, up to where it first goes behind them.
//   1. Seen from the centre c the ray p + t r sweeps an arc, from p - c (t = 0) to r (t = infinity). At the angle a of an
//      arc A long its distance from c is |p - c| sin A / sin (A - a).
//   2. Steps of u_step radians along the arc; where the ray comes to lie behind what the cube shows, the step is halved
//      down to a texel.
//   3. The texel there and its neighbours on the same object give a plane; the ray is cut with it. If it meets it near that
//      texel, that is the answer. Else the ray went behind a silhouette, where this cube knows nothing: the search goes
//      on until the ray comes out again, and the answer is marked as unsure.

const int kMostSteps = 768;
const int kHalvings = 6;
const float kSameSurface = 0.06f;  // of the distance, between neighbouring texels

struct CubeAnswer {
  float t;       // along the ray; kSkyPath at the sky
  uint object;
  bool isSure;
  vec3 direction;  // from the centre to the point
};

/// Step 3. Where the ray meets the plane of the texel in direction w; false if that is nowhere near.
bool meetTexelPlane(samplerCube position, usamplerCube ids, vec3 centre, vec3 p, vec3 r, vec3 w, vec3 sideways,
                    float texel, inout float t) {
  vec4 here = textureLod(position, w, 0.0f);
  uint object = textureLod(ids, w, 0.0f).x;
  vec3 upwards = cross(w, sideways);
  vec3 edges[2];
  for (int i = 0; i < 2; ++i) {
    vec3 axis = (i == 0 ? sideways : upwards) * (1.5f * texel);
    vec4 ahead = textureLod(position, w + axis, 0.0f), behind = textureLod(position, w - axis, 0.0f);
    bool isAhead = textureLod(ids, w + axis, 0.0f).x == object && abs(ahead.w - here.w) < kSameSurface * here.w;
    bool isBehind = textureLod(ids, w - axis, 0.0f).x == object && abs(behind.w - here.w) < kSameSurface * here.w;
    if (isAhead && (!isBehind || abs(ahead.w - here.w) < abs(here.w - behind.w))) edges[i] = ahead.xyz - here.xyz;
    else if (isBehind) edges[i] = here.xyz - behind.xyz;
    else edges[i] = axis * here.w;
  }
  vec3 n = cross(edges[0], edges[1]);
  float slope = dot(n, r);
  float met = dot(n, here.xyz - p) / slope;
  vec3 v = p + met * r - centre;
  float reach = 2.5f * texel * length(v);
  if (abs(slope) < 1.0e-12f * dot(n, n) || met <= 0.0f) return false;
  if (length(cross(v, w)) > reach || dot(v, w) <= 0.0f) return false;
  t = met;
  return true;
}

/// The arc that a ray sweeps as seen from a centre.
struct Arc {
  vec3 e1, e2;   // unit: towards its start, and across
  float start;   // distance from the centre at its start
  float sine, angle;
};

/// Distance from the centre at an angle of the arc.
float reachAt(Arc arc, float angle) {
  return angle < arc.angle ? arc.start * arc.sine / max(sin(arc.angle - angle), 1.0e-12f) : kSkyPath;
}

vec3 directionAt(Arc arc, float angle) { return cos(angle) * arc.e1 + sin(angle) * arc.e2; }

Arc makeArc(vec3 v0, vec3 r) {
  Arc arc;
  arc.start = max(length(v0), 1.0e-12f);
  arc.e1 = v0 / arc.start;
  vec3 across = r - arc.e1 * dot(arc.e1, r);
  arc.sine = length(across);
  arc.angle = atan(arc.sine, dot(arc.e1, r));
  arc.e2 = across / max(arc.sine, 1.0e-12f);
  return arc;
}

/// Step 2: between `low`, before what the cube shows, and `high`, behind it.
void halve(samplerCube position, Arc arc, inout float low, inout float high) {
  for (int k = 0; k < kHalvings; ++k) {
    float middle = 0.5f * (low + high);
    if (reachAt(arc, middle) > textureLod(position, directionAt(arc, middle), 0.0f).w) high = middle;
    else low = middle;
  }
}

CubeAnswer followThroughCube(samplerCube position, usamplerCube ids, vec3 centre, vec3 p, vec3 r, float leastStep) {
  CubeAnswer answer = CubeAnswer(kSkyPath, 0u, true, r);
  // 1
  Arc arc = makeArc(p - centre, r);
  float texel = 2.0f / float(textureSize(position, 0).x);
  // 2
  float previous = 0.0f;
  bool wasBehind = false;
  float stepAngle = max(leastStep, arc.angle / float(kMostSteps));
  int steps = int(ceil(arc.angle / stepAngle));
  for (int i = 0; i <= steps; ++i) {
    float angle = min((float(i) + 0.5f) * stepAngle, arc.angle);
    bool isBehind = reachAt(arc, angle) > textureLod(position, directionAt(arc, angle), 0.0f).w;
    if (isBehind && !wasBehind) {
      float low = previous, high = angle;
      halve(position, arc, low, high);
      // 3. The surface may be that of the texel before as well.
      for (int k = 0; k < 2; ++k) {
        vec3 m = directionAt(arc, k == 0 ? high : low);
        uint object = textureLod(ids, m, 0.0f).x;
        float t = 0.0f;
        if (object != 0u && meetTexelPlane(position, ids, centre, p, r, m, cross(arc.e1, arc.e2), texel, t))
          return CubeAnswer(t, object, true, p + t * r - centre);
      }
      answer.isSure = false;
    }
    wasBehind = isBehind;
    previous = angle;
  }
  return answer;
}

// SPDX-License-Identifier: Apache-2.0
// The search of solver `refined` in a vertex shader: from where the maps blend to, Newton's steps on the mirror law, walking
// across edges (mesh_walk.h, reflection_point.h). Ends as the processor's lanes do: one more step once the residual is so
// small that its square does not matter. Frame: that of mirror_maps.glsl.

const int kMostSteps = 8, kMostCrossings = 24;
const float kAlmostSine = 2.0e-3f;
const float kStraight = 1.0e-4f;  // as MirrorLaw::kStraight
const float kNearlySine = 0.05f;  // a root this near is good enough to place a doubly virtual vertex
const float kLongestStep = 0.7f;  // of the mirror's radius

/// Moves a point by (du, dv) of its triangle; past the end of the mesh it leaves the last one.
MirrorPoint walkOnMirror(MirrorPoint at, vec2 change) {
  int entered = 3;
  for (int crossing = 0; crossing < kMostCrossings; ++crossing) {
    // Never straight back over the edge it came in by.
    if (entered == 0) change.y = max(change.y, 0.0f);
    if (entered == 2) change.x = max(change.x, 0.0f);
    if (entered == 1 && change.x + change.y > 0.0f) change = vec2(0.5f, -0.5f) * (change.x - change.y);
    vec2 target = at.uv + change;
    uvec4 neighbours = readNeighbours(at.triangle);
    vec3 inside = vec3(at.uv.y, 1.0f - at.uv.x - at.uv.y, at.uv.x);
    vec3 changes = vec3(change.y, -(change.x + change.y), change.x);
    bool isInside = min(target.x, target.y) >= 0.0f && target.x + target.y <= 1.0f;
    int edge = 3;
    float first = 2.0f;
    for (int k = 0; k < 3; ++k) {
      if (inside[k] + changes[k] >= 0.0f || neighbours[k] == kNoTriangle) continue;
      float fraction = changes[k] < 0.0f ? max(inside[k] / -changes[k], 0.0f) : 0.0f;
      if (fraction < first) {
        first = fraction;
        edge = k;
      }
    }
    if (isInside || edge == 3) {
      at.uv = target;
      return at;
    }
    vec2 crossed = at.uv + first * change;
    float back = 1.0f - (edge == 0 ? crossed.x : edge == 1 ? crossed.y : 1.0f - crossed.y);
    MirrorFacet t = readFacet(at.triangle);
    vec3 rest = (1.0f - first) * (change.x * t.edge1 + change.y * t.edge2);
    uint link = neighbours[edge];
    at.triangle = int(link >> 2u);
    entered = int(link & 3u);
    at.uv = entered == 0 ? vec2(back, 0.0f) : entered == 1 ? vec2(1.0f - back, back) : vec2(0.0f, 1.0f - back);
    vec3 gram = vec3(readTable(u_mirrorTriangles, 6 * at.triangle).w, readTable(u_mirrorTriangles, 6 * at.triangle + 1).w,
                     readTable(u_mirrorTriangles, 6 * at.triangle + 2).w);
    MirrorFacet next = readFacet(at.triangle);
    change = uvOfFoot(next.edge1, next.edge2, gram, rest);
  }
  return at;
}

bool isFarOutside(vec2 uv, float slack) { return min(min(uv.x, uv.y), 1.0f - uv.x - uv.y) < -slack; }

VirtualVertex searchVertex(MapBlend blend, vec3 point) {
  MirrorPoint at = heavierOf(blend);
  at.uv = clampUv(at.uv);
  at = walkOnMirror(at, projectOnto(at.triangle, blend.position) - at.uv);
  at.uv = clampUv(at.uv);  // past the mesh's end searches go astray
  MirrorPoint lastGood = at;
  vec2 lastStep = vec2(0.0f);
  float lastMerit = 1.0e30f, damping = 1.0f;
  bool isFound = false;
  LawOnFacet law;
  for (int i = 0; i < kMostSteps && !isFound; ++i) {
    MirrorFacet t = readFacet(at.triangle);
    law = lawOnFacet(t, at.uv, u_mirrorEye, point);
    if (!(law.distancePoint > 1.0e-6f * law.distanceEye)) break;
    bool isRoot = squaredSineOf(law) < kAlmostSine * kAlmostSine;
    bool isStraight = dot(law.h, law.h) < kStraight * kStraight;
    if (isStraight || (isRoot && law.hn <= 0.0f)) break;  // no reflection, and the search would stay here
    isFound = isRoot;
    float merit = squaredMeritOf(law);
    vec2 change;
    if (isFound || merit < lastMerit || damping < 0.02f) {
      change = newtonStepOnFacet(t, law);
      vec3 move = change.x * t.edge1 + change.y * t.edge2;
      if (!(dot(move, move) < 1.0e30f)) break;
      change *= min(1.0f, kLongestStep * u_mirrorRadius / max(length(move), 1.0e-30f));
      lastGood = at;
      lastMerit = merit;
      lastStep = change;
      damping = 1.0f;
    } else {  // worse: back, and not as far
      at = lastGood;
      damping *= 0.35f;
      change = lastStep * damping;
    }
    at = walkOnMirror(at, change);
  }
  law = lawOnFacet(readFacet(at.triangle), at.uv, u_mirrorEye, point);
  bool isPastBoundary = isSkirt(at.triangle) || isFarOutside(at.uv, 1.0e-4f);
  int kind = isPastBoundary ? kPastBoundary : kReflected;
  if (isFound) return makeVertex(placeBehind(u_mirrorEye, law.position, point), law.position, kind);
  if (law.distancePoint <= 1.0e-6f * u_mirrorRadius) return makeVertex(point, law.position, kind);
  MirrorPoint hiding = findHidingPoint(point, false);
  bool isStraight = dot(law.h, law.h) < kStraight * kStraight;
  if (hiding.triangle < 0 && isStraight && !isPastBoundary && dot(law.normal, law.toEye) > 0.0f) hiding = at;
  if (hiding.triangle >= 0) return mirrorHidden(hiding, point);
  bool isNear = isPastBoundary ? law.hn > 0.0f || isStraight : law.hn > 0.0f && squaredSineOf(law) <= kNearlySine * kNearlySine;
  if (!isNear) return makeNone(point);
  return makeVertex(placeBehind(u_mirrorEye, law.position, point), law.position, kDoublyVirtual);
}

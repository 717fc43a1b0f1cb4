// SPDX-License-Identifier: Apache-2.0
// A mirror turns every triangle's orientation round, as seen from the eye against as seen from the mirror. A
// triangle that reaches around the reflector's shadow does not: its corners come to lie all around the rim,
// and drawn it would cover the mirror from rim to rim with what belongs into a ring thinner than a pixel.
// Orientation finds it, eight triangles side by side.
#include "catoptric/raster/virtual_triangles.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "catoptric/core/eight_lanes.h"
#include "catoptric/core/parallel.h"
#include "catoptric/raster/eight_triangles.h"

namespace catoptric::raster {
namespace {

using core::Eight;
using core::EightInts;
using core::kLanes;
using core::toBits;

constexpr std::size_t kTrianglesPerTask = 4096;
constexpr float kEdgeOn = 0.02f;  // sine below which a face says nothing about its orientation

/// What tells whether a triangle is kept, by vertex.
struct Judge {
  std::span<const vec3> scenePoints, virtualPositions, reflectionPoints;
  std::span<const VertexKind> kinds;
  vec3 eye;
  LongestChords longest;
};

/// Eight points or directions.
struct Vectors {
  Eight v[3];
};

CATOPTRIC_INLINE Vectors operator-(const Vectors& a, const Vectors& b) {
  return {{a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2]}};
}

CATOPTRIC_INLINE Eight dot(const Vectors& a, const Vectors& b) {
  return core::dot(a.v, b.v);
}

CATOPTRIC_INLINE Vectors cross(const Vectors& a, const Vectors& b) {
  return {{a.v[1] * b.v[2] - b.v[1] * a.v[2], a.v[2] * b.v[0] - b.v[2] * a.v[0],
           a.v[0] * b.v[1] - b.v[0] * a.v[1]}};
}

/// A corner of eight triangles in a row; `corner` points to that of the first.
CATOPTRIC_INLINE Vectors gather(std::span<const vec3> from, const std::uint32_t* corner) {
  Vectors points;
  core::gatherTriples(&from.data()->x, corner, 3, points.v);
  return points;
}

/// -1 where all three points lie on one side of their triangle's plane, `inFront` which; 0 mixed or nearly in
/// it.
CATOPTRIC_INLINE EightInts findSides(const Vectors& normal, const Vectors (&offsets)[3], EightInts& inFront) {
  const Eight scale = kEdgeOn * core::squareRoot(dot(normal, normal));
  EightInts front = ~EightInts{}, behind = front;
  for (const Vectors& offset : offsets) {
    const Eight height = dot(normal, offset), least = scale * core::squareRoot(dot(offset, offset));
    front &= height > least, behind &= height < -least;
  }
  inFront = front;
  return front | behind;
}

/// Bits for eight triangles in a row.
struct ByKinds {
  unsigned dropped = 0;     ///< a None corner, or three hidden ones
  unsigned partly = 0;      ///< reflected in part
  unsigned atBoundary = 0;  ///< not reflected at any corner, hidden at some
};

ByKinds sortByKinds(const Judge& judge, const std::uint32_t* corners) {
  ByKinds found;
  for (unsigned i = 0; i < unsigned(kLanes); ++i, corners += 3) {
    unsigned present = 0;  // a bit for each kind
    for (int k = 0; k < 3; ++k) present |= 1u << unsigned(judge.kinds[corners[k]]);
    constexpr unsigned kNone = 1u << unsigned(VertexKind::None),
                       kReflected = 1u << unsigned(VertexKind::Reflected),
                       kHidden = 1u << unsigned(VertexKind::DoublyVirtual);
    found.dropped |= unsigned((present & kNone) != 0 || present == kHidden) << i;
    const bool isReflected = (present & kReflected) != 0, isHidden = (present & kHidden) != 0;
    found.partly |= unsigned(isReflected && present != kReflected) << i;
    found.atBoundary |= unsigned(!isReflected && isHidden) << i;
  }
  return found;
}

/// Of eight triangles in a row, those that are not worth drawing.
struct FindDropped {
  static CATOPTRIC_INLINE void run(const Judge& judge, const std::uint32_t*& corners, unsigned& dropped) {
    const ByKinds kinds = sortByKinds(judge, corners);
    dropped = kinds.dropped;
    if (dropped == 0xffu) return;
    Vectors q[3], w[3], j[3];
    for (int k = 0; k < 3; ++k) {
      q[k] = gather(judge.scenePoints, corners + k), w[k] = gather(judge.virtualPositions, corners + k);
      j[k] = gather(judge.reflectionPoints, corners + k);
    }
    const Vectors normal = cross(q[1] - q[0], q[2] - q[0]),
                  offsets[3] = {j[0] - q[0], j[1] - q[1], j[2] - q[2]};
    EightInts inFront;
    const EightInts isSure = findSides(normal, offsets, inFront);
    const Eight zero{};
    const Vectors eye{{zero + judge.eye.x, zero + judge.eye.y, zero + judge.eye.z}};
    const Eight image = dot(cross(w[1] - w[0], w[2] - w[0]), eye - w[0]);
    dropped |= toBits(isSure & (inFront ? image > 0.0f : image < 0.0f));
    if ((kinds.partly | kinds.atBoundary) == 0) return;
    const Vectors chords[3] = {j[0] - j[1], j[1] - j[2], j[2] - j[0]};
    Eight longest{};  // squared
    for (const Vectors& chord : chords) longest = core::larger(longest, dot(chord, chord));
    longest = core::squareRoot(longest);
    dropped |= (kinds.partly & toBits(longest > judge.longest.atRim)) |
               (kinds.atBoundary & toBits(longest > judge.longest.atBoundary));
  }
};

}  // namespace

void dropVirtualTriangles(const TessellatedObjects& objects, const dvec3& eye,
                          std::span<const vec3> virtualPositions, std::span<const VertexKind> kinds,
                          std::span<const vec3> reflectionPoints, std::span<std::uint8_t> isKept,
                          std::span<const vec3> scenePoints, const LongestChords& longest) {
  if (scenePoints.empty()) scenePoints = objects.positions;
  assert(scenePoints.size() == objects.positions.size());
  assert(virtualPositions.size() == objects.positions.size() && kinds.size() == objects.positions.size());
  assert(reflectionPoints.size() == objects.positions.size());
  const Judge judge{scenePoints, virtualPositions, reflectionPoints, kinds, vec3(eye), longest};
  assert(isKept.size() == objects.indices.size() / 3);
  core::parallelFor(isKept.size(), kTrianglesPerTask, [&](std::size_t begin, std::size_t end) {
    dropByEights(objects.indices, begin, end, isKept, [&](const std::uint32_t* corners) {
      unsigned dropped = 0;
      core::runOnWidestVectors<FindDropped>(judge, corners, dropped);
      return dropped;
    });
  });
}

void markVirtualTriangles(const TessellatedObjects& objects, const dvec3& eye,
                          std::span<const vec3> virtualPositions, std::span<const VertexKind> kinds,
                          std::span<const vec3> reflectionPoints, VirtualTriangles& out,
                          std::span<const vec3> scenePoints, const LongestChords& longest) {
  out.isKept.assign(objects.indices.size() / 3, 1);
  dropVirtualTriangles(objects, eye, virtualPositions, kinds, reflectionPoints, out.isKept, scenePoints,
                       longest);
}

void selectVirtualTriangles(const TessellatedObjects& objects, const dvec3& eye,
                            std::span<const vec3> virtualPositions, std::span<const VertexKind> kinds,
                            std::span<const vec3> reflectionPoints, VirtualTriangles& out,
                            std::span<const vec3> scenePoints) {
  markVirtualTriangles(objects, eye, virtualPositions, kinds, reflectionPoints, out, scenePoints);
  gatherVirtualTriangles(objects, objects.indices, {}, out);
}

void gatherVirtualTriangles(const TessellatedObjects& objects, std::span<const std::uint32_t> indices,
                            std::span<const std::uint8_t> isWanted, VirtualTriangles& out) {
  assert(indices.size() == objects.indices.size());
  out.indices.clear();
  out.parts.clear();
  for (const TessellatedPart& part : objects.parts) {
    if (!isWanted.empty() && !isWanted[part.part]) continue;
    TessellatedPart run = part;
    run.firstIndex = std::uint32_t(out.indices.size());
    for (std::size_t i = part.firstIndex; i < part.firstIndex + part.indexCount; i += 3)
      if (out.isKept[i / 3]) out.indices.insert(out.indices.end(), &indices[i], &indices[i] + 3);
    run.indexCount = std::uint32_t(out.indices.size()) - run.firstIndex;
    out.parts.push_back(run);
  }
}

}  // namespace catoptric::raster

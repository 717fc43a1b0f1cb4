// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/culling.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "catoptric/core/eight_lanes.h"
#include "catoptric/core/parallel.h"

namespace catoptric::virtual_object {
namespace {

using core::Eight;
using core::EightInts;
using core::toBits;

constexpr std::size_t kTriangleRun = 32, kLanes = BoxLanes::kLanes, kRun = VertexRuns::kLength;
constexpr unsigned kAll = 0xff;
constexpr float kRounding = 1.000001f;
constexpr std::size_t kSparse =
    4;  // planes all round, every other one: most that are missed lie behind these
static_assert(ReflectedBeams::kPlanes == 2 * kSparse + 1);

/// How deep the innermost and the outermost corner of boxes lie below the nearest plane.
struct Depths {
  Eight most = Eight{} + std::numeric_limits<float>::infinity(), least = most;
};

struct Boxes {
  Eight centre[3], half[3];
};

CATOPTRIC_INLINE Boxes load(const BoxLanes& lanes) {
  Boxes boxes;
  for (int k = 0; k < 3; ++k)
    boxes.centre[k] = core::load(lanes.centre[k]), boxes.half[k] = core::load(lanes.half[k]);
  return boxes;
}

CATOPTRIC_INLINE void dip(const BeamPlane& plane, const Boxes& boxes, Depths& depths) {
  const vec3& n = plane.normal;
  const Eight centre = n.x * boxes.centre[0] + n.y * boxes.centre[1] + n.z * boxes.centre[2] - plane.distance;
  const Eight half =
      std::abs(n.x) * boxes.half[0] + std::abs(n.y) * boxes.half[1] + std::abs(n.z) * boxes.half[2];
  const Eight most = centre + half, least = centre - half;
  depths.most = most < depths.most ? most : depths.most;
  depths.least = least < depths.least ? least : depths.least;
}

/// Calls visit(beam, may, wholly) for those of the beams `among` that some box may meet, until it returns
/// false. What is not a number may be met.
template <class Visit>
CATOPTRIC_INLINE void forEachMet(const ReflectedBeams& beams, std::uint32_t among, const BoxLanes& lanes,
                                 const Visit& visit) {
  const Boxes boxes = load(lanes);
  const EightInts isThere = boxes.half[0] >= 0.0f;
  for (; among != 0; among &= among - 1) {
    const unsigned n = unsigned(std::countr_zero(among));
    const ReflectedBeams::Beam& planes = beams.beams[n];
    Depths depths;
    for (std::size_t k = 0; k < kSparse; ++k) dip(planes[2 * k], boxes, depths);
    if (toBits(isThere & ~(depths.most < 0.0f)) == 0) continue;
    for (std::size_t k = 0; k < kSparse; ++k) dip(planes[2 * k + 1], boxes, depths);
    dip(planes[2 * kSparse], boxes, depths);
    if (!visit(n, isThere & ~(depths.most < 0.0f), depths.least >= 0.0f)) return;
  }
}

/// A bit for each beam.
std::uint32_t allOf(const ReflectedBeams& beams) {
  static_assert(ReflectedBeams::kMost == 32);
  return std::uint32_t((std::uint64_t(1) << beams.beams.size()) - 1);
}

struct MeetBoxes {
  static CATOPTRIC_INLINE void run(const ReflectedBeams& beams, const std::uint32_t& among,
                                   const BoxLanes& boxes, unsigned& met) {
    EightInts found{};
    forEachMet(
        beams, among,
        boxes, [&](unsigned, const EightInts& may, const EightInts&) __attribute__((always_inline)) {
          found |= may;
          return toBits(found) != kAll;
        });
    met = toBits(found);
  }
};

/// The bits of eight runs.
struct FindReflected {
  static CATOPTRIC_INLINE void run(const ReflectedBeams& beams, const BoxLanes& runBoxes,
                                   const BoxLanes* const& vertexBoxes, VertexBits (&found)[kLanes]) {
    EightInts near{}, wholly{};  // bits for the beams that may meet a run
    forEachMet(
        beams, allOf(beams), runBoxes,
        [&](unsigned n, const EightInts& may, const EightInts& whollyHere) __attribute__((always_inline)) {
          near |= may & std::int32_t(1u << n);
          wholly |= may & whollyHere;
          return true;
        });
    for (std::size_t run = 0; run < kLanes; ++run) {
      found[run] = VertexBits(wholly[int(run)]);
      if (near[int(run)] == 0 || wholly[int(run)] != 0) continue;
      for (std::size_t k = 0; k < kRun / kLanes; ++k) {
        unsigned met;
        MeetBoxes::run(beams, std::uint32_t(near[int(run)]), vertexBoxes[run * (kRun / kLanes) + k], met);
        found[run] |= VertexBits(met << k * kLanes);
      }
    }
  }
};

/// The beams where the world is; `moved` keeps them if that is elsewhere.
const ReflectedBeams& seenInWorld(const ReflectedBeams& beams, const dmat4& beamsFromWorld,
                                  ReflectedBeams& moved) {
  if (beamsFromWorld == dmat4(1.0)) return beams;
  moved = moveToWorld(beams, beamsFromWorld);
  return moved;
}

std::size_t groupsOf(std::size_t boxes) {
  return (boxes + kLanes - 1) / kLanes;
}

}  // namespace

void BoxLanes::set(std::size_t lane, const core::Box& box) {
  if (box.isEmpty()) return;
  const vec3 middle(box.centre());
  for (int k = 0; k < 3; ++k) {
    centre[k][lane] = middle[k];
    half[k][lane] = kRounding * float(0.5 * (box.upper[k] - box.lower[k]));
  }
}

VertexRuns::VertexRuns(const raster::TessellatedObjects& objects)
    : vertices_(objects.positions.size()),
      runBoxes_(groupsOf(runs())),
      vertexBoxes_(runBoxes_.size() * kRun) {
  std::vector<core::Box> boxes(vertices_), around(runs());
  for (std::size_t i = 0; i + 2 < objects.indices.size(); i += 3) {
    core::Box triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle.add(dvec3(objects.positions[objects.indices[i + k]]));
    for (std::size_t k = 0; k < 3; ++k) boxes[objects.indices[i + k]].add(triangle);
  }
  for (std::size_t v = 0; v < vertices_; ++v) {
    vertexBoxes_[v / kLanes].set(v % kLanes, boxes[v]);
    around[v / kRun].add(boxes[v]);
  }
  for (std::size_t run = 0; run < around.size(); ++run)
    runBoxes_[run / kLanes].set(run % kLanes, around[run]);
}

void VertexRuns::findReflected(const ReflectedBeams& beams, const dmat4& beamsFromWorld,
                               std::vector<VertexBits>& mayReflect) const {
  constexpr std::size_t kGroupsPerTask = 16;
  ReflectedBeams moved;
  const ReflectedBeams& seen = seenInWorld(beams, beamsFromWorld, moved);
  mayReflect.resize(runs());
  core::parallelFor(runBoxes_.size(), kGroupsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t group = begin; group < end; ++group) {
      VertexBits found[kLanes];
      const BoxLanes* vertexBoxes = &vertexBoxes_[group * kRun];
      core::runOnWidestVectors<FindReflected>(seen, runBoxes_[group], vertexBoxes, found);
      std::copy_n(found, std::min(kLanes, runs() - group * kLanes), &mayReflect[group * kLanes]);
    }
  });
}

std::size_t VertexRuns::countLeftOut(std::span<const VertexBits> mayReflect) const {
  if (mayReflect.empty()) return 0;
  std::size_t count = vertices_;
  for (std::size_t run = 0; run < mayReflect.size(); ++run) {
    const std::size_t length = std::min(kRun, vertices_ - run * kRun);
    count -= std::size_t(std::popcount(mayReflect[run] & ((1u << length) - 1)));
  }
  return count;
}

TriangleRuns::TriangleRuns(std::span<const vec3> positions, std::span<const std::uint32_t> indices)
    : triangles_(indices.size() / 3), boxes_(groupsOf((triangles_ + kTriangleRun - 1) / kTriangleRun)) {
  for (std::size_t first = 0; first < triangles_; first += kTriangleRun) {
    core::Box box;
    for (std::size_t i = 3 * first; i < 3 * std::min(first + kTriangleRun, triangles_); ++i)
      box.add(dvec3(positions[indices[i]]));
    const std::size_t run = first / kTriangleRun;
    boxes_[run / kLanes].set(run % kLanes, box);
  }
}

std::size_t TriangleRuns::mark(const ReflectedBeams& beams, const dmat4& beamsFromWorld,
                               std::vector<std::uint8_t>& mayMeet) const {
  mayMeet.resize(triangles_);
  ReflectedBeams moved;
  const ReflectedBeams& seen = seenInWorld(beams, beamsFromWorld, moved);
  const std::uint32_t all = allOf(seen);
  std::size_t leftOut = 0;
  for (std::size_t group = 0; group < boxes_.size(); ++group) {
    unsigned met;
    core::runOnWidestVectors<MeetBoxes>(seen, all, boxes_[group], met);
    for (std::size_t i = 0; i < kLanes; ++i) {
      const std::size_t first = (group * kLanes + i) * kTriangleRun;
      if (first >= triangles_) break;
      const std::size_t count = std::min(kTriangleRun, triangles_ - first);
      const bool isMet = (met >> i & 1u) != 0;
      std::fill_n(&mayMeet[first], count, std::uint8_t(isMet));
      leftOut += isMet ? 0 : count;
    }
  }
  return leftOut;
}

}  // namespace catoptric::virtual_object

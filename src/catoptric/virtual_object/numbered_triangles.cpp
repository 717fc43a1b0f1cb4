// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/numbered_triangles.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>

#include "catoptric/core/eight_lanes.h"
#include "catoptric/core/parallel.h"
#include "catoptric/raster/eight_triangles.h"

namespace catoptric::virtual_object {
namespace {

using core::Eight;
using core::EightInts;
using core::larger;
using core::smaller;
using core::toBits;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kSnap = 1.0f / 32;  // rasterizers round corners to 1/16 of a pixel at worst, most to 1/256
constexpr std::size_t kVerticesPerTask = 16384, kTrianglesPerTask = 4096;

CATOPTRIC_INLINE Eight absolute(const Eight& a) {
  return larger(a, -a);
}

/// Where triangles are looked for, and which way round.
struct Question {
  std::span<const vec3> screen;
  float facing;       ///< 1 or -1 by winding, 0: either side will do
  vec2 lower, upper;  ///< of the rectangle
};

/// Is a point outside of a triangle whose corners may be `kSnap` away from where they are said to be?
/// `turn`: the sign of its area.
CATOPTRIC_INLINE EightInts isOutside(const Eight (&x)[3], const Eight (&y)[3], const Eight& turn,
                                     const Eight& pointX, const Eight& pointY) {
  EightInts outside{};
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const Eight edgeX = x[next] - x[k], edgeY = y[next] - y[k];
    const Eight slack = 2.0f * kSnap * (absolute(edgeX) + absolute(edgeY) + kSnap);
    outside |= (edgeX * (pointY - y[k]) - edgeY * (pointX - x[k])) * turn < -slack;
  }
  return outside;
}

/// The first and the last pixel of [lower, upper] whose centres, at k + 0.5, lie between the least and the
/// largest of three.
CATOPTRIC_INLINE void findCentres(const Eight (&v)[3], float lower, float upper, Eight& first, Eight& last) {
  const Eight below = Eight{} + (lower - 2), above = Eight{} + (upper + 2);  // in the range of integers
  const Eight least =
      smaller(larger(smaller(smaller(v[0], v[1]), v[2]) - kSnap, Eight{} + lower), above) - 0.5f;
  const Eight most = larger(smaller(larger(larger(v[0], v[1]), v[2]) + kSnap, Eight{} + upper), below) - 0.5f;
  const auto truncate = [](const Eight& a) __attribute__((always_inline)) {
    return __builtin_convertvector(__builtin_convertvector(a, EightInts), Eight);
  };
  first = truncate(least), last = truncate(most);
  first = first < least ? first + 1.0f : first;  // ceil
  last = last > most ? last - 1.0f : last;       // floor
}

/// Of eight triangles in a row, which ones have a pixel of the rectangle whose centre they hold, and turn
/// their front to the eye? Where several centres lie in a triangle's box: it has. So has a NaN.
struct FindSeen {
  static CATOPTRIC_INLINE void run(const Question& question, const std::uint32_t*& corners, unsigned& seen) {
    Eight x[3], y[3];
    for (int k = 0; k < 3; ++k) {
      Eight columns[3];
      core::gatherTriples(&question.screen.data()->x, corners + k, 3, columns);
      x[k] = columns[0], y[k] = columns[1];
    }
    const Eight area = (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]),
                sum = x[0] + x[1] + x[2];
    const EightInts isNan = ~((sum >= 0.0f) | (sum < 0.0f)), isTurnedAway = area * question.facing < 0.0f;
    Eight firstX, lastX, firstY, lastY;
    findCentres(x, question.lower.x, question.upper.x, firstX, lastX);
    findCentres(y, question.lower.y, question.upper.y, firstY, lastY);
    const EightInts isEmpty = (lastX < firstX) | (lastY < firstY),
                    isOne = (firstX == lastX) & (firstY == lastY);
    const Eight turn = area < 0.0f ? Eight{} - 1.0f : Eight{} + 1.0f;
    const EightInts isMissed = isOne & isOutside(x, y, turn, firstX + 0.5f, firstY + 0.5f);
    seen = toBits(isNan | ~(isTurnedAway | isEmpty | isMissed));
  }
};

/// From virtual vertices to pixels.
struct Projection {
  mat4 clipFromDraw;
  vec2 half;  ///< of the picture's size
  std::span<const vec3> positions;
};

struct ProjectRange {
  static CATOPTRIC_INLINE void run(const Projection& projection, const std::size_t& first,
                                   const std::size_t& last, std::vector<vec3>& screen) {
    const mat4& m = projection.clipFromDraw;
    const auto row = [&](int i, const Eight(&p)[3]) __attribute__((always_inline)) {
      return m[0][i] * p[0] + m[1][i] * p[1] + m[2][i] * p[2] + m[3][i];
    };
    for (std::size_t begin = first; begin < last; begin += core::kLanes) {
      std::uint32_t which[core::kLanes];
      for (std::uint32_t i = 0; i < std::uint32_t(core::kLanes); ++i)
        which[i] = std::uint32_t(std::min(begin + i, last - 1));
      Eight p[3];
      core::gatherTriples(&projection.positions.data()->x, which, 1, p);
      const Eight w = row(3, p), inverse = w > 0.0f ? 1.0f / w : Eight{} + kNan;
      const Eight x = projection.half.x * (row(0, p) * inverse + 1.0f),
                  y = projection.half.y * (row(1, p) * inverse + 1.0f);
      const std::size_t count = std::min<std::size_t>(core::kLanes, last - begin);
      for (std::size_t i = 0; i < count; ++i) screen[begin + i] = vec3(x[i], y[i], inverse[i]);
    }
  }
};

}  // namespace

void projectVertices(const PictureView& view, std::span<const vec3> positions, std::vector<vec3>& screen,
                     std::span<const VertexBits> mayReflect) {
  constexpr std::size_t kRun = VertexRuns::kLength;
  const vec2 half(0.5f * float(view.widthPx), 0.5f * float(view.heightPx));
  const Projection projection{view.clipFromDraw, half, positions};
  screen.resize(positions.size());
  const std::size_t runs = (screen.size() + kRun - 1) / kRun;
  core::parallelFor(runs, kVerticesPerTask / kRun, [&](std::size_t firstRun, std::size_t endRun) {
    for (std::size_t run = firstRun, end = 0; run < endRun; run = end) {
      const bool isWanted = mayReflect.empty() || mayReflect[run] != 0;
      end = run + 1;
      while (end < endRun && (mayReflect.empty() || mayReflect[end] != 0) == isWanted) ++end;
      const std::size_t first = run * kRun, last = std::min(end * kRun, screen.size());
      if (isWanted)
        core::runOnWidestVectors<ProjectRange>(projection, first, last, screen);
      else
        std::fill(screen.begin() + std::ptrdiff_t(first), screen.begin() + std::ptrdiff_t(last), vec3(kNan));
    }
  });
}

NumberedMesh makeNumberedMesh(const raster::TessellatedObjects& objects) {
  NumberedMesh mesh;
  mesh.indices.resize(objects.indices.size());
  mesh.vertices.resize(objects.positions.size());
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) mesh.vertices[v] = v;
  mesh.numbers.assign(mesh.vertices.size(), core::kNoId);
  for (std::size_t t = 0; t < objects.sourceTriangles.size(); ++t) {
    const std::uint32_t number = objects.sourceTriangles[t];
    std::array<std::uint32_t, 3> corners{objects.indices[3 * t], objects.indices[3 * t + 1],
                                         objects.indices[3 * t + 2]};
    const auto cornerWith = [&](std::uint32_t wanted) {
      return std::find_if(corners.begin(), corners.end(),
                          [&](std::uint32_t v) { return mesh.numbers[v] == wanted; });
    };
    auto last = cornerWith(number);
    if (last == corners.end()) last = cornerWith(core::kNoId);
    if (last == corners.end()) {
      mesh.vertices.push_back(corners[2]);
      mesh.numbers.push_back(number);
      corners[2] = std::uint32_t(mesh.vertices.size() - 1);
    } else {
      std::rotate(corners.begin(), last + 1, corners.end());
    }
    mesh.numbers[corners[2]] = number;
    std::copy(corners.begin(), corners.end(), mesh.indices.begin() + std::ptrdiff_t(3 * t));
  }
  return mesh;
}

std::size_t dropUnseenTriangles(const raster::TessellatedObjects& objects, const scene::WorldGeometry& world,
                                const PictureView& view, const gl::Scissor& bounds,
                                std::span<const vec3> screen, std::span<std::uint8_t> isKept) {
  const vec2 lower(bounds.x, bounds.y), upper = lower + vec2(bounds.width, bounds.height);
  std::atomic<std::size_t> dropped{0};
  const auto endOf = [](const raster::TessellatedPart& part) {
    return std::size_t(part.firstIndex + part.indexCount) / 3;
  };
  core::parallelFor(isKept.size(), kTrianglesPerTask, [&](std::size_t begin, std::size_t end) {
    auto part = std::partition_point(objects.parts.begin(), objects.parts.end(),
                                     [&](const raster::TessellatedPart& p) { return endOf(p) <= begin; });
    std::size_t count = 0;
    for (std::size_t t = begin; t < end && part != objects.parts.end(); t = endOf(*part++)) {
      const float facing = world.parts[part->part].isSeenFromBehind ? 0.0f
                           : view.windingFlipped                    ? -1.0f
                                                                    : 1.0f;
      const Question question{screen, facing, lower, upper};
      count += raster::dropByEights(objects.indices, t, std::min(end, endOf(*part)), isKept,
                                    [&](const std::uint32_t* corners) {
                                      unsigned seen = 0;
                                      core::runOnWidestVectors<FindSeen>(question, corners, seen);
                                      return ~seen;
                                    });
    }
    dropped += count;
  });
  return dropped;
}

NumberedTriangles::NumberedTriangles(const raster::TessellatedObjects& objects)
    : mesh_(makeNumberedMesh(objects)),
      positions_(gl::BufferKind::Vertex),
      numbers_(gl::BufferKind::Vertex),
      indices_(gl::BufferKind::Index),
      drawPositions_(mesh_.vertices.size()) {
  numbers_.upload(std::span<const std::uint32_t>(mesh_.numbers));
  array_.setUnsignedAttribute(1, numbers_);
  array_.setIndices(indices_);
}

void NumberedTriangles::draw(const raster::FrameContext& frame, const raster::SurfaceView& view,
                             gl::Program& program, std::span<const vec3> virtualPositions,
                             std::span<const std::uint32_t> triangles,
                             std::span<const raster::DrawRange> ranges) {
  core::parallelFor(mesh_.vertices.size(), kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) drawPositions_[i] = virtualPositions[mesh_.vertices[i]];
  });
  positions_.upload(std::span<const vec3>(drawPositions_), true);
  array_.setAttribute(0, positions_, 3);
  array_.bind();
  indices_.upload(triangles, true);
  program.use();
  program.set("u_clipFromDraw", mat4(view.clipFromDraw));
  program.set("u_drawEye", vec3(view.drawEye));
  view.parent->bindAsParent(program);
  const gl::Cull hidden = view.windingFlipped ? gl::Cull::Front : gl::Cull::Back;
  const auto isSeenFromBehind = [&](const raster::DrawRange& range) {
    return frame.scene.geometry().parts[range.part].isSeenFromBehind;
  };
  for (std::size_t first = 0, last = 0; first < ranges.size(); first = last) {
    const bool isTwoSided = isSeenFromBehind(ranges[first]);
    std::uint32_t count = 0;
    for (last = first; last < ranges.size() && isSeenFromBehind(ranges[last]) == isTwoSided &&
                       ranges[last].firstIndex == ranges[first].firstIndex + count;
         ++last)
      count += ranges[last].indexCount;
    gl::setDrawState({.depthTest = true, .depthWrite = true, .cull = isTwoSided ? gl::Cull::None : hidden});
    gl::drawTriangles(ranges[first].firstIndex, count);
  }
}

}  // namespace catoptric::virtual_object

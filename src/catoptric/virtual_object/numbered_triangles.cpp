// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/numbered_triangles.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include "catoptric/core/parallel.h"

namespace catoptric::virtual_object {
namespace {

constexpr float kSnap = 1.0f / 32;  // rasterizers round corners to 1/16 of a pixel at worst, most to 1/256
constexpr std::size_t kVerticesPerTask = 16384, kTrianglesPerTask = 4096;

/// Is the point outside of a triangle whose corners may be `kSnap` away from where they are said to be?
/// `turn`: the sign of its area.
bool isOutside(const std::array<vec2, 3>& p, float turn, const vec2& point) {
  for (std::size_t k = 0; k < 3; ++k) {
    const vec2 edge = p[(k + 1) % 3] - p[k], offset = point - p[k];
    const float slack = 2.0f * kSnap * (std::abs(edge.x) + std::abs(edge.y) + kSnap);
    if ((edge.x * offset.y - edge.y * offset.x) * turn < -slack) return true;
  }
  return false;
}

/// Has a pixel of the rectangle its centre in the triangle, and does its front face the eye (`facing`: 1 or
/// -1 by winding, 0: either side will do)? Where several have theirs in its box: true. True for a NaN, too.
bool mayBeSeen(const std::array<vec2, 3>& p, float facing, const vec2& lower, const vec2& upper) {
  if (std::isnan(p[0].x + p[1].x + p[2].x)) return true;
  const vec2 a = p[1] - p[0], b = p[2] - p[0];
  const float area = a.x * b.y - a.y * b.x;
  if (area * facing < 0.0f) return false;
  const vec2 least = glm::max(glm::min(glm::min(p[0], p[1]), p[2]) - kSnap, lower);
  const vec2 most = glm::min(glm::max(glm::max(p[0], p[1]), p[2]) + kSnap, upper);
  // Pixel k has its centre at k + 0.5.
  const vec2 first = glm::ceil(least - 0.5f), last = glm::floor(most - 0.5f);
  if (last.x < first.x || last.y < first.y) return false;
  return first != last || !isOutside(p, area < 0.0f ? -1.0f : 1.0f, first + 0.5f);
}

}  // namespace

void projectVertices(const PictureView& view, std::span<const vec3> positions, std::vector<vec3>& screen) {
  const mat4& m = view.clipFromDraw;
  const vec2 half(0.5f * float(view.widthPx), 0.5f * float(view.heightPx));
  screen.resize(positions.size());
  core::parallelFor(screen.size(), kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const vec3& p = positions[i];
      const float x = m[0].x * p.x + m[1].x * p.y + m[2].x * p.z + m[3].x;
      const float y = m[0].y * p.x + m[1].y * p.y + m[2].y * p.z + m[3].y;
      const float w = m[0].w * p.x + m[1].w * p.y + m[2].w * p.z + m[3].w;
      const float inverse = w > 0.0f ? 1.0f / w : std::numeric_limits<float>::quiet_NaN();
      screen[i] = vec3(half * (vec2(x, y) * inverse + 1.0f), inverse);
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
  for (const raster::TessellatedPart& part : objects.parts) {
    const float facing = world.parts[part.part].isSeenFromBehind ? 0.0f : view.windingFlipped ? -1.0f : 1.0f;
    core::parallelFor(part.indexCount / 3, kTrianglesPerTask, [&](std::size_t begin, std::size_t end) {
      std::size_t count = 0;
      for (std::size_t t = part.firstIndex / 3 + begin; t < part.firstIndex / 3 + end; ++t) {
        if (!isKept[t]) continue;
        const std::uint32_t* v = &objects.indices[3 * t];
        if (mayBeSeen({vec2(screen[v[0]]), vec2(screen[v[1]]), vec2(screen[v[2]])}, facing, lower, upper))
          continue;
        isKept[t] = 0;
        ++count;
      }
      dropped += count;
    });
  }
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

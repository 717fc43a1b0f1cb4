// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/mixed/incomplete_triangles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>
#include <utility>

#include "catoptric/core/parallel.h"
#include "catoptric/virtual_object/formulas.h"

namespace catoptric::virtual_object {
namespace {

using raster::VertexKind;

constexpr std::size_t kTrianglesPerTask = 4096;
constexpr float kWiderPx = 3.0f;
constexpr float kFarther = 2.0f;  // than to first order
constexpr std::size_t kRowsPerTask = 4;

/// Step 2, in pixels.
struct Bound {
  vec2 lower{1e9f}, upper{-1e9f};
  std::uint32_t triangle = 0;  ///< of the scene
  bool isTwoSided = false;
  void add(const vec2& at) { lower = glm::min(lower, at - kWiderPx), upper = glm::max(upper, at + kWiderPx); }
  [[nodiscard]] bool isEmpty() const { return !(lower.x <= upper.x && lower.y <= upper.y); }
};

/// Pixels of a point in draw space.
vec2 project(const PartImages& images, const dvec3& point) {
  const dvec4 clip = images.clipFromDraw * dvec4(point, 1.0);
  return 0.5f * vec2(images.widthPx, images.heightPx) * (vec2(clip) / float(clip.w) + 1.0f);
}

struct TriangleImages {
  const PartImages& images;
  const std::uint32_t* corners;
  vec3 points[3];

  [[nodiscard]] bool isFound(std::size_t interval, std::size_t k) const {
    return images.vertices[interval].kinds[corners[k]] != VertexKind::None;
  }
  /// Step 1.
  [[nodiscard]] bool isIncomplete(std::size_t interval) const {
    const int found = isFound(interval, 0) + isFound(interval, 1) + isFound(interval, 2);
    return found == 1 || found == 2;
  }
  [[nodiscard]] bool facesMirror(std::size_t interval) const {
    const vec3 normal = glm::cross(points[1] - points[0], points[2] - points[0]);
    for (std::size_t k = 0; k < 3; ++k) {
      const vec3& place = images.vertices[interval].reflectionPoints[corners[k]];
      if (isFound(interval, k) && glm::dot(normal, place - points[k]) > 0) return true;
    }
    return false;
  }
  /// Step 2.
  void addTo(std::size_t interval, Bound& bound) const {
    const IntervalVertices& vertices = images.vertices[interval];
    for (std::size_t k = 0; k < 3; ++k) {
      if (!isFound(interval, k)) continue;
      const vec2 at(images.screens[interval][corners[k]]);
      if (std::isnan(at.x)) continue;
      bound.add(at);
      const double path = glm::length(dvec3(vertices.positions[corners[k]]) - images.eye);
      const MirrorTriangle& mirror = images.mesh.triangles()[vertices.triangles[corners[k]]];
      for (std::size_t m = 0; m < 3; ++m) {
        if (isFound(interval, m)) continue;
        const double edge = glm::length(points[m] - points[k]);
        const auto farthest = float(edge / path * images.pixelsPerTangent);
        const dvec2 place = predictPlace(mirror, images.eye, dvec3(points[m]));
        const float length = glm::length(project(images, mirror.position(place.x, place.y)) - at) * kFarther;
        const float reach = length < farthest ? length : farthest;  // farthest at a focus, too
        bound.add(at - reach), bound.add(at + reach);
      }
    }
  }
};

std::vector<Bound> findBounds(const raster::TessellatedObjects& objects, const scene::WorldGeometry& world,
                              const PartImages& images) {
  std::vector<Bound> bounds;
  std::mutex mutex;
  for (const raster::TessellatedPart& part : objects.parts) {
    const bool isTwoSided = world.parts[part.part].isSeenFromBehind;
    core::parallelFor(part.indexCount / 3, kTrianglesPerTask, [&](std::size_t begin, std::size_t end) {
      std::vector<Bound> own;
      for (std::size_t t = part.firstIndex / 3 + begin; t < part.firstIndex / 3 + end; ++t) {
        const std::uint32_t* v = &objects.indices[3 * t];
        const TriangleImages triangle{
            images, v, {objects.positions[v[0]], objects.positions[v[1]], objects.positions[v[2]]}};
        bool isUnsure = false;
        for (std::size_t i = 0; i < kIntervals; ++i)
          isUnsure = isUnsure || (images.isFound[i] && triangle.isIncomplete(i) &&
                                  (isTwoSided || triangle.facesMirror(i)));
        if (!isUnsure) continue;
        Bound bound{.triangle = objects.sourceTriangles[t], .isTwoSided = isTwoSided};
        for (std::size_t i = 0; i < kIntervals; ++i)
          if (images.isFound[i]) triangle.addTo(i, bound);
        if (!bound.isEmpty()) own.push_back(bound);
      }
      const std::scoped_lock lock(mutex);
      bounds.insert(bounds.end(), own.begin(), own.end());
    });
  }
  return bounds;
}

/// A pixel's ray.
struct Ray {
  vec3 origin, direction;
  float start, pathBefore;  ///< where it begins to hit; from the eye to its origin
};

/// Distance along the ray at which it meets a triangle; none: negative.
float meet(const scene::WorldGeometry& world, const Bound& bound, const Ray& ray) {
  const std::uint32_t* v = &world.indices[3 * std::size_t(bound.triangle)];
  const vec3 a = world.positions[v[0]] - ray.origin, b = world.positions[v[1]] - ray.origin,
             c = world.positions[v[2]] - ray.origin;
  const formulas::RayHit hit =
      formulas::meetTriangle(ray.direction, ray.start, a, b, c, glm::cross(b - a, c - a));
  return hit.isHit && (hit.isFront || bound.isTwoSided) ? hit.t : -1.0f;
}

/// Of the virtual point on the ray from the eye through a point of the mirror, as a depth buffer has it.
float findDepth(const PartImages& images, const vec3& onMirror, float path) {
  const dvec3 along = dvec3(onMirror) - images.eye;
  const dvec4 clip =
      images.clipFromDraw * dvec4(images.eye + along * (double(path) / glm::length(along)), 1.0);
  return float(0.5 * clip.z / clip.w + 0.5);
}

}  // namespace

void drawIncomplete(const raster::TessellatedObjects& objects, const scene::WorldGeometry& world,
                    const RayImages& rays, const PartImages& images, MirrorPixels& pixels) {
  const std::vector<Bound> bounds = findBounds(objects, world, images);
  const gl::Scissor& area = images.bounds;
  const auto addAt = [&](const Bound& bound, int x, int y) {
    const std::size_t i = std::size_t(y - pixels.bounds.y) * std::size_t(pixels.bounds.width) +
                          std::size_t(x - pixels.bounds.x);
    uvec2& best = pixels.confirmed.hits[i];
    if (pixels.partNumbers[i].x != images.part || best.x == bound.triangle + 1) return;
    const std::size_t pixel = std::size_t(y) * std::size_t(rays.widthPx) + std::size_t(x);
    if (rays.words[pixel].y != pixels.word) return;
    const vec4 &origin = rays.origins[pixel], &direction = rays.directions[pixel];
    const float t = meet(world, bound, {vec3(origin), vec3(direction), direction.w, origin.w});
    if (t < 0.0f) return;
    const float path = origin.w + t;
    const uvec2 hit(bound.triangle + 1, std::bit_cast<std::uint32_t>(path));
    // Lengths are positive: their bits have their order.
    if (best.x != 0 && std::pair(best.y, best.x) <= std::pair(hit.y, hit.x)) return;
    best = hit;
    pixels.confirmed.depths[i] = findDepth(images, vec3(origin), path);
  };
  core::parallelFor(std::size_t(area.height), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    const vec2 lower(float(area.x), float(area.y + int(begin))),
        upper(float(area.x + area.width - 1), float(area.y + int(end) - 1));
    for (const Bound& bound : bounds) {
      const ivec2 first(glm::ceil(glm::max(bound.lower, lower))), last(glm::min(bound.upper, upper));
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) addAt(bound, x, y);
    }
  });
}

}  // namespace catoptric::virtual_object

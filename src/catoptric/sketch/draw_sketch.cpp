// SPDX-License-Identifier: Apache-2.0
// The steps of sketch.h.
#include <algorithm>
#include <cmath>
#include <optional>

#include "catoptric/core/parallel.h"
#include "catoptric/sketch/sketch.h"

namespace catoptric::sketch {
namespace {

constexpr double kNearest = 1e-3;     // of the distance eye - scene's first thing: nothing is drawn nearer
constexpr float kBehind = 0.22f;      // how strong a line is that something hides
constexpr double kDepthSlack = 2e-3;  // relative: a line on a surface counts as before it
constexpr std::size_t kRowsAtOnce = 16;

/// A point in the camera's frame: right, up, forward.
dvec3 toView(const scene::CameraFrame& camera, const vec3& point) {
  const dvec3 d = dvec3(point) - camera.eye;
  return {glm::dot(d, camera.right), glm::dot(d, camera.up), glm::dot(d, camera.forward)};
}

/// Picture position of a point of the camera's frame with z > 0; the inverse of rayDirection().
dvec2 toPixels(const scene::CameraFrame& camera, const dvec3& view) {
  const double scale = camera.heightPx / (2.0 * camera.tanHalfFovY);
  return {0.5 * camera.widthPx + scale * view.x / view.z, 0.5 * camera.heightPx - scale * view.y / view.z};
}

void blend(glm::u8vec4& pixel, const Colour& colour, float share) {
  const float alpha = share * float(colour.a) / 255.0f;
  pixel = glm::u8vec4(vec4(glm::mix(vec3(pixel), vec3(colour), alpha) + 0.5f, 255.0f));
}

struct Target {
  const scene::CameraFrame& camera;
  core::ImageRgba8& picture;
  DistanceImage& distances;
  double nearest;
};

/// Step 1: the part of a face in front of the eye, three or four corners.
std::vector<dvec3> cutAtNearPlane(const Target& target, const Face& face) {
  std::vector<dvec3> kept;
  for (int k = 0; k < 3; ++k) {
    const dvec3 a = toView(target.camera, face.corners[std::size_t(k)]);
    const dvec3 b = toView(target.camera, face.corners[std::size_t(k + 1) % 3]);
    if (a.z >= target.nearest) kept.push_back(a);
    if ((a.z >= target.nearest) != (b.z >= target.nearest))
      kept.push_back(glm::mix(a, b, (target.nearest - a.z) / (b.z - a.z)));
  }
  return kept;
}

struct PreparedFace {
  std::vector<dvec2> corners;  ///< in the picture, counter-clockwise there or clockwise
  dvec3 normal{0};             ///< of its plane, in the camera's frame
  double offset = 0;           ///< dot(normal, point of the plane)
  Colour colour{};
  double top = 0, bottom = 0;
};

std::optional<PreparedFace> prepareFace(const Target& target, const Face& face) {
  const std::vector<dvec3> kept = cutAtNearPlane(target, face);
  if (kept.size() < 3) return std::nullopt;
  PreparedFace prepared;
  prepared.normal = glm::cross(kept[1] - kept[0], kept[2] - kept[0]);
  prepared.offset = glm::dot(prepared.normal, kept[0]);
  prepared.colour = face.colour;
  prepared.top = 1e30, prepared.bottom = -1e30;
  for (const dvec3& corner : kept) {
    prepared.corners.push_back(toPixels(target.camera, corner));
    prepared.top = std::min(prepared.top, prepared.corners.back().y);
    prepared.bottom = std::max(prepared.bottom, prepared.corners.back().y);
  }
  return std::isfinite(prepared.top + prepared.bottom) ? std::optional(prepared) : std::nullopt;
}

/// One row of a face: from the outermost crossings of its edges.
void fillRow(const Target& target, const PreparedFace& face, int y) {
  const double at = y + 0.5;
  double left = 1e30, right = -1e30;
  for (std::size_t k = 0; k < face.corners.size(); ++k) {
    const dvec2 a = face.corners[k], b = face.corners[(k + 1) % face.corners.size()];
    if ((a.y <= at) == (b.y <= at)) continue;
    const double x = a.x + (b.x - a.x) * (at - a.y) / (b.y - a.y);
    left = std::min(left, x), right = std::max(right, x);
  }
  const double most = target.camera.widthPx;
  if (!(left <= right) || right < 0 || left > most) return;
  const int first = int(std::ceil(std::max(left - 0.5, 0.0)));
  const int last = int(std::floor(std::min(right - 0.5, most - 1.0)));
  const double scale = 2.0 * target.camera.tanHalfFovY / target.camera.heightPx;
  for (int x = first; x <= last; ++x) {
    const dvec3 ray((x + 0.5 - 0.5 * target.camera.widthPx) * scale,
                    (0.5 * target.camera.heightPx - at) * scale, 1.0);
    const double distance = face.offset / glm::dot(face.normal, ray) * glm::length(ray);
    float& before = target.distances.at(x, y);
    if (!(distance > 0) || !(distance < double(before) * (1.0 + 1e-6))) continue;
    blend(target.picture.at(x, y), face.colour, 1.0f);
    if (face.colour.a == 255) before = float(distance);
  }
}

void drawFaces(const Target& target, const std::vector<Face>& faces) {
  std::vector<PreparedFace> prepared;
  for (const Face& face : faces)
    if (auto one = prepareFace(target, face)) prepared.push_back(std::move(*one));
  // Opaque faces first, so that a transparent one lies over what is behind it.
  std::stable_partition(prepared.begin(), prepared.end(), [](const auto& f) { return f.colour.a == 255; });
  core::parallelFor(std::size_t(target.camera.heightPx), kRowsAtOnce,
                    [&](std::size_t begin, std::size_t end) {
                      for (const PreparedFace& face : prepared)
                        for (int y = std::max(int(begin), int(std::max(face.top - 0.5, 0.0)));
                             y < int(end) && y <= face.bottom; ++y)
                          fillRow(target, face, y);
                    });
}

/// Step 2: a stroke between two points of the picture, with 1 / z linear along it.
void drawStroke(const Target& target, const dvec3& a, const dvec3& b, const Colour& colour, double widthPx) {
  const dvec2 from = toPixels(target.camera, a), to = toPixels(target.camera, b), along = to - from;
  const double squared = std::max(glm::dot(along, along), 1e-12), reach = 0.5 * widthPx + 1.0;
  const auto clampTo = [](double value, int size) { return int(std::clamp(value, 0.0, double(size))); };
  const int x0 = clampTo(std::min(from.x, to.x) - reach, target.camera.widthPx);
  const int x1 = clampTo(std::max(from.x, to.x) + reach + 1, target.camera.widthPx);
  const int y0 = clampTo(std::min(from.y, to.y) - reach, target.camera.heightPx);
  const int y1 = clampTo(std::max(from.y, to.y) + reach + 1, target.camera.heightPx);
  const double scale = 2.0 * target.camera.tanHalfFovY / target.camera.heightPx;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const dvec2 p(x + 0.5, y + 0.5);
      const double t = std::clamp(glm::dot(p - from, along) / squared, 0.0, 1.0);
      const double cover = std::clamp(0.5 * widthPx + 0.5 - glm::length(p - from - t * along), 0.0, 1.0);
      if (cover <= 0) continue;
      const double z = 1.0 / glm::mix(1.0 / a.z, 1.0 / b.z, t);
      const dvec2 slope = (p - 0.5 * dvec2(target.camera.widthPx, target.camera.heightPx)) * scale;
      const double distance = z * std::sqrt(1.0 + glm::dot(slope, slope));
      const bool isHidden = distance > double(target.distances.at(x, y)) * (1.0 + kDepthSlack);
      blend(target.picture.at(x, y), colour, float(cover) * (isHidden ? kBehind : 1.0f));
    }
}

void drawLine(const Target& target, const Line& line) {
  dvec3 a = toView(target.camera, line.from), b = toView(target.camera, line.to);
  if (a.z < target.nearest && b.z < target.nearest) return;
  if (a.z < target.nearest) a = glm::mix(a, b, (target.nearest - a.z) / (b.z - a.z));
  if (b.z < target.nearest) b = glm::mix(b, a, (target.nearest - b.z) / (a.z - b.z));
  if (std::isfinite(glm::dot(a, b))) drawStroke(target, a, b, line.colour, double(line.widthPx));
}

void drawDot(const Target& target, const Dot& dot) {
  const dvec3 at = toView(target.camera, dot.at);
  if (at.z >= target.nearest) drawStroke(target, at, at, dot.colour, 2.0 * double(dot.radiusPx));
}

}  // namespace

void drawSketch(const Sketch& sketch, const scene::CameraFrame& camera, core::ImageRgba8& picture,
                DistanceImage& distances) {
  float nearest = 1e30f;
  const auto consider = [&](float distance) {
    if (distance > 0) nearest = std::min(nearest, distance);
  };
  for (const float distance : distances.pixels()) consider(distance);
  for (const Line& line : sketch.lines) consider(glm::length(line.to - vec3(camera.eye)));
  for (const Face& face : sketch.faces) consider(glm::length(face.corners[0] - vec3(camera.eye)));
  for (const Dot& dot : sketch.dots) consider(glm::length(dot.at - vec3(camera.eye)));
  const Target target{camera, picture, distances, std::max(kNearest * double(nearest), 1e-9)};
  drawFaces(target, sketch.faces);
  for (const Line& line : sketch.lines) drawLine(target, line);
  for (const Dot& dot : sketch.dots) drawDot(target, dot);
}

}  // namespace catoptric::sketch

// SPDX-License-Identifier: Apache-2.0
#include "catoptric/sketch/section.h"

#include <algorithm>
#include <cmath>

#include "catoptric/core/parallel.h"

namespace catoptric::sketch {
namespace {

using virtual_object::CellPoint;
using virtual_object::ExplosionMap;
using virtual_object::MirrorTriangle;
using virtual_object::ReflectorMesh;
using virtual_object::VirtualObjectSolver;

constexpr float kPale = 0.55f;  // how much white is in the colour of a reflected cell

/// Where the plane cuts an edge of the mesh, with the normal there (unit).
struct ProfilePoint {
  dvec3 position{0}, normal{0};
};

struct ProfileSegment {
  ProfilePoint a, b;
};

/// Of the ordinary triangles that the plane cuts.
std::vector<ProfileSegment> cutMesh(const ReflectorMesh& mesh, const Section& section) {
  std::vector<ProfileSegment> segments;
  const dvec3 n = section.normal();
  for (std::size_t t = 0; t < mesh.ordinaryCount(); ++t) {
    std::vector<ProfilePoint> ends;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.corners()[3 * t + k], w = mesh.corners()[3 * t + (k + 1) % 3];
      const double a = glm::dot(mesh.positions()[v] - section.centre, n);
      const double b = glm::dot(mesh.positions()[w] - section.centre, n);
      if ((a < 0) == (b < 0)) continue;
      const double share = a / (a - b);
      ends.push_back({glm::mix(mesh.positions()[v], mesh.positions()[w], share),
                      glm::normalize(glm::mix(mesh.normals()[v], mesh.normals()[w], share))});
    }
    if (ends.size() == 2) segments.push_back({ends[0], ends[1]});
  }
  return segments;
}

bool isFront(const ProfilePoint& point, const dvec3& eye) {
  return glm::dot(point.normal, eye - point.position) >= 0;
}

dvec3 reflectAt(const ProfilePoint& point, const dvec3& eye) {
  return core::reflectDirection(glm::normalize(point.position - eye), point.normal);
}

/// Front points of the outline, in order of their place across the line of sight, none twice.
std::vector<ProfilePoint> listFront(const std::vector<ProfileSegment>& segments, const dvec3& eye,
                                    const Section& section) {
  std::vector<ProfilePoint> front;
  for (const ProfileSegment& segment : segments)
    for (const ProfilePoint& end : {segment.a, segment.b})
      if (isFront(end, eye)) front.push_back(end);
  const auto place = [&](const ProfilePoint& p) { return glm::dot(p.position - section.centre, section.up); };
  std::sort(front.begin(), front.end(),
            [&](const ProfilePoint& a, const ProfilePoint& b) { return place(a) < place(b); });
  const double least = 1e-5 * section.width;
  front.erase(
      std::unique(front.begin(), front.end(),
                  [&](const auto& a, const auto& b) { return glm::length(a.position - b.position) < least; }),
      front.end());
  return front;
}

Colour mixColours(const Colour& a, const Colour& b, float share) {
  return Colour(glm::mix(vec4(a), vec4(b), share) + 0.5f);
}

}  // namespace

scene::CameraFrame Section::makeCamera() const {
  constexpr double kAway = 1000;  // widths
  scene::CameraFrame camera;
  camera.eye = centre + kAway * width * normal();
  camera.right = right, camera.up = up, camera.forward = -normal();
  camera.tanHalfFovY = 0.5 * width * heightPx / widthPx / (kAway * width);
  camera.widthPx = widthPx, camera.heightPx = heightPx;
  return camera;
}

Section makeSection(const ReflectorMesh& mesh, const dvec3& eye, const dvec3& sideways, double width,
                    int widthPx, int heightPx) {
  Section section;
  const dvec3 toMirror = mesh.centre() - eye;
  section.right = glm::normalize(toMirror);
  section.up = glm::normalize(sideways - glm::dot(sideways, section.right) * section.right);
  section.width = width > 0 ? width : 2.0 * (glm::length(toMirror) + mesh.bodyRadius());
  section.centre = mesh.centre();
  section.widthPx = widthPx, section.heightPx = heightPx;
  return section;
}

core::ImageRgba8 drawCells(const ReflectorMesh& mesh, const dvec3& eye, const Section& section) {
  virtual_object::ReflectedRays rays;
  static_cast<void>(computeReflectedRays(mesh, eye, rays));
  virtual_object::ReflectionSubdivision subdivision;
  subdivision.build(mesh, eye, rays);
  core::ImageRgba8 picture(section.widthPx, section.heightPx, glm::u8vec4(255));
  core::parallelFor(std::size_t(section.heightPx), 8, [&](std::size_t begin, std::size_t end) {
    std::vector<CellPoint> found;
    for (int y = int(begin); y < int(end); ++y)
      for (int x = 0; x < section.widthPx; ++x) {
        const dvec3 point = section.at(x + 0.5, y + 0.5);
        glm::u8vec4& pixel = picture.at(x, y);
        subdivision.findReflectedCells(point, found);
        std::erase_if(found, [&](const CellPoint& c) { return c.at.triangle >= mesh.ordinaryCount(); });
        if (const auto hidden = subdivision.findHiddenCell(point)) {
          pixel = mixColours(colourOfNumber(hidden->at.triangle), Colour(70, 80, 110, 255), 0.6f);
        } else if (found.size() == 1) {
          pixel = mixColours(colourOfNumber(found.front().at.triangle), Colour(255), kPale);
        } else if (!found.empty()) {
          pixel = mixColours(Colour(225, 190, 240, 255), Colour(80, 20, 110, 255),
                             std::min(1.0f, float(found.size() - 2) / 4.0f));
        }
      }
  });
  return picture;
}

Sketch sketchProfile(const ReflectorMesh& mesh, const dvec3& eye, const Section& section, int mostRays) {
  Sketch sketch;
  const std::vector<ProfileSegment> segments = cutMesh(mesh, section);
  for (const ProfileSegment& s : segments) sketch.addLine(s.a.position, s.b.position, kBlack, 3);
  const std::vector<ProfilePoint> front = listFront(segments, eye, section);
  const double length = 2.0 * section.width;
  const std::size_t count = std::min(front.size(), std::size_t(std::max(mostRays, 2)));
  for (std::size_t i = 0; i < count; ++i) {
    const ProfilePoint& p = front[count > 1 ? i * (front.size() - 1) / (count - 1) : 0];
    sketch.addLine(p.position, section.project(p.position + length * reflectAt(p, eye)), kRed, 1.5f);
    sketch.addLine(p.position, p.position + length * glm::normalize(p.position - eye), kBlue, 1.5f);
    sketch.addDot(p.position, kBlack, 3);
  }
  for (const ProfileSegment& s : segments) {  // Z, where the outline turns away
    if (isFront(s.a, eye) == isFront(s.b, eye)) continue;
    const ProfilePoint& last = isFront(s.a, eye) ? s.a : s.b;
    const dvec3 view = glm::normalize(last.position - eye);
    const dvec3 along = glm::normalize(view - glm::dot(view, last.normal) * last.normal);
    sketch.addLine(last.position, last.position + length * along, kGreen, 2);
  }
  sketch.addDot(eye, kBlack, 7);
  return sketch;
}

Sketch sketchMapping(const ReflectorMesh& mesh, const dvec3& eye, const ExplosionMap& map,
                     const Section& section, double share) {
  Sketch sketch;
  sketch.addCircle(map.centre, map.radius, section.right, section.up, kGrey);
  sketch.addDot(map.centre, kGrey);
  const std::vector<ProfilePoint> front = listFront(cutMesh(mesh, section), eye, section);
  if (front.empty()) return sketch;
  const ProfilePoint& p = front[std::size_t(std::lround(share * double(front.size() - 1)))];
  const dvec3 ray = reflectAt(p, eye), from = p.position - map.centre;
  const double half = glm::dot(from, ray);
  const double reach =
      -half + std::sqrt(std::max(half * half - glm::dot(from, from) + map.radius * map.radius, 0.0));
  const dvec3 end = p.position + reach * ray;
  sketch.addLine(eye, p.position, kBlack);                                                           // V
  sketch.addDashes(p.position, p.position + 0.4 * map.radius * p.normal, 0.02 * map.radius, kGrey);  // N
  sketch.addLine(p.position, end, kRed);                                                             // R
  sketch.addLine(map.centre, end, kBlue);                                                            // D
  sketch.addDot(p.position, kBlack);
  sketch.addDot(end, kBlue);
  return sketch;
}

Sketch sketchLookUp(const VirtualObjectSolver& solver, const dvec3& point, const Section& section,
                    bool withFarMap) {
  Sketch sketch;
  const double dash = 0.008 * section.width;
  const auto ask = [&](const ExplosionMap& map, const Colour& colour) {
    sketch.addCircle(map.centre, map.radius, section.right, section.up, colour);
    const dvec3 direction = glm::normalize(point - map.centre);
    sketch.addDashes(map.centre, map.centre + map.radius * direction, dash, colour);
    sketch.addDot(map.centre + map.radius * direction, colour);
    const auto answer = lookUpMap(solver.mesh(), map, computeMapCoords(map.frame, direction));
    const MirrorTriangle& triangle = solver.mesh().triangles()[answer.at.triangle];
    const dvec3 at = triangle.position(answer.at.u, answer.at.v);
    const dvec3 normal = glm::normalize(triangle.normal(answer.at.u, answer.at.v));
    const dvec3 mirrored = core::reflectPoint(point, {normal, -glm::dot(normal, at)});
    const dvec3 tangent = 0.12 * section.width * glm::normalize(glm::cross(normal, section.normal()));
    sketch.addLine(at - tangent, at + tangent, colour, 1.5f);
    sketch.addDashes(point, mirrored, dash, colour, 1.5f);
    sketch.addDot(at, colour);
    sketch.addDot(mirrored, colour, 5);
  };
  ask(solver.nearMap(), kOrange);
  if (withFarMap) ask(solver.farMap(), kViolet);
  const auto published = solver.findReflectionPoint(virtual_object::Solver::Explosion, point);
  if (published && withFarMap) sketch.addDot(published->virtualPosition, kBlue, 6);
  if (const auto right = solver.findReflectionPoint(virtual_object::Solver::Refined, point)) {
    sketch.addLine(solver.eye(), right->position, kGreen, 1.5f);
    sketch.addLine(right->position, point, kGreen, 1.5f);
    sketch.addDashes(right->position, right->virtualPosition, dash, kGreen, 1.5f);
    sketch.addDot(right->virtualPosition, kGreen, 5);
  }
  sketch.addDot(point, kRed, 6);
  return sketch;
}

}  // namespace catoptric::sketch

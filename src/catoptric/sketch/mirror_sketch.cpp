// SPDX-License-Identifier: Apache-2.0
#include "catoptric/sketch/mirror_sketch.h"

#include <algorithm>

#include "catoptric/core/seen.h"

namespace catoptric::sketch {

using virtual_object::ReflectorMesh;
using virtual_object::VirtualObjectSolver;

std::vector<Colour> colourTriangles(const ReflectorMesh& mesh) {
  constexpr std::size_t kFew = 1000;  // that can be told apart by colours without order
  constexpr float kMiddle = 0.5f, kRange = 0.42f, kSteps = 7;
  std::vector<Colour> colours;
  for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    if (mesh.triangles().size() <= kFew) {
      colours.push_back(colourOfNumber(t));
      continue;
    }
    const vec3 from(mesh.triangles()[t].position(1.0 / 3, 1.0 / 3) - mesh.centre());
    const float step = float(t * 2654435769u >> 16 & 0xffffu) / 65536.0f;  // neighbours still differ a little
    const vec3 place = from / std::max(float(mesh.radius()), 1e-30f);
    const vec3 colour = (kMiddle + kRange * place) * (0.75f + 0.35f * std::floor(kSteps * step) / kSteps);
    colours.emplace_back(glm::u8vec3(255.0f * glm::clamp(colour, 0.0f, 1.0f)), 255);
  }
  return colours;
}

core::ImageRgba8 drawMap(const core::Image<std::uint32_t>& ids, bool hasExtensionBit,
                         std::span<const Colour> colours) {
  constexpr float kExtension = 0.4f;
  core::ImageRgba8 picture(ids.width(), ids.height(), glm::u8vec4(0, 0, 0, 255));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::uint32_t id = ids.pixels()[i];
    if (id == core::kNoId) continue;
    const bool isExtension = hasExtensionBit && (id & virtual_object::kExtensionBit) != 0;
    const vec4 colour(colours[hasExtensionBit ? id / 2 : id]);
    picture.pixels()[i] = Colour(vec3(colour) * (isExtension ? kExtension : 1.0f) + 0.5f, 255);
  }
  return picture;
}

core::ImageRgba8 drawMaps(const VirtualObjectSolver& solver) {
  const std::vector<Colour> colours = colourTriangles(solver.mesh());
  return putSideBySide({drawMap(solver.nearMap().ids, true, colours),
                        drawMap(solver.farMap().ids, true, colours),
                        drawMap(solver.hiddenMap().ids, false, colours)});
}

Sketch sketchRays(const ReflectorMesh& mesh, const dvec3& eye, int count, double length) {
  virtual_object::ReflectedRays rays;
  static_cast<void>(computeReflectedRays(mesh, eye, rays));
  // Farthest-first, so that few rays are spread over the whole mirror.
  std::vector<std::uint32_t> front;
  const std::span<const std::uint32_t> corners = mesh.corners().first(3 * mesh.ordinaryCount());
  for (const std::uint32_t v : corners)
    if (rays.isFront[v]) front.push_back(v);
  std::sort(front.begin(), front.end());
  front.erase(std::unique(front.begin(), front.end()), front.end());
  std::vector<double> distance(front.size(), 1e300);
  Sketch sketch;
  for (int k = 0; k < std::min(count, int(front.size())); ++k) {
    const auto farthest = std::size_t(std::max_element(distance.begin(), distance.end()) - distance.begin());
    const dvec3 at = mesh.positions()[front[farthest]];
    for (std::size_t i = 0; i < front.size(); ++i)
      distance[i] = std::min(distance[i], glm::length(mesh.positions()[front[i]] - at));
    sketch.addLine(eye, at, kGrey, 1.2f);
    sketch.addLine(at, at + length * rays.directions[front[farthest]], kRed);
    sketch.addLine(at, at + length * glm::normalize(at - eye), kBlue, 1.2f);
  }
  return sketch;
}

std::optional<Sketch> sketchCell(const ReflectorMesh& mesh, const dvec3& eye, std::uint32_t triangle,
                                 double length) {
  constexpr int kRulings = 16;
  constexpr Colour kReflectedSide{230, 120, 100, 150}, kHiddenSide{110, 150, 230, 150};
  virtual_object::ReflectedRays rays;
  static_cast<void>(computeReflectedRays(mesh, eye, rays));
  if (!rays.isMapped[triangle]) return std::nullopt;
  Sketch sketch;
  const auto addSide = [&](const dvec3& a, const dvec3& rayA, const dvec3& b, const dvec3& rayB, Colour side,
                           Colour edge) {
    for (int i = 0; i < kRulings; ++i) {
      const double t0 = length * i / kRulings, t1 = length * (i + 1) / kRulings;
      sketch.addFace(a + t0 * rayA, b + t0 * rayB, b + t1 * rayB, side);
      sketch.addFace(a + t0 * rayA, b + t1 * rayB, a + t1 * rayA, side);
      sketch.addLine(a + t1 * rayA, b + t1 * rayB, edge, 1.0f);
    }
    sketch.addLine(a, a + length * rayA, edge);
  };
  dvec3 corners[3];
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t v = mesh.corners()[3 * triangle + k],
                        next = mesh.corners()[3 * triangle + (k + 1) % 3];
    const dvec3 a = mesh.positions()[v], b = mesh.positions()[next];
    corners[k] = a;
    addSide(a, rays.directions[v], b, rays.directions[next], kReflectedSide, kRed);
    addSide(a, glm::normalize(a - eye), b, glm::normalize(b - eye), kHiddenSide, kBlue);
    sketch.addLine(a, b, kBlack, 2.5f);
    sketch.addLine(eye, a, kGrey, 1.0f);
  }
  sketch.addFace(corners[0], corners[1], corners[2], Colour(250, 220, 80, 255));
  return sketch;
}

std::optional<std::uint32_t> findTriangleOf(const VirtualObjectSolver& solver, const dvec3& point) {
  const auto found = solver.findReflectionPoint(virtual_object::Solver::Refined, point);
  if (!found || found->at.triangle >= solver.mesh().ordinaryCount()) return std::nullopt;
  return found->at.triangle;
}

Sketch sketchReflectedPoint(const VirtualObjectSolver& solver, const dvec3& point) {
  Sketch sketch;
  const auto found = solver.findReflectionPoint(virtual_object::Solver::Refined, point);
  if (!found) return sketch;
  sketch.addLine(solver.eye(), found->position, kGrey);
  sketch.addLine(found->position, point, kRed);
  sketch.addLine(found->position, found->virtualPosition, kBlue);
  sketch.addDot(point, kRed);
  sketch.addDot(found->position, kBlack);
  sketch.addDot(found->virtualPosition, kBlue);
  return sketch;
}

Sketch sketchVirtualTriangles(std::span<const vec3> virtualPositions,
                              const raster::VirtualTriangles& triangles, bool withFaces) {
  Sketch sketch;
  for (const raster::TessellatedPart& part : triangles.parts) {
    const Colour edge = colourOfNumber(part.part, 0.7f);
    const Colour face = Colour((glm::uvec4(colourOfNumber(part.part)) + 2u * glm::uvec4(255)) / 3u);
    for (std::uint32_t i = part.firstIndex; i < part.firstIndex + part.indexCount; i += 3) {
      vec3 corners[3];
      for (std::uint32_t k = 0; k < 3; ++k) corners[k] = virtualPositions[triangles.indices[i + k]];
      if (withFaces) sketch.addFace(corners[0], corners[1], corners[2], face);
      for (std::uint32_t k = 0; k < 3; ++k) sketch.addLine(corners[k], corners[(k + 1) % 3], edge, 1.0f);
    }
  }
  return sketch;
}

}  // namespace catoptric::sketch

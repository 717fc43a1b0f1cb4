// SPDX-License-Identifier: Apache-2.0
#include "catoptric/depth_reflection_map/inverse_warp.h"

#include <algorithm>
#include <array>
#include <string>

namespace catoptric::depth_reflection_map {
namespace {

constexpr double kOpenFrom = 0.3;       // length of the mean normal; a closed surface has 0
constexpr double kBefore = 0.15;        // of an open surface's radius
constexpr double kAround = 1.02;        // of the radius
constexpr double kFarthestImage = 4.0;  // of an eye by a concave mirror, of the radius
constexpr double kImageGrid = 0.05;     // likewise: the eye may move for a while until a cube is drawn anew
constexpr std::uint32_t kMostSamples = 256;
constexpr float kTexelsPerStep = 1.5f;

}  // namespace

ReflectorOutline measureOutline(const scene::WorldGeometry& world, std::uint32_t reflector) {
  const scene::Part& part = world.parts[world.reflectors[reflector].part];
  ReflectorOutline outline;
  for (std::uint32_t v = part.firstVertex; v < part.firstVertex + part.vertexCount; ++v) {
    outline.middle += dvec3(world.positions[v]);
    outline.normal += dvec3(world.normals[v]);
  }
  const double count = std::max<double>(part.vertexCount, 1);
  outline.middle /= count;
  outline.normal /= count;
  const std::uint32_t step = std::max(1u, part.vertexCount / kMostSamples);
  for (std::uint32_t v = part.firstVertex; v < part.firstVertex + part.vertexCount; v += step)
    outline.samples.push_back({dvec3(world.positions[v]), dvec3(world.normals[v])});
  return outline;
}

std::optional<dvec3> findEyeImage(const ReflectorOutline& outline, const dvec3& eye) {
  dmat3 sum(0.0);
  dvec3 right(0);
  for (const auto& [p, n] : outline.samples) {
    const dvec3 r = core::reflectDirection(glm::normalize(p - eye), glm::normalize(n));
    const dmat3 across = dmat3(1.0) - glm::outerProduct(r, r);
    sum += across;
    right += across * p;
  }
  const double scale = double(outline.samples.size());
  if (!(glm::determinant(sum) > 1e-6 * scale * scale * scale)) return std::nullopt;
  return glm::inverse(sum) * right;
}

std::vector<dvec3> makeCubeCentres(const scene::Reflector& mirror, const ReflectorOutline& outline,
                                   const dvec3& eye) {
  const bool isOpen = glm::length(outline.normal) > kOpenFrom;
  const bool isFromBehind = mirror.doubleSided && glm::dot(eye - outline.middle, outline.normal) < 0.0;
  const dvec3 normal = isFromBehind ? -outline.normal : outline.normal;
  std::vector<dvec3> centres{isOpen ? outline.middle + kBefore * mirror.radius * glm::normalize(normal)
                                    : mirror.centre};
  for (const dvec3& axis : {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)})
    for (const double sign : {1.0, -1.0}) {
      if (isOpen && glm::dot(sign * axis, normal) < 0.0) continue;  // would be behind it
      centres.push_back(centres[0] + sign * kAround * mirror.radius * axis);
    }
  if (!isOpen) return centres;
  const auto image = findEyeImage(outline, eye);
  const double distance = image ? glm::dot(*image - outline.middle, glm::normalize(normal)) : 0.0;
  if (distance < kBefore * mirror.radius || distance > kFarthestImage * mirror.radius) return centres;
  const double grid = kImageGrid * mirror.radius;
  return {glm::round(*image / grid) * grid, centres[0]};
}

InverseWarp::InverseWarp() : program_("raster/screen.vert", "depth_reflection_map/inverse_warp.frag") {}

void InverseWarp::setOptions(const ZexelOptions& options) {
  cubes_.setLimits(std::max(8, 3 * options.size / 4), options.maxBytes);
  references_ = options.references;
  marksExposures_ = options.marksExposures;
}

void InverseWarp::render(raster::FrameContext& frame, const raster::Chain& chain, const raster::Level& parent,
                         const raster::Level& target) {
  // 1, 2
  const dvec3 eye = dvec3(glm::inverse(chain.screenFromDraw) * dvec4(frame.camera.eye, 1.0));
  const scene::WorldGeometry& world = frame.scene.geometry();
  const auto [outline, isNew] = outlines_.try_emplace(chain.last);
  if (isNew) outline->second = measureOutline(world, chain.last);
  const std::vector<dvec3> centres = makeCubeCentres(world.reflectors[chain.last], outline->second, eye);
  int second = 0;
  for (int i = 1; i < int(centres.size()); ++i)
    if (second == 0 ||
        glm::length(centres[std::size_t(i)] - eye) < glm::length(centres[std::size_t(second)] - eye))
      second = i;
  const int count = second > 0 ? references_ : 1;
  const std::uint64_t captures = cubes_.captures();
  std::array<const raster::SceneCube*, 2> cubes{};
  cubes[0] = &cubes_.take(frame, {chain.last, 0}, centres[0]);
  cubes[1] = count > 1 ? &cubes_.take(frame, {chain.last, second}, centres[std::size_t(second)]) : cubes[0];
  frame.counters.zexelCaptures += cubes_.captures() - captures;

  // 3
  target.surfaces.bind();
  gl::setScissor(chain.bounds);
  gl::setDrawState({.depthTest = false, .depthWrite = false});
  program_.use();
  parent.bindAsParent(program_);
  program_.set("u_parentWord", chain.parentWord());
  program_.set("u_chain", chain.id);
  program_.set("u_step", kTexelsPerStep * 1.5707963f / float(cubes_.sizeTexels()));
  program_.set("u_cubeCount", count);
  program_.set("u_marksExposures", marksExposures_ ? 1 : 0);
  int unit = raster::kUnitFirstFree + 4;
  for (std::size_t i = 0; i < cubes.size(); ++i) {
    const std::string suffix(1, char('0' + i));
    const std::array<std::pair<const char*, const gl::Texture*>, 3> textures{
        {{"u_color", &cubes[i]->color}, {"u_position", &cubes[i]->position}, {"u_ids", &cubes[i]->ids}}};
    for (const auto& [name, texture] : textures) {
      texture->bind(unit);
      program_.set(name + suffix, unit++);
    }
    program_.set("u_centre" + suffix, vec3(cubes[i]->centre));
  }
  nothing_.bind();
  gl::drawScreen();
}

}  // namespace catoptric::depth_reflection_map

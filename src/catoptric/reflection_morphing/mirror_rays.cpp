// SPDX-License-Identifier: Apache-2.0
#include "catoptric/reflection_morphing/mirror_rays.h"

namespace catoptric::reflection_morphing {
namespace {

constexpr double kLeastSegment = 1e-7;  // of the scene's radius

geometry::TriangleBvh makeHierarchy(const scene::WorldGeometry& world,
                                    std::vector<std::uint32_t>& worldTriangles) {
  std::vector<vec3> corners;
  std::vector<std::uint8_t> twoSided;
  for (std::uint32_t t = 0; t < world.triangleCount(); ++t) {
    const std::uint32_t reflector = world.parts[world.triangleParts[t]].reflector;
    if (reflector == core::kNoId) continue;
    worldTriangles.push_back(t);
    for (std::uint32_t k = 0; k < 3; ++k) corners.push_back(world.positions[world.indices[3 * t + k]]);
    twoSided.push_back(world.reflectors[reflector].doubleSided ? 1 : 0);
  }
  return geometry::TriangleBvh(std::move(corners), std::move(twoSided));
}

}  // namespace

MirrorRays::MirrorRays(const scene::WorldGeometry& world)
    : world_(world),
      least_(kLeastSegment * world.bounds.radius()),
      bvh_(makeHierarchy(world, worldTriangles_)) {}

bool MirrorRays::reflect(ReflectedRay& ray, std::uint32_t& triangle) const {
  const auto hit = bvh_.findNearest(ray.origin, ray.direction, least_, triangle);
  if (!hit) return false;
  triangle = hit->triangle;
  const std::uint32_t t = worldTriangles_[triangle];
  const std::uint32_t* corner = &world_.indices[3 * std::size_t(t)];
  dvec3 normal = (1.0 - hit->u - hit->v) * dvec3(world_.normals[corner[0]]) +
                 hit->u * dvec3(world_.normals[corner[1]]) + hit->v * dvec3(world_.normals[corner[2]]);
  const double length = glm::length(normal);
  if (!(length > 0)) return false;
  normal /= length;
  ray.origin += hit->distance * ray.direction;
  (ray.trace.empty() ? ray.distance : ray.between) += hit->distance;
  ray.direction = glm::normalize(core::reflectDirection(ray.direction, normal));
  ray.trace.push_back(world_.parts[world_.triangleParts[t]].reflector);
  return true;
}

}  // namespace catoptric::reflection_morphing

// SPDX-License-Identifier: Apache-2.0
#include "catoptric/reflection_morphing/mirror_rays.h"

#include <limits>

#include "catoptric/scene/hierarchy_triangles.h"
#include "catoptric/scene/shading.h"

namespace catoptric::reflection_morphing {
namespace {

constexpr double kLeastSegment = 1e-7;  // of the scene's radius

std::vector<geometry::HierarchyTriangle> listTriangles(const scene::WorldGeometry& world, bool ofReflectors) {
  std::vector<std::uint32_t> flags;
  flags.reserve(world.parts.size());
  for (const scene::Part& part : world.parts) {
    const bool isReflector = part.reflector != core::kNoId;
    const bool isTwoSided = !isReflector || world.reflectors[part.reflector].doubleSided ||
                            world.reflectors[part.reflector].isRefractor();
    flags.push_back(isReflector != ofReflectors ? scene::kLeftOut : isTwoSided ? geometry::kTwoSided : 0u);
  }
  return scene::listTriangles(world, flags);
}

}  // namespace

MirrorRays::MirrorRays(const scene::WorldGeometry& world, bool withObstacles)
    : world_(world),
      least_(kLeastSegment * world.bounds.radius()),
      hierarchy_(listTriangles(world, true)),
      obstacles_(withObstacles ? listTriangles(world, false) : std::vector<geometry::HierarchyTriangle>()) {}

double MirrorRays::findObstacle(const ReflectedRay& ray) const {
  const auto hit = geometry::findNearestHit(obstacles_, ray.origin, ray.direction, least_, core::kNoId);
  return hit ? hit->distance : std::numeric_limits<double>::infinity();
}

bool MirrorRays::passOn(ReflectedRay& ray, std::uint32_t& triangle) const {
  const auto hit = geometry::findNearestHit(hierarchy_, ray.origin, ray.direction, least_, triangle);
  if (!hit) return false;
  triangle = hit->triangle;
  const std::uint32_t* corner = &world_.indices[3 * std::size_t(triangle)];
  dvec3 normal = (1.0 - hit->u - hit->v) * dvec3(world_.normals[corner[0]]) +
                 hit->u * dvec3(world_.normals[corner[1]]) + hit->v * dvec3(world_.normals[corner[2]]);
  const double length = glm::length(normal);
  if (!(length > 0)) return false;
  normal /= length;
  const std::uint32_t index = world_.parts[world_.triangleParts[triangle]].reflector;
  const scene::Reflector& reflector = world_.reflectors[index];
  ray.origin += hit->distance * ray.direction;
  (ray.trace.empty() ? ray.distance : ray.between) += hit->distance;
  ray.trace.push_back(index);
  if (!reflector.isRefractor()) {
    ray.direction = glm::normalize(core::reflectDirection(ray.direction, normal));
    ++ray.mirrors;
    return true;
  }
  const double eta = double(scene::glsl::relativeIndex(reflector.ior, hit->isFront));
  const dvec3 refracted = glm::refract(ray.direction, hit->isFront ? normal : -normal, eta);
  ++ray.crossings;
  ray.isTotal = refracted == dvec3(0);
  if (ray.isTotal) return true;
  ray.direction = glm::normalize(refracted);
  ray.medium = hit->isFront ? index : core::kNoId;
  return true;
}

}  // namespace catoptric::reflection_morphing

// SPDX-License-Identifier: Apache-2.0
// Small worlds of mirrors for the tests of reflection morphing.
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "catoptric/geometry/shapes.h"
#include "catoptric/reflection_morphing/location_source.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::reflection_morphing::test {

/// Each mesh is a mirror of its own; the bounds are [-3, 3]^3.
inline scene::WorldGeometry makeMirrorWorld(const std::vector<geometry::Mesh>& mirrors) {
  scene::WorldGeometry world;
  for (const geometry::Mesh& mesh : mirrors) {
    scene::Part part;
    part.firstIndex = std::uint32_t(world.indices.size());
    part.indexCount = std::uint32_t(mesh.indices.size());
    part.firstVertex = std::uint32_t(world.positions.size());
    part.vertexCount = std::uint32_t(mesh.positions.size());
    part.reflector = std::uint32_t(world.reflectors.size());
    for (const std::uint32_t i : mesh.indices) world.indices.push_back(part.firstVertex + i);
    world.positions.insert(world.positions.end(), mesh.positions.begin(), mesh.positions.end());
    world.normals.insert(world.normals.end(), mesh.normals.begin(), mesh.normals.end());
    world.triangleParts.resize(world.indices.size() / 3, std::uint32_t(world.parts.size()));
    scene::Reflector reflector;
    core::Box box;
    for (const vec3& p : mesh.positions) box.add(dvec3(p));
    reflector.centre = box.centre();
    for (const vec3& p : mesh.positions)
      reflector.radius = std::max(reflector.radius, glm::length(dvec3(p) - reflector.centre));
    reflector.part = std::uint32_t(world.parts.size());
    world.reflectors.push_back(reflector);
    world.parts.push_back(part);
  }
  world.bounds = {dvec3(-3), dvec3(3)};
  return world;
}

inline geometry::Mesh makeSphereAt(const dvec3& centre, double radius, int frequency = 24) {
  return geometry::transformed(geometry::makeIcosphere(radius, frequency), geometry::moveBy(centre));
}

/// A sphere of 0.5 m at the origin.
inline scene::WorldGeometry makeSphereWorld() {
  return makeMirrorWorld({makeSphereAt(dvec3(0), 0.5)});
}

/// Two spheres that see each other.
inline scene::WorldGeometry makeTwoSpheres() {
  return makeMirrorWorld({makeSphereAt({-0.6, 0, 0}, 0.5), makeSphereAt({0.6, 0, 0.2}, 0.5)});
}

inline BakeOptions makeOptions(const scene::WorldGeometry& world, int rays = 256, int depth = 5,
                               int bounces = 1) {
  BakeOptions options;
  options.map = {rays, bounces};
  options.octree.box = makeLookUpBox(world);
  options.octree.depth = depth;
  return options;
}

inline std::shared_ptr<const SamplingLocation> makeLocation(const MirrorRays& rays, const dvec3& position,
                                                            const BakeOptions& options) {
  return unpackLocation(bakeLocation(rays, position, options), options.octree.box);
}

/// A scene point and where it is seen, known because the point was taken from the ray.
struct KnownPoint {
  dvec3 mirrorPoint, scenePoint;
  double pathLength;
};

/// Points that are seen from `eye` by way of `trace`, at random on random rays, 0.02 to 2.5 m behind the last
/// mirror.
inline std::vector<KnownPoint> makeKnownPoints(const MirrorRays& rays, const dvec3& eye, const Trace& trace,
                                               std::size_t count, unsigned seed) {
  std::vector<KnownPoint> points;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const scene::Reflector& first = rays.world().reflectors[trace.front()];
  for (int tries = 0; points.size() < count && tries < 1000000; ++tries) {
    const dvec3 offset(uniform(random), uniform(random), uniform(random));
    const dvec3 d = glm::normalize(first.centre + first.radius * offset - eye);
    const double t = 0.02 * std::pow(125.0, 0.5 + 0.5 * uniform(random));
    rays.follow(eye, d, int(trace.size()), trace.size(), [&](const ReflectedRay& ray) {
      if (ray.trace == trace)
        points.push_back(
            {eye + ray.distance * d, ray.origin + t * ray.direction, ray.distance + ray.between + t});
    });
  }
  return points;
}

/// Angle between two points seen from the eye, in pixels of a picture in which `mirror` is 700 px wide.
inline double measurePixels(const dvec3& eye, const dvec3& a, const dvec3& b,
                            const scene::Reflector& mirror) {
  const double angle = std::asin(std::min(1.0, mirror.radius / glm::length(mirror.centre - eye)));
  return glm::length(glm::cross(glm::normalize(a - eye), glm::normalize(b - eye))) / (2 * angle) * 700;
}

}  // namespace catoptric::reflection_morphing::test

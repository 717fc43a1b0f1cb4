// SPDX-License-Identifier: Apache-2.0
// Small scenes put together by hand, for the tests of the ray tracer.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "catoptric/reference/ray_tracer.h"

namespace catoptric::reference {

inline constexpr double kPi = 3.14159265358979323846;

/// Rectangle spanned by two edges from a corner, facing cross(u, v); texture coordinates 0..repeat, v
/// downwards.
inline scene::MeshPrimitive makeQuad(const vec3& corner, const vec3& u, const vec3& v, float repeat = 1) {
  scene::MeshPrimitive mesh;
  const vec3 n = glm::normalize(glm::cross(u, v));
  for (const vec2 c : {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1)}) {
    mesh.positions.push_back(corner + c.x * u + c.y * v);
    mesh.normals.push_back(n);
    mesh.uv[0].push_back(repeat * vec2(c.x, 1 - c.y));
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

/// Unit sphere at the origin.
inline scene::MeshPrimitive makeBall(int slices, int stacks) {
  scene::MeshPrimitive mesh;
  for (int j = 0; j <= stacks; ++j)
    for (int i = 0; i <= slices; ++i) {
      const double theta = kPi * j / stacks, phi = 2 * kPi * i / slices;
      const dvec3 n(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi));
      mesh.positions.push_back(vec3(n));
      mesh.normals.push_back(vec3(n));
      mesh.uv[0].push_back(vec2(float(i) / float(slices), float(j) / float(stacks)));
    }
  const auto at = [&](int i, int j) { return std::uint32_t(j * (slices + 1) + i); };
  for (int j = 0; j < stacks; ++j)
    for (int i = 0; i < slices; ++i) {
      if (j > 0) mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i + 1, j + 1), at(i + 1, j)});
      if (j < stacks - 1) mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  return mesh;
}

inline scene::Material makeMirror(const vec3& tint = vec3(1)) {
  scene::Material material;
  material.name = "mirror";
  material.baseColor = vec4(tint, 1);
  material.roughness = 0;
  return material;
}

inline scene::Material makeUnlit(const vec3& color) {
  scene::Material material;
  material.baseColor = vec4(color, 1);
  material.unlit = true;
  return material;
}

/// Checkerboard of two bytes, `cells` x `cells` cells of `texels` texels.
inline scene::Texture makeChecker(int cells, int texels, int dark = 0, int bright = 255) {
  scene::Texture texture;
  texture.image = core::ImageRgba8(cells * texels, cells * texels);
  for (int y = 0; y < cells * texels; ++y)
    for (int x = 0; x < cells * texels; ++x) {
      const auto value = std::uint8_t((x / texels + y / texels) % 2 == 0 ? dark : bright);
      texture.image.at(x, y) = {value, value, value, 255};
    }
  return texture;
}

inline scene::Environment makeUniformSky(const vec3& radiance) {
  scene::Environment environment;
  environment.radiance = {core::ImageRgbF(2, 1, radiance), core::ImageRgbF(1, 1, radiance)};
  environment.prefiltered.assign(scene::kPrefilteredLevels, core::ImageRgbF(2, 1, radiance));
  environment.irradiance[0] = radiance / 0.282095f;
  return environment;
}

/// A scene, its geometry and its tracer, rebuilt by finish().
struct TracedTestScene {
  scene::Scene scene;
  scene::WorldGeometry world;
  scene::Environment environment = makeUniformSky(vec3(0.25f, 0.5f, 1.0f));
  scene::Camera camera;
  std::unique_ptr<RayTracer> tracer;

  int add(scene::MeshPrimitive mesh, const scene::Material& material, const std::string& name = "thing",
          const dmat4& worldFromMesh = dmat4(1.0)) {
    mesh.material = int(scene.materials.size());
    scene.materials.push_back(material);
    scene.meshes.push_back({name, {std::move(mesh)}});
    scene.instances.push_back({name, int(scene.meshes.size()) - 1, worldFromMesh, {}});
    return int(scene.instances.size()) - 1;
  }
  void finish(const scene::ReflectorOptions& options = {}) {
    scene.materials.emplace_back();
    world = scene::makeWorldGeometry(scene, options);
    tracer = std::make_unique<RayTracer>(scene, world, environment);
  }
  [[nodiscard]] scene::CameraFrame frame(int width, int height) const {
    return scene::makeCameraFrame(camera, width, height);
  }
  [[nodiscard]] TraceResult trace(int width, int height, const TraceOptions& options = {}) const {
    return tracer->trace(frame(width, height), options);
  }
};

inline void expectColor(const vec4& actual, const vec3& expected, float tolerance = 1e-6f) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(actual[i], expected[i], tolerance) << "channel " << i;
  EXPECT_EQ(actual.a, 1);
}

/// A quad of 2 x 2 around the origin facing +z.
inline scene::MeshPrimitive makeFacingQuad(float z = 0, float repeat = 1) {
  return makeQuad({-1, -1, z}, {2, 0, 0}, {0, 2, 0}, repeat);
}

/// Looks along -z from z = 3 at the origin; the picture's centre pixel looks straight on.
inline void lookAtOrigin(TracedTestScene& t) {
  t.camera.eye = {0, 0, 3};
  t.camera.target = {0, 0, 0};
}

inline vec4 centreOf(const TraceResult& result) {
  return result.radiance.at(result.radiance.width() / 2, result.radiance.height() / 2);
}
inline core::SeenPixel centreSeen(const TraceResult& result) {
  return result.seen.at(result.seen.width() / 2, result.seen.height() / 2);
}

}  // namespace catoptric::reference

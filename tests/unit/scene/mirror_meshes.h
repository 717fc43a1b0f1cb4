// SPDX-License-Identifier: Apache-2.0
// Meshes as exporters write them, and what must hold for every WorldGeometry; for the tests of reflector
// finding.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

#include "catoptric/scene/world_geometry.h"

namespace catoptric::scene {

inline constexpr double kPi = 3.14159265358979323846;

/// Latitude-longitude sphere with a texture seam, as exporters write it; `inside` turns it over.
inline MeshPrimitive makeSphere(int slices, int stacks, bool inside = false, double fromV = 0,
                                double toV = 1) {
  MeshPrimitive mesh;
  for (int j = 0; j <= stacks; ++j)
    for (int i = 0; i <= slices; ++i) {
      const double theta = kPi * (fromV + (toV - fromV) * j / stacks), phi = 2 * kPi * i / slices;
      const dvec3 n(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi));
      mesh.positions.push_back(vec3(n));
      mesh.normals.push_back(vec3(inside ? -n : n));
      mesh.uv[0].push_back(vec2(float(i) / float(slices), float(j) / float(stacks)));
    }
  const auto at = [&](int i, int j) { return std::uint32_t(j * (slices + 1) + i); };
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (inside) std::swap(b, c);
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
  };
  for (int j = 0; j < stacks; ++j)
    for (int i = 0; i < slices; ++i) {
      if (j > 0 || fromV > 0) add(at(i, j), at(i + 1, j + 1), at(i + 1, j));
      if (j < stacks - 1 || toV < 1) add(at(i, j), at(i, j + 1), at(i + 1, j + 1));
    }
  return mesh;
}

/// Open cylinder (topRadius = 1) or cone frustum about y with exact normals.
inline MeshPrimitive makeFrustum(int slices, double topRadius) {
  MeshPrimitive mesh;
  const double slope = 1 - topRadius;  // height 1
  for (int i = 0; i <= slices; ++i)
    for (int j = 0; j < 2; ++j) {
      const double phi = 2 * kPi * i / slices, r = j == 0 ? 1 : topRadius;
      mesh.positions.push_back(vec3(dvec3(r * std::cos(phi), j, -r * std::sin(phi))));
      mesh.normals.push_back(vec3(glm::normalize(dvec3(std::cos(phi), slope, -std::sin(phi)))));
    }
  for (std::uint32_t i = 0; i < std::uint32_t(slices); ++i) {
    const std::uint32_t a = 2 * i;
    mesh.indices.insert(mesh.indices.end(), {a, a + 2, a + 3, a, a + 3, a + 1});
  }
  return mesh;
}

/// Cube from -1 to 1 with four vertices of its own on each face.
inline MeshPrimitive makeCube() {
  MeshPrimitive mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = -1; side <= 1; side += 2) {
      vec3 n(0), u(0), v(0);
      n[axis] = float(side);
      u[(axis + 1) % 3] = 1;
      v[(axis + 2) % 3] = float(side);
      const auto first = std::uint32_t(mesh.positions.size());
      for (const vec2 c : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)}) {
        mesh.positions.push_back(n + c.x * u + c.y * v);
        mesh.normals.push_back(n);
      }
      mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
    }
  return mesh;
}

/// Square in z = 0 facing +z, every triangle with three vertices of its own.
inline MeshPrimitive makeFlatShadedQuad() {
  MeshPrimitive mesh;
  for (const vec2 c : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, -1), vec2(1, 1), vec2(-1, 1)}) {
    mesh.indices.push_back(std::uint32_t(mesh.positions.size()));
    mesh.positions.push_back(vec3(c, 0));
    mesh.normals.push_back(vec3(0, 0, 1));
  }
  return mesh;
}

inline Material makeMirrorMaterial() {
  Material material;
  material.name = "chrome";
  material.roughness = 0;
  return material;
}

inline Scene makeScene(MeshPrimitive primitive, const Material& material = makeMirrorMaterial(),
                       const dmat4& worldFromMesh = dmat4(1.0)) {
  Scene scene;
  primitive.material = 0;
  scene.materials = {material, Material{}};
  scene.meshes.push_back({"mesh", {std::move(primitive)}});
  scene.instances.push_back({"thing", 0, worldFromMesh, {}});
  return scene;
}

inline dvec3 faceNormal(const WorldGeometry& world, std::size_t triangle) {
  const dvec3 a(world.positions[world.indices[3 * triangle]]),
      b(world.positions[world.indices[3 * triangle + 1]]),
      c(world.positions[world.indices[3 * triangle + 2]]);
  return glm::normalize(glm::cross(b - a, c - a));
}

inline void expectConsistent(const WorldGeometry& world) {
  const std::size_t vertices = world.positions.size();
  EXPECT_EQ(world.normals.size(), vertices);
  EXPECT_EQ(world.tangents.size(), vertices);
  EXPECT_EQ(world.uv0.size(), vertices);
  EXPECT_EQ(world.uv1.size(), vertices);
  EXPECT_EQ(world.colors.size(), vertices);
  EXPECT_EQ(world.triangleParts.size(), world.triangleCount());
  std::size_t nextIndex = 0, nextVertex = 0;
  for (std::uint32_t p = 0; p < world.parts.size(); ++p) {
    const Part& part = world.parts[p];
    EXPECT_EQ(part.firstIndex, nextIndex);
    EXPECT_EQ(part.firstVertex, nextVertex);
    nextIndex += part.indexCount;
    nextVertex += part.vertexCount;
    std::set<std::uint32_t> used;
    for (std::uint32_t i = part.firstIndex; i < part.firstIndex + part.indexCount; ++i) {
      used.insert(world.indices[i]);
      EXPECT_EQ(world.triangleParts[i / 3], p);
    }
    EXPECT_EQ(used.size(), part.vertexCount);
    EXPECT_EQ(*used.begin(), part.firstVertex);
    if (part.reflector != core::kNoId) {
      EXPECT_EQ(world.reflectors[part.reflector].part, p);
    }
  }
  EXPECT_EQ(nextIndex, world.indices.size());
  EXPECT_EQ(nextVertex, vertices);
  for (std::size_t v = 0; v < vertices; ++v) EXPECT_NEAR(glm::length(world.normals[v]), 1, 1e-5);
}

}  // namespace catoptric::scene

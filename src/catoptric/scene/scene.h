// SPDX-License-Identifier: Apache-2.0
// A scene as imported: textures, materials, meshes shared by instances, lights, cameras. Units are metres, y
// is up, frames are right-handed, as in glTF 2.0. What renderers draw is made from it by makeWorldGeometry().
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/scene/material.h"
#include "catoptric/scene/motion.h"

namespace catoptric::scene {

/// Triangles with one material. Attribute arrays are as long as `positions` or empty; `normals` are never
/// empty after import. uv sets and colours are optional. Validated: indices in range, every number finite.
struct MeshPrimitive {
  std::vector<vec3> positions;
  std::vector<vec3> normals;   ///< unit
  std::vector<vec4> tangents;  ///< unit xyz, w = handedness; empty if absent
  std::vector<vec2> uv[2];
  std::vector<vec4> colors;                  ///< linear RGBA, multiplies the base colour
  std::vector<std::uint32_t> indices;        ///< three per triangle, counter-clockwise seen from the front
  int material = -1;                         ///< index into Scene::materials
  std::optional<Deformation> deformation{};  ///< only where an animation may deform it
};

struct Mesh {
  std::string name;
  std::vector<MeshPrimitive> primitives;
  int node = -1;  ///< of Motion: whose weights drive its morph targets
  int skin = -1;  ///< of Motion; the vertices of a skinned mesh stand in the world
};

/// A mesh placed in the world; one per node that has a mesh.
struct Instance {
  std::string name;
  int mesh = -1;
  dmat4 worldFromMesh{1.0};
  ReflectorHint hint;
  int node = -1;  ///< of Motion, which carries it: worldFromMesh = worldFromNode nodeFromMesh
  dmat4 nodeFromMesh{1.0};
};

enum class LightType : std::uint8_t { Directional, Point, Spot };

/// KHR_lights_punctual; lights cast no shadows.
struct Light {
  LightType type = LightType::Point;
  vec3 color{1.0f};  ///< linear colour times intensity (candela; lux for a directional light)
  vec3 position{0.0f};
  vec3 direction{0, 0, -1};  ///< unit, the way the light travels
  float range = 0.0f;        ///< 0 = unlimited
  float innerConeRadians = 0.0f, outerConeRadians = 0.7853982f;
  int node = -1;  ///< of Motion
};

/// Perspective camera. An orthographic glTF camera is imported as a distant perspective one, with a warning.
struct Camera {
  std::string name;
  dvec3 eye{0, 0, 0};
  dvec3 target{0, 0, -1};
  dvec3 up{0, 1, 0};
  double fovYRadians = 0.9;
  int node = -1;  ///< of Motion
};

struct Scene {
  std::string name;
  std::vector<Texture> textures;
  std::vector<Material> materials;  ///< never empty: the last one is glTF's default material
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  Motion motion;                      ///< empty unless the file has animations
  std::vector<std::string> warnings;  ///< repairs and ignored optional features, one line each
};

/// A camera that sees the whole scene from slightly above, for scenes without one.
[[nodiscard]] Camera makeFrameAllCamera(const core::Box& bounds, double azimuthRadians = 0.6,
                                        double elevationRadians = 0.35, double fovYRadians = 0.7);

}  // namespace catoptric::scene

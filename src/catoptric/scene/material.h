// SPDX-License-Identifier: Apache-2.0
// Metallic-roughness materials with textures, as in glTF 2.0; colours are linear unless said otherwise.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "catoptric/core/image.h"

namespace catoptric::scene {

enum class Wrap : std::uint8_t { Repeat, MirroredRepeat, ClampToEdge };

/// A decoded texture image and its sampler.
struct Texture {
  std::string name;
  core::ImageRgba8 image;  ///< As stored in the file; row 0 on top, texture coordinate v = 0 at the top edge.
  Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
  bool magnifyNearest = false;
  bool minifyNearest = false;  ///< Nearest texel within a level.
  bool useMipmaps = true;
};

/// Reference from a material to a texture; `texture` is an index into Scene::textures, -1 for none.
struct TextureSlot {
  int texture = -1;
  int uvSet = 0;          ///< 0 or 1.
  mat3 uvFromMesh{1.0f};  ///< KHR_texture_transform.
};

enum class AlphaMode : std::uint8_t { Opaque, Mask, Blend };

/// What `extras.catoptric` of a node or material says; absent members are not overridden.
struct ReflectorHint {
  std::optional<bool> reflector;
  std::optional<std::string> shape;   ///< "plane", "sphere", "cylinder", "cone", "mesh"
  std::optional<float> reflectivity;  ///< 0..1, multiplies the mirror lobe; the rest shows the base.
  std::optional<bool> morphed;        ///< by reflection morphing: true always, false never (environment map)
  std::optional<bool> shell;          ///< Node: belongs to the shell of the room (metrics).
};

struct Material {
  std::string name;
  vec4 baseColor{1.0f};
  TextureSlot baseColorTexture;  ///< sRGB
  float metallic = 1.0f;         ///< glTF's defaults: metallic 1, roughness 1 is no mirror.
  float roughness = 1.0f;
  TextureSlot metallicRoughnessTexture;  ///< linear; G roughness, B metallic
  TextureSlot normalTexture;             ///< linear
  float normalScale = 1.0f;
  TextureSlot occlusionTexture;  ///< linear; R
  float occlusionStrength = 1.0f;
  vec3 emissive{0.0f};          ///< Emissive factor times KHR_materials_emissive_strength.
  TextureSlot emissiveTexture;  ///< sRGB
  AlphaMode alphaMode = AlphaMode::Opaque;
  float alphaCutoff = 0.5f;
  bool doubleSided = false;
  bool unlit = false;     ///< KHR_materials_unlit
  float ior = 1.5f;       ///< KHR_materials_ior; 0 means Fresnel 1.
  float specular = 1.0f;  ///< KHR_materials_specular factor
  vec3 specularColor{1.0f};
  float clearcoat = 0.0f;  ///< KHR_materials_clearcoat
  float clearcoatRoughness = 0.0f;
  float transmission = 0.0f;  ///< KHR_materials_transmission
  float thickness = 0.0f;  ///< KHR_materials_volume; 0 = a thin wall, anything else: the mesh bounds a solid
  vec3 attenuationColor{1.0f};       ///< KHR_materials_volume: what is left of white light after ...
  float attenuationDistance = 0.0f;  ///< ... this way through the solid, world units; 0 = endless
  ReflectorHint hint;

  /// Does light go on behind its surface, inside a solid, bent by Snell's law?
  [[nodiscard]] bool isRefractive() const {
    return transmission > 0.0f && thickness > 0.0f && ior >= 1.0f && !unlit;
  }
  /// Is there a surface for rays that come from behind? The solid's own light leaves through there.
  [[nodiscard]] bool isSeenFromBehind() const { return doubleSided || isRefractive(); }
};

}  // namespace catoptric::scene

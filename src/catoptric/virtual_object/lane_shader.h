// SPDX-License-Identifier: Apache-2.0
// virtual_shade.frag for eight pixels side by side: the functions are the shaders' own, what they read from
// GL is here. Used by shade_bands.cpp alone.
#pragma once

#include <array>
#include <cstdint>

#include "catoptric/raster/scene_buffers.h"

namespace catoptric::virtual_object {

struct LaneShader {
  // Types and uniforms of shaders/raster/*.glsl. What decides a branch is one value, not eight.
  using vec2 = core::lanes::Vec2;
  using vec3 = core::lanes::Vec3;
  using vec4 = core::lanes::Vec4;
  using uint = std::uint32_t;
  using sampler2D = const raster::LaneTexture*;
  struct alignas(core::lanes::kAlignment) Corners {
    core::EightInts x, y, z, w;
  };
  using uvec4 = Corners;
  vec4 m_baseColor, m_emissive, m_factors;
  catoptric::vec4 m_more, u_lobes;
  std::array<catoptric::vec4, 10> m_uvRows;
  vec3 u_irradiance[9];
  sampler2D u_baseColor, u_metallicRoughness, u_normalMap, u_occlusion, u_emissive;
  /// The same object in its two roles.
  const raster::LaneEnvironment* u_environment;
  struct Layers {
    const raster::LaneEnvironment* of;
  } u_prefiltered;
  const raster::LaneLatLong* blurred;  ///< for the material's roughness; null: textures say what that is
  float u_environmentMaxLod, u_prefilteredLast;
  uint u_objectWord, u_reflectorWord;
  const catoptric::vec4* u_vertices;

  unsigned textures;  ///< bit k: the material has its k-th
  bool isColored, isTwiceMapped, isLastMirror;

  [[nodiscard]] bool hasTexture(int slot) const { return ((textures >> unsigned(slot)) & 1u) != 0; }
  [[nodiscard]] bool hasColors() const { return isColored; }
  [[nodiscard]] bool hasSecondUv() const { return isTwiceMapped; }
  [[nodiscard]] bool showsEnvironment() const { return isLastMirror; }
  CATOPTRIC_INLINE vec4 uvRow(int i) const { return m_uvRows[std::size_t(i)]; }

  CATOPTRIC_INLINE static ivec2 textureSize(sampler2D map, int) { return map->size(); }
  CATOPTRIC_INLINE static ivec2 textureSize(const raster::LaneEnvironment* map, int) { return map->size(); }
  CATOPTRIC_INLINE static vec4 textureLod(sampler2D map, const vec2& uv, core::lanes::Float level) {
    return map->sample(uv, level);
  }
  CATOPTRIC_INLINE static vec3 textureLod(const raster::LaneEnvironment* map, const vec2& uv,
                                          core::lanes::Float level) {
    return map->sampleLevel(uv, level);
  }
  CATOPTRIC_INLINE static vec3 textureLod(Layers map, const vec3& uvLayer, core::lanes::Float) {
    return map.of->sampleLayer(vec2(uvLayer), uvLayer.z);
  }
  [[nodiscard]] bool hasBlurred() const { return blurred != nullptr; }
  CATOPTRIC_INLINE vec3 readBlurred(const vec2& uv) const {
    return raster::LaneEnvironment::sampleBlurred(*blurred, uv);
  }
  CATOPTRIC_INLINE vec4 readVertex(const core::EightInts& vertex, int texel) const {
    const catoptric::vec4* rows[core::kLanes];
    for (int i = 0; i < core::kLanes; ++i)
      rows[i] = u_vertices + (std::size_t(vertex[i]) * 5 + std::size_t(texel));
    return core::lanes::loadRows(rows);
  }

#define CATOPTRIC_LANES
#define CATOPTRIC_FN CATOPTRIC_INLINE
#define float core::lanes::Float
#define bool core::lanes::Mask
// clang-format off
#include "lib/environment.glsl"
#include "lib/refraction.glsl"
#include "lib/ray_triangle.glsl"
#include "lib/texture_lod.glsl"
#include "raster/environment_lookup.glsl"
#include "raster/level_pixels.glsl"
#include "raster/material.glsl"
#include "raster/surface_shading.glsl"
#include "virtual_object/exact_point.glsl"
#include "virtual_object/near_hit.glsl"
// clang-format on
#undef float
#undef bool
#undef CATOPTRIC_FN
#undef CATOPTRIC_LANES

  std::array<PunctualLight, raster::kMaxLights> lights;
  int lightCount = 0;

  CATOPTRIC_INLINE vec3 shadeLights(const Surface& s) {
    vec3 sum(0.0f);
    for (int i = 0; i < lightCount; ++i) sum += shadeLight(lights[std::size_t(i)], s);
    return sum;
  }
};

}  // namespace catoptric::virtual_object

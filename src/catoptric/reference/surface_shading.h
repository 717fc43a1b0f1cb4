// SPDX-License-Identifier: Apache-2.0
// From a hit to light: interpolated attributes with their derivatives per pixel, textures, the shared shading
// functions (scene/shading.h). The rules are those of shaders/raster/surface.frag, in the same order.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "catoptric/reference/ray_differential.h"
#include "catoptric/reference/texture_sampling.h"
#include "catoptric/scene/scene.h"
#include "catoptric/scene/shading.h"
#include "catoptric/scene/world_geometry.h"

namespace catoptric::reference {

/// Not initialised by itself; direction is unit.
struct Ray {
  dvec3 origin, direction;
  RayDifferential differential;
};

/// A point of a triangle met by a ray; computeHit() sets every member.
struct Hit {
  std::uint32_t triangle, part;
  std::array<std::uint32_t, 3> vertices;
  bool isFront;
  double t;
  dvec3 position;
  dvec3 geometricNormal;  ///< by winding, not unit
  dvec2 barycentric;      ///< weights of the second and third vertex
  PerPixel<dvec3> positionChange;
  PerPixel<dvec2> barycentricChange;
};

/// What leaves a surface towards the viewer.
struct Shaded {
  vec3 radiance{0};      ///< without the mirror lobe
  vec3 mirrorWeight{0};  ///< of the mirrored radiance
  float alpha = 1;
};

/// Shading normal on the viewer's side; computeNormal() sets every member.
struct ShadingNormal {
  dvec3 normal;
  dvec3 mirror;            ///< what rays are mirrored at: a clear coat's has no normal map
  PerPixel<dvec3> change;  ///< of the interpolated normal; a normal map's own change is left out
};

class SurfaceShader {
 public:
  SurfaceShader(const scene::Scene& scene, const scene::WorldGeometry& geometry,
                const scene::Environment& environment);

  /// Distance, point and derivatives of a hit in double precision; `barycentricHint` is used where the
  /// triangle is seen too exactly from its edge.
  [[nodiscard]] Hit computeHit(const Ray& ray, std::uint32_t triangle, const dvec2& barycentricHint) const;
  [[nodiscard]] ShadingNormal computeNormal(const Hit& hit) const;
  [[nodiscard]] Shaded shade(const Ray& ray, const Hit& hit, const ShadingNormal& normal) const;
  /// Is there an opaque texel of an alpha-masked material?
  [[nodiscard]] bool passesAlphaMask(const Hit& hit) const;

  [[nodiscard]] const scene::Material& materialOf(const scene::Part& part) const {
    return *materials_[std::size_t(part.material < 0 ? int(materials_.size()) - 1 : part.material)].source;
  }

 private:
  struct Slot {
    const SampledTexture* texture = nullptr;
    int uvSet = 0;
    mat3 uvFromMesh{1.0f};
  };
  struct ShadingMaterial {
    const scene::Material* source = nullptr;
    Slot baseColor, metallicRoughness, normal, occlusion, emissive;
    float f0Dielectric = 0.04f;
  };
  struct SlotUv {
    vec2 uv;
    PerPixel<vec2> change;
  };

  [[nodiscard]] Slot makeSlot(const scene::TextureSlot& slot, bool srgb);
  [[nodiscard]] const ShadingMaterial& material(const Hit& hit) const;
  [[nodiscard]] SlotUv computeUv(const Slot& slot, const Hit& hit) const;
  [[nodiscard]] vec4 sample(const Slot& slot, const Hit& hit) const;
  [[nodiscard]] vec4 baseColor(const ShadingMaterial& material, const Hit& hit) const;
  [[nodiscard]] dvec3 perturbNormal(const ShadingMaterial& material, const Hit& hit,
                                    const dvec3& normal) const;

  const scene::Scene& scene_;
  const scene::WorldGeometry& geometry_;
  const scene::Environment& environment_;
  scene::Material defaultMaterial_;
  std::vector<ShadingMaterial> materials_;  // the scene's and, last, the default one
  std::array<std::vector<std::unique_ptr<SampledTexture>>, 2> textures_;  // as data, as colour
  std::vector<std::uint8_t> hasColors_;  // of each part: any vertex colour but white
  std::vector<scene::glsl::PunctualLight> lights_;
};

}  // namespace catoptric::reference

// SPDX-License-Identifier: Apache-2.0
#include "catoptric/reference/surface_shading.h"

#include <algorithm>
#include <cmath>

namespace catoptric::reference {
namespace {

template <class T>
T interpolate(const std::vector<T>& values, const Hit& hit, const vec3& weights) {
  return values[hit.vertices[0]] * weights.x + values[hit.vertices[1]] * weights.y +
         values[hit.vertices[2]] * weights.z;
}

vec3 weightsOf(const Hit& hit) {
  const vec2 b(hit.barycentric);
  return {1.0f - b.x - b.y, b.x, b.y};
}

scene::glsl::PunctualLight makeLight(const scene::Light& light) {
  scene::glsl::PunctualLight result;
  result.color = light.color;
  result.position = light.position;
  result.direction = light.direction;
  result.range = light.range;
  result.cosInner = std::cos(light.innerConeRadians);
  result.cosOuter = std::cos(light.outerConeRadians);
  result.kind = light.type == scene::LightType::Directional ? 0
                : light.type == scene::LightType::Point     ? 1
                                                            : 2;
  return result;
}

float dielectricF0(const scene::Material& material) {
  if (material.ior == 0.0f) return 1.0f;  // KHR_materials_ior: Fresnel 1
  const float r = (material.ior - 1.0f) / (material.ior + 1.0f);
  return r * r * material.specular;
}

}  // namespace

SurfaceShader::SurfaceShader(const scene::Scene& scene, const scene::WorldGeometry& geometry,
                             const scene::Environment& environment)
    : scene_(scene), geometry_(geometry), environment_(environment) {
  for (auto& textures : textures_) textures.resize(scene.textures.size());
  const auto add = [&](const scene::Material& source) {
    ShadingMaterial material;
    material.source = &source;
    material.baseColor = makeSlot(source.baseColorTexture, true);
    material.metallicRoughness = makeSlot(source.metallicRoughnessTexture, false);
    material.normal = makeSlot(source.normalTexture, false);
    material.occlusion = makeSlot(source.occlusionTexture, false);
    material.emissive = makeSlot(source.emissiveTexture, true);
    material.f0Dielectric = dielectricF0(source);
    materials_.push_back(material);
  };
  for (const scene::Material& source : scene.materials) add(source);
  add(defaultMaterial_);
  for (const scene::Part& part : geometry.parts) {
    const auto first = geometry.colors.begin() + part.firstVertex;
    hasColors_.push_back(
        std::any_of(first, first + part.vertexCount, [](const vec4& c) { return c != vec4(1); }));
  }
  for (const scene::Light& light : scene.lights) lights_.push_back(makeLight(light));
}

SurfaceShader::Slot SurfaceShader::makeSlot(const scene::TextureSlot& slot, bool srgb) {
  Slot result;
  result.uvSet = slot.uvSet;
  result.uvFromMesh = slot.uvFromMesh;
  if (slot.texture < 0 || std::size_t(slot.texture) >= scene_.textures.size()) return result;
  auto& texture = textures_[srgb ? 1 : 0][std::size_t(slot.texture)];
  if (!texture) texture = std::make_unique<SampledTexture>(scene_.textures[std::size_t(slot.texture)], srgb);
  if (!texture->isEmpty()) result.texture = texture.get();
  return result;
}

Hit SurfaceShader::computeHit(const Ray& ray, std::uint32_t triangle, const dvec2& barycentricHint) const {
  Hit hit;
  hit.triangle = triangle;
  hit.part = geometry_.triangleParts[triangle];
  for (int k = 0; k < 3; ++k) hit.vertices[k] = geometry_.indices[3 * std::size_t(triangle) + k];
  const dvec3 a(geometry_.positions[hit.vertices[0]]), b(geometry_.positions[hit.vertices[1]]),
      c(geometry_.positions[hit.vertices[2]]);
  const dvec3 e1 = b - a, e2 = c - a, n = glm::cross(e1, e2);
  hit.geometricNormal = n;
  const double square = glm::dot(n, n), inverseSquare = 1.0 / square;
  double across = glm::dot(ray.direction, n);
  hit.isFront = across < 0;
  // Gradients of the barycentric coordinates over the plane.
  const dvec3 gradientB = glm::cross(e2, n) * inverseSquare, gradientC = glm::cross(n, e1) * inverseSquare;
  if (across * across > 1e-20 * square) {
    hit.t = glm::dot(a - ray.origin, n) / across;
    hit.position = ray.origin + hit.t * ray.direction;
    hit.barycentric = {glm::dot(hit.position - a, gradientB), glm::dot(hit.position - a, gradientC)};
  } else {  // seen from its edge
    hit.barycentric = barycentricHint;
    hit.position = a + barycentricHint.x * e1 + barycentricHint.y * e2;
    hit.t = glm::dot(hit.position - ray.origin, ray.direction);
    across = std::copysign(1e-10 * std::sqrt(square), across);
  }
  const RayDifferential& d = ray.differential;
  const double inverseAcross = 1.0 / across;
  hit.positionChange.dx =
      transferToPlane(d.origin.dx, d.direction.dx, ray.direction, hit.t, n, inverseAcross);
  hit.positionChange.dy =
      transferToPlane(d.origin.dy, d.direction.dy, ray.direction, hit.t, n, inverseAcross);
  const auto toBarycentric = [&](const dvec3& change) {
    return dvec2(glm::dot(change, gradientB), glm::dot(change, gradientC));
  };
  hit.barycentricChange = {toBarycentric(hit.positionChange.dx), toBarycentric(hit.positionChange.dy)};
  return hit;
}

const SurfaceShader::ShadingMaterial& SurfaceShader::material(const Hit& hit) const {
  const int index = geometry_.parts[hit.part].material;
  return index < 0 ? materials_.back() : materials_[std::size_t(index)];
}

SurfaceShader::SlotUv SurfaceShader::computeUv(const Slot& slot, const Hit& hit) const {
  const auto& uv = slot.uvSet == 1 ? geometry_.uv1 : geometry_.uv0;
  const mat3& m = slot.uvFromMesh;
  const vec2 a = uv[hit.vertices[0]], toB = uv[hit.vertices[1]] - a, toC = uv[hit.vertices[2]] - a;
  const auto along = [&](const vec2& meshUv) { return vec2(m * vec3(meshUv, 0.0f)); };
  const auto change = [&](const dvec2& barycentric) {
    return along(toB * float(barycentric.x) + toC * float(barycentric.y));
  };
  SlotUv result;
  result.uv = vec2(m * vec3(interpolate(uv, hit, weightsOf(hit)), 1.0f));
  result.change = {change(hit.barycentricChange.dx), change(hit.barycentricChange.dy)};
  return result;
}

vec4 SurfaceShader::sample(const Slot& slot, const Hit& hit) const {
  const SlotUv at = computeUv(slot, hit);
  return slot.texture->sample(at.uv, at.change);
}

vec4 SurfaceShader::baseColor(const ShadingMaterial& material, const Hit& hit) const {
  vec4 base = material.source->baseColor;
  if (hasColors_[hit.part]) base *= interpolate(geometry_.colors, hit, weightsOf(hit));
  if (material.baseColor.texture != nullptr) base *= sample(material.baseColor, hit);
  return base;
}

bool SurfaceShader::passesAlphaMask(const Hit& hit) const {
  const ShadingMaterial& m = material(hit);
  return baseColor(m, hit).a >= m.source->alphaCutoff;
}

/// Normal map in the frame of the vertices' tangents or, where they have none, of the triangle's texture
/// coordinates.
dvec3 SurfaceShader::perturbNormal(const ShadingMaterial& m, const Hit& hit, const dvec3& n) const {
  const vec3 weights = weightsOf(hit);
  const vec4 vertexTangent = interpolate(geometry_.tangents, hit, weights);
  dvec3 t(vec3(vertexTangent.x, vertexTangent.y, vertexTangent.z));
  double handedness = double(vertexTangent.w);
  if (glm::dot(t, t) < 1e-12) {
    const auto& uv = m.normal.uvSet == 1 ? geometry_.uv1 : geometry_.uv0;
    const auto transformed = [&](int k) {
      return dvec2(vec2(m.normal.uvFromMesh * vec3(uv[hit.vertices[k]], 1.0f)));
    };
    const dvec2 a = transformed(0), b = transformed(1) - a, c = transformed(2) - a;
    const dvec3 p(geometry_.positions[hit.vertices[0]]), e1 = dvec3(geometry_.positions[hit.vertices[1]]) - p,
                                                         e2 = dvec3(geometry_.positions[hit.vertices[2]]) - p;
    const double sign = b.x * c.y - c.x * b.y < 0 ? -1 : 1;
    t = (e1 * c.y - e2 * b.y) * sign;
    const dvec3 bitangent = (e2 * b.x - e1 * c.x) * sign;
    t -= n * glm::dot(n, t);
    handedness = glm::dot(glm::cross(n, t), bitangent) < 0 ? -1 : 1;
  }
  const double length = glm::length(t);
  if (!(length > 1e-15)) return n;
  t /= length;
  const dvec3 b = glm::cross(n, t) * handedness;
  const vec4 texel = sample(m.normal, hit);
  const float scale = m.source->normalScale;
  const dvec3 map =
      dvec3((2.0f * texel.x - 1.0f) * scale, (2.0f * texel.y - 1.0f) * scale, 2.0f * texel.z - 1.0f);
  const dvec3 perturbed = t * map.x + b * map.y + n * map.z;
  const double perturbedLength = glm::length(perturbed);
  return perturbedLength > 1e-9 ? perturbed / perturbedLength : n;
}

ShadingNormal SurfaceShader::computeNormal(const Hit& hit) const {
  const dvec3 a(geometry_.normals[hit.vertices[0]]), toB = dvec3(geometry_.normals[hit.vertices[1]]) - a,
                                                     toC = dvec3(geometry_.normals[hit.vertices[2]]) - a;
  const dvec3 sum = a + toB * hit.barycentric.x + toC * hit.barycentric.y;
  const double length = glm::length(sum);
  ShadingNormal result;
  if (length > 1e-6) {
    const double inverseLength = 1.0 / length;
    result.normal = sum * inverseLength;
    const auto change = [&](const dvec2& barycentric) {
      return limitDerivative(
          differentiateNormalized(result.normal, inverseLength, toB * barycentric.x + toC * barycentric.y));
    };
    result.change = {change(hit.barycentricChange.dx), change(hit.barycentricChange.dy)};
  } else {  // normals that cancel each other
    result.normal = glm::normalize(hit.geometricNormal);
    result.change = {dvec3(0), dvec3(0)};
  }
  const ShadingMaterial& m = material(hit);
  const std::uint32_t reflector = geometry_.parts[hit.part].reflector;
  result.mirror = result.normal;
  if (m.normal.texture != nullptr) result.normal = perturbNormal(m, hit, result.normal);
  if (reflector == core::kNoId || !(geometry_.reflectors[reflector].clearcoat > 0))
    result.mirror = result.normal;
  if (!hit.isFront) {
    result.normal = -result.normal;
    result.mirror = -result.mirror;
    result.change = {-result.change.dx, -result.change.dy};
  }
  return result;
}

Shaded SurfaceShader::shade(const Ray& ray, const Hit& hit, const ShadingNormal& normal) const {
  const ShadingMaterial& m = material(hit);
  const scene::Part& part = geometry_.parts[hit.part];
  const vec4 base = baseColor(m, hit);
  Shaded result;
  result.alpha = base.a;
  scene::glsl::Surface s;
  s.baseColor = vec3(base);
  if (m.source->unlit) {
    result.radiance = s.baseColor;
    return result;
  }
  s.position = vec3(hit.position);
  s.toViewer = vec3(-ray.direction);
  s.normal = vec3(normal.normal);
  s.coatNormal = vec3(normal.mirror);
  s.emissive = m.source->emissive;
  if (m.emissive.texture != nullptr) s.emissive *= vec3(sample(m.emissive, hit));
  s.metallic = m.source->metallic;
  s.roughness = m.source->roughness;
  if (m.metallicRoughness.texture != nullptr) {
    const vec4 texel = sample(m.metallicRoughness, hit);
    s.roughness *= texel.g;
    s.metallic *= texel.b;
  }
  s.occlusion = 1.0f;
  if (m.occlusion.texture != nullptr)
    s.occlusion = glm::mix(1.0f, sample(m.occlusion, hit).r, m.source->occlusionStrength);
  s.f0Dielectric = m.f0Dielectric;
  const bool isReflector = part.reflector != core::kNoId;
  s.reflectivity = isReflector ? geometry_.reflectors[part.reflector].reflectivity : 0.0f;
  s.clearcoat = isReflector ? geometry_.reflectors[part.reflector].clearcoat : 0.0f;

  const float ior = isReflector ? geometry_.reflectors[part.reflector].ior : 0.0f;
  s.transmission = m.source->transmission;
  s.eta = ior > 0.0f ? scene::glsl::relativeIndex(ior, hit.isFront) : 0.0f;

  if (isReflector)
    result.mirrorWeight = ior > 0.0f ? scene::glsl::refractionWeight(s) : scene::glsl::mirrorWeight(s);
  if (s.reflectivity == 1.0f && s.metallic == 1.0f) {  // all of shadeSurface() but the emission is zero then
    result.radiance = s.emissive;
    return result;
  }
  vec3 direct(0);
  for (const auto& light : lights_) direct += scene::glsl::shadeLight(light, s);
  vec3 prefiltered(0);
  if (!(s.reflectivity > 0.0f))
    prefiltered = samplePrefiltered(environment_, glm::reflect(-s.toViewer, s.normal), s.roughness);
  result.radiance =
      scene::glsl::shadeSurface(s, direct, sampleIrradiance(environment_, s.normal), prefiltered);
  return result;
}

}  // namespace catoptric::reference

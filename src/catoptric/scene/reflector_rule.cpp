// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/reflector_rule.h"

#include <fmt/format.h>

#include <array>

#include "catoptric/core/log.h"

namespace catoptric::scene {
namespace {

constexpr double kIgnoredTexels = 0.02;
constexpr float kLeastTransmission = 0.5f;  // of a refractor
constexpr float kMostMetallicGlass = 0.1f;

struct ChannelRange {
  double mean = 1, low = 1, high = 1;  // low, high: all but kIgnoredTexels of the texels lie between
};

ChannelRange measureChannel(const core::ImageRgba8& image, int channel) {
  std::array<std::size_t, 256> histogram{};
  double sum = 0;
  for (const auto& texel : image.pixels()) {
    ++histogram[texel[channel]];
    sum += texel[channel];
  }
  const auto ignored = static_cast<std::size_t>(kIgnoredTexels * double(image.size()));
  int low = 0, high = 255;
  for (std::size_t below = histogram[0]; below <= ignored && low < 255;) below += histogram[++low];
  for (std::size_t above = histogram[255]; above <= ignored && high > 0;) above += histogram[--high];
  return {sum / double(image.size()) / 255.0, low / 255.0, high / 255.0};
}

ReflectorDecision decideByRule(const Scene& scene, const Material& material,
                               const ReflectorOptions& options) {
  ReflectorDecision decision;
  if (material.unlit) {
    decision.reason = "material: unlit";
    return decision;
  }
  if (material.isRefractive() && material.transmission >= kLeastTransmission &&
      material.roughness <= options.maxRoughness && material.metallic <= kMostMetallicGlass) {
    decision.isReflector = decision.isRefractor = true;
    decision.reason = fmt::format("transmission {:.3g} into a volume, index of refraction {:.4g}",
                                  material.transmission, material.ior);
    return decision;
  }
  ChannelRange roughness, metallic;
  const int texture = material.metallicRoughnessTexture.texture;
  const bool textured = texture >= 0 && !scene.textures[texture].image.isEmpty();
  if (textured) {
    roughness = measureChannel(scene.textures[texture].image, 1);
    metallic = measureChannel(scene.textures[texture].image, 2);
  }
  const double meanMetallic = material.metallic * metallic.mean,
               meanRoughness = material.roughness * roughness.mean;
  const bool onTheWhole = meanMetallic >= options.minMetallic && meanRoughness <= options.maxRoughness;
  const bool everywhere = material.metallic * metallic.low >= options.minMetallic &&
                          material.roughness * roughness.high <= options.maxRoughness;
  decision.reason = fmt::format("material: metallic {:.3g}, roughness {:.3g}{}", meanMetallic, meanRoughness,
                                textured ? " (texture means)" : "");
  if (onTheWhole && everywhere) {
    decision.isReflector = true;
    decision.reflectivity = 1;
    return decision;
  }
  if (material.clearcoat > 0 && material.clearcoatRoughness <= options.maxRoughness) {
    decision.isReflector = true;
    decision.clearcoat = material.clearcoat;
    decision.reason =
        fmt::format("clearcoat {:.3g}, roughness {:.3g}", material.clearcoat, material.clearcoatRoughness);
    return decision;
  }
  if (onTheWhole)
    decision.reason +=
        fmt::format(", but the texture varies: metallic down to {:.3g}, roughness up to {:.3g}",
                    material.metallic * metallic.low, material.roughness * roughness.high);
  return decision;
}

}  // namespace

ReflectorRule::ReflectorRule(const Scene& scene, const ReflectorOptions& options) : scene_(scene) {
  for (const Material& material : scene.materials)
    byMaterial_.push_back(decideByRule(scene, material, options));
  byMaterial_.push_back(decideByRule(scene, Material{}, options));
}

ReflectorRule::ReflectorRule(const Scene& scene, const ReflectorOptions& options, int onlyMaterial)
    : scene_(scene), byMaterial_(scene.materials.size() + 1) {
  const bool isNone = onlyMaterial < 0;
  byMaterial_[isNone ? scene.materials.size() : std::size_t(onlyMaterial)] =
      decideByRule(scene, isNone ? Material{} : scene.materials[std::size_t(onlyMaterial)], options);
}

const ReflectorDecision& ReflectorRule::decideByMaterial(int material) const {
  return material < 0 ? byMaterial_.back() : byMaterial_[std::size_t(material)];
}

ReflectorDecision ReflectorRule::decide(int material, const ReflectorHint& instanceHint) const {
  ReflectorDecision decision = decideByMaterial(material);
  const ReflectorHint none,
      &materialHint = material < 0 ? none : scene_.materials[std::size_t(material)].hint;
  const bool byNode = instanceHint.reflector.has_value();
  const std::optional<bool> hint = byNode ? instanceHint.reflector : materialHint.reflector;
  const auto reflectivity = instanceHint.reflectivity ? instanceHint.reflectivity : materialHint.reflectivity;
  if (material >= 0 && scene_.materials[std::size_t(material)].unlit) {
    if (hint.value_or(false))
      core::logWarningOnce("an unlit material cannot be a reflector; extras.catoptric ignored");
    return decision;
  }
  if (hint) {
    decision.reason = byNode ? "extras.catoptric of the node" : "extras.catoptric of the material";
    if (!*hint) return {false, 0, 0, false, decision.reason};
    decision.isRefractor = false;
    if (!decision.isReflector) decision.reflectivity = 1;
    decision.isReflector = true;
  }
  if (decision.isReflector && reflectivity && !decision.isRefractor) {
    if (decision.clearcoat > 0)
      decision.clearcoat *= *reflectivity;
    else
      decision.reflectivity = *reflectivity;
  }
  return decision;
}

}  // namespace catoptric::scene

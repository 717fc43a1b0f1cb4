// SPDX-License-Identifier: Apache-2.0
#include "catoptric/raster/scene_buffers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "catoptric/core/error.h"
#include "catoptric/core/log.h"
#include "catoptric/gl/context.h"
#include "catoptric/scene/texture_mips.h"

namespace catoptric::raster {
namespace {

MaterialBlock makeBlock(const scene::Material& m, const std::array<const gl::Texture*, 5>& textures) {
  MaterialBlock block{};
  block.baseColor = m.baseColor;
  block.emissive = vec4(m.emissive, m.metallic);
  block.factors = vec4(m.roughness, m.normalScale, m.occlusionStrength, m.alphaCutoff);
  const float ratio = (m.ior - 1.0f) / (m.ior + 1.0f);
  const float f0 = m.ior == 0.0f ? 1.0f : ratio * ratio * m.specular;
  block.more = vec4(f0, m.unlit ? 1.0f : 0.0f, m.alphaMode == scene::AlphaMode::Mask ? 1.0f : 0.0f,
                    m.isSeenFromBehind() ? 1.0f : 0.0f);
  const scene::TextureSlot* slots[5] = {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture,
                                        &m.occlusionTexture, &m.emissiveTexture};
  for (std::size_t i = 0; i < 5; ++i) {
    const mat3& t = slots[i]->uvFromMesh;
    const float lastLevel = textures[i] ? float(textures[i]->levels() - 1) : -1.0f;
    block.uvRows[2 * i] = vec4(t[0][0], t[1][0], t[2][0], float(slots[i]->uvSet));
    block.uvRows[2 * i + 1] = vec4(t[0][1], t[1][1], t[2][1], lastLevel);
  }
  return block;
}

gl::TextureWrap wrapOf(scene::Wrap wrap) {
  return wrap == scene::Wrap::Repeat           ? gl::TextureWrap::Repeat
         : wrap == scene::Wrap::MirroredRepeat ? gl::TextureWrap::MirroredRepeat
                                               : gl::TextureWrap::ClampToEdge;
}

core::Box computePartBox(const scene::WorldGeometry& world, std::uint32_t index) {
  const scene::Part& part = world.parts[index];
  core::Box box;
  for (std::uint32_t v = 0; v < part.vertexCount; ++v) box.add(dvec3(world.positions[part.firstVertex + v]));
  return box;
}

}  // namespace

SceneBuffers::SceneBuffers(const scene::Scene& scene, const scene::WorldGeometry& geometry,
                           const scene::Environment& environment)
    : scene_(scene),
      geometry_(geometry),
      environment_(environment),
      world_(geometry),
      materialBlocks_(gl::BufferKind::Uniform) {
  uploadTextures();
  updateMaterials();
  uploadEnvironment(environment);
  if (scene.lights.size() > std::size_t(kMaxLights))
    core::logWarningOnce(fmt::format("the scene has {} lights; the rasterizer uses the first {}",
                                     scene.lights.size(), kMaxLights));
  for (std::uint32_t i = 0; i < geometry.parts.size(); ++i) {
    const scene::Part& part = geometry.parts[i];
    if (part.indexCount == 0) continue;
    (isBlended(i) ? blended_ : opaque_).push_back({i, part.firstIndex, part.indexCount});
  }
  boxes_.resize(geometry.parts.size());
  for (std::uint32_t i = 0; i < geometry.parts.size(); ++i) boxes_[i] = computePartBox(geometry, i);
}

void SceneBuffers::updateGeometry(std::span<const std::uint32_t> movedParts) {
  for (const std::uint32_t p : movedParts) {
    world_.update(geometry_, geometry_.parts[p].firstVertex, geometry_.parts[p].vertexCount);
    boxes_[p] = computePartBox(geometry_, p);
  }
  if (!movedParts.empty()) world_.setIndices(geometry_.indices, false);
  if (levels_) levels_->update(scene_, geometry_, movedParts);
}

const LevelsOfDetail& SceneBuffers::levels() const {
  if (!levels_) levels_ = std::make_unique<LevelsOfDetail>(scene_, geometry_);
  return *levels_;
}

bool SceneBuffers::isBlended(std::uint32_t part) const {
  const scene::Part& p = geometry_.parts[part];
  return p.reflector == core::kNoId && material(p.material).alphaMode == scene::AlphaMode::Blend;
}

const scene::Material& SceneBuffers::material(int index) const {
  return index < 0 ? materials_.back() : materials_[std::size_t(index)];
}

const gl::Texture* SceneBuffers::findTexture(const scene::TextureSlot& slot, bool srgb) {
  if (slot.texture < 0) return nullptr;
  std::unique_ptr<gl::Texture>& texture = textures_[{slot.texture, srgb}];
  if (texture) return texture.get();
  const scene::Texture& source = scene_.textures[std::size_t(slot.texture)];
  if (source.image.isEmpty()) return nullptr;
  if (source.image.width() > gl::maxTextureSize() || source.image.height() > gl::maxTextureSize())
    throw core::Error("gl.texture_size",
                      fmt::format("texture '{}' is {}x{}, this GL takes {} at most", source.name,
                                  source.image.width(), source.image.height(), gl::maxTextureSize()));
  const auto mips = source.useMipmaps ? scene::makeMipChain(source.image, srgb)
                                      : std::vector<core::ImageRgba8>{source.image};
  const gl::SamplerState sampler{wrapOf(source.wrapU), wrapOf(source.wrapV), source.magnifyNearest,
                                 source.minifyNearest, source.useMipmaps};
  texture = std::make_unique<gl::Texture>(
      gl::TextureKind::Flat, srgb ? gl::Format::Srgb8Alpha8 : gl::Format::Rgba8, source.image.width(),
      source.image.height(), 1, int(mips.size()), sampler);
  for (std::size_t level = 0; level < mips.size(); ++level)
    texture->upload(int(level), 0, mips[level].data());
  if (gl::isSoftwareContext()) laneTextures_.try_emplace({slot.texture, srgb}, source, mips, srgb);
  return texture.get();
}

void SceneBuffers::uploadTextures() {
  const std::array<std::uint8_t, 4> whiteTexel{255, 255, 255, 255};
  white_ =
      std::make_unique<gl::Texture>(gl::TextureKind::Flat, gl::Format::Rgba8, 1, 1, 1, 1, gl::SamplerState{});
  white_->upload(0, 0, whiteTexel.data());
  materials_ = scene_.materials;
  materials_.emplace_back();
  for (const scene::Material& m : materials_)
    slots_.push_back({findTexture(m.baseColorTexture, true), findTexture(m.metallicRoughnessTexture, false),
                      findTexture(m.normalTexture, false), findTexture(m.occlusionTexture, false),
                      findTexture(m.emissiveTexture, true)});
}

void SceneBuffers::updateMaterials() {
  std::copy(scene_.materials.begin(), scene_.materials.end(), materials_.begin());
  const std::size_t alignment = gl::uniformBufferAlignment();
  blockStride_ = (sizeof(MaterialBlock) + alignment - 1) / alignment * alignment;
  std::vector<std::byte> bytes(blockStride_ * materials_.size());
  for (std::size_t i = 0; i < materials_.size(); ++i) {
    const MaterialBlock block = makeBlock(materials_[i], slots_[i]);
    std::memcpy(bytes.data() + i * blockStride_, &block, sizeof block);
  }
  materialBlocks_.upload(std::span<const std::byte>(bytes));
}

void SceneBuffers::uploadEnvironment(const scene::Environment& environment) {
  const core::ImageRgbF& finest = environment.radiance.front();
  const gl::SamplerState wrapAround{gl::TextureWrap::Repeat, gl::TextureWrap::ClampToEdge, false, false,
                                    true};
  radiance_ = std::make_unique<gl::Texture>(gl::TextureKind::Flat, gl::Format::Rgb16F, finest.width(),
                                            finest.height(), 1, int(environment.radiance.size()), wrapAround);
  for (std::size_t level = 0; level < environment.radiance.size(); ++level)
    radiance_->upload(int(level), 0, environment.radiance[level].data());
  const core::ImageRgbF& first = environment.prefiltered.front();
  gl::SamplerState flat = wrapAround;
  flat.hasMipmaps = false;
  prefiltered_ = std::make_unique<gl::Texture>(gl::TextureKind::Array, gl::Format::Rgb16F, first.width(),
                                               first.height(), int(environment.prefiltered.size()), 1, flat);
  for (std::size_t layer = 0; layer < environment.prefiltered.size(); ++layer)
    prefiltered_->upload(0, int(layer), environment.prefiltered[layer].data());
  irradiance_.assign(environment.irradiance.begin(), environment.irradiance.end());
}

void SceneBuffers::bindEnvironment(gl::Program& program) const {
  radiance_->bind(kUnitEnvironment);
  prefiltered_->bind(kUnitPrefiltered);
  program.set("u_environment", int(kUnitEnvironment));
  program.set("u_prefiltered", int(kUnitPrefiltered));
  program.set("u_irradiance[0]", irradiance_);
  program.set("u_environmentMaxLod", float(radiance_->levels() - 1));
  program.set("u_prefilteredLast", float(scene::kPrefilteredLevels - 1));
}

int SceneBuffers::lightCount() const {
  return int(std::min(scene_.lights.size(), std::size_t(kMaxLights)));
}

std::vector<vec4> SceneBuffers::packLights() const {
  std::vector<vec4> packed;
  for (int i = 0; i < lightCount(); ++i) {
    const scene::Light& light = scene_.lights[std::size_t(i)];
    const float kind = light.type == scene::LightType::Directional ? 0.0f
                       : light.type == scene::LightType::Point     ? 1.0f
                                                                   : 2.0f;
    packed.emplace_back(light.color, kind);
    packed.emplace_back(light.position, light.range);
    packed.emplace_back(light.direction, std::cos(light.innerConeRadians));
    packed.emplace_back(std::cos(light.outerConeRadians), 0.0f, 0.0f, 0.0f);
  }
  return packed;
}

void SceneBuffers::bindLights(gl::Program& program) const {
  program.set("u_lights[0]", packLights());
}

MaterialBlock SceneBuffers::materialBlock(int material) const {
  const std::size_t index = material < 0 ? materials_.size() - 1 : std::size_t(material);
  return makeBlock(materials_[index], slots_[index]);
}

const LaneEnvironment& SceneBuffers::laneEnvironment() const {
  if (!laneEnvironment_) laneEnvironment_ = std::make_unique<LaneEnvironment>(environment_);
  for (std::size_t i = 0; i < materials_.size(); ++i)
    if (slots_[i][kUnitMetallicRoughness] == nullptr) laneEnvironment_->addBlurred(materials_[i].roughness);
  return *laneEnvironment_;
}

std::array<const LaneTexture*, 5> SceneBuffers::laneTextures(int index) const {
  const scene::Material& m = material(index);
  const std::pair<int, bool> keys[5] = {{m.baseColorTexture.texture, true},
                                        {m.metallicRoughnessTexture.texture, false},
                                        {m.normalTexture.texture, false},
                                        {m.occlusionTexture.texture, false},
                                        {m.emissiveTexture.texture, true}};
  std::array<const LaneTexture*, 5> textures{};
  for (std::size_t k = 0; k < 5; ++k)
    if (const auto found = laneTextures_.find(keys[k]); found != laneTextures_.end())
      textures[k] = &found->second;
  return textures;
}

unsigned SceneBuffers::textureBits(int material) const {
  const std::size_t index = material < 0 ? materials_.size() - 1 : std::size_t(material);
  unsigned bits = 0;
  for (unsigned unit = 0; unit < 5; ++unit) bits |= slots_[index][unit] ? 1u << unit : 0u;
  return bits;
}

void SceneBuffers::bindMaterial(int material) const {
  const std::size_t index = material < 0 ? materials_.size() - 1 : std::size_t(material);
  materialBlocks_.bindRange(0, index * blockStride_, sizeof(MaterialBlock));
  for (int unit = 0; unit < 5; ++unit) {
    const gl::Texture* texture = slots_[index][std::size_t(unit)];
    (texture ? *texture : *white_).bind(unit);
  }
}

}  // namespace catoptric::raster

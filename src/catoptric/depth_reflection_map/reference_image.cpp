// SPDX-License-Identifier: Apache-2.0
#include "catoptric/depth_reflection_map/reference_image.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <glm/gtc/packing.hpp>
#include <system_error>

#include "catoptric/core/error.h"
#include "catoptric/core/file.h"

namespace catoptric::depth_reflection_map {
namespace {

int mipLevels(int width, int height) {
  return std::bit_width(unsigned(std::max(width, height)));
}

gl::SamplerState smooth() {
  return {gl::TextureWrap::ClampToEdge, gl::TextureWrap::ClampToEdge, false, false, true};
}

constexpr std::size_t kLargestFile = std::size_t(8) << 30;

std::vector<float> readDisparities(const std::vector<uvec2>& zexels) {
  std::vector<float> disparities(zexels.size());
  std::transform(zexels.begin(), zexels.end(), disparities.begin(),
                 [](const uvec2& zexel) { return std::bit_cast<float>(zexel.x); });
  return disparities;
}

}  // namespace

ReferenceImage::ReferenceImage(const ReferenceCamera& referenceCamera)
    : camera(referenceCamera),
      color(gl::TextureKind::Flat, gl::Format::Rgba16F, camera.width, camera.height, 1,
            mipLevels(camera.width, camera.height), smooth()),
      zexels(gl::TextureKind::Flat, gl::Format::Rg32Ui, camera.width, camera.height, 1, 1,
             gl::SamplerState{}) {}

std::size_t ReferenceImage::bytes() const {
  const std::size_t count = std::size_t(camera.width) * std::size_t(camera.height);
  return count * (8 + 8) + count * 8 / 3 + map.bytes();
}

ReferenceCache::ReferenceCache()
    : program_("raster/screen.vert", "depth_reflection_map/zexel_capture.frag") {}

std::size_t ReferenceCache::bytes() const {
  std::size_t sum = 0;
  for (const auto& [key, image] : images_) sum += image->bytes();
  return sum;
}

void ReferenceCache::evict() {
  while (images_.size() > 2 && bytes() > maxBytes_)
    images_.erase(std::min_element(images_.begin(), images_.end(), [](const auto& a, const auto& b) {
      return a.second->lastUse < b.second->lastUse;
    }));
}

void ReferenceCache::clear() {
  images_.clear();
  records_.clear();
  path_.clear();
  hasNew_ = false;
}

void ReferenceCache::useFile(const std::filesystem::path& path, std::uint64_t fingerprint) {
  std::error_code ignored;
  records_.clear();
  path_ = path;
  fingerprint_ = fingerprint;
  hasNew_ = !images_.empty();
  if (!std::filesystem::exists(path, ignored)) return;
  try {
    records_ = unpackReferences(core::readFile(path, kLargestFile), fingerprint);
  } catch (const core::Error& error) {
    path_.clear();
    if (error.code().starts_with("file.")) throw;
    throw core::Error(error.code(), "'" + path.string() + "': " + error.message(), {}, error.hint());
  }
}

bool ReferenceCache::loadFromFile(const ReferenceKey& key, ReferenceImage& image) const {
  const auto record = records_.find(key);
  if (record == records_.end()) return false;
  const StoredImage stored = unpackImage(record->second);
  const ReferenceCamera &there = stored.camera, &here = image.camera;
  if (there.centre != here.centre || there.worldFromZexel != here.worldFromZexel ||
      there.width != here.width || there.height != here.height)
    return false;  // of another hemisphere or size
  std::vector<vec4> radiance(stored.radiance.size());
  std::transform(stored.radiance.begin(), stored.radiance.end(), radiance.begin(),
                 [](std::uint64_t half) { return glm::unpackHalf4x16(half); });
  image.color.upload(0, 0, radiance.data());
  image.color.generateMipmaps();
  image.zexels.uploadCorner(here.width, here.height, stored.zexels.data());
  image.map = makeZexelMap(here.width, here.height, readDisparities(stored.zexels));
  return true;
}

void ReferenceCache::save() {
  if (path_.empty() || !hasNew_) return;
  for (const auto& [key, image] : images_) {
    const std::array<const gl::Texture*, 2> targets{&image->color, &image->zexels};
    const gl::Framebuffer framebuffer(targets, nullptr);
    StoredImage stored{key, image->camera, {}, {}};
    std::vector<vec4> radiance(std::size_t(image->camera.width) * std::size_t(image->camera.height));
    framebuffer.readPixels(0, std::span<vec4>(radiance));
    stored.zexels.resize(radiance.size());
    framebuffer.readPixels(1, std::span<uvec2>(stored.zexels));
    stored.radiance.resize(radiance.size());
    std::transform(radiance.begin(), radiance.end(), stored.radiance.begin(),
                   [](const vec4& value) { return glm::packHalf4x16(value); });
    records_[key] = packImage(stored);
  }
  core::writeFileAtomically(path_, packReferences(fingerprint_, records_));
  hasNew_ = false;
}

void ReferenceCache::capture(raster::FrameContext& frame, std::uint32_t reflector, ReferenceImage& image) {
  const ReferenceCamera& camera = image.camera;
  if (!level_ || level_->widthPx != camera.width || level_->heightPx != camera.height)
    level_ = std::make_unique<raster::Level>(camera.width, camera.height);
  frame.primary.draw(frame.scene, camera.makeView(), *level_, reflector);
  frame.compose.draw(*level_, nullptr);

  const std::array<const gl::Texture*, 2> targets{&image.color, &image.zexels};
  const gl::Framebuffer framebuffer(targets, nullptr);
  framebuffer.bind();
  gl::setDrawState({.depthTest = false, .depthWrite = false});
  program_.use();
  int unit = raster::kUnitFirstFree;
  const std::array<std::pair<const char*, const gl::Texture*>, 3> sources{
      {{"u_color", &level_->radiance}, {"u_position", &level_->seenPosition}, {"u_ids", &level_->seenIds}}};
  for (const auto& [name, texture] : sources) {
    texture->bind(unit);
    program_.set(name, unit++);
  }
  program_.set("u_centre", vec3(camera.centre));
  program_.set("u_forward", vec3(camera.forward));
  program_.set("u_planeDistance", float(camera.planeDistance));
  nothing_.bind();
  gl::drawScreen();

  std::vector<uvec2> zexels(std::size_t(camera.width) * std::size_t(camera.height));
  framebuffer.readPixels(1, std::span<uvec2>(zexels));
  image.map = makeZexelMap(camera.width, camera.height, readDisparities(zexels));
  image.color.generateMipmaps();
}

ReferenceImage& ReferenceCache::take(raster::FrameContext& frame, const ReferenceKey& key,
                                     const ReferenceCamera& camera) {
  std::unique_ptr<ReferenceImage>& slot = images_[key];
  const bool isNew = !slot;
  if (isNew) {
    const auto start = std::chrono::steady_clock::now();
    slot = std::make_unique<ReferenceImage>(camera);
    if (!loadFromFile(key, *slot)) {
      capture(frame, key.reflector, *slot);
      ++frame.counters.zexelCaptures;
      hasNew_ = true;
    }
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
    frame.counters.captureMs += spent.count();
  }
  ReferenceImage& image = *slot;
  image.lastUse = ++now_;
  if (isNew) evict();
  return image;
}

}  // namespace catoptric::depth_reflection_map

// SPDX-License-Identifier: Apache-2.0
#include "catoptric/depth_reflection_map/reference_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "catoptric/core/byte_stream.h"
#include "catoptric/core/error.h"

namespace catoptric::depth_reflection_map {
namespace {

using core::computeChecksum;
using Magic = std::array<char, 8>;
constexpr Magic kMagic{'C', 'A', 'T', 'O', 'Z', 'E', 'X', 'L'};
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeaderSize = 8 + 4 + 4 + 8 + 8 + 8, kRecordHeader = 16;
constexpr std::uint32_t kLargestSide = 1u << 14;
constexpr const char* kTakeAgain = "delete it; it is made anew";

[[noreturn]] void refuseDamaged(const char* what) {
  throw core::Error("zexel.damaged", std::string("the file of reference images is damaged: ") + what, {},
                    kTakeAgain);
}

class Fingerprint {
 public:
  template <class Value>
  void add(const std::vector<Value>& values) {
    hash_ = computeChecksum(std::as_bytes(std::span(values)), hash_ ^ values.size());
  }
  template <class... Values>
  void addAll(const Values&... values) {
    core::ByteWriter out;
    (out.put(values), ...);
    hash_ = computeChecksum(out.bytes(), hash_);
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = computeChecksum({});
};

void addMaterial(const scene::Material& m, Fingerprint& print) {
  print.addAll(m.baseColor, m.metallic, m.roughness, m.normalScale, m.occlusionStrength, m.emissive,
               m.alphaMode, m.alphaCutoff, m.doubleSided, m.unlit, m.ior, m.specular, m.specularColor,
               m.clearcoat, m.clearcoatRoughness, m.transmission);
  for (const scene::TextureSlot* slot : {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture,
                                         &m.occlusionTexture, &m.emissiveTexture})
    print.addAll(slot->texture, slot->uvSet, slot->uvFromMesh);
}

}  // namespace

std::uint64_t computeSceneFingerprint(const scene::Scene& scene, const scene::WorldGeometry& world,
                                      const scene::Environment& environment) {
  Fingerprint print;
  print.add(world.positions);
  print.add(world.normals);
  print.add(world.tangents);
  print.add(world.uv0);
  print.add(world.uv1);
  print.add(world.colors);
  print.add(world.indices);
  for (const scene::Part& p : world.parts)
    print.addAll(p.firstIndex, p.indexCount, p.material, p.object, p.reflector, p.shell);
  for (const scene::Reflector& r : world.reflectors)
    print.addAll(r.part, r.doubleSided, r.reflectivity, r.clearcoat);
  for (const scene::Material& material : scene.materials) addMaterial(material, print);
  for (const scene::Texture& t : scene.textures) {
    print.addAll(t.image.width(), t.wrapU, t.wrapV, t.magnifyNearest, t.minifyNearest, t.useMipmaps);
    print.add(t.image.pixels());
  }
  for (const scene::Light& l : scene.lights)
    print.addAll(l.type, l.color, l.position, l.direction, l.range, l.innerConeRadians, l.outerConeRadians);
  if (!environment.radiance.empty()) print.add(environment.radiance[0].pixels());
  print.addAll(environment.irradiance);
  return print.value();
}

std::vector<std::byte> packImage(const StoredImage& image) {
  core::ByteWriter out;
  out.put(image.key.reflector);
  out.put(std::uint32_t(image.key.isFromBehind ? 1 : 0));
  out.put(std::int32_t(image.key.shell));
  out.put(std::int32_t(image.key.index));
  const ReferenceCamera& camera = image.camera;
  out.put(std::uint32_t(camera.width));
  out.put(std::uint32_t(camera.height));
  out.put(camera.centre);
  out.put(camera.worldFromZexel);
  out.put(camera.forward);
  out.put(camera.planeDistance);
  out.putAll(std::span<const std::uint64_t>(image.radiance));
  out.putAll(std::span<const uvec2>(image.zexels));
  return std::move(out.bytes());
}

StoredImage unpackImage(std::span<const std::byte> record) {
  core::ByteReader in(record, refuseDamaged);
  StoredImage image;
  image.key.reflector = in.get<std::uint32_t>();
  image.key.isFromBehind = in.get<std::uint32_t>() != 0;
  image.key.shell = in.get<std::int32_t>();
  image.key.index = in.get<std::int32_t>();
  const auto width = in.get<std::uint32_t>(), height = in.get<std::uint32_t>();
  if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide)
    refuseDamaged("the size of an image is out of range");
  image.camera.width = int(width);
  image.camera.height = int(height);
  image.camera.centre = in.get<dvec3>();
  image.camera.worldFromZexel = in.get<dmat3>();
  image.camera.forward = in.get<dvec3>();
  image.camera.planeDistance = in.get<double>();
  const std::uint64_t count = std::uint64_t(width) * height;
  image.radiance = in.getAll<std::uint64_t>(count);
  image.zexels = in.getAll<uvec2>(count);
  if (!in.isAtEnd()) refuseDamaged("an image is too long");
  return image;
}

std::vector<std::byte> packReferences(std::uint64_t fingerprint,
                                      const std::map<ReferenceKey, std::vector<std::byte>>& records) {
  std::uint64_t size = 0;
  for (const auto& [key, record] : records) size += kRecordHeader + record.size();
  core::ByteWriter out;
  out.bytes().reserve(kHeaderSize + std::size_t(size));
  out.put(kMagic);
  out.put(kVersion);
  out.put(std::uint32_t(records.size()));
  out.put(fingerprint);
  out.put(size);
  out.put(computeChecksum(out.bytes()));
  for (const auto& [key, record] : records) {
    out.put(std::uint64_t(record.size()));
    out.put(computeChecksum(record));
    out.putAll(std::span<const std::byte>(record));
  }
  return std::move(out.bytes());
}

std::map<ReferenceKey, std::vector<std::byte>> unpackReferences(std::span<const std::byte> bytes,
                                                                std::uint64_t fingerprint) {
  core::ByteReader in(bytes, refuseDamaged);
  if (bytes.size() < sizeof kMagic + sizeof kVersion || in.get<Magic>() != kMagic)
    throw core::Error("zexel.foreign", "this is no file of reference images", {}, "name another one");
  if (const auto version = in.get<std::uint32_t>(); version != kVersion)
    throw core::Error(
        "zexel.version",
        fmt::format("the file of reference images has format {}, this version reads {}", version, kVersion),
        {}, kTakeAgain);
  if (bytes.size() < kHeaderSize)
    throw core::Error("zexel.truncated", "the file of reference images ends in its header", {}, kTakeAgain);
  const auto count = in.get<std::uint32_t>();
  const auto scene = in.get<std::uint64_t>(), size = in.get<std::uint64_t>();
  if (in.get<std::uint64_t>() != computeChecksum(bytes.first(kHeaderSize - 8)))
    refuseDamaged("the checksum of its header is wrong");
  if (scene != fingerprint)
    throw core::Error("zexel.other_scene",
                      "the file of reference images was made for another scene, or it has changed since", {},
                      kTakeAgain);
  if (bytes.size() - kHeaderSize < size)
    throw core::Error("zexel.truncated", "the file of reference images is not complete", {}, kTakeAgain);
  if (bytes.size() - kHeaderSize > size) refuseDamaged("something follows after its end");
  std::map<ReferenceKey, std::vector<std::byte>> records;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto length = in.get<std::uint64_t>(), checksum = in.get<std::uint64_t>();
    std::vector<std::byte> record = in.getAll<std::byte>(length);
    if (checksum != computeChecksum(record)) refuseDamaged("the checksum of an image is wrong");
    const ReferenceKey key = unpackImage(record).key;
    records.emplace(key, std::move(record));
  }
  if (!in.isAtEnd()) refuseDamaged("something follows after its last image");
  return records;
}

}  // namespace catoptric::depth_reflection_map

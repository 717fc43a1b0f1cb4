// SPDX-License-Identifier: Apache-2.0
// Reference images in a file, so that they need not be taken again. Layout, little-endian:
//   header   "CATOZEXL", version (4), number of images (4), fingerprint of the scene (8), size of all records
//            (8), checksum of that (8)
//   records  one an image: size (8), checksum (8), key, camera, radiance as half floats, zexels
// All of it is checked before anything is used: a file that is damaged, truncated, foreign, newer, or of
// another scene is refused.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <vector>

#include "catoptric/core/math.h"
#include "catoptric/depth_reflection_map/reference_camera.h"
#include "catoptric/depth_reflection_map/reference_key.h"
#include "catoptric/scene/environment.h"
#include "catoptric/scene/scene.h"

namespace catoptric::depth_reflection_map {

/// What a reference image consists of, bottom row first.
struct StoredImage {
  ReferenceKey key;
  ReferenceCamera camera;
  std::vector<std::uint64_t> radiance;  ///< four half floats a zexel
  std::vector<uvec2> zexels;            ///< shaders/depth_reflection_map/zexel_capture.frag
};

/// Of all that reference images depend on: geometry, materials, textures, lights, surroundings.
[[nodiscard]] std::uint64_t computeSceneFingerprint(const scene::Scene& scene,
                                                    const scene::WorldGeometry& world,
                                                    const scene::Environment& environment);

[[nodiscard]] std::vector<std::byte> packImage(const StoredImage& image);
/// Throws core::Error("zexel.damaged").
[[nodiscard]] StoredImage unpackImage(std::span<const std::byte> record);

/// The bytes of a file with these records, as packImage() makes them.
[[nodiscard]] std::vector<std::byte> packReferences(
    std::uint64_t fingerprint, const std::map<ReferenceKey, std::vector<std::byte>>& records);
/// The records of a file. Throws core::Error: "zexel.foreign", "zexel.version", "zexel.truncated",
/// "zexel.damaged", "zexel.other_scene".
[[nodiscard]] std::map<ReferenceKey, std::vector<std::byte>> unpackReferences(
    std::span<const std::byte> bytes, std::uint64_t fingerprint);

}  // namespace catoptric::depth_reflection_map

// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 (.gltf with files or data URIs, .glb) to Scene. The whole document is validated strictly before
// any byte of geometry is read; docs/gltf.md lists what is supported, repaired and refused.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "catoptric/core/image_io.h"
#include "catoptric/scene/scene.h"

namespace catoptric::scene {

struct ImportOptions {
  std::optional<std::string> sceneName;  ///< name or index of the glTF scene; default scene if absent
  std::size_t maxMemoryBytes = std::size_t(4) << 30;  ///< --max-memory: refuse what would need more
  std::size_t maxPixels = core::kDefaultMaxPixels;    ///< --max-pixels: per image
  std::size_t maxNodes = 1000000;
};

/// Reads a scene file. Throws core::Error with a code "gltf.*" or "file.*", one line, and the JSON pointer of
/// the offending element. Repairs (dropped non-finite vertices, recomputed normals, ignored optional
/// extensions) are listed in Scene::warnings.
[[nodiscard]] Scene importGltf(const std::filesystem::path& path, const ImportOptions& options = {});

/// The same from memory; `baseFolder` is where relative URIs are looked up (empty: none are allowed).
[[nodiscard]] Scene importGltf(std::span<const std::byte> bytes, const std::filesystem::path& baseFolder,
                               const std::string& name, const ImportOptions& options = {});

}  // namespace catoptric::scene

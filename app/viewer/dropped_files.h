// SPDX-License-Identifier: Apache-2.0
// What files that were let go of over the window mean, and which scenes a folder holds.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace catoptric::viewer {

/// By its name: .hdr or .exr.
[[nodiscard]] bool isEnvironmentFile(const std::string& file);

/// The .gltf and .glb files of a folder in alphabetical order. Throws core::Error("file.not_found") if there
/// are none.
[[nodiscard]] std::vector<std::string> listScenes(const std::string& folder);

struct DroppedFiles {
  std::vector<std::string> scenes;  ///< in alphabetical order; a folder stands for those in it
  std::string environment;          ///< the last one; empty: none
};

/// A .bin or a .png beside a scene is of no interest: who drags all files of a scene means the scene. Throws
/// core::Error("file.kind") where nothing is a scene or surroundings.
[[nodiscard]] DroppedFiles sortDroppedFiles(std::span<const std::string> files);

}  // namespace catoptric::viewer

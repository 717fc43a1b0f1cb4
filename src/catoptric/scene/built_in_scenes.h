// SPDX-License-Identifier: Apache-2.0
// The scenes the project ships (methods.md, section 7), made by our own code as ordinary .glb files, which
// are then read through the ordinary importer.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace catoptric::scene {

struct BuiltInScene {
  std::string_view name;         ///< "four-spheres", ...
  std::string_view description;  ///< one line, with the figure of the paper it follows
};

[[nodiscard]] std::span<const BuiltInScene> builtInScenes();

/// The bytes of the .glb; the same on every run. Throws core::Error("scene.unknown") with a "did you mean".
[[nodiscard]] std::vector<std::byte> makeBuiltInScene(std::string_view name);

}  // namespace catoptric::scene

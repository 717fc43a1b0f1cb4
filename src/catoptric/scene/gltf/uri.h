// SPDX-License-Identifier: Apache-2.0
// Which bytes a URI of a scene file may name.
// Allowed are data: URIs and regular files inside the scene's folder. A scene file may come from anywhere, so
// a URI that leaves the folder (.., absolute, through a symbolic link), has another scheme, or names a device
// is refused. Percent-encoding is decoded once; unencoded blanks and UTF-8 names are accepted, as all
// exporters write them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "catoptric/scene/gltf/context.h"

namespace catoptric::scene::gltf {

[[nodiscard]] bool isDataUri(std::string_view uri);

/// The bytes of a data: URI (base64 or percent-encoded). Throws "gltf.uri".
[[nodiscard]] std::vector<std::byte> decodeDataUri(Context& context, std::string_view uri,
                                                   const std::string& pointer);

/// The relative path that a file URI stands for. Throws "gltf.uri" if the policy forbids it; touches no file.
[[nodiscard]] std::filesystem::path checkFileUri(Context& context, const std::string& uri,
                                                 const std::string& pointer);

/// The file that a relative URI names. Throws "gltf.uri" if it is not allowed, "gltf.file" if it does not
/// exist.
[[nodiscard]] std::filesystem::path resolveFileUri(Context& context, const std::filesystem::path& folder,
                                                   const std::string& uri, const std::string& pointer);

/// Either of the two, charged to the memory budget.
[[nodiscard]] std::vector<std::byte> readUri(Context& context, const std::filesystem::path& folder,
                                             const std::string& uri, const std::string& pointer);

}  // namespace catoptric::scene::gltf

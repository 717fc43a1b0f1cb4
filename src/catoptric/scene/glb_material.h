// SPDX-License-Identifier: Apache-2.0
// Materials and hints as glTF's JSON; the part of scene/glb_writer.h that knows the extensions.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>

#include "catoptric/scene/material.h"

namespace catoptric::scene {

using ExtensionNames = std::set<std::string>;

/// The double whose shortest decimal is the float's shortest decimal: 0.9f is written as 0.9.
[[nodiscard]] double makeNumber(float value);
[[nodiscard]] nlohmann::json makeVectorJson(const vec3& v);

/// Null when the hint says nothing.
[[nodiscard]] nlohmann::json makeHintJson(const ReflectorHint& hint);

/// An element of `materials`; names of the extensions it needs are added to `used`.
[[nodiscard]] nlohmann::json makeMaterialJson(const Material& material, ExtensionNames& used);

}  // namespace catoptric::scene

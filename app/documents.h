// SPDX-License-Identifier: Apache-2.0
// The JSON documents: what all of them have in common. Every one carries "schema": 1.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "catoptric/core/error.h"
#include "catoptric/renderer/frame.h"
#include "catoptric/scene/scene.h"
#include "loaded_scene.h"

namespace catoptric::app {

using Json = nlohmann::ordered_json;

/// Text of a document. Bytes that are not UTF-8 (names in a file) are replaced; numbers that are not finite
/// are null.
[[nodiscard]] std::string serialise(const Json& document);

/// Writes it to `file`, or to stdout for "-"; does nothing if `file` is empty.
void writeDocument(const std::string& file, const Json& document);

[[nodiscard]] Json makeErrorDocument(const core::Error& error);

/// {"schema": 1, "command": ..., "environment": {...}}; the renderer says which GL and Embree build it runs
/// on.
[[nodiscard]] Json makeDocument(const std::string& command, renderer::Renderer* renderer);
/// "gl_renderer" and "backend_auto" (what --backend auto stands for there); makes the renderer's context.
void addGl(renderer::Renderer& renderer, Json& environment);
[[nodiscard]] Json makeJson(const scene::Camera& camera);
[[nodiscard]] Json makeJson(const dvec3& vector);
[[nodiscard]] Json makeSceneJson(const LoadedScene& loaded);

/// For --version: build, GL, Embree, a line each.
[[nodiscard]] std::string makeVersionText();

}  // namespace catoptric::app

// SPDX-License-Identifier: Apache-2.0
// Helpers for the tests of the glTF importer: documents written in the test, a scene checker, asset folders.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catoptric/core/error.h"
#include "catoptric/scene/gltf_import.h"
#include "gltf_scene_check.h"

namespace catoptric::scene::gltf_test {

using Json = nlohmann::json;

inline std::string encodeBase64(std::span<const std::byte> bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = (bits << 8) | (i + k < bytes.size() ? std::uint32_t(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? kDigits[(bits >> (18 - 6 * k)) & 63u] : '=';
  }
  return out;
}

/// A document in the making: arrays of numbers become accessors in one buffer.
class Document {
 public:
  Json json = {{"asset", {{"version", "2.0"}}}};

  /// Appends the values, 4-byte aligned, with a buffer view of their own; returns the buffer view.
  template <class T>
  int addView(const std::vector<T>& values) {
    while (bytes_.size() % 4 != 0) bytes_.push_back(std::byte(0));
    const std::size_t offset = bytes_.size();
    bytes_.resize(offset + values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(bytes_.data() + offset, values.data(), values.size() * sizeof(T));
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", values.size() * sizeof(T)}});
    return int(json["bufferViews"].size()) - 1;
  }

  template <class T>
  int addAccessor(const std::vector<T>& values, const std::string& type, int componentType) {
    static const std::vector<std::pair<std::string, int>> kCounts = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    int components = 1;
    for (const auto& [name, count] : kCounts)
      if (name == type) components = count;
    json["accessors"].push_back({{"bufferView", addView(values)},
                                 {"componentType", componentType},
                                 {"type", type},
                                 {"count", values.size() / std::size_t(components)}});
    return int(json["accessors"].size()) - 1;
  }

  int addFloats(const std::vector<float>& values, const std::string& type) {
    return addAccessor(values, type, 5126);
  }

  /// Adds a mesh with one primitive and a node that shows it; returns the primitive.
  Json& addPrimitive(const Json& attributes) {
    json["meshes"].push_back({{"primitives", {{{"attributes", attributes}}}}});
    json["nodes"].push_back({{"mesh", json["meshes"].size() - 1}});
    return json["meshes"].back()["primitives"][0];
  }

  [[nodiscard]] std::string text() const {
    Json out = json;
    if (!bytes_.empty() && !out.contains("buffers"))
      out["buffers"] = {{{"byteLength", bytes_.size()},
                         {"uri", "data:application/octet-stream;base64," + encodeBase64(bytes_)}}};
    return out.dump();
  }

  [[nodiscard]] std::vector<std::byte>& bytes() { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// A triangle in the plane z = 0 that faces +z, with normals.
inline Document makeTriangle() {
  Document document;
  const int position = document.addFloats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const int normal = document.addFloats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  document.addPrimitive({{"POSITION", position}, {"NORMAL", normal}});
  return document;
}

inline Scene import(const std::string& text, const ImportOptions& options = {},
                    const std::filesystem::path& folder = {}) {
  return importGltf(std::as_bytes(std::span(text.data(), text.size())), folder, "test.gltf", options);
}

inline Scene import(const Document& document, const ImportOptions& options = {}) {
  return import(document.text(), options);
}

/// What the importer throws; a failure of the test if it throws nothing.
inline std::optional<core::Error> importError(const std::string& text, const ImportOptions& options = {},
                                              const std::filesystem::path& folder = {}) {
  try {
    (void)import(text, options, folder);
  } catch (const core::Error& error) {
    return error;
  }
  ADD_FAILURE() << "the importer accepted the document";
  return std::nullopt;
}

inline std::optional<core::Error> importError(const Document& document, const ImportOptions& options = {}) {
  return importError(document.text(), options);
}

#define EXPECT_REFUSED(document, wantedCode, wantedPointer)                    \
  do {                                                                         \
    const auto refusal = ::catoptric::scene::gltf_test::importError(document); \
    if (refusal) {                                                             \
      EXPECT_EQ(refusal->code(), wantedCode) << refusal->what();               \
      EXPECT_EQ(refusal->pointer(), wantedPointer) << refusal->what();         \
    }                                                                          \
  } while (false)

inline bool hasWarning(const Scene& scene, const std::string& part) {
  for (const std::string& line : scene.warnings)
    if (line.find(part) != std::string::npos) return true;
  return false;
}

}  // namespace catoptric::scene::gltf_test

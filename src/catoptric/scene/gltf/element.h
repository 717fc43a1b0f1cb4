// SPDX-License-Identifier: Apache-2.0
// A JSON value that knows its JSON pointer, with getters that check type and range before they convert.
// (nlohmann's own get<size_t>() turns -1 into 2^64-1 and 1e20 into 0.) All getters throw core::Error with the
// pointer of the offending value. An Element refers into the parsed document and must not outlive it.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "catoptric/scene/gltf/context.h"

namespace catoptric::scene::gltf {

using Json = nlohmann::json;

/// Integers of a JSON file are exact up to here; it also keeps count * stride + offset below 2^63.
inline constexpr std::size_t kMaxJsonInteger = std::size_t(1) << 53;
/// Numbers of larger magnitude do not fit into the floats that hold them later.
inline constexpr double kMaxNumber = 3.0e38;

class Element {
 public:
  /// The root. Throws unless it is an object.
  Element(const Context& context, const Json& root);

  [[noreturn]] void fail(std::string_view code, const std::string& message,
                         const std::string& hint = {}) const;
  [[nodiscard]] std::string pointer() const;
  [[nodiscard]] const Json& json() const { return *value_; }

  // Members of an object.
  [[nodiscard]] bool has(std::string_view key) const { return value_->contains(key); }
  /// The member `key`, whatever its type.
  [[nodiscard]] std::optional<Element> find(std::string_view key) const;
  [[nodiscard]] std::optional<Element> findObject(std::string_view key) const;
  [[nodiscard]] std::optional<Element> findArray(std::string_view key) const;
  [[nodiscard]] Element getObject(std::string_view key) const;  ///< Required.
  [[nodiscard]] Element getArray(std::string_view key) const;   ///< Required and not empty.
  /// Object at extensions.KEY.
  [[nodiscard]] std::optional<Element> findExtension(std::string_view key) const;

  /// Index below `limit`, -1 if absent; `what` is said in messages ("mesh", "accessor", ...).
  [[nodiscard]] int findIndex(std::string_view key, std::size_t limit, std::string_view what) const;
  [[nodiscard]] int getIndex(std::string_view key, std::size_t limit, std::string_view what) const;
  /// Every element an index below `limit`, no value twice; empty if absent.
  [[nodiscard]] std::vector<int> findIndexList(std::string_view key, std::size_t limit,
                                               std::string_view what) const;

  [[nodiscard]] std::size_t findInteger(std::string_view key, std::size_t fallback, std::size_t least = 0,
                                        std::size_t most = kMaxJsonInteger) const;
  [[nodiscard]] std::size_t getInteger(std::string_view key, std::size_t least = 0,
                                       std::size_t most = kMaxJsonInteger) const;
  [[nodiscard]] double findNumber(std::string_view key, double fallback, double least = -kMaxNumber,
                                  double most = kMaxNumber) const;
  [[nodiscard]] double getNumber(std::string_view key, double least = -kMaxNumber,
                                 double most = kMaxNumber) const;
  [[nodiscard]] bool findBool(std::string_view key, bool fallback) const;
  [[nodiscard]] std::string findString(std::string_view key, std::string_view fallback = {}) const;
  [[nodiscard]] std::string getString(std::string_view key) const;
  [[nodiscard]] std::vector<float> findNumberList(std::string_view key) const;

  template <std::size_t N>
  [[nodiscard]] std::array<double, N> findNumbers(std::string_view key, const std::array<double, N>& fallback,
                                                  double least = -kMaxNumber,
                                                  double most = kMaxNumber) const {
    const std::optional<Element> list = findArray(key);
    if (!list) return fallback;
    list->requireSize(N);
    std::array<double, N> out{};
    for (std::size_t i = 0; i < N; ++i) out[i] = (*list)[i].asNumber(least, most);
    return out;
  }

  // Elements of an array.
  [[nodiscard]] std::size_t size() const { return value_->size(); }
  [[nodiscard]] Element operator[](std::size_t index) const;
  void requireSize(std::size_t size) const;

  // The value itself.
  void requireObject() const;
  [[nodiscard]] std::size_t asInteger(std::size_t least = 0, std::size_t most = kMaxJsonInteger) const;
  [[nodiscard]] int asIndex(std::size_t limit, std::string_view what) const;
  [[nodiscard]] double asNumber(double least = -kMaxNumber, double most = kMaxNumber) const;
  [[nodiscard]] bool asBool() const;
  [[nodiscard]] std::string asString() const;

 private:
  struct Step {
    std::string_view key;   ///< Of an object, or ...
    std::size_t index = 0;  ///< ... of an array (key.data() is null).
  };
  Element(const Element& parent, const Json& value, Step step);
  [[nodiscard]] Element require(std::string_view key) const;
  [[noreturn]] void failType(std::string_view wanted) const;

  static constexpr std::size_t kMaxSteps = 12;  ///< Nothing that we read lies deeper.
  const Context* context_;
  const Json* value_;
  std::array<Step, kMaxSteps> steps_;
  std::size_t depth_ = 0;
};

/// Calls body(element, index) for each object in the array `key`; nothing if it is absent.
template <class Body>
void forEachObject(const Element& parent, std::string_view key, Body body) {
  const std::optional<Element> list = parent.findArray(key);
  if (!list) return;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const Element element = (*list)[i];
    element.requireObject();
    body(element, i);
  }
}

}  // namespace catoptric::scene::gltf

// SPDX-License-Identifier: Apache-2.0
// Reading a session's JSON: each value knows where it is, and says so when it is not what was expected.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "documents.h"

namespace catoptric::app {

/// One value of the file and where it is.
class SessionValue {
 public:
  SessionValue(const std::string& file, const Json& json, std::string pointer)
      : file_(file), json_(json), pointer_(std::move(pointer)) {}

  [[noreturn]] void refuse(const std::string& expected) const {
    throw core::Error("session.invalid",
                      fmt::format("'{}' is no session: {} is not {}", file_,
                                  pointer_.empty() ? "its content" : pointer_, expected),
                      pointer_, "ctrl-S in the viewer writes one");
  }
  /// Calls `read` with the name and value of each member.
  template <class Read>
  void forMembers(const Read& read) const {
    if (!json_.is_object()) refuse("an object");
    for (const auto& [name, member] : json_.items())
      read(name, SessionValue(file_, member, pointer_ + "/" + name));
  }
  template <class Read>
  void forElements(const Read& read) const {
    if (!json_.is_array()) refuse("a list");
    for (std::size_t i = 0; i < json_.size(); ++i)
      read(SessionValue(file_, json_[i], fmt::format("{}/{}", pointer_, i)));
  }
  [[nodiscard]] std::string text() const {
    if (!json_.is_string()) refuse("a text");
    return json_.get<std::string>();
  }
  [[nodiscard]] bool flag() const {
    if (!json_.is_boolean()) refuse("true or false");
    return json_.get<bool>();
  }
  [[nodiscard]] double number(double least, double most) const {
    const double value = json_.is_number() ? json_.get<double>() : std::nan("");
    if (!(value >= least && value <= most)) refuse(fmt::format("a number from {} to {}", least, most));
    return value;
  }
  [[nodiscard]] int integer(int least, int most) const {
    const double value = number(least, most);
    if (value != std::floor(value)) refuse("a whole number");
    return int(value);
  }
  [[nodiscard]] dvec3 vector(double least = -1e9, double most = 1e9) const {
    if (!json_.is_array() || json_.size() != 3) refuse("a list of three numbers");
    dvec3 result(0);
    int i = 0;
    forElements([&](const SessionValue& element) { result[i++] = element.number(least, most); });
    return result;
  }
  [[nodiscard]] std::vector<std::string> texts() const {
    std::vector<std::string> result;
    forElements([&](const SessionValue& element) { result.push_back(element.text()); });
    return result;
  }
  /// One of enumerators 0 .. last by their names.
  template <class Enum, class Name>
  [[nodiscard]] Enum choice(Enum last, const Name& nameOf) const {
    const std::string wanted = text();
    std::string all;
    for (int i = 0; i <= int(last); ++i) {
      if (wanted == nameOf(Enum(i))) return Enum(i);
      all += (i > 0 ? ", " : "") + std::string(nameOf(Enum(i)));
    }
    refuse("one of " + all);
  }

 private:
  const std::string& file_;
  const Json& json_;
  std::string pointer_;
};

}  // namespace catoptric::app

// SPDX-License-Identifier: Apache-2.0
// World failures (files, formats, GL) throw Error; misuse by the caller asserts; expected absence is an
// std::optional.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace catoptric::core {

/// A failure the user can act on. what() is one line: what went wrong, where, what to do.
class Error : public std::runtime_error {
 public:
  /// `code` is a stable machine word such as "gltf.index_out_of_range"; `pointer` a JSON pointer to the
  /// offending element of the input, empty if there is none; `hint` what to do, empty if nothing is to be
  /// said.
  Error(std::string code, const std::string& message, std::string pointer = {}, std::string hint = {})
      : std::runtime_error(join(message, pointer, hint)),
        code_(std::move(code)),
        message_(message),
        pointer_(std::move(pointer)),
        hint_(std::move(hint)) {}

  [[nodiscard]] const std::string& code() const { return code_; }
  [[nodiscard]] const std::string& message() const { return message_; }
  [[nodiscard]] const std::string& pointer() const { return pointer_; }
  [[nodiscard]] const std::string& hint() const { return hint_; }

 private:
  static std::string join(const std::string& message, const std::string& pointer, const std::string& hint) {
    std::string line = message;
    if (!pointer.empty()) line += " (at " + pointer + ")";
    if (!hint.empty()) line += "; " + hint;
    for (char& c : line)
      if (c == '\n' || c == '\r') c = ' ';
    return line;
  }

  std::string code_, message_, pointer_, hint_;
};

}  // namespace catoptric::core

// SPDX-License-Identifier: Apache-2.0
// How commands declare what they take from the command line, without seeing the library that parses it (its
// header is heavy, so one file only includes it: arguments.cpp).
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace catoptric::app {

/// The command line itself is wrong: exit code 2.
class UsageError : public std::runtime_error {
 public:
  explicit UsageError(const std::string& message, std::string hint = {})
      : std::runtime_error(message), hint_(std::move(hint)) {}
  [[nodiscard]] const std::string& hint() const { return hint_; }

 private:
  std::string hint_;
};

/// Takes one value as typed; throws UsageError if it is no good.
using Setter = std::function<void(const std::string&)>;

/// What a command accepts. Names are written as "-o,--output"; setters are called after the whole line was
/// read.
class Arguments {
 public:
  virtual ~Arguments() = default;

  /// Heading in --help for what is declared next.
  virtual void group(const std::string& heading) = 0;
  virtual void flag(const std::string& names, const std::string& help, bool& target) = 0;
  virtual void option(const std::string& names, const std::string& valueName, const std::string& help,
                      Setter setter) = 0;
  /// May be given several times; the setter is called for each.
  virtual void repeatable(const std::string& names, const std::string& valueName, const std::string& help,
                          Setter setter) = 0;
  enum class Count { ExactlyOne, AtMostOne, OneOrMore };
  virtual void positional(const std::string& name, const std::string& help, Count count, Setter setter) = 0;
};

/// A command of the program: one row in the table of command_line.cpp.
struct Command {
  std::string name;
  std::string summary;
  std::string examples;  ///< at the foot of --help
  std::function<void(Arguments&)> declare;
  /// After parsing; gets the line as it was typed (without the program's name), returns the exit code.
  std::function<int(const std::vector<std::string>&)> run;
};

struct ParsedLine {
  const Command* command = nullptr;  ///< null when all was said already (--help) or --version was asked for
  std::string help;                  ///< to print to stdout, if --help was given
  bool version = false;
};

/// Parses a command line (without the program's name). Throws UsageError, with a "did you mean" where that is
/// close.
[[nodiscard]] ParsedLine parseArguments(const std::vector<Command>& commands,
                                        const std::vector<std::string>& line);

/// The help of the whole program.
[[nodiscard]] std::string makeProgramHelp(const std::vector<Command>& commands);

}  // namespace catoptric::app

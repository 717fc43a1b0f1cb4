// SPDX-License-Identifier: Apache-2.0
// The only file that sees CLI11. Each command is an application of its own to it; the command's name is
// looked up here, so that a slip in it gets a "did you mean", too.
#include "arguments.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "suggest.h"

namespace catoptric::app {
namespace {

using Strings = std::vector<std::string>;

/// What a command declared, and CLI11's parser for it.
class Cli11Arguments final : public Arguments {
 public:
  explicit Cli11Arguments(const Command& command)
      : app_(std::make_unique<CLI::App>(command.summary, "catoptric " + command.name)) {
    app_->set_help_flag("-h,--help", "Print this help and exit");
    app_->get_formatter()->column_width(36);
    if (!command.examples.empty()) app_->footer("\nExamples:\n" + command.examples);
    command.declare(*this);
  }

  void group(const std::string& heading) override { heading_ = heading; }

  void flag(const std::string& names, const std::string& help, bool& target) override {
    app_->add_flag(names, target, help)->group(heading_);
  }
  void option(const std::string& names, const std::string& valueName, const std::string& help,
              Setter setter) override {
    add(names, valueName, help, std::move(setter), false);
  }
  void repeatable(const std::string& names, const std::string& valueName, const std::string& help,
                  Setter setter) override {
    add(names, valueName, help + " (may be given several times)", std::move(setter), true);
  }
  void positional(const std::string& name, const std::string& help, Count count, Setter setter) override {
    storage_.push_back(std::make_unique<Strings>());
    CLI::Option* option = app_->add_option(name, *storage_.back(), help)->type_name("");
    if (count == Count::OneOrMore)
      option->expected(-1);
    else
      option->expected(1)->allow_extra_args(false);
    if (count != Count::AtMostOne) option->required();
    given_.push_back({option, std::move(setter), true});
  }

  void parse(const Strings& line) {
    refuseSingleDashes(line);
    try {
      app_->parse(Strings(line.rbegin(), line.rend()));  // CLI11 wants the first word last
    } catch (const CLI::ExtrasError&) {
      refuseExtras(app_->remaining());
    } catch (const CLI::RequiredError& error) {
      throw UsageError(error.what(), "see 'catoptric ... --help'");
    } catch (const CLI::ParseError& error) {
      if (dynamic_cast<const CLI::Success*>(&error) != nullptr) throw;  // --help
      throw UsageError(error.what());
    }
    for (const Given& given : given_) {
      const Strings& values = given.option->results();
      if (values.size() > 1 && !given.repeatable)
        throw UsageError(given.option->get_name() + " is given more than once");
      for (const std::string& value : values) given.setter(value);
    }
  }

  [[nodiscard]] std::string help() const {
    std::string text = app_->help();
    for (auto at = text.find("\n\n\n"); at != std::string::npos; at = text.find("\n\n\n", at))
      text.erase(at, 1);
    return text;
  }

 private:
  struct Given {
    CLI::Option* option;
    Setter setter;
    bool repeatable;
  };

  void add(const std::string& names, const std::string& valueName, const std::string& help, Setter setter,
           bool isRepeatable) {
    storage_.push_back(std::make_unique<Strings>());
    CLI::Option* option =
        app_->add_option(names, *storage_.back(), help)->type_name(valueName)->group(heading_);
    option->expected(1)->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    given_.push_back({option, std::move(setter), isRepeatable});
  }

  [[nodiscard]] Strings longNames() const {
    Strings names;
    for (const CLI::Option* option : app_->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
  }

  /// "-output" would be read as "-o utput".
  void refuseSingleDashes(const Strings& line) const {
    const Strings known = longNames();
    for (const std::string& word : line) {
      if (word == "--") return;
      if (word.size() < 3 || word[0] != '-' || word[1] == '-') continue;
      const std::string name = "-" + word.substr(0, word.find('='));
      if (std::find(known.begin(), known.end(), name) != known.end())
        throw UsageError("unknown option '" + word + "'", "did you mean '" + name + "'?");
    }
  }

  [[noreturn]] void refuseExtras(const Strings& extras) const {
    for (const std::string& word : extras)
      if (word.size() > 1 && word[0] == '-') {
        const std::string name = word.substr(0, word.find('='));
        throw UsageError("unknown option '" + name + "'",
                         makeSuggestion(name, longNames(), "see '" + app_->get_name() + " --help'"));
      }
    throw UsageError("unexpected argument '" + (extras.empty() ? "" : extras.front()) + "'",
                     "see '" + app_->get_name() + " --help'");
  }

  std::unique_ptr<CLI::App> app_;
  std::string heading_ = "Options";
  std::vector<std::unique_ptr<Strings>> storage_;
  std::vector<Given> given_;
};

[[noreturn]] void refuseCommand(const std::vector<Command>& commands, const std::string& word) {
  Strings names;
  for (const Command& command : commands) names.push_back(command.name);
  if (word.starts_with("-")) throw UsageError("unknown option '" + word + "'", "see 'catoptric --help'");
  throw UsageError("unknown command '" + word + "'", makeSuggestion(word, names, "see 'catoptric --help'"));
}

}  // namespace

ParsedLine parseArguments(const std::vector<Command>& commands, const std::vector<std::string>& line) {
  ParsedLine parsed;
  if (line.empty()) throw UsageError("no command was given", "see 'catoptric --help'");
  const bool isHelpCommand = line[0] == "help" && line.size() > 1;
  const std::string& word = isHelpCommand ? line[1] : line[0];
  if (word == "-h" || word == "--help" || word == "help") {
    parsed.help = makeProgramHelp(commands);
    return parsed;
  }
  if (word == "--version") {
    parsed.version = true;
    return parsed;
  }
  const auto command =
      std::find_if(commands.begin(), commands.end(), [&](const Command& c) { return c.name == word; });
  if (command == commands.end()) refuseCommand(commands, word);
  Cli11Arguments arguments(*command);
  try {
    if (isHelpCommand) throw CLI::CallForHelp();
    arguments.parse({line.begin() + 1, line.end()});
    parsed.command = &*command;
  } catch (const CLI::Success&) {
    parsed.help = arguments.help();
  }
  return parsed;
}

std::string makeProgramHelp(const std::vector<Command>& commands) {
  std::string help =
      "catoptric shows what mirrors show: true reflections in flat and curved mirrors, drawn with a plain\n"
      "rasterizer, and how far each picture is from ray-traced truth, in pixels.\n\n"
      "Usage: catoptric COMMAND [OPTIONS]\n       catoptric FILE        (looks at it: catoptric view "
      "FILE)\n\nCommands:\n";
  for (const Command& command : commands)
    help += "  " + command.name + std::string(12 - std::min<std::size_t>(command.name.size(), 11), ' ') +
            command.summary + "\n";
  help +=
      "\nOptions:\n"
      "  -h, --help  Print this help and exit; 'catoptric COMMAND --help' for a command\n"
      "  --version   Print the version, the build, and the OpenGL and Embree in use, and exit\n"
      "\nSCENE is a glTF 2.0 file (.gltf, .glb), '-' for a .glb on standard input, or the name of a built-in "
      "scene.\n"
      "Exit code: 0 done, 1 failed, 2 wrong usage, 3 a comparison exceeded its limit.\n"
      "\nExamples:\n"
      "  catoptric scenes\n"
      "  catoptric view four-spheres\n"
      "  catoptric render four-spheres -o four-spheres.png\n"
      "  catoptric compare drivers-view -o report\n";
  return help;
}

}  // namespace catoptric::app

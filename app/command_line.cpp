// SPDX-License-Identifier: Apache-2.0
#include "command_line.h"

#include <exception>
#include <new>

#include "catoptric/core/error.h"
#include "commands.h"
#include "documents.h"
#include "terminal.h"

namespace catoptric::app {
namespace {

/// --json - asks for errors as JSON, too; that must work even when the line cannot be parsed.
bool wantsJsonOnStdout(const std::vector<std::string>& line) {
  for (std::size_t i = 0; i < line.size(); ++i)
    if (line[i] == "--json=-" || (line[i] == "--json" && i + 1 < line.size() && line[i + 1] == "-"))
      return true;
  return false;
}

int fail(const std::vector<std::string>& line, int exitCode, const core::Error& error) {
  sayError(error.what());
  if (wantsJsonOnStdout(line)) {
    try {
      printData(serialise(makeErrorDocument(error)));
    } catch (const core::Error&) {  // stdout is what failed; stderr has said it
    }
  }
  return exitCode;
}

/// `catoptric FILE` views it. A word without a dot or a slash is a command, or a slip in one.
std::vector<std::string> withViewCommand(std::vector<std::string> line) {
  const std::string& word = line.front();
  const bool isPath = word.find('.') != std::string::npos || word.find('/') != std::string::npos;
  if (isPath && !word.starts_with("-")) line.insert(line.begin(), "view");
  return line;
}

int runCommand(const std::vector<std::string>& line) {
  const std::vector<Command> commands{makeInfoCommand(),   makeRenderCommand(), makeCompareCommand(),
                                      makeBenchCommand(),  makeBakeCommand(),   makeDrawCommand(),
                                      makeScenesCommand(), makeViewCommand()};
  if (line.empty()) {
    setVerbosity(Verbosity::Normal);
    say(makeProgramHelp(commands));
    return kWrongUsage;
  }
  const ParsedLine parsed = parseArguments(commands, withViewCommand(line));
  if (parsed.version) printData(makeVersionText());
  if (!parsed.help.empty()) printData(parsed.help);
  return parsed.command == nullptr ? int(kDone) : parsed.command->run(line);
}

}  // namespace

int runCommandLine(const std::vector<std::string>& line) {
  try {
    return runCommand(line);
  } catch (const UsageError& error) {
    return fail(line, kWrongUsage, core::Error("usage", error.what(), {}, error.hint()));
  } catch (const core::Error& error) {
    return fail(line, kFailed, error);
  } catch (const std::bad_alloc&) {
    return fail(line, kFailed,
                core::Error("memory", "out of memory", {}, "try a smaller --size or fewer --samples"));
  } catch (const std::exception& error) {
    return fail(
        line, kFailed,
        core::Error("internal", std::string("unexpected: ") + error.what(), {}, "please report this"));
  }
}

}  // namespace catoptric::app

// SPDX-License-Identifier: Apache-2.0
#include "zexel_options.h"

#include "option_values.h"
#include "suggest.h"

namespace catoptric::app {
namespace {

using depth_reflection_map::Splat;
using depth_reflection_map::Visibility;

/// The place of a word in a list of words.
std::size_t findWord(const std::string& option, const std::string& text,
                     const std::vector<std::string>& words) {
  std::string all;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == text) return i;
    all.append(all.empty() ? "there are " : ", ").append(words[i]);
  }
  throw UsageError(option + ": there is no '" + text + "'", makeSuggestion(text, words, all));
}

}  // namespace

void declareZexels(Arguments& arguments, depth_reflection_map::ZexelOptions& options) {
  constexpr int kMostReferences = 4096, kLargestSize = 8192;
  arguments.group("Zexels (of the zexel method)");
  arguments.option("--zexel-references", "N", "Reference images warped per flat mirror, 1 or 2; default 2",
                   setInteger("--zexel-references", options.references, 1, 2));
  arguments.option("--zexel-hemisphere", "N", "Of how many behind a mirror; default 64",
                   setInteger("--zexel-hemisphere", options.hemisphere, 1, kMostReferences));
  arguments.option("--zexel-size", "N", "Zexels along a reference image's longer side; default 512",
                   setInteger("--zexel-size", options.size, 8, kLargestSize));
  arguments.option("--zexel-splat", "NAME", "What a zexel fills: point, square, footprint (default)",
                   [&](const std::string& text) {
                     options.splat = Splat(findWord("--zexel-splat", text, {"point", "square", "footprint"}));
                   });
  arguments.option(
      "--zexel-visibility", "NAME", "By order of warping (ordered, default) or by zbuffer",
      [&](const std::string& text) {
        options.visibility = Visibility(findWord("--zexel-visibility", text, {"ordered", "zbuffer"}));
      });
  arguments.option(
      "--zexel-memory", "BYTES", "Keep reference images up to this, as in 512M; default 512M",
      [&](const std::string& text) { options.maxBytes = parseByteCount("--zexel-memory", text); });
  arguments.option("--zexel-cache", "FILE", "Reference images are read from there, and new ones added",
                   setText(options.cacheFile));
  arguments.option(
      "--zexel-without", "A,B", "Switch off: hierarchy, regions, coherence, continuation",
      [&](const std::string& text) {
        for (const std::string& word : splitList(text)) {
          bool* const parts[] = {&options.isHierarchical, &options.skipsRegions, &options.isCoherent,
                                 &options.continuesSurfaces};
          *parts[findWord("--zexel-without", word, {"hierarchy", "regions", "coherence", "continuation"})] =
              false;
        }
      });
  arguments.flag("--zexel-mark", "Exposures in magenta instead: what no zexel, or no cube, has seen",
                 options.marksExposures);
}

}  // namespace catoptric::app

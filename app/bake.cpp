// SPDX-License-Identifier: Apache-2.0
// catoptric bake SCENE -o FILE: what reflection morphing needs of a scene, for every sampling location.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "catoptric/core/log.h"
#include "catoptric/core/progress.h"
#include "catoptric/reflection_morphing/baked_file.h"
#include "commands.h"
#include "documents.h"
#include "option_values.h"
#include "shared_options.h"
#include "terminal.h"

namespace catoptric::app {
namespace {

using reflection_morphing::BakedLocation;
using reflection_morphing::BakePlan;

constexpr int kMostRays = 4096, kMostDepth = 12, kMostBounces = 16;
constexpr int kMostCounts = 1 << 20;
constexpr std::uint64_t kMostLocations = std::uint64_t(1) << 32;

struct Options {
  std::string source, file;
  std::optional<core::Box> box;
  std::optional<glm::uvec3> counts;
  std::optional<double> spacing, maxErrorPx;
  int rays = 256, depth = 5, bounces = 1;
  bool keepStatic = false;
  SceneOptions scene;
  OutputOptions output;
};

/// "x0,y0,z0,x1,y1,z1"
core::Box parseBox(const std::string& option, const std::string& text) {
  const auto words = splitList(text);
  if (words.size() != 6) throw UsageError(option + ": '" + text + "' is not x0,y0,z0,x1,y1,z1");
  core::Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = parseNumber(option, words[std::size_t(axis)], -1e15, 1e15);
    box.upper[axis] = parseNumber(option, words[std::size_t(axis) + 3], -1e15, 1e15);
    if (!(box.lower[axis] < box.upper[axis]))
      throw UsageError(fmt::format("{}: '{}' is an empty box", option, text));
  }
  return box;
}

/// "8x4x8"
glm::uvec3 parseCounts(const std::string& option, const std::string& text) {
  glm::uvec3 counts(0);
  std::string rest = text;
  for (int axis = 0; axis < 3; ++axis) {
    const auto cross = rest.find('x');
    if ((cross == std::string::npos) != (axis == 2))
      throw UsageError(fmt::format("{}: '{}' is not three counts, as in 8x4x8", option, text));
    counts[axis] = std::uint32_t(parseInteger(option, rest.substr(0, cross), 2, kMostCounts));
    rest = axis == 2 ? "" : rest.substr(cross + 1);
  }
  return counts;
}

/// Counts as asked for, from the spacing, or from the error.
BakePlan makePlan(const Options& options, const scene::WorldGeometry& world) {
  if (int(options.counts.has_value()) + int(options.spacing.has_value()) +
          int(options.maxErrorPx.has_value()) >
      1)
    throw UsageError("--counts, --spacing and --max-error exclude each other");
  BakePlan plan = reflection_morphing::makeDefaultPlan(world);
  const core::Box box = options.box.value_or(plan.grid.box);
  const double error = options.maxErrorPx.value_or(reflection_morphing::kDefaultMaxErrorPx);
  const double needed = reflection_morphing::findSpacing(world, box, error);
  const bool isAsked = options.spacing || options.maxErrorPx;
  plan.grid =
      reflection_morphing::makeGrid(box, options.spacing.value_or(needed),
                                    isAsked ? kMostCounts - 1 : reflection_morphing::kMostDefaultCells);
  if (options.counts) plan.grid.counts = *options.counts;
  if (plan.grid.locationCount() > kMostLocations)
    throw UsageError("there would be more than 2^32 locations",
                     "choose a smaller --box or a larger --spacing");
  const dvec3 spacing = plan.grid.spacing();
  if (!options.counts && !isAsked && std::max({spacing.x, spacing.y, spacing.z}) > 1.001 * needed &&
      needed > 0)
    core::logWarningOnce(
        fmt::format("locations are up to {:.3g} m apart; {:.3g} m would be needed for {} px: name a smaller "
                    "--box, or --spacing",
                    std::max({spacing.x, spacing.y, spacing.z}), needed, error));
  plan.options.map.size = options.rays;
  plan.options.map.bounces = options.bounces;
  plan.options.map.keepStatic = options.keepStatic;
  plan.options.octree.depth = options.depth;
  return plan;
}

Json makeLocationsJson(const std::vector<BakedLocation>& locations) {
  Json rows = Json::array();
  for (const BakedLocation& l : locations)
    rows.push_back({{"position", makeJson(l.position)},
                    {"seconds", l.seconds > 0 ? Json(l.seconds) : Json(nullptr)},
                    {"bytes", l.bytes},
                    {"traces", l.traces},
                    {"rays", l.rays},
                    {"mean_leaf_rays", l.meanLeafRays},
                    {"most_leaf_rays", l.mostLeafRays}});
  return rows;
}

void sayResult(const Options& options, const std::vector<BakedLocation>& locations) {
  std::size_t bytes = 0, largest = 0, mostLeafRays = 0, timed = 0;
  double seconds = 0, leafRays = 0;
  for (const BakedLocation& l : locations) {
    bytes += l.bytes;
    largest = std::max(largest, l.bytes);
    mostLeafRays = std::max(mostLeafRays, l.mostLeafRays);
    leafRays += l.meanLeafRays / double(locations.size());
    seconds += l.seconds;
    if (l.seconds > 0) ++timed;
  }
  say(fmt::format(
      "wrote {} ({} locations, {:.1f} MB, at most {:.2f} MB each; rays a leaf: {:.1f}, at most {})",
      options.file, locations.size(), double(bytes) / 1e6, double(largest) / 1e6, leafRays, mostLeafRays));
  if (timed > 0)
    say(fmt::format("{:.2f} s of one thread for each of the {} locations baked now", seconds / double(timed),
                    timed));
}

int run(const Options& options) {
  applyOutput(options.output);
  if (options.file.empty()) throw UsageError("where to write to is missing", "add -o FILE");
  if (options.file == "-") throw UsageError("a baked file cannot go to standard output", "name a file");
  const auto loaded = loadScene(options.source, options.scene);
  const BakePlan plan = makePlan(options, loaded->geometry);
  std::vector<BakedLocation> locations;
  {
    core::Progress progress("baking", std::size_t(plan.grid.locationCount()));
    locations = reflection_morphing::bakeToFile(loaded->geometry, plan, options.file, progress);
  }
  sayResult(options, locations);
  if (options.output.json.empty()) return 0;
  Json document = makeDocument("bake", nullptr);
  document["scene"] = makeSceneJson(*loaded);
  document["grid"] = {{"lower", makeJson(plan.grid.box.lower)},
                      {"upper", makeJson(plan.grid.box.upper)},
                      {"counts", {plan.grid.counts.x, plan.grid.counts.y, plan.grid.counts.z}}};
  document["rays"] = options.rays;
  document["depth"] = options.depth;
  document["bounces"] = options.bounces;
  document["locations"] = makeLocationsJson(locations);
  writeDocument(options.output.json, document);
  return 0;
}

}  // namespace

Command makeBakeCommand() {
  const auto options = std::make_shared<Options>();
  return {
      .name = "bake",
      .summary = "Preprocess a scene for reflection morphing",
      .examples =
          "  catoptric bake columns -o columns.bake --box -1,0.6,1.6,1,1.6,3 --counts 6x4x5\n"
          "  catoptric render columns -o out.png --method morphing --baked columns.bake\n",
      .declare =
          [options](Arguments& arguments) {
            arguments.positional("SCENE", "A .gltf or .glb file, '-', or a built-in scene",
                                 Arguments::Count::ExactlyOne, setText(options->source));
            arguments.group("Baking");
            arguments.option("-o,--output", "FILE", "File to write; FILE.part is gone on with if it is there",
                             setText(options->file));
            arguments.option("--box", "X0,Y0,Z0,X1,Y1,Z1", "Where the eye will be; default: the scene's box",
                             [options](const std::string& text) { options->box = parseBox("--box", text); });
            arguments.option(
                "--counts", "NXxNYxNZ", "Sampling locations each way; default: from --max-error",
                [options](const std::string& text) { options->counts = parseCounts("--counts", text); });
            arguments.option("--spacing", "M", "Metres between sampling locations, instead of counts",
                             [options](const std::string& text) {
                               options->spacing = parseNumber("--spacing", text, 1e-9, 1e15);
                             });
            arguments.option("--max-error", "PX",
                             "Choose the counts for an error of PX on a mirror 700 px wide; default 0.5",
                             [options](const std::string& text) {
                               options->maxErrorPx = parseNumber("--max-error", text, 0.001, 100);
                             });
            arguments.option("--rays", "N", "Rays along an edge of each ray map; default 256",
                             setInteger("--rays", options->rays, 8, kMostRays));
            arguments.option("--depth", "N", "Levels of the ray octrees; default 5",
                             setInteger("--depth", options->depth, 0, kMostDepth));
            arguments.option("--bounces", "N", "Mirrors in mirrors, to this depth; default 1",
                             setInteger("--bounces", options->bounces, 1, kMostBounces));
            arguments.flag("--keep-static", "Rays end at diffuse objects, which then must not move",
                           options->keepStatic);
            declareScene(arguments, options->scene);
            declareOutput(arguments, options->output);
          },
      .run = [options](const std::vector<std::string>&) { return run(*options); }};
}

}  // namespace catoptric::app

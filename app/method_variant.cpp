// SPDX-License-Identifier: Apache-2.0
#include "method_variant.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catoptric/core/progress.h"
#include "option_values.h"
#include "shared_options.h"
#include "suggest.h"

namespace catoptric::app {
namespace {

using renderer::Method;
using renderer::Solver;

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const auto rank = std::size_t(std::ceil(share * double(values.size())));
  return values[std::max<std::size_t>(rank, 1) - 1];
}

FrameTimes summarise(const std::vector<renderer::FrameTimings>& frames,
                     const renderer::FrameCounters& counters, bool isMorphing) {
  const auto collect = [&](double renderer::FrameTimings::*member) {
    std::vector<double> values;
    values.reserve(frames.size());
    for (const renderer::FrameTimings& frame : frames) values.push_back(frame.*member);
    return values;
  };
  FrameTimes times;
  times.frames = int(frames.size());
  times.medianMs = quantile(collect(&renderer::FrameTimings::totalMs), 0.5);
  times.p95Ms = quantile(collect(&renderer::FrameTimings::totalMs), 0.95);
  times.primaryMs = quantile(collect(&renderer::FrameTimings::primaryMs), 0.5);
  times.reflectionMs = quantile(collect(&renderer::FrameTimings::reflectionMs), 0.5);
  const double verticesMs = quantile(collect(&renderer::FrameTimings::virtualVerticesMs), 0.5);
  if (verticesMs > 0) times.virtualVerticesPerS = double(counters.virtualVertices) / (0.001 * verticesMs);
  const double lookUpMs = quantile(collect(&renderer::FrameTimings::lookUpMs), 0.5);
  // A vertex counts once, when it has been through all traces.
  const auto traces = double(std::max<std::uint64_t>(counters.morphedTraces, 1));
  if (counters.lookedUpVertices > 0)
    times.dynamicVerticesPerS =
        double(counters.lookedUpVertices) / traces / (0.001 * (lookUpMs + verticesMs));
  else if (isMorphing && verticesMs > 0)
    times.staticVerticesPerS = double(counters.virtualVertices) / traces / (0.001 * verticesMs);
  times.warpMs = quantile(collect(&renderer::FrameTimings::warpMs), 0.5);
  if (times.warpMs > 0) times.zexelsPerS = double(counters.zexels) / (0.001 * times.warpMs);
  if (times.medianMs > 0) times.raysPerS = double(counters.rays) / (0.001 * times.medianMs);
  times.counters = counters;
  return times;
}

/// What stands behind a "+".
void addEnding(MethodVariant& variant, const std::string& method, const std::string& ending) {
  if (ending == "cpu" || ending == "gpu") {
    if (!renderer::hasSolvers(variant.method) || !renderer::hasVertexShader(variant.solver))
      throw UsageError("--methods: '" + method + "' has no vertex shader", "leave '+" + ending + "' out");
    variant.backend = ending == "gpu" ? renderer::Backend::Gpu : renderer::Backend::Cpu;
    variant.description += ", vertices on the " + ending;
    return;
  }
  if (!renderer::hasMerges(variant.method))
    throw UsageError("--methods: '" + method + "' has nothing to merge", "leave '+" + ending + "' out");
  variant.merge = parseMerge("--methods, after '+' (or cpu, gpu)", ending);
  variant.description += fmt::format(", merged by {}", ending);
}

}  // namespace

const std::vector<MethodVariant>& methodVariants() {
  static const std::vector<MethodVariant> variants{
      {"auto", "what each mirror needs", Method::Auto, Solver::Auto, true, false, false},
      {"none", "mirrors show the surroundings only", Method::None, Solver::Auto, true},
      {"environment-plain", "environment map of each mirror", Method::Environment, Solver::Auto, false},
      {"environment", "environment map, corrected by the box of the room", Method::Environment, Solver::Auto,
       true},
      {"virtual-explosion", "virtual objects, explosion maps as published", Method::Virtual,
       Solver::Explosion, true},
      {"virtual-layered", "virtual objects, explosion maps at eight radii", Method::Virtual, Solver::Layered,
       true},
      {"virtual-refined", "virtual objects, reflection points polished", Method::Virtual, Solver::Refined,
       true},
      {"virtual-analytic", "virtual objects, closed forms where the shape is known", Method::Virtual,
       Solver::Analytic, true},
      {"virtual-exact", "virtual objects, each fragment tested by its ray", Method::Virtual, Solver::Exact,
       true},
      {"zexel", "warped reference images of flat mirrors, followed by rays for curved ones", Method::Zexel,
       Solver::Auto, true, false, false},
      {"morphing", "reflection morphing, vertices kept while the eye stays in its cell", Method::Morphing,
       Solver::Auto, true, false, false},
      {"morphing-dynamic", "reflection morphing, every vertex looked up in every frame", Method::Morphing,
       Solver::Auto, true, true, false},
      {"raytrace", "ray-traced truth", Method::RayTrace, Solver::Auto, true}};
  return variants;
}

std::vector<MethodVariant> defaultVariants() {
  std::vector<MethodVariant> chosen;
  for (const MethodVariant& variant : methodVariants())
    if (variant.byDefault) chosen.push_back(variant);
  return chosen;
}

std::string listMethodNames() {
  std::string names;
  for (const MethodVariant& variant : methodVariants()) names += (names.empty() ? "" : ", ") + variant.name;
  return names;
}

std::vector<MethodVariant> parseMethodList(const std::string& text) {
  std::vector<MethodVariant> chosen;
  std::vector<std::string> names;
  for (const MethodVariant& variant : methodVariants()) names.push_back(variant.name);
  for (const std::string& word : splitList(text)) {
    const std::size_t plus = std::min(word.find('+'), word.size());
    const auto at = std::find(names.begin(), names.end(), word.substr(0, plus));
    if (at == names.end())
      throw UsageError("--methods: there is no '" + word + "'",
                       makeSuggestion(word, names, "there are " + listMethodNames()));
    for (const MethodVariant& variant : chosen)
      if (variant.name == word) throw UsageError("--methods: '" + word + "' is named twice");
    chosen.push_back(methodVariants()[std::size_t(at - names.begin())]);
    chosen.back().name = word;
    for (std::size_t begin = plus; begin < word.size();) {
      const std::size_t end = std::min(word.find('+', begin + 1), word.size());
      addEnding(chosen.back(), word.substr(0, plus), word.substr(begin + 1, end - begin - 1));
      begin = end;
    }
  }
  return chosen;
}

void checkVariants(const renderer::FrameOptions& options, const std::vector<MethodVariant>& variants) {
  if (options.backend != renderer::Backend::Auto &&
      std::none_of(variants.begin(), variants.end(), [](const MethodVariant& variant) {
        return renderer::hasSolvers(variant.method) && renderer::hasVertexShader(variant.solver);
      }))
    throw UsageError("--backend: none of the methods has virtual vertices on both", "leave it out");
  checkMerge(options, std::any_of(variants.begin(), variants.end(), [&](const MethodVariant& variant) {
               return variant.merge.value_or(options.merge) == renderer::Merge::Texture;
             }));
}

renderer::FrameOptions withMethod(renderer::FrameOptions options, const MethodVariant& variant) {
  options.method = variant.method;
  options.solver = variant.solver;
  options.boxCorrected = variant.boxCorrected;
  options.allDynamic = variant.allDynamic;
  if (variant.merge) options.merge = *variant.merge;
  options.backend = variant.backend.value_or(options.backend);
  if (!variant.backend && !renderer::hasVertexShader(variant.solver))
    options.backend = renderer::Backend::Auto;
  return options;
}

std::vector<FrameTimes> timeInTurn(renderer::Renderer& renderer, const scene::Camera& camera,
                                   const renderer::FrameOptions& options,
                                   const std::vector<MethodVariant>& variants, int repeats,
                                   core::Progress& progress) {
  std::vector<std::vector<renderer::FrameTimings>> frames(variants.size());
  std::vector<renderer::FrameCounters> counters(variants.size());
  for (int round = 0; round < repeats; ++round)
    for (std::size_t i = 0; i < variants.size(); ++i) {
      renderer::FrameOptions frameOptions = withMethod(options, variants[i]);
      frameOptions.withSeen = false;
      const renderer::Frame frame = renderer.render(camera, frameOptions);
      frames[i].push_back(frame.timings);
      counters[i] = frame.counters;
      progress.advance();
    }
  std::vector<FrameTimes> times;
  for (std::size_t i = 0; i < variants.size(); ++i)
    times.push_back(summarise(frames[i], counters[i], variants[i].method == Method::Morphing));
  return times;
}

}  // namespace catoptric::app

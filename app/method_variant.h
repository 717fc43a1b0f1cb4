// SPDX-License-Identifier: Apache-2.0
// The ways of drawing that compare and bench put side by side, each under one name.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "arguments.h"
#include "catoptric/renderer/frame.h"

namespace catoptric::core {
class Progress;
}

namespace catoptric::app {

struct MethodVariant {
  std::string name;  ///< "environment-plain", "virtual-refined", ...
  std::string description;
  renderer::Method method = renderer::Method::Auto;
  renderer::Solver solver = renderer::Solver::Auto;
  bool boxCorrected = true;
  bool allDynamic = false;                     ///< of morphing: through all traces
  bool byDefault = true;                       ///< false: only where it is named
  std::optional<renderer::Merge> merge{};      ///< "virtual-refined+stencil"; none: as --merge says
  std::optional<renderer::Backend> backend{};  ///< "virtual-layered+gpu"; none: as --backend says
};

/// Slowest-looking last, after auto: none, environment-plain, environment, virtual-explosion,
/// virtual-layered, virtual-refined, virtual-analytic, virtual-exact, zexel, morphing, morphing-dynamic,
/// raytrace.
[[nodiscard]] const std::vector<MethodVariant>& methodVariants();
/// Those that are drawn where none is named.
[[nodiscard]] std::vector<MethodVariant> defaultVariants();

/// --methods A,B,C; a name may end in "+" and a name of --merge, and in "+cpu" or "+gpu". Throws UsageError
/// for one that is not there or is there twice.
[[nodiscard]] std::vector<MethodVariant> parseMethodList(const std::string& text);
[[nodiscard]] std::string listMethodNames();

/// Throws UsageError for a --texture-scale that none of them uses, and for a --backend that one of them
/// cannot have or none of them uses.
void checkVariants(const renderer::FrameOptions& options, const std::vector<MethodVariant>& variants);

[[nodiscard]] renderer::FrameOptions withMethod(renderer::FrameOptions options, const MethodVariant& variant);

/// Many frames of one variant.
struct FrameTimes {
  int frames = 0;
  double medianMs = 0, p95Ms = 0;          ///< of the whole frame
  double primaryMs = 0, reflectionMs = 0;  ///< medians of its parts
  double warpMs = 0;                       ///< median
  /// 0 where the variant has none; from the medians.
  double virtualVerticesPerS = 0, zexelsPerS = 0, raysPerS = 0;
  double dynamicVerticesPerS = 0, staticVerticesPerS = 0;  ///< of morphing: through all traces
  renderer::FrameCounters counters;
};

/// Times the variants in turn, A B C A B C, so that a slow moment of the machine falls on all. The caller has
/// rendered each once before (warm-up).
[[nodiscard]] std::vector<FrameTimes> timeInTurn(renderer::Renderer& renderer, const scene::Camera& camera,
                                                 const renderer::FrameOptions& options,
                                                 const std::vector<MethodVariant>& variants, int repeats,
                                                 core::Progress& progress);

}  // namespace catoptric::app

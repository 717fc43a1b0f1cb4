// SPDX-License-Identifier: Apache-2.0
#include "viewer/model.h"

#include <algorithm>
#include <cmath>

namespace catoptric::viewer {

void FrameHistory::add(const FrameResult& result) {
  const renderer::FrameTimings& times = result.frame->timings;
  Entry& entry = entries[count++ % kFrames];
  entry.primaryMs = float(times.primaryMs);
  entry.verticesMs = float(times.virtualVerticesMs + times.coverMs);
  entry.reflectionMs = std::max(0.0f, float(times.totalMs - times.primaryMs) - entry.verticesMs);
  entry.readMs = float(std::max(0.0, result.wholeMs - times.totalMs));
}

renderer::FrameOptions Model::frameOptions(const ivec2& windowPx) const {
  renderer::FrameOptions options = app::withMethod(view.frame, variants[view.variant]);
  options.widthPx = std::max(1, int(std::lround(float(windowPx.x) * view.resolution)));
  options.heightPx = std::max(1, int(std::lround(float(windowPx.y) * view.resolution)));
  return options;
}

renderer::MethodChoice Model::choiceOf(const scene::Reflector& reflector) const {
  if (frame.frame && geometry) {
    const auto& all = geometry->reflectors;
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const scene::Reflector& r) { return r.name == reflector.name; });
    const auto choice = frame.frame->choices.find(std::uint32_t(found - all.begin()));
    if (choice != frame.frame->choices.end()) return choice->second;
  }
  return renderer::Renderer::chooseMethod(reflector);
}

}  // namespace catoptric::viewer

// SPDX-License-Identifier: Apache-2.0
// Steps 2 to 4 of raster_frame.cpp: level by level, which mirrors the level before shows, and what each of
// them shows.
#include <algorithm>
#include <limits>

#include "catoptric/renderer/mirror_rects.h"
#include "catoptric/renderer/raster_frame.h"

namespace catoptric::renderer {
namespace {

/// The rectangle around all that the mirrors show.
gl::Scissor findUnion(const VisibleMirrors& mirrors) {
  ivec2 lower(std::numeric_limits<int>::max()), upper(0);
  for (const auto* chains : {&mirrors.chains, &mirrors.unfollowed})
    for (const raster::Chain& chain : *chains) {
      const ivec2 corner(chain.bounds.x, chain.bounds.y);
      lower = glm::min(lower, corner);
      upper = glm::max(upper, corner + ivec2(chain.bounds.width, chain.bounds.height));
    }
  return {lower.x, lower.y, upper.x - lower.x, upper.y - lower.y};
}

}  // namespace

void RasterFrame::renderMirror(raster::ReflectionMethod& method, raster::FrameContext& context,
                               const raster::Chain& chain, const raster::Level& parent,
                               raster::Level& target) {
  context.masking = mask_.begin(context.merge, chain, parent, target);
  method.render(context, chain, parent, target);
  mask_.end(chain, parent, target);
}

void RasterFrame::renderMirrors(raster::FrameContext& context, const VisibleMirrors& mirrors,
                                const raster::Level& parent, raster::Level& target,
                                const FrameOptions& options) {
  std::vector<std::pair<const raster::Chain*, raster::ReflectionMethod*>> single;
  std::vector<const raster::Chain*> together;
  const bool drawsFlat = virtual_.drawsFlat(context);
  for (const raster::Chain& chain : mirrors.chains) {
    raster::ReflectionMethod* method = pickMethod(context, chain, options);
    if (chain.level == 1 && method) lastMethods_[chain.last] = method;
    if (method == &planar_ && drawsFlat) method = &virtual_;
    if (context.addsTo && method == &virtual_)
      together.push_back(&chain);
    else
      single.emplace_back(&chain, method);
  }
  if (!together.empty())
    for (const raster::Chain* chain : virtual_.addTogether(context, std::move(together), parent))
      single.emplace_back(chain, &virtual_);
  for (const raster::Chain& chain : mirrors.unfollowed) single.emplace_back(&chain, nullptr);
  target.isDrawn = !mirrors.unfollowed.empty();
  if (single.empty()) return;
  target.clear(findUnion(mirrors));
  target.drawnRects = mirrors.rects;
  for (const auto& [chain, method] : single) {
    context.hasAdded = false;
    if (method)
      renderMirror(*method, context, *chain, parent, target);
    else
      unfollowed_.draw(scene_, *chain, parent, target, false);
    target.isDrawn = target.isDrawn || !context.hasAdded;
  }
}

/// Does the processor shade in some mirrors?
bool RasterFrame::shadesHere(const FrameOptions& options) const {
  return !numbersByGl_ && (options.method == Method::Auto || options.method == Method::Virtual);
}

int RasterFrame::renderLevels(raster::FrameContext& context, const FrameOptions& options, int mostLevels) {
  std::vector<raster::Chain> parents{raster::makeEyeChain()};
  int levelCount = 1;
  lastMirrors_ = 0;
  std::vector<gl::Scissor> mirrorRects;
  if (mostLevels > 0)
    mirrorRects = findMirrorRects(
        geometry_, raster::makeClipFromWorld(context.camera, context.nearPlane, context.jitterPx),
        options.widthPx, options.heightPx);
  const int levelsToLookAt = mirrorRects.empty() ? 0 : mostLevels;
  for (int level = 0; level < levelsToLookAt; ++level) {
    // 2
    const raster::Level& parent = *levels_[std::size_t(level)];
    VisibleMirrors mirrors = chains_.find(parent, parents, options.bounces, mirrorRects);
    mirrorRects.clear();
    if (level == 0) lastMirrors_ = mirrors.chains.size();
    if (mirrors.chains.empty() && mirrors.unfollowed.empty()) break;
    context.parentIds = chains_.ids();
    prepareLevels(level + 2, options);
    // 3, 4
    raster::Level& target = *levels_[std::size_t(level) + 1];
    target.withSeen = options.withSeen || options.drawsSeen;
    target.composesSeen = options.withSeen;
    target.isLast = level + 1 == mostLevels;
    const bool isAdded =
        target.isLast && !target.withSeen && options.merge == Merge::Ids && shadesHere(options);
    target.withIds = !target.isLast || options.merge != Merge::Ids || isAdded;
    context.addsTo = isAdded ? levels_[std::size_t(level)].get() : nullptr;
    renderMirrors(context, mirrors, parent, target, options);
    levelCount += target.isDrawn ? 1 : 0;
    parents = std::move(mirrors.chains);
  }
  return levelCount;
}

}  // namespace catoptric::renderer

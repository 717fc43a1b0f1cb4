// SPDX-License-Identifier: Apache-2.0
// Steps: 1 environment in the mirror direction, 2 mirrored eye (1998, eq. 1 and 2) and the reference images
// nearest to it, taken if they are not there yet, 3 warp them, the second where the first leaves exposures,
// 4 hand the winners to the GPU, which fetches point and colour.
#include "catoptric/depth_reflection_map/depth_reflection_map_method.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace catoptric::depth_reflection_map {
namespace {

/// From one hemisphere to the next larger one.
constexpr double kShellRatio = 1.2;

double shellRadius(const MirrorWindow& window, int shell) {
  return glm::length(window.half) * std::pow(kShellRatio, shell);
}

/// Width of a zexel on the mirror's plane in pixels of the view, the largest of the window's corners and
/// middle.
double measureZexelPx(const ReferenceCamera& reference, const Pinhole& view) {
  const dmat3 pixelFromWorld = glm::inverse(view.worldFromPixel);
  double largest = 0;
  for (const dvec2 share :
       {dvec2(0.5, 0.5), dvec2(0.15, 0.15), dvec2(0.85, 0.15), dvec2(0.15, 0.85), dvec2(0.85, 0.85)}) {
    const dvec3 zexel(share.x * reference.width, share.y * reference.height, 1.0);
    const dvec3 offset = reference.centre - view.centre;
    const auto project = [&](const dvec3& z) {
      return pixelFromWorld * (offset + reference.worldFromZexel * z);
    };
    const dvec3 h = project(zexel), right = project(zexel + dvec3(1, 0, 0)),
                up = project(zexel + dvec3(0, 1, 0));
    if (h.z <= 0 || right.z <= 0 || up.z <= 0) return 1.0;
    const dvec2 p(h / h.z);
    largest = std::max({largest, glm::length(dvec2(right / right.z) - p), glm::length(dvec2(up / up.z) - p)});
  }
  return largest;
}

/// The picture's pixels as rays of the mirrored eye: the camera behind its chain of flat mirrors.
Pinhole mirrorCamera(const raster::FrameContext& frame, const raster::Chain& chain) {
  const raster::PinholeView camera = raster::makePinholeView(frame.camera, frame.nearPlane, frame.jitterPx);
  const dmat4 drawFromScreen = glm::inverse(chain.screenFromDraw);
  return {dvec3(drawFromScreen * dvec4(camera.eye, 1.0)),
          dmat3(drawFromScreen) * dmat3(camera.rayDx, camera.rayDy, camera.rayOrigin)};
}

}  // namespace

DepthReflectionMapMethod::DepthReflectionMapMethod()
    : program_("raster/screen.vert", "depth_reflection_map/zexel_resolve.frag") {}

void DepthReflectionMapMethod::setOptions(const ZexelOptions& options) {
  if (options.hemisphere != options_.hemisphere || options.size != options_.size) {
    cache_.clear();
    windows_.clear();
  }
  cache_.setMaxBytes(options.maxBytes);
  inverse_.setOptions(options);
  options_ = options;
}

/// What an object's edge hides from an image on one side of the eye, an image on the other side shows. So of
/// all pairs of near images that is taken between which the eye lies best: near to both and to the line
/// between them.
void DepthReflectionMapMethod::pickPair(const dvec3& eye) {
  constexpr std::size_t kNear = 12;
  const std::size_t candidates = std::min(nearest_.size(), kNear);
  constexpr double kOffLine = 2.0;  // how much more the distance from the line counts
  double best = std::numeric_limits<double>::max();
  std::pair<std::size_t, std::size_t> pair(0, 1);
  for (std::size_t i = 0; i < candidates; ++i)
    for (std::size_t k = i + 1; k < candidates; ++k) {
      const dvec3 a = nearest_[i].centre, along = nearest_[k].centre - a;
      const double share = std::clamp(glm::dot(eye - a, along) / glm::dot(along, along), 0.0, 1.0);
      const double cost =
          nearest_[i].distance + nearest_[k].distance + kOffLine * glm::length(a + share * along - eye);
      if (cost < best) best = cost, pair = {i, k};
    }
  if (candidates < 2) return;
  const Nearest first = nearest_[pair.first], second = nearest_[pair.second];
  nearest_[0] = first, nearest_[1] = second;
}

DepthReflectionMapMethod::Window& DepthReflectionMapMethod::findNearest(const raster::FrameContext& frame,
                                                                        const raster::Chain& chain,
                                                                        const dvec3& mirroredEye) {
  const scene::Reflector& mirror = frame.scene.geometry().reflectors[chain.last];
  // The mirrored eye is behind the mirror; what it shows lies on the other side.
  const bool isFromBehind = mirror.plane.signedDistance(mirroredEye) > 0.0;
  const auto [slot, isNew] = windows_.try_emplace({chain.last, isFromBehind});
  Window& w = slot->second;
  if (isNew) w.window = makeMirrorWindow(frame.scene.geometry(), chain.last, isFromBehind ? -1.0 : 1.0);
  const double distance =
      std::max(glm::length(mirroredEye - w.window.centre), 1e-3 * glm::length(w.window.half));
  const int shell = int(std::lround(std::log(distance / shellRadius(w.window, 0)) / std::log(kShellRatio)));
  const core::Box& bounds = frame.scene.geometry().bounds;
  const dvec3 eye = mirroredEye - 2.0 * mirror.plane.signedDistance(mirroredEye) * mirror.plane.normal;
  const bool isInside =
      glm::all(glm::greaterThanEqual(eye, bounds.lower)) && glm::all(glm::lessThanEqual(eye, bounds.upper));
  const int key = 2 * shell + (isInside ? 0 : 1);
  Hemisphere& hemisphere = w.shells[key];
  if (hemisphere.centres.empty())
    hemisphere = makeHemisphere(w.window, shellRadius(w.window, shell), options_.hemisphere,
                                isInside ? &bounds : nullptr);
  spacing_ = hemisphere.spacing;
  nearest_.clear();
  for (std::size_t i = 0; i < hemisphere.centres.size(); ++i)
    nearest_.push_back({{chain.last, isFromBehind, key, int(i)},
                        hemisphere.centres[i],
                        glm::length(hemisphere.centres[i] - mirroredEye)});
  std::sort(nearest_.begin(), nearest_.end(),
            [](const Nearest& a, const Nearest& b) { return a.distance < b.distance; });
  if (options_.references > 1) pickPair(mirroredEye);
  nearest_.resize(std::min(nearest_.size(), std::size_t(options_.references)));
  return w;
}

void DepthReflectionMapMethod::warpReferences(raster::FrameContext& frame, const Pinhole& view,
                                              const PixelRectangle& rectangle) {
  std::uint32_t tag = 0;
  for (const Nearest& nearest : nearest_) {
    const MirrorWindow& window = windows_.at({nearest.key.reflector, nearest.key.isFromBehind}).window;
    const ReferenceCamera camera = makeReferenceCamera(window, nearest.centre, 0.5 * spacing_, options_.size);
    const ReferenceImage& image = cache_.take(frame, nearest.key, camera);
    if (tag == 0) {
      const double zexelPx = options_.isHierarchical ? measureZexelPx(camera, view) : 1.0;
      level_ = std::clamp(int(std::floor(-std::log2(std::max(zexelPx, 1e-9)))), 0,
                          int(image.map.levels.size()) - 1);
    }
    const auto start = std::chrono::steady_clock::now();
    const WarpOptions warp{options_.splat, options_.visibility, level_, options_.skipsRegions};
    frame.counters.zexels += warp_.warp(image.map, {camera.centre, camera.worldFromZexel}, view, rectangle,
                                        tag, warp, tag == 0 ? winners_ : secondWinners_);
    if (tag > 0) fillExposures(secondWinners_, winners_);
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
    frame.counters.warpMs += spent.count();
    ++tag;
  }
}

void DepthReflectionMapMethod::closeExposures(raster::FrameContext& frame, const raster::Chain& chain,
                                              const Pinhole& view, Window& window) {
  if (options_.isCoherent && !options_.marksExposures) {
    std::array<std::uint32_t, 4> tags{kNoTag, kNoTag, kNoTag, kNoTag};
    for (std::size_t before = 0; before < window.lastKeys.size(); ++before)
      for (std::size_t now = 0; now < nearest_.size(); ++now)
        if (nearest_[now].key == window.lastKeys[before]) tags[before] = std::uint32_t(now);
    keepLastFrame(window.lastWinners, tags, winners_);
  }
  const MirrorPixels mirror{frame.parentIds, frame.camera.widthPx, chain.parentWord()};
  const Coverage coverage = measureCoverage(winners_, mirror);
  frame.counters.zexelPixels += coverage.pixels;
  frame.counters.uncoveredPixels += coverage.uncovered;
  window.lastWinners = winners_;
  window.lastKeys.clear();
  for (const Nearest& nearest : nearest_) window.lastKeys.push_back(nearest.key);
  if (options_.marksExposures) return markExposures(mirror, winners_);
  if (!options_.continuesSurfaces || coverage.uncovered == 0) return;
  continueSurfaces(mirror, winners_, [&](std::uint32_t winner) {
    const ReferenceImage& image = cache_.get(nearest_[winner >> kWinnerTagShift].key);
    const auto zexel = int((winner & kWinnerIndexMask) - 1u), width = image.map.width;
    const int column = zexel % width, row = zexel / width;
    const double disparity = image.map.levels[0].disparities[std::size_t(zexel)];
    const dvec3 point = image.camera.centre + image.camera.worldFromZexel *
                                                  dvec3(column + 0.5, row + 0.5, 1.0) /
                                                  std::max(disparity, 1e-30);
    return disparity > 0 ? glm::length(point - view.centre) : 0.0;
  });
}

void DepthReflectionMapMethod::resolve(const raster::Chain& chain, const raster::Level& parent,
                                       const raster::Level& target) {
  const int width = target.widthPx + 2 * WinnerImage::kBorder,
            height = target.heightPx + 2 * WinnerImage::kBorder;
  if (!winnersTexture_ || winnersTexture_->width() != width || winnersTexture_->height() != height)
    winnersTexture_ = std::make_unique<gl::Texture>(gl::TextureKind::Flat, gl::Format::R32Ui, width, height,
                                                    1, 1, gl::SamplerState{});
  winnersTexture_->uploadCorner(winners_.stride, winners_.rows, winners_.winners.data());
  target.surfaces.bind();
  gl::setScissor(chain.bounds);
  gl::setDrawState({.depthTest = false, .depthWrite = false});
  program_.use();
  parent.bindAsParent(program_);
  int unit = raster::kUnitFirstFree + 4;
  winnersTexture_->bind(unit);
  program_.set("u_winners", unit++);
  program_.set("u_winnersCorner", vec2(winners_.rectangle.x - WinnerImage::kBorder,
                                       winners_.rectangle.y - WinnerImage::kBorder));
  program_.set("u_lod", float(level_));
  program_.set("u_count", int(nearest_.size()));
  program_.set("u_parentWord", chain.parentWord());
  program_.set("u_chain", chain.id);
  for (int i = 0; i < 2; ++i) {
    const Nearest& nearest = nearest_[std::min(std::size_t(i), nearest_.size() - 1)];
    const ReferenceImage& image = cache_.get(nearest.key);
    const std::string suffix(1, char('0' + i));
    image.color.bind(unit);
    program_.set("u_color" + suffix, unit++);
    image.zexels.bind(unit);
    program_.set("u_zexels" + suffix, unit++);
    program_.set("u_zexelFromWorld" + suffix, mat4(dmat4(glm::inverse(image.camera.worldFromZexel))));
    program_.set("u_centre" + suffix, vec3(image.camera.centre));
  }
  nothing_.bind();
  gl::drawScreen();
}

void DepthReflectionMapMethod::render(raster::FrameContext& frame, const raster::Chain& chain,
                                      const raster::Level& parent, raster::Level& target) {
  if (chain.curved) {
    background_.draw(frame.scene, chain, parent, target);
    inverse_.render(frame, chain, parent, target);
    return;
  }
  // 2, before 1: taking an image draws.
  const Pinhole view = mirrorCamera(frame, chain);
  Window& window = findNearest(frame, chain, view.centre);
  // 3
  warpReferences(frame, view, {chain.bounds.x, chain.bounds.y, chain.bounds.width, chain.bounds.height});
  closeExposures(frame, chain, view, window);
  // 1
  background_.draw(frame.scene, chain, parent, target);
  // 4
  resolve(chain, parent, target);
}

}  // namespace catoptric::depth_reflection_map

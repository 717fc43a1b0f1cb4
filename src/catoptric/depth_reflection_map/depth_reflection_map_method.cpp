// SPDX-License-Identifier: Apache-2.0
// Steps: 1 environment in the mirror direction, 2 mirrored eye (1998, eq. 1 and 2) and the reference images
// nearest to it, taken if they are not there yet, 3 warp them, the second where the first leaves exposures,
// 4 hand the winners to the GPU, which fetches point and colour.
#include "catoptric/depth_reflection_map/depth_reflection_map_method.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace catoptric::depth_reflection_map {
namespace {

/// From one hemisphere to the next larger one.
constexpr double kShellRatio = 1.35;

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
  std::vector<dvec3>& centres = w.shells[shell];
  if (centres.empty()) centres = makeHemisphere(w.window, shellRadius(w.window, shell), options_.hemisphere);
  nearest_.clear();
  for (std::size_t i = 0; i < centres.size(); ++i)
    nearest_.push_back(
        {{chain.last, isFromBehind, shell, int(i)}, centres[i], glm::length(centres[i] - mirroredEye)});
  const std::size_t count = std::min(nearest_.size(), std::size_t(options_.references));
  std::partial_sort(nearest_.begin(), nearest_.begin() + std::ptrdiff_t(count), nearest_.end(),
                    [](const Nearest& a, const Nearest& b) { return a.distance < b.distance; });
  nearest_.resize(count);
  return w;
}

void DepthReflectionMapMethod::warpReferences(raster::FrameContext& frame, const Pinhole& view,
                                              const PixelRectangle& rectangle) {
  std::uint32_t tag = 0;
  for (const Nearest& nearest : nearest_) {
    const MirrorWindow& window = windows_.at({nearest.key.reflector, nearest.key.isFromBehind}).window;
    const double spacing =
        shellRadius(window, nearest.key.shell) * std::sqrt(2.0 * glm::pi<double>() / options_.hemisphere);
    const ReferenceCamera camera = makeReferenceCamera(window, nearest.centre, 0.5 * spacing, options_.size);
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

/// Colour coherence (1998, section 4.1): a pixel that nothing reached keeps the zexel that it showed in the
/// frame before, as far as the same reference images are still in use.
void DepthReflectionMapMethod::keepLastFrame(Window& window) {
  const PixelRectangle &r = winners_.rectangle, &last = window.lastWinners.rectangle;
  std::array<std::uint32_t, 4> tags{4, 4, 4, 4};
  for (std::size_t before = 0; before < window.lastKeys.size(); ++before)
    for (std::size_t now = 0; now < nearest_.size(); ++now)
      if (nearest_[now].key == window.lastKeys[before]) tags[before] = std::uint32_t(now);
  const int x0 = std::max(r.x, last.x), x1 = std::min(r.x + r.width, last.x + last.width);
  const int y0 = std::max(r.y, last.y), y1 = std::min(r.y + r.height, last.y + last.height);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      std::uint32_t& winner = winners_.at(x - r.x, y - r.y);
      if (winner != 0) continue;
      const std::uint32_t before = window.lastWinners.at(x - last.x, y - last.y);
      const std::uint32_t tag = tags[before >> kWinnerTagShift];
      if (before != 0 && tag < 4) winner = (before & kWinnerIndexMask) | (tag << kWinnerTagShift);
    }
}

void DepthReflectionMapMethod::countCoverage(raster::FrameContext& frame, const raster::Chain& chain) const {
  const PixelRectangle& r = winners_.rectangle;
  const std::uint32_t word = chain.parentWord();
  std::uint64_t mirror = 0, uncovered = 0;
  for (int y = 0; y < r.height; ++y) {
    const uvec2* ids =
        frame.parentIds.data() + std::size_t(r.y + y) * std::size_t(frame.camera.widthPx) + r.x;
    for (int x = 0; x < r.width; ++x) {
      const bool isMirror = ids[x].y == word;
      mirror += isMirror ? 1 : 0;
      uncovered += isMirror && winners_.at(x, y) == 0 ? 1 : 0;
    }
  }
  frame.counters.zexelPixels += mirror;
  frame.counters.uncoveredPixels += uncovered;
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
    program_.set("u_worldFromZexel" + suffix, mat4(dmat4(image.camera.worldFromZexel)));
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
  if (options_.isCoherent) keepLastFrame(window);
  countCoverage(frame, chain);
  // 1
  background_.draw(frame.scene, chain, parent, target);
  // 4
  resolve(chain, parent, target);
  std::swap(window.lastWinners, winners_);
  window.lastKeys.clear();
  for (const Nearest& nearest : nearest_) window.lastKeys.push_back(nearest.key);
}

}  // namespace catoptric::depth_reflection_map

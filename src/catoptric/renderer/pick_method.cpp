// SPDX-License-Identifier: Apache-2.0
// Which method draws what a chain of mirrors shows: the table of methods. For `auto` and a curved mirror that
// is seen directly choose_method.h decides, else the method that is named, or the mirror's shape.
#include <fmt/format.h>

#include "catoptric/core/log.h"
#include "catoptric/renderer/raster_frame.h"

namespace catoptric::renderer {
namespace {

constexpr double kLeastMove = 0.02;  // of the way to the mirror's centre: from there on it is chosen anew

}  // namespace

/// Hybrid reflectors (2004, section 7): large parts are morphed, small ones get environment maps, unless the
/// user says otherwise.
bool RasterFrame::isMapped(const raster::Chain& chain, const FrameOptions& options) const {
  const scene::Reflector& mirror = geometry_.reflectors[chain.last];
  const bool isSmall = chain.pixels < std::uint64_t(options.mappedBelowPixels);
  const bool mapped = mirror.morphed ? !*mirror.morphed : isSmall;
  if (mapped)
    core::logInfo(fmt::format(
        "reflector '{}': environment map, {}", mirror.name,
        mirror.morphed ? "by " + mirror.morphedReason
                       : fmt::format("{} pixels, fewer than {}", chain.pixels, options.mappedBelowPixels)));
  return mapped;
}

raster::ReflectionMethod* RasterFrame::pickMethod(const raster::FrameContext& context,
                                                  const raster::Chain& chain, const FrameOptions& options) {
  if (options.method == Method::Environment) return &environment_;
  if (chain.hasRefractor()) {
    if (options.method == Method::Morphing && morphing_.supports(chain)) return &morphing_;
    return &exact_;
  }
  if (options.method == Method::Zexel && zexel_.supports(chain)) return &zexel_;
  const bool isMorphing = options.method == Method::Morphing;
  if (isMorphing && chain.curved && isMapped(chain, options)) return &environment_;
  const bool isAuto = options.solver == Solver::Auto;
  if (isAuto && !isMorphing && chain.level == 1 && chain.curved && chain.pixels < std::uint64_t(kFewPixels) &&
      !hasMoved_)
    return &smallMaps_;
  if (options.method == Method::Auto && isAuto && chain.level == 1 && chain.curved && !hasMoved_)
    return chooseByView(context, chain, options);
  const bool needsExact =
      chain.curved && Renderer::chooseMethod(geometry_.reflectors[*chain.curved]).solver == Solver::Exact;
  // A vertex has a reflection point in one curved mirror; what two of them show is found by the pixels' rays.
  const bool wantsExact = options.solver == Solver::Exact || (isAuto && needsExact) ||
                          (chain.hasSecondCurved && (isAuto || options.solver == Solver::Refined));
  if (!isMorphing && wantsExact && exact_.supports(chain)) return &exact_;
  raster::ReflectionMethod* curved = &virtual_;
  if (isMorphing) curved = &morphing_;
  const std::array<raster::ReflectionMethod*, 3> table{&planar_, curved, &environment_};
  for (raster::ReflectionMethod* candidate : table)
    if (candidate->supports(chain)) return candidate;
  return nullptr;
}

raster::ReflectionMethod* RasterFrame::chooseByView(const raster::FrameContext& context,
                                                    const raster::Chain& chain, const FrameOptions& options) {
  const MethodChoice choice =
      options.isPassing ? lastChoice(chain.last) : askForChoice(context, chain.last, options);
  if (choice.method == Method::Environment) return &environment_;
  return choice.solver == Solver::Exact ? static_cast<raster::ReflectionMethod*>(&exact_) : &virtual_;
}

/// Of whatever view; by shape where none was asked about.
MethodChoice RasterFrame::lastChoice(std::uint32_t reflector) const {
  const auto found = chosen_.find(reflector);
  return found != chosen_.end() ? found->second.choice
                                : Renderer::chooseMethod(geometry_.reflectors[reflector]);
}

const MethodChoice& RasterFrame::askForChoice(const raster::FrameContext& context, std::uint32_t reflector,
                                              const FrameOptions& options) {
  const scene::CameraFrame& camera = context.camera;
  const ChoiceOptions asked{.maxErrorPx = options.maxErrorPx,
                            .bounces = options.bounces,
                            .boxCorrected = options.boxCorrected,
                            .mapTexels = options.environmentMapSize,
                            .levels = scene_.levelsSoFar(),
                            .isForFrame = true};  // pickMethod() has seen to smaller ones
  const double pixelsPerTangent = 0.5 * camera.heightPx / camera.tanHalfFovY;
  if (!chooser_) chooser_ = std::make_unique<MethodChooser>(geometry_, exact_.findHierarchy(context));
  const auto found = chosen_.find(reflector);
  Chosen* last = found == chosen_.end() || found->second.options != asked ? nullptr : &found->second;
  const double way = glm::length(camera.eye - geometry_.reflectors[reflector].centre);
  if (!last || last->pixelsPerTangent != pixelsPerTangent ||
      glm::length(camera.eye - last->eye) > kLeastMove * way) {
    MethodChoice choice = chooser_->choose(reflector, camera, asked, last ? &last->choice : nullptr);
    chosen_[reflector] = {std::move(choice), camera.eye, pixelsPerTangent, asked};
  }
  return chosen_[reflector].choice;
}

}  // namespace catoptric::renderer

// SPDX-License-Identifier: Apache-2.0
// Frames by a method, and the truth in passes: a quarter of the size, half, full with what is seen, then more
// samples. Coarse passes are there within a moment, and a new view interrupts between two of them.
#include <algorithm>
#include <chrono>

#include "catoptric/core/file.h"
#include "catoptric/core/image_io.h"
#include "catoptric/core/tone_map.h"
#include "viewer/jobs.h"

namespace catoptric::viewer {
namespace {

struct Pass {
  int divisor, samples;
};
constexpr Pass kPasses[kTruthPasses] = {{4, 1}, {2, 1}, {1, 1}, {1, 4}, {1, 16}};

renderer::Frame render(KeptRenderer& kept, const FrameRequest& view, const renderer::FrameOptions& options) {
  try {
    return kept.prepare(view.scene, view.state).render(view.camera, options);
  } catch (...) {
    kept.drop();
    throw;
  }
}

void record(const FrameResult& result) {
  if (result.request.recordFile.empty()) return;
  core::writeFileAtomically(result.request.recordFile,
                            std::span<const std::byte>(core::encodePng(result.picture)));
}

/// The renderer still has the frame that is asked about: it is the same thread's.
FrameResult drawElsewhere(KeptRenderer& kept, FrameResult result) {
  const ElsewhereRequest& elsewhere = *result.request.elsewhere;
  try {
    renderer::Renderer& renderer = kept.prepare(result.request.scene, result.request.state);
    result.picture =
        core::toneMap(renderer.renderElsewhere(elsewhere.camera, elsewhere.options), result.request.exposure);
  } catch (...) {
    kept.drop();
    throw;
  }
  return result;
}

TruthResult judge(const TruthRequest& request, const renderer::Frame& truth, TruthResult result) {
  if (result.isPreview) return result;
  const renderer::Frame& method = *request.method.frame;
  const core::ImageRgba8& picture = request.method.picture;
  if (truth.radiance.width() != picture.width() || method.seen.isEmpty() || truth.seen.isEmpty())
    return result;
  result.difference = metrics::makeDifferencePicture(picture, result.picture);
  result.imageDifference = metrics::compareImages(picture, result.picture);
  const metrics::DisplacementResult moved =
      metrics::computeDisplacement(method.seen, truth.seen, truth.footprints);
  result.displacement = metrics::makeDisplacementPicture(moved.displacementPx, picture);
  result.objectPixels = moved.objectPixels;
  result.mirrorPixels = moved.mirrorPixels;
  return result;
}

}  // namespace

FrameWorker::Work makeFrameWork() {
  const auto kept = std::make_shared<KeptRenderer>();
  kept->warmUp();
  return [kept](const FrameRequest& request) {
    const auto start = std::chrono::steady_clock::now();
    FrameResult result;
    result.request = request;
    if (request.elsewhere) return drawElsewhere(*kept, std::move(result));
    if (request.sceneCamera) {
      (void)kept->prepare(request.scene, request.state);
      result.request.camera = kept->posed().scene().cameras.at(*request.sceneCamera);
    }
    result.frame = std::make_shared<const renderer::Frame>(render(*kept, result.request, request.options));
    if (request.options.withSeen) result.geometry = kept->posed().snapshot();
    result.picture = core::toneMap(result.frame->radiance, request.exposure);
    result.wholeMs =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    record(result);
    return result;
  };
}

TruthWorker::Work makeTruthWork() {
  return [kept = std::make_shared<KeptRenderer>()](const TruthRequest& request) {
    const FrameRequest& view = request.method.request;
    if (!view.scene) {
      kept->forget();
      return TruthResult{};
    }
    const Pass pass = kPasses[std::clamp(request.pass, 0, kTruthPasses - 1)];
    renderer::FrameOptions options = view.options;
    options.method = renderer::Method::RayTrace;
    options.widthPx = std::max(1, options.widthPx / pass.divisor);
    options.heightPx = std::max(1, options.heightPx / pass.divisor);
    options.samples = pass.samples;
    const bool isPreview = request.method.frame == nullptr;
    options.withSeen = pass.divisor == 1 && pass.samples == 1 && !isPreview;
    options.cancel = request.cancel.get();
    const renderer::Frame truth = render(*kept, view, options);
    TruthResult result;
    result.scene = view.scene;
    result.isPreview = isPreview;
    result.view = view.view;
    result.pass = request.pass;
    result.samples = pass.samples;
    result.picture = core::toneMap(truth.radiance, view.exposure);
    // Figures compare one sample with one sample; more of them are for looking at.
    return judge(request, truth, std::move(result));
  };
}

}  // namespace catoptric::viewer

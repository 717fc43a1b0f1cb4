// SPDX-License-Identifier: Apache-2.0
#include "comparison.h"

#include <fmt/format.h>

#include <cmath>

#include "catoptric/core/image_io.h"
#include "catoptric/core/progress.h"
#include "catoptric/core/tone_map.h"
#include "data_address.h"
#include "pictures.h"

namespace catoptric::app {
namespace {

constexpr int kEmbeddedQuality = 90;

const MethodVariant& truthVariant() {
  return methodVariants().back();
}

/// Mirror pixels of either picture, or all others.
core::Image<std::uint8_t> makeMask(const core::SeenImage& a, const core::SeenImage& b, bool mirrors) {
  core::Image<std::uint8_t> mask(a.width(), a.height());
  for (std::size_t i = 0; i < mask.size(); ++i)
    mask.pixels()[i] = (a.pixels()[i].isMirror() || b.pixels()[i].isMirror()) == mirrors ? 1 : 0;
  return mask;
}

/// Draws with one method, compares with the truth, writes the pictures.
class ViewComparer {
 public:
  ViewComparer(const ComparisonOptions& options, const renderer::Frame& truth)
      : options_(options), truth_(truth), truthPicture_(core::toneMap(truth.radiance, options.exposure)) {}

  [[nodiscard]] ComparisonRow judge(const MethodVariant& variant, const renderer::Frame& frame) const {
    ComparisonRow row{.variant = variant,
                      .displacement = {},
                      .mirrors = {},
                      .primary = {},
                      .times = {},
                      .sizes = {},
                      .files = {},
                      .embedded = {}};
    const core::ImageRgba8 picture = core::toneMap(frame.radiance, options_.exposure);
    row.displacement = metrics::computeDisplacement(frame.seen, truth_.seen, truth_.footprints);
    row.mirrors = metrics::compareImages(picture, truthPicture_, makeMask(frame.seen, truth_.seen, true));
    row.primary = metrics::compareImages(picture, truthPicture_, makeMask(frame.seen, truth_.seen, false));
    keep(variant.name, picture, row.files.picture, row.embedded.picture);
    if (!row.isTruth()) {
      keep(variant.name + ".displacement",
           metrics::makeDisplacementPicture(row.displacement.displacementPx, truthPicture_),
           row.files.displacement, row.embedded.displacement);
      keep(variant.name + ".difference", metrics::makeDifferencePicture(picture, truthPicture_),
           row.files.difference, row.embedded.difference);
    }
    row.displacement.displacementPx = {};
    return row;
  }

 private:
  /// As a file beside the page, and as text within it.
  void keep(const std::string& name, const core::ImageRgba8& picture, std::string& file,
            std::string& embedded) const {
    file = options_.viewFolder + "/" + name + ".png";
    writePng((options_.folder / file).string(), picture);
    embedded = makeDataAddress("image/jpeg", core::encodeJpeg(picture, kEmbeddedQuality));
  }

  const ComparisonOptions& options_;
  const renderer::Frame& truth_;
  core::ImageRgba8 truthPicture_;
};

/// A figure of a set of pixels; null when the set is empty.
Json figure(std::uint64_t pixels, double value) {
  return pixels > 0 && std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json makeJson(const metrics::DisplacementStatistics& s) {
  return {{"pixels", s.pixels},
          {"median_px", figure(s.pixels, s.medianPx)},
          {"p95_px", figure(s.pixels, s.p95Px)},
          {"mean_px", figure(s.pixels, s.meanPx)},
          {"share_le_1px", figure(s.pixels, s.shareWithin1Px)},
          {"share_le_2px", figure(s.pixels, s.shareWithin2Px)},
          {"share_lost", figure(s.pixels, s.shareLost)}};
}

/// psnr_db is null for equal pictures, too: JSON has no infinity.
Json makeJson(const metrics::ImageDifference& d) {
  return {{"pixels", d.pixels},
          {"psnr_db", figure(d.pixels, d.psnrDb)},
          {"ssim", figure(d.pixels, d.ssim)},
          {"share_within_4", figure(d.pixels, d.shareWithin4)},
          {"mean_difference", figure(d.pixels, d.meanDifference)},
          {"largest_difference", figure(d.pixels, d.largestDifference)}};
}

std::string cell(std::uint64_t pixels, const char* format, double value) {
  return pixels > 0 ? fmt::format(fmt::runtime(format), value) : "-";
}

std::vector<std::string> makeCells(const Comparison& comparison, const ComparisonRow& row) {
  const auto &all = row.displacement.mirrorPixels, &objects = row.displacement.objectPixels;
  return {comparison.sceneName,
          row.variant.name,
          cell(all.pixels, "{:.2f}", all.medianPx),
          cell(all.pixels, "{:.1f}", 100 * all.shareWithin1Px),
          cell(all.pixels, "{:.1f}", 100 * all.shareLost),
          cell(objects.pixels, "{:.2f}", objects.medianPx),
          cell(objects.pixels, "{:.1f}", 100 * objects.shareWithin1Px),
          cell(objects.pixels, "{:.1f}", 100 * objects.shareLost),
          cell(row.mirrors.pixels, "{:.1f}", row.mirrors.psnrDb),
          cell(row.mirrors.pixels, "{:.3f}", row.mirrors.ssim),
          cell(row.primary.pixels, "{:.2f}", 100 * row.primary.shareWithin4),
          fmt::format("{:.1f}", row.times.medianMs)};
}

}  // namespace

namespace {

/// Each size by itself: warm-up, then in turn.
void timeSizes(renderer::Renderer& renderer, const scene::Camera& camera, const ComparisonOptions& options,
               const std::vector<MethodVariant>& variants, core::Progress& progress, Comparison& comparison) {
  for (const ivec2 size : options.sizes) {
    progress.describe(fmt::format("{}: timing at {}x{}", comparison.sceneName, size.x, size.y));
    renderer::FrameOptions frame = options.frame;
    frame.widthPx = size.x, frame.heightPx = size.y;
    static_cast<void>(timeInTurn(renderer, camera, frame, variants, 1, progress));
    const auto times = timeInTurn(renderer, camera, frame, variants, options.repeats, progress);
    for (std::size_t i = 0; i < times.size(); ++i) comparison.rows[i].sizes.push_back({size, times[i]});
  }
}

}  // namespace

std::size_t countSteps(const ComparisonOptions& options) {
  const std::size_t timed = std::size_t(options.repeats + 1) * (options.sizes.size() + 1);
  return (options.variants.size() + 1) * (1 + timed);
}

Comparison compareView(const LoadedScene& loaded, renderer::Renderer& renderer, const scene::Camera& camera,
                       const ComparisonOptions& options, core::Progress& progress) {
  Comparison comparison{loaded.name, loaded.source, camera, options.frame, {}};
  std::filesystem::create_directories(options.folder / options.viewFolder);
  renderer::FrameOptions frameOptions = withMethod(options.frame, truthVariant());
  frameOptions.withSeen = true;
  progress.describe(loaded.name + ": " + truthVariant().name);
  const renderer::Frame truth = renderer.render(camera, frameOptions);
  const ViewComparer comparer(options, truth);
  progress.advance();
  for (const MethodVariant& variant : options.variants) {
    progress.describe(loaded.name + ": " + variant.name);
    frameOptions = withMethod(frameOptions, variant);
    comparison.rows.push_back(comparer.judge(variant, renderer.render(camera, frameOptions)));
    progress.advance();
  }
  comparison.rows.push_back(comparer.judge(truthVariant(), truth));

  std::vector<MethodVariant> variants = options.variants;
  variants.push_back(truthVariant());
  progress.describe(loaded.name + ": timing");
  // Warm-up: frames that are not read back as far use programs of their own.
  static_cast<void>(timeInTurn(renderer, camera, options.frame, variants, 1, progress));
  const auto times = timeInTurn(renderer, camera, options.frame, variants, options.repeats, progress);
  for (std::size_t i = 0; i < times.size(); ++i) comparison.rows[i].times = times[i];
  timeSizes(renderer, camera, options, variants, progress, comparison);
  return comparison;
}

Json makeJson(const Comparison& comparison, const ComparisonRow& row) {
  const FrameTimes& times = row.times;
  const auto rate = [](double perSecond) { return perSecond > 0 ? Json(perSecond) : Json(nullptr); };
  Json json{{"scene", comparison.sceneName},
            {"source", comparison.source},
            {"camera", makeJson(comparison.camera)},
            {"name", row.variant.name},
            {"method", std::string(renderer::methodName(row.variant.method))},
            {"solver", std::string(renderer::solverName(row.variant.solver))},
            {"backend", renderer::backendName(withMethod(comparison.frame, row.variant).backend)},
            {"box_corrected", row.variant.boxCorrected},
            {"width", comparison.frame.widthPx},
            {"height", comparison.frame.heightPx},
            {"bounces", comparison.frame.bounces},
            {"merge", renderer::mergeName(row.variant.merge.value_or(comparison.frame.merge))},
            {"samples", comparison.frame.samples},
            {"displacement",
             {{"mirror_pixels", makeJson(row.displacement.mirrorPixels)},
              {"object_pixels", makeJson(row.displacement.objectPixels)}}}};
  const std::uint64_t mirrorPixels = row.displacement.mirrorPixels.pixels;
  json["coverage"] = {{"false_share", figure(mirrorPixels, row.displacement.falseCoverage)},
                      {"missed_share", figure(mirrorPixels, row.displacement.missedCoverage)}};
  json["image"] = makeJson(row.mirrors);
  json["primary"] = makeJson(row.primary);
  json["frames"] = times.frames;
  json["median_ms"] = times.medianMs;
  json["p95_ms"] = times.p95Ms;
  json["primary_ms"] = times.primaryMs;
  json["reflection_ms"] = times.reflectionMs;
  json["virtual_vertices"] = times.counters.virtualVertices;
  json["virtual_triangles"] = times.counters.virtualTriangles;
  json["fragment_tests"] = times.counters.fragmentTests;
  json["virtual_pixels"] = times.counters.virtualPixels;
  json["bounded_pixels"] = times.counters.boundedPixels;
  json["virtual_vertices_per_s"] = rate(times.virtualVerticesPerS);
  json["zexels"] = times.counters.zexels;
  json["zexels_per_s"] = rate(times.zexelsPerS);
  json["uncovered_share"] =
      figure(times.counters.zexelPixels, double(times.counters.uncoveredPixels) /
                                             double(std::max<std::uint64_t>(1, times.counters.zexelPixels)));
  json["rays"] = times.counters.rays;
  json["rays_per_s"] = rate(times.raysPerS);
  if (!row.sizes.empty()) json["sizes"] = Json::array();
  for (const SizedTimes& sized : row.sizes)
    json["sizes"].push_back({{"width", sized.sizePx.x},
                             {"height", sized.sizePx.y},
                             {"median_ms", sized.times.medianMs},
                             {"p95_ms", sized.times.p95Ms},
                             {"reflection_ms", sized.times.reflectionMs}});
  json["files"] = {{"picture", row.files.picture}};
  if (!row.files.displacement.empty()) json["files"]["displacement"] = row.files.displacement;
  if (!row.files.difference.empty()) json["files"]["difference"] = row.files.difference;
  return json;
}

std::vector<std::vector<std::string>> makeRows(const std::vector<Comparison>& comparisons) {
  std::vector<std::vector<std::string>> rows{{"scene", "method", "median px", "<=1px %", "lost %",
                                              "obj. median", "obj. <=1px %", "obj. lost %", "PSNR dB", "SSIM",
                                              "direct <=4 %", "ms"}};
  for (const Comparison& comparison : comparisons)
    for (const ComparisonRow& row : comparison.rows) rows.push_back(makeCells(comparison, row));
  return rows;
}

}  // namespace catoptric::app

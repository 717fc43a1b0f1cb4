// SPDX-License-Identifier: Apache-2.0
// One view of a scene, drawn by several methods and judged against ray-traced truth (methods.md, section 6).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "catoptric/metrics/displacement.h"
#include "catoptric/metrics/image_difference.h"
#include "documents.h"
#include "loaded_scene.h"
#include "method_variant.h"

namespace catoptric::app {

struct ComparisonFiles {
  std::string picture, displacement,
      difference;  ///< relative to the report's folder; empty where there is none
};

/// The same pictures as data: addresses (JPEG), for the page that carries them in itself.
using EmbeddedPictures = ComparisonFiles;

/// Frames of one variant at another size.
struct SizedTimes {
  ivec2 sizePx{0};
  FrameTimes times;
};

struct ComparisonRow {
  MethodVariant variant;
  metrics::DisplacementResult displacement;  ///< the image is not kept
  metrics::ImageDifference mirrors;          ///< pictures where method or truth shows a mirror
  metrics::ImageDifference primary;          ///< pictures everywhere else
  FrameTimes times;
  std::vector<SizedTimes> sizes;  ///< ComparisonOptions::sizes
  ComparisonFiles files;
  EmbeddedPictures embedded;

  [[nodiscard]] bool isTruth() const { return variant.method == renderer::Method::RayTrace; }
};

struct Comparison {
  std::string sceneName, source;
  scene::Camera camera;
  renderer::FrameOptions frame;
  std::vector<ComparisonRow> rows;  ///< the truth is the last one
};

struct ComparisonOptions {
  renderer::FrameOptions frame;
  float exposure = 1;
  std::vector<MethodVariant> variants;  ///< without the truth
  int repeats = 3;
  std::vector<ivec2> sizes{};    ///< at which the variants are timed besides, for time against resolution
  std::filesystem::path folder;  ///< of the report
  std::string viewFolder;        ///< below it, for the pictures of this view
};

/// Number of progress steps that compareView() takes.
[[nodiscard]] std::size_t countSteps(const ComparisonOptions& options);

/// Draws, measures and writes the pictures.
[[nodiscard]] Comparison compareView(const LoadedScene& loaded, renderer::Renderer& renderer,
                                     const scene::Camera& camera, const ComparisonOptions& options,
                                     core::Progress& progress);

/// A row of report.json.
[[nodiscard]] Json makeJson(const Comparison& comparison, const ComparisonRow& row);

/// The table, as printed and as on the page: heading first.
[[nodiscard]] std::vector<std::vector<std::string>> makeRows(const std::vector<Comparison>& comparisons);

}  // namespace catoptric::app

// SPDX-License-Identifier: Apache-2.0
// The four kinds of work that go on behind the window, each on a thread of its own (worker.h): load a scene,
// draw a frame by a method, trace the truth, fill explosion maps.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "catoptric/metrics/displacement.h"
#include "catoptric/metrics/image_difference.h"
#include "catoptric/renderer/frame.h"
#include "viewer/posed_scene.h"
#include "viewer/worker.h"

namespace catoptric::viewer {

/// How far the loading of a scene has come.
enum class LoadStep : std::uint8_t { Waiting, Scene, Surroundings, Drawing };

struct LoadRequest {
  std::string source, environment;              ///< as on the command line; no environment = the built-in sky
  std::vector<std::string> mirrors;             ///< names of the only reflectors; empty = all ...
  bool noReflectors = false;                    ///< ... or none
  bool keepsCamera = false;                     ///< the same scene again: the eye stays where it is
  std::shared_ptr<std::atomic<LoadStep>> step;  ///< told how far it is; may be null
};

struct LoadResult {
  LoadRequest request;
  ScenePointer scene;
  scene::Camera camera;                      ///< where the command line puts it
  std::vector<scene::Reflector> reflectors;  ///< all that the scene has, also when only some are mirrors now
  double durationS = 0;                      ///< of its animations; 0: none
  std::optional<double> timeS;               ///< to begin at; absent: the rest pose
};

struct ElsewhereRequest {
  scene::Camera camera;
  renderer::ElsewhereOptions options;
};

struct FrameRequest {
  ScenePointer scene;
  SceneState state;
  scene::Camera camera;
  std::optional<std::size_t> sceneCamera;  ///< the eye moves with this camera of the scene instead
  renderer::FrameOptions options;
  float exposure = 1;
  std::uint64_t view = 0;                           ///< counts what the user has changed
  std::chrono::steady_clock::time_point changed{};  ///< the first change that no frame before it shows
  double scale = 1;                                 ///< of the full resolution
  std::string recordFile;                           ///< write the picture there; empty: do not
  /// Instead of a frame: what the last one worked with, from another camera.
  std::optional<ElsewhereRequest> elsewhere;
};

struct FrameResult {
  FrameRequest request;  ///< its camera is where the eye was
  std::shared_ptr<const renderer::Frame> frame;
  GeometryPointer geometry;  ///< as drawn; only where the frame says what is seen
  core::ImageRgba8 picture;  ///< or that from elsewhere
  double wholeMs = 0;        ///< from request to picture, with reading back and tone mapping
};

struct TruthRequest {
  /// At rest: what is judged. Without a frame: the truth is shown until there is one. Without a scene: the
  /// last one is forgotten.
  FrameResult method;
  std::shared_ptr<std::atomic<bool>> cancel;  ///< made true when the view has changed; may be null
  int pass = 0;                               ///< 0 .. kTruthPasses - 1: coarse, full size, more samples
};
inline constexpr int kTruthPasses = 5;
inline constexpr int kPreviewPasses = 2;  ///< of which, before there is a frame: finer ones slow its coming

struct TruthResult {
  ScenePointer scene;
  bool isPreview = false;  ///< before there was a frame
  std::uint64_t view = 0;
  int pass = 0, samples = 1;
  core::ImageRgba8 picture;
  core::ImageRgba8 difference, displacement;  ///< and figures: of the pass with full size and one sample
  metrics::DisplacementStatistics objectPixels, mirrorPixels;
  metrics::ImageDifference imageDifference;
};

struct MapsRequest {
  GeometryPointer geometry;
  dvec3 eye{0};
  std::uint32_t reflector = 0;
};

/// Shares of a map's width and height, from the lower left corner; outside 0..1 it is not on the map.
struct MapPlaces {
  dvec2 explosion{0}, hidden{0};
};

struct MapsResult {
  MapsRequest request;
  bool canReflect = false;  ///< false: flat, or the eye sees none of its front
  core::ImageRgba8 nearMap, farMap, hiddenMap;
  std::function<MapPlaces(const dvec3& point)> findPlaces;  ///< where a scene point is looked up
  std::size_t triangles = 0;
};

using Load = std::function<LoadResult(const LoadRequest&)>;
using LoadWorker = Worker<LoadRequest, LoadResult>;
using FrameWorker = Worker<FrameRequest, FrameResult>;
using TruthWorker = Worker<TruthRequest, TruthResult>;
using MapsWorker = Worker<MapsRequest, MapsResult>;

[[nodiscard]] FrameWorker::Work makeFrameWork();
[[nodiscard]] TruthWorker::Work makeTruthWork();
[[nodiscard]] MapsWorker::Work makeMapsWork();

}  // namespace catoptric::viewer

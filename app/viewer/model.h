// SPDX-License-Identifier: Apache-2.0
// What the viewer knows: what the user has chosen, what the work behind the window has brought, and what the
// user wants done. Input and panels change it, the viewer acts on it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "method_variant.h"
#include "viewer/dragging.h"
#include "viewer/jobs.h"

namespace catoptric::viewer {

enum class Comparison : std::uint8_t { None, Split, Difference, Displacement };

/// What an edit goes to.
struct Selected {
  std::uint32_t instance = 0;
  int material = -1;
};

struct ViewState {
  scene::Camera camera, firstCamera;
  std::optional<std::size_t> sceneCamera;  ///< of the scene, which the eye moves with; `camera` follows it
  SceneState state;
  bool isPlaying = false;
  std::optional<Selected> selected;
  std::size_t variant = 0;       ///< row of Model::variants
  renderer::FrameOptions frame;  ///< method and solver are the variant's, the size is the window's
  float exposure = 1;
  float resolution = 1;  ///< of the window's pixels
  Comparison comparison = Comparison::None;
  float split = 0.5f;  ///< where the line is, share of the width
  bool showPanels = true, showHelp = false;
  std::optional<std::uint32_t> mapsOf;    ///< reflector whose explosion maps are shown
  std::optional<std::uint32_t> insideOf;  ///< and whose method is looked at from elsewhere ...
  scene::Camera elsewhere;                ///< ... by this camera ...
  ivec2 elsewherePx{520, 390};            ///< ... into a picture of this size
  raster::MarkOptions marks;
};

/// What is under the mouse.
struct Picked {
  ivec2 pixel{0};
  core::SeenPixel seen;
  std::optional<dvec3> reflectionPoint;  ///< on the first mirror
  double lawErrorDegrees = 0;  ///< between the mirrored ray and the way to the seen point; one bounce only
};

/// What the last frames took, oldest first.
struct FrameHistory {
  static constexpr std::size_t kFrames = 120;
  struct Entry {
    float primaryMs = 0, verticesMs = 0, reflectionMs = 0, readMs = 0;
    [[nodiscard]] float sum() const { return primaryMs + verticesMs + reflectionMs + readMs; }
  };
  std::array<Entry, kFrames> entries{};
  std::size_t count = 0;  ///< of all frames; the newest is entries[(count - 1) % kFrames]

  void add(const FrameResult& result);
  [[nodiscard]] const Entry* newest() const { return count == 0 ? nullptr : &entries[(count - 1) % kFrames]; }
};

/// An object that is being moved.
struct Drag {
  std::uint32_t instance = 0;
  dvec3 point{0};   ///< where it was taken, as moved so far
  dvec3 before{0};  ///< its shift at the start
};

/// Pictures of each frame, numbered, in a folder of their own.
struct Recording {
  std::string folder;
  int frames = 0;  ///< asked for so far
};

/// Done once by the viewer, then cleared.
struct Wishes {
  bool screenshot = false, copyCommand = false, close = false, viewChanged = false;
  bool undo = false, redo = false, saveSession = false, record = false;
  std::optional<LoadRequest> load;
};

struct Model {
  ViewState view;
  Wishes wishes;
  std::vector<app::MethodVariant> variants;
  std::vector<std::string> files;  ///< of a folder, to step through
  std::vector<std::string> sceneOptions;

  LoadResult loaded;         ///< its scene is null before the first is there
  GeometryPointer geometry;  ///< as in the last frame at rest, and the state it was in
  SceneState geometryState;
  EditHistory edits;
  std::optional<Drag> drag;
  dvec3 shiftBefore{0};  ///< of the value in a panel that is being changed
  scene::MaterialValues materialBefore;
  std::optional<Recording> recording;
  std::vector<std::string> environments;        ///< files that have surrounded a scene in this window
  std::vector<std::string> environmentsListed;  ///< to choose from
  std::shared_ptr<const std::atomic<LoadStep>> loadStep;
  std::string loadingName;
  std::chrono::steady_clock::time_point loadStart{};
  bool isLoading = false, isDrawing = false, isTracing = false;
  FrameResult frame;                   ///< its picture is what is shown
  std::optional<TruthResult> preview;  ///< is shown instead, before there is a frame of the scene
  std::optional<TruthResult> truth;
  std::optional<MapsResult> maps;
  std::optional<Picked> picked;
  FrameHistory history;
  std::string message;
  bool isError = false;

  [[nodiscard]] bool truthIsCurrent() const { return truth && truth->view == frame.request.view; }
  /// The options of a frame that fills the window.
  [[nodiscard]] renderer::FrameOptions frameOptions(const ivec2& windowPx) const;
  /// How `auto` draws it: as in the last frame, or else as its shape says.
  [[nodiscard]] renderer::MethodChoice choiceOf(const scene::Reflector& reflector) const;
};

}  // namespace catoptric::viewer

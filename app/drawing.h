// SPDX-License-Identifier: Apache-2.0
// What `catoptric draw` can show: one table, a function for each.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "catoptric/renderer/frame.h"
#include "catoptric/sketch/sketch.h"
#include "documents.h"
#include "loaded_scene.h"

namespace catoptric::app {

struct DrawingOptions {
  std::string what;
  std::optional<dvec3> from, at;  ///< the third eye; absent: aside and above
  double fromFovDegrees = 40;
  std::vector<dvec3> points;
  std::vector<std::string> objects;  ///< names of instances; empty: all
  int count = 12;                    ///< rays, or texels along an edge of a reflection cell
  double width = 0;                  ///< world units; 0: as each picture finds fit
  double spacing = 0.3;              ///< of sampling locations, metres
};

/// All that the functions of the table work with.
struct Drawing {
  LoadedScene& loaded;
  renderer::Renderer& renderer;
  scene::Camera camera;          ///< of the viewer
  renderer::FrameOptions frame;  ///< size, bounces
  float exposure = 1;
  DrawingOptions options;
  Json facts = Json::object();  ///< for --json

  [[nodiscard]] const scene::WorldGeometry& world() const { return loaded.geometry; }
  [[nodiscard]] scene::CameraFrame viewer() const {
    return scene::makeCameraFrame(camera, frame.widthPx, frame.heightPx);
  }
};

struct DrawingKind {
  std::string_view name, help;
  core::ImageRgba8 (*draw)(Drawing&);
  std::string uses;  ///< which options mean something to it, besides the scene, its camera and the size
};

[[nodiscard]] const std::vector<DrawingKind>& drawingKinds();

/// The first curved reflector, or the first flat one where `flat`. Throws core::Error("draw.no_reflector").
[[nodiscard]] std::uint32_t findReflector(const Drawing& drawing, bool flat);

/// The sketch over the scene as the third eye sees it, faded.
[[nodiscard]] core::ImageRgba8 drawFromAside(Drawing& drawing, const sketch::Sketch& sketch,
                                             const dvec3& middle);
/// The sketch over the viewer's own picture by `method`; lines show wherever they are.
[[nodiscard]] core::ImageRgba8 drawOverView(Drawing& drawing, const sketch::Sketch& sketch,
                                            renderer::Method method, float fading);

// What is drawn, by paper: drawing_mirrors.cpp, drawing_morphing.cpp, drawing_zexels.cpp.
[[nodiscard]] core::ImageRgba8 drawExplosionMaps(Drawing& drawing);
[[nodiscard]] core::ImageRgba8 drawSubdivision(Drawing& drawing);
[[nodiscard]] core::ImageRgba8 drawMapping(Drawing& drawing);
[[nodiscard]] core::ImageRgba8 drawNearLookUp(Drawing& drawing);
[[nodiscard]] core::ImageRgba8 drawLookUp(Drawing& drawing);
[[nodiscard]] core::ImageRgba8 drawCell(Drawing& drawing);
[[nodiscard]] core::ImageRgba8 drawVirtualObject(Drawing& drawing);
[[nodiscard]] core::ImageRgba8 drawCameraRays(Drawing& drawing);
[[nodiscard]] core::ImageRgba8 drawSamplingCell(Drawing& drawing);
[[nodiscard]] core::ImageRgba8 drawRayOctree(Drawing& drawing);
[[nodiscard]] core::ImageRgba8 drawReflectionMesh(Drawing& drawing);
[[nodiscard]] core::ImageRgba8 drawReflectionCell(Drawing& drawing);
[[nodiscard]] core::ImageRgba8 drawMappedRays(Drawing& drawing);
[[nodiscard]] core::ImageRgba8 drawZexels(Drawing& drawing);
[[nodiscard]] core::ImageRgba8 drawExposures(Drawing& drawing);

}  // namespace catoptric::app

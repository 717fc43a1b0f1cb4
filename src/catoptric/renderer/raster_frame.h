// SPDX-License-Identifier: Apache-2.0
// A rasterised frame (1998, figure 1): primary image, then level after level of mirrors, then composition.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "catoptric/depth_reflection_map/depth_reflection_map_method.h"
#include "catoptric/environment_map/environment_map_method.h"
#include "catoptric/gl/context.h"
#include "catoptric/planar_mirror/planar_mirror_method.h"
#include "catoptric/reflection_morphing/reflection_morphing_method.h"
#include "catoptric/renderer/chain_finder.h"
#include "catoptric/renderer/choose_method.h"
#include "catoptric/renderer/frame.h"
#include "catoptric/virtual_object/exact/exact_method.h"
#include "catoptric/virtual_object/virtual_object_method.h"

namespace catoptric::renderer {

/// The picture of one sample, top row first, opaque (what composing leaves in alpha means nothing).
void readFlipped(const gl::Framebuffer& framebuffer, int attachment, core::ImageRgbaF& image);

class RasterFrame {
 public:
  /// Needs a current context; arguments must outlive the object.
  RasterFrame(gl::Context& context, const scene::Scene& scene, const scene::WorldGeometry& geometry,
              const scene::Environment& environment);

  [[nodiscard]] Frame render(const scene::CameraFrame& camera, const FrameOptions& options);
  /// After vertices of these parts have moved.
  void updateGeometry(std::span<const std::uint32_t> movedParts);
  /// After values of materials have changed.
  void updateMaterials();
  [[nodiscard]] core::ImageRgbaF renderElsewhere(const scene::CameraFrame& camera,
                                                 const ElsewhereOptions& options);
  void saveReferenceImages() { zexel_.saveCacheFile(); }

  /// VirtualObjectMethod::setSolver(); where GL runs in software it draws none unless it is told to.
  void drawNumbersByGl(bool byGl) { numbersByGl_ = byGl; }

 private:
  void prepareLevels(int count, const FrameOptions& options);
  /// Does the frame ask for scene_.levels(), which are not there yet?
  [[nodiscard]] bool needsLevelsOfDetail(const FrameOptions& options) const;
  void renderSample(const scene::CameraFrame& camera, const FrameOptions& options, const dvec2& jitterPx,
                    Frame& frame);
  /// What one mirror shows, kept within its pixels.
  /// Draws what mirrors show into levels 1, 2, ...; how many levels there are then to be composed, the
  /// primary image among them.
  int renderLevels(raster::FrameContext& context, const FrameOptions& options, int mostLevels);
  /// What the mirrors of a level show, each by the method that is picked for it.
  void renderMirrors(raster::FrameContext& context, const VisibleMirrors& mirrors,
                     const raster::Level& parent, raster::Level& target, const FrameOptions& options);
  void renderMirror(raster::ReflectionMethod& method, raster::FrameContext& context,
                    const raster::Chain& chain, const raster::Level& parent, raster::Level& target);
  [[nodiscard]] bool isMapped(const raster::Chain& chain, const FrameOptions& options) const;
  [[nodiscard]] raster::ReflectionMethod* pickMethod(const raster::FrameContext& context,
                                                     const raster::Chain& chain, const FrameOptions& options);
  /// What MethodChooser picks for a curved mirror that is seen directly, in a scene that has not moved.
  [[nodiscard]] raster::ReflectionMethod* chooseByView(const raster::FrameContext& context,
                                                       const raster::Chain& chain,
                                                       const FrameOptions& options);
  [[nodiscard]] MethodChoice lastChoice(std::uint32_t reflector) const;
  [[nodiscard]] const MethodChoice& askForChoice(const raster::FrameContext& context, std::uint32_t reflector,
                                                 const FrameOptions& options);
  /// Whether vertex shaders find virtual vertices; throws where they are asked for and cannot.
  [[nodiscard]] bool shadesHere(const FrameOptions& options) const;
  [[nodiscard]] bool findsVerticesOnGpu(const FrameOptions& options) const;
  /// Opens the baked file, or makes ready to bake where the eye is.
  void prepareMorphing(const dvec3& eye, const FrameOptions& options);
  /// Opens the file of reference images.
  void prepareZexels(const FrameOptions& options);
  void readSeen(const raster::Level& level, Frame& frame) const;
  /// chooseNearPlane(), once for each place of the eye.
  [[nodiscard]] double findNearPlane(const scene::CameraFrame& camera);

  gl::Context& context_;
  const scene::Scene& sceneData_;
  const scene::WorldGeometry& geometry_;
  const scene::Environment& surroundings_;
  raster::SceneBuffers scene_;
  ChainFinder chains_;
  std::uint64_t lastMirrors_ = 0;  ///< that the last primary image shows
  raster::SurfacePass surfaces_;
  raster::PrimaryPass primary_;
  raster::ComposePass compose_;
  raster::MirrorBackgroundPass unfollowed_;
  raster::MirrorMask mask_;
  planar_mirror::PlanarMirrorMethod planar_;
  virtual_object::HitShading hits_;
  virtual_object::ExactMethod exact_;
  virtual_object::VirtualObjectMethod virtual_;
  environment_map::EnvironmentMapMethod environment_;
  environment_map::EnvironmentMapMethod smallMaps_;  ///< of mirrors of a few pixels
  reflection_morphing::ReflectionMorphingMethod morphing_;
  std::string
      morphingFile_;  ///< what morphing_ has its locations from; empty: from morphingPlan_, on the fly
  reflection_morphing::BakePlan morphingPlan_;
  depth_reflection_map::DepthReflectionMapMethod zexel_;
  std::string zexelFile_;  ///< that zexel_ was given
  bool hasMoved_ = false;
  bool numbersByGl_;
  /// What was chosen for a mirror, and for which view.
  struct Chosen {
    MethodChoice choice;
    dvec3 eye{0};
    double pixelsPerTangent = 0;
    ChoiceOptions options;
  };
  std::unique_ptr<MethodChooser> chooser_;  ///< made when first needed
  std::map<std::uint32_t, Chosen> chosen_;  ///< by reflector
  /// All of them, in no order that matters.
  std::array<raster::ReflectionMethod*, 7> methods_{&planar_,      &virtual_,   &exact_,   &zexel_,
                                                    &environment_, &smallMaps_, &morphing_};
  double nearPlane_ = 0;  ///< of the last camera; 0 = not known
  scene::CameraFrame nearPlaneCamera_;
  std::vector<std::unique_ptr<raster::Level>> levels_;
  std::map<std::uint32_t, raster::ReflectionMethod*>
      lastMethods_;                           ///< of the last frame, by reflector seen directly
  std::unique_ptr<raster::Level> elsewhere_;  ///< of renderElsewhere(), with what draws the marks
  std::unique_ptr<raster::MarksPass> marksPass_;
};

}  // namespace catoptric::renderer

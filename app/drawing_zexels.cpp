// SPDX-License-Identifier: Apache-2.0
// What environment maps and zexels work with (Bastos & Stuerzlinger 1998).
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "catoptric/core/error.h"
#include "catoptric/core/file.h"
#include "catoptric/core/tone_map.h"
#include "catoptric/sketch/zexel_sketch.h"
#include "drawing.h"

namespace catoptric::app {
namespace {

/// A name in the folder for temporary files, of this process only; the file is gone when it is.
class TemporaryFile {
 public:
  TemporaryFile()
      : path_(std::filesystem::temp_directory_path() / ("catoptric-zexels-" + std::to_string(::getpid()))) {}
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Where a cell's middle is: the point asked for, or the reflector's centre as environment maps have it.
dvec3 chooseCentre(const Drawing& drawing) {
  return drawing.options.points.empty() ? drawing.world().reflectors[findReflector(drawing, true)].centre
                                        : drawing.options.points.front();
}

}  // namespace

core::ImageRgba8 drawReflectionCell(Drawing& drawing) {
  constexpr int kSamples = 16;
  renderer::FrameOptions face = drawing.frame;
  face.method = renderer::Method::None;
  face.widthPx = face.heightPx = drawing.options.count;
  face.samples = kSamples;
  face.withSeen = false;
  const dvec3 centre = chooseCentre(drawing);
  std::array<core::ImageRgba8, 6> faces;
  for (std::size_t f = 0; f < faces.size(); ++f)
    faces[f] = core::toneMap(
        drawing.renderer.render(sketch::makeFaceCamera(centre, sketch::cubeFaces()[f]), face).radiance,
        drawing.exposure);
  const double edge =
      drawing.options.width > 0 ? drawing.options.width : 0.2 * drawing.world().bounds.radius();
  return drawFromAside(drawing, sketch::sketchReflectionCell(centre, edge, 3 * edge, faces), centre);
}

core::ImageRgba8 drawMappedRays(Drawing& drawing) {
  const reflection_morphing::MirrorRays rays(drawing.world(), true);
  const dvec3 centre = chooseCentre(drawing);
  const auto sketch = sketch::sketchMappedRays(rays, drawing.viewer(), centre, drawing.options.count);
  return drawFromAside(drawing, sketch, drawing.world().reflectors[findReflector(drawing, true)].centre);
}

core::ImageRgba8 drawZexels(Drawing& drawing) {
  namespace zexel = depth_reflection_map;
  static_cast<void>(findReflector(drawing, true));
  const TemporaryFile file;
  renderer::FrameOptions options = drawing.frame;
  options.method = renderer::Method::Zexel;
  options.zexel.cacheFile = file.path().string();
  static_cast<void>(drawing.renderer.render(drawing.camera, options));
  drawing.renderer.saveReferenceImages();
  const auto bytes = core::readFile(file.path());
  const auto records = zexel::unpackReferences(
      bytes,
      zexel::computeSceneFingerprint(drawing.loaded.scene, drawing.world(), drawing.loaded.environment));
  if (records.empty())
    throw core::Error("draw.not_seen", "no flat mirror is in view, so no reference image was taken", {},
                      "try another --eye");
  const zexel::StoredImage image = zexel::unpackImage(records.begin()->second);
  drawing.facts["zexels"] = image.zexels.size();
  const dvec3 middle = drawing.world().reflectors[image.key.reflector].centre;
  return drawFromAside(
      drawing, sketch::sketchZexels(image, std::max(1, image.camera.width / (8 * drawing.options.count))),
      middle);
}

core::ImageRgba8 drawExposures(Drawing& drawing) {
  static_cast<void>(findReflector(drawing, true));
  renderer::FrameOptions options = drawing.frame;
  options.method = renderer::Method::Zexel;
  options.zexel.isCoherent = options.zexel.continuesSurfaces = false;
  options.withSeen = true;
  const renderer::Frame frame = drawing.renderer.render(drawing.camera, options);
  options.method = renderer::Method::RayTrace;
  const renderer::Frame truth = drawing.renderer.render(drawing.camera, options);
  core::ImageRgba8 picture = core::toneMap(frame.radiance, drawing.exposure);
  drawing.facts["exposures"] = sketch::markExposures(frame.seen, truth.seen, picture);
  drawing.facts["uncovered_pixels"] = frame.counters.uncoveredPixels;
  drawing.facts["zexel_pixels"] = frame.counters.zexelPixels;
  return picture;
}

}  // namespace catoptric::app

// SPDX-License-Identifier: Apache-2.0
// Zexels of the reference images that a flat mirror's last picture was warped from, as points of the scene:
// what lies bare between them are exposures. And the window that the images were taken through, and from
// where.
#include "catoptric/depth_reflection_map/depth_reflection_map_method.h"

namespace catoptric::depth_reflection_map {
namespace {

const vec3 kReferenceColors[2]{vec3(0.2f, 0.75f, 0.95f), vec3(1.0f, 0.55f, 0.1f)};
const vec3 kWindowColor(0.9f, 0.9f, 0.3f);

void addWindow(const MirrorWindow& window, const dvec3& centre, const vec3& color, raster::Marks& marks) {
  dvec3 corners[4];
  for (int k = 0; k < 4; ++k)
    corners[k] = window.centre + (k == 0 || k == 3 ? -1.0 : 1.0) * window.half.x * window.right +
                 (k < 2 ? -1.0 : 1.0) * window.half.y * window.up;
  for (int k = 0; k < 4; ++k) {
    marks.addLine(corners[k], corners[(k + 1) % 4], kWindowColor);
    marks.addLine(centre, corners[k], color);
  }
}

}  // namespace

void DepthReflectionMapMethod::collectMarks(const scene::WorldGeometry&, std::uint32_t reflector,
                                            const raster::MarkOptions& options, raster::Marks& marks) const {
  if (!options.zexels) return;
  for (const auto& [side, window] : windows_) {
    if (side.first != reflector) continue;
    for (std::size_t i = 0; i < window.lastKeys.size(); ++i) {
      const ReferenceImage* image = cache_.find(window.lastKeys[i]);
      if (!image) continue;
      const vec3 color = kReferenceColors[i % 2];
      addWindow(window.window, image->camera.centre, 0.5f * color, marks);
      const ZexelLevel& level = image->map.levels[0];
      for (int y = 0; y < level.height; ++y)
        for (int x = 0; x < level.width; ++x) {
          const double disparity =
              level.disparities[std::size_t(y) * std::size_t(level.width) + std::size_t(x)];
          if (disparity <= 0) continue;
          const dvec3 ray = image->camera.worldFromZexel * dvec3(x + 0.5, y + 0.5, 1.0);
          // Neighbouring depths differ in brightness, so that shapes can be told.
          marks.addPoint(image->camera.centre + ray / disparity, float(0.35 + 0.65 * disparity) * color);
        }
    }
  }
}

}  // namespace catoptric::depth_reflection_map

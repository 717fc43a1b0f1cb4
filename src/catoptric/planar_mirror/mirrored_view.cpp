// SPDX-License-Identifier: Apache-2.0
#include "catoptric/planar_mirror/mirrored_view.h"

namespace catoptric::planar_mirror {

raster::PinholeView makeMirroredView(const raster::FrameContext& frame, const raster::Chain& chain) {
  raster::PinholeView view = raster::makePinholeView(frame.camera, frame.nearPlane, frame.jitterPx);
  const dmat4 drawFromScreen = glm::inverse(chain.screenFromDraw);
  view.eye = dvec3(drawFromScreen * dvec4(view.eye, 1.0));
  for (dvec3* ray : {&view.rayOrigin, &view.rayDx, &view.rayDy}) *ray = dmat3(drawFromScreen) * *ray;
  view.clipFromWorld = view.clipFromWorld * chain.screenFromDraw;
  view.windingFlipped = chain.level % 2 == 1;
  // The mirrored eye is behind the last mirror; what it shows lies on the other side.
  const core::Plane& plane = frame.scene.geometry().reflectors[chain.last].plane;
  const double side = plane.signedDistance(view.eye) < 0.0 ? 1.0 : -1.0;
  view.clip.add(vec4(vec3(side * plane.normal), float(side * plane.offset)));
  return view;
}

raster::PinholeView reduceToRectangle(const raster::PinholeView& view, const gl::Scissor& rectangle,
                                      int widthPx, int heightPx, int textureWidth, int textureHeight) {
  raster::PinholeView reduced = view;
  const double w = rectangle.width, h = rectangle.height;
  dmat4 crop(1.0);  // of clip space: [-1, 1] is the rectangle
  crop[0][0] = widthPx / w;
  crop[1][1] = heightPx / h;
  crop[3][0] = (widthPx - 2.0 * rectangle.x - w) / w;
  crop[3][1] = (heightPx - 2.0 * rectangle.y - h) / h;
  reduced.clipFromWorld = crop * view.clipFromWorld;
  reduced.rayOrigin = view.rayOrigin + double(rectangle.x) * view.rayDx + double(rectangle.y) * view.rayDy;
  reduced.rayDx = view.rayDx * (w / textureWidth);
  reduced.rayDy = view.rayDy * (h / textureHeight);
  return reduced;
}

std::array<vec4, 4> makeFrustumSides(const raster::PinholeView& view, const gl::Scissor& rectangle) {
  const auto ray = [&](double x, double y) {
    return view.rayOrigin + (rectangle.x + x * rectangle.width) * view.rayDx +
           (rectangle.y + y * rectangle.height) * view.rayDy;
  };
  const std::array<dvec3, 4> corners{ray(0, 0), ray(1, 0), ray(1, 1), ray(0, 1)};
  const dvec3 inside = ray(0.5, 0.5);
  std::array<vec4, 4> sides;
  for (std::size_t i = 0; i < 4; ++i) {
    dvec3 normal = glm::normalize(glm::cross(corners[i], corners[(i + 1) % 4]));
    if (glm::dot(normal, inside) < 0.0) normal = -normal;  // an odd number of mirrors turns them round
    sides[i] = vec4(vec3(normal), float(-glm::dot(normal, view.eye)));
  }
  return sides;
}

bool isWhollyBehind(const core::Box& box, const vec4& plane) {
  const dvec3 normal = dvec3(vec3(plane));
  const dvec3 foremost = glm::mix(box.lower, box.upper, glm::greaterThan(normal, dvec3(0)));
  return glm::dot(normal, foremost) + double(plane.w) <= 0.0;
}

}  // namespace catoptric::planar_mirror

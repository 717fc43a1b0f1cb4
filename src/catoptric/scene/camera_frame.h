// SPDX-License-Identifier: Apache-2.0
// A camera and a picture size as matrices; the one place that says which ray a pixel looks along.
#pragma once

#include "catoptric/core/math.h"
#include "catoptric/scene/scene.h"

namespace catoptric::scene {

struct CameraFrame {
  dvec3 eye{0};
  dvec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  ///< unit, orthogonal
  double tanHalfFovY = 0.5;
  int widthPx = 0, heightPx = 0;

  /// Unnormalised direction of the ray through image position (x, y) in pixels; (0, 0) is the top left corner
  /// of the picture and (0.5, 0.5) the centre of its first pixel. Its component along `forward` is 1.
  [[nodiscard]] dvec3 rayDirection(double xPx, double yPx) const {
    const double aspect = double(widthPx) / heightPx;
    const double sx = (2.0 * xPx / widthPx - 1.0) * aspect * tanHalfFovY;
    const double sy = (1.0 - 2.0 * yPx / heightPx) * tanHalfFovY;
    return forward + sx * right + sy * up;
  }
  /// Change of rayDirection per pixel to the right and downwards.
  [[nodiscard]] dvec3 rayDirectionDx() const {
    return right * (2.0 * tanHalfFovY * (double(widthPx) / heightPx) / widthPx);
  }
  [[nodiscard]] dvec3 rayDirectionDy() const { return up * (-2.0 * tanHalfFovY / heightPx); }

  [[nodiscard]] dmat4 viewFromWorld() const;
  /// OpenGL clip space, infinite far plane.
  [[nodiscard]] dmat4 clipFromView(double nearPlane) const;
};

[[nodiscard]] CameraFrame makeCameraFrame(const Camera& camera, int widthPx, int heightPx);

}  // namespace catoptric::scene

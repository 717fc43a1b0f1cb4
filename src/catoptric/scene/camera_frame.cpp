// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/camera_frame.h"

#include <cmath>

namespace catoptric::scene {

dmat4 CameraFrame::viewFromWorld() const {
  dmat4 m(1.0);
  for (int i = 0; i < 3; ++i) {
    m[i][0] = right[i];
    m[i][1] = up[i];
    m[i][2] = -forward[i];
  }
  m[3] = dvec4(-glm::dot(right, eye), -glm::dot(up, eye), glm::dot(forward, eye), 1.0);
  return m;
}

dmat4 CameraFrame::clipFromView(double nearPlane) const {
  const double aspect = double(widthPx) / heightPx;
  dmat4 m(0.0);
  m[0][0] = 1.0 / (aspect * tanHalfFovY);
  m[1][1] = 1.0 / tanHalfFovY;
  m[2][2] = -1.0;
  m[2][3] = -1.0;
  m[3][2] = -2.0 * nearPlane;
  return m;
}

CameraFrame makeCameraFrame(const Camera& camera, int widthPx, int heightPx) {
  CameraFrame frame;
  frame.eye = camera.eye;
  frame.forward = glm::normalize(camera.target - camera.eye);
  dvec3 side = glm::cross(frame.forward, camera.up);
  if (glm::length(side) < 1e-9)  // looking along `up`: any side will do
    side = glm::cross(frame.forward, std::abs(frame.forward.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 0, 1));
  frame.right = glm::normalize(side);
  frame.up = glm::cross(frame.right, frame.forward);
  frame.tanHalfFovY = std::tan(0.5 * camera.fovYRadians);
  frame.widthPx = widthPx;
  frame.heightPx = heightPx;
  return frame;
}

Camera makeFrameAllCamera(const core::Box& bounds, double azimuthRadians, double elevationRadians,
                          double fovYRadians) {
  const double radius = bounds.isEmpty() ? 1.0 : std::max(bounds.radius(), 1e-6);
  const dvec3 centre = bounds.isEmpty() ? dvec3(0) : bounds.centre();
  const dvec3 away(std::sin(azimuthRadians) * std::cos(elevationRadians), std::sin(elevationRadians),
                   std::cos(azimuthRadians) * std::cos(elevationRadians));
  Camera camera;
  camera.name = "frame-all";
  camera.fovYRadians = fovYRadians;
  camera.target = centre;
  camera.eye = centre + away * (radius * 1.05 / std::sin(0.5 * fovYRadians));
  return camera;
}

}  // namespace catoptric::scene

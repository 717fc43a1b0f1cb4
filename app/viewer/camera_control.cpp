// SPDX-License-Identifier: Apache-2.0
#include "viewer/camera_control.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "catoptric/scene/camera_frame.h"

namespace catoptric::viewer {
namespace {

constexpr double kRadiansPerPixel = 0.4 * 3.14159265358979 / 180.0;
constexpr double kPoleRadians = 0.01;  // how near the view may come to `up`
constexpr double kZoomBase = 0.9;

dvec3 rotate(const dvec3& v, double radians, const dvec3& unitAxis) {
  return glm::angleAxis(radians, unitAxis) * v;
}

}  // namespace

void orbit(scene::Camera& camera, const dvec2& mousePx) {
  const dvec3 up = glm::normalize(camera.up);
  dvec3 away = camera.eye - camera.target;
  away = rotate(away, -mousePx.x * kRadiansPerPixel, up);
  const scene::CameraFrame frame = scene::makeCameraFrame(camera, 1, 1);
  const dvec3 right = rotate(frame.right, -mousePx.x * kRadiansPerPixel, up);
  const double fromUp = std::acos(std::clamp(glm::dot(glm::normalize(away), up), -1.0, 1.0));
  const double wanted =
      std::clamp(fromUp - mousePx.y * kRadiansPerPixel, kPoleRadians, 3.14159265358979 - kPoleRadians);
  camera.eye = camera.target + rotate(away, wanted - fromUp, right);
}

void pan(scene::Camera& camera, const dvec2& mousePx, int heightPx) {
  const scene::CameraFrame frame = scene::makeCameraFrame(camera, 1, 1);
  const double perPixel =
      2.0 * glm::length(camera.target - camera.eye) * frame.tanHalfFovY / std::max(heightPx, 1);
  const dvec3 shift = (-mousePx.x * frame.right + mousePx.y * frame.up) * perPixel;
  camera.eye += shift;
  camera.target += shift;
}

void zoom(scene::Camera& camera, double steps) {
  camera.eye = camera.target + (camera.eye - camera.target) * std::pow(kZoomBase, steps);
}

void setPivot(scene::Camera& camera, const dvec3& point) {
  if (glm::length(point - camera.eye) > 1e-9) camera.target = point;
}

scene::Camera frameAll(const scene::Camera& camera, const core::Box& bounds) {
  scene::Camera framed = scene::makeFrameAllCamera(bounds, 0.0, 0.0, camera.fovYRadians);
  const double distance = glm::length(framed.eye - framed.target);
  framed.eye = framed.target + glm::normalize(camera.eye - camera.target) * distance;
  framed.up = camera.up;
  return framed;
}

scene::Camera frameFrom(Side side, const scene::Camera& camera, const core::Box& bounds) {
  constexpr double kQuarterTurn = 1.5707963267949;
  scene::Camera framed =
      scene::makeFrameAllCamera(bounds, side == Side::Right ? kQuarterTurn : 0.0,
                                side == Side::Top ? kQuarterTurn - kPoleRadians : 0.0, camera.fovYRadians);
  framed.up = dvec3(0, 1, 0);
  return framed;
}

bool isSameView(const scene::Camera& a, const scene::Camera& b) {
  return a.eye == b.eye && a.target == b.target && a.up == b.up && a.fovYRadians == b.fovYRadians;
}

}  // namespace catoptric::viewer

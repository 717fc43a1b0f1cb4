// SPDX-License-Identifier: Apache-2.0
// Cameras and KHR_lights_punctual.
#include <fmt/format.h>

#include <cmath>

#include "catoptric/scene/gltf/model.h"

namespace catoptric::scene::gltf {
namespace {

constexpr double kSmallest = 1e-30;  // "greater than 0" that is still greater than 0 as a float

CameraSource readCamera(const Element& element) {
  CameraSource camera;
  camera.name = element.findString("name");
  const std::string type = element.getString("type");
  const bool hasPerspective = element.has("perspective"), hasOrthographic = element.has("orthographic");
  if (type != "perspective" && type != "orthographic")
    element.find("type")->fail("gltf.value", fmt::format("\"{}\" is no camera type", printable(type)));
  if (hasPerspective && hasOrthographic)
    element.fail("gltf.value", "a camera is either perspective or orthographic");
  const Element body = element.getObject(type);
  camera.orthographic = type == "orthographic";
  if (!camera.orthographic) {
    camera.fovYRadians = body.getNumber("yfov", kSmallest, 3.14159);
    (void)body.findNumber("aspectRatio", 1, kSmallest);
    const double near = body.getNumber("znear", kSmallest);
    if (body.has("zfar") && !(body.getNumber("zfar", kSmallest) > near))
      body.fail("gltf.value", "zfar must be greater than znear");
    return camera;
  }
  camera.halfHeight = std::abs(body.getNumber("ymag"));
  if (camera.halfHeight < kSmallest || std::abs(body.getNumber("xmag")) < kSmallest)
    body.fail("gltf.value", "xmag and ymag must not be zero");
  if (!(body.getNumber("zfar", 0) > body.getNumber("znear", 0)))
    body.fail("gltf.value", "zfar must be greater than znear");
  return camera;
}

LightSource readLight(const Element& element) {
  LightSource light;
  light.type = element.getString("type");
  if (light.type != "directional" && light.type != "point" && light.type != "spot")
    element.find("type")->fail("gltf.value",
                               fmt::format("\"{}\" is no type of light", printable(light.type)));
  const auto color = element.findNumbers<3>("color", {1, 1, 1}, 0);
  const double intensity = element.findNumber("intensity", 1, 0);
  light.color = vec3(0);
  for (int i = 0; i < 3; ++i) light.color[i] = float(std::min(color[std::size_t(i)] * intensity, 1e30));
  light.range = float(element.findNumber("range", 0, kSmallest));
  if (light.type != "spot") return light;
  const Element spot = element.getObject("spot");
  constexpr double kHalfPi = 1.5707964;
  light.innerConeRadians = float(spot.findNumber("innerConeAngle", 0, 0, kHalfPi));
  light.outerConeRadians = float(spot.findNumber("outerConeAngle", 0.7853981633974483, kSmallest, kHalfPi));
  if (!(light.innerConeRadians < light.outerConeRadians))
    spot.fail("gltf.value", "the inner cone of a spot light must be narrower than the outer one");
  return light;
}

}  // namespace

void readCamerasAndLights(Context&, const Element& root, Model& model) {
  forEachObject(root, "cameras",
                [&](const Element& element, std::size_t) { model.cameras.push_back(readCamera(element)); });
  if (const auto extension = root.findExtension("KHR_lights_punctual"))
    forEachObject(*extension, "lights",
                  [&](const Element& element, std::size_t) { model.lights.push_back(readLight(element)); });
}

}  // namespace catoptric::scene::gltf

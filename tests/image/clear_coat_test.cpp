// SPDX-License-Identifier: Apache-2.0
// A clear coat over a normal-mapped base is a smooth mirror (KHR_materials_clearcoat); a metal with that map
// is not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "catoptric/geometry/shapes.h"
#include "image_test_support.h"
#include "traced_scene.h"

namespace catoptric::image_test {
namespace {

/// Bumps across a texture.
scene::Texture makeBumps() {
  scene::Texture texture;
  texture.image = core::ImageRgba8(16, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const dvec3 n = glm::normalize(
          dvec3(0.6 * std::sin(reference::kPi * x / 4), 0.6 * std::cos(reference::kPi * y / 4), 1.0));
      const auto byte = [](double c) { return std::uint8_t(std::lround(127.5 * (c + 1))); };
      texture.image.at(x, y) = {byte(n.x), byte(n.y), byte(n.z), 255};
    }
  return texture;
}

enum class Base : std::uint8_t { Black, BlackWithBumps, BlueWithBumps, MetalWithBumps };

/// A quad and a ball of one material before bright boards.
reference::TracedTestScene makeCoated(Base base) {
  reference::TracedTestScene t;
  t.scene.textures.push_back(makeBumps());
  scene::Material paint;
  paint.roughness = base == Base::MetalWithBumps ? 0.0f : 0.5f;
  paint.metallic = base == Base::MetalWithBumps ? 1.0f : 0.0f;
  paint.clearcoat = base == Base::MetalWithBumps ? 0.0f : 1.0f;
  paint.baseColor = base == Base::BlueWithBumps ? vec4(0.1f, 0.2f, 0.8f, 1) : vec4(0, 0, 0, 1);
  if (base == Base::MetalWithBumps) paint.baseColor = vec4(1);
  if (base != Base::Black) paint.normalTexture.texture = 0;
  t.add(reference::makeQuad({-1.6f, -1, 0}, {1.5f, 0, 0}, {0, 2, 0}), paint, "quad");
  t.add(reference::makeBall(64, 32), paint, "ball",
        geometry::moveBy({0.9, 0, 0}) * geometry::scaleBy(dvec3(0.7)));
  for (int i = -3; i <= 3; ++i)
    t.add(reference::makeQuad({float(i) - 0.2f, -2, 6}, {0, 4, 0}, {0.4f, 0, 0}),
          reference::makeUnlit(vec3(8)), "board");
  t.camera.eye = {0, 0, 4.5};
  t.camera.target = {0, 0, 0};
  t.camera.fovYRadians = 0.6;
  t.finish();
  return t;
}

/// Largest difference of any channel under a black sky, where a black base is not seen.
float compareTraced(Base base, Base other) {
  float largest = 0;
  const auto trace = [](Base which) {
    reference::TracedTestScene t = makeCoated(which);
    t.environment = reference::makeUniformSky(vec3(0));
    t.tracer = std::make_unique<reference::RayTracer>(t.scene, t.world, t.environment);
    return t.trace(96, 96).radiance;
  };
  const core::ImageRgbaF a = trace(base), b = trace(other);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const vec4 change = glm::abs(a.pixels()[i] - b.pixels()[i]);
    largest = std::max({largest, change.r, change.g, change.b});
  }
  return largest;
}

TEST(ClearCoat, isAsSmoothAsItsMesh) {
  const reference::TracedTestScene bumps = makeCoated(Base::BlackWithBumps),
                                   metal = makeCoated(Base::MetalWithBumps);
  EXPECT_EQ(bumps.world.reflectors.at(0).shape, scene::ReflectorShape::Plane);
  EXPECT_EQ(metal.world.reflectors.at(0).shape, scene::ReflectorShape::Mesh);
  EXPECT_LT(compareTraced(Base::BlackWithBumps, Base::Black), 1e-6f);
  EXPECT_GT(compareTraced(Base::MetalWithBumps, Base::Black), 0.1f);
}

TEST(ClearCoat, isDrawnAsItIsTraced) {
  const reference::TracedTestScene t = makeCoated(Base::BlueWithBumps);
  expectWithin({"coat-over-blue-bumps", t.scene, t.world, t.camera}, withTurnedNormals(t.world, 0.02),
               {24, 0.25, "bumps are filtered with weights of 8 bits; edges of the boards on the ball"});
}

}  // namespace
}  // namespace catoptric::image_test

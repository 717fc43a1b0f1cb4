// SPDX-License-Identifier: Apache-2.0
// Rules of the picture: mirrors, visibility, transparency, textures.
#include "catoptric/reference/ray_tracer.h"

#include <gtest/gtest.h>

#include "traced_scene.h"

namespace catoptric::reference {
namespace {

TEST(RayTracer, EmptySceneIsSky) {
  TracedTestScene t;
  t.finish();
  const TraceResult result = t.trace(33, 17);
  ASSERT_EQ(result.seen.width(), 33);
  for (const vec4& pixel : result.radiance.pixels()) expectColor(pixel, {0.25f, 0.5f, 1.0f});
  for (const core::SeenPixel& seen : result.seen.pixels()) {
    EXPECT_TRUE(seen.isSky());
    EXPECT_FALSE(seen.isMirror());
    EXPECT_NEAR(glm::length(seen.point), 1, 1e-6);
    EXPECT_TRUE(std::isinf(seen.pathLength));
  }
  EXPECT_EQ(result.rays, 33u * 17u);
}

TEST(RayTracer, UnlitColourIsExactDirectlyAndInAPerfectMirror) {
  const vec3 color(0.1f, 0.7f, 0.33f);
  TracedTestScene t;
  t.add(makeFacingQuad(), makeMirror(), "mirror");
  // Behind the camera, facing the mirror.
  t.add(makeQuad({20, -20, 9}, {-40, 0, 0}, {0, 40, 0}), makeUnlit(color), "board");
  lookAtOrigin(t);
  t.finish();
  const TraceResult result = t.trace(31, 31);
  EXPECT_TRUE(centreSeen(result).isMirror());
  EXPECT_EQ(centreSeen(result).object, 1u);
  expectColor(centreOf(result), color, 1e-6f);
  t.camera.target = {0, 0, 9};
  t.camera.eye = {0, 0, 4};
  expectColor(centreOf(t.trace(31, 31)), color, 0);
}

TEST(RayTracer, TintAndSchlickFresnel) {
  const vec3 tint(0.9f, 0.6f, 0.3f), color(0.5f, 0.4f, 0.8f);
  TracedTestScene t;
  t.add(makeFacingQuad(), makeMirror(tint), "mirror");
  t.add(makeQuad({200, -200, 9}, {-400, 0, 0}, {0, 400, 0}), makeUnlit(color), "board");
  t.finish();
  for (const double angle : {0.0, 0.5, 1.0, 1.3}) {
    t.camera.eye = {3 * std::sin(angle), 0, 3 * std::cos(angle)};
    t.camera.target = {0, 0, 0};
    const float m = float(std::pow(1 - std::cos(angle), 5));
    expectColor(centreOf(t.trace(31, 31)), (tint + (vec3(1) - tint) * m) * color, 1e-5f);
  }
}

TEST(RayTracer, ReflectivityScalesTheMirrorAndShowsTheBase) {
  TracedTestScene t;
  scene::Material material = makeMirror();
  material.hint.reflector = true;
  material.hint.reflectivity = 0.25f;
  t.environment = makeUniformSky(vec3(0));
  t.add(makeFacingQuad(), material, "mirror");
  t.add(makeQuad({20, -20, 9}, {-40, 0, 0}, {0, 40, 0}), makeUnlit(vec3(1)), "board");
  lookAtOrigin(t);
  t.finish();
  expectColor(centreOf(t.trace(31, 31)), vec3(0.25f), 1e-5f);
}

TEST(RayTracer, ClearcoatMirrorsFourPercent) {
  TracedTestScene t;
  scene::Material paint;
  paint.metallic = 0;
  paint.clearcoat = 1;
  paint.baseColor = {0, 0, 0, 1};
  t.environment = makeUniformSky(vec3(0));
  t.add(makeFacingQuad(), paint, "paint");
  t.add(makeQuad({20, -20, 9}, {-40, 0, 0}, {0, 40, 0}), makeUnlit(vec3(1)), "board");
  lookAtOrigin(t);
  t.finish();
  ASSERT_EQ(t.world.reflectors.size(), 1u);
  expectColor(centreOf(t.trace(31, 31)), vec3(0.04f), 1e-5f);
}

TEST(RayTracer, BouncesAreLimited) {
  TracedTestScene t;
  t.add(makeQuad({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}), makeMirror(), "near mirror");
  t.add(makeQuad({5, -5, 4}, {-10, 0, 0}, {0, 10, 0}), makeMirror(), "far mirror");
  t.camera.eye = {0, 0, 2};
  t.camera.target = {0.1, 0.05, 0};
  t.finish();
  for (int bounces = 0; bounces < 6; ++bounces) {
    const TraceResult result = t.trace(15, 15, {.bounces = bounces});
    const core::SeenPixel seen = centreSeen(result);
    EXPECT_EQ(seen.bounces, std::uint32_t(bounces));
    EXPECT_EQ(seen.object, std::uint32_t(bounces % 2));
    EXPECT_EQ(seen.firstReflector, 0u);
    EXPECT_NEAR(seen.point.z, bounces % 2 == 0 ? 0 : 4, 1e-5);
    // Straight up the corridor: 2 to the first mirror, 4 for each leg.
    EXPECT_NEAR(seen.pathLength, (2 + 4 * bounces) * std::sqrt(1 + (0.01 + 0.0025) / 4), 1e-4);
    expectColor(centreOf(result), {0.25f, 0.5f, 1.0f}, 1e-5f);  // the last mirror shows the environment
    EXPECT_EQ(result.reflectionSeconds > 0, bounces > 0);
    EXPECT_LT(result.reflectionSeconds, result.seconds);
  }
}

TEST(RayTracer, BackFacesOfSingleSidedMaterialsAreNotThere) {
  for (const bool doubleSided : {false, true}) {
    TracedTestScene t;
    scene::Material front = makeUnlit({1, 0, 0});
    front.doubleSided = doubleSided;
    t.add(makeQuad({1, -1, 1}, {-2, 0, 0}, {0, 2, 0}), front, "turned away");
    t.add(makeFacingQuad(), makeUnlit({0, 1, 0}), "behind");
    lookAtOrigin(t);
    t.finish();
    expectColor(centreOf(t.trace(31, 31)), doubleSided ? vec3(1, 0, 0) : vec3(0, 1, 0));
  }
}

TEST(RayTracer, FacesBackToBackInOnePlane) {
  // The front one must be found although the other is at the very same distance.
  TracedTestScene t;
  t.add(makeQuad({1, -1, 0}, {-2, 0, 0}, {0, 2, 0}), makeUnlit({1, 0, 0}), "back");
  t.add(makeFacingQuad(), makeUnlit({0, 1, 0}), "front");
  t.add(makeQuad({1, -1, 0}, {-2, 0, 0}, {0, 2, 0}), makeUnlit({1, 0, 0}), "back again");
  lookAtOrigin(t);
  t.finish();
  const TraceResult result = t.trace(64, 64);
  for (std::size_t i = 0; i < result.seen.size(); ++i)
    EXPECT_TRUE(result.seen.data()[i].object == 1u || result.seen.data()[i].isSky());
}

TEST(RayTracer, SingleSidedMirrorIsNotThereFromBehindDoubleSidedIs) {
  for (const bool doubleSided : {false, true}) {
    TracedTestScene t;
    scene::Material material = makeMirror();
    material.doubleSided = doubleSided;
    t.add(makeQuad({1, -1, 0}, {-2, 0, 0}, {0, 2, 0}), material, "turned away");
    t.add(makeQuad({-20, -20, -1}, {40, 0, 0}, {0, 40, 0}), makeUnlit({0, 1, 0}), "behind");
    t.add(makeQuad({20, -20, 9}, {-40, 0, 0}, {0, 40, 0}), makeUnlit({1, 0, 0}), "board");
    lookAtOrigin(t);
    t.finish();
    const TraceResult result = t.trace(31, 31);
    EXPECT_EQ(centreSeen(result).isMirror(), doubleSided);
    expectColor(centreOf(result), doubleSided ? vec3(1, 0, 0) : vec3(0, 1, 0), 1e-6f);
  }
}

TEST(RayTracer, AlphaMaskedTexelsAreNotThere) {
  TracedTestScene t;
  scene::Texture texture;
  texture.image = core::ImageRgba8(2, 1);
  texture.image.at(0, 0) = {255, 255, 255, 0};
  texture.image.at(1, 0) = {255, 255, 255, 255};
  texture.magnifyNearest = texture.minifyNearest = true;
  texture.useMipmaps = false;
  t.scene.textures.push_back(texture);
  scene::Material masked = makeUnlit({1, 1, 0});
  masked.alphaMode = scene::AlphaMode::Mask;
  masked.baseColorTexture.texture = 0;
  t.add(makeFacingQuad(), masked, "leaf");
  t.add(makeQuad({-9, -9, -1}, {18, 0, 0}, {0, 18, 0}), makeUnlit({0, 0, 1}), "behind");
  lookAtOrigin(t);
  t.finish();
  const TraceResult result = t.trace(64, 64);
  EXPECT_EQ(result.seen.at(28, 32).object, 1u);
  EXPECT_EQ(result.seen.at(36, 32).object, 0u);
  expectColor(result.radiance.at(28, 32), {0, 0, 1});
  expectColor(result.radiance.at(36, 32), {1, 1, 0});
}

TEST(RayTracer, BlendedLayersAddUpFrontToBackAndAreNotSeen) {
  TracedTestScene t;
  const auto glass = [](const vec3& color, float alpha) {
    scene::Material material = makeUnlit(color);
    material.baseColor.a = alpha;
    material.alphaMode = scene::AlphaMode::Blend;
    return material;
  };
  t.add(makeFacingQuad(1), glass({1, 0, 0}, 0.25f), "front");
  t.add(makeFacingQuad(0.5f), glass({0, 1, 0}, 0.5f), "middle");
  t.add(makeQuad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), makeUnlit({0, 0, 1}), "wall");
  lookAtOrigin(t);
  t.finish();
  const TraceResult result = t.trace(31, 31);
  expectColor(centreOf(result), {0.25f, 0.75f * 0.5f, 0.75f * 0.5f}, 1e-6f);
  EXPECT_EQ(centreSeen(result).object, 2u);
  EXPECT_NEAR(centreSeen(result).pathLength, 3, 1e-6);
}

TEST(RayTracer, CoplanarBlendedLayersEachCountOnce) {
  TracedTestScene t;
  scene::Material half = makeUnlit(vec3(0));
  half.baseColor.a = 0.5f;
  half.alphaMode = scene::AlphaMode::Blend;
  half.doubleSided = true;
  for (int i = 0; i < 100; ++i) t.add(makeFacingQuad(0.01f * float(i)), half, "layer");
  t.environment = makeUniformSky(vec3(1));
  lookAtOrigin(t);
  t.finish();
  const vec4 centre = centreOf(t.trace(31, 31));
  EXPECT_GE(centre.x, 0);
  EXPECT_LT(centre.x, 1e-6);  // 2^-64 and an end
}

TEST(RayTracer, FarCheckerAveragesToGreyDirectlyAndInMirrors) {
  // A checkerboard of thousands of cells per pixel would be noise if it were sampled without its footprint.
  TracedTestScene t;
  t.scene.textures.push_back(makeChecker(2, 4));
  scene::Material board = makeUnlit(vec3(1));
  board.baseColorTexture.texture = 0;
  t.add(makeQuad({2000, -2000, 1000}, {-4000, 0, 0}, {0, 4000, 0}, 8000), board, "board");
  t.add(makeFacingQuad(), makeMirror(), "mirror");
  t.add(makeBall(64, 32), makeMirror(), "ball", glm::translate(dmat4(1), dvec3(4, 0, 0)));
  t.camera.eye = {1.5, 0, 8};
  t.camera.target = {1.5, 0, 0};
  t.finish();
  const TraceResult result = t.trace(96, 64);
  int mirrorPixels = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 96; ++x) {
      const core::SeenPixel& seen = result.seen.at(x, y);
      if (seen.object != 0u || !seen.isMirror()) continue;
      ++mirrorPixels;
      // The mean of black and white in linear light, as an sRGB byte.
      EXPECT_NEAR(result.radiance.at(x, y).x, 0.5f, 0.01f) << x << " " << y;
    }
  EXPECT_GT(mirrorPixels, 150);
  t.camera.target = {1.5, 0, 1000};
  expectColor(centreOf(t.trace(31, 31)), vec3(0.5f), 0.01f);
}

TEST(RayTracer, NormalMapTiltsTheMirror) {
  // A constant map that leans the normal by atan(0.5) towards +x: the mirror looks along (0.8, 0, 0.6).
  for (const bool withTangents : {false, true}) {
    TracedTestScene t;
    scene::Texture texture;
    const dvec3 n = glm::normalize(dvec3(0.5, 0, 1));
    texture.image = core::ImageRgba8(1, 1,
                                     {std::uint8_t(std::lround(127.5 * (n.x + 1))), 128,
                                      std::uint8_t(std::lround(127.5 * (n.z + 1))), 255});
    t.scene.textures.push_back(texture);
    scene::Material material = makeMirror();
    material.normalTexture.texture = 0;
    scene::MeshPrimitive quad = makeFacingQuad();
    if (withTangents) quad.tangents.assign(4, vec4(1, 0, 0, 1));
    t.add(quad, material, "mirror");
    lookAtOrigin(t);
    t.finish();
    const core::SeenPixel seen = centreSeen(t.trace(31, 31));
    EXPECT_TRUE(seen.isMirror() && seen.isSky());
    EXPECT_LT(glm::length(seen.point - vec3(0.8f, 0, 0.6f)), 0.02f) << "tangents " << withTangents;
  }
}

TEST(RayTracer, ConvexMirrorNeverSeesItself) {
  // Coarse, so that interpolated normals send grazing rays below their facets; double-sided, so that those
  // would hit.
  TracedTestScene t;
  scene::Material material = makeMirror();
  material.doubleSided = true;
  t.add(makeBall(16, 8), material, "ball");
  t.camera.eye = {0, 0.4, 4};
  t.camera.target = {0, 0, 0};
  t.finish();
  ASSERT_TRUE(t.world.reflectors.at(0).isConvex);
  const TraceResult result = t.trace(200, 200, {.bounces = 4});
  for (const core::SeenPixel& seen : result.seen.pixels())
    if (seen.isMirror()) {
      EXPECT_TRUE(seen.isSky());
      EXPECT_EQ(seen.bounces, 1u);
    }
}

TEST(RayTracer, ConcaveMirrorSeesItself) {
  TracedTestScene t;
  scene::Material material = makeMirror();
  material.doubleSided = true;
  t.add(makeBall(64, 32), material, "ball");
  t.camera.eye = {0.2, 0.1, 0.3};
  t.camera.target = {1, 0, 0};
  t.finish();
  const TraceResult result = t.trace(40, 40, {.bounces = 5});
  for (const core::SeenPixel& seen : result.seen.pixels()) {
    EXPECT_EQ(seen.bounces, 5u);
    EXPECT_EQ(seen.object, 0u);
  }
}

}  // namespace
}  // namespace catoptric::reference

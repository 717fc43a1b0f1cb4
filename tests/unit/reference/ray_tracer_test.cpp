// SPDX-License-Identifier: Apache-2.0
// Rules of the picture: mirrors, visibility, transparency, textures, robustness.
#include "catoptric/reference/ray_tracer.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "catoptric/core/error.h"
#include "catoptric/core/parallel.h"
#include "traced_scene.h"

namespace catoptric::reference {
namespace {

void expectColor(const vec4& actual, const vec3& expected, float tolerance = 1e-6f) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(actual[i], expected[i], tolerance) << "channel " << i;
  EXPECT_EQ(actual.a, 1);
}

/// A quad of 2 x 2 around the origin facing +z.
scene::MeshPrimitive makeFacingQuad(float z = 0, float repeat = 1) {
  return makeQuad({-1, -1, z}, {2, 0, 0}, {0, 2, 0}, repeat);
}

/// Looks along -z from z = 3 at the origin; the picture's centre pixel looks straight on.
void lookAtOrigin(TracedTestScene& t) {
  t.camera.eye = {0, 0, 3};
  t.camera.target = {0, 0, 0};
}

vec4 centreOf(const TraceResult& result) {
  return result.radiance.at(result.radiance.width() / 2, result.radiance.height() / 2);
}
core::SeenPixel centreSeen(const TraceResult& result) {
  return result.seen.at(result.seen.width() / 2, result.seen.height() / 2);
}

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

TEST(RayTracer, TouchingTheMirrorIsSeenInIt) {
  // A ball that rests on a mirror floor: its image touches it.
  TracedTestScene t;
  t.add(makeQuad({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}), makeMirror(), "floor");
  t.add(makeBall(128, 64), makeUnlit({1, 0, 0}), "ball", glm::translate(dmat4(1), dvec3(0, 1, 0)));
  t.camera.eye = {0, 0.3, 6};
  t.camera.target = {0, 0, 0};
  t.finish();
  const TraceResult result = t.trace(65, 65);
  for (int y = 24; y < 41; ++y) EXPECT_EQ(result.seen.at(32, y).object, 1u) << y;
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

TracedTestScene makeBusyScene() {
  TracedTestScene t;
  t.scene.textures.push_back(makeChecker(4, 8));
  scene::Material floor;
  floor.metallic = 0;
  floor.baseColorTexture.texture = 0;
  t.add(makeQuad({-9, -1, 9}, {18, 0, 0}, {0, 0, -18}, 4), floor, "floor");
  for (int i = 0; i < 4; ++i)
    t.add(makeBall(48, 24), makeMirror(), "ball",
          glm::translate(dmat4(1), dvec3(2.2 * (i % 2) - 1.1, 0, 2.2 * (i / 2) - 1.1)));
  t.camera.eye = {1, 2, 7};
  t.finish();
  return t;
}

template <class Pixel>
bool equalBytes(const core::Image<Pixel>& a, const core::Image<Pixel>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Pixel)) == 0;
}

TEST(RayTracer, SameBytesOnEveryRunAndThreadCount) {
  const TracedTestScene t = makeBusyScene();
  const TraceOptions options{.bounces = 3, .samples = 2};
  const TraceResult first = t.trace(101, 67, options), second = t.trace(101, 67, options);
  core::setThreadCount(1);
  const TraceResult alone = t.trace(101, 67, options);
  const TracedTestScene rebuilt = makeBusyScene();
  const TraceResult again = rebuilt.trace(101, 67, options);
  core::setThreadCount(0);
  for (const TraceResult* other : {&second, &alone, &again}) {
    EXPECT_TRUE(equalBytes(first.radiance, other->radiance));
    EXPECT_TRUE(equalBytes(first.seen, other->seen));
    EXPECT_TRUE(equalBytes(first.footprints, other->footprints));
    EXPECT_EQ(first.rays, other->rays);
  }
}

TEST(RayTracer, SamplesChangeRadianceButNotWhatIsSeen) {
  const TracedTestScene t = makeBusyScene();
  const TraceResult one = t.trace(64, 48), eight = t.trace(64, 48, {.samples = 8});
  EXPECT_TRUE(equalBytes(one.seen, eight.seen));
  EXPECT_TRUE(equalBytes(one.footprints, eight.footprints));
  EXPECT_FALSE(equalBytes(one.radiance, eight.radiance));
  double meanOne = 0, meanEight = 0;
  for (std::size_t i = 0; i < one.radiance.size(); ++i) {
    meanOne += one.radiance.data()[i].g;
    meanEight += eight.radiance.data()[i].g;
    EXPECT_EQ(eight.radiance.data()[i].a, 1);
  }
  EXPECT_NEAR(meanOne / meanEight, 1, 0.01);
  const TraceResult bare = t.trace(64, 48, {.withSeen = false, .withFootprints = false});
  EXPECT_TRUE(bare.seen.isEmpty() && bare.footprints.isEmpty());
  EXPECT_TRUE(equalBytes(one.radiance, bare.radiance));
}

TEST(RayTracer, OddNormalsAndGrazingViewsGiveNoNan) {
  TracedTestScene t;
  scene::MeshPrimitive quad = makeQuad({-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
  quad.normals = {vec3(0, 1, 0), vec3(0, -1, 0), vec3(1, 0, 0), vec3(-1, 0, 0)};  // cancel in the middle
  t.scene.textures.push_back(makeChecker(2, 2));
  scene::Material material = makeMirror();
  material.doubleSided = true;
  material.normalTexture.texture = 0;  // half its texels are no direction at all
  t.add(quad, material, "twisted");
  scene::Material rough;
  rough.metallic = 0;
  rough.doubleSided = true;
  quad.normals.assign(4, vec3(0, 1, 0));
  t.add(quad, rough, "floor", glm::translate(dmat4(1), dvec3(0, -1, 0)));
  scene::Light light;
  light.position = {0, 0, 0};
  t.scene.lights.push_back(light);
  t.finish();
  for (const dvec3& eye :
       {dvec3(0, 0, 5), dvec3(0, 1e-7, 5), dvec3(0, 3, 0.001), dvec3(0, 0, 0), dvec3(1e9, 1, 0)}) {
    t.camera.eye = eye;
    t.camera.target = eye + dvec3(0, -1e-4, -1);
    const TraceResult result = t.trace(64, 64, {.bounces = 4});
    for (const vec4& pixel : result.radiance.pixels())
      EXPECT_TRUE(std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b));
    for (const core::Footprint& f : result.footprints.pixels())
      EXPECT_TRUE(std::isfinite(glm::dot(f.dPdx, vec3(1))) && std::isfinite(glm::dot(f.dPdy, vec3(1))));
  }
}

TEST(RayTracer, NonFiniteVerticesAreLeftOut) {
  TracedTestScene t;
  t.add(makeFacingQuad(), makeUnlit({0, 1, 0}), "quad");
  t.add(makeFacingQuad(1), makeUnlit({1, 0, 0}), "broken");
  t.finish();
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                       1e30f};
  for (const float value : bad) {
    t.world.positions[4].x = value;
    t.world.positions[6].y = value;
    t.tracer = std::make_unique<RayTracer>(t.scene, t.world, t.environment);
    lookAtOrigin(t);
    expectColor(centreOf(t.trace(31, 31)), {0, 1, 0});
  }
}

TEST(RayTracer, NonFiniteCameraIsRefused) {
  TracedTestScene t = makeBusyScene();
  scene::CameraFrame frame = t.frame(20, 20);
  frame.eye.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)t.tracer->trace(frame, {}), core::Error);
  frame = t.frame(20, 20);
  frame.forward = frame.right = frame.up = dvec3(0);
  EXPECT_THROW((void)t.tracer->trace(frame, {}), core::Error);
}

TEST(RayTracer, SaysWhatItRunsOn) {
  TracedTestScene t;
  t.finish();
  EXPECT_NE(t.tracer->describe().find("Embree 3."), std::string::npos);
}

}  // namespace
}  // namespace catoptric::reference

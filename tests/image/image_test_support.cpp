// SPDX-License-Identifier: Apache-2.0
#include "image_test_support.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "catoptric/core/image_io.h"
#include "catoptric/core/tone_map.h"

namespace catoptric::image_test {
namespace {

/// Limits::largest of two pictures.
double findLargest(const core::ImageRgba8& actual, const core::ImageRgba8& expected) {
  constexpr int kRadius = 2, kPixels = (2 * kRadius + 1) * (2 * kRadius + 1);
  int largest = 0;
  for (int y = kRadius; y < actual.height() - kRadius; ++y)
    for (int x = kRadius; x < actual.width() - kRadius; ++x) {
      glm::ivec4 sum(0);
      for (int v = y - kRadius; v <= y + kRadius; ++v)
        for (int u = x - kRadius; u <= x + kRadius; ++u)
          sum += glm::ivec4(actual.at(u, v)) - glm::ivec4(expected.at(u, v));
      for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(sum[k]));
    }
  return double(largest) / kPixels;
}

void writePng(const std::string& name, const core::ImageRgba8& image) {
  const std::filesystem::path folder(CATOPTRIC_IMAGE_OUTPUT);
  std::filesystem::create_directories(folder);
  const std::vector<std::byte> bytes = core::encodePng(image);
  std::ofstream(folder / name, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

}  // namespace

const scene::Environment& sky() {
  static const scene::Environment environment = scene::makeSkyEnvironment();
  return environment;
}

core::ImageRgba8 draw(const Subject& subject, const scene::WorldGeometry& world, renderer::Method method,
                      int sizePx) {
  renderer::Renderer renderer(subject.scene, world, sky());
  return core::toneMap(renderer
                           .render(subject.camera, {.method = method,
                                                    .solver = subject.solver,
                                                    .widthPx = sizePx,
                                                    .heightPx = sizePx,
                                                    .bounces = subject.bounces,
                                                    .allParts = subject.allParts,
                                                    .withSeen = false})
                           .radiance);
}

bool isWithin(const std::string& name, const core::ImageRgba8& actual, const core::ImageRgba8& expected,
              const Limits& limits) {
  const double largest = findLargest(actual, expected);
  const double mean = metrics::compareImages(actual, expected).meanDifference;
  std::printf("%-24s largest %5.1f of %4.1f, mean %.3f of %.3f (%s)\n", name.c_str(), largest, limits.largest,
              mean, limits.mean, limits.reason);
  return largest <= limits.largest && mean <= limits.mean;
}

void writeFailure(const std::string& name, const core::ImageRgba8& actual, const core::ImageRgba8& expected) {
  writePng(name + ".actual.png", actual);
  writePng(name + ".expected.png", expected);
  writePng(name + ".difference.png", metrics::makeDifferencePicture(actual, expected));
  std::printf("%s: pictures are in %s\n", name.c_str(), CATOPTRIC_IMAGE_OUTPUT);
}

void expectWithin(const Subject& subject, const scene::WorldGeometry& twin, const Limits& limits) {
  const core::ImageRgba8 truth = draw(subject, subject.world, renderer::Method::RayTrace);
  const core::ImageRgba8 actual = draw(subject, subject.world, renderer::Method::Virtual);
  const bool isGood = isWithin(subject.name, actual, truth, limits);
  EXPECT_TRUE(isGood) << subject.name;
  if (!isGood) writeFailure(subject.name, actual, truth);
  EXPECT_FALSE(
      isWithin(subject.name + ", twin", draw(subject, twin, renderer::Method::Virtual), truth, limits))
      << "the limits are too wide to see a fault";
}

scene::WorldGeometry withTurnedNormals(scene::WorldGeometry world, double radians) {
  const dmat3 turn(glm::rotate(dmat4(1.0), radians, dvec3(1, 0, 0)));
  for (const scene::Part& part : world.parts) {
    if (part.reflector == core::kNoId ||
        world.reflectors[part.reflector].shape == scene::ReflectorShape::Plane)
      continue;
    for (std::uint32_t v = part.firstVertex; v < part.firstVertex + part.vertexCount; ++v)
      world.normals[v] = vec3(turn * dvec3(world.normals[v]));
  }
  return world;
}

scene::WorldGeometry withTurnedPlanes(scene::WorldGeometry world, double radians) {
  for (scene::Reflector& mirror : world.reflectors) {
    const dvec3 n = mirror.plane.normal;
    const dvec3 axis = glm::normalize(glm::cross(n, std::abs(n.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0)));
    mirror.plane.normal = dmat3(glm::rotate(dmat4(1.0), radians, axis)) * n;
    mirror.plane.offset = -glm::dot(mirror.plane.normal, mirror.centre);
  }
  return world;
}

}  // namespace catoptric::image_test

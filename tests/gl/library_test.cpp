// SPDX-License-Identifier: Apache-2.0
// The functions of shaders/lib give the same numbers in a fragment shader as compiled by C++, for random
// inputs. The comparison of raster with ray-traced pictures stands on that.
//
// Tolerance, relative to the larger of 1 and the value: 1e-5 for arithmetic, which is 80 roundings of float;
// 1e-4 where a transcendental function is called, whose precision GLSL leaves to the driver; GGX squares a
// difference near zero for smooth surfaces and divides by it, so that 2^-23 grows to 1e-3 at the least
// roughness drawn here (0.2).
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "catoptric/scene/shading.h"
#include "gl_test_support.h"

namespace catoptric::gl::test {
namespace {

namespace glsl = scene::glsl;
using Library = GlTest;

constexpr int kCases = 512, kRows = 11;
using Rows = std::array<vec4, kRows>;

/// Numbered as in shaders/library.frag.
struct Function {
  const char* name;
  double tolerance;
};
constexpr std::array<Function, 15> kFunctions{{{"fresnelSchlick", 1e-5},
                                               {"surfaceF0", 1e-5},
                                               {"mirrorWeight", 1e-5},
                                               {"lightIrradiance", 1e-5},
                                               {"shadeLight", 1e-3},
                                               {"environmentBrdf", 1e-4},
                                               {"shadeAmbient", 1e-4},
                                               {"shadeSurface", 1e-4},
                                               {"latLongFromDirection", 1e-4},
                                               {"environmentLod", 1e-4},
                                               {"evaluateIrradiance", 1e-5},
                                               {"textureLodFromDerivatives", 1e-4},
                                               {"relativeIndex", 1e-6},
                                               {"refractionWeight", 1e-4},
                                               {"absorbLight", 1e-5}}};

std::vector<Rows> makeInputs() {
  std::mt19937 random(7);
  const auto uniform = [&](float low, float high) {
    return low + (high - low) * float(random() >> 8) / float(1u << 24);
  };
  const auto direction = [&] {
    vec3 v;
    do v = vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    while (glm::dot(v, v) > 1 || glm::dot(v, v) < 0.01f);
    return glm::normalize(v);
  };
  const auto color = [&] { return vec3(uniform(0, 1), uniform(0, 1), uniform(0, 1)); };
  std::vector<Rows> inputs(kCases);
  for (Rows& r : inputs) {
    const bool isReflector = random() % 4 == 0;
    r[0] = vec4(3.0f * direction(), float(random() % 3) * 0.5f);          // position, metallic
    r[1] = vec4(direction(), uniform(0.2f, 1));                           // normal, roughness
    r[2] = vec4(direction(), uniform(0, 1));                              // to viewer, occlusion
    r[3] = vec4(color(), uniform(0.02f, 0.1f));                           // base colour, F0
    r[4] = vec4(color(), isReflector ? uniform(0.1f, 1) : 0.0f);          // emissive, reflectivity
    r[5] = vec4(5.0f * color(), isReflector ? uniform(0, 1) : 0.0f);      // light colour, clearcoat
    r[6] = vec4(3.0f * direction(), float(random() % 3));                 // light position, kind
    r[7] = vec4(direction(), random() % 2 == 0 ? 0.0f : uniform(1, 10));  // light direction, range
    r[8] = vec4(uniform(0.8f, 1), uniform(0.1f, 0.7f), uniform(0, 1),
                // cone, a cosine, relative index
                random() % 2 == 0 ? 0.0f : uniform(0.5f, 2));
    r[9] = vec4(direction(), uniform(0.5f, 4));
    r[10] = vec4(direction(), uniform(0, 1));  // transmission
  }
  return inputs;
}

glsl::Surface readSurface(const Rows& r) {
  glsl::Surface s{};
  s.position = vec3(r[0]), s.normal = vec3(r[1]), s.toViewer = vec3(r[2]);
  s.baseColor = vec3(r[3]), s.emissive = vec3(r[4]);
  s.metallic = r[0].w, s.roughness = r[1].w, s.occlusion = r[2].w, s.f0Dielectric = r[3].w;
  s.coatNormal = vec3(r[9]), s.reflectivity = r[4].w, s.clearcoat = r[5].w;
  s.eta = r[8].w, s.transmission = r[10].w;
  return s;
}

glsl::PunctualLight readLight(const Rows& r) {
  glsl::PunctualLight light{};
  light.color = vec3(r[5]), light.position = vec3(r[6]), light.direction = vec3(r[7]);
  light.kind = int(r[6].w), light.range = r[7].w, light.cosInner = r[8].x, light.cosOuter = r[8].y;
  return light;
}

/// main() of shaders/library.frag.
vec3 evaluate(int function, const Rows& r) {
  const glsl::Surface s = readSurface(r);
  const glsl::PunctualLight light = readLight(r);
  const vec3 a(r[9]), b(r[10]);
  switch (function) {
    case 0:
      return glsl::fresnelSchlick(s.baseColor, r[8].z);
    case 1:
      return glsl::surfaceF0(s);
    case 2:
      return glsl::mirrorWeight(s);
    case 3:
      return glsl::lightIrradiance(light, s, a, r[9].w);
    case 4:
      return glsl::shadeLight(light, s);
    case 5:
      return vec3(glsl::environmentBrdf(s.roughness, r[8].z), 0);
    case 6:
      return glsl::shadeAmbient(s, s.emissive, light.color);
    case 7:
      return glsl::shadeSurface(s, light.color, s.emissive, b);
    case 8:
      return vec3(glsl::latLongFromDirection(s.normal), 0);
    case 9:
      return vec3(glsl::environmentLod(a * 0.01f, b * 0.01f, 2048.0f));
    case 10:
      return glsl::evaluateIrradiance(s.position, s.baseColor, s.emissive, light.color, light.position, a, b,
                                      light.direction, s.toViewer, s.normal);
    case 12:
      return vec3(glsl::relativeIndex(1.0f + r[10].w, a.x > 0.0f));
    case 13:
      return glsl::refractionWeight(s);
    case 14:
      return glsl::absorbLight(s.emissive, r[9].w);
    default:
      return vec3(glsl::textureLodFromDerivatives(vec2(a) * 30.0f, vec2(b) * 30.0f, 8.0f));
  }
}

std::vector<vec4> evaluateOnGpu(int function, const std::vector<Rows>& inputs) {
  std::vector<vec4> texels(std::size_t(kCases) * kRows);
  for (std::size_t i = 0; i < inputs.size(); ++i)
    for (std::size_t row = 0; row < kRows; ++row) texels[row * kCases + i] = inputs[i][row];
  Texture texture(TextureKind::Flat, Format::Rgba32F, kCases, kRows, 1, 1, {});
  texture.upload(0, 0, texels.data());
  const TestProgram program("screen.vert", "library.frag");
  const FloatTarget target(kCases, 1);
  const VertexArray nothing;
  target.framebuffer.bind();
  setDrawState({.depthTest = false, .depthWrite = false});
  program.use();
  program.set("u_inputs", 0);
  program.set("u_function", function);
  texture.bind(0);
  nothing.bind();
  drawScreen();
  return target.read();
}

/// Largest difference, relative to the larger of 1 and the value.
double computeDifference(const std::vector<vec4>& gpu, int function, const std::vector<Rows>& inputs) {
  double largest = 0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const vec3 cpu = evaluate(function, inputs[i]);
    for (int k = 0; k < 3; ++k) {
      const double difference =
          std::abs(double(gpu[i][k]) - double(cpu[k])) / std::max(1.0, std::abs(double(cpu[k])));
      largest = std::isfinite(difference) ? std::max(largest, difference) : 1e30;
    }
  }
  return largest;
}

TEST_F(Library, givesTheSameNumbersOnTheGpu) {
  const std::vector<Rows> inputs = makeInputs();
  for (std::size_t f = 0; f < kFunctions.size(); ++f) {
    const double difference = computeDifference(evaluateOnGpu(int(f), inputs), int(f), inputs);
    EXPECT_LE(difference, kFunctions[f].tolerance) << kFunctions[f].name;
    std::printf("%-26s largest relative difference %.1e\n", kFunctions[f].name, difference);
  }
}

TEST_F(Library, anotherNormalDoesNotPass) {
  const std::vector<Rows> inputs = makeInputs();
  std::vector<Rows> wrong = inputs;
  for (Rows& r : wrong) r[1] = vec4(glm::normalize(vec3(r[1]) + vec3(0, 0.01f, 0)), r[1].w);
  for (const std::size_t f : {2, 3, 4, 6, 7, 8, 10})
    EXPECT_GT(computeDifference(evaluateOnGpu(int(f), wrong), int(f), inputs), kFunctions[f].tolerance)
        << kFunctions[f].name;
}

}  // namespace
}  // namespace catoptric::gl::test

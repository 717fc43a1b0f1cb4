// SPDX-License-Identifier: Apache-2.0
// Textures that show something: paintings and toy-block faces.
#include <array>
#include <cmath>
#include <vector>

#include "catoptric/scene/built_in/noise.h"
#include "catoptric/scene/built_in/textures.h"

namespace catoptric::scene::built_in {
namespace {

double smooth(double from, double to, double x) {
  return glm::smoothstep(from, to, x);
}
vec3 blend(const vec3& a, const vec3& b, double t) {
  return glm::mix(a, b, float(t));
}

double distanceToSegment(const dvec2& p, const dvec2& a, const dvec2& b) {
  const dvec2 ab = b - a;
  const double t = glm::clamp(glm::dot(p - a, ab) / std::max(glm::dot(ab, ab), 1e-12), 0.0, 1.0);
  return glm::distance(p, a + t * ab);
}

/// Strokes of a symbol as open polylines on a grid 4 wide and 6 high, y upwards.
std::vector<std::vector<dvec2>> symbolStrokes(char symbol) {
  switch (symbol) {
    case 'A':
      return {{{0, 0}, {2, 6}, {4, 0}}, {{0.8, 2.3}, {3.2, 2.3}}};
    case 'B':
      return {{{0, 0}, {0, 6}, {2.6, 6}, {3.6, 5.4}, {3.6, 3.9}, {2.6, 3.2}, {0, 3.2}},
              {{2.6, 3.2}, {4, 2.4}, {4, 0.8}, {3, 0}, {0, 0}}};
    case 'C':
      return {{{4, 5}, {3, 6}, {1, 6}, {0, 5}, {0, 1}, {1, 0}, {3, 0}, {4, 1}}};
    case 'D':
      return {{{0, 0}, {0, 6}, {2.4, 6}, {4, 4.6}, {4, 1.4}, {2.4, 0}, {0, 0}}};
    case 'E':
      return {{{4, 0}, {0, 0}, {0, 6}, {4, 6}}, {{0, 3.1}, {3, 3.1}}};
    case 'F':
      return {{{0, 0}, {0, 6}, {4, 6}}, {{0, 3.1}, {3, 3.1}}};
    case '1':
      return {{{0.8, 4.6}, {2, 6}, {2, 0}}, {{0.8, 0}, {3.2, 0}}};
    case '2':
      return {{{0, 4.8}, {1, 6}, {3, 6}, {4, 5}, {4, 4}, {0, 0}, {4, 0}}};
    case '3':
      return {{{0, 5}, {1, 6}, {3, 6}, {4, 5}, {4, 4}, {3, 3.1}, {1.4, 3.1}},
              {{3, 3.1}, {4, 2.2}, {4, 1}, {3, 0}, {1, 0}, {0, 1}}};
    case '4':
      return {{{3, 0}, {3, 6}, {0, 2}, {4, 2}}};
    case '5':
      return {{{3.8, 6}, {0.3, 6}, {0, 3.4}, {1, 3.8}, {3, 3.8}, {4, 2.8}, {4, 1}, {3, 0}, {1, 0}, {0, 0.8}}};
    default:
      return {{{3.6, 6},
               {1.4, 5},
               {0, 2.6},
               {0, 1},
               {1, 0},
               {3, 0},
               {4, 1},
               {4, 2.2},
               {3, 3.2},
               {1, 3.2},
               {0, 2.2}}};
  }
}

}  // namespace

Pattern blockFace(char symbol, const vec3& ground, const vec3& ink) {
  const std::vector<std::vector<dvec2>> strokes = symbolStrokes(symbol);
  return [=](dvec2 uv) {
    const dvec2 p((uv.x - 0.5) * 10 + 2, (0.5 - uv.y) * 10 + 3);
    double distance = 1e9;
    for (const auto& line : strokes)
      for (std::size_t i = 0; i + 1 < line.size(); ++i)
        distance = std::min(distance, distanceToSegment(p, line[i], line[i + 1]));
    const double edge = std::min(std::min(uv.x, 1 - uv.x), std::min(uv.y, 1 - uv.y));
    const double grain = fractalNoise({uv.x * 3, uv.y * 14}, ivec2(3, 14), 4, 23u + std::uint32_t(symbol));
    vec3 c = ground * float(0.92 + 0.16 * grain);
    c = blend(c, ink, smooth(0.62, 0.52, distance));
    return blend(c, ink, smooth(0.01, 0.02, edge) * smooth(0.085, 0.075, edge));
  };
}

Pattern landscapePainting() {
  const vec3 high = colour(0x4E86B8), low = colour(0xF3D9A8), lake = colour(0x5D8FA8), sun = colour(0xFFF1C0);
  const std::array<vec3, 4> hills = {colour(0x8FA3B5), colour(0x6F8F86), colour(0x55793F), colour(0x36552A)};
  return [=](dvec2 uv) {
    const double brush = fractalNoise({uv.x * 40, uv.y * 90}, ivec2(40, 90), 3, 61);
    vec3 c = blend(high, low, smooth(0.0, 0.62, uv.y));
    const double cloud = fractalNoise({uv.x * 4, uv.y * 10}, ivec2(4, 10), 5, 8);
    c = blend(c, vec3(0.95f), 0.7 * smooth(0.52, 0.75, cloud) * smooth(0.55, 0.2, uv.y));
    c = blend(c, sun, smooth(0.075, 0.06, glm::distance(dvec2(uv.x * 1.4, uv.y), dvec2(0.98, 0.3))));
    for (int i = 0; i < 4; ++i) {
      const double crest =
          0.42 + 0.09 * i -
          (0.22 - 0.03 * i) *
              (fractalNoise({uv.x * (2 + i), 0.5}, ivec2(64), 4, 30u + std::uint32_t(i)) - 0.35);
      c = blend(c, hills[std::size_t(i)], smooth(crest - 0.004, crest + 0.004, uv.y));
    }
    const double shore = 0.8 + 0.02 * std::sin(uv.x * 9);
    const double ripple = fractalNoise({uv.x * 6, uv.y * 80}, ivec2(6, 80), 2, 19);
    c = blend(c, blend(lake, low, 0.5 * ripple), smooth(shore, shore + 0.01, uv.y));
    return c * float(0.85 + 0.3 * brush);
  };
}

Pattern abstractPainting() {
  struct Area {
    dvec2 lower, upper;
    vec3 ink;
  };
  const std::vector<Area> areas = {{{0.0, 0.0}, {0.34, 0.45}, colour(0xC8342B)},
                                   {{0.62, 0.0}, {1.0, 0.28}, colour(0x1F4E9C)},
                                   {{0.34, 0.62}, {0.62, 1.0}, colour(0xE7B928)},
                                   {{0.82, 0.62}, {1.0, 1.0}, colour(0x1E2A33)},
                                   {{0.0, 0.8}, {0.16, 1.0}, colour(0x3C8A5A)}};
  return [=](dvec2 uv) {
    vec3 c = colour(0xEFE9DC);
    double line = 1;
    for (const Area& a : areas) {
      const dvec2 inside = glm::min(uv - a.lower, a.upper - uv);
      if (inside.x > 0 && inside.y > 0) c = a.ink;
    }
    for (double x : {0.34, 0.62, 0.82}) line = std::min(line, std::abs(uv.x - x));
    for (double y : {0.28, 0.45, 0.62, 0.8}) line = std::min(line, std::abs(uv.y - y));
    const double ring = std::abs(glm::distance(uv, dvec2(0.6, 0.46)) - 0.2);
    c = blend(c, colour(0x1B1B1B), smooth(0.014, 0.011, line));
    c = blend(c, colour(0xD86A1D), smooth(0.03, 0.026, ring));
    return c * float(0.92 + 0.16 * fractalNoise(uv * 30.0, ivec2(30), 3, 3));
  };
}

}  // namespace catoptric::scene::built_in

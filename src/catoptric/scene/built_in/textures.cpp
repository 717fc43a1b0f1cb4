// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/built_in/textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "catoptric/core/parallel.h"
#include "catoptric/core/tone_map.h"
#include "catoptric/scene/built_in/noise.h"

namespace catoptric::scene::built_in {
namespace {

double smooth(double from, double to, double x) {
  return glm::smoothstep(from, to, x);
}

vec3 blend(const vec3& a, const vec3& b, double t) {
  return glm::mix(a, b, float(t));
}

/// Distance to the nearest integer multiple of `step`.
double distanceToGrid(double x, double step) {
  const double t = x / step;
  return std::abs(t - std::round(t)) * step;
}

int floorInt(double x) {
  const int truncated = int(x);
  return truncated > x ? truncated - 1 : truncated;
}

std::uint8_t toSrgbByte(float linear) {
  static const std::array<std::uint8_t, 4097> table = [] {
    std::array<std::uint8_t, 4097> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const float root =
          float(i) / 4096.0f;  // the table runs over the square root, for fine steps in the dark
      values[i] = std::uint8_t(std::lround(255.0f * core::srgbFromLinear(root * root)));
    }
    return values;
  }();
  // Rounded as by std::lround(), which is a function call: of a float the sum is exact in double.
  return table[std::size_t(2.0 * double(std::sqrt(std::clamp(linear, 0.0f, 1.0f)) * 4096.0f) + 1.0) / 2];
}

}  // namespace

vec3 colour(std::uint32_t srgbHex) {
  const auto channel = [&](int shift) {
    return core::linearFromSrgb(float((srgbHex >> shift) & 0xff) / 255.0f);
  };
  return {channel(16), channel(8), channel(0)};
}

core::ImageRgba8 paintTexture(int widthPx, int heightPx, const Pattern& pattern, int samplesPerAxis) {
  core::ImageRgba8 image(widthPx, heightPx);
  core::parallelFor(std::size_t(heightPx), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      for (int x = 0; x < widthPx; ++x) {
        vec3 sum(0);
        for (int sy = 0; sy < samplesPerAxis; ++sy)
          for (int sx = 0; sx < samplesPerAxis; ++sx)
            sum += pattern({(x + (sx + 0.5) / samplesPerAxis) / widthPx,
                            (double(y) + (sy + 0.5) / samplesPerAxis) / heightPx});
        sum /= float(samplesPerAxis * samplesPerAxis);
        image.at(x, int(y)) = {toSrgbByte(sum.r), toSrgbByte(sum.g), toSrgbByte(sum.b), 255};
      }
  });
  return image;
}

Pattern repeated(Pattern pattern, const dvec2& times) {
  return [pattern = std::move(pattern), times](dvec2 uv) {
    const dvec2 scaled = uv * times;
    return pattern(scaled - glm::floor(scaled));
  };
}

Pattern shaded(Pattern pattern, std::function<double(dvec2)> factor) {
  return [pattern = std::move(pattern), factor = std::move(factor)](dvec2 uv) {
    return pattern(uv) * float(factor(uv));
  };
}

Pattern plain(const vec3& c) {
  return [c](dvec2) { return c; };
}

Pattern checker(const vec3& first, const vec3& second, int columns, int rows, double wear) {
  return [=](dvec2 uv) {
    const int x = floorInt(uv.x * columns), y = floorInt(uv.y * rows);
    const double blotch = fractalNoise(uv * 6.0, ivec2(6), 5, 11);
    const double own = hashToUnit(x, y, 5);
    const double shade = 1 + wear * (blotch - 0.5) * 2 + 0.4 * wear * (own - 0.5);
    return ((x + y) % 2 == 0 ? first : second) * float(shade);
  };
}

Pattern woodPlanks(const vec3& light, const vec3& dark, int boards, std::uint32_t seed) {
  return [=](dvec2 uv) {
    const int board = floorInt(uv.y * boards);
    const double across = uv.y * boards - board;
    const double shift = (std::floor(hashToUnit(board, 1, seed) * 8) + 0.5) / 8;  // no joint at the seam
    const double along = uv.x + shift;
    const int piece = floorInt(along * 2) % 2;  // two boards to a repeat, ends staggered by `shift`
    const double tone = hashToUnit(board, piece + 2, seed);
    // Grain: noise stretched along the board; its own offset for each board.
    const dvec2 p(along * 4 + 7.0 * piece, across * 6 + 13.0 * board);
    const double rings = fractalNoise({p.x, p.y * 2.5}, ivec2(4, 1 << 16), 4, seed + 1);
    const double fibre = fractalNoise({p.x * 4, p.y * 16}, ivec2(16, 1 << 16), 2, seed + 2);
    const double grain = 0.5 + 0.5 * std::sin(18 * rings + 3 * across);
    const double mixture =
        std::clamp(0.15 + 0.45 * tone + 0.3 * (grain - 0.5) + 0.25 * (fibre - 0.5), 0.0, 1.0);
    const double endJoint = distanceToGrid(along, 0.5) * boards;
    const double joint =
        std::min(smooth(0.0, 0.035, std::min(across, 1 - across)), smooth(0.0, 0.05, endJoint));
    return blend(light, dark, mixture) * float(0.55 + 0.45 * joint);
  };
}

Pattern bricks(const vec3& brick, const vec3& mortar, int columns, int rows, std::uint32_t seed) {
  return [=](dvec2 uv) {
    const int row = floorInt(uv.y * rows);
    const double x = uv.x * columns + 0.5 * (row % 2);
    const int column = floorInt(x) % columns;
    const double dx = std::min(x - std::floor(x), 1 - (x - std::floor(x))) * 2.0;  // bricks are about 2:1
    const double dy = std::min(uv.y * rows - row, 1 - (uv.y * rows - row));
    const double rough = fractalNoise(uv * 32.0, ivec2(32), 3, seed);
    const double edge = smooth(0.05, 0.11, std::min(dx, dy) + 0.05 * (rough - 0.5));
    const double tone = 0.8 + 0.35 * hashToUnit(column, row, seed + 7) + 0.4 * (rough - 0.5);
    return blend(mortar * float(0.85 + 0.3 * rough), brick * float(tone), edge);
  };
}

Pattern tiles(const vec3& tile, const vec3& joint, int count, std::uint32_t seed) {
  return [=](dvec2 uv) {
    const int x = floorInt(uv.x * count), y = floorInt(uv.y * count);
    const double step = 1.0 / count;
    const double distance = std::min(distanceToGrid(uv.x, step), distanceToGrid(uv.y, step)) * count;
    const double cloud = fractalNoise(uv * 8.0, ivec2(8), 4, seed);
    const double tone = 0.92 + 0.12 * hashToUnit(x, y, seed + 3) + 0.16 * (cloud - 0.5);
    return blend(joint, tile * float(tone), smooth(0.012, 0.03, distance));
  };
}

Pattern plaster(const vec3& c, double contrast, std::uint32_t seed) {
  return [=](dvec2 uv) {
    const double soft = fractalNoise(uv * 5.0, ivec2(5), 6, seed);
    const double fine = periodicNoise(uv * 128.0, ivec2(128), seed + 9);
    return c * float(1 + contrast * (2 * (soft - 0.5) + 0.35 * (fine - 0.5)));
  };
}

Pattern speckle(const vec3& dark, const vec3& light, int grains, std::uint32_t seed) {
  return [=](dvec2 uv) {
    const double fine = periodicNoise(uv * double(grains), ivec2(grains), seed);
    const double coarse = fractalNoise(uv * 6.0, ivec2(6), 4, seed + 5);
    return blend(dark, light, std::clamp(0.5 + 0.7 * (fine - 0.5) + 0.5 * (coarse - 0.5), 0.0, 1.0));
  };
}

Pattern grass(std::uint32_t seed) {
  const vec3 deep = colour(0x3E5A26), fresh = colour(0x7D9A45), dry = colour(0xA3A05E);
  return [=](dvec2 uv) {
    const double field = fractalNoise(uv * 4.0, ivec2(4), 5, seed);
    const double blades = fractalNoise({uv.x * 96, uv.y * 32}, ivec2(96, 32), 2, seed + 3);
    const vec3 green = blend(deep, fresh, std::clamp(0.6 * blades + 0.8 * (field - 0.5) + 0.25, 0.0, 1.0));
    return blend(green, dry, 0.5 * smooth(0.5, 0.8, field));
  };
}

Pattern rug(const vec3& ground, const vec3& figure, const vec3& border) {
  return [=](dvec2 uv) {
    const double edge = std::min(std::min(uv.x, 1 - uv.x), std::min(uv.y, 1 - uv.y));
    const double weave = 0.86 + 0.14 * std::sin(uv.x * 700) * std::sin(uv.y * 500) +
                         0.25 * (fractalNoise(uv * 40.0, ivec2(40), 2, 77) - 0.5);
    const double diamond = std::abs(distanceToGrid(uv.x, 0.2) * 5 + distanceToGrid(uv.y, 0.25) * 4 - 0.5);
    vec3 c = diamond < 0.09 ? figure : diamond > 0.36 ? blend(ground, border, 0.5) : ground;
    if (edge < 0.1) c = edge > 0.035 && edge < 0.085 ? border : figure;
    if (edge > 0.055 && edge < 0.065) c = ground;
    return c * float(weave);
  };
}

Pattern globe() {
  const vec3 sea = colour(0x2F6FA8), land = colour(0x6E9A4B), desert = colour(0xC9AE6D),
             ice = colour(0xEEF2F4);
  return [=](dvec2 uv) {
    const double height = fractalNoise({uv.x * 6, uv.y * 3}, ivec2(6, 1 << 16), 5, 4);
    const double latitude = std::abs(uv.y - 0.5) * 2;
    const vec3 ground = blend(desert, land, smooth(0.1, 0.45, latitude));
    vec3 c = blend(sea, ground, smooth(0.5, 0.515, height));
    c = blend(c, ice, smooth(0.78, 0.84, latitude + 0.2 * (height - 0.5)));
    const double line = std::min(distanceToGrid(uv.x, 1.0 / 12), distanceToGrid(uv.y, 1.0 / 6) * 0.5);
    return blend(c, c * 0.6f, 1 - smooth(0.0006, 0.002, line));
  };
}

Pattern stripes(const vec3& first, const vec3& second, int count, int slant) {
  return [=](dvec2 uv) {
    const double t = uv.y * count + uv.x * slant;
    return t - std::floor(t) < 0.5 ? first : second;
  };
}

}  // namespace catoptric::scene::built_in

// SPDX-License-Identifier: Apache-2.0
#include "catoptric/sketch/sketch.h"

#include <algorithm>
#include <cmath>

namespace catoptric::sketch {

void Sketch::addBox(const core::Box& box, Colour colour, float widthPx) {
  const auto corner = [&](int k) {
    return dvec3(k & 1 ? box.upper.x : box.lower.x, k & 2 ? box.upper.y : box.lower.y,
                 k & 4 ? box.upper.z : box.lower.z);
  };
  for (int k = 0; k < 8; ++k)
    for (const int side : {1, 2, 4})
      if ((k & side) == 0) addLine(corner(k), corner(k | side), colour, widthPx);
}

void Sketch::addCircle(const dvec3& centre, double radius, const dvec3& x, const dvec3& y, Colour colour) {
  constexpr int kPieces = 96;
  const auto at = [&](int i) {
    const double angle = glm::two_pi<double>() * i / kPieces;
    return centre + radius * (std::cos(angle) * x + std::sin(angle) * y);
  };
  for (int i = 0; i < kPieces; ++i) addLine(at(i), at(i + 1), colour);
}

void Sketch::addDashes(const dvec3& from, const dvec3& to, double dash, Colour colour, float widthPx) {
  constexpr double kMostDashes = 400;
  const double length = glm::length(to - from);
  if (!(length > 0) || !(dash > 0)) return;
  const double step = std::max(dash, length / kMostDashes);
  const dvec3 unit = (to - from) / length;
  for (double t = 0; t < length; t += 2 * step)
    addLine(from + t * unit, from + std::min(t + step, length) * unit, colour, widthPx);
}

void Sketch::addEye(const scene::CameraFrame& camera, double size) {
  addDot(camera.eye, kBlack, 6);
  dvec3 corners[4];
  for (int k = 0; k < 4; ++k)
    corners[k] = camera.eye + size * camera.rayDirection(k == 0 || k == 3 ? 0 : camera.widthPx,
                                                         k < 2 ? 0 : camera.heightPx);
  for (int k = 0; k < 4; ++k) {
    addLine(camera.eye, corners[k], kBlack, 1.5f);
    addLine(corners[k], corners[(k + 1) % 4], kBlack, 1.5f);
  }
}

void Sketch::add(const Sketch& other) {
  faces.insert(faces.end(), other.faces.begin(), other.faces.end());
  lines.insert(lines.end(), other.lines.begin(), other.lines.end());
  dots.insert(dots.end(), other.dots.begin(), other.dots.end());
}

core::ImageRgba8 halve(const core::ImageRgba8& picture) {
  core::ImageRgba8 half(picture.width() / 2, picture.height() / 2);
  for (int y = 0; y < half.height(); ++y)
    for (int x = 0; x < half.width(); ++x) {
      glm::uvec4 sum(2);
      for (int k = 0; k < 4; ++k) sum += glm::uvec4(picture.at(2 * x + (k & 1), 2 * y + (k >> 1)));
      half.at(x, y) = glm::u8vec4(sum / 4u);
    }
  return half;
}

core::ImageRgba8 enlarge(const core::ImageRgba8& picture, int factor) {
  core::ImageRgba8 large(factor * picture.width(), factor * picture.height());
  for (int y = 0; y < large.height(); ++y)
    for (int x = 0; x < large.width(); ++x) large.at(x, y) = picture.at(x / factor, y / factor);
  return large;
}

void fade(core::ImageRgba8& picture, float share) {
  for (glm::u8vec4& pixel : picture.pixels())
    pixel = glm::u8vec4(glm::mix(vec4(pixel), vec4(255), share) + 0.5f);
}

Colour colourOfNumber(std::uint32_t number, float strength) {
  const float hue = float(number % 4096u) * 0.61803399f;  // steps of the golden angle, three brightnesses
  const float value = strength * (0.6f + 0.2f * float(number % 3u));
  Colour colour(0, 0, 0, 255);
  for (int c = 0; c < 3; ++c) {
    const float phase = hue + float(c) / 3.0f;
    const float wave = std::abs((phase - std::floor(phase)) * 6.0f - 3.0f) - 1.0f;
    colour[c] = std::uint8_t(255.0f * value * (0.25f + 0.75f * glm::clamp(wave, 0.0f, 1.0f)));
  }
  return colour;
}

core::ImageRgba8 putSideBySide(const std::vector<core::ImageRgba8>& pictures, int gapPx) {
  int tallest = 0, width = 0;
  for (const core::ImageRgba8& picture : pictures) tallest = std::max(tallest, picture.height());
  std::vector<int> factors;
  for (const core::ImageRgba8& picture : pictures) {
    factors.push_back(std::max(1, tallest / std::max(picture.height(), 1)));
    width += factors.back() * picture.width() + (factors.size() > 1 ? gapPx : 0);
  }
  core::ImageRgba8 row(width, tallest, glm::u8vec4(255));
  int left = 0;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const int k = factors[i];
    for (int y = 0; y < k * pictures[i].height(); ++y)
      for (int x = 0; x < k * pictures[i].width(); ++x) row.at(left + x, y) = pictures[i].at(x / k, y / k);
    left += k * pictures[i].width() + gapPx;
  }
  return row;
}

}  // namespace catoptric::sketch

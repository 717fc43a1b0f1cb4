// SPDX-License-Identifier: Apache-2.0
// Brightness differences between two 8-bit sRGB pictures, inside a mask.
//
// PSNR: 10 log10(255^2 / mean squared difference of the three channels of the masked pixels).
// SSIM: of Rec. 601 luma, 11x11 Gaussian window with sigma 1.5, K1 = 0.01, K2 = 0.03 (Wang, Bovik, Sheikh,
// Simoncelli 2004), averaged over the masked pixels. A window looks beyond the mask, and at the picture's
// border it is cut off and renormalised (the paper leaves the border out; a mask may be all border).
#include "catoptric/metrics/image_difference.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>

#include "catoptric/core/parallel.h"

namespace catoptric::metrics {
namespace {

constexpr int kWindowRadius = 5;
constexpr double kWindowSigma = 1.5;

using Plane = core::Image<float>;

Plane makeLuma(const core::ImageRgba8& image) {
  Plane luma(image.width(), image.height());
  for (std::size_t i = 0; i < image.size(); ++i) {
    const auto& p = image.pixels()[i];
    luma.pixels()[i] = 0.299f * float(p.r) + 0.587f * float(p.g) + 0.114f * float(p.b);
  }
  return luma;
}

/// One direction of the Gaussian blur; `stepX`, `stepY` is (1,0) or (0,1).
Plane blurAlong(const Plane& image, int stepX, int stepY) {
  std::array<double, kWindowRadius + 1> weights{};
  for (int i = 0; i <= kWindowRadius; ++i)
    weights[std::size_t(i)] = std::exp(-0.5 * i * i / (kWindowSigma * kWindowSigma));
  Plane result(image.width(), image.height());
  core::parallelFor(std::size_t(image.height()), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = int(begin); y < int(end); ++y)
      for (int x = 0; x < image.width(); ++x) {
        double sum = 0, total = 0;
        for (int k = -kWindowRadius; k <= kWindowRadius; ++k) {
          const int sx = x + k * stepX, sy = y + k * stepY;
          if (sx < 0 || sy < 0 || sx >= image.width() || sy >= image.height()) continue;
          sum += weights[std::size_t(std::abs(k))] * image.at(sx, sy);
          total += weights[std::size_t(std::abs(k))];
        }
        result.at(x, y) = float(sum / total);
      }
  });
  return result;
}

Plane blur(const Plane& image) {
  return blurAlong(blurAlong(image, 1, 0), 0, 1);
}

Plane multiply(const Plane& a, const Plane& b) {
  Plane product(a.width(), a.height());
  for (std::size_t i = 0; i < a.size(); ++i) product.pixels()[i] = a.pixels()[i] * b.pixels()[i];
  return product;
}

double computeSsim(const core::ImageRgba8& a, const core::ImageRgba8& b,
                   const core::Image<std::uint8_t>& mask) {
  const Plane lumaA = makeLuma(a), lumaB = makeLuma(b);
  const Plane meanA = blur(lumaA), meanB = blur(lumaB);
  const Plane squareA = blur(multiply(lumaA, lumaA)), squareB = blur(multiply(lumaB, lumaB));
  const Plane cross = blur(multiply(lumaA, lumaB));
  constexpr double kC1 = 0.01 * 255 * 0.01 * 255, kC2 = 0.03 * 255 * 0.03 * 255;
  double sum = 0;
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!mask.isEmpty() && mask.pixels()[i] == 0) continue;
    const double ma = meanA.pixels()[i], mb = meanB.pixels()[i];
    const double varianceA = std::max(squareA.pixels()[i] - ma * ma, 0.0);
    const double varianceB = std::max(squareB.pixels()[i] - mb * mb, 0.0);
    const double covariance = cross.pixels()[i] - ma * mb;
    sum += (2 * ma * mb + kC1) * (2 * covariance + kC2) /
           ((ma * ma + mb * mb + kC1) * (varianceA + varianceB + kC2));
    ++count;
  }
  return count == 0 ? 1.0 : sum / double(count);
}

}  // namespace

ImageDifference compareImages(const core::ImageRgba8& a, const core::ImageRgba8& b,
                              const core::Image<std::uint8_t>& mask) {
  assert(a.width() == b.width() && a.height() == b.height());
  assert(mask.isEmpty() || (mask.width() == a.width() && mask.height() == a.height()));
  ImageDifference result;
  double squares = 0, sum = 0;
  std::uint64_t within = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!mask.isEmpty() && mask.pixels()[i] == 0) continue;
    int largest = 0;
    for (int channel = 0; channel < 3; ++channel) {
      const int difference = std::abs(int(a.pixels()[i][channel]) - int(b.pixels()[i][channel]));
      largest = std::max(largest, difference);
      sum += difference;
      squares += double(difference) * difference;
    }
    ++result.pixels;
    within += largest <= 4 ? 1 : 0;
    result.largestDifference = std::max(result.largestDifference, largest);
  }
  if (result.pixels == 0) return result;
  const double values = 3.0 * double(result.pixels);
  result.meanDifference = sum / values;
  result.shareWithin4 = double(within) / double(result.pixels);
  if (squares > 0) result.psnrDb = 10.0 * std::log10(255.0 * 255.0 * values / squares);
  result.ssim = squares > 0 || !mask.isEmpty() ? computeSsim(a, b, mask) : 1.0;
  return result;
}

}  // namespace catoptric::metrics

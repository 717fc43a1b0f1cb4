// SPDX-License-Identifier: Apache-2.0
#include "catoptric/metrics/image_difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "catoptric/metrics/displacement.h"

namespace catoptric::metrics {
namespace {

core::ImageRgba8 makeNoise(int widthPx, int heightPx, unsigned seed) {
  std::mt19937 random(seed);
  core::ImageRgba8 image(widthPx, heightPx);
  for (auto& p : image.pixels())
    p = {std::uint8_t(random() % 256), std::uint8_t(random() % 256), std::uint8_t(random() % 256), 255};
  return image;
}

core::ImageRgba8 brighten(core::ImageRgba8 image, int by) {
  for (auto& p : image.pixels())
    for (int c = 0; c < 3; ++c) p[c] = std::uint8_t(std::min(255, int(p[c]) + by));
  return image;
}

TEST(ImageDifference, EqualPicturesAreEqual) {
  const auto image = makeNoise(40, 30, 1);
  const auto result = compareImages(image, image);
  EXPECT_EQ(result.pixels, 1200u);
  EXPECT_TRUE(std::isinf(result.psnrDb));
  EXPECT_DOUBLE_EQ(result.ssim, 1);
  EXPECT_EQ(result.shareWithin4, 1);
  EXPECT_EQ(result.largestDifference, 0);
}

TEST(ImageDifference, ConstantOffsetHasTheTextbookPsnr) {
  const core::ImageRgba8 grey(32, 32, {100, 100, 100, 255});
  const auto four = compareImages(grey, brighten(grey, 4));
  EXPECT_NEAR(four.psnrDb, 20 * std::log10(255.0 / 4), 1e-9);
  EXPECT_EQ(four.shareWithin4, 1);
  EXPECT_EQ(four.meanDifference, 4);
  const auto five = compareImages(grey, brighten(grey, 5));
  EXPECT_EQ(five.shareWithin4, 0);
  EXPECT_EQ(five.largestDifference, 5);
  const double c1 = 0.01 * 255 * 0.01 * 255;  // constant pictures: only the luminance term of SSIM remains
  EXPECT_NEAR(five.ssim, (2 * 100 * 105 + c1) / (100.0 * 100 + 105.0 * 105 + c1), 1e-3);
}

TEST(ImageDifference, SsimTellsStructureFromBrightness) {
  const auto image = makeNoise(64, 64, 2);
  EXPECT_LT(std::abs(compareImages(image, makeNoise(64, 64, 3)).ssim), 0.1);
  EXPECT_GT(compareImages(image, brighten(image, 3)).ssim, 0.98);
}

TEST(ImageDifference, OnlyTheMaskCounts) {
  const auto image = makeNoise(40, 40, 4);
  auto other = image;
  core::Image<std::uint8_t> mask(40, 40, 0);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      if (x < 10) mask.at(x, y) = 1;
      if (x >= 30) other.at(x, y) = {0, 0, 0, 255};
    }
  const auto inside = compareImages(image, other, mask);
  EXPECT_EQ(inside.pixels, 400u);
  EXPECT_TRUE(std::isinf(inside.psnrDb));
  EXPECT_DOUBLE_EQ(inside.ssim, 1);
  EXPECT_LT(compareImages(image, other).psnrDb, 20);
  const auto nowhere = compareImages(image, other, core::Image<std::uint8_t>(40, 40, 0));
  EXPECT_EQ(nowhere.pixels, 0u);
}

TEST(ImageDifference, EmptyPictures) {
  EXPECT_EQ(compareImages({}, {}).pixels, 0u);
}

TEST(DifferencePicture, IsBlackWhereEqualAndAmplifiedElsewhere) {
  const core::ImageRgba8 grey(2, 1, {100, 100, 100, 255});
  auto other = grey;
  other.at(1, 0) = {103, 99, 255, 255};
  const auto picture = makeDifferencePicture(grey, other, 8);
  EXPECT_EQ(picture.at(0, 0), glm::u8vec4(0, 0, 0, 255));
  EXPECT_EQ(picture.at(1, 0), glm::u8vec4(24, 8, 255, 255));
}

TEST(DisplacementPicture, ColoursFollowTheRamp) {
  core::Image<float> displacement(4, 1, -1.0f);
  displacement.at(1, 0) = 0;
  displacement.at(2, 0) = 1;
  displacement.at(3, 0) = kLostPx;
  const auto picture = makeDisplacementPicture(displacement, core::ImageRgba8(4, 1, {80, 80, 80, 255}));
  EXPECT_EQ(picture.at(0, 0).r, picture.at(0, 0).b);           // no mirror: grey
  EXPECT_GT(picture.at(1, 0).b, picture.at(1, 0).g);           // right: blue
  EXPECT_GT(picture.at(2, 0).g, 2 * picture.at(2, 0).b - 60);  // 1 px: green
  EXPECT_GT(picture.at(2, 0).g, picture.at(2, 0).r);
  EXPECT_GT(picture.at(3, 0).r, 2 * picture.at(3, 0).g);  // lost: red
}

}  // namespace
}  // namespace catoptric::metrics

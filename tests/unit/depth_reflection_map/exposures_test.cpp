// SPDX-License-Identifier: Apache-2.0
// What uncovered pixels show: on a picture of ten by six pixels, all of it mirror but the last column.
#include "catoptric/depth_reflection_map/exposures.h"

#include <gtest/gtest.h>

namespace catoptric::depth_reflection_map {
namespace {

constexpr int kWidth = 10, kHeight = 6;
constexpr std::uint32_t kWord = 5, kSecond = 1u << kWinnerTagShift;

struct Exposures : testing::Test {
  Exposures() : ids(kWidth * kHeight, uvec2(0, kWord)) {
    for (int y = 0; y < kHeight; ++y) ids[std::size_t(y * kWidth + kWidth - 1)].y = 0;
    image.reset({0, 0, kWidth, kHeight}, false);
  }
  std::vector<uvec2> ids;
  MirrorPixels mirror{ids, kWidth, kWord};
  WinnerImage image;
};

TEST_F(Exposures, CountsMirrorPixelsOnly) {
  image.at(2, 3) = 7;
  image.at(kWidth - 1, 0) = 8;
  const Coverage coverage = measureCoverage(image, mirror);
  EXPECT_EQ(coverage.pixels, 54u);
  EXPECT_EQ(coverage.uncovered, 53u);
}

TEST_F(Exposures, TheFarthestNeighbourIsContinuedButNotTheSky) {
  image.at(1, 2) = 10;  // 10 m away
  image.at(5, 2) = 3;
  image.at(3, 4) = 99;  // sky
  const auto distance = [](std::uint32_t winner) { return winner == 99 ? 0.0 : double(winner); };
  continueSurfaces(mirror, image, distance);
  EXPECT_EQ(image.at(3, 2), 10u);
  EXPECT_EQ(image.at(6, 2), 3u);  // 10 m is not the first winner in its direction
  EXPECT_EQ(image.at(3, 4), 99u);
  EXPECT_EQ(image.at(8, 0), 0u);           // sees none
  EXPECT_EQ(image.at(kWidth - 1, 2), 0u);  // no mirror
}

TEST_F(Exposures, LastFramesZexelsAreKeptWhileTheirReferenceIsInUse) {
  WinnerImage last;
  last.reset({1, 0, kWidth, kHeight}, false);  // its first column is the second of `image`
  last.at(0, 1) = 4;
  last.at(1, 1) = 6 | kSecond;
  last.at(2, 1) = 8;
  image.at(3, 1) = 2;
  keepLastFrame(last, {1, kNoTag, kNoTag, kNoTag}, image);
  EXPECT_EQ(image.at(1, 1), 4u | kSecond);
  EXPECT_EQ(image.at(2, 1), 0u);
  EXPECT_EQ(image.at(3, 1), 2u);
}

}  // namespace
}  // namespace catoptric::depth_reflection_map

// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/texture_mips.h"

#include <gtest/gtest.h>

namespace catoptric::scene {
namespace {

TEST(TextureMips, SizesHalveDownToOne) {
  const auto levels = makeMipChain(core::ImageRgba8(12, 5), true);
  ASSERT_EQ(levels.size(), 4u);
  const int widths[] = {12, 6, 3, 1}, heights[] = {5, 2, 1, 1};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(levels[i].width(), widths[i]);
    EXPECT_EQ(levels[i].height(), heights[i]);
  }
  EXPECT_TRUE(makeMipChain({}, true).empty());
  EXPECT_EQ(makeMipChain(core::ImageRgba8(1, 1), false).size(), 1u);
}

TEST(TextureMips, EveryConstantByteStaysWhatItIs) {
  for (int value = 0; value < 256; ++value) {
    const auto byte = std::uint8_t(value);
    for (const bool srgb : {false, true}) {
      const auto levels = makeMipChain(core::ImageRgba8(8, 8, glm::u8vec4(byte)), srgb);
      EXPECT_EQ(levels.back().at(0, 0), glm::u8vec4(byte)) << value << " srgb " << srgb;
    }
  }
}

TEST(TextureMips, BlackAndWhiteMeetInLinearLight) {
  core::ImageRgba8 image(2, 2, glm::u8vec4(0));
  image.at(1, 0) = image.at(0, 1) = glm::u8vec4(255);
  const glm::u8vec4 colour = makeMipChain(image, true).back().at(0, 0),
                    data = makeMipChain(image, false).back().at(0, 0);
  EXPECT_EQ(colour, glm::u8vec4(188, 188, 188, 128));  // alpha is linear always
  EXPECT_EQ(data, glm::u8vec4(128));
}

TEST(TextureMips, RoundsToNearest) {
  core::ImageRgba8 image(2, 2, glm::u8vec4(10));
  image.at(0, 0) = glm::u8vec4(11);
  EXPECT_EQ(makeMipChain(image, false)[1].at(0, 0).r, 10);
  image.at(1, 0) = glm::u8vec4(11);
  EXPECT_EQ(makeMipChain(image, false)[1].at(0, 0).r, 11);
}

}  // namespace
}  // namespace catoptric::scene

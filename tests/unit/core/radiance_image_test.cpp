// SPDX-License-Identifier: Apache-2.0
// Radiance .hdr in all its encodings, and OpenEXR.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>

#include "catoptric/core/file.h"
#include "catoptric/core/image_io.h"
#include "test_support.h"

namespace catoptric::core {
namespace {

using Bytes = std::vector<std::byte>;

Bytes toBytes(const std::string& text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

enum class Runs { Flat, Old, New };

constexpr int kWidth = 20, kHeight = 6;

/// Pixel of the test picture: some runs, some variety, one black.
glm::u8vec4 rgbeAt(int x, int y) {
  if (x == 19 && y == 5) return {0, 0, 0, 0};
  if (x < 12) return {100 + y, 50, 25, 128 + y};
  return {9 * x, 255 - 7 * y, 128, 130};
}

vec3 radianceAt(int x, int y) {
  const glm::u8vec4 p = rgbeAt(x, y);
  return p.a == 0 ? vec3(0) : vec3(p) * std::ldexp(1.0f, int(p.a) - 136);
}

std::string encodeRow(int y, Runs runs) {
  std::string out;
  const auto put = [&](int value) { out.push_back(char(value)); };
  if (runs == Runs::New) {
    for (const int value : {2, 2, 0, kWidth}) put(value);
    for (int c = 0; c < 4; ++c) {
      put(128 + 12);  // a run, then literals
      put(rgbeAt(0, y)[c]);
      put(kWidth - 12);
      for (int x = 12; x < kWidth; ++x) put(rgbeAt(x, y)[c]);
    }
    return out;
  }
  for (int x = 0; x < kWidth; ++x) {
    for (int c = 0; c < 4; ++c) put(rgbeAt(x, y)[c]);
    if (x == 0 && runs == Runs::Old) {
      for (const int value : {1, 1, 1, 11}) put(value);
      x = 11;
    }
  }
  return out;
}

std::string makeHdr(Runs runs, const std::string& variables = "FORMAT=32-bit_rle_rgbe\n",
                    const std::string& resolution = "-Y 6 +X 20") {
  std::string file = "#?RADIANCE\n# a comment\n" + variables + "\n" + resolution + "\n";
  for (int y = 0; y < kHeight; ++y) file += encodeRow(y, runs);
  return file;
}

class RadianceImage : public ::testing::Test {
 protected:
  ImageRgbF read(std::span<const std::byte> bytes, std::size_t maxPixels = kDefaultMaxPixels) {
    // A new file each time: replacing one makes some file systems flush, which is slow a thousand times.
    std::filesystem::remove(folder_ / "picture");
    std::ofstream(folder_ / "picture", std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    return readRadianceImage(folder_ / "picture", maxPixels);
  }
  ImageRgbF read(const std::string& text) { return read(toBytes(text)); }

  TemporaryFolder folder_;
};

TEST_F(RadianceImage, AllEncodingsGiveTheSamePixels) {
  for (const Runs runs : {Runs::Flat, Runs::Old, Runs::New}) {
    const ImageRgbF image = read(makeHdr(runs));
    ASSERT_EQ(image.width(), kWidth);
    ASSERT_EQ(image.height(), kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        EXPECT_EQ(image.at(x, y), radianceAt(x, y)) << x << " " << y << " " << int(runs);
  }
}

TEST_F(RadianceImage, LongOldRunsAreShifted) {
  // 1 + 3 + 2 * 256 pixels: the second of two neighbouring run pixels counts 256-fold.
  std::string file = "#?RGBE\n\n-Y 1 +X 516\n";
  file += std::string("\x40\x50\x60\x80", 4) + std::string("\x01\x01\x01\x03", 4) +
          std::string("\x01\x01\x01\x02", 4);
  const ImageRgbF image = read(file);
  EXPECT_EQ(image.at(515, 0), image.at(0, 0));
  EXPECT_EQ(image.at(0, 0), vec3(0x40, 0x50, 0x60) / 256.0f);
}

TEST_F(RadianceImage, ExposureIsDividedOutAndAxesAreTurned) {
  const ImageRgbF dark = read(makeHdr(Runs::New, "EXPOSURE=2\nEXPOSURE= 4\n"));
  EXPECT_EQ(dark.at(3, 2), radianceAt(3, 2) / 8.0f);
  const ImageRgbF turned = read(makeHdr(Runs::New, "", "+Y 6 -X 20"));
  EXPECT_EQ(turned.at(0, 0), radianceAt(kWidth - 1, kHeight - 1));
  EXPECT_EQ(turned.at(kWidth - 1, kHeight - 1), radianceAt(0, 0));
}

TEST_F(RadianceImage, WhatIsNotUnderstoodIsRefused) {
  const auto code = [&](const std::string& file) { return errorCode([&] { (void)read(file); }); };
  EXPECT_EQ(code(makeHdr(Runs::New, "FORMAT=32-bit_rle_xyze\n")), "image.unsupported");
  EXPECT_EQ(code(makeHdr(Runs::New, "", "+X 20 -Y 6")), "image.unsupported");
  EXPECT_EQ(code(makeHdr(Runs::New, "EXPOSURE=0\n")), "image.damaged");
  EXPECT_EQ(code(makeHdr(Runs::New, "EXPOSURE=nan\n")), "image.damaged");
  EXPECT_EQ(code(makeHdr(Runs::New, "", "-Y 6 +X -20")), "image.damaged");
  EXPECT_EQ(code(makeHdr(Runs::New, "", "nonsense")), "image.damaged");
  EXPECT_EQ(code(makeHdr(Runs::New, "", "-Y 1000000 +X 1000000")), "image.too_large");
  EXPECT_EQ(code(makeHdr(Runs::New, "", "-Y 99999 +X 600")), "image.damaged");  // far too few bytes for it
  EXPECT_EQ(code("not a picture"), "image.unknown_format");
  EXPECT_EQ(code(""), "image.unknown_format");
  EXPECT_EQ(errorCode([&] { (void)readRadianceImage(folder_ / "missing.hdr"); }), "file.not_found");
}

TEST_F(RadianceImage, EveryTruncationIsAnError) {
  for (const Runs runs : {Runs::Flat, Runs::Old, Runs::New})
    forEachTruncation(toBytes(makeHdr(runs)), 1, [&](std::span<const std::byte> part) {
      EXPECT_NE(errorCode([&] { (void)read(part); }), "") << part.size();
    });
}

TEST_F(RadianceImage, DamagedFilesNeverCrash) {
  constexpr std::size_t kMaxPixels = 1 << 20;
  int refused = 0;
  for (const Runs runs : {Runs::Flat, Runs::Old, Runs::New})
    forEachDamage(toBytes(makeHdr(runs)), 400, [&](std::span<const std::byte> bytes) {
      refused += !errorCode([&] { (void)read(bytes, kMaxPixels); }).empty();
    });
  EXPECT_GT(refused, 100);
}

TEST_F(RadianceImage, RealPanoramasAreRead) {
  const char* assets = std::getenv("CATOPTRIC_ASSETS");
  if (!assets) GTEST_SKIP() << "CATOPTRIC_ASSETS is not set";
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(assets) / "env")) {
    if (entry.path().extension() != ".hdr") continue;
    const ImageRgbF image = readRadianceImage(entry.path());
    EXPECT_EQ(image.width(), 2 * image.height()) << entry.path();
    float peak = 0;
    for (const vec3& pixel : image.pixels()) {
      ASSERT_TRUE(pixel.r >= 0 && pixel.g >= 0 && pixel.b >= 0 && std::isfinite(pixel.r + pixel.g + pixel.b));
      peak = std::max(peak, pixel.g);
    }
    EXPECT_GT(peak, 1.0f) << entry.path();
    ++count;
  }
  EXPECT_GT(count, 0);
}

// --- OpenEXR

struct ExrPixel {
  vec3 colour{0};
  std::uint32_t id = 0;
};

constexpr float kInfinity = std::numeric_limits<float>::infinity();

class Exr : public RadianceImage {
 protected:
  static constexpr int kW = 37, kH = 21;

  Exr() : pixels_(kW, kH) {
    for (int y = 0; y < kH; ++y)
      for (int x = 0; x < kW; ++x)
        pixels_.at(x, y) = {vec3(0.1f * float(x), 1e4f * float(y), -0.3f * float(x * y)),
                            std::uint32_t(x + 1000 * y)};
    pixels_.at(1, 0).colour.r = kInfinity;
    pixels_.at(2, 0).id = 0xffffffffu;
  }

  [[nodiscard]] std::vector<ExrChannel> channels() const {
    constexpr int kStride = sizeof(ExrPixel) / 4;
    const std::size_t span = (pixels_.size() - 1) * kStride + 1;
    const float* colour = &pixels_.data()->colour.x;
    return {{"R", {colour, span}, {}, kStride},
            {"G", {colour + 1, span}, {}, kStride},
            {"B", {colour + 2, span}, {}, kStride},
            {"object.id", {}, {&pixels_.data()->id, span}, kStride}};
  }

  Image<ExrPixel> pixels_;
};

TEST_F(Exr, RoundTripIsExact) {
  writeFileAtomically(folder_ / "a.exr", encodeExr(kW, kH, channels()));
  const ExrImage back = readExr(folder_ / "a.exr");
  ASSERT_EQ(back.widthPx, kW);
  ASSERT_EQ(back.heightPx, kH);
  ASSERT_EQ(back.names, (std::vector<std::string>{"B", "G", "R", "object.id"}));  // OpenEXR sorts them
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const ExrPixel& pixel = pixels_.data()[i];
    EXPECT_EQ(back.values[0][i], pixel.colour.b);
    EXPECT_EQ(back.values[1][i], pixel.colour.g);
    EXPECT_EQ(back.values[2][i], pixel.colour.r);
    EXPECT_EQ(back.values[3][i], float(pixel.id));
  }
  const ImageRgbF image = readRadianceImage(folder_ / "a.exr");
  EXPECT_EQ(image.at(5, 7), pixels_.at(5, 7).colour);
}

TEST_F(Exr, TwoEncodesGiveTheSameBytes) {
  EXPECT_EQ(encodeExr(kW, kH, channels()), encodeExr(kW, kH, channels()));
}

TEST_F(Exr, LuminanceIsReadAsGreyAndOtherChannelsAreRefused) {
  const float values[] = {1, 2, 3, 4, 5, 6};
  const ExrChannel grey[] = {{"Y", values, {}, 1}}, depth[] = {{"Z", values, {}, 1}};
  EXPECT_EQ(read(encodeExr(3, 2, grey)).at(2, 1), vec3(6));
  EXPECT_EQ(errorCode([&] { (void)read(encodeExr(3, 2, depth)); }), "image.unsupported");
  EXPECT_EQ(errorCode([&] { (void)encodeExr(0, 2, grey); }), "image.encode");
  EXPECT_EQ(errorCode([&] { (void)encodeExr(3, 2, {}); }), "image.encode");
}

TEST_F(Exr, PixelCap) {
  const Bytes bytes = encodeExr(kW, kH, channels());
  EXPECT_EQ(errorCode([&] { (void)read(bytes, kW * kH - 1); }), "image.too_large");
  EXPECT_EQ(errorCode([&] { (void)read(bytes, kW * kH); }), "");
}

TEST_F(Exr, EveryTruncationIsAnError) {
  const Bytes whole = encodeExr(kW, kH, channels());
  forEachTruncation(whole, 7, [&](std::span<const std::byte> part) {
    EXPECT_NE(errorCode([&] { (void)read(part); }), "") << part.size() << " of " << whole.size();
  });
}

TEST_F(Exr, DamagedFilesNeverCrash) {
  constexpr std::size_t kMaxPixels = 1 << 20;
  int refused = 0;
  forEachDamage(encodeExr(kW, kH, channels()), 1500, [&](std::span<const std::byte> bytes) {
    refused += !errorCode([&] { (void)read(bytes, kMaxPixels); }).empty();
  });
  EXPECT_GT(refused, 200);
}

}  // namespace
}  // namespace catoptric::core

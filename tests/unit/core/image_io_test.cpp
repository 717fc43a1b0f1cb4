// SPDX-License-Identifier: Apache-2.0
// PNG, JPEG and WebP. The pictures are encoded here, by the C libraries themselves where our own writer does
// not make that kind of file.
#include "catoptric/core/image_io.h"

#include <png.h>
#include <webp/encode.h>
#include <zlib.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

// clang-format off
#include <jpeglib.h>  // needs size_t and FILE
// clang-format on

#include "catoptric/core/log.h"
#include "test_support.h"

namespace catoptric::core {
namespace {

using Bytes = std::vector<std::byte>;

void appendTo(png_structp png, png_bytep data, std::size_t size) {
  auto* bytes = static_cast<Bytes*>(png_get_io_ptr(png));
  bytes->insert(bytes->end(), reinterpret_cast<std::byte*>(data), reinterpret_cast<std::byte*>(data) + size);
}

struct PngKind {
  int colourType, depth;
  bool interlaced, transparent;  // transparent: with a tRNS chunk
};

/// An 11x9 picture whose bytes are (17 x + 5 y) in every sample of the row.
Bytes makePng(const PngKind& kind) {
  constexpr png_uint_32 kWidth = 11, kHeight = 9;
  Bytes bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &bytes, appendTo, nullptr);
  png_set_IHDR(png, info, kWidth, kHeight, kind.depth, kind.colourType,
               kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_gAMA(png, info, 1.0);  // must not change the pixels
  if (kind.colourType == PNG_COLOR_TYPE_PALETTE) {
    png_color palette[2] = {{10, 20, 30}, {200, 100, 50}};
    png_set_PLTE(png, info, palette, 2);
    png_byte alpha[2] = {255, 77};
    if (kind.transparent) png_set_tRNS(png, info, alpha, 2, nullptr);
  } else if (kind.transparent) {
    png_color_16 key{};  // the samples of pixel (0, 0)
    png_set_tRNS(png, info, nullptr, 0, &key);
  }
  png_write_info(png, info);
  const std::size_t rowBytes = png_get_rowbytes(png, info);
  std::vector<png_byte> data(rowBytes * kHeight);
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < kHeight; ++y) {
    rows.push_back(data.data() + y * rowBytes);
    for (std::size_t x = 0; x < rowBytes; ++x)
      rows[y][x] = png_byte(kind.colourType == PNG_COLOR_TYPE_PALETTE ? (kind.depth == 8 ? (x + y) % 2 : 0x55)
                                                                      : 17 * x + 5 * y);
  }
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

/// libjpeg's own encoder: 1 channel is grey, 3 RGB, 4 CMYK.
Bytes makeJpeg(int channels, bool progressive) {
  jpeg_compress_struct info;
  jpeg_error_mgr errors;
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* out = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &out, &size);
  info.image_width = 40;
  info.image_height = 30;
  info.input_components = channels;
  info.in_color_space = channels == 1 ? JCS_GRAYSCALE : channels == 3 ? JCS_RGB : JCS_CMYK;
  jpeg_set_defaults(&info);
  if (progressive) jpeg_simple_progression(&info);
  jpeg_start_compress(&info, TRUE);
  for (int y = 0; y < 30; ++y) {
    std::vector<unsigned char> row;
    row.reserve(std::size_t(40) * std::size_t(channels));
    for (int x = 0; x < 40 * channels; ++x)
      row.push_back(static_cast<unsigned char>(3 * x / channels + 2 * y));
    JSAMPROW pointer = row.data();
    jpeg_write_scanlines(&info, &pointer, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  const auto* begin = reinterpret_cast<std::byte*>(out);
  Bytes bytes(begin, begin + size);
  std::free(out);
  return bytes;
}

Bytes makeWebp(const ImageRgba8& image, bool lossless) {
  const auto* pixels = reinterpret_cast<const std::uint8_t*>(image.data());
  std::uint8_t* out = nullptr;
  const std::size_t size =
      lossless ? WebPEncodeLosslessRGBA(pixels, image.width(), image.height(), image.width() * 4, &out)
               : WebPEncodeRGBA(pixels, image.width(), image.height(), image.width() * 4, 90, &out);
  const auto* begin = reinterpret_cast<std::byte*>(out);
  Bytes bytes(begin, begin + size);
  WebPFree(out);
  return bytes;
}

double meanDifference(const ImageRgba8& a, const ImageRgba8& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int c = 0; c < 3; ++c) sum += std::abs(int(a.data()[i][c]) - int(b.data()[i][c]));
  return sum / double(3 * a.size());
}

// --- PNG

TEST(Png, RoundTripIsExact) {
  for (const bool isOpaque : {true, false})
    for (const ivec2 size : {ivec2(1, 1), ivec2(33, 7), ivec2(128, 64)}) {
      const ImageRgba8 image = makePicture(size.x, size.y, isOpaque);
      const ImageRgba8 back = decodeImage(encodePng(image), "test.png");
      ASSERT_EQ(back.width(), size.x);
      ASSERT_EQ(back.height(), size.y);
      EXPECT_EQ(back.pixels(), image.pixels());
    }
}

TEST(Png, TwoEncodesGiveTheSameBytes) {
  const ImageRgba8 image = makePicture(64, 48, false);
  EXPECT_EQ(encodePng(image), encodePng(ImageRgba8(image)));
}

TEST(Png, EmptyImageIsRefused) {
  EXPECT_EQ(errorCode([] { (void)encodePng(ImageRgba8()); }), "image.encode");
}

TEST(Png, EveryKindIsRead) {
  const struct {
    int type, depth;
  } kinds[] = {{PNG_COLOR_TYPE_GRAY, 1},       {PNG_COLOR_TYPE_GRAY, 2},        {PNG_COLOR_TYPE_GRAY, 4},
               {PNG_COLOR_TYPE_GRAY, 8},       {PNG_COLOR_TYPE_GRAY, 16},       {PNG_COLOR_TYPE_RGB, 8},
               {PNG_COLOR_TYPE_RGB, 16},       {PNG_COLOR_TYPE_PALETTE, 1},     {PNG_COLOR_TYPE_PALETTE, 8},
               {PNG_COLOR_TYPE_GRAY_ALPHA, 8}, {PNG_COLOR_TYPE_GRAY_ALPHA, 16}, {PNG_COLOR_TYPE_RGBA, 8},
               {PNG_COLOR_TYPE_RGBA, 16}};
  for (const auto& kind : kinds)
    for (const bool transparent : {false, true}) {
      if (transparent && (kind.type & PNG_COLOR_MASK_ALPHA)) continue;
      const ImageRgba8 plain = decodeImage(makePng({kind.type, kind.depth, false, transparent}), "plain");
      const ImageRgba8 interlaced =
          decodeImage(makePng({kind.type, kind.depth, true, transparent}), "interlaced");
      ASSERT_EQ(plain.width(), 11);
      ASSERT_EQ(plain.height(), 9);
      EXPECT_EQ(plain.pixels(), interlaced.pixels()) << kind.type << " " << kind.depth;
      const bool hasAlpha = kind.type & PNG_COLOR_MASK_ALPHA;
      if (!hasAlpha && !transparent) {
        EXPECT_EQ(plain.at(3, 3).a, 255);
      }
    }
}

TEST(Png, SamplesAreWhatIsStored) {
  const ImageRgba8 rgb = decodeImage(makePng({PNG_COLOR_TYPE_RGB, 8, false, false}), "rgb");
  EXPECT_EQ(rgb.at(2, 3), glm::u8vec4((17 * 6 + 15) % 256, (17 * 7 + 15) % 256, (17 * 8 + 15) % 256, 255));
  const ImageRgba8 grey = decodeImage(makePng({PNG_COLOR_TYPE_GRAY, 8, false, true}), "grey");
  EXPECT_EQ(grey.at(0, 0), glm::u8vec4(0, 0, 0, 0));  // the tRNS key
  EXPECT_EQ(grey.at(1, 0), glm::u8vec4(17, 17, 17, 255));
  // 16 bits: high byte 17 * 2x, low byte 17 * (2x + 1), rounded to 8 bits.
  const ImageRgba8 deep = decodeImage(makePng({PNG_COLOR_TYPE_GRAY, 16, false, false}), "deep");
  const int value = (17 * 4) * 256 + 17 * 5;
  EXPECT_EQ(int(deep.at(2, 0).r), int(std::lround(value * 255.0 / 65535.0)));
  const ImageRgba8 palette = decodeImage(makePng({PNG_COLOR_TYPE_PALETTE, 8, false, true}), "palette");
  EXPECT_EQ(palette.at(0, 0), glm::u8vec4(10, 20, 30, 255));
  EXPECT_EQ(palette.at(1, 0), glm::u8vec4(200, 100, 50, 77));
}

TEST(Png, EveryTruncationIsAnError) {
  for (const bool interlaced : {false, true})
    forEachTruncation(makePng({PNG_COLOR_TYPE_RGBA, 16, interlaced, false}), 1,
                      [](std::span<const std::byte> part) {
                        EXPECT_NE(errorCode([&] { (void)decodeImage(part, "cut.png"); }), "") << part.size();
                      });
}

TEST(Png, PixelCapComesBeforeThePixels) {
  // A header of 60000 x 60000 with a right checksum: refused by its size, not by missing data.
  Bytes bytes = encodePng(makePicture(4, 4, true));
  const unsigned char header[] = {0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60, 8, 2, 0, 0, 0};
  std::memcpy(bytes.data() + 16, header, sizeof header);
  const unsigned long sum = crc32(0, reinterpret_cast<const Bytef*>(bytes.data()) + 12, 17);
  for (unsigned i = 0; i < 4; ++i) bytes[29 + i] = std::byte(sum >> (24 - 8 * i));
  EXPECT_EQ(errorCode([&] { (void)decodeImage(bytes, "huge.png"); }), "image.too_large");
  const Bytes real = encodePng(makePicture(100, 100, true));
  EXPECT_EQ(errorCode([&] { (void)decodeImage(real, "big.png", 9999); }), "image.too_large");
  EXPECT_EQ(errorCode([&] { (void)decodeImage(real, "big.png", 10000); }), "");
}

// --- JPEG

TEST(Jpeg, RoundTripIsClose) {
  const ImageRgba8 image = makePicture(64, 48, true);
  const ImageRgba8 back = decodeImage(encodeJpeg(image, 95), "test.jpg");
  ASSERT_EQ(back.size(), image.size());
  EXPECT_LT(meanDifference(image, back), 4.0);
  EXPECT_EQ(back.at(5, 5).a, 255);
  EXPECT_EQ(encodeJpeg(image), encodeJpeg(image));
  EXPECT_GT(encodeJpeg(image, 95).size(), encodeJpeg(image, 40).size());
}

TEST(Jpeg, GreyAndProgressiveAreReadAndCmykIsRefused) {
  const ImageRgba8 grey = decodeImage(makeJpeg(1, false), "grey.jpg");
  EXPECT_NEAR(int(grey.at(20, 10).r), 3 * 20 + 2 * 10, 3);
  EXPECT_EQ(grey.at(20, 10).r, grey.at(20, 10).g);
  EXPECT_EQ(grey.at(20, 10).a, 255);
  const ImageRgba8 plain = decodeImage(makeJpeg(3, false), "plain.jpg");
  const ImageRgba8 progressive = decodeImage(makeJpeg(3, true), "progressive.jpg");
  EXPECT_LT(meanDifference(plain, progressive), 1.0);
  EXPECT_EQ(errorCode([] { (void)decodeImage(makeJpeg(4, false), "cmyk.jpg"); }), "image.unsupported");
}

TEST(Jpeg, EveryTruncationIsAnError) {
  for (const bool progressive : {false, true})
    forEachTruncation(makeJpeg(3, progressive), 1, [](std::span<const std::byte> part) {
      EXPECT_NE(errorCode([&] { (void)decodeImage(part, "cut.jpg"); }), "") << part.size();
    });
}

TEST(Jpeg, PixelCapAndLimitsOfTheFormat) {
  EXPECT_EQ(errorCode([] { (void)decodeImage(makeJpeg(3, false), "big.jpg", 1199); }), "image.too_large");
  EXPECT_EQ(errorCode([] { (void)encodeJpeg(ImageRgba8(70000, 1)); }), "image.encode");
  EXPECT_EQ(errorCode([] { (void)encodeJpeg(ImageRgba8()); }), "image.encode");
}

// --- WebP

TEST(Webp, LosslessIsExactAndLossyIsClose) {
  const ImageRgba8 image = makePicture(48, 40, true);
  EXPECT_EQ(decodeImage(makeWebp(image, true), "test.webp").pixels(), image.pixels());
  EXPECT_LT(meanDifference(decodeImage(makeWebp(image, false), "test.webp"), image), 6.0);
  const ImageRgba8 glass(8, 8, glm::u8vec4(10, 200, 30, 99));
  EXPECT_EQ(decodeImage(makeWebp(glass, true), "glass.webp").pixels(), glass.pixels());
}

TEST(Webp, TruncationsAreErrorsOrLoseNothing) {
  for (const bool lossless : {true, false}) {
    const Bytes whole = makeWebp(makePicture(24, 20, true), lossless);
    const ImageRgba8 expected = decodeImage(whole, "whole.webp");
    forEachTruncation(whole, 1, [&](std::span<const std::byte> part) {
      // The last byte may be padding.
      (void)errorCode(
          [&] { EXPECT_EQ(decodeImage(part, "cut.webp").pixels(), expected.pixels()) << part.size(); });
      if (part.size() + 8 < whole.size()) {
        EXPECT_NE(errorCode([&] { (void)decodeImage(part, "cut.webp"); }), "") << part.size();
      }
    });
  }
}

TEST(Webp, PixelCap) {
  EXPECT_EQ(errorCode([] { (void)decodeImage(makeWebp(makePicture(20, 20, true), true), "big.webp", 399); }),
            "image.too_large");
}

// --- all of them

TEST(DecodeImage, UnknownFormatsAreNamed) {
  const auto message = [](std::string_view text) -> std::string {
    try {
      (void)decodeImage(std::as_bytes(std::span(text.data(), text.size())), "thing");
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), "image.unknown_format");
      return error.what();
    }
    return "no error";
  };
  EXPECT_NE(message("GIF89a....").find("GIF"), std::string::npos);
  EXPECT_NE(message("").find("empty"), std::string::npos);
  EXPECT_NE(message("hello").find("unknown"), std::string::npos);
  EXPECT_NE(message("<svg>").find("SVG"), std::string::npos);
  EXPECT_NE(message("hello").find("PNG, JPEG or WebP"), std::string::npos);
}

TEST(DecodeImage, StrayBytesAreSkippedWithAWarning) {
  Bytes file = makeJpeg(3, false);
  const ImageRgba8 expected = decodeImage(file, "clean.jpg");
  file.insert(file.begin() + 20, 5, std::byte(0x11));  // after the JFIF segment
  std::string warning;
  setLogCallback([&](LogLevel level, const std::string& line) {
    if (level == LogLevel::Warning) warning = line;
  });
  EXPECT_EQ(decodeImage(file, "stray.jpg").pixels(), expected.pixels());
  setLogCallback({});
  EXPECT_NE(warning.find("stray.jpg"), std::string::npos);
  EXPECT_NE(warning.find("extraneous"), std::string::npos);
}

TEST(DecodeImage, DamagedFilesNeverCrash) {
  const ImageRgba8 picture = makePicture(24, 20, false);
  const Bytes files[] = {encodePng(picture),
                         makePng({PNG_COLOR_TYPE_PALETTE, 1, true, true}),
                         makePng({PNG_COLOR_TYPE_RGB, 16, true, true}),
                         makeJpeg(3, false),
                         makeJpeg(3, true),
                         makeWebp(picture, true),
                         makeWebp(picture, false)};
  constexpr std::size_t kMaxPixels = 1 << 20;
  int read = 0, refused = 0;
  setLogCallback({});  // warnings about what was read all the same
  for (const Bytes& file : files)
    forEachDamage(file, 400, [&](std::span<const std::byte> bytes) {
      const std::string code = errorCode([&] { (void)decodeImage(bytes, "damaged", kMaxPixels); });
      ++(code.empty() ? read : refused);
      EXPECT_TRUE(code.empty() || code.starts_with("image.")) << code;
    });
  EXPECT_GT(refused, 500);  // the damage is real ...
  EXPECT_GT(read, 50);      // ... and some of it harmless
}

TEST(Png, DescriptionIsCarriedAndChangesNoPixel) {
  ImageRgba8 image(3, 2, glm::u8vec4(1, 2, 3, 255));
  const auto plain = encodePng(image), described = encodePng(image, "catoptric render x");
  const std::string text(reinterpret_cast<const char*>(described.data()), described.size());
  EXPECT_NE(text.find(std::string("Description\0catoptric render x", 30)), std::string::npos);
  EXPECT_EQ(decodeImage(plain, "plain").pixels(), decodeImage(described, "described").pixels());
}

}  // namespace
}  // namespace catoptric::core

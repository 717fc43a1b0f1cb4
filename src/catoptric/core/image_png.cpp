// SPDX-License-Identifier: Apache-2.0
// PNG through libpng's row interface (its "simplified" one would apply gamma, and glTF says that gAMA, cHRM
// and iCCP are to be ignored).
#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <exception>
#include <vector>

#include "catoptric/core/image_codec.h"
#include "catoptric/core/image_io.h"

namespace catoptric::core {
namespace {

struct Failure {
  char message[160] = "unknown error";
};

void onError(png_structp png, png_const_charp message) {
  auto* failure = static_cast<Failure*>(png_get_error_ptr(png));
  std::snprintf(failure->message, sizeof failure->message, "%s", message);
  png_longjmp(png, 1);
}

/// Warnings concern ancillary chunks (colour profiles, time), which we do not use.
void onWarning(png_structp, png_const_charp) {}

// --- reading

struct Reader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  codec::Bytes rest;
  Failure failure;

  Reader(codec::Bytes bytes) : rest(bytes) {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &failure, onError, onWarning);
    if (png) info = png_create_info_struct(png);
  }
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
};

void onRead(png_structp png, png_bytep out, std::size_t count) {
  auto* reader = static_cast<Reader*>(png_get_io_ptr(png));
  if (count > reader->rest.size()) png_error(png, "the file ends too early");
  std::memcpy(out, reader->rest.data(), count);
  reader->rest = reader->rest.subspan(count);
}

// The pixel cap is checked by the caller, in pixels and with its own message, so libpng's cap on the edges is
// lifted.
bool readHeader(Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  constexpr std::size_t kMaxChunkBytes = std::size_t(64) << 20;
  png_set_user_limits(reader.png, 0x7fffffff, 0x7fffffff);
  png_set_chunk_malloc_max(reader.png, kMaxChunkBytes);
  png_set_read_fn(reader.png, &reader, onRead);
  png_read_info(reader.png, reader.info);
  return true;
}

/// Asks libpng to make 8-bit RGBA of whatever the file holds.
bool startRgba8(Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_set_expand(reader.png);    // palette, 1-2-4 bits and tRNS
  png_set_scale_16(reader.png);  // rounds, where strip_16 would truncate
  png_set_gray_to_rgb(reader.png);
  png_set_add_alpha(reader.png, 0xff, PNG_FILLER_AFTER);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  return true;
}

bool readRows(Reader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);
  return true;
}

// --- writing

struct Writer {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::vector<std::byte> bytes;
  Failure failure;

  Writer() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &failure, onError, onWarning);
    if (png) info = png_create_info_struct(png);
  }
  ~Writer() { png_destroy_write_struct(&png, &info); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
};

bool append(std::vector<std::byte>& bytes, png_const_bytep data, std::size_t count) {
  try {
    const auto* begin = reinterpret_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), begin, begin + count);
    return true;
  } catch (const std::exception&) {  // must not travel through libpng
    return false;
  }
}

void onWrite(png_structp png, png_bytep data, std::size_t count) {
  if (!append(static_cast<Writer*>(png_get_io_ptr(png))->bytes, data, count)) png_error(png, "out of memory");
}

void onFlush(png_structp) {}

bool writeRows(Writer& writer, const ImageRgba8& image, bool isOpaque, png_bytep row, png_textp text) {
  if (setjmp(png_jmpbuf(writer.png))) return false;
  png_set_write_fn(writer.png, &writer, onWrite, onFlush);
  png_set_user_limits(writer.png, 0x7fffffff, 0x7fffffff);
  png_set_IHDR(writer.png, writer.info, png_uint_32(image.width()), png_uint_32(image.height()), 8,
               isOpaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_compression_level(writer.png, 6);
  if (text != nullptr) png_set_text(writer.png, writer.info, text, 1);
  png_write_info(writer.png, writer.info);
  for (int y = 0; y < image.height(); ++y) {
    const glm::u8vec4* pixels = image.data() + std::size_t(y) * std::size_t(image.width());
    png_bytep out = row;
    for (int x = 0; x < image.width(); ++x) {
      *out++ = pixels[x].r;
      *out++ = pixels[x].g;
      *out++ = pixels[x].b;
      if (!isOpaque) *out++ = pixels[x].a;
    }
    png_write_row(writer.png, row);
  }
  png_write_end(writer.png, nullptr);
  return true;
}

}  // namespace

ImageRgba8 codec::decodePng(Bytes bytes, const std::string& name, std::size_t maxPixels) {
  Reader reader(bytes);
  if (!reader.png || !reader.info) throwDamaged(name, "libpng cannot start");
  if (!readHeader(reader)) throwDamaged(name, reader.failure.message);
  const png_uint_32 width = png_get_image_width(reader.png, reader.info);
  const png_uint_32 height = png_get_image_height(reader.png, reader.info);
  checkPixelCount(width, height, name, maxPixels);
  if (!startRgba8(reader)) throwDamaged(name, reader.failure.message);
  if (png_get_rowbytes(reader.png, reader.info) != std::size_t(width) * 4)
    throwDamaged(name, "it does not convert to RGBA");

  ImageRgba8 image{int(width), int(height)};
  std::vector<png_bytep> rows(height);
  for (std::size_t y = 0; y < height; ++y)
    rows[y] = reinterpret_cast<png_bytep>(image.data() + y * std::size_t(width));
  if (!readRows(reader, rows.data())) throwDamaged(name, reader.failure.message);
  return image;
}

std::vector<std::byte> encodePng(const ImageRgba8& image, const std::string& description) {
  if (image.isEmpty()) throw Error("image.encode", "cannot encode a PNG without pixels");
  bool isOpaque = true;
  for (const glm::u8vec4& pixel : image.pixels()) isOpaque = isOpaque && pixel.a == 255;
  Writer writer;
  if (!writer.png || !writer.info) throw Error("image.encode", "cannot encode PNG: libpng cannot start");
  std::vector<png_byte> row(std::size_t(image.width()) * 4);
  char key[] = "Description";
  std::string value = description;
  png_text text{};
  text.compression = PNG_TEXT_COMPRESSION_NONE;
  text.key = key;
  text.text = value.data();
  text.text_length = value.size();
  if (!writeRows(writer, image, isOpaque, row.data(), value.empty() ? nullptr : &text))
    throw Error("image.encode", std::string("cannot encode PNG: ") + writer.failure.message);
  return std::move(writer.bytes);
}

}  // namespace catoptric::core

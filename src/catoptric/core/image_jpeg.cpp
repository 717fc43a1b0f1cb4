// SPDX-License-Identifier: Apache-2.0
// JPEG through libjpeg-turbo. libjpeg invents grey for missing data and only warns; here such a file is
// refused, so that a half-copied texture is not mistaken for a whole one.
#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

// clang-format off
#include <jpeglib.h>  // needs size_t and FILE
#include <jerror.h>   // needs jpeglib.h
// clang-format on

#include "catoptric/core/image_codec.h"
#include "catoptric/core/image_io.h"
#include "catoptric/core/log.h"

namespace catoptric::core {
namespace {

/// First member first: libjpeg hands back a pointer to `base`.
struct Failure {
  jpeg_error_mgr base{};
  std::jmp_buf jump{};
  char message[JMSG_LENGTH_MAX] = "unknown error";
  char harmless[JMSG_LENGTH_MAX] = "";  // the last warning that does not touch the pixels
};

void onError(j_common_ptr info) {
  auto* failure = reinterpret_cast<Failure*>(info->err);
  info->err->format_message(info, failure->message);
  std::longjmp(failure->jump, 1);
}

/// Level -1 is a warning. Stray bytes between segments and the like are common in camera files and lose
/// nothing; any other warning means that pixels were made up.
void onMessage(j_common_ptr info, int level) {
  if (level >= 0) return;
  auto* failure = reinterpret_cast<Failure*>(info->err);
  switch (info->err->msg_code) {
    case JWRN_EXTRANEOUS_DATA:
    case JWRN_ADOBE_XFORM:
    case JWRN_JFIF_MAJOR:
    case JWRN_NOT_SEQUENTIAL:
    case JWRN_BOGUS_ICC:
      info->err->format_message(info, failure->harmless);
      break;
    default:
      onError(info);
  }
}

/// A small progressive file can ask for thousands of passes over a large image.
void onProgress(j_common_ptr info) {
  constexpr int kMaxScans = 200;
  auto* decoder = reinterpret_cast<j_decompress_ptr>(info);
  if (info->is_decompressor && decoder->input_scan_number > kMaxScans) ERREXIT(info, JERR_BAD_PROGRESSION);
}

void installHandlers(Failure& failure) {
  jpeg_std_error(&failure.base);
  failure.base.error_exit = onError;
  failure.base.emit_message = onMessage;
}

struct Decoder {
  Failure failure;
  jpeg_progress_mgr progress{};
  jpeg_decompress_struct info{};

  Decoder() {
    installHandlers(failure);
    info.err = &failure.base;
    progress.progress_monitor = onProgress;
  }
  ~Decoder() { jpeg_destroy_decompress(&info); }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
};

bool readHeader(Decoder& decoder, codec::Bytes bytes) {
  if (setjmp(decoder.failure.jump)) return false;
  jpeg_create_decompress(&decoder.info);
  decoder.info.progress = &decoder.progress;
  jpeg_mem_src(&decoder.info, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&decoder.info, TRUE);
  return true;
}

bool readRows(Decoder& decoder, unsigned char* out) {
  if (setjmp(decoder.failure.jump)) return false;
  decoder.info.out_color_space = JCS_EXT_RGBA;
  jpeg_start_decompress(&decoder.info);
  const std::size_t rowBytes = std::size_t(decoder.info.output_width) * 4;
  while (decoder.info.output_scanline < decoder.info.output_height) {
    JSAMPROW row = out + rowBytes * decoder.info.output_scanline;
    jpeg_read_scanlines(&decoder.info, &row, 1);
  }
  jpeg_finish_decompress(&decoder.info);
  return true;
}

struct Encoder {
  Failure failure;
  jpeg_compress_struct info{};
  unsigned char* bytes = nullptr;  // grown by libjpeg with malloc
  unsigned long size = 0;

  Encoder() {
    installHandlers(failure);
    info.err = &failure.base;
  }
  ~Encoder() {
    jpeg_destroy_compress(&info);
    std::free(bytes);
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
};

bool writeRows(Encoder& encoder, const ImageRgba8& image, int quality) {
  if (setjmp(encoder.failure.jump)) return false;
  jpeg_create_compress(&encoder.info);
  jpeg_mem_dest(&encoder.info, &encoder.bytes, &encoder.size);
  encoder.info.image_width = JDIMENSION(image.width());
  encoder.info.image_height = JDIMENSION(image.height());
  encoder.info.input_components = 4;
  encoder.info.in_color_space = JCS_EXT_RGBX;
  jpeg_set_defaults(&encoder.info);
  jpeg_set_quality(&encoder.info, quality, TRUE);
  if (quality >= 90) {  // full-resolution colour: thin coloured edges are what mirrors are full of
    encoder.info.comp_info[0].h_samp_factor = 1;
    encoder.info.comp_info[0].v_samp_factor = 1;
  }
  jpeg_start_compress(&encoder.info, TRUE);
  while (encoder.info.next_scanline < encoder.info.image_height) {
    const glm::u8vec4* pixels =
        image.data() + std::size_t(encoder.info.next_scanline) * std::size_t(image.width());
    auto* row = const_cast<JSAMPROW>(reinterpret_cast<const unsigned char*>(pixels));
    jpeg_write_scanlines(&encoder.info, &row, 1);
  }
  jpeg_finish_compress(&encoder.info);
  return true;
}

}  // namespace

ImageRgba8 codec::decodeJpeg(Bytes bytes, const std::string& name, std::size_t maxPixels) {
  Decoder decoder;
  if (!readHeader(decoder, bytes)) throwDamaged(name, decoder.failure.message);
  checkPixelCount(decoder.info.image_width, decoder.info.image_height, name, maxPixels);
  const J_COLOR_SPACE space = decoder.info.jpeg_color_space;
  if (space == JCS_CMYK || space == JCS_YCCK)
    throwUnsupported(name, "it is a CMYK JPEG", "convert it to RGB");
  if (space != JCS_GRAYSCALE && space != JCS_YCbCr && space != JCS_RGB)
    throwUnsupported(name, "its JPEG colour space is unknown", "convert it to RGB");

  ImageRgba8 image{int(decoder.info.image_width), int(decoder.info.image_height)};
  if (!readRows(decoder, reinterpret_cast<unsigned char*>(image.data())))
    throwDamaged(name, decoder.failure.message);
  if (decoder.failure.harmless[0] != '\0')
    logWarningOnce("image '" + name + "' was read in spite of: " + decoder.failure.harmless);
  return image;
}

std::vector<std::byte> encodeJpeg(const ImageRgba8& image, int quality) {
  if (image.isEmpty()) throw Error("image.encode", "cannot encode a JPEG without pixels");
  Encoder encoder;
  if (!writeRows(encoder, image, quality))
    throw Error("image.encode", std::string("cannot encode JPEG: ") + encoder.failure.message);
  const auto* begin = reinterpret_cast<const std::byte*>(encoder.bytes);
  return {begin, begin + encoder.size};
}

}  // namespace catoptric::core

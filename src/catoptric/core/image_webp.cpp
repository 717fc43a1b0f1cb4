// SPDX-License-Identifier: Apache-2.0
#include <webp/decode.h>

#include "catoptric/core/image_codec.h"

namespace catoptric::core {

ImageRgba8 codec::decodeWebp(Bytes bytes, const std::string& name, std::size_t maxPixels) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  WebPBitstreamFeatures features;
  const VP8StatusCode status = WebPGetFeatures(data, bytes.size(), &features);
  if (status == VP8_STATUS_NOT_ENOUGH_DATA) throwDamaged(name, "the WebP file ends too early");
  if (status != VP8_STATUS_OK) throwDamaged(name, "damaged WebP header");
  if (features.has_animation) throwUnsupported(name, "it is an animated WebP", "save one frame of it");
  checkPixelCount(std::uint64_t(features.width), std::uint64_t(features.height), name, maxPixels);

  ImageRgba8 image(features.width, features.height);
  auto* out = reinterpret_cast<std::uint8_t*>(image.data());
  if (!WebPDecodeRGBAInto(data, bytes.size(), out, image.size() * 4, features.width * 4))
    throwDamaged(name, "damaged or incomplete WebP data");
  return image;
}

}  // namespace catoptric::core

// SPDX-License-Identifier: Apache-2.0
// Frames to files.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "catoptric/core/image.h"
#include "catoptric/renderer/frame.h"

namespace catoptric::app {

enum class PictureFormat { Png, Jpeg, Exr };

/// By the file's extension; "-" (stdout) is PNG. Throws UsageError for any other.
[[nodiscard]] PictureFormat findPictureFormat(const std::string& option, const std::string& file);

/// PNG and JPEG: tone-mapped sRGB; EXR: linear radiance as it is. "-" is stdout.
void writePicture(const std::string& file, PictureFormat format, const core::ImageRgbaF& radiance,
                  float exposure);
void writePng(const std::string& file, const core::ImageRgba8& picture);

/// Everything a frame knows of each pixel (docs/command-line.md lists the channels). No value is NaN.
[[nodiscard]] std::vector<std::byte> encodeAov(const renderer::Frame& frame);

}  // namespace catoptric::app

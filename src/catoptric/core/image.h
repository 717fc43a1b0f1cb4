// SPDX-License-Identifier: Apache-2.0
// A plain 2-D array of pixels. Row 0 is the top row, as in every image file we read or write.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "catoptric/core/math.h"

namespace catoptric::core {

template <class Pixel>
class Image {
 public:
  Image() = default;
  Image(int widthPx, int heightPx, const Pixel& fill = Pixel{})
      : width_(widthPx), height_(heightPx), pixels_(std::size_t(widthPx) * std::size_t(heightPx), fill) {
    assert(widthPx >= 0 && heightPx >= 0);
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] bool isEmpty() const { return pixels_.empty(); }
  [[nodiscard]] std::size_t size() const { return pixels_.size(); }

  [[nodiscard]] Pixel& at(int x, int y) { return pixels_[index(x, y)]; }
  [[nodiscard]] const Pixel& at(int x, int y) const { return pixels_[index(x, y)]; }
  [[nodiscard]] Pixel* data() { return pixels_.data(); }
  [[nodiscard]] const Pixel* data() const { return pixels_.data(); }
  [[nodiscard]] std::vector<Pixel>& pixels() { return pixels_; }
  [[nodiscard]] const std::vector<Pixel>& pixels() const { return pixels_; }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    assert(x >= 0 && x < width_ && y >= 0 && y < height_);
    return std::size_t(y) * std::size_t(width_) + std::size_t(x);
  }

  int width_ = 0, height_ = 0;
  std::vector<Pixel> pixels_;
};

using ImageRgba8 = Image<glm::u8vec4>;  ///< sRGB or raw bytes; the owner says which.
using ImageRgbF = Image<vec3>;          ///< Linear radiance.
using ImageRgbaF = Image<vec4>;         ///< Linear radiance with alpha.

}  // namespace catoptric::core

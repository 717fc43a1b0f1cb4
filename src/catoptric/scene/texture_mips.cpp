// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/texture_mips.h"

#include <algorithm>
#include <array>

#include "catoptric/core/parallel.h"
#include "catoptric/core/tone_map.h"

namespace catoptric::scene {
namespace {

/// Byte to linear and back, rounded to the nearest byte in sRGB space, without pow per texel.
class SrgbTables {
 public:
  SrgbTables() {
    for (int i = 0; i < 256; ++i) linear_[i] = core::linearFromSrgb(float(i) / 255.0f);
    for (int i = 0; i < 255; ++i) upperBound_[i] = core::linearFromSrgb((float(i) + 0.5f) / 255.0f);
    upperBound_[255] = 2.0f;
    for (int slot = 0, byte = 0; slot < kSlots; ++slot) {
      while (upperBound_[byte] < float(slot) / kSlots) ++byte;
      start_[slot] = std::uint8_t(byte);
    }
  }
  [[nodiscard]] float decode(std::uint8_t byte) const { return linear_[byte]; }
  [[nodiscard]] std::uint8_t encode(float linear) const {
    int byte = start_[std::clamp(int(linear * kSlots), 0, kSlots - 1)];
    while (linear >= upperBound_[byte]) ++byte;
    return std::uint8_t(byte);
  }

 private:
  static constexpr int kSlots = 4096;
  std::array<float, 256> linear_{}, upperBound_{};
  std::array<std::uint8_t, kSlots> start_{};
};

std::uint8_t meanOfBytes(int a, int b, int c, int d) {
  return std::uint8_t((a + b + c + d + 2) / 4);
}

core::ImageRgba8 halve(const core::ImageRgba8& source, bool srgb) {
  static const SrgbTables tables;
  core::ImageRgba8 target(std::max(1, source.width() / 2), std::max(1, source.height() / 2));
  const int lastX = source.width() - 1, lastY = source.height() - 1;
  core::parallelFor(std::size_t(target.height()), 64, [&](std::size_t begin, std::size_t end) {
    for (int y = int(begin); y < int(end); ++y)
      for (int x = 0; x < target.width(); ++x) {
        const int x0 = 2 * x, x1 = std::min(x0 + 1, lastX), y0 = 2 * y, y1 = std::min(y0 + 1, lastY);
        const auto &a = source.at(x0, y0), &b = source.at(x1, y0), &c = source.at(x0, y1),
                   &d = source.at(x1, y1);
        auto& mean = target.at(x, y);
        for (int i = 0; i < 4; ++i)
          mean[i] = srgb && i < 3 ? tables.encode(0.25f * (tables.decode(a[i]) + tables.decode(b[i]) +
                                                           tables.decode(c[i]) + tables.decode(d[i])))
                                  : meanOfBytes(a[i], b[i], c[i], d[i]);
      }
  });
  return target;
}

}  // namespace

std::vector<core::ImageRgba8> makeMipChain(const core::ImageRgba8& image, bool srgb) {
  std::vector<core::ImageRgba8> levels;
  if (image.isEmpty()) return levels;
  levels.push_back(image);
  while (levels.back().width() > 1 || levels.back().height() > 1)
    levels.push_back(halve(levels.back(), srgb));
  return levels;
}

}  // namespace catoptric::scene

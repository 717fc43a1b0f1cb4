// SPDX-License-Identifier: Apache-2.0
// Shared by the tests of core: a folder of one's own, made-up pictures, damaged copies of a file.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "catoptric/core/error.h"
#include "catoptric/core/image.h"

namespace catoptric::core {

/// A new empty folder that vanishes with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "catoptric-test-XXXXXX").string();
    if (!::mkdtemp(pattern.data())) throw std::runtime_error("cannot make a temporary folder");
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  [[nodiscard]] std::size_t fileCount() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(path_)) ++count;
    return count;
  }

 private:
  std::filesystem::path path_;
};

inline ImageRgba8 makePicture(int width, int height, bool isOpaque) {
  ImageRgba8 image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.at(x, y) = glm::u8vec4(x * 255 / width, y * 255 / height, (x * 7 + y * 13) % 256,
                                   isOpaque ? 255 : (x * 31 + y * 17) % 256);
  return image;
}

/// Code of the core::Error that `action` throws; "" if it throws none. Any other exception fails the test.
inline std::string errorCode(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_FALSE(std::string(error.what()).empty());
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.code();
  }
  return {};
}

/// Every prefix whose length is a multiple of `step`, without the whole.
inline void forEachTruncation(std::span<const std::byte> bytes, std::size_t step,
                              const std::function<void(std::span<const std::byte>)>& action) {
  for (std::size_t size = 0; size < bytes.size(); size += step) {
    // An exact heap block of its own, so that the address sanitizer sees a read past the end.
    const std::vector<std::byte> copy(bytes.begin(), bytes.begin() + std::ptrdiff_t(size));
    action(copy);
  }
}

/// `count` copies, each with one to four bytes changed; the first half of them near the beginning, where the
/// headers are.
inline void forEachDamage(std::span<const std::byte> bytes, int count,
                          const std::function<void(std::span<const std::byte>)>& action) {
  std::mt19937 random(1);
  for (int i = 0; i < count; ++i) {
    std::vector<std::byte> copy(bytes.begin(), bytes.end());
    const std::size_t reach = i < count / 2 ? std::min<std::size_t>(copy.size(), 400) : copy.size();
    for (unsigned k = 0; k <= random() % 4; ++k) copy[random() % reach] ^= std::byte(1u << (random() % 8));
    if (i % 5 == 0) copy[random() % reach] = std::byte(0xff);
    action(copy);
  }
}

}  // namespace catoptric::core

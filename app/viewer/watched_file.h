// SPDX-License-Identifier: Apache-2.0
// Tells when a file has changed, by its time stamp, at most twice a second.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

namespace catoptric::viewer {

class WatchedFile {
 public:
  void watch(const std::string& file) {
    if (file == file_) return;
    file_ = file;
    stamp_ = stampOf(file_);
  }
  [[nodiscard]] bool hasChanged() {
    const auto now = std::chrono::steady_clock::now();
    if (file_.empty() || now - lastLook_ < std::chrono::milliseconds(500)) return false;
    lastLook_ = now;
    const auto stamp = stampOf(file_);
    // While an editor replaces the file it may be missing; the old stamp is kept until it is back.
    if (stamp == stamp_ || stamp == std::filesystem::file_time_type::min()) return false;
    stamp_ = stamp;
    return true;
  }

 private:
  static std::filesystem::file_time_type stampOf(const std::string& file) {
    std::error_code failed;
    const auto stamp = std::filesystem::last_write_time(file, failed);
    return failed ? std::filesystem::file_time_type::min() : stamp;
  }

  std::string file_;
  std::filesystem::file_time_type stamp_;
  std::chrono::steady_clock::time_point lastLook_{};
};

}  // namespace catoptric::viewer

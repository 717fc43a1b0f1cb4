// SPDX-License-Identifier: Apache-2.0
#include "pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "arguments.h"
#include "catoptric/core/file.h"
#include "catoptric/core/image_io.h"
#include "catoptric/core/tone_map.h"
#include "terminal.h"

namespace catoptric::app {
namespace {

/// Channels of an EXR file and the arrays they point to.
class ChannelList {
 public:
  explicit ChannelList(std::size_t pixels) : pixels_(pixels) { floats_.reserve(32), ids_.reserve(32); }

  template <class ValueAt>
  void addFloat(const std::string& name, ValueAt valueAt) {
    std::vector<float>& values = floats_.emplace_back(pixels_);
    for (std::size_t i = 0; i < pixels_; ++i) {
      values[i] = valueAt(i);
      if (std::isnan(values[i])) values[i] = 0.0f, ++notANumber_;
    }
    core::ExrChannel channel;
    channel.name = name;
    channel.values = values;
    channels_.push_back(channel);
  }
  template <class ValueAt>
  void addId(const std::string& name, ValueAt valueAt) {
    std::vector<std::uint32_t>& values = ids_.emplace_back(pixels_);
    for (std::size_t i = 0; i < pixels_; ++i) values[i] = valueAt(i);
    core::ExrChannel channel;
    channel.name = name;
    channel.ids = values;
    channels_.push_back(channel);
  }
  [[nodiscard]] std::vector<std::byte> encode(int widthPx, int heightPx) const {
    if (notANumber_ > 0)
      sayWarning(fmt::format("{} values that were no numbers were written as 0", notANumber_));
    return core::encodeExr(widthPx, heightPx, channels_);
  }

 private:
  std::size_t pixels_;
  std::vector<std::vector<float>> floats_;
  std::vector<std::vector<std::uint32_t>> ids_;
  std::vector<core::ExrChannel> channels_;
  std::uint64_t notANumber_ = 0;
};

void addRadiance(ChannelList& channels, const core::ImageRgbaF& radiance) {
  constexpr std::string_view kNames = "RGBA";
  for (int c = 0; c < 4; ++c)
    channels.addFloat(std::string(1, kNames[std::size_t(c)]),
                      [&](std::size_t i) { return radiance.pixels()[i][c]; });
}

void writeBytes(const std::string& file, const std::vector<std::byte>& bytes) {
  if (file == "-")
    printData({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  else
    core::writeFileAtomically(file, std::span(bytes));
}

}  // namespace

PictureFormat findPictureFormat(const std::string& option, const std::string& file) {
  if (file == "-") return PictureFormat::Png;
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  if (extension == ".png") return PictureFormat::Png;
  if (extension == ".jpg" || extension == ".jpeg") return PictureFormat::Jpeg;
  if (extension == ".exr") return PictureFormat::Exr;
  // Devices have no extension: /dev/stdout, /dev/null.
  std::error_code ignored;
  if (std::filesystem::is_character_file(file, ignored) || std::filesystem::is_fifo(file, ignored))
    return PictureFormat::Png;
  throw UsageError(option + ": '" + file + "' is no kind of picture that can be written",
                   "use .png, .exr or .jpg");
}

void writePng(const std::string& file, const core::ImageRgba8& picture) {
  writeBytes(file, core::encodePng(picture));
}

void writePicture(const std::string& file, PictureFormat format, const core::ImageRgbaF& radiance,
                  float exposure) {
  if (format == PictureFormat::Png) return writePng(file, core::toneMap(radiance, exposure));
  if (format == PictureFormat::Jpeg)
    return writeBytes(file, core::encodeJpeg(core::toneMap(radiance, exposure)));
  ChannelList channels(radiance.size());
  addRadiance(channels, radiance);
  writeBytes(file, channels.encode(radiance.width(), radiance.height()));
}

std::vector<std::byte> encodeAov(const renderer::Frame& frame) {
  const auto& seen = frame.seen.pixels();
  ChannelList channels(seen.size());
  addRadiance(channels, frame.radiance);
  channels.addFloat("seen.X", [&](std::size_t i) { return seen[i].point.x; });
  channels.addFloat("seen.Y", [&](std::size_t i) { return seen[i].point.y; });
  channels.addFloat("seen.Z", [&](std::size_t i) { return seen[i].point.z; });
  channels.addFloat("pathLength", [&](std::size_t i) { return seen[i].pathLength; });
  channels.addId("object.id", [&](std::size_t i) { return seen[i].object; });
  channels.addId("triangle.id", [&](std::size_t i) { return seen[i].triangle; });
  channels.addId("reflector.id", [&](std::size_t i) { return seen[i].firstReflector; });
  channels.addId("bounces", [&](std::size_t i) { return seen[i].bounces; });
  return channels.encode(frame.seen.width(), frame.seen.height());
}

}  // namespace catoptric::app

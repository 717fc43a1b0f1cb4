// SPDX-License-Identifier: Apache-2.0
// OpenEXR from and to memory. All OpenEXR exceptions end here, as core::Error.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTestFile.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>

#include "catoptric/core/file.h"
#include "catoptric/core/image_codec.h"
#include "catoptric/core/image_io.h"
#include "catoptric/core/log.h"

namespace catoptric::core {
namespace {

class MemoryInput : public Imf::IStream {
 public:
  MemoryInput(codec::Bytes bytes, const std::string& name) : Imf::IStream(name.c_str()), bytes_(bytes) {}

  bool read(char out[], int count) override {
    if (count < 0 || position_ > bytes_.size() || std::size_t(count) > bytes_.size() - position_)
      throw std::runtime_error("the file ends too early");
    std::memcpy(out, bytes_.data() + position_, std::size_t(count));
    position_ += std::size_t(count);
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  codec::Bytes bytes_;
  std::uint64_t position_ = 0;
};

class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput() : Imf::OStream("memory") {}

  void write(const char data[], int count) override {
    const std::size_t end = position_ + std::size_t(count);
    if (end > bytes.size()) bytes.resize(end);
    std::memcpy(bytes.data() + position_, data, std::size_t(count));
    position_ = end;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  std::vector<std::byte> bytes;

 private:
  std::uint64_t position_ = 0;
};

struct Size {
  std::int64_t width = 0, height = 0;
};

Size dataSize(const Imf::Header& header) {
  const Imath::Box2i& window = header.dataWindow();
  return {std::int64_t(window.max.x) - window.min.x + 1, std::int64_t(window.max.y) - window.min.y + 1};
}

/// Reads the header alone: OpenEXR's file classes allocate tables in proportion to the size that it claims.
void checkHeader(codec::Bytes bytes, const std::string& name, std::size_t maxPixels) {
  MemoryInput stream(bytes, name);
  bool isTiled = false, isDeep = false, isMultiPart = false;
  if (!Imf::isOpenExrFile(stream, isTiled, isDeep, isMultiPart))
    codec::throwDamaged(name, "damaged OpenEXR header");
  if (isDeep) codec::throwUnsupported(name, "it is a deep OpenEXR image", "flatten it");
  constexpr std::uint64_t kMagicAndVersionBytes = 8;
  stream.seekg(kMagicAndVersionBytes);
  Imf::Header header;
  int version = 2;
  header.readFrom(stream, version);
  const Size size = dataSize(header);
  if (size.width < 1 || size.height < 1) codec::throwDamaged(name, "it has no pixels");
  codec::checkPixelCount(std::uint64_t(size.width), std::uint64_t(size.height), name, maxPixels);
}

/// All channels, or those of `wanted` that the file has.
ExrImage readChannels(codec::Bytes bytes, const std::string& name, std::size_t maxPixels,
                      std::span<const std::string> wanted) {
  checkHeader(bytes, name, maxPixels);
  MemoryInput stream(bytes, name);
  constexpr int kThreads = 0;  // decode in this thread
  Imf::InputFile file(stream, kThreads);
  const Size size = dataSize(file.header());
  codec::checkPixelCount(std::uint64_t(size.width), std::uint64_t(size.height), name, maxPixels);

  ExrImage image;
  image.widthPx = int(size.width);
  image.heightPx = int(size.height);
  const Imf::ChannelList& channels = file.header().channels();
  for (auto i = channels.begin(); i != channels.end(); ++i) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), i.name()) == wanted.end()) continue;
    if (i.channel().xSampling != 1 || i.channel().ySampling != 1)
      codec::throwUnsupported(name, std::string("its channel '") + i.name() + "' is subsampled",
                              "save it with all channels at full resolution");
    image.names.emplace_back(i.name());
  }
  const Imath::Box2i window = file.header().dataWindow();
  if (window != file.header().displayWindow())
    logWarningOnce("image '" + name +
                   "': its data window is taken as the whole picture, its display window ignored");
  Imf::FrameBuffer frame;
  for (const std::string& channel : image.names) {
    image.values.emplace_back(std::size_t(size.width) * std::size_t(size.height));
    frame.insert(channel, Imf::Slice::Make(Imf::FLOAT, image.values.back().data(), window, sizeof(float),
                                           sizeof(float) * std::size_t(size.width)));
  }
  if (image.names.empty()) return image;
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  return image;
}

ExrImage decodeExr(codec::Bytes bytes, const std::string& name, std::size_t maxPixels,
                   std::span<const std::string> wanted = {}) {
  try {
    return readChannels(bytes, name, maxPixels, wanted);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error("image.too_large", "image '" + name + "' does not fit into memory");
  } catch (const std::exception& failure) {
    codec::throwDamaged(name, failure.what());
  }
}

const std::vector<float>* findChannel(const ExrImage& image, const std::string& name) {
  const auto found = std::find(image.names.begin(), image.names.end(), name);
  return found == image.names.end() ? nullptr : &image.values[std::size_t(found - image.names.begin())];
}

}  // namespace

ImageRgbF codec::decodeExrRgb(Bytes bytes, const std::string& name, std::size_t maxPixels) {
  // RY and BY are the colour of luminance-chroma files; being subsampled they are refused, not dropped.
  const std::string wanted[] = {"R", "G", "B", "Y", "RY", "BY"};
  const ExrImage exr = decodeExr(bytes, name, maxPixels, wanted);
  const std::vector<float>* channels[3] = {findChannel(exr, "R"), findChannel(exr, "G"),
                                           findChannel(exr, "B")};
  const std::vector<float>* luminance = findChannel(exr, "Y");
  const bool isGrey = luminance && !channels[0] && !channels[1] && !channels[2];
  for (const std::vector<float>*& channel : channels) {
    if (isGrey) channel = luminance;
    if (!channel) throwUnsupported(name, "it lacks one of the channels R, G, B", "save it as an RGB image");
  }
  ImageRgbF image(exr.widthPx, exr.heightPx);
  for (std::size_t i = 0; i < image.size(); ++i)
    image.data()[i] = vec3((*channels[0])[i], (*channels[1])[i], (*channels[2])[i]);
  return image;
}

ExrImage readExr(const std::filesystem::path& path, std::size_t maxPixels) {
  const std::vector<std::byte> bytes = readFile(path);
  return decodeExr(bytes, path.string(), maxPixels);
}

std::vector<std::byte> encodeExr(int widthPx, int heightPx, std::span<const ExrChannel> channels) {
  if (widthPx < 1 || heightPx < 1 || channels.empty())
    throw Error("image.encode", "cannot encode an OpenEXR image without pixels or channels");
  try {
    Imf::Header header(widthPx, heightPx);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer frame;
    for (const ExrChannel& channel : channels) {
      const bool isFloat = !channel.values.empty();
      assert(channel.values.empty() != channel.ids.empty() && channel.stride >= 1);
      assert((std::size_t(widthPx) * std::size_t(heightPx) - 1) * std::size_t(channel.stride) <
             std::max(channel.values.size(), channel.ids.size()));
      const Imf::PixelType type = isFloat ? Imf::FLOAT : Imf::UINT;
      const void* base = isFloat ? static_cast<const void*>(channel.values.data()) : channel.ids.data();
      const std::size_t step = sizeof(float) * std::size_t(channel.stride);
      header.channels().insert(channel.name, Imf::Channel(type));
      frame.insert(channel.name, Imf::Slice(type, static_cast<char*>(const_cast<void*>(base)), step,
                                            step * std::size_t(widthPx)));
    }
    MemoryOutput stream;
    {
      Imf::OutputFile file(stream, header, 0);
      file.setFrameBuffer(frame);
      file.writePixels(heightPx);
    }  // the table of offsets is written here
    return std::move(stream.bytes);
  } catch (const std::exception& failure) {
    throw Error("image.encode", std::string("cannot encode OpenEXR: ") + failure.what());
  }
}

}  // namespace catoptric::core

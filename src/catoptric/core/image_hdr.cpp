// SPDX-License-Identifier: Apache-2.0
// How is a Radiance picture (.hdr, .pic) read?
//
// Input: the bytes of a file that begins with "#?". Output: linear radiance, top row first.
//
// 1. The header is lines of text up to an empty one. FORMAT must be 32-bit_rle_rgbe. Each EXPOSURE line says
//    by what the pixels were multiplied, so they are divided by the product.
// 2. The resolution line: "-Y H +X W" has the top row first; other signs mirror the picture. Pictures stored
//    by columns (X before Y) are refused: nobody writes them.
// 3. Each scan line is in one of two encodings. The new one starts with 2, 2, width: the four bytes of all
//    pixels follow as four planes of runs (length + 128, value) and literals (length, values). The old one
//    is plain pixels in which the pixel (1, 1, 1, n) repeats the one before n times, n shifted left by 8
//    more for each such pixel in a row.
// 4. A pixel (r, g, b, e) is (r, g, b) * 2^(e - 136), and black where e is 0. (Radiance's own reader adds
//    half a step to r, g and b. Other readers do not, and black next to a light would not be black.)
//
// Failures: everything that does not fit, a file that ends early included, throws image.damaged.
// Cost: linear; 8 MB of texels take about 20 ms.
// Source: Ward, "Real Pixels", Graphics Gems II, 1991; Radiance's color.c.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "catoptric/core/image_codec.h"

namespace catoptric::core {
namespace {

using Rgbe = glm::u8vec4;

struct Header {
  int width = 0, height = 0;
  bool isBottomUp = false, isRightToLeft = false;
  float scale = 1.0f;  // 1 / product of the exposures
};

/// Takes bytes from the front; throws at the end of the file.
class ByteReader {
 public:
  ByteReader(codec::Bytes bytes, const std::string& name) : rest_(bytes), name_(name) {}

  std::uint8_t byte() { return take(1)[0]; }
  Rgbe pixel() {
    const std::uint8_t* p = take(4);
    return {p[0], p[1], p[2], p[3]};
  }
  const std::uint8_t* take(std::size_t count) {
    if (count > rest_.size()) fail("the file ends too early");
    const auto* data = reinterpret_cast<const std::uint8_t*>(rest_.data());
    rest_ = rest_.subspan(count);
    return data;
  }
  std::string_view line() {
    const std::string_view text(reinterpret_cast<const char*>(rest_.data()), rest_.size());
    const std::size_t end = text.substr(0, kMaxLine).find('\n');
    if (end == std::string_view::npos) fail("the header does not end");
    rest_ = rest_.subspan(end + 1);
    return text.substr(0, end > 0 && text[end - 1] == '\r' ? end - 1 : end);
  }
  [[nodiscard]] std::size_t restSize() const { return rest_.size(); }
  [[noreturn]] void fail(const std::string& why) const { codec::throwDamaged(name_, why); }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  static constexpr std::size_t kMaxLine = 65536;
  codec::Bytes rest_;
  const std::string& name_;
};

std::string_view nextWord(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(" \t"));
  text.remove_prefix(word.size());
  return word;
}

/// Step 1, one line of it.
void readVariable(std::string_view line, ByteReader& in, double& exposure) {
  const std::size_t equals = line.find('=');
  if (line.starts_with('#') || equals == std::string_view::npos) return;  // comments and commands
  const std::string_view key = line.substr(0, equals);
  std::string_view rest = line.substr(equals + 1);
  const std::string_view value = nextWord(rest);
  if (key == "FORMAT" && value != "32-bit_rle_rgbe")
    codec::throwUnsupported(in.name(), "its pixel format is '" + std::string(value) + "'",
                            "convert it to 32-bit_rle_rgbe");
  if (key == "EXPOSURE") {
    double factor = 0;
    const auto result = std::from_chars(value.data(), value.data() + value.size(), factor);
    if (result.ec != std::errc() || !(factor > 1e-20) || !(factor < 1e20))
      in.fail("its EXPOSURE is not a number");
    exposure *= factor;
  }
}

/// Step 2.
void readResolution(std::string_view line, ByteReader& in, Header& header) {
  const std::string_view yAxis = nextWord(line), height = nextWord(line);
  const std::string_view xAxis = nextWord(line), width = nextWord(line);
  if (yAxis == "+X" || yAxis == "-X")
    codec::throwUnsupported(in.name(), "its pixels are stored by columns",
                            "store them by rows (-Y before +X)");
  if ((yAxis != "-Y" && yAxis != "+Y") || (xAxis != "+X" && xAxis != "-X"))
    in.fail("its resolution line is damaged");
  header.isBottomUp = yAxis == "+Y";
  header.isRightToLeft = xAxis == "-X";
  const auto y = std::from_chars(height.data(), height.data() + height.size(), header.height);
  const auto x = std::from_chars(width.data(), width.data() + width.size(), header.width);
  if (y.ec != std::errc() || x.ec != std::errc() || header.width < 1 || header.height < 1)
    in.fail("its size is not two positive numbers");
}

Header readHeader(ByteReader& in) {
  Header header;
  double exposure = 1.0;
  while (true) {
    const std::string_view line = in.line();
    if (line.empty()) break;
    readVariable(line, in, exposure);
  }
  if (!(exposure > 1e-20) || !(exposure < 1e20)) in.fail("its EXPOSURE is not a number");
  header.scale = float(1.0 / exposure);
  readResolution(in.line(), in, header);
  return header;
}

/// Step 3, new encoding: four planes of runs and literals.
void readPlanes(ByteReader& in, std::vector<Rgbe>& row) {
  for (int channel = 0; channel < 4; ++channel)
    for (std::size_t x = 0; x < row.size();) {
      const std::size_t code = in.byte();
      const bool isRun = code > 128;
      const std::size_t count = isRun ? code - 128 : code;
      if (count == 0 || count > row.size() - x) in.fail("a run passes the end of its scan line");
      const std::uint8_t* values = in.take(isRun ? 1 : count);
      for (std::size_t i = 0; i < count; ++i) row[x++][channel] = values[isRun ? 0 : i];
    }
}

/// Step 3, old encoding; `first` is already read.
void readPixels(ByteReader& in, const Rgbe& first, std::vector<Rgbe>& row) {
  int shift = 0;
  Rgbe pixel = first;
  for (std::size_t x = 0;;) {
    if (pixel.r == 1 && pixel.g == 1 && pixel.b == 1) {
      const std::size_t count = shift < 32 ? std::size_t(pixel.a) << shift : 0;
      if (x == 0 || shift >= 32 || count > row.size() - x) in.fail("a run passes the end of its scan line");
      for (std::size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
      shift += 8;
    } else {
      row[x++] = pixel;
      shift = 0;
    }
    if (x == row.size()) return;
    pixel = in.pixel();
  }
}

void readScanLine(ByteReader& in, std::vector<Rgbe>& row) {
  const Rgbe first = in.pixel();
  const bool isNew = row.size() >= 8 && row.size() < 32768 && first.r == 2 && first.g == 2 && first.b < 128;
  if (!isNew) return readPixels(in, first, row);
  if (std::size_t(first.b) * 256 + first.a != row.size()) in.fail("a scan line has the wrong length");
  readPlanes(in, row);
}

}  // namespace

ImageRgbF codec::decodeRadianceHdr(Bytes bytes, const std::string& name, std::size_t maxPixels) {
  ByteReader in(bytes, name);
  const Header header = readHeader(in);
  checkPixelCount(std::uint64_t(header.width), std::uint64_t(header.height), name, maxPixels);
  // A scan line takes four bytes at least: a tiny file that claims to be huge is refused before it costs
  // memory.
  if (in.restSize() / 4 < std::size_t(header.height)) in.fail("the file ends too early");

  std::array<float, 256> powers;  // step 4
  for (int e = 0; e < 256; ++e) powers[std::size_t(e)] = e == 0 ? 0.0f : std::ldexp(header.scale, e - 136);
  ImageRgbF image(header.width, header.height);
  std::vector<Rgbe> row(std::size_t(header.width));
  for (int i = 0; i < header.height; ++i) {
    readScanLine(in, row);
    vec3* out = &image.at(0, header.isBottomUp ? header.height - 1 - i : i);
    for (std::size_t x = 0; x < row.size(); ++x)
      out[header.isRightToLeft ? row.size() - 1 - x : x] = vec3(row[x]) * powers[row[x].a];
  }
  return image;
}

}  // namespace catoptric::core

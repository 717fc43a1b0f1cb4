// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/number_raster.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "catoptric/core/eight_lanes.h"
#include "catoptric/core/parallel.h"
#include "catoptric/virtual_object/clip_to_screen.h"
#include "catoptric/virtual_object/item_rasterizer.h"
#include "catoptric/virtual_object/number_rows.h"
#include "catoptric/virtual_object/triangle_lanes.h"

namespace catoptric::virtual_object {
namespace {

using core::Eight;
using core::EightInts;
using core::kLanes;
using core::larger;
using core::smaller;
using LargeTriangle = NumberRaster::LargeTriangle;
using SmallTriangle = NumberRaster::SmallTriangle;

constexpr std::size_t kTrianglesPerTask = 4096;
constexpr int kBandRows = 16;
constexpr int kSub = TriangleGroup::kSub;
constexpr float kFarthest = 1e5f;  // pixels off the picture; beyond, triangles are cut

/// Eight triangles; most are.
bool areLeftOut(const std::uint8_t* isKept) {
  std::uint64_t eight;
  std::memcpy(&eight, isKept, sizeof eight);
  return eight == 0;
}

bool isNearScreen(const vec3& s) {
  return std::abs(s.x) < kFarthest && std::abs(s.y) < kFarthest;  // false for a NaN
}

/// 1. Triangles into the bands of a chunk, eight at a time.
class Binner {
 public:
  Binner(const NumberPicture& picture, NumberRaster::Chunk& chunk)
      : picture_(picture), chunk_(chunk), stride_(picture.bounds.width + kLanes) {}

  void add(const raster::TessellatedObjects& objects, std::size_t t) {
    for (std::size_t k = 0; k < 3; ++k) corners_[k][lanes_] = objects.indices[3 * t + k];
    numbers_[lanes_] = objects.sourceTriangles[t];
    if (++lanes_ == kGroup) flush();
  }

  void flush() {
    group_.wanted = (1u << lanes_) - 1u;
    lanes_ = 0;
    if (group_.wanted == 0) return;
    gatherCorners(picture_.screen, corners_, group_);
    setUpTriangles(picture_.bounds, group_);
    for (unsigned lane = 0; lane < kGroup; ++lane) {
      if ((group_.hard >> lane & 1u) == 0)
        addLane(lane);
      else
        addHard(lane);
    }
  }

 private:
  static constexpr unsigned kGroup = TriangleGroup::kLanes;

  [[nodiscard]] std::array<vec3, 3> laneOf(unsigned lane) const {
    std::array<vec3, 3> s;
    for (std::size_t k = 0; k < 3; ++k)
      s[k] = {group_.x[k][lane], group_.y[k][lane], group_.nearness[k][lane]};
    return s;
  }

  void addLane(unsigned lane) {
    if ((group_.tiny >> lane & 1u) != 0)
      addFragments(lane);
    else if ((group_.small >> lane & 1u) != 0)
      addSmall(lane);
    else
      return;
    ++chunk_.drawn;
  }

  /// Each centre inside by itself.
  void addFragments(unsigned lane) {
    const int y0 = group_.y0[lane], width = group_.width[lane], height = group_.height[lane];
    std::uint64_t inside =
        std::uint32_t(group_.inside[0][lane]) | std::uint64_t(std::uint32_t(group_.inside[1][lane])) << 32;
    inside &= (0x0101010101010101u * ((1u << width) - 1u)) & ~std::uint64_t(0) >> (64 - 8 * height);
    const int rowsOfBand = kBandRows - y0 % kBandRows;
    const std::uint64_t first =
        rowsOfBand >= height ? inside : inside & ((std::uint64_t(1) << (8 * rowsOfBand)) - 1);
    addFragments(lane, first, std::size_t(y0 / kBandRows));
    if (first != inside) addFragments(lane, inside ^ first, std::size_t(y0 / kBandRows) + 1);
  }

  void addFragments(unsigned lane, std::uint64_t inside, std::size_t band) {
    const std::uint32_t at = std::uint32_t(group_.y0[lane] * stride_ + group_.x0[lane]);
    const float near = group_.near[lane], nearX = group_.nearX[lane], nearY = group_.nearY[lane];
    const float least = group_.least[lane], most = group_.most[lane];
    NumberRaster::Item* to = chunk_.bands[band].makeRoom(std::size_t(std::popcount(inside)));
    for (; inside != 0; inside &= inside - 1) {
      const int bit = std::countr_zero(inside), x = bit % 8, y = bit / 8;
      float n = near + nearX * float(x) + nearY * float(y);
      n = least > n ? least : n;
      n = most < n ? most : n;
      *to++ = {at + std::uint32_t(y * stride_ + x), numbers_[lane] + 1, n};
    }
  }

  void addSmall(unsigned lane) {
    const TriangleGroup& g = group_;
    SmallTriangle& t = chunk_.small.emplace_back();
    t.x0 = g.x0[lane], t.y0 = g.y0[lane], t.width = g.width[lane], t.height = g.height[lane];
    for (int k = 0; k < 3; ++k)
      t.edge[k] = g.edge[k][lane], t.stepX[k] = g.stepX[k][lane], t.stepY[k] = g.stepY[k][lane];
    t.nearness = g.near[lane], t.nearX = g.nearX[lane], t.nearY = g.nearY[lane];
    t.least = g.least[lane], t.most = g.most[lane];
    t.number = numbers_[lane];
    addToBands(std::uint32_t(chunk_.small.size() - 1), t.y0, t.y0 + t.height - 1);
  }

  void addToBands(std::uint32_t index, int y0, int y1) {
    for (int band = y0 / kBandRows; band <= y1 / kBandRows; ++band)
      *chunk_.bands[std::size_t(band)].makeRoom(1) = {index | NumberRaster::kTriangleBit, 0, 0.0f};
  }

  /// Of those that reach far off the picture or behind the eye, what does not.
  void addHard(unsigned lane) {
    const std::array<vec3, 3> screen = laneOf(lane);
    if (isNearScreen(screen[0]) && isNearScreen(screen[1]) && isNearScreen(screen[2]))
      return addLarge(screen, numbers_[lane]);
    std::array<vec4, 3> clip;
    for (std::size_t k = 0; k < 3; ++k)
      clip[k] = picture_.clipFromDraw * vec4(picture_.virtualPositions[corners_[k][lane]], 1.0f);
    Binner pieces(picture_, chunk_);
    clipToScreen(clip, picture_.widthPx, picture_.heightPx, [&](const std::array<vec3, 3>& s) {
      for (std::size_t k = 0; k < 3; ++k)
        pieces.group_.x[k][0] = s[k].x, pieces.group_.y[k][0] = s[k].y, pieces.group_.nearness[k][0] = s[k].z;
      pieces.numbers_[0] = numbers_[lane];
      pieces.group_.wanted = 1;
      setUpTriangles(picture_.bounds, pieces.group_);
      if (pieces.group_.hard != 0)
        addLarge(s, numbers_[lane]);
      else
        pieces.addLane(0);
    });
  }

  void addLarge(const std::array<vec3, 3>& screen, std::uint32_t number) {
    LargeTriangle t{{}, number};
    ivec2 least(std::numeric_limits<int>::max()), most(std::numeric_limits<int>::min());
    for (std::size_t k = 0; k < 3; ++k) {
      const ivec2 corner(std::lrintf(screen[k].x * float(kSub)) - picture_.bounds.x * kSub,
                         std::lrintf(screen[k].y * float(kSub)) - picture_.bounds.y * kSub);
      t.corners[k] = {corner.x, corner.y, screen[k].z};
      least = glm::min(least, corner), most = glm::max(most, corner);
    }
    const ivec2 size(picture_.bounds.width, picture_.bounds.height);
    const ivec2 first = glm::max((least + (kSub / 2 - 1)) >> 8, ivec2(0)),
                last = glm::min((most - kSub / 2) >> 8, size - 1);
    if (last.x < first.x || last.y < first.y) return;
    chunk_.large.push_back(t);
    addToBands(std::uint32_t(chunk_.large.size() - 1) | NumberRaster::kLargeBit, first.y, last.y);
    ++chunk_.drawn;
  }

  const NumberPicture& picture_;
  NumberRaster::Chunk& chunk_;
  int stride_;
  unsigned lanes_ = 0;  ///< that are filled
  std::array<std::uint32_t, kGroup> numbers_{};
  std::uint32_t corners_[3][kGroup] = {};
  TriangleGroup group_{};
};

CATOPTRIC_INLINE float smaller(float a, float b) {
  return a < b ? a : b;
}
CATOPTRIC_INLINE float larger(float a, float b) {
  return a > b ? a : b;
}
CATOPTRIC_INLINE bool isAny(const EightInts& mask) {
  return core::toBits(mask) != 0;
}
CATOPTRIC_INLINE bool isAny(std::uint32_t mask) {
  return mask != 0;
}

/// Some pixels, in one lane or eight: which of them are drawn, what is seen there before and after.
template <class Real, class Whole>
struct Drawn {
  Whole passes;  ///< inside, and not before the mirror
  Real nearness, stored;
  Whole number, storedNumber;
};

/// 2. The farther of two is the second one if it is about as near; seldom.
template <class Real, class Whole>
CATOPTRIC_INLINE void keepRival(const Drawn<Real, Whole>& d, float* rivalNearness, std::uint32_t* rivals) {
  const Real second = smaller(d.nearness, d.stored), first = larger(d.nearness, d.stored);
  const Whole isRival = d.passes & (second >= kAboutAsNear * first) & (d.number != d.storedNumber);
  if (!isAny(isRival)) return;
  const Whole wins = d.nearness > d.stored;
  const Whole secondNumber = wins ? d.storedNumber : d.number;
  Real before;
  Whole numberBefore;
  std::memcpy(&before, rivalNearness, sizeof before);
  std::memcpy(&numberBefore, rivals, sizeof numberBefore);
  const Whole follows = isRival & (second > before);
  before = follows ? second : before;
  numberBefore = follows ? secondNumber : numberBefore;
  std::memcpy(rivalNearness, &before, sizeof before);
  std::memcpy(rivals, &numberBefore, sizeof numberBefore);
}

/// 2. Rows [begin, end) of a triangle, eight columns after the other.
template <bool kWithRivals>
CATOPTRIC_INLINE void drawSmall(const SmallTriangle& triangle, int begin, int end,
                                const NumberRaster::Rows& rows) {
  const EightInts lane{0, 1, 2, 3, 4, 5, 6, 7};
  const SmallTriangle t = triangle;  // so that no store seems to change it
  const int first = std::max(begin, t.y0), last = std::min(end, t.y0 + t.height);
  const std::ptrdiff_t stride = rows.stride, start = std::ptrdiff_t(first) * stride + t.x0;
  const EightInts number = EightInts{} + std::int32_t(t.number + 1);
  const Eight inRow = t.nearness + t.nearX * __builtin_convertvector(lane, Eight), least = Eight{} + t.least,
              most = Eight{} + t.most;
  for (int x = 0; x < t.width; x += kLanes) {
    float *nearness = rows.nearness + start + x, *limits = rows.limits + start + x;
    std::uint32_t* numbers = rows.numbers + start + x;
    EightInts edge[3];
    for (int k = 0; k < 3; ++k) edge[k] = t.edge[k] + (first - t.y0) * t.stepY[k] + (lane + x) * t.stepX[k];
    const float toBlock = t.nearX * float(x);
    float row = float(first - t.y0);
    for (int y = first; y < last; ++y, row += 1.0f) {
      Eight n = inRow + t.nearY * row + toBlock;
      n = least > n ? least : n;
      n = most < n ? most : n;
      const Eight stored = core::load(nearness);
      const EightInts passes = ((edge[0] | edge[1] | edge[2]) >= 0) & (n <= core::load(limits)),
                      draws = passes & (n > stored);
      core::store(nearness, draws ? n : stored);
      EightInts before;
      std::memcpy(&before, numbers, sizeof before);
      const EightInts after = draws ? number : before;
      std::memcpy(numbers, &after, sizeof after);
      if constexpr (kWithRivals)
        keepRival<Eight, EightInts>({passes, n, stored, number, before},
                                    rows.rivalNearness + (nearness - rows.nearness),
                                    rows.rivals + (nearness - rows.nearness));
      nearness += stride, limits += stride, numbers += stride;
      for (int k = 0; k < 3; ++k) edge[k] += t.stepY[k];
    }
  }
}

template <bool kWithRivals>
void drawLarge(const NumberRaster::LargeTriangle& t, int begin, int end, const NumberRaster::Rows& rows) {
  std::array<dvec2, 3> px;
  for (std::size_t k = 0; k < 3; ++k)
    px[k] = dvec2(t.corners[k].x, t.corners[k].y - begin * kSub) / double(kSub);
  rasterizeTriangle(px, rows.width, end - begin, [&](int x, int y, const dvec3& weights) {
    const float n = float(weights.x * t.corners[0].nearness + weights.y * t.corners[1].nearness +
                          weights.z * t.corners[2].nearness);
    const std::ptrdiff_t at = std::ptrdiff_t(begin + y) * rows.stride + x;
    if (n > rows.limits[at]) return;
    if constexpr (kWithRivals)
      keepRival<float, std::uint32_t>({~0u, n, rows.nearness[at], t.number + 1, rows.numbers[at]},
                                      rows.rivalNearness + at, rows.rivals + at);
    if (n <= rows.nearness[at]) return;
    rows.nearness[at] = n;
    rows.numbers[at] = t.number + 1;
  });
}

/// 2. A pixel of a triangle.
template <bool kWithRivals>
CATOPTRIC_INLINE void drawFragment(const NumberRaster::Item& item, const NumberRaster::Rows& rows) {
  const float n = item.nearness, stored = rows.nearness[item.at];
  const std::uint32_t passes = 0u - std::uint32_t(n <= rows.limits[item.at]),
                      mask = passes & (0u - std::uint32_t(n > stored));
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(n),
                      storedBits = std::bit_cast<std::uint32_t>(stored);
  rows.nearness[item.at] = std::bit_cast<float>(storedBits ^ ((storedBits ^ bits) & mask));
  std::uint32_t& number = rows.numbers[item.at];
  if constexpr (kWithRivals)
    keepRival<float, std::uint32_t>({passes, n, stored, item.number, number}, rows.rivalNearness + item.at,
                                    rows.rivals + item.at);
  number ^= (number ^ item.number) & mask;
}

template <bool kWithRivals>
struct DrawBand {
  static CATOPTRIC_INLINE void run(const std::vector<NumberRaster::Chunk>& chunks, const int& band,
                                   const int& end, const NumberRaster::Rows& rows) {
    const int begin = band * kBandRows;
    for (const NumberRaster::Chunk& chunk : chunks)
      for (const NumberRaster::Item& item : chunk.bands[std::size_t(band)].items()) {
        const std::uint32_t index = item.at & ~(NumberRaster::kTriangleBit | NumberRaster::kLargeBit);
        if ((item.at & NumberRaster::kTriangleBit) == 0)
          drawFragment<kWithRivals>(item, rows);
        else if ((item.at & NumberRaster::kLargeBit) != 0)
          drawLarge<kWithRivals>(chunk.large[index], begin, end, rows);
        else
          drawSmall<kWithRivals>(chunk.small[index], begin, end, rows);
      }
  }
};

}  // namespace

void NumberRaster::drawBand(const NumberPicture& picture, const PixelRays& rays, int band,
                            NumberImage& image) {
  const int begin = band * kBandRows, end = std::min(begin + kBandRows, picture.bounds.height);
  const bool withRivals = picture.withRivals;
  const Rows rows{nearness_.data(),    limits_.data(),
                  numbers_.data(),     withRivals ? rivalNearness_.data() : nullptr,
                  rivals_.data(),      picture.bounds.width + kLanes,
                  picture.bounds.width};
  beginRows(picture, rays, begin, end, rows);
  if (withRivals)
    core::runOnWidestVectors<DrawBand<true>>(chunks_, band, end, rows);
  else
    core::runOnWidestVectors<DrawBand<false>>(chunks_, band, end, rows);
  finishRows(picture, rays, begin, end, rows, image);
  if (withRivals) findRivals(begin, end, rows, image.hits, image.depths, image.rivals[std::size_t(band)]);
}

std::size_t NumberRaster::draw(const raster::TessellatedObjects& objects, const NumberPicture& picture,
                               NumberImage& image) {
  const std::size_t triangles = objects.sourceTriangles.size();
  const std::size_t bands = std::size_t((picture.bounds.height + kBandRows - 1) / kBandRows);
  chunks_.resize((triangles + kTrianglesPerTask - 1) / kTrianglesPerTask);
  core::parallelFor(chunks_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Chunk& chunk = chunks_[i];
      chunk.small.clear(), chunk.large.clear(), chunk.drawn = 0;
      if (chunk.bands.size() < bands) chunk.bands.resize(bands);
      for (Band& band : chunk.bands) band.clear();
      Binner binner(picture, chunk);
      const std::size_t last = std::min(triangles, (i + 1) * kTrianglesPerTask);
      for (std::size_t t = i * kTrianglesPerTask; t < last; ++t) {
        while (t + 8 <= last && areLeftOut(&picture.isKept[t])) t += 8;
        if (t < last && picture.isKept[t] &&
            picture.isWanted[picture.triangleParts[objects.sourceTriangles[t]]])
          binner.add(objects, t);
      }
      binner.flush();
    }
  });
  const std::size_t pixels = std::size_t(picture.bounds.width) * std::size_t(picture.bounds.height);
  const std::size_t padded = pixels + std::size_t(kLanes) * std::size_t(picture.bounds.height);
  nearness_.resize(padded), limits_.resize(padded), numbers_.resize(padded);
  if (picture.withRivals) rivalNearness_.resize(padded), rivals_.resize(padded);
  image.rivals.resize(picture.withRivals ? bands : 0);
  image.hits.resize(pixels), image.depths.resize(picture.withDepths ? pixels : 0);
  const PixelRays rays(picture);
  core::parallelFor(bands, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t band = begin; band < end; ++band) drawBand(picture, rays, int(band), image);
  });
  core::parallelFor(image.rivals.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t band = begin; band < end; ++band) {
      const int first = int(band) * kBandRows;
      findNeighbours(picture, first, std::min(first + kBandRows, picture.bounds.height), image,
                     image.rivals[band]);
    }
  });
  std::size_t drawn = 0;
  for (const Chunk& chunk : chunks_) drawn += chunk.drawn;
  return drawn;
}

}  // namespace catoptric::virtual_object

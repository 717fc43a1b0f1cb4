// SPDX-License-Identifier: Apache-2.0
// Whether a zexel fills one or two columns and rows is as good as random, and a branch on it would be guessed
// wrongly for half of the zexels: 15 cycles each. So a chunk whose splats have at most N x N pixels writes N
// x N for each, some of them twice; those that fill nothing write the corner of the border.
#include "catoptric/depth_reflection_map/zexel_splats.h"

#include <algorithm>

namespace catoptric::depth_reflection_map {
namespace {

/// The picture as plain pointers: `WinnerImage` might change with what is written to it, for all the compiler
/// knows.
struct Target {
  std::uint32_t* winners;
  float* nearness;
  int stride;
};

template <Visibility V>
inline void put(const Target& out, std::int32_t pixel, std::uint32_t winner, float nearness) {
  if constexpr (V == Visibility::ZBuffer) {
    const float before = out.nearness[pixel];
    const bool isNearer = nearness > before;
    out.nearness[pixel] = isNearer ? nearness : before;
    out.winners[pixel] = isNearer ? winner : out.winners[pixel];
  } else {
    out.winners[pixel] = winner;
  }
}

/// Splats of at most N x N pixels; N = 0: of any size.
template <int N, Visibility V>
void splatAll(const Landing& landing, int count, const WinnerRun& run, const Target& out) {
  const int step = run.leftToRight ? 1 : -1;
  const std::uint32_t winnerStep = run.leftToRight ? run.step : 0u - run.step;
  auto i = std::size_t(run.leftToRight ? 0 : count - 1);
  std::uint32_t winner = run.first + std::uint32_t(i) * run.step;
  for (int k = 0; k < count; ++k, i += std::size_t(std::ptrdiff_t(step)), winner += winnerStep) {
    const std::int32_t first = landing.first[i], columns = landing.columns[i], rows = landing.rows[i];
    const float nearness = landing.nearness[i];
    const auto putRow = [&](std::int32_t start) {
      put<V>(out, start, winner, nearness);
      if constexpr (N == 3) put<V>(out, start + std::min(columns, 1), winner, nearness);
      if constexpr (N > 1) put<V>(out, start + columns, winner, nearness);
      if constexpr (N == 0)
        for (std::int32_t x = 1; x <= columns; ++x) put<V>(out, start + x, winner, nearness);
    };
    putRow(first);
    if constexpr (N == 3) putRow(first + std::min(rows, out.stride));
    if constexpr (N > 1) putRow(first + rows);
    if constexpr (N == 0)
      for (std::int32_t y = out.stride; y <= rows; y += out.stride) putRow(first + y);
  }
}

template <Visibility V>
void splatBy(const Landing& landing, int count, const WinnerRun& run, const Target& out) {
  const int most = std::max(landing.mostColumns, landing.mostRows);
  if (most == 0) return splatAll<1, V>(landing, count, run, out);
  if (most == 1) return splatAll<2, V>(landing, count, run, out);
  if (most == 2) return splatAll<3, V>(landing, count, run, out);
  splatAll<0, V>(landing, count, run, out);
}

}  // namespace

void splatZexels(const ZexelChunk& chunk, const ZexelWarp& warp, const WinnerRun& run, Splat splat,
                 WinnerImage& out) {
  Landing landing;
  landZexels(chunk, warp, splat, landing);
  if (landing.box.isEmpty()) return;
  out.written.include(landing.box);
  const Target target{out.winners.data(), out.nearness.data(), out.stride};
  if (out.nearness.empty())
    splatBy<Visibility::Ordered>(landing, chunk.count, run, target);
  else
    splatBy<Visibility::ZBuffer>(landing, chunk.count, run, target);
}

}  // namespace catoptric::depth_reflection_map

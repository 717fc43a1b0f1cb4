// SPDX-License-Identifier: Apache-2.0
// From an edge to a number, as that of the vertex at its middle: open addressing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "catoptric/core/seen.h"

namespace catoptric::raster {

class EdgeTable {
 public:
  EdgeTable() { resize(1024); }

  /// The slot of an edge, whose key is not ~0; its value is kNoId if the edge is new.
  std::uint32_t& operator[](std::uint64_t key) {
    if (2 * count_ >= keys_.size()) grow();
    std::size_t slot = findSlot(key);
    if (keys_[slot] == kFree) keys_[slot] = key, ++count_;
    return values_[slot];
  }

  /// kNoId: no such edge.
  [[nodiscard]] std::uint32_t find(std::uint64_t key) const { return values_[findSlot(key)]; }

 private:
  static constexpr std::uint64_t kFree = ~std::uint64_t(0);

  [[nodiscard]] std::size_t findSlot(std::uint64_t key) const {
    std::size_t slot = (key * 0x9e3779b97f4a7c15u) >> shift_;
    while (keys_[slot] != kFree && keys_[slot] != key) slot = (slot + 1) & (keys_.size() - 1);
    return slot;
  }
  void resize(std::size_t slots) {
    keys_.assign(slots, kFree);
    values_.assign(slots, core::kNoId);
    shift_ = 64;
    for (std::size_t s = slots; s > 1; s /= 2) --shift_;
  }
  void grow() {
    std::vector<std::uint64_t> keys = std::move(keys_);
    std::vector<std::uint32_t> values = std::move(values_);
    resize(2 * keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (keys[i] == kFree) continue;
      const std::size_t slot = findSlot(keys[i]);
      keys_[slot] = keys[i], values_[slot] = values[i];
    }
  }

  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> values_;
  std::size_t count_ = 0;
  int shift_ = 54;
};

}  // namespace catoptric::raster

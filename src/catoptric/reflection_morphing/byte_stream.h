// SPDX-License-Identifier: Apache-2.0
// core/byte_stream.h, with this folder's way of refusing a damaged file.
#pragma once

#include <string>

#include "catoptric/core/byte_stream.h"
#include "catoptric/core/error.h"

namespace catoptric::reflection_morphing {

using core::ByteWriter;
using core::computeChecksum;

[[noreturn]] inline void refuseDamaged(const char* what) {
  throw core::Error("bake.damaged", std::string("the baked file is damaged: ") + what, {}, "bake it again");
}

class ByteReader : public core::ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : core::ByteReader(bytes, refuseDamaged) {}
};

}  // namespace catoptric::reflection_morphing

// SPDX-License-Identifier: Apache-2.0
#include "catoptric/reflection_morphing/baked_format.h"

#include <fmt/format.h>

#include <cmath>

#include "catoptric/reflection_morphing/byte_stream.h"

namespace catoptric::reflection_morphing {
namespace {

core::Box getBox(ByteReader& in) {
  core::Box box;
  box.lower = in.get<dvec3>();
  box.upper = in.get<dvec3>();
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::abs(box.lower[axis]) < 1e18 && std::abs(box.upper[axis]) < 1e18 &&
          box.lower[axis] < box.upper[axis]))
      refuseDamaged("a box is empty or endless");
  return box;
}

int getInteger(ByteReader& in, std::uint32_t least, std::uint32_t most) {
  const auto value = in.get<std::uint32_t>();
  if (value < least || value > most) refuseDamaged("a number of the header is out of range");
  return int(value);
}

}  // namespace

std::vector<std::byte> packHeader(const BakedHeader& header) {
  ByteWriter out;
  out.put(kMagic);
  out.put(kBakedVersion);
  const std::size_t sizeAt = out.bytes().size();
  out.put(std::uint32_t(0));
  out.put(header.fingerprint);
  const BakePlan& plan = header.plan;
  for (const dvec3& corner : {plan.grid.box.lower, plan.grid.box.upper, plan.options.octree.box.lower,
                              plan.options.octree.box.upper})
    out.put(corner);
  out.put(plan.grid.counts);
  for (const int value : {plan.options.map.size, plan.options.map.bounces, plan.options.octree.depth,
                          plan.options.octree.mostLeafRays})
    out.put(std::uint32_t(value));
  out.put(std::uint32_t(plan.options.map.keepStatic ? 1 : 0));
  const auto& mapped = plan.options.map.mapped;
  out.put(std::uint32_t(mapped.size()));
  out.put(computeChecksum(std::as_bytes(std::span(mapped))));
  const auto size = std::uint32_t(out.bytes().size() + sizeof(std::uint64_t));
  std::memcpy(out.bytes().data() + sizeAt, &size, sizeof size);
  out.put(computeChecksum(out.bytes()));
  return std::move(out.bytes());
}

std::size_t headerSize() {
  static const std::size_t size = packHeader({}).size();
  return size;
}

BakedHeader unpackHeader(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  if (bytes.size() < sizeof kMagic + sizeof kBakedVersion || in.get<Magic>() != kMagic)
    throw core::Error("bake.foreign", "this is no file of 'catoptric bake'");
  BakedHeader header;
  header.version = in.get<std::uint32_t>();
  if (header.version != kBakedVersion)
    throw core::Error(
        "bake.version",
        fmt::format("the baked file has format {}, this version reads {}", header.version, kBakedVersion), {},
        "bake it again");
  if (bytes.size() < headerSize())
    throw core::Error("bake.truncated", "the baked file ends in its header", {}, "bake it again");
  const auto body = bytes.first(headerSize() - sizeof(std::uint64_t));
  std::uint64_t checksum = 0;
  std::memcpy(&checksum, bytes.data() + body.size(), sizeof checksum);
  if (in.get<std::uint32_t>() != headerSize() || checksum != computeChecksum(body))
    refuseDamaged("the checksum of its header is wrong");
  header.fingerprint = in.get<std::uint64_t>();
  BakePlan& plan = header.plan;
  plan.grid.box = getBox(in);
  plan.options.octree.box = getBox(in);
  for (int axis = 0; axis < 3; ++axis) plan.grid.counts[axis] = std::uint32_t(getInteger(in, 2, 1u << 20));
  if (plan.grid.locationCount() > 0xffffffffu) refuseDamaged("the grid is too large");
  plan.options.map.size = getInteger(in, 2, 4096);
  plan.options.map.bounces = getInteger(in, 1, 64);
  plan.options.octree.depth = getInteger(in, 0, 12);
  plan.options.octree.mostLeafRays = getInteger(in, 1, 31);
  plan.options.map.keepStatic = getInteger(in, 0, 1) != 0;
  header.mappedReflectors = in.get<std::uint32_t>();
  return header;
}

}  // namespace catoptric::reflection_morphing

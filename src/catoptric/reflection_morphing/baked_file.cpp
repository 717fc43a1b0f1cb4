// SPDX-License-Identifier: Apache-2.0
#include "catoptric/reflection_morphing/baked_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "catoptric/reflection_morphing/baked_format.h"
#include "catoptric/reflection_morphing/byte_stream.h"

namespace catoptric::reflection_morphing {
namespace {

/// The whole file, mapped; the caller unmaps it.
std::span<const std::byte> mapFile(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  const bool isOpen = fd >= 0 && ::fstat(fd, &status) == 0;
  const int code = errno;
  void* mapped = MAP_FAILED;
  if (isOpen && S_ISREG(status.st_mode) && status.st_size > 0)
    mapped = ::mmap(nullptr, std::size_t(status.st_size), PROT_READ, MAP_PRIVATE, fd, 0);
  if (fd >= 0) ::close(fd);
  if (!isOpen)
    throw core::Error("file.read", "cannot read '" + path.string() +
                                       "': " + std::error_code(code, std::generic_category()).message());
  if (!S_ISREG(status.st_mode)) throw core::Error("file.read", "'" + path.string() + "' is no regular file");
  if (status.st_size == 0) throw core::Error("bake.truncated", "'" + path.string() + "' is empty");
  if (mapped == MAP_FAILED) throw core::Error("file.read", "cannot map '" + path.string() + "' into memory");
  return {static_cast<const std::byte*>(mapped), std::size_t(status.st_size)};
}

[[noreturn]] void throwTruncated() {
  throw core::Error("bake.truncated", "the baked file is not complete", {},
                    "run 'catoptric bake' again; it goes on where it stopped");
}

/// The offsets of the records, in the file.
std::span<const std::byte> findTable(std::span<const std::byte> bytes, const SamplingGrid& grid) {
  const std::uint64_t size = 8 * grid.locationCount();
  if (bytes.size() < headerSize() + size + 16) throwTruncated();
  const auto table = bytes.last(std::size_t(size) + 16);
  ByteReader in(table);
  const auto offsets = in.take(std::size_t(size));
  const auto checksum = in.get<std::uint64_t>();
  if (in.get<Magic>() != kEndMagic) throwTruncated();
  if (checksum != computeChecksum(offsets)) refuseDamaged("the checksum of its table is wrong");
  return offsets;
}

}  // namespace

BakedFile::BakedFile(const std::filesystem::path& path) : bytes_(mapFile(path)) {
  try {
    header_ = unpackHeader(bytes_);
    offsets_ = findTable(bytes_, header_.plan.grid);
  } catch (const core::Error& error) {
    ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
    throw core::Error(error.code(), "'" + path.string() + "': " + error.message(), {}, error.hint());
  }
}

BakedFile::~BakedFile() {
  ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

void BakedFile::checkScene(const scene::WorldGeometry& world) const {
  if (header_.fingerprint != computeFingerprint(world))
    throw core::Error("bake.other_scene", "the baked file was made for other mirrors than this scene has", {},
                      "bake this scene");
}

std::span<const std::byte> BakedFile::findRecord(std::uint32_t index) const {
  std::uint64_t offset = 0, size = 0, checksum = 0;
  std::memcpy(&offset, offsets_.data() + 8 * std::size_t(index), sizeof offset);
  const std::size_t end = bytes_.size() - offsets_.size() - 16;
  if (offset < headerSize() || offset > end || end - offset < kRecordHeader)
    refuseDamaged("a location lies outside of it");
  std::memcpy(&size, bytes_.data() + offset, sizeof size);
  std::memcpy(&checksum, bytes_.data() + offset + 8, sizeof checksum);
  if (size > end - offset - kRecordHeader) refuseDamaged("a location lies outside of it");
  const auto record = bytes_.subspan(std::size_t(offset) + kRecordHeader, std::size_t(size));
  if (checksum != computeChecksum(record)) refuseDamaged("the checksum of a location is wrong");
  return record;
}

std::shared_ptr<const SamplingLocation> BakedFile::load(std::uint32_t index) const {
  return unpackLocation(findRecord(index), header_.plan.options.octree.box);
}

std::size_t BakedFile::locationBytes(std::uint32_t index) const {
  return findRecord(index).size();
}

std::uint64_t computeFingerprint(const scene::WorldGeometry& world) {
  std::uint64_t hash = computeChecksum({});
  const auto add = [&](const auto& values) {
    hash = computeChecksum(std::as_bytes(std::span(values)), hash);
  };
  for (const scene::Reflector& reflector : world.reflectors) {
    const scene::Part& part = world.parts[reflector.part];
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < part.indexCount; ++i)
      indices.push_back(world.indices[part.firstIndex + i] - part.firstVertex);
    indices.push_back(reflector.doubleSided ? 1 : 0);
    if (reflector.isRefractor()) add(std::span(&reflector.ior, 1));
    add(indices);
    add(std::span(world.positions).subspan(part.firstVertex, part.vertexCount));
    add(std::span(world.normals).subspan(part.firstVertex, part.vertexCount));
  }
  return hash;
}

}  // namespace catoptric::reflection_morphing

// SPDX-License-Identifier: Apache-2.0
// Bakes a grid of locations into a file, many at a time, and can be stopped at any moment.
//
//   1. FILE.part is opened. If it begins with the header of this very bake, its records are read as far as
//      their checksums hold, and it is cut off behind the last good one; else it is started anew.
//   2. The locations that are missing are baked, as many at a time as there are threads, and appended in
//      order. So memory is bounded by the threads, and what is in the file never depends on them.
//   3. The table is appended and the file renamed. Until then there is no FILE, or the old one.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <system_error>

#include "catoptric/core/parallel.h"
#include "catoptric/reflection_morphing/baked_format.h"
#include "catoptric/reflection_morphing/byte_stream.h"

namespace catoptric::reflection_morphing {
namespace {

/// FILE.part, open for appending.
class PartFile {
 public:
  explicit PartFile(std::filesystem::path target)
      : target_(std::move(target)), path_(target_.string() + ".part") {
    std::error_code ignored;
    if (std::filesystem::exists(target_, ignored) && !std::filesystem::is_regular_file(target_, ignored))
      throw core::Error("file.write", "cannot write '" + target_.string() + "': it is no regular file");
    file_ = std::fopen(path_.c_str(), "ab+");
    if (file_ == nullptr) fail("cannot write");
  }
  ~PartFile() {
    if (file_ != nullptr) std::fclose(file_);
  }
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  /// Step 1: calls visit(record) for each good record after the header; what follows is cut off.
  template <class Visit>
  void resume(std::span<const std::byte> header, std::uint64_t mostRecords, const Visit& visit) {
    std::rewind(file_);
    std::vector<std::byte> start(header.size());
    if (!read(start) || !std::equal(start.begin(), start.end(), header.begin())) {
      cutOff(0);
      append(header);
      return;
    }
    size_ = header.size();
    std::vector<std::byte> record;
    std::uint64_t head[2];  // size, checksum
    while (offsets_.size() < mostRecords && read(std::as_writable_bytes(std::span(head)))) {
      constexpr std::uint64_t kLargest = std::uint64_t(1) << 32;
      if (head[0] > kLargest) break;
      record.resize(std::size_t(head[0]));
      if (!read(record) || computeChecksum(record) != head[1]) break;
      offsets_.push_back(size_);
      size_ += kRecordHeader + record.size();
      visit(std::span<const std::byte>(record));
    }
    cutOff(size_);
  }

  void appendRecord(std::span<const std::byte> record) {
    offsets_.push_back(size_);
    const std::uint64_t head[2] = {record.size(), computeChecksum(record)};
    append(std::as_bytes(std::span(head)));
    append(record);
    if (std::fflush(file_) != 0) fail("cannot write");
  }

  /// Step 3.
  void finish() {
    ByteWriter table;
    table.putAll(std::span<const std::uint64_t>(offsets_));
    table.put(computeChecksum(table.bytes()));
    table.put(kEndMagic);
    append(table.bytes());
    if (std::fflush(file_) != 0 || ::fsync(::fileno(file_)) != 0) fail("cannot write");
    std::error_code error;
    std::filesystem::rename(path_, target_, error);
    if (error) throw core::Error("file.write", "cannot write '" + target_.string() + "': " + error.message());
  }

  [[nodiscard]] std::size_t recordCount() const { return offsets_.size(); }

 private:
  bool read(std::span<std::byte> bytes) {
    return std::fread(bytes.data(), 1, bytes.size(), file_) == bytes.size();
  }
  void append(std::span<const std::byte> bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail("cannot write");
    size_ += bytes.size();
  }
  void cutOff(std::uint64_t size) {
    std::fflush(file_);
    if (::ftruncate(::fileno(file_), ::off_t(size)) != 0) fail("cannot shorten");
    std::fseek(file_, 0, SEEK_END);
    size_ = size;
  }
  [[noreturn]] void fail(const char* what) const {
    throw core::Error("file.write", fmt::format("{} '{}': {}", what, path_.string(),
                                                std::error_code(errno, std::generic_category()).message()));
  }

  std::filesystem::path target_, path_;
  std::FILE* file_ = nullptr;
  std::uint64_t size_ = 0;
  std::vector<std::uint64_t> offsets_;
};

BakedLocation describe(std::span<const std::byte> record, const core::Box& box, double seconds) {
  const auto location = unpackLocation(record, box);
  BakedLocation result;
  result.position = location->position;
  result.seconds = seconds;
  result.bytes = record.size();
  result.traces = location->traces.size();
  std::size_t leaves = 0, leafRays = 0;
  for (const SampledTrace& trace : location->traces) {
    const RayOctreeStatistics statistics = measure(trace.octree);
    result.rays += trace.table.countRays();
    leaves += statistics.leaves;
    leafRays += statistics.rays;
    result.mostLeafRays = std::max(result.mostLeafRays, statistics.mostRays);
  }
  if (leaves > 0) result.meanLeafRays = double(leafRays) / double(leaves);
  return result;
}

}  // namespace

std::vector<BakedLocation> bakeToFile(const scene::WorldGeometry& world, const BakePlan& plan,
                                      const std::filesystem::path& path, core::Progress& progress) {
  const std::uint64_t count = plan.grid.locationCount();
  const core::Box& box = plan.options.octree.box;
  std::vector<BakedLocation> results;
  // 1
  PartFile file(path);
  file.resume(packHeader({kBakedVersion, computeFingerprint(world), plan}), count,
              [&](std::span<const std::byte> record) { results.push_back(describe(record, box, 0)); });
  progress.advance(file.recordCount());
  progress.expectEvenSteps();

  // 2
  const MirrorRays rays(world, plan.options.map.keepStatic);
  const auto batch = std::size_t(core::threadCount());
  std::vector<std::vector<std::byte>> records(batch);
  std::vector<BakedLocation> described(batch);
  while (file.recordCount() < count) {
    const std::size_t first = file.recordCount(), size = std::min<std::size_t>(batch, count - first);
    core::parallelFor(size, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto start = std::chrono::steady_clock::now();
        records[i] = bakeLocation(rays, plan.grid.location(std::uint32_t(first + i)), plan.options);
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
        described[i] = describe(records[i], box, spent.count());
        progress.advance();
      }
    });
    for (std::size_t i = 0; i < size; ++i) {
      file.appendRecord(records[i]);
      results.push_back(described[i]);
    }
  }

  // 3
  file.finish();
  return results;
}

}  // namespace catoptric::reflection_morphing

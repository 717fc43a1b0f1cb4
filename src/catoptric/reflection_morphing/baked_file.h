// SPDX-License-Identifier: Apache-2.0
// One file with all sampling locations of a scene. Layout, little-endian:
//   header   "CATOBAKE", version (4), header size (4), fingerprint of the mirrors (8), grid, look-up box,
//            rays, bounces, depth, rays in a leaf, static objects kept, reflectors that are not baked (how
//            many, checksum of which); checksum of all that (8)
//   records  one a location, in order of index: size (8), checksum (8), bytes of bakeLocation()
//   table    offset of each record (8), checksum of the offsets (8), "CATODONE"
// A file without a table is a bake that was interrupted; it has the name of the file and ".part".
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "catoptric/core/progress.h"
#include "catoptric/reflection_morphing/location_source.h"

namespace catoptric::reflection_morphing {

/// What the header says.
struct BakedHeader {
  std::uint32_t version = 0;
  std::uint64_t fingerprint = 0;
  BakePlan plan;                       ///< without RayMapOptions::mapped
  std::uint32_t mappedReflectors = 0;  ///< how many there were
};

/// Of all that the maps depend on: positions, normals and triangles of the mirrors. Diffuse objects may
/// change.
[[nodiscard]] std::uint64_t computeFingerprint(const scene::WorldGeometry& world);

/// A file of bakeToFile(), mapped into memory; a location is checked and unpacked when it is asked for.
class BakedFile : public LocationSource {
 public:
  /// Throws core::Error: "bake.foreign", "bake.version", "bake.truncated", "bake.damaged", "file.*".
  explicit BakedFile(const std::filesystem::path& path);
  ~BakedFile() override;
  BakedFile(const BakedFile&) = delete;
  BakedFile& operator=(const BakedFile&) = delete;

  /// Throws core::Error("bake.other_scene") unless the mirrors are those that were baked.
  void checkScene(const scene::WorldGeometry& world) const;
  [[nodiscard]] const BakedHeader& header() const { return header_; }
  [[nodiscard]] const SamplingGrid& grid() const override { return header_.plan.grid; }
  [[nodiscard]] std::shared_ptr<const SamplingLocation> load(std::uint32_t index) const override;
  [[nodiscard]] std::size_t byteCount() const { return bytes_.size(); }
  [[nodiscard]] std::size_t locationBytes(std::uint32_t index) const;

 private:
  [[nodiscard]] std::span<const std::byte> findRecord(std::uint32_t index) const;

  std::span<const std::byte> bytes_, offsets_;
  BakedHeader header_;
};

/// What one location cost; for --json.
struct BakedLocation {
  dvec3 position{0};
  double seconds = 0;  ///< of one thread; 0 for a location that an interrupted bake had done already
  std::size_t bytes = 0, traces = 0, rays = 0;
  double meanLeafRays = 0;
  std::size_t mostLeafRays = 0;
};

/// Bakes all locations of the plan's grid, on all threads, as many at a time as there are threads. Goes on
/// where an interrupted bake of the same plan and mirrors left off; the finished file has the same bytes
/// either way. Throws core::Error("file.write").
std::vector<BakedLocation> bakeToFile(const scene::WorldGeometry& world, const BakePlan& plan,
                                      const std::filesystem::path& path, core::Progress& progress);

}  // namespace catoptric::reflection_morphing

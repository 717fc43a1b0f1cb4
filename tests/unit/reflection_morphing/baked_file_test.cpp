// SPDX-License-Identifier: Apache-2.0
// Baked files: what is written is read; an interrupted bake ends in the same bytes; damage does no harm.
// CATOPTRIC_DAMAGED_FILES=10000 runs the tests of damaged files with that many.
#include "catoptric/reflection_morphing/baked_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>

#include "catoptric/core/error.h"
#include "catoptric/core/file.h"
#include "catoptric/reflection_morphing/find_ray.h"
#include "mirror_world.h"

namespace catoptric::reflection_morphing {
namespace {

using namespace test;
using Bytes = std::vector<std::byte>;

int damagedFiles(int fewer) {
  const char* wanted = std::getenv("CATOPTRIC_DAMAGED_FILES");
  return wanted != nullptr ? std::atoi(wanted) : fewer;
}

void lookUpIn(const SamplingLocation& location) {
  for (const SampledTrace& trace : location.traces)
    for (const vec3& q : {vec3(0.2f, 0.4f, 1.0f), vec3(-2, 1, 0), vec3(9)}) {
      const OctreeRay& ray = findNearestRay(trace.octree, trace.octree.findLeaf(q), q);
      (void)findRay(trace.table, q, {ray.x, ray.y});
      (void)trace.shaft.mayReach(q);
    }
}

/// The code of the error that opening and reading everything ends in; empty: none.
std::string readAll(const std::filesystem::path& path) {
  try {
    const BakedFile file(path);
    const auto count = std::min<std::uint64_t>(file.grid().locationCount(), 64);
    for (std::uint32_t i = 0; i < count; ++i) lookUpIn(*file.load(i));
  } catch (const core::Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.code();
  }
  return {};
}

class BakedFileTest : public testing::Test {
 protected:
  BakedFileTest()
      : world_(makeMirrorWorld({makeSphereAt({-0.6, 0, 0}, 0.5, 6), makeSphereAt({0.6, 0, 0}, 0.5, 6)})) {
    plan_.grid = {{dvec3(-1, 0, 1.5), dvec3(1, 1, 2)}, {3, 2, 2}};
    plan_.options = makeOptions(world_, 24, 2, 2);
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    // Of this process: another tree's suite may run at the same time.
    path_ = std::filesystem::path(testing::TempDir()) / fmt::format("catoptric_{}_{}.bake", name, ::getpid());
    std::filesystem::remove(part());
  }
  ~BakedFileTest() override {
    std::filesystem::remove(path_);
    std::filesystem::remove(part());
  }
  [[nodiscard]] std::filesystem::path part() const { return path_.string() + ".part"; }
  Bytes bake() {
    core::setProgressStyle(core::ProgressStyle::Silent);
    core::Progress progress("baking", std::size_t(plan_.grid.locationCount()));
    baked_ = bakeToFile(world_, plan_, path_, progress);
    return core::readFile(path_);
  }
  std::string readChanged(Bytes bytes, const std::function<void(Bytes&)>& change) {
    change(bytes);
    core::writeFileAtomically(path_, std::span<const std::byte>(bytes));
    return readAll(path_);
  }

  scene::WorldGeometry world_;
  BakePlan plan_;
  std::filesystem::path path_;
  std::vector<BakedLocation> baked_;
};

TEST_F(BakedFileTest, isReadAsItWasWritten) {
  const Bytes bytes = bake();
  EXPECT_FALSE(std::filesystem::exists(part()));
  const BakedFile file(path_);
  file.checkScene(world_);
  EXPECT_EQ(file.byteCount(), bytes.size());
  EXPECT_EQ(file.grid().counts, plan_.grid.counts);
  ASSERT_EQ(baked_.size(), 12u);
  const MirrorRays rays(world_);
  for (std::uint32_t i = 0; i < 12; ++i) {
    const Bytes expected = bakeLocation(rays, plan_.grid.location(i), plan_.options);
    EXPECT_EQ(file.locationBytes(i), expected.size());
    EXPECT_EQ(file.load(i)->position, plan_.grid.location(i));
  }
  EXPECT_GE(file.load(0)->traces.size(), 3u);  // two mirrors, and one in the other
}

TEST_F(BakedFileTest, anInterruptedBakeEndsInTheSameBytes) {
  const Bytes whole = bake();
  std::mt19937 random(3);
  for (int i = 0; i < 10; ++i) {
    Bytes part(whole.begin(), whole.begin() + std::ptrdiff_t(random() % whole.size()));
    if (i % 2 == 1 && part.size() > 600) part[part.size() - 100] ^= std::byte(1);  // half-written block
    std::filesystem::remove(path_);
    core::writeFileAtomically(this->part(), std::span<const std::byte>(part));
    EXPECT_EQ(bake(), whole) << part.size();
  }
}

TEST_F(BakedFileTest, thePartOfAnotherBakeIsNotGoneOnWith) {
  const Bytes whole = bake();
  plan_.options.octree.depth = 1;
  const Bytes other = bake();
  EXPECT_NE(other, whole);
  core::writeFileAtomically(part(), std::span<const std::byte>(whole).first(whole.size() / 2));
  EXPECT_EQ(bake(), other);
}

TEST_F(BakedFileTest, isRefusedWithItsReason) {
  const Bytes bytes = bake();
  EXPECT_EQ(readAll(path_.string() + ".missing"), "file.read");
  EXPECT_EQ(readChanged(bytes, [](Bytes& b) { b[0] = std::byte('X'); }), "bake.foreign");
  EXPECT_EQ(readChanged(bytes, [](Bytes& b) { b.resize(3); }), "bake.foreign");
  EXPECT_EQ(readChanged(bytes, [](Bytes& b) { b[8] = std::byte(3); }), "bake.version");
  EXPECT_EQ(readChanged(bytes, [](Bytes& b) { b.resize(40); }), "bake.truncated");
  EXPECT_EQ(readChanged(bytes, [](Bytes& b) { b.resize(b.size() - 1); }), "bake.truncated");
  EXPECT_EQ(readChanged(bytes, [](Bytes& b) { b[50] ^= std::byte(4); }), "bake.damaged");
  EXPECT_EQ(readChanged(bytes, [](Bytes& b) { b[b.size() / 2] ^= std::byte(4); }), "bake.damaged");
  EXPECT_EQ(readChanged(bytes, [](Bytes& b) { b[b.size() - 20] ^= std::byte(4); }), "bake.damaged");
  EXPECT_EQ(readChanged(bytes, [](Bytes&) {}), "");
  scene::WorldGeometry other = world_;
  other.positions[5].x += 0.01f;
  try {
    BakedFile(path_).checkScene(other);
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_EQ(error.code(), "bake.other_scene");
  }
}

TEST_F(BakedFileTest, damagedFilesDoNoHarm) {
  const Bytes bytes = bake();
  std::mt19937 random(5);
  const int count = damagedFiles(200);
  for (int i = 0; i < count; ++i) {
    const std::string code = readChanged(bytes, [&](Bytes& b) {
      if (i % 3 == 0) b.resize(random() % b.size());
      for (unsigned k = 0; k < 1 + random() % 4 && !b.empty(); ++k)
        b[random() % b.size()] ^= std::byte(1u << (random() % 8));
      if (b == bytes) b.back() ^= std::byte(1);  // two flips of one bit
    });
    EXPECT_NE(code, "") << i;  // every byte is under a checksum
  }
}

TEST_F(BakedFileTest, wrongSizesUnderAValidChecksumDoNoHarm) {
  const Bytes good = bakeLocation(MirrorRays(world_), plan_.grid.location(1), plan_.options);
  std::mt19937 random(9);
  const int count = damagedFiles(1000);
  int refused = 0;
  for (int i = 0; i < count; ++i) {
    Bytes bytes = good;
    if (i % 5 == 0) bytes.resize(random() % bytes.size());
    const std::uint32_t values[] = {0, 1, 0xffffffffu, 0x7fffffffu, 0x80000000u, std::uint32_t(random())};
    for (unsigned k = 0; k < 1 + random() % 3 && bytes.size() > 8; ++k) {
      const std::uint32_t value = values[random() % 6];
      const std::size_t all = bytes.size() - 4,
                        reach = random() % 2 == 0 ? std::min<std::size_t>(all, 120) : all;
      std::memcpy(bytes.data() + random() % reach, &value, sizeof value);
    }
    try {
      lookUpIn(*unpackLocation(bytes, plan_.options.octree.box));
    } catch (const core::Error& error) {
      EXPECT_EQ(error.code(), "bake.damaged");
      ++refused;
    }
  }
  EXPECT_GT(refused, count / 4);
}

}  // namespace
}  // namespace catoptric::reflection_morphing

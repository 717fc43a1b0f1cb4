// SPDX-License-Identifier: Apache-2.0
// What files that are let go of over the viewer's window mean.
#include "viewer/dropped_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "catoptric/core/error.h"

namespace catoptric::viewer {
namespace {

using Names = std::vector<std::string>;

struct Folder {
  std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "dropped files";
  Folder() {
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path / "empty");
    for (const char* name : {"b.glb", "A.GLTF", "b.bin", "sky.HDR"}) std::ofstream(path / name) << "?";
  }
  ~Folder() { std::filesystem::remove_all(path); }
  [[nodiscard]] std::string operator/(const char* name) const { return (path / name).string(); }
};

TEST(DroppedFiles, ScenesAndSurroundingsAreToldApartByName) {
  const DroppedFiles sorted =
      sortDroppedFiles(Names{"/x/room.glb", "/x/room.bin", "/x/day.exr", "/x/night.hdr", "/x/hall.gltf"});
  EXPECT_EQ(sorted.scenes, (Names{"/x/hall.gltf", "/x/room.glb"}));
  EXPECT_EQ(sorted.environment, "/x/night.hdr");
  EXPECT_TRUE(sortDroppedFiles(Names{"/x/day.EXR"}).scenes.empty());
  EXPECT_TRUE(sortDroppedFiles(Names{}).scenes.empty());
}

TEST(DroppedFiles, AFolderStandsForItsScenes) {
  const Folder folder;
  const DroppedFiles sorted = sortDroppedFiles(Names{folder.path.string()});
  EXPECT_EQ(sorted.scenes, (Names{folder / "A.GLTF", folder / "b.glb"}));
  EXPECT_TRUE(sorted.environment.empty()) << "a folder's skies are listed, not taken";
  EXPECT_THROW((void)sortDroppedFiles(Names{folder / "empty"}), core::Error);
}

TEST(DroppedFiles, WhatIsNeitherIsRefusedByItsName) {
  try {
    (void)sortDroppedFiles(Names{"/x/notes.txt", "/x/room.bin"});
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_EQ(error.code(), "file.kind");
    EXPECT_NE(error.message().find("'notes.txt'"), std::string::npos);
    EXPECT_FALSE(error.hint().empty());
  }
}

}  // namespace
}  // namespace catoptric::viewer

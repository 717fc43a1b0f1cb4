// SPDX-License-Identifier: Apache-2.0
// Which files a scene may name.
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "gltf_test_support.h"

namespace catoptric::scene::gltf_test {
namespace {

namespace fs = std::filesystem;

/// A folder "scene" inside a folder of its own; removed afterwards.
class GltfUri : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "catoptric_uri_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    root_ = name;
    folder_ = root_ / "scene";
    fs::create_directories(folder_ / "sub");
    document_ = makeTriangle();
    write(root_ / "outside.bin");
  }
  void TearDown() override { fs::remove_all(root_); }

  void write(const fs::path& file) {
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(document_.bytes().data()),
               std::streamsize(document_.bytes().size()));
  }
  std::string withUri(const std::string& uri) {
    document_.json["buffers"] = {{{"byteLength", document_.bytes().size()}, {"uri", uri}}};
    return document_.text();
  }
  void expectRead(const std::string& uri) {
    try {
      EXPECT_EQ(import(withUri(uri), {}, folder_).instances.size(), 1u);
    } catch (const core::Error& error) {
      ADD_FAILURE() << uri << ": " << error.what();
    }
  }
  void expectRefused(const std::string& uri, const std::string& code = "gltf.uri") {
    const auto error = importError(withUri(uri), {}, folder_);
    ASSERT_TRUE(error) << uri;
    EXPECT_EQ(error->code(), code) << error->what();
    EXPECT_EQ(error->pointer(), "/buffers/0/uri") << error->what();
  }

  fs::path root_, folder_;
  Document document_;
};

TEST_F(GltfUri, ReadsNamesWithBlanksUnicodeAndPercentSigns) {
  for (const char* name : {"a.bin", "with blank.bin", "\xE2\x9D\xA4\xE2\x99\xBB.bin", "100%.bin", "sub/b.bin",
                           "a+b&c=d.bin", "..c.bin"}) {
    write(folder_ / name);
    expectRead(name);
  }
  expectRead("with%20blank.bin");
  expectRead("%E2%9D%A4%e2%99%bb.bin");
  expectRead("./sub//b.bin");
}

TEST_F(GltfUri, RefusesWhateverLeavesTheFolder) {
  for (const char* uri : {"../outside.bin", "sub/../../outside.bin", "sub/../a.bin", "%2e%2e/outside.bin",
                          "%2E%2E%2Foutside.bin", "..", ""})
    expectRefused(uri);
  expectRefused((root_ / "outside.bin").string());
  expectRefused("/dev/zero");
  expectRefused("%2Fdev%2Fzero");
  expectRefused("..\\outside.bin");
  expectRefused("a%00.bin");
}

TEST_F(GltfUri, RefusesSchemes) {
  for (const char* uri : {"http://example.org/a.bin", "https:a.bin", "file:///etc/passwd", "FILE:a.bin",
                          "C:/a.bin", ":", "javascript:0"})
    expectRefused(uri);
}

TEST_F(GltfUri, RefusesSymbolicLinksThatLeadOut) {
  fs::create_symlink(root_ / "outside.bin", folder_ / "link.bin");
  fs::create_directory_symlink(root_, folder_ / "up");
  expectRefused("link.bin");
  expectRefused("up/outside.bin");
  write(folder_ / "inside.bin");
  fs::create_symlink("inside.bin", folder_ / "good.bin");
  expectRead("good.bin");
  // The scene's own folder may be reached through a link.
  fs::create_directory_symlink(folder_, root_ / "alias");
  EXPECT_EQ(import(withUri("inside.bin"), {}, root_ / "alias").instances.size(), 1u);
}

TEST_F(GltfUri, RefusesWhatIsNoRegularFile) {
  expectRefused("sub");
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  expectRefused("pipe");
  expectRefused("missing.bin", "gltf.file");
  expectRefused(std::string(5000, 'x'), "gltf.file");
}

TEST_F(GltfUri, RefusesFilesThatAreTooShortOrTooLarge) {
  std::ofstream(folder_ / "short.bin") << "abc";
  EXPECT_EQ(importError(withUri("short.bin"), {}, folder_)->code(), "gltf.buffer_size");
  std::ofstream(folder_ / "large.bin") << std::string(2 << 20, 'x');
  ImportOptions options;
  options.maxMemoryBytes = 1 << 20;
  EXPECT_EQ(importError(withUri("large.bin"), options, folder_)->code(), "gltf.memory");
}

TEST_F(GltfUri, WithoutAFolderOnlyDataUrisAreRead) {
  EXPECT_EQ(importError(withUri("a.bin"))->code(), "gltf.uri");
  document_.json.erase("buffers");
  EXPECT_EQ(import(document_.text()).instances.size(), 1u);
}

TEST_F(GltfUri, DataUris) {
  const std::string base64 = encodeBase64(document_.bytes());
  expectRead("data:;base64," + base64);
  expectRead("data:application/gltf-buffer;base64," + base64);
  expectRead("DATA:application/octet-stream;base64," + base64);
  std::string percent = "data:application/octet-stream,";
  for (const std::byte b : document_.bytes()) {
    char hex[4];
    std::snprintf(hex, sizeof hex, "%%%02x", unsigned(b));
    percent += hex;
  }
  expectRead(percent);
  for (const char* bad : {"data:", "data:application/octet-stream;;base64,AA==", "data:x;base64,????",
                          "data:x;base64,A", "data:x;base64,AA=A"})
    expectRefused(bad);
  EXPECT_EQ(importError(withUri("data:x;base64,AAAA"), {}, folder_)->code(), "gltf.buffer_size");
}

TEST_F(GltfUri, ImportFromAPathFindsNeighboursAndNamesMissingFiles) {
  write(folder_ / "a.bin");
  std::ofstream(folder_ / "scene.gltf") << withUri("a.bin");
  EXPECT_EQ(importGltf(folder_ / "scene.gltf").instances.size(), 1u);
  try {
    (void)importGltf(folder_ / "nothing.gltf");
    ADD_FAILURE();
  } catch (const core::Error& error) {
    EXPECT_TRUE(error.code().starts_with("file.")) << error.code();
  }
}

}  // namespace
}  // namespace catoptric::scene::gltf_test

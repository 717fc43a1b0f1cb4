// SPDX-License-Identifier: Apache-2.0
// Every glTF file at hand goes through the importer: it loads into a scene that keeps its promises, or is
// refused with one line, within 2 s. Prints one summary line per folder. The folders are looked up in
// CATOPTRIC_ASSETS and in Debian's assimp-testmodels; a test skips when its folder is absent.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <set>

#include "gltf_test_support.h"

namespace catoptric::scene::gltf_test {
namespace {

namespace fs = std::filesystem;

enum class Outcome { Loaded, Repaired, NeedsExtension, Refused, Broken };

struct Result {
  Outcome outcome = Outcome::Broken;
  std::string detail;  ///< The error, or what is broken.
};

Result tryImport(const fs::path& file) {
  const auto start = std::chrono::steady_clock::now();
  Result result;
  try {
    const Scene scene = importGltf(file);
    result = {scene.warnings.empty() ? Outcome::Loaded : Outcome::Repaired, ""};
    if (const std::string fault = checkScene(scene); !fault.empty()) result = {Outcome::Broken, fault};
  } catch (const core::Error& error) {
    result = {error.code() == "gltf.extension_required" ? Outcome::NeedsExtension : Outcome::Refused,
              error.what()};
    const bool isKnownCode = error.code().starts_with("gltf.") || error.code().starts_with("file.");
    if (!isKnownCode || result.detail.find('\n') != std::string::npos || result.detail.empty())
      result.outcome = Outcome::Broken;
  } catch (const std::exception& error) {
    result = {Outcome::Broken, fmt::format("foreign exception: {}", error.what())};
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
#ifdef __SANITIZE_ADDRESS__
  constexpr double kMaxSeconds = 20;  // the sanitizers slow image decoding down tenfold
#else
  constexpr double kMaxSeconds = 2;
#endif
  if (seconds.count() > kMaxSeconds)
    result = {Outcome::Broken, fmt::format("took {:.1f} s", seconds.count())};
  if (std::getenv("CATOPTRIC_GLTF_VERBOSE") != nullptr)
    fmt::print("{}: {} {}\n", file.string(), int(result.outcome), result.detail);
  return result;
}

std::vector<fs::path> findSceneFiles(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->path().extension() == ".gltf" || it->path().extension() == ".glb") files.push_back(it->path());
  std::sort(files.begin(), files.end());
  return files;
}

/// Empty if there is no such folder.
fs::path findAssets(const std::string& name) {
  const fs::path absolute(name);
  const char* const assets = std::getenv("CATOPTRIC_ASSETS");
  const fs::path folder = absolute.is_absolute() ? absolute
                          : assets != nullptr    ? fs::path(assets) / name
                                                 : fs::path();
  return !folder.empty() && fs::is_directory(folder) ? folder : fs::path();
}

struct Corpus {
  const char* folder;
  std::size_t leastFiles;
  bool mustLoad;  ///< Refusals other than for a required extension are failures.
};

class GltfCorpus : public testing::TestWithParam<Corpus> {};

TEST_P(GltfCorpus, LoadsOrIsRefusedWithOneLine) {
  const fs::path folder = findAssets(GetParam().folder);
  if (folder.empty())
    GTEST_SKIP() << GetParam().folder << " is not there (CATOPTRIC_ASSETS, assimp-testmodels)";
  std::array<std::size_t, 5> counts{};
  const std::vector<fs::path> files = findSceneFiles(folder);
  for (const fs::path& file : files) {
    const Result result = tryImport(file);
    ++counts[std::size_t(result.outcome)];
    EXPECT_NE(result.outcome, Outcome::Broken) << file << ": " << result.detail;
    if (GetParam().mustLoad) {
      EXPECT_NE(result.outcome, Outcome::Refused) << file << ": " << result.detail;
    }
  }
  EXPECT_GE(files.size(), GetParam().leastFiles);
  fmt::print(
      "gltf corpus {}: {} files, {} loaded, {} loaded with warnings or repairs, {} refused by extension, {} "
      "refused, {} broken\n",
      GetParam().folder, files.size(), counts[0], counts[1], counts[2], counts[3], counts[4]);
}

INSTANTIATE_TEST_SUITE_P(Folders, GltfCorpus,
                         testing::Values(Corpus{"khronos", 60, true}, Corpus{"conformance", 80, true},
                                         Corpus{"vehicles", 1, true}, Corpus{"scenes", 1, true},
                                         Corpus{"malformed", 150, false},
                                         Corpus{"/usr/share/assimp/models/glTF2", 46, false}),
                         [](const testing::TestParamInfo<Corpus>& corpus) {
                           std::string name = corpus.param.folder;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return std::isalnum(c) == 0; }, '_');
                           return name;
                         });

/// Errors of the Khronos validator that we accept on purpose; docs/gltf.md says what is done instead.
const std::set<std::string>& acceptedErrors() {
  static const std::set<std::string> kCodes = {
      // The limits that a file states are not used; those of the data are.
      "ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND",
      "ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND",
      "ACCESSOR_MAX_MISMATCH",
      "ACCESSOR_MIN_MISMATCH",
      "MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS",
      "ANIMATION_SAMPLER_INPUT_ACCESSOR_WITHOUT_BOUNDS",
      // Values: triangles dropped, normals and tangents recomputed, colours clamped, weights normalised.
      "ACCESSOR_INVALID_FLOAT",
      "ACCESSOR_INVALID_SIGN",
      "ACCESSOR_VECTOR3_NON_UNIT",
      "ACCESSOR_NON_CLAMPED",
      "ACCESSOR_WEIGHTS_NEGATIVE",
      "ACCESSOR_WEIGHTS_NON_NORMALIZED",
      "ACCESSOR_JOINTS_INDEX_DUPLICATE",
      "ROTATION_NON_UNIT",
      "NODE_MATRIX_NON_TRS",
      "ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION",
      // Unambiguous all the same.
      "MESH_PRIMITIVE_ACCESSOR_UNALIGNED",
      "MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE",
      "BUFFER_VIEW_TARGET_OVERRIDE",
      "BUFFER_VIEW_INVALID_BYTE_STRIDE",
      "BUFFER_DATA_URI_MIME_TYPE_INVALID",
      "IMAGE_MIME_TYPE_INVALID",
      "EMPTY_ENTITY",
      // Unknown or unusable things, left out.
      "MESH_PRIMITIVE_INVALID_ATTRIBUTE",
      "MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY",
      "MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR",
      "MESH_PRIMITIVE_TOO_FEW_TEXCOORDS",
      "NODE_SKIN_WITH_NON_SKINNED_MESH",
      "NODE_SKIN_NO_SCENE",
      "SKIN_NO_COMMON_ROOT",
      "SKIN_SKELETON_INVALID",
      // Declarations of extensions.
      "DUPLICATE_ELEMENTS",
      "UNDECLARED_EXTENSION",
      "UNUSED_EXTENSION_REQUIRED",
      // An image that no material uses is not read: single files, not the whole code.
      "image/not_found.gltf IO_ERROR",
      "image/invalid_data_uri_mime_type.gltf INVALID_URI",
  };
  return kCodes;
}

/// The validator's reports are the oracle: what it calls valid must load; what it calls an error is refused,
/// or the error is on the list above.
TEST(GltfValidatorCorpus, AgreesWithTheKhronosValidator) {
  const fs::path folder = findAssets("malformed/gltf-validator");
  if (folder.empty()) GTEST_SKIP() << "CATOPTRIC_ASSETS is not set or has no malformed/gltf-validator";
  std::ifstream stream(folder / "expected-reports.json");
  const Json reports = Json::parse(stream);
  std::size_t files = 0, invalid = 0, accepted = 0;
  for (const auto& [name, report] : reports.items()) {
    if (!fs::exists(folder / name)) continue;
    ++files;
    const Result result = tryImport(folder / name);
    const bool isAccepted = result.outcome == Outcome::Loaded || result.outcome == Outcome::Repaired;
    std::set<std::string> errors;
    for (const Json& message : report["issues"]["messages"])
      if (message["severity"] == 0) errors.insert(message["code"].get<std::string>());
    invalid += errors.empty() ? 0 : 1;
    accepted += !errors.empty() && isAccepted ? 1 : 0;
    if (errors.empty()) {
      EXPECT_TRUE(isAccepted || result.outcome == Outcome::NeedsExtension) << name << ": " << result.detail;
    }
    if (!isAccepted) continue;
    for (const std::string& code : errors)
      EXPECT_TRUE(acceptedErrors().contains(code) ||
                  acceptedErrors().contains(fmt::format("{} {}", name, code)))
          << name << " was accepted in spite of " << code;
  }
  fmt::print("gltf validator corpus: {} files, {} with errors, {} of them accepted and repaired\n", files,
             invalid, accepted);
  EXPECT_GE(files, 140u);
}

}  // namespace
}  // namespace catoptric::scene::gltf_test

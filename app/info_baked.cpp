// SPDX-License-Identifier: Apache-2.0
// catoptric info FILE for a file of catoptric bake.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "catoptric/reflection_morphing/baked_file.h"
#include "commands.h"
#include "documents.h"
#include "terminal.h"

namespace catoptric::app {

bool isBakedFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string start(8, '\0');
  return file.read(start.data(), 8) && start == "CATOBAKE";
}

void describeBakedFile(const std::string& path, const std::string& jsonFile) {
  const reflection_morphing::BakedFile file(path);
  const reflection_morphing::BakePlan& plan = file.header().plan;
  const auto count = std::uint32_t(file.grid().locationCount());
  std::size_t largest = 0;
  for (std::uint32_t i = 0; i < count; ++i) largest = std::max(largest, file.locationBytes(i));
  const glm::uvec3 n = plan.grid.counts;
  const std::string fingerprint = fmt::format("{:016x}", file.header().fingerprint);
  const dvec3 low = plan.grid.box.lower, high = plan.grid.box.upper;
  if (!jsonFile.empty()) {
    Json document = makeDocument("info", nullptr);
    document["baked"] = {{"source", path},
                         {"format", file.header().version},
                         {"fingerprint", fingerprint},
                         {"lower", makeJson(low)},
                         {"upper", makeJson(high)},
                         {"counts", {n.x, n.y, n.z}},
                         {"rays", plan.options.map.size},
                         {"depth", plan.options.octree.depth},
                         {"bounces", plan.options.map.bounces},
                         {"keep_static", plan.options.map.keepStatic},
                         {"mapped_reflectors", file.header().mappedReflectors},
                         {"bytes", file.byteCount()},
                         {"largest_location_bytes", largest}};
    writeDocument(jsonFile, document);
  }
  if (jsonFile == "-") return;
  printData(
      fmt::format("{}  baked for reflection morphing, format {}, mirrors {}\n"
                  "  {}x{}x{} locations from ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g}) m\n"
                  "  {}^2 rays a map, octree depth {}, {} bounces{}; {} reflectors left to environment maps\n"
                  "  {:.1f} MB, a location at most {:.2f} MB\n",
                  path, file.header().version, fingerprint, n.x, n.y, n.z, low.x, low.y, low.z, high.x,
                  high.y, high.z, plan.options.map.size, plan.options.octree.depth, plan.options.map.bounces,
                  plan.options.map.keepStatic ? ", rays end at static objects" : "",
                  file.header().mappedReflectors, double(file.byteCount()) / 1e6, double(largest) / 1e6));
}

}  // namespace catoptric::app

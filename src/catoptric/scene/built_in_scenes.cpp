// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/built_in_scenes.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <string>

#include "catoptric/core/error.h"
#include "catoptric/scene/built_in/scenes.h"
#include "catoptric/scene/glb_writer.h"

namespace catoptric::scene {
namespace {

struct Row {
  BuiltInScene scene;
  Scene (*make)();
};

/// Adding a scene = one file in built_in/ and one row here.
constexpr std::array<Row, 22> kRows = {{
    {{"four-spheres", "four chrome spheres on a table in a furnished room (1998, figures 15 and 16)"},
     built_in::makeFourSpheres},
    {{"cylinder", "an upright chrome cylinder on a patterned floor (1998, figure 12)"},
     built_in::makeCylinder},
    {{"fender", "an open convex free-form patch without back faces, objects close to it (1999)"},
     built_in::makeFender},
    {{"polyhedra-and-sphere", "reflecting polyhedra with flat facets and a sphere (1998, figure 20)"},
     built_in::makePolyhedraAndSphere},
    {{"checker-box", "teapot over an inverted pyramid in a checker box, one flat mirror (Bastos, figure 6)"},
     built_in::makeCheckerBox},
    {{"hall-of-mirrors", "a hall between facing flat mirrors, for many bounces (1998, figure 18)"},
     built_in::makeHallOfMirrors},
    {{"drivers-view",
      "a car's flat inner mirror and two convex wing mirrors in traffic; also cameras left-mirror, "
      "right-mirror and inner-mirror"},
     built_in::makeDriversView},
    {{"concave-bowl",
      "a concave bowl, things near it enlarged, the room upside down (1998, figures 8 and 11)"},
     built_in::makeConcaveBowl},
    {{"mask", "a face of convex and concave pieces between two balls (1998, figure 19)"}, built_in::makeMask},
    {{"mixed", "a convex half and a concave half that join smoothly (1998, figure 9)"}, built_in::makeMixed},
    {{"tv", "a television screen, the extrusion of a convex curve (1998, figure 17)"}, built_in::makeTv},
    {{"cone", "a chrome cone on a table of rings and rays"}, built_in::makeCone},
    {{"dome", "an aspheric dome on a wall and a chrome barrel of two radii"}, built_in::makeDome},
    {{"vase", "a surface of revolution with a waist, where it is a saddle"}, built_in::makeVase},
    {{"wavy-wall", "a wall of wavy chrome as at a fair, crests and troughs"}, built_in::makeWavyWall},
    {{"lenses", "a glass ball, a free-form lens and a block of green glass: refraction"},
     built_in::makeLenses},
    {{"columns", "columns around a chrome sphere and a cube close to it (2004, figure 1)"},
     built_in::makeColumns},
    {{"teapot", "a chrome teapot: body morphed, spout, handle and lid environment-mapped (2004, figure 8)"},
     built_in::makeTeapotScene},
    {{"facing-mirrors",
      "two curved mirrors that face each other, a block moves between them (2004, section 9)"},
     built_in::makeFacingMirrors},
    {{"furnished-room", "about 190,000 polygons and two large flat mirrors (Bastos, figure 7)"},
     built_in::makeFurnishedRoom},
    {{"reflector-sweep", "balls of 32, 128, 512 and 2048 triangles (1998, figure 13)"},
     built_in::makeReflectorSweep},
    {{"object-sweep",
      "boards of 1, 9, 49 and 225 cells before balls of 512 triangles (1998, figure 14; with --max-error "
      "100)"},
     built_in::makeObjectSweep},
}};

/// Levenshtein distance.
std::size_t countEdits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

std::string hintFor(std::string_view name) {
  const auto nearest = std::min_element(kRows.begin(), kRows.end(), [&](const Row& a, const Row& b) {
    return countEdits(name, a.scene.name) < countEdits(name, b.scene.name);
  });
  if (countEdits(name, nearest->scene.name) <= nearest->scene.name.size() / 2)
    return "did you mean \"" + std::string(nearest->scene.name) + "\"?";
  std::string all = "there are:";
  for (const Row& row : kRows) all += " " + std::string(row.scene.name);
  return all;
}

}  // namespace

std::span<const BuiltInScene> builtInScenes() {
  static const std::vector<BuiltInScene> scenes = [] {
    std::vector<BuiltInScene> list;
    list.reserve(kRows.size());
    for (const Row& row : kRows) list.push_back(row.scene);
    return list;
  }();
  return scenes;
}

std::vector<std::byte> makeBuiltInScene(std::string_view name) {
  const auto row =
      std::find_if(kRows.begin(), kRows.end(), [&](const Row& r) { return r.scene.name == name; });
  if (row == kRows.end())
    throw core::Error("scene.unknown", "no built-in scene is called \"" + std::string(name) + "\"", {},
                      hintFor(name));
  GlbOptions options;
  options.jpegFromPixels = 256 * 256;
  return makeGlb(row->make(), options);
}

}  // namespace catoptric::scene

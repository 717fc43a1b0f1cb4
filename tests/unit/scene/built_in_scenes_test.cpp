// SPDX-License-Identifier: Apache-2.0
// The scenes we ship are what they say: valid, modest in size, with the reflectors their figures need.
#include "catoptric/scene/built_in_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "catoptric/core/error.h"
#include "catoptric/geometry/mesh_inspection.h"
#include "catoptric/scene/gltf_import.h"
#include "catoptric/scene/world_geometry.h"
#include "catoptric/scene/world_motion.h"

namespace catoptric::scene {
namespace {

struct Made {
  std::vector<std::byte> bytes;
  Scene scene;
  WorldGeometry geometry;
};

Made make(const std::string& name) {
  Made m;
  m.bytes = makeBuiltInScene(name);
  m.scene = importGltf(m.bytes, {}, name + ".glb");
  m.geometry = makeWorldGeometry(m.scene);
  return m;
}

/// The triangles of a reflector, cut out of the world.
geometry::Mesh meshOf(const WorldGeometry& world, const Reflector& reflector) {
  const Part& part = world.parts[reflector.part];
  geometry::Mesh mesh;
  mesh.positions.assign(world.positions.begin() + part.firstVertex,
                        world.positions.begin() + part.firstVertex + part.vertexCount);
  mesh.normals.assign(world.normals.begin() + part.firstVertex,
                      world.normals.begin() + part.firstVertex + part.vertexCount);
  for (std::uint32_t i = 0; i < part.indexCount; ++i)
    mesh.indices.push_back(world.indices[part.firstIndex + i] - part.firstVertex);
  return mesh;
}

std::map<ReflectorShape, int> countShapes(const WorldGeometry& world) {
  std::map<ReflectorShape, int> count;
  for (const Reflector& r : world.reflectors) ++count[r.shape];
  return count;
}

void checkImportsWithoutAWarningAndStaysSmall(const Made& m, std::size_t mostTriangles) {
  EXPECT_TRUE(m.scene.warnings.empty()) << m.scene.warnings.front();
  EXPECT_EQ(m.geometry.droppedTriangles, 0u);
  EXPECT_GT(m.geometry.triangleCount(), 1000u);
  EXPECT_LE(m.geometry.triangleCount(), mostTriangles);
  EXPECT_LE(m.bytes.size(), 3u << 20);
  ASSERT_FALSE(m.scene.cameras.empty());
  EXPECT_FALSE(m.scene.lights.empty());
  EXPECT_FALSE(m.geometry.reflectors.empty());
}

void checkNormalsAreUnitAndOnTheFrontOfTheirTriangles(const Made& m) {
  const WorldGeometry& world = m.geometry;
  std::size_t turnedAway = 0;
  for (std::size_t t = 0; t < world.triangleCount(); ++t) {
    dvec3 p[3];
    for (int k = 0; k < 3; ++k) p[k] = world.positions[world.indices[3 * t + k]];
    const dvec3 face = glm::cross(p[1] - p[0], p[2] - p[0]);
    for (int k = 0; k < 3; ++k) {
      const dvec3 n = world.normals[world.indices[3 * t + k]];
      ASSERT_NEAR(glm::length(n), 1, 1e-4);
      if (glm::dot(n, face) < 0) ++turnedAway;
    }
  }
  EXPECT_EQ(turnedAway, 0u);
}

void checkReflectorsAreSmoothAndFine(const Made& m, bool areConvex, bool areFine) {
  const WorldGeometry& world = m.geometry;
  for (const Reflector& r : world.reflectors) {
    SCOPED_TRACE(r.name);
    if (r.isRefractor()) {  // with edges, and closed without its normals
      EXPECT_TRUE(geometry::inspectEdges(geometry::welded(meshOf(world, r), 2e-6, 4)).isWatertight());
      continue;
    }
    // What environment maps draw need not be fine.
    if (r.morphed == false) continue;
    EXPECT_EQ(r.isConvex, areConvex);
    EXPECT_FALSE(r.doubleSided);
    const geometry::Mesh mesh = meshOf(world, r);
    EXPECT_EQ(geometry::findDeepestConcavity(mesh) < 1e-3, areConvex);
    // Between the normals at a triangle's corners and its plane lie at most half of 4 degrees.
    if (areFine) {
      EXPECT_LT(geometry::findLargestNormalDeviation(mesh), glm::radians(2.0));
    }
    const geometry::EdgeReport edges = geometry::inspectEdges(mesh);
    EXPECT_EQ(edges.nonManifold + edges.inconsistent, 0u);
    EXPECT_EQ(edges.isWatertight(), r.shape == ReflectorShape::Sphere && areConvex);
  }
}

void checkSmoothMirrorsShareTheirVertices(const Made& m) {
  const WorldGeometry& world = m.geometry;
  for (const Reflector& r : world.reflectors) {
    if (r.shape == ReflectorShape::Plane || r.isRefractor()) continue;
    const geometry::Mesh mesh = meshOf(world, r);
    EXPECT_EQ(geometry::welded(mesh, 1e-7, 1e-3).positions.size(), mesh.positions.size()) << r.name;
  }
}

void checkRoomsAndRoadsAreShellAndMirrorsAreNot(const Made& m) {
  std::size_t shells = 0;
  for (const Instance& instance : m.scene.instances) shells += instance.hint.shell.value_or(false) ? 1 : 0;
  EXPECT_GE(shells, 2u);
  EXPECT_LT(shells, m.scene.instances.size());
  for (const Reflector& r : m.geometry.reflectors) EXPECT_FALSE(m.geometry.parts[r.part].shell) << r.name;
}

void checkNothingReachesIntoAMirrorsBackOrIsCoplanarWithIt(const Made& m) {
  // A flat mirror hangs a little in front of its wall: no vertex of another object lies in its plane within
  // its bounds.
  const WorldGeometry& world = m.geometry;
  for (const Reflector& r : world.reflectors) {
    if (r.shape != ReflectorShape::Plane) continue;
    for (const Part& part : world.parts) {
      if (part.object == r.object) continue;
      for (std::uint32_t i = 0; i < part.indexCount; i += 3) {
        dvec3 middle(0);
        bool isInPlane = true;
        for (std::uint32_t k = 0; k < 3; ++k) {
          const dvec3 p = world.positions[world.indices[part.firstIndex + i + k]];
          middle += p / 3.0;
          isInPlane = isInPlane && std::abs(r.plane.signedDistance(p)) < 5e-4;
        }
        ASSERT_FALSE(isInPlane && glm::distance(middle, r.centre) < r.radius) << r.name;
      }
    }
  }
}

void checkEveryCameraSeesAMirrorsFront(const Made& m) {
  for (const Camera& camera : m.scene.cameras) {
    const dvec3 forward = glm::normalize(camera.target - camera.eye);
    bool seesMirror = false;
    for (const Reflector& r : m.geometry.reflectors) {
      const dvec3 toMirror = glm::normalize(r.centre - camera.eye);
      const bool isFront = r.shape != ReflectorShape::Plane || r.plane.signedDistance(camera.eye) > 0;
      seesMirror =
          seesMirror || (isFront && glm::dot(forward, toMirror) > std::cos(0.5 * camera.fovYRadians));
    }
    EXPECT_TRUE(seesMirror) << camera.name;
  }
}

/// A corner of a flat mirror's front, or more of it.
bool seesPartOfAMirror(const WorldGeometry& world, const Camera& camera) {
  const dvec3 forward = glm::normalize(camera.target - camera.eye);
  for (const Reflector& r : world.reflectors)
    for (const vec3& p : meshOf(world, r).positions)
      if (r.plane.signedDistance(camera.eye) > 0 &&
          glm::dot(forward, glm::normalize(dvec3(p) - camera.eye)) > std::cos(0.5 * camera.fovYRadians))
        return true;
  return false;
}

/// The camera "walk" sees a mirror's front at each moment, and nothing else moves.
void checkWalk(Made m) {
  ASSERT_EQ(m.scene.motion.animations.size(), 1u);
  const ReflectorOptions options;
  WorldMotion motion(m.scene, m.geometry, options);
  EXPECT_TRUE(motion.movesOnlyCameras());
  dvec3 last = m.scene.cameras.back().eye;
  ASSERT_EQ(m.scene.cameras.back().name, "walk");
  double way = 0;
  for (int i = 0; i <= 40; ++i) {
    motion.setTime(m.scene.motion.animations[0].durationS * i / 40);
    const dvec3 eye = m.scene.cameras.back().eye;
    EXPECT_LT(glm::distance(eye, last), 0.6);
    way += glm::distance(eye, last);
    last = eye;
    EXPECT_TRUE(seesPartOfAMirror(m.geometry, m.scene.cameras.back())) << i;
  }
  EXPECT_GT(way, 3.0);
}

void checkMirrorsFaceEachOther(const Made& m) {
  const auto& reflectors = m.geometry.reflectors;
  ASSERT_EQ(reflectors.size(), 2u);
  EXPECT_NEAR(glm::dot(reflectors[0].plane.normal, reflectors[1].plane.normal), -1, 1e-6);
  EXPECT_GT(reflectors[0].plane.signedDistance(reflectors[1].centre), 3);
}

void checkIsOpen(const Made& m) {
  const WorldGeometry& world = m.geometry;
  EXPECT_GT(geometry::inspectEdges(meshOf(world, world.reflectors[0])).boundary, 100u);
}

using ShapeCount = std::map<ReflectorShape, int>;

struct Expected {
  const char* name;
  ShapeCount reflectors;
  bool areConvex = true;
  std::size_t mostTriangles = 60000;
  bool areFine = true;
};

// NOLINTNEXTLINE(readability-identifier-naming): GoogleTest asks for this name.
void PrintTo(const Expected& expected, std::ostream* out) {
  *out << expected.name;
}

/// One test a scene: making it is most of the time.
class ShippedScene : public testing::TestWithParam<Expected> {};

TEST_P(ShippedScene, IsWhatItSays) {
  const Made m = make(GetParam().name);
  checkImportsWithoutAWarningAndStaysSmall(m, GetParam().mostTriangles);
  checkNormalsAreUnitAndOnTheFrontOfTheirTriangles(m);
  checkReflectorsAreSmoothAndFine(m, GetParam().areConvex, GetParam().areFine);
  checkSmoothMirrorsShareTheirVertices(m);
  checkRoomsAndRoadsAreShellAndMirrorsAreNot(m);
  checkNothingReachesIntoAMirrorsBackOrIsCoplanarWithIt(m);
  checkEveryCameraSeesAMirrorsFront(m);
  EXPECT_EQ(countShapes(m.geometry), GetParam().reflectors);
  if (GetParam().name == std::string("hall-of-mirrors")) checkMirrorsFaceEachOther(m);
  if (GetParam().name == std::string("fender")) checkIsOpen(m);
}

const Expected kExpected[] = {
    {"four-spheres", {{ReflectorShape::Sphere, 4}}},
    {"cylinder", {{ReflectorShape::Cylinder, 1}}},
    {"fender", {{ReflectorShape::Mesh, 1}}},
    {"polyhedra-and-sphere", {{ReflectorShape::Plane, 12 + 8 + 6}, {ReflectorShape::Sphere, 1}}},
    {"checker-box", {{ReflectorShape::Plane, 1}}},
    {"hall-of-mirrors", {{ReflectorShape::Plane, 2}}},
    {"drivers-view", {{ReflectorShape::Plane, 1}, {ReflectorShape::Mesh, 2}}},
    {"concave-bowl", {{ReflectorShape::Sphere, 1}}, false},
    {"mask", {{ReflectorShape::Mesh, 1}}, false},
    {"mixed", {{ReflectorShape::Mesh, 1}}, false},
    {"tv", {{ReflectorShape::Extrusion, 1}}},
    {"cone", {{ReflectorShape::Cone, 1}}},
    {"dome", {{ReflectorShape::Aspheric, 1}, {ReflectorShape::Torus, 1}}},
    {"vase", {{ReflectorShape::Mesh, 1}}, false},
    {"wavy-wall", {{ReflectorShape::Extrusion, 1}}, false},
    {"lenses", {{ReflectorShape::Sphere, 1}, {ReflectorShape::Mesh, 2}}, false},
    {"columns", {{ReflectorShape::Sphere, 1}}},
    {"teapot", {{ReflectorShape::Mesh, 6}}},
    {"facing-mirrors", {{ReflectorShape::Quadric, 2}}},
    {"furnished-room", {{ReflectorShape::Plane, 2}}, true, 195000},  // 189,982 in the paper
    {"reflector-sweep", {{ReflectorShape::Sphere, 4}}, true, 60000, false},
    {"object-sweep", {{ReflectorShape::Sphere, 4}}, true, 60000, false},
};

INSTANTIATE_TEST_SUITE_P(All, ShippedScene, testing::ValuesIn(kExpected), [](const auto& param) {
  std::string name = param.param.name;
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
});

TEST(BuiltInScenes, AllAreTested) {
  ASSERT_EQ(builtInScenes().size(), std::size(kExpected));
  for (std::size_t i = 0; i < std::size(kExpected); ++i)
    EXPECT_EQ(builtInScenes()[i].name, kExpected[i].name);
}

TEST(BuiltInScenes, BytesAreTheSameOnEveryRun) {
  EXPECT_EQ(makeBuiltInScene("drivers-view"), makeBuiltInScene("drivers-view"));
}

TEST(BuiltInScenes, WalksStayWhereMirrorsAreSeen) {
  for (const char* name : {"checker-box", "furnished-room"}) {
    SCOPED_TRACE(name);
    checkWalk(make(name));
  }
}

TEST(BuiltInScenes, UnknownNameIsRefusedWithAHint) {
  try {
    (void)makeBuiltInScene("four-sphere");
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_EQ(error.code(), "scene.unknown");
    EXPECT_EQ(error.hint(), "did you mean \"four-spheres\"?");
  }
  try {
    (void)makeBuiltInScene("xyzzy");
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_NE(error.hint().find("cylinder"), std::string::npos);
  }
}

}  // namespace
}  // namespace catoptric::scene

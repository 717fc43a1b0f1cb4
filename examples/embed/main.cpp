// SPDX-License-Identifier: Apache-2.0
// Embeds catoptric: meshes that the host has in memory, one picture back. Made here: a checkered floor, a
// chrome ball, three coloured boxes close to it.
//
//   catoptric_embed OUT.png
//
// 1 fill a scene::Scene; 2 flatten it, which also finds its mirrors; 3 make a Renderer; 4 render; 5 tone-map
// and write.
#include <cmath>
#include <cstdio>

#include "catoptric/core/error.h"
#include "catoptric/core/file.h"
#include "catoptric/core/image_io.h"
#include "catoptric/core/tone_map.h"
#include "catoptric/renderer/frame.h"
#include "catoptric/scene/environment.h"
#include "catoptric/scene/scene.h"
#include "catoptric/scene/world_geometry.h"

namespace {

using namespace catoptric;
using scene::Material;
using scene::MeshPrimitive;

/// The quadrilateral a b c d, counter-clockwise seen from its front.
void addQuad(MeshPrimitive& mesh, const vec3& a, const vec3& b, const vec3& c, const vec3& d) {
  const auto first = std::uint32_t(mesh.positions.size());
  const vec3 normal = glm::normalize(glm::cross(b - a, d - a));
  for (const vec3& corner : {a, b, c, d}) {
    mesh.positions.push_back(corner);
    mesh.normals.push_back(normal);
    mesh.colors.emplace_back(1.0f);
  }
  for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + corner);
}

MeshPrimitive makeCheckerFloor(float halfEdge, int cells) {
  MeshPrimitive floor;
  const float step = 2 * halfEdge / float(cells);
  for (int row = 0; row < cells; ++row)
    for (int column = 0; column < cells; ++column) {
      const vec3 a(-halfEdge + step * float(column), 0, -halfEdge + step * float(row));
      addQuad(floor, a, a + vec3(0, 0, step), a + vec3(step, 0, step), a + vec3(step, 0, 0));
      if ((row + column) % 2)
        for (int corner = 1; corner <= 4; ++corner)
          floor.colors[floor.colors.size() - corner] = vec4(0.1f, 0.1f, 0.12f, 1);
    }
  return floor;
}

MeshPrimitive makeBox(const vec3& centre, const vec3& halfSize) {
  MeshPrimitive box;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      vec3 out(0), u(0), v(0);
      out[axis] = side * halfSize[axis];
      u[(axis + 1) % 3] = side * halfSize[(axis + 1) % 3];
      v[(axis + 2) % 3] = halfSize[(axis + 2) % 3];
      addQuad(box, centre + out - u - v, centre + out + u - v, centre + out + u + v, centre + out - u + v);
    }
  return box;
}

/// A ball with exact normals; what makes it a mirror is its material.
MeshPrimitive makeBall(const vec3& centre, float radius, int rings) {
  MeshPrimitive ball;
  const int segments = 2 * rings;
  for (int ring = 0; ring <= rings; ++ring)
    for (int segment = 0; segment <= segments; ++segment) {
      const float polar = glm::pi<float>() * float(ring) / float(rings);
      const float azimuth = glm::two_pi<float>() * float(segment) / float(segments);
      const vec3 normal(std::sin(polar) * std::sin(azimuth), std::cos(polar),
                        std::sin(polar) * std::cos(azimuth));
      ball.positions.push_back(centre + radius * normal);
      ball.normals.push_back(normal);
    }
  for (int ring = 0; ring < rings; ++ring)
    for (int segment = 0; segment < segments; ++segment) {
      const auto a = std::uint32_t(ring * (segments + 1) + segment);
      const auto below = std::uint32_t(a + segments + 1);
      for (const std::uint32_t index : {a, below, below + 1, a, below + 1, a + 1})
        ball.indices.push_back(index);
    }
  return ball;
}

void addObject(scene::Scene& scene, const char* name, MeshPrimitive primitive, const vec3& color,
               float metallic, float roughness) {
  Material material;
  material.name = name;
  material.baseColor = vec4(color, 1);
  material.metallic = metallic;
  material.roughness = roughness;
  primitive.material = int(scene.materials.size());
  scene.materials.push_back(material);
  scene::Instance instance;
  instance.name = name;
  instance.mesh = int(scene.meshes.size());
  scene.meshes.push_back({name, {std::move(primitive)}});
  scene.instances.push_back(instance);
}

scene::Scene makeScene() {
  scene::Scene scene;
  addObject(scene, "floor", makeCheckerFloor(4, 16), vec3(0.9f), 0, 0.9f);
  addObject(scene, "red box", makeBox({1.6f, 0.4f, 0.7f}, {0.25f, 0.4f, 0.25f}), {0.8f, 0.1f, 0.1f}, 0, 0.6f);
  addObject(scene, "green box", makeBox({-1.5f, 0.3f, 1.0f}, {0.3f, 0.3f, 0.2f}), {0.1f, 0.6f, 0.2f}, 0,
            0.6f);
  addObject(scene, "blue box", makeBox({0.3f, 0.2f, 1.8f}, {0.4f, 0.2f, 0.2f}), {0.1f, 0.2f, 0.8f}, 0, 0.6f);
  addObject(scene, "chrome ball", makeBall({0, 1, 0}, 1, 96), vec3(0.95f), 1, 0);
  scene::Light sun;
  sun.type = scene::LightType::Directional;
  sun.color = vec3(2.5f);
  sun.direction = glm::normalize(vec3(-0.4f, -1, -0.5f));
  scene.lights.push_back(sun);
  return scene;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: catoptric_embed OUT.png\n");
    return 2;
  }
  try {
    const scene::Scene scene = makeScene();
    const scene::WorldGeometry geometry = scene::makeWorldGeometry(scene);
    const scene::Environment sky = scene::makeSkyEnvironment();

    renderer::Renderer renderer(scene, geometry, sky);
    scene::Camera camera;
    camera.eye = {0.5, 2.2, 5.5};
    camera.target = {0, 0.8, 0};
    camera.fovYRadians = 0.7;
    renderer::FrameOptions options;
    options.widthPx = 480;
    options.heightPx = 360;
    const renderer::Frame frame = renderer.render(camera, options);

    core::writeFileAtomically(argv[1], core::encodePng(core::toneMap(frame.radiance)));
    std::printf("%s: %zu mirrors, %zu virtual vertices, %.1f ms\n", argv[1], geometry.reflectors.size(),
                std::size_t(frame.counters.virtualVertices), frame.timings.totalMs);
  } catch (const core::Error& error) {
    std::fprintf(stderr, "catoptric_embed: %s\n", error.what());
    return 1;
  }
}

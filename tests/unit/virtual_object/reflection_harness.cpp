// SPDX-License-Identifier: Apache-2.0
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("O2")  // tests are compiled with little optimisation; this one traces a million rays
#endif
#include "reflection_harness.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

#include "catoptric/core/parallel.h"
#include "catoptric/virtual_object/item_rasterizer.h"
#include "catoptric/virtual_object/make_point_finder.h"

namespace catoptric::virtual_object::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kLost = 24.0f;

struct MirrorPixel {
  std::uint32_t triangle = core::kNoId;  // of the mirror's part
  double distance = kInfinity;
  dvec3 position, ray;  // ray: reflected, unit
};

struct Seen {
  dvec3 point{0};
  std::uint32_t triangle = core::kNoId;  // world triangle; kNoId = sky
  std::uint32_t part = core::kNoId;
  double distance = kInfinity;
  bool shell = true;
};

dvec3 corner(const scene::WorldGeometry& g, std::size_t triangle, int k) {
  return dvec3(g.positions[g.indices[3 * triangle + k]]);
}

/// Pixel position and depth along `forward`.
dvec3 project(const scene::CameraFrame& camera, const dvec3& p) {
  const dvec3 d = p - camera.eye;
  const double depth = glm::dot(d, camera.forward);
  const double scale = camera.heightPx / (2.0 * camera.tanHalfFovY * depth);
  return {0.5 * camera.widthPx + glm::dot(d, camera.right) * scale,
          0.5 * camera.heightPx - glm::dot(d, camera.up) * scale, depth};
}

core::Image<MirrorPixel> drawMirror(const scene::WorldGeometry& g, const scene::CameraFrame& camera) {
  core::Image<MirrorPixel> image(camera.widthPx, camera.heightPx);
  const scene::Part& part = g.parts[0];
  for (std::uint32_t t = part.firstIndex / 3; t < (part.firstIndex + part.indexCount) / 3; ++t) {
    const std::array<dvec3, 3> p{corner(g, t, 0), corner(g, t, 1), corner(g, t, 2)};
    const dvec3 facet = glm::cross(p[1] - p[0], p[2] - p[0]);
    if (glm::dot(facet, camera.eye - p[0]) <= 0) continue;
    std::array<dvec2, 3> px;
    bool isBehind = false;
    for (int k = 0; k < 3; ++k) {
      const dvec3 s = project(camera, p[k]);
      px[k] = dvec2(s);
      isBehind |= s.z <= 0;
    }
    if (isBehind) continue;
    rasterizeTriangle(px, camera.widthPx, camera.heightPx, [&](int x, int y, const dvec3&) {
      const dvec3 direction = glm::normalize(camera.rayDirection(x + 0.5, y + 0.5));
      const double distance = glm::dot(facet, p[0] - camera.eye) / glm::dot(facet, direction);
      MirrorPixel& pixel = image.at(x, y);
      if (distance >= pixel.distance) return;
      pixel.distance = distance;
      pixel.triangle = t;
      pixel.position = camera.eye + distance * direction;
      const double area = glm::dot(facet, facet);
      const double b1 = glm::dot(glm::cross(pixel.position - p[0], p[2] - p[0]), facet) / area;
      const double b2 = glm::dot(glm::cross(p[1] - p[0], pixel.position - p[0]), facet) / area;
      const auto normal = [&](int k) { return dvec3(g.normals[g.indices[3 * t + k]]); };
      const dvec3 n = glm::normalize(normal(0) * (1 - b1 - b2) + normal(1) * b1 + normal(2) * b2);
      pixel.ray = core::reflectDirection(direction, n);
    });
  }
  return image;
}

Seen traceRay(const scene::WorldGeometry& g, const dvec3& origin, const dvec3& direction) {
  Seen best;
  for (std::uint32_t t = 0; t < g.indices.size() / 3; ++t) {
    if (g.parts[g.triangleParts[t]].reflector == 0) continue;
    const dvec3 a = corner(g, t, 0), e1 = corner(g, t, 1) - a, e2 = corner(g, t, 2) - a;
    const dvec3 p = glm::cross(direction, e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0) continue;
    const dvec3 s = origin - a;
    const double u = glm::dot(s, p) / determinant;
    if (u < 0 || u > 1) continue;
    const dvec3 q = glm::cross(s, e1);
    const double v = glm::dot(direction, q) / determinant;
    if (v < 0 || u + v > 1) continue;
    const double distance = glm::dot(e2, q) / determinant;
    if (distance <= 1e-7 || distance >= best.distance) continue;
    best.distance = distance;
    best.triangle = t;
    best.part = g.triangleParts[t];
    best.shell = g.parts[best.part].shell;
  }
  best.point = best.triangle == core::kNoId ? direction : origin + best.distance * direction;
  return best;
}

core::Image<Seen> drawTruth(const scene::WorldGeometry& g, const core::Image<MirrorPixel>& mirror) {
  core::Image<Seen> image(mirror.width(), mirror.height());
  core::parallelFor(mirror.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (const MirrorPixel& m = mirror.pixels()[i]; m.triangle != core::kNoId)
        image.pixels()[i] = traceRay(g, m.position, m.ray);
  });
  return image;
}

core::Image<Seen> drawVirtual(const scene::WorldGeometry& g, const scene::CameraFrame& camera,
                              const core::Image<MirrorPixel>& mirror, const TessellatedObjects& objects,
                              std::span<const vec3> virtualPositions, const VirtualTriangles& triangles) {
  core::Image<Seen> image(mirror.width(), mirror.height());
  for (std::size_t i = 0; i < image.size(); ++i) image.pixels()[i].point = mirror.pixels()[i].ray;
  for (const TessellatedPart& run : triangles.parts)
    for (std::uint32_t i = run.firstIndex; i < run.firstIndex + run.indexCount; i += 3) {
      std::array<dvec2, 3> px;
      dvec3 inverseDepth;
      std::array<std::uint32_t, 3> v;
      bool isBehind = false;
      for (int k = 0; k < 3; ++k) {
        v[k] = triangles.indices[i + k];
        const dvec3 s = project(camera, dvec3(virtualPositions[v[k]]));
        px[k] = dvec2(s);
        inverseDepth[k] = 1.0 / s.z;
        isBehind |= s.z <= 1e-3;
      }
      if (isBehind) continue;
      rasterizeTriangle(px, image.width(), image.height(), [&](int x, int y, const dvec3& w) {
        const MirrorPixel& m = mirror.at(x, y);
        if (m.triangle == core::kNoId) return;
        dvec3 b = w * inverseDepth;
        b /= b.x + b.y + b.z;
        const auto blend = [&](auto& values) {
          return dvec3(values[v[0]]) * b.x + dvec3(values[v[1]]) * b.y + dvec3(values[v[2]]) * b.z;
        };
        const double path = glm::length(blend(virtualPositions) - camera.eye);
        Seen& pixel = image.at(x, y);
        if (path < m.distance * 0.99999 || path - m.distance >= pixel.distance) return;
        pixel.distance = path - m.distance;
        pixel.point = blend(objects.positions);
        pixel.part = run.part;
        pixel.triangle = 0;
        pixel.shell = g.parts[run.part].shell;
      });
    }
  return image;
}

/// Change of the seen point per pixel, from a neighbour that shows the same part.
bool findDifference(const core::Image<Seen>& truth, int x, int y, int dx, int dy, dvec3& difference) {
  double best = kInfinity;
  for (const int sign : {1, -1}) {
    const int nx = x + sign * dx, ny = y + sign * dy;
    if (nx < 0 || ny < 0 || nx >= truth.width() || ny >= truth.height()) continue;
    if (truth.at(nx, ny).part != truth.at(x, y).part) continue;
    const dvec3 d = (truth.at(nx, ny).point - truth.at(x, y).point) * double(sign);
    if (glm::dot(d, d) < best) best = glm::dot(d, d), difference = d;
  }
  return best < kInfinity;
}

/// Distance in pixels from (x, y) to where the truth shows the point that the method shows at (x, y).
float findDisplacement(const core::Image<Seen>& truth, const core::Image<MirrorPixel>& mirror, int x, int y,
                       const Seen& method) {
  float best = kLost;
  for (int r = 0; r <= int(kLost) && float(r) - 1.0f < best; ++r)
    for (int dy = -r; dy <= r; ++dy)
      for (int dx = -r; dx <= r; dx += (std::abs(dy) == r ? 1 : std::max(2 * r, 1))) {
        const int tx = x + dx, ty = y + dy;
        if (tx < 0 || ty < 0 || tx >= truth.width() || ty >= truth.height()) continue;
        if (mirror.at(tx, ty).triangle == core::kNoId || truth.at(tx, ty).part != method.part) continue;
        dvec3 px(0), py(0);
        if (!findDifference(truth, tx, ty, 1, 0, px) || !findDifference(truth, tx, ty, 0, 1, py)) continue;
        const dvec3 d = method.point - truth.at(tx, ty).point;
        const double xx = glm::dot(px, px), xy = glm::dot(px, py), yy = glm::dot(py, py);
        const double determinant = xx * yy - xy * xy;
        if (!(determinant > 1e-12 * xx * yy)) continue;
        const double a = glm::dot(px, d), b = glm::dot(py, d);
        const double sx = (yy * a - xy * b) / determinant, sy = (xx * b - xy * a) / determinant;
        if (std::abs(sx) > 0.75 || std::abs(sy) > 0.75) continue;
        const dvec3 rest = d - sx * px - sy * py;
        if (glm::dot(rest, rest) > 0.25 * std::max(xx, yy)) continue;
        best = std::min(best, float(std::hypot(dx + sx, dy + sy)));
      }
  return best;
}

ErrorStatistics summarize(std::vector<float> errors) {
  ErrorStatistics s;
  s.pixels = errors.size();
  if (errors.empty()) return s;
  std::sort(errors.begin(), errors.end());
  s.medianPx = errors[errors.size() / 2];
  s.p95Px = errors[errors.size() * 95 / 100];
  const auto share = [&](auto from, auto to) { return double(to - from) / double(errors.size()); };
  s.within1 = share(errors.begin(), std::upper_bound(errors.begin(), errors.end(), 1.0f));
  s.lost = share(std::lower_bound(errors.begin(), errors.end(), kLost), errors.end());
  return s;
}

void writePicture(const std::string& name, int width, int height, const auto& colourOf) {
  const char* directory = std::getenv("CATOPTRIC_TEST_PICTURES");
  if (directory == nullptr) return;
  std::ofstream file(std::string(directory) + "/" + name + ".ppm", std::ios::binary);
  file << "P6\n" << width << " " << height << "\n255\n";
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::u8vec3 c = colourOf(x, y);
      file.write(reinterpret_cast<const char*>(&c), 3);
    }
}

glm::u8vec3 chequer(const Seen& s) {
  if (s.triangle == core::kNoId) return {150, 180, 220};
  const dvec3 c = glm::floor(s.point * 4.0 + 1e-4);
  const int odd = int(std::fmod(std::abs(c.x + c.y + c.z), 2.0));
  const int hue = int(s.part * 83 % 7);
  return glm::u8vec3(60 + hue * 25, 60 + (hue * 40) % 150, 60 + (hue * 70) % 150) + glm::u8vec3(45 * odd);
}

}  // namespace

TestWorld::TestWorld(const geometry::Mesh& mirror, scene::ReflectorShape shape) {
  scene::Reflector reflector;
  reflector.name = "mirror";
  reflector.shape = shape;
  core::Box box;
  for (const vec3& p : mirror.positions) box.add(dvec3(p));
  reflector.centre = box.centre();
  reflector.radius = box.radius();
  geometry_.reflectors.push_back(reflector);
  append(mirror, false, 0);
}

void TestWorld::add(const geometry::Mesh& mesh, bool shell) {
  append(mesh, shell, core::kNoId);
}

std::uint32_t TestWorld::append(const geometry::Mesh& mesh, bool shell, std::uint32_t reflector) {
  scene::WorldGeometry& g = geometry_;
  scene::Part part;
  part.firstIndex = std::uint32_t(g.indices.size());
  part.indexCount = std::uint32_t(mesh.indices.size());
  part.firstVertex = std::uint32_t(g.positions.size());
  part.vertexCount = std::uint32_t(mesh.positions.size());
  part.object = std::uint32_t(g.parts.size());
  part.reflector = reflector;
  part.shell = shell;
  for (const std::uint32_t i : mesh.indices) g.indices.push_back(part.firstVertex + i);
  g.positions.insert(g.positions.end(), mesh.positions.begin(), mesh.positions.end());
  g.normals.insert(g.normals.end(), mesh.normals.begin(), mesh.normals.end());
  g.uv0.resize(g.positions.size(), vec2(0));
  if (!mesh.uv.empty()) std::copy(mesh.uv.begin(), mesh.uv.end(), g.uv0.begin() + part.firstVertex);
  g.uv1.resize(g.positions.size(), vec2(0));
  g.tangents.resize(g.positions.size(), vec4(0));
  g.colors.resize(g.positions.size(), vec4(1));
  g.triangleParts.resize(g.indices.size() / 3, std::uint32_t(g.parts.size()));
  for (const vec3& p : mesh.positions) g.bounds.add(dvec3(p));
  g.parts.push_back(part);
  return std::uint32_t(g.parts.size() - 1);
}

double TestWorld::farRadius(const dvec3& centre) const {
  double radius = 0;
  for (const vec3& p : geometry_.positions) radius = std::max(radius, glm::length(dvec3(p) - centre));
  return radius;
}

HarnessResult measureReflection(const TestWorld& world, const scene::CameraFrame& camera, Solver solver,
                                const TessellationOptions& tessellation, const std::string& name,
                                const scene::WorldGeometry* solvedGeometry) {
  const scene::WorldGeometry& g = world.geometry();
  const ReflectorMesh mesh(solvedGeometry ? *solvedGeometry : g, 0);
  VirtualObjectSolver maps(mesh, camera.eye, world.farRadius(mesh.centre()));
  maps.useFinder(makePointFinder(solver, solvedGeometry ? *solvedGeometry : g, 0, false, mesh));
  const TessellatedObjects objects = tessellateForReflector(g, 0, tessellation);
  std::vector<vec3> virtualPositions(objects.positions.size()), points(objects.positions.size());
  std::vector<VertexKind> kinds(objects.positions.size());
  const auto start = std::chrono::steady_clock::now();
  maps.compute(solver, objects.positions, virtualPositions, kinds, points);
  HarnessResult result;
  result.solveSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  VirtualTriangles triangles;
  selectVirtualTriangles(objects, camera.eye, virtualPositions, kinds, points, triangles);
  result.triangles = objects.indices.size() / 3;
  result.vertices = objects.positions.size();
  result.drawn = triangles.indices.size() / 3;

  const auto mirror = drawMirror(g, camera);
  const auto truth = drawTruth(g, mirror);
  const auto method = drawVirtual(g, camera, mirror, objects, virtualPositions, triangles);
  core::Image<float> errors(camera.widthPx, camera.heightPx, -1.0f);
  const int stride = camera.widthPx > 400 ? 3 : 1;  // every third pixel will do
  core::parallelFor(std::size_t(camera.heightPx) / stride, 8, [&](std::size_t begin, std::size_t end) {
    for (int y = int(begin) * stride; y < int(end) * stride; y += stride)
      for (int x = 0; x < camera.widthPx; x += stride)
        if (mirror.at(x, y).triangle != core::kNoId)
          errors.at(x, y) = findDisplacement(truth, mirror, x, y, method.at(x, y));
  });
  std::vector<float> all, objectPixels;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (errors.pixels()[i] < 0) continue;
    all.push_back(errors.pixels()[i]);
    if (!truth.pixels()[i].shell || !method.pixels()[i].shell) objectPixels.push_back(errors.pixels()[i]);
  }
  result.mirror = summarize(std::move(all));
  result.objects = summarize(std::move(objectPixels));
  writePicture(name + "-truth", camera.widthPx, camera.heightPx, [&](int x, int y) {
    return mirror.at(x, y).triangle == core::kNoId ? glm::u8vec3(0) : chequer(truth.at(x, y));
  });
  writePicture(name + "-method", camera.widthPx, camera.heightPx, [&](int x, int y) {
    return mirror.at(x, y).triangle == core::kNoId ? glm::u8vec3(0) : chequer(method.at(x, y));
  });
  writePicture(name + "-error", camera.widthPx, camera.heightPx, [&](int x, int y) {
    const float e = errors.at(x, y);
    if (e < 0) return glm::u8vec3(40, 40, 80);
    if (e >= kLost) return glm::u8vec3(255, 0, 255);
    return e <= 1 ? glm::u8vec3(std::uint8_t(e * 160))
                  : glm::u8vec3(255, std::uint8_t(std::max(0.f, 220 - e * 12)), 0);
  });
  return result;
}

}  // namespace catoptric::virtual_object::test

// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/reflected_beams.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catoptric::virtual_object {
namespace {

constexpr double kWidest = 0.6;  // of the box around a patch's normals
constexpr int kNearlyAll = 22;   // of 26 directions
constexpr float kWide = 0.1f;    // cosine to the axis below which no plane is worth while
// Within a triangle normals are interpolated: its rays stay between those of the corners, but for terms of
// the second order.
constexpr float kBetween = 0.25f, kLeast = 1e-3f;  // of the longest chord; radians
constexpr float kSlack = 1e-4f;                    // of the mirror's radius
constexpr double kRounding = 1e-6;                 // of the distance from the world's origin
constexpr std::size_t kMostPatches = ReflectedBeams::kMost, kFewestTriangles = 16;

/// A range of the triangles, along which axis their normals differ most, and by how much.
struct Patch {
  std::size_t first, end;
  int axis = 0;
  double width = 0;
};

Patch makePatch(std::span<const std::uint32_t> triangles, std::span<const dvec3> normals, std::size_t first,
                std::size_t end) {
  core::Box box;
  for (std::size_t i = first; i < end; ++i) box.add(normals[triangles[i]]);
  const dvec3 size = box.upper - box.lower;
  Patch patch{first, end};
  if (end - first < kFewestTriangles) return patch;  // not to be cut
  for (int k = 0; k < 3; ++k)
    if (size[k] > patch.width) patch.axis = k, patch.width = size[k];
  return patch;
}

}  // namespace

MirrorPatches::MirrorPatches(const ReflectorMesh& mesh)
    : triangles_(mesh.ordinaryCount()),
      gatheredFor_(mesh.positions().size()),
      centre_(mesh.centre()),
      radius_(mesh.radius()),
      slack_(kSlack * float(mesh.radius()) + float(kRounding * glm::length(mesh.centre()))) {
  std::vector<dvec3> normals(triangles_.size());
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    triangles_[t] = t;
    normals[t] = glm::normalize(mesh.triangles()[t].normal(1.0 / 3, 1.0 / 3));
  }
  std::vector<Patch> patches;
  if (!triangles_.empty()) patches.push_back(makePatch(triangles_, normals, 0, triangles_.size()));
  while (!patches.empty() && patches.size() < kMostPatches) {
    const auto widest = std::max_element(patches.begin(), patches.end(),
                                         [](const Patch& a, const Patch& b) { return a.width < b.width; });
    if (!(widest->width > kWidest)) break;
    const auto [first, end, axis, width] = *widest;
    const std::size_t middle = (first + end) / 2;
    const auto at = [&](std::size_t i) { return triangles_.begin() + std::ptrdiff_t(i); };
    std::nth_element(at(first), at(middle), at(end), [&, k = axis](std::uint32_t a, std::uint32_t b) {
      return normals[a][k] < normals[b][k];
    });
    *widest = makePatch(triangles_, normals, first, middle);
    patches.push_back(makePatch(triangles_, normals, middle, end));
  }
  std::sort(patches.begin(), patches.end(), [](const Patch& a, const Patch& b) { return a.end < b.end; });
  for (const Patch& patch : patches) ends_.push_back(patch.end);
}

bool MirrorPatches::gatherRays(const ReflectorMesh& mesh, const ReflectedRays& rays, std::size_t patch) {
  for (auto* list : {origins_, directions_})
    for (int k = 0; k < 3; ++k) list[k].clear();
  sum_ = vec3(0);
  float longest = 0;  // squared
  for (std::size_t i = patch > 0 ? ends_[patch - 1] : 0; i < ends_[patch]; ++i) {
    if (!rays.isMapped[triangles_[i]]) continue;
    const std::uint32_t* corners = &mesh.corners()[3 * std::size_t(triangles_[i])];
    for (std::size_t k = 0; k < 3; ++k) {
      const vec3 direction(rays.directions[corners[k]]);
      const vec3 chord = vec3(rays.directions[corners[(k + 1) % 3]]) - direction;
      longest = std::max(longest, glm::dot(chord, chord));
      std::uint32_t& gatheredFor = gatheredFor_[corners[k]];
      if (gatheredFor == patch + 1) continue;
      gatheredFor = std::uint32_t(patch + 1);
      const vec3 origin(mesh.positions()[corners[k]] - mesh.centre());
      for (int c = 0; c < 3; ++c) origins_[c].push_back(origin[c]), directions_[c].push_back(direction[c]);
      sum_ += direction;
    }
  }
  longest_ = std::sqrt(longest);
  return !origins_[0].empty();
}

/// Step 2.
ReflectedBeams::Beam MirrorPatches::makeBeam() const {
  ReflectedBeams::Beam beam;
  const std::size_t count = origins_[0].size();
  const auto least = [count](const std::vector<float>(&vectors)[3], const vec3& along) {
    float found = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < count; ++i)
      found = std::min(found, along.x * vectors[0][i] + along.y * vectors[1][i] + along.z * vectors[2][i]);
    return found;
  };
  const vec3 axis = glm::dot(sum_, sum_) > 0 ? glm::normalize(sum_) : vec3(0);
  const float leastCosine = least(directions_, axis);
  if (!(leastCosine > kWide)) return beam;
  const float margin = (kBetween * longest_ + kLeast) / leastCosine;
  const MapFrame frame = makeMapFrame(dvec3(axis));
  constexpr std::size_t kSides = ReflectedBeams::kPlanes - 1;
  for (std::size_t k = 0; k < kSides; ++k) {
    const float around = float(k) * 2.0f * glm::pi<float>() / float(kSides);
    const vec3 aside = std::cos(around) * vec3(frame.x) + std::sin(around) * vec3(frame.y);
    float tangent = std::numeric_limits<float>::infinity();  // of angles from the axis
    for (std::size_t i = 0; i < count; ++i) {
      const vec3 d(directions_[0][i], directions_[1][i], directions_[2][i]);
      tangent = std::min(tangent, glm::dot(aside, d) / glm::dot(axis, d));
    }
    const float angle = std::atan(tangent) - margin;
    beam[k].normal = std::cos(angle) * aside - std::sin(angle) * axis;
  }
  beam[kSides].normal = axis;
  for (BeamPlane& plane : beam)
    plane.distance = float(glm::dot(dvec3(plane.normal), centre_) + least(origins_, plane.normal)) - slack_;
  return beam;
}

/// Does a beam meet nearly every direction, far away? Then no plane is worth while.
bool MirrorPatches::isAllAround(const ReflectedBeams& beams) const {
  constexpr double kFar = 8;  // of the mirror's radius
  int met = 0;
  for (int i = 0; i < 27; ++i) {
    if (i == 13) continue;
    const dvec3 direction = glm::normalize(dvec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
    core::Box point;
    point.add(centre_ + kFar * radius_ * direction);
    met += beams.mayMeet(point) ? 1 : 0;
  }
  return met >= kNearlyAll;
}

void MirrorPatches::makeBeams(const ReflectorMesh& mesh, const ReflectedRays& rays, ReflectedBeams& out) {
  out.beams.clear();
  std::fill(gatheredFor_.begin(), gatheredFor_.end(), 0u);
  for (std::size_t patch = 0; patch < ends_.size(); ++patch)
    if (gatherRays(mesh, rays, patch)) out.beams.push_back(makeBeam());
  if (isAllAround(out)) out.beams.assign(1, {});
}

void makePictureBeam(const dmat4& clipFromWorld, const dvec3& eye, const ivec2& sizePx,
                     const gl::Scissor& rectangle, ReflectedBeams& out) {
  constexpr double kMarginPx = 1;
  const dmat4 rows = glm::transpose(clipFromWorld);
  const dvec2 size(sizePx), first = dvec2(rectangle.x, rectangle.y) - kMarginPx,
                            last = first + dvec2(rectangle.width, rectangle.height) + 2.0 * kMarginPx;
  const dvec2 lower = 2.0 * first / size - 1.0, upper = 2.0 * last / size - 1.0;
  out.beams.assign(1, {});
  const auto through = [&](const dvec3& inwards) {
    const dvec3 normal = glm::normalize(inwards);
    return BeamPlane{vec3(normal), float(glm::dot(normal, eye) - kRounding * glm::length(eye))};
  };
  for (int k = 0; k < 2; ++k) {
    out.beams[0][std::size_t(k)] = through(rows[k] - lower[k] * rows[3]);
    out.beams[0][std::size_t(k) + 2] = through(upper[k] * rows[3] - rows[k]);
  }
}

ReflectedBeams moveToWorld(const ReflectedBeams& beams, const dmat4& beamsFromWorld) {
  ReflectedBeams moved = beams;
  const dmat3 worldFromBeams = glm::transpose(dmat3(beamsFromWorld));
  for (ReflectedBeams::Beam& beam : moved.beams)
    for (BeamPlane& plane : beam) {
      const dvec3 normal(plane.normal);
      plane.distance -= float(glm::dot(normal, dvec3(beamsFromWorld[3])));
      plane.normal = vec3(worldFromBeams * normal);
    }
  return moved;
}

bool ReflectedBeams::mayMeet(const core::Box& box) const {
  const vec3 centre(box.centre()), half(0.5 * (box.upper - box.lower));
  return std::any_of(beams.begin(), beams.end(), [&](const Beam& beam) {
    return std::none_of(beam.begin(), beam.end(), [&](const BeamPlane& plane) {
      return glm::dot(plane.normal, centre) + glm::dot(glm::abs(plane.normal), half) < plane.distance;
    });
  });
}

}  // namespace catoptric::virtual_object

// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/monge_patches.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace catoptric::virtual_object {
namespace {

constexpr double kFacet = 0.2;   // an edge, of the mirror's radius, bends counted
constexpr int kMostCuts = 6;     // of a triangle's edges
constexpr double kLeaf = 0.12;   // half a patch's side, likewise
constexpr double kWidest = 0.9;  // cosine between a patch's normals and that at its middle
constexpr double kSteepest = 0.2;
constexpr double kWider = 0.1;    // of a facet's box: its edges are curved
constexpr double kMargin = 1.25;  // of measured third derivatives
constexpr double kClose = 1e-7;   // of the mirror's radius: where the next step is rounding
constexpr int kMostSteps = 12;

/// Halves so that those with the smaller key come first; neither half is empty.
template <class Element, class Key>
std::size_t halve(std::span<Element> elements, const Key& key) {
  double least = key(elements[0]), most = least;
  for (const Element& e : elements) least = std::min(least, key(e)), most = std::max(most, key(e));
  const double middle = 0.5 * (least + most);
  const auto second =
      std::partition(elements.begin(), elements.end(), [&](const Element& e) { return key(e) < middle; });
  const auto count = std::size_t(second - elements.begin());
  return count == 0 || count == elements.size() ? elements.size() / 2 : count;
}

}  // namespace

struct MongePatches::Facet {
  std::array<dvec3, 3> corners;
  dvec3 middle, normal;
};

dvec3 MongePatches::findNormal(const dvec3& at) const {
  return side_ * glm::normalize(surface_->gradient(at));
}

/// Step 1.
void MongePatches::cut(const std::array<dvec3, 3>& corners, int depth, std::vector<Facet>& facets) const {
  std::array<dvec3, 3> normals;
  for (int i = 0; i < 3; ++i) normals[i] = findNormal(corners[i]);
  int longest = 0;
  double most = 0;
  for (int i = 0; i < 3; ++i) {
    const dvec3 along = corners[(i + 1) % 3] - corners[i],
                bend = radius_ * (normals[(i + 1) % 3] - normals[i]);
    const double square = glm::dot(along, along) + glm::dot(bend, bend);
    if (square > most) most = square, longest = i;
  }
  if (depth == 0 || most <= kFacet * kFacet * radius_ * radius_) {
    const dvec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    const dvec3 normal = normals[0] + normals[1] + normals[2];
    facets.push_back({corners, middle, glm::normalize(normal)});
    return;
  }
  const dvec3 &a = corners[longest], &b = corners[(longest + 1) % 3], &c = corners[(longest + 2) % 3];
  const dvec3 between = surface_->project(0.5 * (a + b));
  cut({a, between, c}, depth - 1, facets);
  cut({between, b, c}, depth - 1, facets);
}

/// Step 3. From the height that the other patch's derivatives give, Newton's method along the frame's normal.
std::optional<MongePatch> MongePatches::moveIn(const PatchFrame& frame, const MongePatch& near,
                                               const dvec2& middle, const dvec2& half) const {
  const dvec2 away = middle - near.middle;
  MongePatch p = near;
  p.middle = middle;
  p.half = half;
  p.firstHalf = 0;
  p.height += glm::dot(away, near.slope + 0.5 * near.applyBend(away));
  for (int i = 0; i < kMostSteps; ++i) {
    const dvec3 at = frame.toWorld({middle, p.height});
    const auto [value, gradient] = surface_->sampleAt(at);
    const dvec3 g = side_ * (gradient * frame.axes);
    if (!(g.z > kSteepest * glm::length(g))) return std::nullopt;
    const double step = side_ * value / g.z;
    p.height -= step;
    if (!(std::abs(step) <= kClose * radius_)) continue;
    p.slope = -dvec2(g) / g.z;
    const dmat3 hessian = surface_->hessian(at);
    const dvec3 x = frame.axes * dvec3(1, 0, p.slope.x), y = frame.axes * dvec3(0, 1, p.slope.y);
    const dvec3 hx = hessian * x, hy = hessian * y;
    p.bendXx = -side_ * glm::dot(x, hx) / g.z;
    p.bendXy = -side_ * glm::dot(x, hy) / g.z;
    p.bendYy = -side_ * glm::dot(y, hy) / g.z;
    return p;
  }
  return std::nullopt;
}

/// Step 3, the bound: differences along each axis, in three rows of two, and to the edges as much again as
/// they change. False where the surface ends within the patch; then the bend may change by all of it.
bool MongePatches::boundThird(const PatchFrame& frame, MongePatch& patch) const {
  const dvec2& h = patch.half;
  const auto scaleBend = [&](const MongePatch& p) {
    return dvec3(h.x * h.x * p.bendXx, glm::root_two<double>() * h.x * h.y * p.bendXy, h.y * h.y * p.bendYy);
  };
  patch.third = glm::length(scaleBend(patch)) / h;
  dvec3 grid[3][3];
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y) {
      const auto p = moveIn(frame, patch, patch.middle + h * dvec2(x - 1, y - 1), h);
      if (!p) return false;
      grid[x][y] = scaleBend(*p);
    }
  patch.third = dvec2(0);
  for (int axis = 0; axis < 2; ++axis)
    for (int row = 0; row < 3; ++row) {
      const auto at = [&](int i) { return axis == 0 ? grid[i][row] : grid[row][i]; };
      const dvec3 first = at(1) - at(0), second = at(2) - at(1);
      const double most = std::max(glm::length(first), glm::length(second)) + glm::length(second - first);
      patch.third[axis] = std::max(patch.third[axis], kMargin * most / h[axis]);
    }
  return true;
}

/// At the middle of a set, along the principal directions; nothing where its normals are too far apart.
std::optional<PatchFrame> MongePatches::findFrame(std::span<const Facet> facets) const {
  dvec3 middle(0);
  for (const Facet& f : facets) middle += f.middle / double(facets.size());
  const dvec3 origin = surface_->project(middle), normal = findNormal(origin);
  const auto isNear = [&](const Facet& f) { return glm::dot(f.normal, normal) > kWidest; };
  if (facets.size() > 1 && !std::all_of(facets.begin(), facets.end(), isNear)) return std::nullopt;
  const dvec3 helper = std::abs(normal.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  const dvec3 t1 = glm::normalize(glm::cross(helper, normal));
  PatchFrame frame{origin, dmat3(t1, glm::cross(normal, t1), normal)};
  const auto there = moveIn(frame, {}, dvec2(0), dvec2(0));
  if (!there) return std::nullopt;
  const double angle = 0.5 * std::atan2(2 * there->bendXy, there->bendXx - there->bendYy);
  const dvec3 along = std::cos(angle) * frame.axes[0] + std::sin(angle) * frame.axes[1];
  frame.axes = dmat3(along, glm::cross(normal, along), normal);
  return frame;
}

/// Step 2.
std::optional<MongePatch> MongePatches::cover(std::span<const Facet> facets) {
  const auto frame = findFrame(facets);
  if (!frame) return std::nullopt;
  dvec2 lower(1e300), upper(-1e300);
  for (const Facet& f : facets) {
    const dvec2 a(frame->toLocal(f.corners[0])), b(frame->toLocal(f.corners[1])),
        c(frame->toLocal(f.corners[2]));
    const dvec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
    const double wider = kWider * glm::distance(low, high);
    lower = glm::min(lower, low - wider), upper = glm::max(upper, high + wider);
  }
  const auto atOrigin = moveIn(*frame, {}, dvec2(0), dvec2(0));
  if (!atOrigin) return std::nullopt;
  auto patch = moveIn(*frame, *atOrigin, 0.5 * (lower + upper), 0.5 * (upper - lower));
  if (!patch || (!boundThird(*frame, *patch) && facets.size() > 1)) return std::nullopt;
  patch->frame = std::uint32_t(frames_.size());
  frames_.push_back(*frame);
  return patch;
}

void MongePatches::divide(std::span<Facet> facets) {
  if (auto patch = cover(facets)) {
    divideBelow(*patch, facets);
    largest_.push_back(*patch);
    return;
  }
  if (facets.size() < 2) return;
  const auto coordinate = [&](const Facet& f, int axis) {
    return axis < 3 ? f.middle[axis] : radius_ * f.normal[axis - 3];
  };
  int longest = 0;
  double most = -1;
  for (int axis = 0; axis < 6; ++axis) {
    const auto [low, high] = std::minmax_element(
        facets.begin(), facets.end(),
        [&](const Facet& a, const Facet& b) { return coordinate(a, axis) < coordinate(b, axis); });
    const double length = coordinate(*high, axis) - coordinate(*low, axis);
    if (length > most) most = length, longest = axis;
  }
  const std::size_t first = halve(facets, [&](const Facet& f) { return coordinate(f, longest); });
  divide(facets.first(first));
  divide(facets.subspan(first));
}

void MongePatches::divideBelow(MongePatch& patch, std::span<Facet> facets) {
  const double lengthX = patch.half.x * std::hypot(1 / radius_, patch.bendXx),
               lengthY = patch.half.y * std::hypot(1 / radius_, patch.bendYy);
  if (facets.size() < 2 || std::max(lengthX, lengthY) < kLeaf) return;
  const PatchFrame frame = frameOf(patch);
  const int axis = lengthX > lengthY ? 0 : 1;
  const std::size_t first = halve(facets, [&](const Facet& f) { return frame.toLocal(f.middle)[axis]; });
  const std::array sets{facets.first(first), facets.subspan(first)};
  std::array halves{cover(sets[0]), cover(sets[1])};
  if (!halves[0] || !halves[1]) return;  // to be cut when it is asked
  const std::size_t at = halves_.size();
  patch.firstHalf = std::uint32_t(at);
  halves_.resize(at + 2);
  for (std::size_t i = 0; i < 2; ++i) {
    divideBelow(*halves[i], sets[i]);
    halves_[at + i] = *halves[i];
  }
}

void MongePatches::split(const MongePatch& patch, std::vector<MongePatch>& parts) const {
  if (patch.firstHalf > 0) {
    parts.push_back(halves_[patch.firstHalf]);
    parts.push_back(halves_[patch.firstHalf + 1]);
    return;
  }
  for (const dvec2 corner : {dvec2(-1, -1), dvec2(1, -1), dvec2(-1, 1), dvec2(1, 1)})
    if (auto part = move(patch, patch.middle + 0.5 * patch.half * corner, 0.5 * patch.half)) {
      part->third *= 0.25;  // half times a derivative of what is in units of half, twice
      parts.push_back(*part);
    }
}

MongePatches::MongePatches(std::shared_ptr<const geometry::ImplicitSurface> surface, double side,
                           double radius, std::span<const vec3> points,
                           std::span<const std::uint32_t> triangles)
    : surface_(std::move(surface)), side_(side), radius_(radius), halves_(1) {  // 0 is none
  std::vector<dvec3> on;
  for (const vec3& p : points) on.push_back(surface_->project(dvec3(p)));
  std::vector<Facet> facets;
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3)
    cut({on[triangles[i]], on[triangles[i + 1]], on[triangles[i + 2]]}, 2 * kMostCuts, facets);
  if (!facets.empty()) divide(facets);
}

}  // namespace catoptric::virtual_object

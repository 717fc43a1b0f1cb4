// SPDX-License-Identifier: Apache-2.0
#include "catoptric/geometry/aspheric_mirror.h"

#include <array>

namespace catoptric::geometry {
namespace {

constexpr std::size_t kFewestVertices = 12;

/// What is common to f and its derivatives, in the mirror's frame and scale.
struct Terms {
  dvec3 x;
  double u, w;    // r^2; z less the terms in r^4 and r^6
  double bulge;   // d (a4 u^2 + a6 u^3) / d u
  double upward;  // d f / d w
};

Terms evaluateTerms(const AsphericMirror& m, const dvec3& p) {
  Terms t;
  t.x = m.frame.toLocal(p) / m.scale;
  t.u = t.x.x * t.x.x + t.x.y * t.x.y;
  t.w = t.x.z - t.u * t.u * (m.a4 + m.a6 * t.u);
  t.bulge = t.u * (2 * m.a4 + 3 * m.a6 * t.u);
  t.upward = 2 - 2 * (1 + m.conic) * m.curvature * t.w;
  return t;
}

using Parameters = std::array<double, 9>;  // two turns, three moves, c, k, a4, a6

AsphericMirror makeMirror(const AxisFrame& frame, double scale, std::span<const double> p) {
  AsphericMirror mirror;
  mirror.frame = frame.moved({p[0], p[1]}, scale * dvec3(p[2], p[3], p[4]));
  mirror.scale = scale;
  mirror.curvature = p[5], mirror.conic = p[6], mirror.a4 = p[7], mirror.a6 = p[8];
  return mirror;
}

/// Step 2 from one start: first k stays, and either the axis as well or the terms beyond it; then nothing.
std::optional<PolishedSurface> polishFrom(const AxisFrame& frame, double scale, double conic, bool axisStays,
                                          std::span<const vec3> points) {
  const auto spread = [=](std::span<const double> p) {
    return axisStays ? Parameters{0, 0, 0, 0, p[0], p[1], conic, p[2], p[3]}
                     : Parameters{p[0], p[1], p[2], p[3], p[4], p[5], conic, 0, 0};
  };
  const SurfaceFamily all = [&](std::span<const double> p) {
    return std::make_unique<AsphericMirror>(makeMirror(frame, scale, p));
  };
  const SurfaceFamily some = [&](std::span<const double> p) { return all(spread(p)); };
  const auto start = polishSurface(some, std::vector<double>(axisStays ? 4 : 6), points);
  if (!start) return std::nullopt;
  const Parameters parameters = spread(start->parameters);
  return polishSurface(all, {parameters.begin(), parameters.end()}, points);
}

}  // namespace

// f = 2 w - c u - (1 + k) c w^2
ImplicitSurface::Sample AsphericMirror::sampleAt(const dvec3& p) const {
  const Terms t = evaluateTerms(*this, p);
  const double along = -2 * (curvature + t.upward * t.bulge);  // of x and of y in the gradient
  const dvec3 local(along * t.x.x, along * t.x.y, t.upward);
  return {t.w * (2 - (1 + conic) * curvature * t.w) - curvature * t.u, frame.axes * local / scale};
}

dmat3 AsphericMirror::hessian(const dvec3& p) const {
  const Terms t = evaluateTerms(*this, p);
  const dvec3 w(-2 * t.bulge * t.x.x, -2 * t.bulge * t.x.y, 1), r(t.x.x, t.x.y, 0);
  dmat3 h = (-2 * (1 + conic) * curvature) * glm::outerProduct(w, w) -
            (t.upward * 4 * (2 * a4 + 6 * a6 * t.u)) * glm::outerProduct(r, r);
  h[0][0] -= 2 * (curvature + t.upward * t.bulge);
  h[1][1] -= 2 * (curvature + t.upward * t.bulge);
  return frame.axes * h * glm::transpose(frame.axes) / (scale * scale);
}

bool AsphericMirror::isOnSheet(const dvec3& p) const {
  return evaluateTerms(*this, p).upward > 0;
}

std::optional<AsphericFit> fitAsphericMirror(const MeshView& mesh) {
  if (mesh.positions.size() < kFewestVertices) return std::nullopt;
  const MeshScale scale = measureScale(mesh);
  std::optional<AsphericFit> best;
  double bestSquare = 0;
  // 1
  for (const AxisFrame& axis : findRevolutionAxes(mesh)) {
    AxisFrame frame = axis;  // its origin level with the vertices
    frame.origin += frame.axes[2] * frame.toLocal(scale.centre).z;
    for (const bool axisStays : {true, false})
      for (const double conic : {-1.0, 0.0}) {
        // 2
        const auto polished = polishFrom(frame, scale.size, conic, axisStays, mesh.positions);
        if (!polished || (best && !(polished->meanSquare < bestSquare))) continue;
        // 3
        const AsphericMirror mirror = makeMirror(frame, scale.size, polished->parameters);
        const auto deviation = measureDeviation(mirror, mesh);
        if (!deviation) continue;
        best = AsphericFit{mirror, *deviation};
        bestSquare = polished->meanSquare;
        if (polished->isExact) return best;
      }
  }
  return best;
}

}  // namespace catoptric::geometry

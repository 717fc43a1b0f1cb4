// SPDX-License-Identifier: Apache-2.0
#include "catoptric/virtual_object/root_isolation.h"

#include <cmath>
#include <utility>
#include <vector>

namespace catoptric::virtual_object {
namespace {

constexpr std::size_t kMostPatches = 16384;  // of one size
constexpr double kSmallest = 1e-6;           // half a diagonal, of the mirror's radius
constexpr double kUnique = 0.4;              // step 5
constexpr int kMostSteps = 8;                // of Newton's method
constexpr double kLongestStep = 2;           // of a patch's half sides
constexpr double kConverged = 1e-10;         // of the mirror's radius: the last step
constexpr double kNear = 1e-5;               // of it: near enough for a search to go on from there
constexpr int kMostFailures = 256;           // of searches
constexpr double kSingular = 1e-10;          // determinant over squares
constexpr double kDiagonal = 1.4142135623730951;

double sumSides(const dvec2& v) {
  return std::abs(v.x) + std::abs(v.y);
}

struct Symmetric {
  double xx = 0, xy = 0, yy = 0;

  [[nodiscard]] dvec2 operator*(const dvec2& v) const { return {xx * v.x + xy * v.y, xy * v.x + yy * v.y}; }
  [[nodiscard]] double norm() const { return std::sqrt(xx * xx + 2 * xy * xy + yy * yy); }
};

/// A patch in units of its half sides.
struct Scaled {
  Symmetric bend;
  dvec2 slope;
  double third, mostBend, mostSlope;  ///< bounds of |D K|, |K| and |g| over it

  explicit Scaled(const MongePatch& p)
      : bend{p.half.x * p.half.x * p.bendXx, p.half.x * p.half.y * p.bendXy, p.half.y * p.half.y * p.bendYy},
        slope(p.half * p.slope),
        third(glm::length(p.half * p.third)),
        mostBend(bend.norm() + kDiagonal * third),
        mostSlope(glm::length(slope) + kDiagonal * mostBend) {}
};

/// Steps 1 and 2 for E or Q, at a patch's middle; derivatives in units of its half sides.
struct Sight {
  dvec2 across;  ///< p
  double up;     ///< w
  dvec2 alpha;
  double beta;
  Symmetric alphaChange;  ///< D alpha
  dvec2 betaChange;       ///< D beta

  Sight(const MongePatch& p, const Scaled& s, const dvec3& local)
      : across(dvec2(local) - p.middle),
        up(local.z - p.height),
        alpha(p.half * (across + up * p.slope)),
        beta(up - glm::dot(p.slope, across)),
        alphaChange{up * s.bend.xx - p.half.x * p.half.x - s.slope.x * s.slope.x,
                    up * s.bend.xy - s.slope.x * s.slope.y,
                    up * s.bend.yy - p.half.y * p.half.y - s.slope.y * s.slope.y},
        betaChange(-p.half * p.applyBend(across)) {}
};

/// Step 3: over the patch. alphaBend and betaBend are second derivatives.
struct Bounds {
  double alphaBend, betaBend, alphaChange, betaChange, alpha, beta;

  Bounds(const Sight& r, const MongePatch& p, const Scaled& s)
      : alphaBend(s.third * (std::abs(r.up) + kDiagonal * s.mostSlope) + 3 * s.mostBend * s.mostSlope),
        betaBend(glm::dot(p.third, glm::abs(r.across) + p.half) + s.mostBend),
        alphaChange(r.alphaChange.norm() + kDiagonal * alphaBend),
        betaChange(glm::length(r.betaChange) + kDiagonal * betaBend),
        alpha(glm::length(r.alpha) + kDiagonal * alphaChange),
        beta(std::abs(r.beta) + kDiagonal * betaChange) {}
};

/// F and the rows of its derivative.
struct Field {
  dvec2 value, rowX, rowY;
  double determinant;

  Field(const Sight& e, const Sight& q)
      : value(e.alpha * q.beta + q.alpha * e.beta),
        rowX(dvec2(e.alphaChange.xx, e.alphaChange.xy) * q.beta + e.alpha.x * q.betaChange +
             dvec2(q.alphaChange.xx, q.alphaChange.xy) * e.beta + q.alpha.x * e.betaChange),
        rowY(dvec2(e.alphaChange.xy, e.alphaChange.yy) * q.beta + e.alpha.y * q.betaChange +
             dvec2(q.alphaChange.xy, q.alphaChange.yy) * e.beta + q.alpha.y * e.betaChange),
        determinant(rowX.x * rowY.y - rowX.y * rowY.x) {}

  /// Newton's.
  [[nodiscard]] dvec2 findStep() const {
    return dvec2(rowX.y * value.y - rowY.y * value.x, rowY.x * value.x - rowX.x * value.y) / determinant;
  }
  /// That, or the shortest one where DF is singular: reflections on a curve.
  [[nodiscard]] dvec2 findShortestStep() const {
    const double square = glm::dot(rowX, rowX) + glm::dot(rowY, rowY);
    return std::abs(determinant) > kSingular * square ? findStep()
                                                      : -(value.x * rowX + value.y * rowY) / square;
  }
  /// c with c^T DF = v.
  [[nodiscard]] dvec2 turnBack(const dvec2& v) const {
    return dvec2(rowY.y * v.x - rowY.x * v.y, rowX.x * v.y - rowX.y * v.x) / determinant;
  }
};

/// Step 4, the first: nowhere in front of the tangent plane.
bool isBehind(const Sight& r, const Bounds& b) {
  return r.beta + sumSides(r.betaChange) + b.betaBend < 0;
}

/// Step 4, the second: both to the same side of their middle.
bool areOnOneSide(const Sight& e, const Bounds& be, const Sight& q, const Bounds& bq) {
  const dvec2 c = e.alpha * glm::length(q.alpha) + q.alpha * glm::length(e.alpha);
  const double length = glm::length(c);
  const auto isTowards = [&](const Sight& r, const Bounds& b) {
    return glm::dot(c, r.alpha) > sumSides(r.alphaChange * c) + length * b.alphaBend;
  };
  return isTowards(e, be) && isTowards(q, bq);
}

enum class Verdict { None, One, Several };

/// Steps 4 and 5.
Verdict judge(const MongePatch& patch, const dvec3& eyeLocal, const dvec3& pointLocal) {
  const Scaled s(patch);
  const Sight e(patch, s, eyeLocal), q(patch, s, pointLocal);
  const Bounds be(e, patch, s), bq(q, patch, s);
  if (isBehind(e, be) || isBehind(q, bq) || areOnOneSide(e, be, q, bq)) return Verdict::None;
  const double most = be.alphaBend * bq.beta + 2 * be.alphaChange * bq.betaChange + be.alpha * bq.betaBend +
                      bq.alphaBend * be.beta + 2 * bq.alphaChange * be.betaChange + bq.alpha * be.betaBend;
  const Field f(e, q);
  const double square = glm::dot(f.value, f.value);
  if (!(square <= sumSides(f.value.x * f.rowX + f.value.y * f.rowY) + most * std::sqrt(square)))
    return Verdict::None;
  const dvec2 step = f.findStep();
  if (glm::dot(step, step) > sumSides(step) + most * glm::length(f.turnBack(step))) return Verdict::None;
  const double size = std::sqrt(glm::dot(f.rowX, f.rowX) + glm::dot(f.rowY, f.rowY));
  return size * most * kDiagonal <= kUnique * std::abs(f.determinant) ? Verdict::One : Verdict::Several;
}

struct Isolation {
  const MongePatches& patches;
  dvec3 eye, point;
  IsolatedRoots& found;
  int failures = 0;

  /// Newton's method from a patch's middle.
  void search(const MongePatch& from) {
    const PatchFrame& frame = patches.frameOf(from);
    const dvec3 e = frame.toLocal(eye), q = frame.toLocal(point);
    const double radius = patches.radius();
    MongePatch p = from;
    double length = radius;  // of the last step
    for (int i = 0; i < kMostSteps && length > kConverged * radius; ++i) {
      const Scaled s(p);
      dvec2 step = Field(Sight(p, s, e), Sight(p, s, q)).findShortestStep();
      step *= from.half * std::min(1.0, kLongestStep / std::max(glm::length(step), 1e-300));
      length = glm::length(step);
      const auto next = patches.move(p, p.middle + step, from.half);
      if (!next) break;
      p = *next;
    }
    if (!(length < kNear * radius)) {
      ++failures;
      return;
    }
    const dvec3 at = frame.toWorld({p.middle, p.height});
    for (const dvec3& other : found)
      if (glm::distance(other, at) < 10 * kConverged * radius) return;
    found.all[std::size_t(found.count++)] = at;
  }

  /// Its parts are added to `next`, or it is searched, or nothing is there.
  void ask(const MongePatch& patch, std::vector<MongePatch>& next) {
    if (found.count == IsolatedRoots::kMost || failures == kMostFailures) return;
    const PatchFrame& frame = patches.frameOf(patch);
    const Verdict verdict = judge(patch, frame.toLocal(eye), frame.toLocal(point));
    if (verdict == Verdict::None) return;
    if (verdict == Verdict::One || glm::length(patch.half) < kSmallest * patches.radius() ||
        next.size() >= kMostPatches)
      search(patch);
    else
      patches.split(patch, next);
  }
};

}  // namespace

IsolatedRoots isolateReflections(const MongePatches& patches, const dvec3& eye, const dvec3& point) {
  thread_local std::vector<MongePatch> now, next;  // memory kept from pair to pair
  IsolatedRoots found;
  Isolation isolation{patches, eye, point, found};
  next.clear();
  for (const MongePatch& patch : patches.largest()) isolation.ask(patch, next);
  while (!next.empty()) {
    std::swap(now, next);
    next.clear();
    for (const MongePatch& patch : now) isolation.ask(patch, next);
  }
  return found;
}

}  // namespace catoptric::virtual_object

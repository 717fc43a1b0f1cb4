// SPDX-License-Identifier: Apache-2.0
#include "catoptric/scene/built_in/car_interior.h"

#include <array>

#include "catoptric/geometry/bezier_patch.h"
#include "catoptric/geometry/shapes.h"
#include "catoptric/geometry/sweep.h"
#include "catoptric/scene/built_in/vehicles.h"

namespace catoptric::scene::built_in {
namespace {

using geometry::append;
using geometry::Mesh;
using geometry::moveBy;
using geometry::transformed;
using geometry::turnAround;

constexpr double kQuarterTurn = 1.5707963267948966;
const dvec3 kLeftMirror(-1.03, 1.05, -1.3), kRightMirror(1.03, 1.05, -1.3), kInnerMirror(0.03, 1.355, -0.56);

struct CarPaints {
  int body, trim, dash, leather, steel;
};

CarPaints carPaints(SceneBuilder& builder) {
  return {builder.paint("own car paint", colour(0x7A1820), 0.25f),
          builder.paint("trim", colour(0x4A4846), 0.8f), builder.paint("dashboard", colour(0x4B4C50), 0.75f),
          builder.paint("leather", colour(0x4A3A30), 0.7f),
          builder.metal("satin steel", colour(0x9BA0A5), 0.4f)};
}

Mesh boxAt(const dvec3& centre, const dvec3& size) {
  return transformed(geometry::makeBox(size), moveBy(centre));
}

/// A beam with a flat-sided section between two points.
Mesh beam(const dvec3& from, const dvec3& to, double width, double thickness) {
  const dvec3 axis = glm::normalize(to - from), side = glm::normalize(glm::cross(axis, dvec3(0, 0, 1))),
              other = glm::cross(side, axis);
  dmat4 place(1.0);
  place[0] = dvec4(side, 0);
  place[1] = dvec4(axis, 0);
  place[2] = dvec4(other, 0);
  place[3] = dvec4(0.5 * (from + to), 1);
  return transformed(geometry::makeBox({width, glm::distance(from, to), thickness}), place);
}

/// Frame of a mirror at `place` that shows the eye what lies in the direction `seen`: +z is the mirror's
/// normal.
dmat4 worldFromMirror(const dvec3& place, const dvec3& seen) {
  const dvec3 toEye = glm::normalize(kDriversEye - place);
  const dvec3 normal = glm::normalize(toEye + glm::normalize(seen));
  const dvec3 right = glm::normalize(glm::cross(dvec3(0, 1, 0), normal)), up = glm::cross(normal, right);
  dmat4 frame(1.0);
  frame[0] = dvec4(right, 0);
  frame[1] = dvec4(up, 0);
  frame[2] = dvec4(normal, 0);
  frame[3] = dvec4(place, 1);
  return frame;
}

void addWingMirror(SceneBuilder& builder, const CarPaints& paints, bool isLeft) {
  WingMirrorOptions options;
  options.isOuterLeft = isLeft;
  const std::string side = isLeft ? "left" : "right";
  const double out = isLeft ? -1 : 1;
  const dvec3 place = isLeft ? kLeftMirror : kRightMirror;
  const dmat4 frame = worldFromMirror(place, {out * 0.13, -0.045, 1});
  builder.place(side + " wing mirror", makeWingMirrorGlass(options),
                builder.mirror("mirror glass", vec3(0.93f, 0.945f, 0.95f)), frame);
  builder.place(side + " mirror housing", makeMirrorHousing(options.widthMetres, options.heightMetres, 0.085),
                paints.body, frame);
  // The arm reaches the housing from below and from the front, where it hides nothing of the glass.
  const dvec3 foot(out * 0.85, 0.92, place.z - 0.12), hold = place + dvec3(-out * 0.05, -0.07, -0.09);
  builder.place(side + " mirror arm", beam(foot, hold, 0.04, 0.06), paints.trim);
}

void addInnerMirror(SceneBuilder& builder, const CarPaints& paints) {
  const dmat4 frame = worldFromMirror(kInnerMirror, dvec3(0.0, 1.21, 2.3) - kInnerMirror);
  constexpr double kWidth = 0.30, kHeight = 0.085;
  builder.place("inner mirror", makeFlatMirrorGlass(kWidth, kHeight), builder.mirror("mirror glass"), frame);
  builder.place("inner mirror housing", makeMirrorHousing(kWidth, kHeight, 0.035), paints.trim, frame);
  builder.place("inner mirror stalk",
                geometry::makeRod(kInnerMirror + dvec3(0, 0.01, -0.045),
                                  kInnerMirror + dvec3(0, 0.085, -0.06), 0.009, 12),
                paints.trim);
}

void addDashboard(SceneBuilder& builder, const CarPaints& paints) {
  // Side view: x to the front, extruded across the car.
  const std::array<dvec2, 8> profile = {dvec2(0.66, 0.55),  dvec2(2.0, 0.55),  dvec2(2.0, 0.88),
                                        dvec2(1.45, 0.925), dvec2(0.86, 0.94), dvec2(0.74, 0.915),
                                        dvec2(0.69, 0.87),  dvec2(0.70, 0.78)};
  builder.place("dashboard",
                transformed(geometry::makeExtrusion(profile, 1.5, 0.7), turnAround({0, 1, 0}, kQuarterTurn)),
                paints.dash);
  const std::array<dvec2, 7> hood = {dvec2(-0.17, 0),   dvec2(0.17, 0),  dvec2(0.16, 0.05),
                                     dvec2(0.11, 0.08), dvec2(0, 0.092), dvec2(-0.11, 0.08),
                                     dvec2(-0.16, 0.05)};
  builder.place("instrument hood",
                transformed(geometry::makeExtrusion(hood, 0.2, 0.8), moveBy({kDriversEye.x, 0.938, -0.84})),
                paints.dash);
  const dmat4 wheel = moveBy({kDriversEye.x, 0.845, -0.5}) * turnAround({1, 0, 0}, 1.13);
  std::vector<Piece> pieces = {
      {geometry::makeTorus(0.185, 0.0155, 64, 16), paints.dash},
      {transformed(geometry::makeCylinder(0.062, 0.04, 32), moveBy({0, -0.012, 0})), paints.trim}};
  for (double angle : {0.0, 2.0, -2.0}) {
    const dvec3 out(std::sin(angle), 0, std::cos(angle));
    pieces.push_back(
        {geometry::makeRod(0.05 * out + dvec3(0, -0.012, 0), 0.178 * out, 0.013, 12), paints.steel});
  }
  pieces.push_back({geometry::makeRod({0, -0.03, 0}, {0, -0.26, 0}, 0.03, 16), paints.trim});
  builder.place("steering wheel", pieces, wheel);
}

/// Pillars, roof, sills: what frames the windows, which are open.
void addCabin(SceneBuilder& builder, const CarPaints& paints) {
  Mesh trim;
  for (double side : {-1.0, 1.0}) {
    append(trim, beam({side * 0.76, 0.90, -1.92}, {side * 0.60, 1.46, -0.42}, 0.05, 0.045));  // A-pillar
    append(trim, beam({side * 0.79, 0.90, 0.42}, {side * 0.62, 1.46, 0.36}, 0.04, 0.09));     // B-pillar
    append(trim, beam({side * 0.74, 0.92, 2.05}, {side * 0.58, 1.46, 1.55}, 0.05, 0.12));     // C-pillar
    append(trim, boxAt({side * 0.795, 0.745, 0.39}, {0.05, 0.33, 3.3}));                      // door, inside
    append(trim, boxAt({side * 0.61, 1.465, 0.56}, {0.05, 0.035, 2.02}));                     // roof rail
  }
  append(trim, boxAt({0, 1.466, -0.43}, {1.27, 0.034, 0.06}));  // above the windscreen
  append(trim, boxAt({0, 1.464, 1.57}, {1.27, 0.034, 0.07}));   // above the rear window
  append(trim, boxAt({0, 0.905, 2.02}, {1.46, 0.03, 0.4}));     // parcel shelf
  builder.place("cabin", trim, paints.trim);
  builder.place("headliner", boxAt({0, 1.492, 0.56}, {1.2, 0.02, 2.0}),
                builder.paint("headliner", colour(0x9A968D), 0.95f));
  Mesh seats = boxAt({0, 0.68, 1.5}, {1.3, 0.5, 0.16});
  for (double x : {-0.4, 0.4}) {
    append(seats, boxAt({x, 1.0, 1.5}, {0.25, 0.13, 0.09}));
    append(seats, boxAt({x, 0.66, 0.3}, {0.5, 0.6, 0.13}));
    append(seats, boxAt({x, 1.06, 0.31}, {0.24, 0.15, 0.09}));
  }
  builder.place("seats", seats, paints.leather);
}

/// Outside: flanks, which the wing mirrors show, and the bonnet.
void addBody(SceneBuilder& builder, const CarPaints& paints) {
  Mesh body;
  for (double side : {-1.0, 1.0}) {
    append(body, boxAt({side * 0.84, 0.62, 0.2}, {0.035, 0.6, 4.7}));
    append(body, boxAt({side * 0.80, 0.30, 0.5}, {0.06, 0.09, 3.9}));
  }
  builder.place("flanks", body, paints.body);
  Mesh handles;
  for (double side : {-1.0, 1.0})
    for (double z : {0.28, 1.3}) append(handles, boxAt({side * 0.872, 0.80, z}, {0.022, 0.028, 0.17}));
  builder.place("door handles", handles, paints.steel);
  const geometry::BicubicPatch bonnet = geometry::makeTranslationalPatch(
      {dvec3(-0.8, -0.05, 0), dvec3(-0.4, 0.0, 0), dvec3(0.4, 0.0, 0), dvec3(0.8, -0.05, 0)},
      {dvec3(0, 0.62, -3.05), dvec3(0, 0.82, -2.98), dvec3(0, 0.865, -2.5), dvec3(0, 0.885, -2.02)});
  builder.place("bonnet", geometry::tessellatePatch(bonnet, 16, 12, true), paints.body);
}

}  // namespace

void addOwnCar(SceneBuilder& builder) {
  builder.addCamera("driver", kDriversEye, kDriversEye + dvec3(0.165, 0.01, -1.0), 71);
  builder.addCamera("left-mirror", kDriversEye, kLeftMirror + dvec3(0.015, -0.01, 0), 16);
  builder.addCamera("right-mirror", kDriversEye, kRightMirror + dvec3(-0.015, -0.01, 0), 11);
  builder.addCamera("inner-mirror", kDriversEye, kInnerMirror, 20);
  const CarPaints paints = carPaints(builder);
  addWingMirror(builder, paints, true);
  addWingMirror(builder, paints, false);
  addInnerMirror(builder, paints);
  addDashboard(builder, paints);
  addCabin(builder, paints);
  addBody(builder, paints);
}

}  // namespace catoptric::scene::built_in

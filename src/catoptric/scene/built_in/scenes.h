// SPDX-License-Identifier: Apache-2.0
// One function and one file for each built-in scene; the table is in scene/built_in_scenes.cpp. Metres, y up.
#pragma once

#include "catoptric/scene/scene.h"

namespace catoptric::scene::built_in {

[[nodiscard]] Scene makeFourSpheres();
[[nodiscard]] Scene makeCylinder();
[[nodiscard]] Scene makeFender();
[[nodiscard]] Scene makePolyhedraAndSphere();
[[nodiscard]] Scene makeCheckerBox();
[[nodiscard]] Scene makeHallOfMirrors();
[[nodiscard]] Scene makeDriversView();
[[nodiscard]] Scene makeConcaveBowl();
[[nodiscard]] Scene makeMask();
[[nodiscard]] Scene makeMixed();
[[nodiscard]] Scene makeTv();
[[nodiscard]] Scene makeCone();
[[nodiscard]] Scene makeDome();
[[nodiscard]] Scene makeVase();
[[nodiscard]] Scene makeWavyWall();
[[nodiscard]] Scene makeLenses();
[[nodiscard]] Scene makeColumns();
[[nodiscard]] Scene makeTeapotScene();
[[nodiscard]] Scene makeFacingMirrors();
[[nodiscard]] Scene makeFurnishedRoom();
[[nodiscard]] Scene makeReflectorSweep();
[[nodiscard]] Scene makeObjectSweep();

}  // namespace catoptric::scene::built_in

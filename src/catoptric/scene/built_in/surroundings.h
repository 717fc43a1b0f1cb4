// SPDX-License-Identifier: Apache-2.0
// Rooms and terraces that several built-in scenes share, in colours of their own, with what gives reflections
// something to show behind the camera: windows, pictures, parapets, trees.
#pragma once

#include "catoptric/scene/built_in/baked_light.h"
#include "catoptric/scene/built_in/scene_builder.h"

namespace catoptric::scene::built_in {

struct RoomColours {
  vec3 walls, floorLight, floorDark;
};

/// A room of the given inner size, centred on x = z = 0: boards with baked contact shadows, plastered walls
/// with skirting, a window on the left and in the front wall (at +z), a picture on the right and front walls.
void addPictureRoom(SceneBuilder& builder, const dvec3& size, const BakedLight& floorLight,
                    const RoomColours& colours);

/// A square terrace with baked contact shadows, brick parapets 0.8 m high, trees around. The floor's pattern
/// covers it once.
void addTerraceWithTrees(SceneBuilder& builder, double edge, const BakedLight& floorLight,
                         const Pattern& floor);

}  // namespace catoptric::scene::built_in

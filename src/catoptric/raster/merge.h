// SPDX-License-Identifier: Apache-2.0
// How what a mirror shows is kept within the mirror's pixels (2005, section 17.1.2; 1998, section 2.2).
#pragma once

#include <cstdint>

namespace catoptric::raster {

enum class Merge : std::uint8_t {
  Ids,      ///< each fragment looks up whether its pixel shows the mirror
  Stencil,  ///< the mirror's pixels are marked in the stencil, then only they are drawn
  Erase,    ///< everything is drawn, then what is not within the mirror is erased, by the stencil
  Depth,    ///< the depth of all other pixels is made the nearest, so that nothing is drawn there
  Clip,     ///< clip planes through the eye and the edges of a polygonal flat mirror
  Texture   ///< flat mirrors: drawn into a texture of its own, which the mirror then shows
};

}  // namespace catoptric::raster

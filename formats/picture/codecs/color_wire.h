// What a file says about its colours, as bytes.
#pragma once

#include "formats/picture/codecs/wire.h"
#include "formats/picture/color/stated_color.h"

namespace imgmesh {

/// All but StatedColor::fitting, which no file says.
void put_color(WireWriter& out, const StatedColor& color);
/// Throws std::runtime_error where the bytes end.
StatedColor take_color(WireReader& in);

}  // namespace imgmesh

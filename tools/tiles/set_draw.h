// imgmesh-reconstruct on tile sets.
#pragma once

#include <optional>
#include <string>

#include "formats/findings/limits.h"
#include "libcore/recon/draw.h"
#include "tools/common/tool_main.h"

namespace imgmesh {

struct SetDrawOptions {
    std::string input, output;
    std::optional<DrawMode> mode;  ///< kMap or kGouraud; others are refused
    int level = 0;
    std::optional<SampleType> depth;
    /// The part of the level to draw [its pixels], within it; nothing for all.
    std::optional<PixelRect> crop;
    ContainerLimits limits;
};

/// Draws a level of a set tile by tile. A TIFF is written as it is drawn, so that only a row of tiles is
/// held; any other format is held whole. Returns the report's members.
Report draw_set(const SetDrawOptions& options, const std::string& mode_name, Context& context);

/// Parses "X,Y,WIDTH,HEIGHT". Throws Error(kBadArgument); `name` is the option.
PixelRect parse_crop(const std::string& name, const std::string& text);

}  // namespace imgmesh

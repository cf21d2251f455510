// What is decided before the first tile of a set is made.
#pragma once

#include "formats/tileset/tile_set.h"
#include "libcore/pipeline/build_tile.h"
#include "tools/build_options.h"
#include "tools/common/tool_main.h"
#include "tools/tiles/tile_jobs.h"
#include "tools/tiles/tile_pixels.h"

namespace imgmesh {

struct PlannedTileSet {
    TileSetPlan plan;
    TileJobsPlan jobs;
    BuildParams params = {};  ///< with the channels' names
    TileCommon common = {};   ///< without a threshold where a first pass finds it
    double vertices = 0;      ///< the wanted number; 0 where only an error is
    MaskChoice mask = {};
    ReadImageOptions read = {};
    double whole_bytes = 0;    ///< of a picture that is held as a whole by every process that reads it
    std::string picture = {};  ///< the file to read parts of: the picture, or its copy in the work folder
};

/// Looks at the picture and returns the plan. Adds warnings to the context. Throws Error for what cannot
/// become a tile set.
PlannedTileSet plan_tile_set(const BuildOptions& options, Context& context);

/// Returns the plan that --job goes by. Throws Error as read_plan(), in words if there is none.
TileSetPlan plan_of_jobs(const BuildOptions& options);

/// Returns how the pixel maps of tiles are stored.
LayerLayout tile_layers(const BuildOptions& options);

/// Returns the report of --plan: the jobs, each with what it needs, its output, its command and what it
/// takes.
Report plan_report(const PlannedTileSet& planned, const BuildOptions& options);

}  // namespace imgmesh

// The work on a tile set as jobs that any engine can run: each has a name, what it needs and a file that
// tells that it is done.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "libcore/tiles/tile_grid.h"
#include "tools/common/tool_main.h"

namespace imgmesh {

struct TileJob {
    enum class Kind {
        kSpool,      ///< rewrites a picture that cannot be read by parts
        kSample,     ///< counts vertices on parts of a row of tiles
        kThreshold,  ///< finds the threshold of the whole set
        kTile,  ///< builds a tile of level 0 from pixels, or of another one from tiles of the level before
        kIndex  ///< joins the records
    };
    Kind kind = Kind::kIndex;
    TileName tile = {};              ///< of a sample only the row
    std::string name;                ///< "tile/0/3_5"
    std::vector<std::string> needs;  ///< names of jobs that come first
    std::string output;              ///< written when the job is done, below the set's folder
};

/// What the list of jobs depends on.
struct TileJobsPlan {
    TileGrid grid;
    std::string copy = {};    ///< spool_file() if the picture is rewritten first, else ""
    bool first_pass = false;  ///< the threshold is not known beforehand
};

/// Returns all jobs, each after those that it needs.
std::vector<TileJob> tile_jobs(const TileJobsPlan& plan);
/// Returns the job of that name, without what it needs; nothing if there is none. Takes no time for the
/// others, of which a plan may have 100,000.
std::optional<TileJob> find_job(const TileJobsPlan& plan, const std::string& name);

// Files below a set's folder beside those of formats/tileset/tile_files.h.
inline constexpr const char* kThresholdFile = "threshold.json";
inline constexpr const char* kWorkFolder = "work";  ///< what is removed when the set is complete
/// Of a plan: that of another picture must not be taken for it.
std::string spool_file(const std::string& key);
std::string sample_file(int row);

}  // namespace imgmesh

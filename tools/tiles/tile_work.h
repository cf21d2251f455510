// The work of each job of a tile set.
#pragma once

#include <cstdint>
#include <memory>

#include "formats/tileset/tile_set.h"
#include "libcore/base/progress.h"
#include "tools/common/tool_main.h"
#include "tools/tiles/tile_jobs.h"
#include "tools/tiles/tile_plan.h"

namespace imgmesh {

class TilePixels;

/// Does jobs of a set. What is there already, of the same plan and sound, is left alone.
class TileWork {
  public:
    TileWork(const PlannedTileSet& planned, const BuildOptions& options, Context& context);
    ~TileWork();

    /// Throws Error where the job cannot be done at all. A tile whose pixels cannot be read gets a record
    /// that says so instead. Returns whether there was something to do.
    bool run(const TileJob& job, const Progress& progress);

    std::int64_t made() const { return made_; }  ///< tiles that were made by this object
    std::int64_t kept() const { return kept_; }  ///< and those that were there

  private:
    TilePixels& pixels();
    bool spool(const Progress& progress);
    bool sample(int row, const Progress& progress);
    bool find_threshold();
    void forget_coarser(TileName tile) const;
    void remove(const std::string& path) const;
    bool make(const TileName& tile, const Progress& progress);
    void build(TileRecord& record, const Progress& progress);
    void coarsen(TileRecord& record);
    std::vector<std::string> folders_of_set() const;
    void index();
    TileCommon common() const;
    void write(TileRecord& record, MeshImage mesh_image, LayerLayout layers) const;

    const PlannedTileSet& planned_;
    const BuildOptions& options_;
    Context& context_;
    const std::string folder_, key_;
    std::unique_ptr<TilePixels> pixels_;
    std::int64_t made_ = 0, kept_ = 0;
    bool told_dense_ = false;
};

}  // namespace imgmesh

#include "tools/tiles/tile_jobs.h"

#include "formats/tileset/tile_files.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr const char* kSpoolJob = "spool";
constexpr const char* kThresholdJob = "threshold";

std::string job_name(const TileName& tile) {
    return "tile/" + tile_text(tile);
}

}  // namespace

std::string spool_file(const std::string& key) {
    return cat(kWorkFolder, "/source-", key.substr(0, 16));
}
std::string sample_file(int row) {
    return cat(kWorkFolder, "/sample/", row, ".json");
}

std::vector<TileJob> tile_jobs(const TileJobsPlan& plan) {
    using Kind = TileJob::Kind;
    std::vector<TileJob> jobs;
    std::vector<std::string> first;  // what reading pixels needs
    if (!plan.copy.empty()) {
        jobs.push_back({Kind::kSpool, {}, kSpoolJob, {}, plan.copy});
        first = {kSpoolJob};
    }
    if (plan.first_pass) {
        std::vector<std::string> samples;
        for (int row = 0; row < plan.grid.rows(0); ++row) {
            samples.push_back(cat("sample/", row));
            jobs.push_back({Kind::kSample, {0, 0, row}, samples.back(), first, sample_file(row)});
        }
        jobs.push_back({Kind::kThreshold, {}, kThresholdJob, std::move(samples), kThresholdFile});
        first.push_back(kThresholdJob);
    }
    // A coarser tile follows its last child, so that little is left to do at the end.
    for (const TileName& finest : plan.grid.tiles(0)) {
        jobs.push_back({Kind::kTile, finest, job_name(finest), first, tile_record(finest)});
        for (TileName child = finest; child.level + 1 < plan.grid.levels();) {
            const TileName parent = plan.grid.parent(child);
            const std::vector<TileName> children = plan.grid.children(parent);
            if (children.back() != child) break;
            std::vector<std::string> needs;
            for (const TileName& part : children) needs.push_back(job_name(part));
            jobs.push_back({Kind::kTile, parent, job_name(parent), std::move(needs), tile_record(parent)});
            child = parent;
        }
    }
    std::vector<std::string> all;
    for (const TileJob& job : jobs)
        if (job.kind == Kind::kTile) all.push_back(job.name);
    jobs.push_back({Kind::kIndex, {}, "index", std::move(all), kIndexFile});
    return jobs;
}

}  // namespace imgmesh

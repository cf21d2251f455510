#include "tools/tiles/tile_jobs.h"

#include <cstring>
#include <utility>

#include "formats/tileset/tile_files.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr const char* kSpoolJob = "spool";
constexpr const char* kThresholdJob = "threshold";
constexpr const char* kIndexJob = "index";

constexpr const char* kSampleJob = "sample/";
constexpr const char* kTileJob = "tile/";

// Each job without what it needs.
TileJob spool_job(const TileJobsPlan& plan) {
    return {TileJob::Kind::kSpool, {}, kSpoolJob, {}, plan.copy};
}
TileJob sample_job(int row) {
    return {TileJob::Kind::kSample, {0, 0, row}, cat(kSampleJob, row), {}, sample_file(row)};
}
TileJob threshold_job() {
    return {TileJob::Kind::kThreshold, {}, kThresholdJob, {}, kThresholdFile};
}
TileJob tile_job(const TileName& tile) {
    return {TileJob::Kind::kTile, tile, kTileJob + tile_text(tile), {}, tile_record(tile)};
}
TileJob index_job() {
    return {TileJob::Kind::kIndex, {}, kIndexJob, {}, kIndexFile};
}

TileJob after(TileJob job, std::vector<std::string> needs) {
    job.needs = std::move(needs);
    return job;
}

// The inverse of tile_text(); nothing for a text that it never gives.
std::optional<TileName> tile_named(const std::string& text) {
    try {
        return tile_from_text(text);
    } catch (const Error&) {
        return {};
    }
}

}  // namespace

std::string spool_file(const std::string& key) {
    return cat(kWorkFolder, "/source-", key.substr(0, 16));
}
std::string sample_file(int row) {
    return cat(kWorkFolder, "/sample/", row, ".json");
}

std::vector<TileJob> tile_jobs(const TileJobsPlan& plan) {
    std::vector<TileJob> jobs;
    std::vector<std::string> first;  // what reading pixels needs
    if (!plan.copy.empty()) {
        jobs.push_back(spool_job(plan));
        first = {kSpoolJob};
    }
    if (plan.first_pass) {
        std::vector<std::string> samples;
        for (int row = 0; row < plan.grid.rows(0); ++row) {
            jobs.push_back(after(sample_job(row), first));
            samples.push_back(jobs.back().name);
        }
        jobs.push_back(after(threshold_job(), std::move(samples)));
        first.push_back(kThresholdJob);
    }
    std::vector<std::string> all;
    const auto add_tile = [&](const TileName& tile, std::vector<std::string> needs) {
        jobs.push_back(after(tile_job(tile), std::move(needs)));
        all.push_back(jobs.back().name);
    };
    // A coarser tile follows its last child, so that little is left to do at the end.
    for (const TileName& finest : plan.grid.tiles(0)) {
        add_tile(finest, first);
        for (TileName child = finest; child.level + 1 < plan.grid.levels();) {
            const TileName parent = plan.grid.parent(child);
            const std::vector<TileName> children = plan.grid.children(parent);
            if (children.back() != child) break;
            std::vector<std::string> needs;
            for (const TileName& part : children) needs.push_back(tile_job(part).name);
            add_tile(parent, std::move(needs));
            child = parent;
        }
    }
    jobs.push_back(after(index_job(), std::move(all)));
    return jobs;
}

std::optional<TileJob> find_job(const TileJobsPlan& plan, const std::string& name) {
    if (name == kSpoolJob && !plan.copy.empty()) return spool_job(plan);
    if (name == kThresholdJob && plan.first_pass) return threshold_job();
    if (name == kIndexJob) return index_job();
    // A row is the name of a tile of column 0.
    if (name.starts_with(kSampleJob) && plan.first_pass)
        if (const auto tile = tile_named("0/0_" + name.substr(std::strlen(kSampleJob)));
            tile && plan.grid.contains(*tile))
            return sample_job(tile->row);
    if (name.starts_with(kTileJob))
        if (const auto tile = tile_named(name.substr(std::strlen(kTileJob)));
            tile && plan.grid.contains(*tile))
            return tile_job(*tile);
    return {};
}

}  // namespace imgmesh

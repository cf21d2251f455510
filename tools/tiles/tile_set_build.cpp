#include "tools/tiles/tile_set_build.h"

#include <nlohmann/json.hpp>
#include <ostream>

#include "formats/tileset/tile_set_files.h"
#include "libcore/base/stopwatch.h"
#include "libcore/tiles/density.h"
#include "tools/common/output.h"
#include "tools/common/text.h"
#include "tools/tiles/old_set.h"
#include "tools/tiles/tile_jobs.h"
#include "tools/tiles/tile_plan.h"
#include "tools/tiles/tile_work.h"

namespace imgmesh {
namespace {

// One process does all jobs in their order, which reads the picture by rows of tiles.
class TileSetRun {
  public:
    TileSetRun(const BuildOptions& options, Context& context)
        : options_(options), context_(context), planned_(plan_tile_set(options, context)) {}

    Report run() {
        Stopwatch watch;
        if (!options_.tiles.job.empty()) return do_one(options_.tiles.job);
        make_folder(options_.output);
        removed_ = make_way(options_.output, planned_.plan, context_.overwrite, context_.warnings);
        write_plan(options_.output, planned_.plan);
        if (options_.tiles.plan) return plan_report(planned_, options_);
        TileWork work(planned_, options_, context_);
        const std::vector<TileJob> jobs = tile_jobs(planned_.jobs);
        double all = 0, done = 0;
        for (const TileJob& job : jobs) all += job_pixels(job);
        for (const TileJob& job : jobs) {
            // The first job that reads pixels makes the copy. Where all is done, none does.
            if (job.kind == TileJob::Kind::kSpool) continue;
            const double own = job_pixels(job);
            const bool made = work.run(job, [&, done, all](double fraction, std::string_view stage) {
                context_.progress(all > 0 ? (done + own * fraction) / all : 0, cat(job.name, ' ', stage));
            });
            // What an earlier run did tells nothing of the speed of this one.
            if (made)
                done += own;
            else
                all -= own;
        }
        const TileSetIndex index = read_index(options_.output);
        tell_missing(index);
        return with_files(set_report(index, work, watch.lap()));
    }

  private:
    // Returns the work of a job, in pixels of level 0 whose tile takes as long.
    double job_pixels(const TileJob& job) const {
        // Measured: a picture of 1536 x 1024 pixels in tiles of 512.
        constexpr double kSampled = 0.7, kCoarse = 0.4;
        const TileGrid& grid = planned_.jobs.grid;
        const auto area = [](const PixelRect& rect) {
            return static_cast<double>(rect.width()) * rect.height();
        };
        if (job.kind == TileJob::Kind::kSample) {
            double sampled = 0;
            for (const SampledPart& part : sampled_parts(grid, job.tile.row, planned_.common.density))
                sampled += kSampled * area(part.pixels);
            return sampled;
        }
        if (job.kind != TileJob::Kind::kTile) return 0;
        return job.tile.level == 0 ? area(grid.rect(job.tile)) : kCoarse * grid.step() * grid.step();
    }

    Report with_files(Report report) const {
        Report all = {{"input", options_.input}, {"output", options_.output}};
        all.update(report);
        return all;
    }

    void tell_missing(const TileSetIndex& index) {
        for (const MissingTile& missing : index.missing)
            context_.failures.push_back(
                {ExitCode::kBadFile,
                 cat(options_.input, ": tile ", tile_text(missing.tile), " is missing: ", missing.reason)});
    }

    Report set_report(const TileSetIndex& index, const TileWork& work, double seconds) const {
        Report levels = Report::array();
        for (int level = 0; level < planned_.jobs.grid.levels(); ++level) {
            const TileTotals totals = level_totals(index, level);
            levels.push_back({{"tiles", totals.tiles},
                              {"vertices", totals.vertices},
                              {"own_vertices", totals.own_vertices},
                              {"faces", totals.faces},
                              {"bytes", totals.bytes}});
        }
        const TileTotals finest = level_totals(index, 0);
        const double pixels = static_cast<double>(index.plan.width) * index.plan.height;
        Report report = {{"width", index.plan.width},
                         {"height", index.plan.height},
                         {"tile", index.plan.tile},
                         {"wanted_density", index.plan.density},
                         {"threshold", index.threshold},
                         {"density", 100 * static_cast<double>(finest.own_vertices) / pixels},
                         {"map_rms", finest.map_rms},
                         {"gouraud_rms", finest.gouraud_rms},
                         {"seam_rms", finest.seam_rms},
                         {"levels", levels},
                         {"made", work.made()},
                         {"kept", work.kept()},
                         {"missing", index.missing.size()},
                         {"seconds", seconds}};
        if (removed_ > 0) report["removed"] = removed_;
        return report;
    }

    Report do_one(const std::string& name) {
        if (plan_key(plan_of_jobs(options_)) != plan_key(planned_.plan))
            throw Error(
                ErrorKind::kBadArgument,
                cat("--job ", name, ": ", options_.output,
                    " was planned for another picture or with other options; --plan makes a new plan"));
        const std::optional<TileJob> job = find_job(planned_.jobs, name);
        if (!job)
            throw Error(ErrorKind::kBadArgument,
                        cat("--job ", name, ": the tile set has no such job; --plan prints their names"));
        Stopwatch watch;
        TileWork work(planned_, options_, context_);
        const bool made = work.run(*job, context_.progress);
        if (job->kind == TileJob::Kind::kIndex) tell_missing(read_index(options_.output));
        return with_files({{"job", name}, {"made", made}, {"seconds", watch.lap()}});
    }

    const BuildOptions& options_;
    Context& context_;
    PlannedTileSet planned_;
    std::int64_t removed_ = 0;
};

}  // namespace

void print_tile_set(const Report& report, std::ostream& out) {
    if (report.contains("jobs")) {
        for (const Report& job : report["jobs"]) out << job["name"].get<std::string>() << '\n';
        return;
    }
    out << printable_line(report["input"].get<std::string>() + " -> " + report["output"].get<std::string>())
        << '\n';
    const auto number = [&](const char* key) { return format_number(report[key].get<double>()); };
    TextTable table;
    if (report.contains("job")) {
        table.add("job", cat(report["job"].get<std::string>(), report["made"] ? "" : ", done before"));
        table.print(out, 2);
        return;
    }
    const Report& finest = report["levels"].front();
    std::uint64_t bytes = 0, tiles = 0;
    for (const Report& level : report["levels"]) {
        bytes += level["bytes"].get<std::uint64_t>();
        tiles += level["tiles"].get<std::uint64_t>();
    }
    table.add("size", cat(report["width"], " x ", report["height"], " pixels"));
    table.add("tiles", cat(finest["tiles"], " of ", report["tile"], " pixels, ", tiles, " with those of all ",
                           report["levels"].size(), " levels"));
    table.add("meshes", cat(finest["own_vertices"], " vertices, ", finest["faces"], " faces, ",
                            number("density"), " % of the pixels"));
    table.add("error", cat("map ", number("map_rms"), ", at seams ", number("seam_rms"), ", Gouraud ",
                           number("gouraud_rms"), " L*u*v* RMS"));
    table.add("files", format_bytes(bytes));
    if (report["kept"] != 0)
        table.add("kept", cat(report["kept"], " of these ", tiles, ", made by an earlier run"));
    if (report.contains("removed"))
        table.add("removed", cat(report["removed"], " files of tiles of the set that was there before"));
    if (report["missing"] != 0) table.add("missing", cat(report["missing"], " tiles"));
    table.add("time", cat(number("seconds"), " s"));
    table.print(out, 2);
}

Report build_tile_set(const BuildOptions& options, Context& context) {
    return TileSetRun(options, context).run();
}

}  // namespace imgmesh

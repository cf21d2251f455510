#include "tools/tiles/tile_plan.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>

#include "formats/files/sha256.h"
#include "formats/picture/region_source.h"
#include "formats/tileset/tile_set_files.h"
#include "libcore/pipeline/param_table.h"
#include "tools/common/names.h"
#include "tools/tiles/tile_memory.h"

namespace fs = std::filesystem;

namespace imgmesh {
namespace {

std::string option_text(std::string_view name, std::string_view value) {
    return cat("--", name, value.empty() ? "" : " ", value);
}

// Returns what tells whether a picture is still the same, without reading all of it. One that another program
// moves to another folder is.
TileSource source_of(const std::string& path, const ReadImageOptions& read) {
    TileSource source{path, 0, ""};
    const std::vector<std::string> files = picture_files(path, read);
    std::string stamps;
    for (const std::string& file : files) {
        std::error_code is_not_there;
        const std::uintmax_t bytes = fs::file_size(file, is_not_there);
        const fs::file_time_type time = fs::last_write_time(file, is_not_there);
        if (!is_not_there) source.bytes += bytes;
        stamps += is_not_there ? "none\n" : cat(bytes, ' ', time.time_since_epoch().count(), '\n');
    }
    if (files.size() == 1)
        source.stamp = cat(fs::last_write_time(files.front()).time_since_epoch().count());
    else
        source.stamp =
            sha256_hex(std::span(reinterpret_cast<const std::uint8_t*>(stamps.data()), stamps.size()));
    return source;
}

double wanted_vertices(const BuildParams& params, double pixels) {
    const StopParams& stop = params.stop;
    if (stop.vertices) return static_cast<double>(*stop.vertices);
    // Almost all vertices are inside, where there are two faces for each.
    if (stop.faces) return static_cast<double>(*stop.faces) / 2;
    return stop.error ? 0 : pixels * stop.density / 100;
}

// What shapes the tiles beside the picture: by it a run knows which tiles of an earlier one it can keep.
std::vector<std::pair<std::string, std::string>> parameters_of(const BuildOptions& o,
                                                               const PlannedTileSet& planned) {
    std::vector<std::pair<std::string, std::string>> all;
    for (const Param& param : param_table())
        if (std::string value = value_text(param, planned.params); !value.empty())
            all.emplace_back(param.name, std::move(value));
    all.emplace_back("alpha", name_of(alpha_choices(), planned.mask.alpha));
    all.emplace_back("alpha-threshold", cat(planned.mask.threshold));
    if (!o.mask.empty()) {
        const TileSource mask = source_of(o.mask, {});
        all.emplace_back("mask", cat(mask.bytes, ' ', mask.stamp));
    }
    if (o.read.color_space) all.emplace_back("color-space", color_space_name(*o.read.color_space));
    if (o.read.part) all.emplace_back("part", *o.read.part);
    if (o.read.layer) all.emplace_back("layer", *o.read.layer);
    if (o.read.nodata) all.emplace_back("nodata", cat(*o.read.nodata));
    if (planned.read.fitting_space)
        all.emplace_back("fitting-space", color_space_name(*planned.read.fitting_space));
    all.emplace_back("light", planned.common.space.gamut == Gamut::kHdr ? "hdr" : "display");
    all.emplace_back("layers", name_of(layer_choices(), tile_layers(o)));
    ContainerOptions container;
    compress(container, o.compression, DracoMode::kEdgebreaker);
    all.emplace_back("draco", name_of(draco_choices(), container.draco));
    return all;
}

std::optional<std::string> planned_before(const BuildOptions& o, std::string_view name) {
    if (o.tiles.job.empty()) return {};
    for (const auto& [key, value] : plan_of_jobs(o).parameters)
        if (key == name) return value;
    return {};
}

// Whether a picture of floats has colours above 1. All of it must be read, once. Of a broken block the tile
// says so when it is built.
Gamut gamut_of_all(const BuildOptions& o, const TilePixels& pixels, const MaskChoice& choice) {
    if (const std::optional<std::string> before = planned_before(o, "light"))
        return *before == "hdr" ? Gamut::kHdr : Gamut::kDisplay;
    const SampleType type = pixels.facts().sample_type;
    if (type != SampleType::kHalf && type != SampleType::kFloat) return Gamut::kDisplay;
    Gamut gamut = Gamut::kDisplay;
    pixels.sweep([&](const PixelRect& rect) {
        const PixelPart part = pixels.read(rect, choice);
        gamut = gamut_of(part.image, part.mask);
        return gamut == Gamut::kDisplay;
    });
    return gamut;
}

// An image with the channels of the picture: what they are to a build does not depend on the pixels.
Image image_like(const PictureFacts& facts) {
    Image image = make_image(2, 2, static_cast<int>(facts.channel_names.size()));
    image.channel_names = facts.channel_names;
    image.sample_type = facts.sample_type;
    return image;
}

// The image of floats, and as much again while it is read.
double whole_bytes(const PictureFacts& facts) {
    return 2.0 * sizeof(float) * static_cast<double>(facts.channel_names.size()) * facts.width * facts.height;
}

// What becomes of alpha must not depend on the tile.
AlphaUse alpha_of_all(const BuildOptions& o, bool has_alpha, Context& context) {
    if (!has_alpha) return AlphaUse::kIgnore;
    if (o.alpha.use != AlphaUse::kAuto) return o.alpha.use;
    if (!o.mask.empty()) return AlphaUse::kIgnore;
    context.warnings.push_back(cat(o.input,
                                   ": its alpha cuts it, as no tile knows whether all of it is soft; ",
                                   "--alpha keep keeps it as a channel"));
    return AlphaUse::kCut;
}

// Errors of readers have a file's name, others get that of the picture.
template <class Work>
auto in_input(const BuildOptions& o, const Work& work) {
    try {
        return work();
    } catch (const Error& error) {
        const std::string text = error.what();
        for (const std::string& name : {o.input, o.mask, o.output})
            if (!name.empty() && text.starts_with(name)) throw;
        throw Error(error.kind(), cat(o.input, ": ", text));
    }
}

}  // namespace

TileSetPlan plan_of_jobs(const BuildOptions& o) {
    if (!fs::exists(in_set(o.output, kPlanFile)))
        throw Error(ErrorKind::kIo, cat(o.output, ": has no plan for --job ", o.tiles.job,
                                        "; --plan in its place makes one"));
    return read_plan(o.output);
}

LayerLayout tile_layers(const BuildOptions& o) {
    return o.compression.layers.value_or(LayerLayout::kCompact);
}

PlannedTileSet plan_tile_set(const BuildOptions& o, Context& context) {
    return in_input(o, [&] {
        ReadImageOptions read = o.read;
        read.channels = channels_to_read(o.params, false);
        const RegionSource source(o.input, read);
        const PictureFacts& facts = source.facts();
        for (const std::string& warning : facts.warnings)
            context.warnings.push_back(cat(o.input, ": ", warning));
        if (facts.width < 2 || facts.height < 2)
            throw Error(ErrorKind::kUnsupported, cat(facts.width, "x", facts.height,
                                                     " pixels have no tiles; without --tiles they become one "
                                                     "container"));
        const TileGrid grid(facts.width, facts.height, *o.tiles.size);
        PlannedTileSet planned{.plan = {}, .jobs = {grid}};
        if (facts.fits_colors) {
            const std::optional<std::string> before = planned_before(o, "fitting-space");
            read.fitting_space = before ? parse_color_space(*before) : source.color_space();
        }
        planned.read = read;
        planned.mask.alpha = alpha_of_all(o, std::ranges::count(facts.channel_names, "A") > 0, context);
        // Alpha that is kept masks what nobody sees.
        const bool keeps = planned.mask.alpha == AlphaUse::kKeep && o.mask.empty();
        planned.mask.threshold = o.alpha.threshold.value_or(keeps ? double{kVisibleAlpha} : 0.5);
        AlphaParams alpha{planned.mask.alpha, planned.mask.threshold};
        const Image like = image_like(facts);
        const SourcePlan taken = plan_source(like, alpha, !o.mask.empty(), o.params, option_text);
        for (const std::string& warning : taken.warnings)
            context.warnings.push_back(cat(o.input, ": ", warning));
        planned.params = taken.params;
        check_tile_params(planned.params);
        const double pixels = static_cast<double>(facts.width) * facts.height;
        planned.vertices = wanted_vertices(planned.params, pixels);
        planned.jobs.first_pass = planned.vertices > 0;
        const TilePixels whole(o.input, o.mask, read);
        planned.common.space = tile_space(like, planned.params, gamut_of_all(o, whole, planned.mask));
        planned.common.sample_type = facts.sample_type;
        const double side = *o.tiles.size + 1.0;
        planned.common.density = planned.vertices > 0 ? 100 * planned.vertices / pixels : 1;
        const double held = std::min<double>(side, facts.width) * std::min<double>(side, facts.height);
        if (facts.access == RegionAccess::kWhole) {
            planned.whole_bytes = whole_bytes(facts);
            constexpr double kMuch = 1 << 22;  // pixels; of less nobody minds
            if (pixels > kMuch)
                context.warnings.push_back(cat(o.input, ": ", facts.why,
                                               ", so every process holds all of it; of a tiled TIFF or EXR "
                                               "it would read parts"));
        }
        context.memory.take(cat("a tile of ", *o.tiles.size, " pixels",
                                planned.whole_bytes > 0 ? " and the picture, which is read as a whole" : ""),
                            tile_bytes(held, planned.common.density / 100) + planned.whole_bytes);
        planned.plan = {.generator = context.generator,
                        .source = source_of(o.input, read),
                        .width = facts.width,
                        .height = facts.height,
                        .tile = *o.tiles.size,
                        .parameters = {},
                        .density = planned.jobs.first_pass ? planned.common.density : 0,
                        .threshold = {}};
        planned.plan.parameters = parameters_of(o, planned);
        planned.picture = o.input;
        if (facts.access == RegionAccess::kSpool) {
            planned.jobs.copy = spool_file(plan_key(planned.plan));
            planned.picture = in_set(o.output, planned.jobs.copy);
        }
        return planned;
    });
}

Report plan_report(const PlannedTileSet& planned, const BuildOptions& o) {
    // Measured: docs/scale.md.
    constexpr double kSecondsOfMegapixel = 3, kStartSeconds = 2;
    const TileGrid& grid = planned.jobs.grid;
    std::vector<std::string> base;
    for (std::size_t i = 0; i < o.tiles.command.size(); ++i) {
        const std::string& word = o.tiles.command[i];
        if (word != "--plan" && word != "--json" && word != "--jsonl") base.push_back(word);
    }
    Report jobs = Report::array();
    for (const TileJob& job : tile_jobs(planned.jobs)) {
        std::vector<std::string> command = base;
        command.insert(command.end(), {"--job", job.name});
        double pixels = 0;
        switch (job.kind) {
            case TileJob::Kind::kSpool:
                pixels = 0.02 * grid.width() * grid.height();
                break;
            case TileJob::Kind::kSample:
                pixels = static_cast<double>(grid.width()) * grid.step() / 4;
                break;
            case TileJob::Kind::kTile: {
                const PixelRect rect = grid.rect(job.tile);
                pixels = job.tile.level > 0 ? 0.1 * grid.step() * grid.step()
                                            : static_cast<double>(rect.width()) * rect.height();
                break;
            }
            default:
                break;
        }
        const double held = std::min(pixels, static_cast<double>(grid.step() + 1) * (grid.step() + 1));
        jobs.push_back(
            {{"name", job.name},
             {"needs", job.needs},
             {"output", job.output},
             {"command", command},
             {"memory_mb",
              static_cast<int>((tile_bytes(held, planned.common.density / 100) + planned.whole_bytes) / 1e6) +
                  1},
             {"seconds", static_cast<int>(kStartSeconds + kSecondsOfMegapixel * pixels / 1e6) + 1}});
    }
    return {{"format", "imgmesh-tile-jobs"}, {"version", 1},          {"out", o.output},
            {"tile", grid.step()},           {"width", grid.width()}, {"height", grid.height()},
            {"levels", grid.levels()},       {"jobs", jobs}};
}

}  // namespace imgmesh

#include "tools/tiles/set_draw.h"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "formats/files/extension.h"
#include "formats/files/stream_file.h"
#include "formats/picture/image_io.h"
#include "formats/picture/tiled_tiff.h"
#include "formats/tileset/tile_set_files.h"
#include "libcore/base/error.h"
#include "libcore/image/feature_space.h"
#include "tools/common/numbers.h"
#include "tools/common/options.h"
#include "tools/common/output.h"
#include "tools/tiles/set_input.h"

namespace imgmesh {
namespace {

// A pixel of a tile takes this while the tile is read and drawn, and one of a whole picture while it is
// written [bytes].
constexpr double kTileBytes = 60, kPictureBytes = 26;

PixelRect meet(const PixelRect& a, const PixelRect& b) {
    return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right),
            std::min(a.bottom, b.bottom)};
}

bool is_empty(const PixelRect& rect) {
    return rect.width() <= 0 || rect.height() <= 0;
}

// Part of a picture, with the channels that are wanted: an alpha that it lacks is 1.
Image cut(const Image& image, const PixelRect& rect, int channels) {
    Image out = make_image(rect.width(), rect.height(), channels);
    out.sample_type = image.sample_type;
    out.color_space = image.color_space;
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            const float* const from = image.pixel(rect.left + x, rect.top + y);
            float* const to = out.pixel(x, y);
            for (int c = 0; c < channels; ++c) to[c] = c < image.channels ? from[c] : 1;
        }
    return out;
}

PixelRect checked_part(const SetDrawOptions& o, const GridSize& size) {
    const PixelRect part = o.crop.value_or(PixelRect{0, 0, size.width, size.height});
    if (part.right > size.width || part.bottom > size.height)
        throw Error(ErrorKind::kBadArgument,
                    cat("--crop: ends at ", part.right, ',', part.bottom, ", but level ", o.level, " of ",
                        o.input, " has ", size.width, "x", size.height, " pixels"));
    return part;
}

void check_mode(const SetDrawOptions& o, const std::string& mode_name) {
    if (o.mode != DrawMode::kMap && o.mode != DrawMode::kGouraud)
        throw Error(
            ErrorKind::kBadArgument,
            cat("--mode ", mode_name, ": a tile set is drawn as map or gouraud; ", single_tiles(o.input)));
}

// Returns the parts of a tile that it draws over those before it, in its own coordinates: on lines that it
// shares with these only its pixels inside the mask, one by one, and all others as one part.
std::vector<PixelRect> drawn_parts(const TileName& tile, const PixelMap& map) {
    const int left = tile.column > 0, top = tile.row > 0;
    std::vector<PixelRect> parts = {{left, top, map.width, map.height}};
    const auto add = [&](int x, int y) {
        if (map.at(x, y).face != kNone) parts.push_back({x, y, x + 1, y + 1});
    };
    for (int x = 0; top && x < map.width; ++x) add(x, 0);
    for (int y = top; left && y < map.height; ++y) add(0, y);
    return parts;
}

// Draws the tiles of a level into a picture, row by row; `put` gets each piece, `complete` the rows above
// which all is drawn.
void draw_tiles(const SetInput& set, const SetDrawOptions& o, const PixelRect& part, int channels,
                const std::function<void(int, int, const Image&)>& put,
                const std::function<void(int)>& complete, const Progress& progress) {
    const TileGrid grid = set.grid();
    for (int row = 0; row < grid.rows(o.level); ++row) {
        progress(0.1 + 0.8 * row / grid.rows(o.level), "draw");
        int bottom = 0;
        for (int column = 0; column < grid.columns(o.level); ++column) {
            const TileName tile{o.level, column, row};
            const PixelRect own = own_level_rect(grid, tile);
            bottom = std::min(own.bottom, part.bottom);
            const GridSize size = level_size(grid, tile);
            const PixelRect whole{own.left, own.top, own.left + size.width, own.top + size.height};
            if (is_empty(meet(whole, part))) continue;
            const MeshImage image = set.read(tile);
            if (image.levels.empty()) continue;
            const Image drawn = draw(image, 0, {*o.mode, 1});
            const PixelRect wanted{part.left - own.left, part.top - own.top, part.right - own.left,
                                   part.bottom - own.top};
            for (const PixelRect& each : drawn_parts(tile, image.levels[0].map)) {
                const PixelRect inside = meet(each, wanted);
                if (is_empty(inside)) continue;
                put(inside.left - wanted.left, inside.top - wanted.top, cut(drawn, inside, channels));
            }
        }
        if (bottom > part.top) complete(bottom - part.top);
    }
}

}  // namespace

PixelRect parse_crop(const std::string& name, const std::string& text) {
    const std::vector<std::string> items = split_list(text);
    constexpr std::int64_t kMost = 1 << 30;
    if (items.size() != 4)
        throw Error(ErrorKind::kBadArgument, cat(name, " '", text, "': expected X,Y,WIDTH,HEIGHT"));
    const auto number = [&](std::size_t i, std::int64_t least) {
        return static_cast<int>(parse_count(name, items[i], {least, kMost}));
    };
    const int x = number(0, 0), y = number(1, 0), width = number(2, 1), height = number(3, 1);
    return {x, y, static_cast<int>(std::min<std::int64_t>(kMost, std::int64_t{x} + width)),
            static_cast<int>(std::min<std::int64_t>(kMost, std::int64_t{y} + height))};
}

Report draw_set(const SetDrawOptions& o, const std::string& mode_name, Context& context) {
    check_mode(o, mode_name);
    check_output(o.output, context.overwrite);
    context.progress(0, "read");
    const SetInput set = open_set(o.input, o.level, o.limits, context);
    const TileGrid grid = set.grid();
    const SourceInfo source = set.source(o.level);
    if (split_names(source.channel_names).color.empty())
        throw Error(ErrorKind::kUnsupported, cat(o.input, ": has no colour to draw"));
    const PixelRect part = checked_part(o, level_size(grid, o.level));
    const auto& names = source.channel_names;
    const bool has_alpha = set.has_gaps() || std::ranges::find(names, "A") != names.end();

    PictureShape shape;
    shape.width = part.width();
    shape.height = part.height();
    shape.channels = has_alpha ? 4 : 3;
    shape.sample_type = source.sample_type;
    shape.color_space = source.gamut == Gamut::kHdr ? ColorSpace::kLinear : source.color_space;
    const double tile_pixels = double(grid.step() + 1) * (grid.step() + 1);
    const std::string extension = lower_extension(o.output);
    const bool streams = (extension == ".tif" || extension == ".tiff") && stream_descriptor(o.output) < 0;
    const double held = streams ? 4.0 * shape.channels * shape.width * (grid.step() + 256)
                                : kPictureBytes * shape.width * shape.height;
    context.memory.take(cat(o.input, ": a drawing of ", shape.width, "x", shape.height, " pixels",
                            streams ? "" : ", which only a .tif need not hold whole,"),
                        kProgramMemory + held + kTileBytes * tile_pixels);
    if (streams) {
        TiledTiff tiff(o.output, shape, o.depth, context.overwrite);
        draw_tiles(
            set, o, part, shape.channels, [&](int x, int y, const Image& piece) { tiff.put(x, y, piece); },
            [&](int bottom) { tiff.complete(bottom); }, context.progress);
        tiff.complete(shape.height);
        tiff.commit();
    } else {
        Image image = make_image(shape.width, shape.height, shape.channels);
        image.sample_type = shape.sample_type;
        image.color_space = shape.color_space;
        draw_tiles(
            set, o, part, shape.channels,
            [&](int x, int y, const Image& piece) {
                for (int j = 0; j < piece.height; ++j)
                    std::copy_n(piece.pixel(0, j), piece.width * piece.channels, image.pixel(x, y + j));
            },
            [](int) {}, context.progress);
        write_image(o.output, image, {context.overwrite, o.depth, {}});
    }
    const TileTotals totals = level_totals(set.index, o.level);
    return {{"input", o.input},
            {"output", o.output},
            {"mode", mode_name},
            {"level", o.level},
            {"scale", 1},
            {"width", shape.width},
            {"height", shape.height},
            {"vertices", totals.own_vertices},
            {"faces", totals.faces},
            {"bytes", output_bytes(o.output)}};
}

}  // namespace imgmesh

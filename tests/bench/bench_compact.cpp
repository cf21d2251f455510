#include "tests/bench/bench_compact.h"

#include <algorithm>
#include <cmath>

#include "formats/compact/compact_layers.h"
#include "formats/picture/image_io.h"
#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/pipeline/build.h"
#include "libcore/pipeline/presets.h"
#include "tests/bench/usage_meter.h"

namespace imgmesh::bench {
namespace {

Displacements rounded_positions(const Level& level, int steps) {
    Displacements result;
    static_cast<GridSize&>(result) = level.map;
    result.steps = steps;
    for (std::size_t i = 0; i < level.map.size(); ++i) {
        const PixelCoord& c = level.map[i];
        const auto corner = [&](std::size_t k) { return level.mesh.position[level.mesh.faces[c.face][k]]; };
        const Vec2f at = (1 - c.u - c.v) * corner(0) + c.u * corner(1) + c.v * corner(2);
        const auto rounded = [&](float position, int pixel) {
            return static_cast<std::int16_t>(
                std::lround((position - static_cast<float>(pixel)) * static_cast<float>(steps)));
        };
        result.dx.push_back(rounded(at.x(), level.map.x_of(i)));
        result.dy.push_back(rounded(at.y(), level.map.y_of(i)));
    }
    return result;
}

// The stream has the coarsest steps that hold a map.
bool same_positions(const Displacements& read, const Displacements& written) {
    const int finer = written.steps / read.steps;
    const auto same = [&](std::int16_t a, std::int16_t b) { return a * finer == b; };
    return std::ranges::equal(read.dx, written.dx, same) && std::ranges::equal(read.dy, written.dy, same);
}

// The processor's seconds that `work` takes.
template <typename Work>
double seconds(const Work& work) {
    UsageMeter meter;
    work();
    const Usage usage = meter.stop();
    return usage.user_seconds + usage.system_seconds;
}

}  // namespace

CompactFigures measure_compact(const std::string& path, int steps, int repeats) {
    const Image image = read_image(path);
    const MeshImage built = build_mesh_image(image, preset_params("default")).mesh_image;
    std::vector<CompactPart> parts(1);
    parts[0].name = "lod0";
    parts[0].map = rounded_positions(built.levels.front(), steps);
    const ExpectedLayers expected{image.width, image.height, {"lod0"}, {}, false};
    const ThreadLimit one(1);
    double encode = 1e9, decode = 1e9;
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i < repeats; ++i) {
        std::vector<CompactPart> read;
        encode = std::min(encode, seconds([&] { bytes = encode_compact_layers(parts); }));
        decode = std::min(decode, seconds([&] { read = decode_compact_layers(bytes, expected); }));
        if (!same_positions(read[0].map, parts[0].map))
            throw Error(ErrorKind::kInternal, "the displacements read are not those written");
    }
    const auto pixels = static_cast<double>(image.pixel_count());
    return {8 * static_cast<double>(bytes.size()) / pixels, pixels / encode / 1e6, pixels / decode / 1e6};
}

}  // namespace imgmesh::bench

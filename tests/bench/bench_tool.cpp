// What ./run bench needs of C++: images of any size, the stages of a build in one process, and the side of
// the comparison with other simplifiers that is ours.
//
//     bench-tool mosaic SIDE OUT.png PICTURE...    SIDE x SIDE pixels: the images in turns, mirrored
//     bench-tool stages PICTURE FOLDER PRESET DENSITY THREADS REPEATS   JSON: a row for every stage
//     bench-tool compact PICTURE STEPS REPEATS     JSON: bits and speed of the compact stream
//     bench-tool features PICTURE OUT              what a simplifier gets (raw_files.h)
//     bench-tool measure FEATURES MESH             JSON: the error of the mesh that it gives back
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/picture/image_io.h"
#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/image/feature_space.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/metrics/metrics.h"
#include "libcore/param/fit_colors.h"
#include "libcore/pipeline/presets.h"
#include "tests/bench/bench_compact.h"
#include "tests/bench/bench_stages.h"
#include "tests/bench/raw_files.h"
#include "tools/common/huge_pages.h"

using namespace imgmesh;
using namespace imgmesh::bench;
using Arguments = std::vector<std::string>;
using Json = nlohmann::ordered_json;

namespace {

int number(const std::string& text, int least, int most) {
    char* end = nullptr;
    const long value = std::strtol(text.c_str(), &end, 10);
    if (text.empty() || *end != '\0' || value < least || value > most)
        throw Error(ErrorKind::kBadArgument,
                    cat("'", text, "': expected a number from ", least, " to ", most));
    return static_cast<int>(value);
}

// Tiles repeat only every 2 x 2 images, and neighbours meet at equal colours: no seam to waste vertices on.
int mirrored(int at, int size) {
    const int within = at % (2 * size);
    return within < size ? within : 2 * size - 1 - within;
}

int mosaic(const Arguments& a) {
    const int side = number(a.at(0), 1, 16384);
    std::vector<Image> pictures;
    for (std::size_t i = 2; i < a.size(); ++i) {
        pictures.push_back(read_image(a[i]));
        if (pictures.back().channels != 3 || pictures.back().width != pictures.front().width ||
            pictures.back().height != pictures.front().height)
            throw Error(ErrorKind::kBadArgument, cat(a[i], ": expected RGB pictures of one size"));
    }
    if (pictures.empty()) throw Error(ErrorKind::kBadArgument, "mosaic: expected a picture");
    const int width = pictures.front().width, height = pictures.front().height;
    Image out = make_image(side, side, 3);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const auto which = static_cast<std::size_t>(x / width + y / height) % pictures.size();
            const float* from = pictures[which].pixel(mirrored(x, width), mirrored(y, height));
            std::copy_n(from, 3, out.pixel(x, y));
        }
    write_image(a.at(1), out);
    return 0;
}

BuildParams params_of(const std::string& preset, const std::string& density) {
    BuildParams params = preset_params(preset);
    params.stop.density = std::strtod(density.c_str(), nullptr);
    return params;
}

int stages(const Arguments& a) {
    const ThreadLimit limit(number(a.at(4), 1, 1024));
    Json rows = Json::array();
    for (const StageRow& row :
         measure_stages(a.at(0), a.at(1), params_of(a.at(2), a.at(3)), number(a.at(5), 1, 1000))) {
        rows.push_back({{"stage", row.stage},
                        {"user_seconds", row.usage.user_seconds},
                        {"system_seconds", row.usage.system_seconds},
                        {"wall_seconds", row.usage.wall_seconds},
                        {"peak_mib", row.usage.peak_mib}});
        if (row.rms >= 0) rows.back()["rms"] = row.rms;
    }
    std::cout << rows.dump(2) << '\n';
    return 0;
}

int compact(const Arguments& a) {
    const CompactFigures figures = measure_compact(a.at(0), number(a.at(1), 8, 32), number(a.at(2), 1, 1000));
    std::cout << Json{{"bits_per_pixel", figures.bits_per_pixel},
                      {"encode_megapixels", figures.encode_megapixels},
                      {"decode_megapixels", figures.decode_megapixels}}
                     .dump(2)
              << '\n';
    return 0;
}

int features(const Arguments& a) {
    const Image image = read_image(a.at(0));
    write_features(a.at(1), extract_features(image, feature_space(image, {})));
    return 0;
}

int measure(const Arguments& a) {
    const FeatureImage feature = read_features(a.at(0));
    BaseMesh mesh = read_mesh(a.at(1));
    const MeshQuality quality = mesh_quality(mesh);
    const PixelMap map = trivial_map(mesh, feature.width, feature.height);
    const auto uncovered =
        std::count_if(map.begin(), map.end(), [](const PixelCoord& c) { return c.face == kNone; });
    Json out = {{"vertices", mesh.vertex_count()},
                {"uncovered_pixels", uncovered},
                {"mean_edge_ratio", quality.mean_edge_ratio},
                {"mean_shape", quality.mean_shape},
                {"gouraud_rms", map_rms(mesh, map, feature)}};
    fit_colors(mesh, feature, {{&map, 1}}, {});
    out["refitted_rms"] = map_rms(mesh, map, feature);
    std::cout << out.dump(2) << '\n';
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    use_huge_pages();  // as the tools do
    const std::map<std::string, std::function<int(const Arguments&)>> commands = {{"mosaic", mosaic},
                                                                                  {"stages", stages},
                                                                                  {"compact", compact},
                                                                                  {"features", features},
                                                                                  {"measure", measure}};
    const auto at = argc > 1 ? commands.find(argv[1]) : commands.end();
    if (at == commands.end()) {
        std::fputs("usage: bench-tool mosaic | stages | compact | features | measure ARGUMENTS\n", stderr);
        return 2;
    }
    try {
        return at->second(Arguments(argv + 2, argv + argc));
    } catch (const Error& e) {
        std::fprintf(stderr, "bench-tool: error: %s\n", e.what());
        return 1;
    } catch (const std::out_of_range&) {
        std::fprintf(stderr, "bench-tool: error: %s: too few arguments\n", argv[1]);
        return 2;
    }
}

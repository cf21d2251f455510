// build-containers FOLDER PART PARTS: containers of small images with every preset, metric, solver and kind
// of map, as FOLDER/NAME.glb, and the contours and superpixels of two of them. Of all containers it writes
// those whose number leaves PART when divided by PARTS. Builds of it by other compilers, and without AVX2,
// write the same bytes (compare_builds.py).
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "formats/container/container.h"
#include "formats/export/contour_files.h"
#include "formats/export/label_files.h"
#include "formats/picture/image_io.h"
#include "libcore/pipeline/build.h"
#include "libcore/pipeline/presets.h"
#include "libcore/segment/contour_map.h"
#include "libcore/segment/segment.h"

using namespace imgmesh;

namespace {

// Odd sides, so that rows end in lanes of vectors that are not full.
constexpr int kWidth = 131, kHeight = 97;

Image make_photo() {
    const Image whole = read_image(IMGMESH_TEST_DATA "/kodim23.png");
    Image photo = make_image(kWidth, kHeight, 3);
    for (int y = 0; y < kHeight; ++y)
        std::copy_n(whole.pixel(200, 100 + y), photo.row_size(), photo.pixel(0, y));
    return photo;
}

Image green_of(const Image& photo) {
    Image gray = make_image(kWidth, kHeight, 1);
    for (std::size_t i = 0; i < gray.data.size(); ++i) gray.data[i] = photo.pixel(i)[1];
    return gray;
}

// An ellipse with a round hole.
Mask make_mask() {
    const auto inside = [](double x, double y, double rx, double ry) {
        return x * x / (rx * rx) + y * y / (ry * ry) <= 1;
    };
    Mask mask(GridSize{kWidth, kHeight});
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            mask.values[mask.index(x, y)] =
                inside(x - 64, y - 48, 58, 43) && !inside(x - 55, y - 49.5, 16, 16.5);
    return mask;
}

struct Case {
    std::string name;
    const Image* image;
    BuildParams params = {};
    Mask mask = {};
    DracoMode draco = DracoMode::kEdgebreaker;
};

std::vector<Case> make_cases(const Image& photo, const Image& gray) {
    std::vector<Case> cases;
    for (const Preset& preset : presets())
        cases.push_back({"preset-" + std::string(preset.name), &photo, preset.params});
    for (const Metric metric : {Metric::kFlattened, Metric::kHoppe, Metric::kGarland})
        for (const Solver solver : {Solver::kSvd, Solver::kLu, Solver::kClosed}) {
            BuildParams params;
            params.metric = metric;
            params.solver = solver;
            params.refine = 0;
            const std::string solvers[] = {"closed", "svd", "lu"};
            cases.push_back(
                {std::string(metric_name(metric)) + "-" + solvers[static_cast<int>(solver)], &photo, params});
        }
    // Adds a case with the defaults, and returns it to be changed.
    const auto add = [&](const std::string& name, const Image& image) -> Case& {
        return cases.emplace_back(Case{name, &image});
    };
    Case& masked = add("mask", photo);
    masked.mask = make_mask();
    masked.params.stop.density = 3;
    Case& levels = add("mask-levels", photo);
    levels.mask = make_mask();
    levels.params.levels.count = 3;
    add("gray", gray);
    add("rebuilt", photo).params.rebuild_quadrics = true;
    Case& tracked = add("tracked", photo);
    tracked.params.map = MapKind::kTracked;
    tracked.params.visits = true;
    Case& rgb = add("rgb-exchange", photo);
    rgb.params.objective = Objective::kRgb;
    rgb.params.exchange = 0.02;
    add("rms", photo).params.stop.rms = 6;
    add("channels", gray).params.channels = {{"Y", 20}};
    Case& plain = add("plain", photo);
    plain.draco = DracoMode::kOff;
    plain.params.bary = WeightPrecision::kFloat;
    return cases;
}

// The heights of all contours, and superpixels, as arrays.
void write_regions(const std::filesystem::path& folder, const std::string& name, const Level& level) {
    const FeatureImage picture = reconstruct_luv(level);
    const Segmentation contours = segment(level, picture, {});
    const ContourMap map = contour_map(contours.cells, contours.hierarchy);
    write_contours((folder / (name + "-contours.npy")).string(), map.width, map.height, map.values, 1, false);
    SegmentParams params;
    params.superpixels = 150;
    const LabelImage labels = segment(level, picture, params).labels;
    write_labels((folder / (name + "-superpixels.npy")).string(), labels.width, labels.height, labels.values,
                 false);
}

void write_part(const std::filesystem::path& folder, std::size_t part, std::size_t parts) {
    const Image photo = make_photo(), gray = green_of(photo);
    std::vector<Case> cases = make_cases(photo, gray);
    for (std::size_t i = part; i < cases.size(); i += parts) {
        Case& c = cases[i];
        const BuildResult result = build_mesh_image(*c.image, c.params, {}, std::move(c.mask));
        write_container((folder / (c.name + ".glb")).string(), result.mesh_image, {.draco = c.draco});
        if (c.name == "preset-default" || c.name == "mask")
            write_regions(folder, c.name, result.mesh_image.levels[0]);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const int parts = argc == 4 ? std::atoi(argv[3]) : 0;
    if (parts <= 0) {
        std::fputs("usage: build-containers FOLDER PART PARTS\n", stderr);
        return 2;
    }
    try {
        write_part(argv[1], static_cast<std::size_t>(std::atoi(argv[2])), static_cast<std::size_t>(parts));
    } catch (const std::exception& e) {
        std::fprintf(stderr, "build-containers: %s\n", e.what());
        return 1;
    }
    return 0;
}

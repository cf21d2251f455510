// How well and how fast coded meshes are optimised on their grid: PSNR of the drawing with colours that are
// not quantised, and seconds of CPU. Prints a line of JSON.
//
//     coding-bench PICTURE VERTICES STEP [EFFORT [FIELD=VALUE...]]
//
// STEP is that of the grid in quarter pixels. Fields are those of libcore/optimize/grid_schedule.h.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <set>
#include <utility>

#include "formats/picture/image_io.h"
#include "libcore/optimize/grid_optimizer.h"
#include "libcore/optimize/grid_schedule.h"

using namespace imgmesh;

namespace {

double cpu_seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void change(GridSchedule& schedule, const char* field) {
    const char* value = std::strchr(field, '=');
    if (!value) return;
    const std::string name(field, value);
    const double number = std::atof(value + 1);
    const std::pair<const char*, int*> whole[] = {
        {"settles", &schedule.settles}, {"rounds", &schedule.rounds}, {"sweeps", &schedule.sweeps},
        {"trials", &schedule.trials},   {"passes", &schedule.passes}, {"last_rounds", &schedule.last_rounds}};
    for (const auto& [key, to] : whole)
        if (name == key) *to = static_cast<int>(number);
    const std::pair<const char*, double*> real[] = {{"share", &schedule.share},
                                                    {"temperature", &schedule.temperature},
                                                    {"last_temperature", &schedule.last_temperature},
                                                    {"spread", &schedule.spread},
                                                    {"last_spread", &schedule.last_spread},
                                                    {"last_share", &schedule.last_share}};
    for (const auto& [key, to] : real)
        if (name == key) *to = number;
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc < 4) {
        std::fprintf(stderr, "coding-bench PICTURE VERTICES STEP [EFFORT [FIELD=VALUE...]]\n");
        return 2;
    }
    Image image = read_image(argv[1]);
    for (float& sample : image.data) sample *= 255;
    const auto vertices = static_cast<std::size_t>(std::atoi(argv[2]));
    OptimizeParams params;
    if (argc > 4) params.effort = std::atoi(argv[4]);
    GridSchedule schedule = grid_schedule(params.effort);
    for (int i = 5; i < argc; ++i) change(schedule, argv[i]);

    params.step = std::atoi(argv[3]) * kPlacesPerPixel / 4;
    const double begin = cpu_seconds();
    const RowSums sums(image);
    GridOptimizer optimizer(sums, regular_mesh(sums, params.step, vertices / 4), params);
    optimizer.set_vertex_count(vertices);
    const auto psnr = [&] {
        const double samples = static_cast<double>(image.data.size());
        return 10 * std::log10(255.0 * 255.0 * samples / optimizer.squared_error());
    };
    const double started = cpu_seconds(), start_psnr = psnr();
    optimizer.optimize(schedule);
    const double end = cpu_seconds();
    std::printf(
        "{\"vertices\": %zu, \"start_s\": %.2f, \"start_db\": %.3f, \"optimize_s\": %.2f, \"db\": "
        "%.3f}\n",
        optimizer.vertices(), started - begin, start_psnr, end - started, psnr());
    return 0;
} catch (const std::exception& e) {
    std::fprintf(stderr, "coding-bench: %s\n", e.what());
    return 1;
}

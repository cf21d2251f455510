// How fast pixel maps follow from displacements, and displacements from maps, on one thread, as CPU time; the
// results are checked. Prints one JSON object.
//
//     locate-bench [REPEATS]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <random>

#include "libcore/base/parallel.h"
#include "libcore/mesh/locate_map.h"
#include "tests/support/meshes.h"

using namespace imgmesh;

namespace {

constexpr int kSide = 1024, kSteps = 16;

double cpu_seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Million pixels in a second, the most of several runs: the others measure what else the machine does.
double speed_of(int repeats, const std::function<void()>& run) {
    double least = 1e300;
    for (int i = 0; i < repeats; ++i) {
        const double start = cpu_seconds();
        run();
        least = std::min(least, cpu_seconds() - start);
    }
    return kSide * kSide / least / 1e6;
}

[[noreturn]] void wrong(const char* what) {
    std::fprintf(stderr, "locate-bench: wrong result: %s\n", what);
    std::exit(1);
}

// Waves of a pixel, as a relaxed map has, and a step of noise.
Displacements waves() {
    std::mt19937 random(1);
    Displacements d;
    d.width = d.height = kSide;
    d.steps = kSteps;
    const auto moved = [&](int at, int along, int across) {
        const double wave = kSteps * std::sin(along / 9.0) * std::cos(across / 13.0);
        const int by = static_cast<int>(std::lround(wave)) + static_cast<int>(random() % 3) - 1;
        return static_cast<std::int16_t>(std::clamp(at * kSteps + by, 0, (kSide - 1) * kSteps) - at * kSteps);
    };
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            d.dx.push_back(moved(x, y, x));
            d.dy.push_back(moved(y, x, y));
        }
    return d;
}

void measure(int repeats, int cells, const char* name) {
    const BaseMesh mesh = test::jittered_grid(0, 0, kSide - 1, kSide - 1, cells, cells, 1);
    const Displacements d = waves();
    for (const WeightPrecision precision : {WeightPrecision::kHalf, WeightPrecision::kFloat}) {
        LocatedMap located;
        const double forth = speed_of(repeats, [&] { located = locate_map(mesh, d, precision); });
        if (located.lost) wrong("a pixel is on no face");
        std::optional<Displacements> found;
        const double back = speed_of(repeats, [&] { found = displacements_of(mesh, located.map); });
        if (found != d) wrong("other displacements come back");
        const char* words = precision == WeightPrecision::kHalf ? "half" : "float";
        std::printf("  \"%s_%s\": %.1f,\n  \"%s_%s_back\": %.1f,\n", name, words, forth, name, words, back);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const int repeats = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
    const ThreadLimit one(1);
    std::printf("{\n");
    measure(repeats, 102, "faces_of_50_pixels");
    measure(repeats, 512, "faces_of_2_pixels");
    measure(repeats, 32, "faces_of_500_pixels");
    std::printf("  \"pixels\": %d\n}\n", kSide * kSide);
}

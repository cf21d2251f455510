// How long warping takes, on one thread, as CPU time; the results are checked. Prints one JSON object.
//
//     warp-bench [REPEATS]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <numeric>

#include "libcore/base/parallel.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/warp/arap.h"
#include "libcore/warp/warp_image.h"
#include "tests/support/meshes.h"

using namespace imgmesh;

namespace {

double cpu_ms() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

// The least of several runs: the others measure what else the machine does.
double time_of(int repeats, const std::function<void()>& run) {
    double least = 1e300;
    for (int i = 0; i < repeats; ++i) {
        const double start = cpu_ms();
        run();
        least = std::min(least, cpu_ms() - start);
    }
    return least;
}

[[noreturn]] void wrong(const char* what) {
    std::fprintf(stderr, "warp-bench: wrong result: %s\n", what);
    std::exit(1);
}

// Colours that are linear in place, so that a drawing can be checked by where its pixels come from.
Image ramps(int side) {
    Image image = make_image(side, side, 3);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            float* p = image.pixel(x, y);
            p[0] = static_cast<float>(x) / static_cast<float>(side);
            p[1] = static_cast<float>(y) / static_cast<float>(side);
            p[2] = 0.5f;
        }
    return image;
}

MeshImage grid_image(int side, int cells) {
    MeshImage m;
    m.source.width = m.source.height = side;
    m.levels.resize(1);
    m.levels[0].mesh = test::jittered_grid(0, 0, side - 1, side - 1, cells, cells, 1);
    m.levels[0].map = trivial_map(m.levels[0].mesh, side, side);
    return m;
}

// Moves, draws, and compares a row of the drawing with the inverse map's.
double warp_ms(int repeats, const MeshImage& m, const Image& image, const std::vector<VertexMoves>& moves,
               const OutputSize& size) {
    Image out;
    const double ms = time_of(repeats, [&] { out = warp_image(image, displacement_field(m, moves), size); });
    const InverseMap map = inverse_map(displacement_field(m, moves), {}, size);
    const int y = out.height / 2;
    for (int x = out.width / 4; x < out.width * 3 / 4; ++x) {
        const Vec2f from = map.source[static_cast<std::size_t>(y * map.width + x)] / float(image.width);
        const float* p = out.pixel(x, y);
        if (std::abs(p[0] - from.x()) > 1e-3f || std::abs(p[1] - from.y()) > 1e-3f ||
            std::abs(p[2] - 0.5f) > 1e-6f)
            wrong("a pixel has not the colour of where it comes from");
    }
    return ms;
}

double arap_solve_ms(int repeats, int cells, int& iterations) {
    const BaseMesh mesh = test::jittered_grid(0, 0, 767, 511, cells, cells, 2);
    std::vector<Id> fixed;
    std::vector<Vec2d> moves;
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const bool side = mesh.position[v].x() == 0, handle = v + 1 == mesh.vertex_count();
        if (!side && !handle) continue;
        fixed.push_back(v);
        moves.push_back(handle ? Vec2d(-60, -90) : Vec2d(0, 0));
    }
    const ArapSolver solver(mesh, fixed);
    ArapSolver::Result result;
    const double ms = time_of(repeats, [&] { result = solver.solve(moves); });
    if (result.moves.back() != Vec2d(-60, -90)) wrong("the handle is not where it must be");
    iterations = result.iterations;
    return ms;
}

}  // namespace

int main(int argc, char** argv) {
    const int repeats = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
    const ThreadLimit one(1);
    const MeshImage m = grid_image(1024, 100);
    const Image image = ramps(1024);
    const BaseMesh& mesh = m.levels[0].mesh;
    VertexMoves one_handle(mesh.vertex_count(), Vec2f(0, 0)), all(mesh.vertex_count()),
        bend(mesh.vertex_count());
    one_handle[mesh.vertex_count() / 2] = {3, 2};
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const Vec2f p = mesh.position[v];
        all[v] = {16, 16};
        bend[v] = {12 * std::sin(p.y() / 90), 9 * std::cos(p.x() / 70)};
    }
    int iterations = 0;
    const double arap = arap_solve_ms(repeats, 31, iterations);  // 32 x 32 vertices
    std::printf("{\n  \"pixels\": %d,\n", 1024 * 1024);
    std::printf("  \"one_handle_ms\": %.1f,\n", warp_ms(repeats, m, image, {one_handle}, {}));
    std::printf("  \"shift_ms\": %.1f,\n", warp_ms(repeats, m, image, {all}, {}));
    std::printf("  \"bend_ms\": %.1f,\n", warp_ms(repeats, m, image, {bend}, {}));
    std::printf("  \"bend_half_size_ms\": %.1f,\n", warp_ms(repeats, m, image, {bend}, {512, 512}));
    std::printf("  \"bend_double_size_ms\": %.1f,\n", warp_ms(repeats, m, image, {bend}, {2048, 2048}));
    std::printf("  \"arap_vertices\": 1024,\n  \"arap_iterations\": %d,\n  \"arap_solve_ms\": %.1f\n}\n",
                iterations, arap);
}

// How long it takes to drag vertices as rigidly as possible and without folds, on one thread, as CPU time, on
// the same random drags; folds are counted. Prints a JSON object for each mesh: that of level 0 of each
// container, or else a grid.
//
//     drag-bench [DRAGS [CONTAINER...]]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <numbers>
#include <random>
#include <string>

#include "formats/container/container.h"
#include "libcore/mesh/exact_face.h"
#include "libcore/warp/arap.h"
#include "libcore/warp/injective.h"
#include "tests/support/meshes.h"

using namespace imgmesh;

namespace {

double cpu_ms() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

struct Drag {
    std::vector<Id> fixed;
    std::vector<Vec2d> moves;
};

// One to six handles and up to eight pins, at any vertices. Handles move in any direction, by up to 0.4 of
// the mesh's shorter side.
Drag random_drag(std::mt19937& random, const BaseMesh& mesh) {
    Vec2f low = mesh.position[0], high = low;
    for (const Vec2f& p : mesh.position) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const double far = 0.4 * static_cast<double>((high - low).minCoeff());
    const std::size_t handles = 1 + random() % 6, pins = random() % 9;
    std::vector<std::pair<Id, Vec2d>> all;
    for (std::size_t i = 0; i < handles + pins; ++i) {
        const auto v = static_cast<Id>(random() % mesh.vertex_count());
        const double angle = 2 * std::numbers::pi * double(random() % 10000) / 10000,
                     length = i < handles ? far * double(random() % 1001) / 1000 : 0;
        if (std::ranges::none_of(all, [v](const auto& one) { return one.first == v; }))
            all.emplace_back(v, length * Vec2d(std::cos(angle), std::sin(angle)));
    }
    std::ranges::sort(all, {}, [](const auto& one) { return one.first; });
    Drag drag;
    for (const auto& one : all) {
        drag.fixed.push_back(one.first);
        drag.moves.push_back(one.second);
    }
    return drag;
}

// The faces without a positive area, of what a container would hold.
template <typename Move>
int folds(const BaseMesh& mesh, const std::vector<Move>& moves) {
    BaseMesh moved = mesh;
    for (std::size_t v = 0; v < moves.size(); ++v) {
        const Vec2f to = mesh.position[v] + Vec2f(moves[v].template cast<float>());
        moved.position[v] = {snapped(to.x()), snapped(to.y())};
    }
    const std::vector<ExactFace> faces = exact_faces(moved);
    return static_cast<int>(std::ranges::count_if(faces, [](const ExactFace& f) { return f.area <= 0; }));
}

// Of many runs, in order.
struct Times {
    std::vector<double> ms;

    double of_share(double share) {
        std::ranges::sort(ms);
        return ms[static_cast<std::size_t>(share * static_cast<double>(ms.size() - 1))];
    }
    double mean() const {
        double sum = 0;
        for (const double t : ms) sum += t;
        return sum / static_cast<double>(ms.size());
    }
};

void print(const char* name, Times& prepare, Times& solve) {
    std::printf(
        "  \"%s\": {\"prepare_ms\": %.2f, \"median_ms\": %.2f, \"mean_ms\": %.2f, \"p90_ms\": %.2f},\n", name,
        prepare.of_share(0.5), solve.of_share(0.5), solve.mean(), solve.of_share(0.9));
}

void measure(const std::string& name, const BaseMesh& mesh, int drags) {
    std::mt19937 random(1);
    Times rigid_prepare, rigid, prepare, injective, step;
    int folded_by_rigid = 0, folded = 0, reached = 0;
    for (int i = 0; i < drags; ++i) {
        const Drag drag = random_drag(random, mesh);
        double start = cpu_ms();
        const auto time = [&start](Times& times) {
            const double now = cpu_ms();
            times.ms.push_back(now - start);
            start = now;
        };
        const ArapSolver rigid_solver(mesh, drag.fixed);
        time(rigid_prepare);
        const ArapSolver::Result by_rigid = rigid_solver.solve(drag.moves);
        time(rigid);
        const InjectiveSolver solver(mesh, drag.fixed);
        time(prepare);
        const InjectiveSolver::Result result = solver.solve(drag.moves);
        time(injective);
        // The hand goes on by a pixel.
        std::vector<Vec2d> next = drag.moves;
        for (Vec2d& m : next)
            if (m != Vec2d(0, 0)) m += m.normalized();
        start = cpu_ms();
        const InjectiveSolver::Result further = solver.solve(next, result.moves);
        time(step);
        folded_by_rigid += folds(mesh, by_rigid.moves) > 0;
        folded += folds(mesh, result.moves) > 0 || folds(mesh, further.moves) > 0;
        reached += result.left == 0;
    }
    std::printf("{\n  \"mesh\": \"%s\",\n  \"vertices\": %zu,\n  \"drags\": %d,\n", name.c_str(),
                mesh.vertex_count(), drags);
    std::printf("  \"folded_by_arap\": %d,\n  \"folded\": %d,\n  \"reached\": %d,\n", folded_by_rigid, folded,
                reached);
    print("arap", rigid_prepare, rigid);
    print("injective", prepare, injective);
    std::printf("  \"next_step_median_ms\": %.2f,\n  \"median_ratio\": %.2f,\n  \"mean_ratio\": %.2f\n}\n",
                step.of_share(0.5), injective.of_share(0.5) / rigid.of_share(0.5),
                injective.mean() / rigid.mean());
    if (folded > 0) {
        std::fprintf(stderr, "drag-bench: wrong result: a face is turned over\n");
        std::exit(1);
    }
}

}  // namespace

int main(int argc, char** argv) try {
    const int drags = argc > 1 ? std::max(1, std::atoi(argv[1])) : 100;
    if (argc <= 2) measure("grid", test::jittered_grid(0, 0, 767, 511, 31, 31, 2), drags);
    for (int i = 2; i < argc; ++i)
        measure(argv[i], read_container(argv[i], {}).mesh_image.levels.at(0).mesh, drags);
    return 0;
} catch (const std::exception& e) {
    std::fprintf(stderr, "drag-bench: %s\n", e.what());
    return 1;
}

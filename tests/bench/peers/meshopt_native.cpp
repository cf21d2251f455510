// The distribution's meshoptimizer. Its 0.18 knows no attributes: the mesh is a relief, L* its height, so it
// has less to do than imgmesh and than newer releases.
//
//     meshopt-native FEATURES VERTICES OUT    prints the processor time of the call as JSON
#include <meshoptimizer.h>
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "libcore/base/error.h"
#include "libcore/mesh/grid_mesh.h"
#include "tests/bench/raw_files.h"

using namespace imgmesh;

namespace {

std::vector<unsigned> grid_indices(const GridMesh& grid) {
    const int width = grid.feature.width, height = grid.feature.height;
    std::vector<unsigned> indices;
    for (int y = 0; y + 1 < height; ++y)
        for (int x = 0; x + 1 < width; ++x) {
            const auto a = static_cast<unsigned>(y * width + x), b = a + 1,
                       c = a + static_cast<unsigned>(width), d = c + 1;
            if (grid.falling_diagonal(x, y))
                indices.insert(indices.end(), {a, c, d, a, d, b});
            else
                indices.insert(indices.end(), {a, c, b, b, c, d});
        }
    return indices;
}

BaseMesh used_part(const FeatureImage& feature, const std::vector<unsigned>& indices) {
    BaseMesh mesh;
    std::vector<Id> number(feature.pixel_count(), kNone);
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        Face face{};
        for (std::size_t k = 0; k < 3; ++k) {
            const unsigned v = indices[i + k];
            if (number[v] == kNone) {
                number[v] = static_cast<Id>(mesh.vertex_count());
                const auto width = static_cast<unsigned>(feature.width);
                mesh.position.emplace_back(float(v % width), float(v / width));
                mesh.feature.insert(mesh.feature.end(), feature.pixel(v), feature.pixel(v) + 3);
            }
            face[k] = number[v];
        }
        mesh.faces.push_back(face);
    }
    return mesh;
}

double seconds(const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

void simplify(const char* features, const char* vertices, const char* out) {
    const FeatureImage feature = bench::read_features(features);
    const std::vector<unsigned> indices = grid_indices(grid_mesh(feature));
    std::vector<float> positions;
    for (int y = 0; y < feature.height; ++y)
        for (int x = 0; x < feature.width; ++x)
            positions.insert(positions.end(), {float(x), float(y), feature.pixel(x, y)[0]});
    const auto target = static_cast<std::size_t>(6 * std::atoll(vertices));
    std::vector<unsigned> kept(indices.size());
    rusage before{}, after{};
    getrusage(RUSAGE_SELF, &before);
    kept.resize(meshopt_simplify(kept.data(), indices.data(), indices.size(), positions.data(),
                                 feature.pixel_count(), 3 * sizeof(float), target, 1e9f, 0, nullptr));
    getrusage(RUSAGE_SELF, &after);
    bench::write_mesh(out, used_part(feature, kept));
    std::printf("{\"user_seconds\": %f, \"system_seconds\": %f}\n",
                seconds(after.ru_utime) - seconds(before.ru_utime),
                seconds(after.ru_stime) - seconds(before.ru_stime));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) {
        std::fputs("usage: meshopt-native FEATURES VERTICES OUT\n", stderr);
        return 2;
    }
    try {
        simplify(argv[1], argv[2], argv[3]);
    } catch (const Error& e) {
        std::fprintf(stderr, "meshopt-native: error: %s\n", e.what());
        return 1;
    }
}

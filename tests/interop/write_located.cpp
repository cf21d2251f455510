// Pixel maps from displacements, for tests of other readers.
//
//     write-located OUT    cases one after the other. Each: width, height, steps, steps of a weight of 1,
//     vertices,
//                          faces, masked (int32 each); positions (float32 x, y), faces (uint32 each), dx, dy
//                          (int16 each), inside (uint8); then the map: face (uint32), u, v (float32) of each
//                          pixel
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>
#include <vector>

#include "libcore/base/error.h"
#include "libcore/mesh/locate_map.h"
#include "libcore/mesh/weight_grid.h"
#include "tests/support/meshes.h"

using namespace imgmesh;

namespace {

template <typename T>
void put(std::ofstream& out, const std::vector<T>& values) {
    out.write(reinterpret_cast<const char*>(values.data()),
              static_cast<std::streamsize>(values.size() * sizeof(T)));
}

// `whole`: vertices on whole pixels, so that many pixels lie on edges and vertices. The mesh reaches `beyond`
// pixels over the image's sides.
void write_case(std::ofstream& out, int width, int height, int cells, int steps, WeightPrecision precision,
                bool whole, bool masked, int beyond, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto low = [&](int side) { return (side == 1 ? -0.5 : 0) - beyond; };
    const auto high = [&](int side) { return (side == 1 ? 0.5 : side - 1) + beyond; };
    const auto count = [&](int side) { return std::clamp(side / 3, 1, cells); };
    BaseMesh mesh = test::jittered_grid(low(width), low(height), high(width), high(height), count(width),
                                        count(height), seed);
    if (whole)
        for (Vec2f& p : mesh.position) p = {std::round(p.x()), std::round(p.y())};
    Displacements d;
    d.width = width;
    d.height = height;
    d.steps = steps;
    const auto moved = [&](int at, int side) {
        if (side == 1) return std::int16_t{0};
        const int by = static_cast<int>(random() % 3) - 1;
        return static_cast<std::int16_t>(std::clamp(at * steps + by, 0, (side - 1) * steps) - at * steps);
    };
    d.inside = Mask(d, 1);
    for (std::size_t i = 0; i < d.pixel_count(); ++i) {
        d.inside[i] = !masked || random() % 4 != 0;
        d.dx.push_back(d.inside[i] ? moved(d.x_of(i), width) : std::int16_t{0});
        d.dy.push_back(d.inside[i] ? moved(d.y_of(i), height) : std::int16_t{0});
    }
    const LocatedMap located = locate_map(mesh, d, precision);
    if (located.lost) throw Error(ErrorKind::kInternal, cat("pixel ", *located.lost, " is on no face"));
    put<std::int32_t>(out, {width, height, steps, static_cast<std::int32_t>(weight_steps(precision)),
                            as_int(mesh.vertex_count()), as_int(mesh.faces.size())});
    put(out, mesh.position);
    put(out, mesh.faces);
    put(out, d.dx);
    put(out, d.dy);
    put(out, d.inside.values);
    put(out, located.map.values);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: write-located OUT\n", stderr);
        return 2;
    }
    std::ofstream out(argv[1], std::ios::binary);
    std::uint32_t seed = 0;
    for (const WeightPrecision precision : {WeightPrecision::kHalf, WeightPrecision::kFloat})
        for (const int steps : {8, 16, 32}) {
            write_case(out, 40, 30, 8, steps, precision, false, false, 0, ++seed);
            write_case(out, 33, 30, 9, steps, precision, true, true, 0, ++seed);
            write_case(out, 1, 50, 9, steps, precision, false, true, 0, ++seed);
            write_case(out, 50, 1, 9, steps, precision, false, false, 0, ++seed);
            write_case(out, 1, 1, 1, steps, precision, false, false, 0, ++seed);
            write_case(out, 30, 30, 1, steps, precision, false, false, 100000, ++seed);
        }
    return out.flush() ? 0 : 1;
}

// Steps: (1) the quadrics of a row become one array for each member; (2) eight edges at a time are evaluated
// from two rows.
#include "libcore/simplify/kernel/grid_costs.h"

#include <algorithm>
#include <cstring>

#include "libcore/simplify/quadrics/quadric_lanes.h"

namespace imgmesh {
namespace {

constexpr int kMembers = kQuadricMembers;

// Pixels of a row in groups of eight: member m of pixel x is at [x / 8][m][x % 8]. One group more is read.
struct Row {
    std::vector<float> member;

    float* of(int x) { return member.data() + x / 8 * (8 * kMembers); }
};

// Quadrics of the pixels from x on, with all members of each in one vector.
struct Eight {
    QuadricMembers member;

    IMGMESH_INLINE void read(const float* group) {
        for (int m = 0; m < kMembers; ++m) member[m] = load8(group + 8 * m);
    }
    // The pixels one to the right: the group's without its first, and the first of the next group.
    IMGMESH_INLINE void read_next(const float* group) {
        for (int m = 0; m < kMembers; ++m)
            member[m] = __builtin_shufflevector(load8(group + 8 * m), load8(group + 8 * (kMembers + m)), 1, 2,
                                                3, 4, 5, 6, 7, 8);
    }
    IMGMESH_INLINE ColorQuadric8 quadric() const { return quadric_of(member); }
};

IMGMESH_INLINE void transpose_row(const ColorQuadric* quadrics, int width, Row& row) {
    for (int x = 0; x < width; x += 8) {
        Id which[8];
        for (int lane = 0; lane < 8; ++lane) which[lane] = static_cast<Id>(std::min(x + lane, width - 1));
        QuadricMembers member;
        read_members(quadrics, which, member);
        std::memcpy(row.of(x), member, sizeof member);
    }
}

IMGMESH_INLINE void put_costs(const Eight& i, const Eight& j, int count, ShortCost* out) {
    ShortCost costs[8];
    short_costs(merged_minimum(i.quadric(), j.quadric()).increment, costs);
    std::copy_n(costs, count, out);
}

IMGMESH_INLINE void all_costs(const GridMesh& grid, const PixelRect& rect, const ColorQuadric* quadrics,
                              GridCosts& out) {
    const int width = rect.width(), height = rect.height();
    Row upper, lower;
    const auto size = static_cast<std::size_t>((width + 7) / 8 + 1) * 8 * kMembers;
    upper.member.resize(size);
    lower.member.resize(size);
    transpose_row(quadrics, width, lower);
    for (int y = 0; y < height; ++y) {
        std::swap(upper, lower);
        const bool last = y + 1 == height;
        if (!last) transpose_row(quadrics + (y + 1) * width, width, lower);
        for (int x = 0; x < width; x += 8) {
            const int count = std::min(8, width - x), at = y * width + x;
            Eight here, right, below, beside;
            here.read(upper.of(x));
            right.read_next(upper.of(x));
            put_costs(here, right, count, out.east.data() + at);
            if (last) continue;
            below.read(lower.of(x));
            put_costs(here, below, count, out.south.data() + at);
            beside.read_next(lower.of(x));
            Int8 falls = {};
            for (int lane = 0; lane < count && rect.left + x + lane + 1 < grid.feature.width; ++lane)
                falls[lane] = -static_cast<int>(grid.falling_diagonal(rect.left + x + lane, rect.top + y));
            for (int m = 0; m < kMembers; ++m) {
                here.member[m] = falls ? here.member[m] : right.member[m];
                below.member[m] = falls ? beside.member[m] : below.member[m];
            }
            put_costs(here, below, count, out.cell.data() + at);
        }
    }
}

#if defined(__x86_64__)
__attribute__((target("avx2"), flatten)) void all_costs_avx2(const GridMesh& grid, const PixelRect& rect,
                                                             const ColorQuadric* quadrics, GridCosts& out) {
    all_costs(grid, rect, quadrics, out);
}
IMGMESH_AVX512 __attribute__((flatten)) void all_costs_avx512(const GridMesh& grid, const PixelRect& rect,
                                                              const ColorQuadric* quadrics, GridCosts& out) {
    all_costs(grid, rect, quadrics, out);
}
#endif

}  // namespace

void grid_costs(const GridMesh& grid, const PixelRect& rect, const ColorQuadric* quadrics, GridCosts& out) {
    const auto pixels = static_cast<std::size_t>(rect.width()) * static_cast<std::size_t>(rect.height());
    out.east.resize(pixels);
    out.south.resize(pixels);
    out.cell.resize(pixels);
#if defined(__x86_64__)
    if (has_avx512()) return all_costs_avx512(grid, rect, quadrics, out);
    if (has_avx2()) return all_costs_avx2(grid, rect, quadrics, out);
#endif
    all_costs(grid, rect, quadrics, out);
}

}  // namespace imgmesh

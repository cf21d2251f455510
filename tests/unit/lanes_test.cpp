// Loads, stores and transposes of lanes, by plain loops. They are the same on every processor.
#include <doctest/doctest.h>

#include <vector>

#include "libcore/base/transpose.h"
#include "libcore/param/relax_lanes.h"

using namespace imgmesh;

namespace {

std::vector<float> numbers(int count) {
    std::vector<float> out;
    for (int i = 0; i < count; ++i) out.push_back(static_cast<float>(100 + 7 * i % 50));
    return out;
}

template <typename T>
void check_lanes() {
    constexpr int n = kLaneCount<T>;
    const std::vector<float> from = numbers(3 * 2 * n + 8);
    const T loaded = load_every_other<T>(&from[1]);
    T by_three[3];
    gather3(&from[2], 6, by_three);
    for (int l = 0; l < n; ++l) {
        CHECK((loaded[l] == from[as_index(1 + 2 * l)]));
        CHECK((every_other<T>()[l] == static_cast<float>(2 * l)));
        for (int c = 0; c < 3; ++c) CHECK((by_three[c][l] == from[as_index(2 + 6 * l + c)]));
    }
    std::vector<float> to = from;
    store_every_other(&to[1], T{} - loaded);
    for (int i = 0; i < static_cast<int>(from.size()); ++i) {
        const bool written = i % 2 == 1 && i < 1 + 2 * n;
        CHECK(to[as_index(i)] == (written ? -1 : 1) * from[as_index(i)]);
    }
    for (int l = 0; l < n; ++l) {
        T zero = {};
        zero[l] = 1;
        CHECK(bits_of(zero > T{}) == 1u << l);
        CHECK(bits_of(zero < T{} + 0.5f) == ((1u << n) - 1 - (1u << l)));
    }
}

template <typename T, typename Transpose>
void check_transpose(Transpose transpose) {
    constexpr int n = kLaneCount<T>;
    T rows[n];
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) rows[i][j] = static_cast<float>(100 * i + j);
    transpose(rows);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) CHECK((rows[i][j] == static_cast<float>(100 * j + i)));
}

}  // namespace

TEST_CASE("lanes: loads, stores and bits are those of single elements") {
    check_lanes<Float8>();
    check_lanes<Float16>();
}

TEST_CASE("lanes: transposing exchanges rows and columns") {
    check_transpose<Float8>([](Float8(&rows)[8]) { transpose8(rows); });
    check_transpose<Float16>([](Float16(&rows)[16]) { transpose16(rows); });
}

// Difficult masks for tests.
#pragma once

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "libcore/image/mask.h"

namespace imgmesh::test {

/// The pixels for which inside(x, y) holds.
template <typename Inside>
Mask mask_where(int width, int height, Inside inside) {
    Mask mask{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) mask.values.push_back(inside(x, y));
    return mask;
}

/// '#' is inside; rows of one length.
inline Mask mask_of(const std::vector<std::string>& rows) {
    return mask_where(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()), [&](int x, int y) {
        return rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] == '#';
    });
}

/// Returns a small random mask: noise, blobs, or blobs with noise. The same seed gives the same mask; some
/// pixel is always inside.
inline Mask random_mask(std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
    const int width = 1 + below(22), height = 1 + below(18), kind = below(3), share = below(1000);
    double cx[4], cy[4], cr[4];
    for (int k = 0; k < 4; ++k) {
        cx[k] = below(static_cast<unsigned>(width));
        cy[k] = below(static_cast<unsigned>(height));
        cr[k] = 1 + below(8);
    }
    Mask mask = mask_where(width, height, [&](int x, int y) {
        if (kind == 0) return below(1000) < share;
        bool inside = false;
        for (int k = 0; k < 4; ++k) inside ^= std::hypot(x - cx[k], y - cy[k]) < cr[k];
        return inside != (kind == 2 && below(20) == 0);
    });
    mask[static_cast<std::size_t>(below(static_cast<unsigned>(mask.size())))] = 1;
    return mask;
}

struct NamedMask {
    std::string name;
    Mask mask;
};

/// Ring, spokes, islands that touch at corners, noise, and more, of about size x size pixels (at least 24).
inline std::vector<NamedMask> sample_masks(int size) {
    const double middle = (size - 1) / 2.0, radius = 0.45 * size;
    const auto r = [=](int x, int y) { return std::hypot(x - middle, y - middle); };
    std::mt19937 random(7);
    std::vector<NamedMask> masks;
    const auto add = [&](const char* name, int width, int height, auto inside) {
        masks.push_back({name, mask_where(width, height, inside)});
    };
    add("disc", size, size, [&](int x, int y) { return r(x, y) <= radius; });
    add("disc cut by the border", size, size - 3,
        [&](int x, int y) { return std::hypot(x, y - middle) <= radius * 1.3; });
    add("ring", size, size, [&](int x, int y) { return r(x, y) <= radius && r(x, y) >= radius / 2; });
    add("thin ring", size, size, [&](int x, int y) { return std::abs(r(x, y) - radius) < 0.6; });
    // Hub, rim and seven spokes, some one pixel wide in places.
    add("spokes", size, size, [&](int x, int y) {
        if (r(x, y) > radius) return false;
        if (r(x, y) < radius / 4 || r(x, y) > 0.85 * radius) return true;
        const double turns = std::atan2(y - middle, x - middle) * 7 / 6.283185307;
        return std::abs(turns - std::round(turns)) * r(x, y) < 0.9;
    });
    add("islands touching at corners", size, size - 1, [](int x, int y) { return (x / 4 + y / 4) % 2 == 0; });
    add("pixels touching at corners", size, size - 2, [](int x, int y) { return (x + y) % 2 == 0; });
    add("comb", size, size, [=](int x, int y) { return y < 4 || (x % 4 < 2 && y < size - x / 3); });
    add("slits", size, size, [=](int x, int y) { return x % 5 != 3 || (x / 5 % 2 ? y > 2 : y < size - 3); });
    add("spiral", size, size, [&](int x, int y) {
        const double turn = std::atan2(y - middle, x - middle) / 6.283185307;
        const double arm = r(x, y) / (0.11 * size) - turn;
        return r(x, y) < radius && arm - std::floor(arm) < 0.62;
    });
    add("disc with salt", size, size,
        [&](int x, int y) { return (r(x, y) <= radius) != (random() % 50 == 0); });
    add("noise", size, size + 2, [&](int, int) { return random() % 2 == 0; });
    add("sparse noise", size, size, [&](int, int) { return random() % 6 == 0; });
    add("dense noise", size, size, [&](int, int) { return random() % 8 != 0; });
    add("lines", size, size, [](int x, int y) { return x % 7 == 3 || y % 9 == 4; });
    add("one row", size, 1, [](int x, int) { return x % 6 < 4; });
    add("one column", 1, size, [](int, int y) { return y % 9 != 3; });
    add("one pixel", size, size, [](int x, int y) { return x == 5 && y == 0; });
    add("a corner", 3, 3, [](int x, int y) { return x + y < 2; });
    add("full", size, 5, [](int, int) { return true; });
    return masks;
}

}  // namespace imgmesh::test

#include "formats/picture/decode/non_finite.h"

#include <cmath>
#include <vector>

namespace imgmesh {
namespace {

constexpr int kNoRow = -1;

// Returns for every pixel the row of the nearest finite sample in its column, or kNoRow.
std::vector<int> nearest_rows(const Image& image, int channel) {
    std::vector<int> rows(image.pixel_count(), kNoRow);
    const auto width = static_cast<std::size_t>(image.width);
    for (int y = 0; y < image.height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * width + x;
            if (std::isfinite(image.pixel(i)[channel]))
                rows[i] = y;
            else if (y > 0)
                rows[i] = rows[i - width];
        }
    for (int y = image.height - 2; y >= 0; --y)
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * width + x;
            const int below = rows[i + width];
            if (below > y && (rows[i] == kNoRow || below - y < y - rows[i])) rows[i] = below;
        }
    return rows;
}

// A column, and from which x on it is nearer than those before it.
struct Reach {
    int column;
    std::int64_t from;
};

std::int64_t squared(std::int64_t x) {
    return x * x;
}

// The columns that are nearest somewhere in row y, from left to right.
void find_reaches(const int* rows, int width, int y, std::vector<Reach>& reaches) {
    reaches.clear();
    const auto height = [&](int x) { return squared(rows[x] - y) + squared(x); };
    for (int x = 0; x < width; ++x) {
        if (rows[x] == kNoRow) continue;
        std::int64_t from = 0;
        while (!reaches.empty()) {
            const int before = reaches.back().column;
            const std::int64_t above = height(x) - height(before), below = 2 * (std::int64_t{x} - before);
            // The first whole number above above / below: where both are equally near, the left one counts.
            from = (above >= 0 ? above / below : -((-above + below - 1) / below)) + 1;
            if (from > reaches.back().from) break;
            reaches.pop_back();
            from = 0;
        }
        if (from < width) reaches.push_back({x, from});
    }
}

}  // namespace

std::size_t first_non_finite(const Image& image, int channel) {
    std::size_t i = 0;
    while (i < image.pixel_count() && std::isfinite(image.pixel(i)[channel])) ++i;
    return i;
}

std::int64_t zero_non_finite(Image& image, int channel) {
    std::int64_t count = 0;
    for (std::size_t i = first_non_finite(image, channel); i < image.pixel_count(); ++i) {
        float& value = image.pixel(i)[channel];
        if (std::isfinite(value)) continue;
        value = 0;
        ++count;
    }
    return count;
}

std::int64_t fill_non_finite(Image& image, int channel) {
    if (first_non_finite(image, channel) == image.pixel_count()) return 0;
    const std::vector<int> rows = nearest_rows(image, channel);
    std::vector<Reach> reaches;
    std::int64_t count = 0;
    for (int y = 0; y < image.height; ++y) {
        const int* const row =
            rows.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width);
        find_reaches(row, image.width, y, reaches);
        if (reaches.empty()) return -1;
        std::size_t r = 0;
        for (int x = 0; x < image.width; ++x) {
            while (r + 1 < reaches.size() && reaches[r + 1].from <= x) ++r;
            if (row[x] == y) continue;  // it is finite itself
            const int column = reaches[r].column;
            image.pixel(x, y)[channel] = image.pixel(column, row[column])[channel];
            ++count;
        }
    }
    return count;
}

}  // namespace imgmesh

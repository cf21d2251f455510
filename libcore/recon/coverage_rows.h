// The body of for_each_covered(). Included by coverage.h alone.
#pragma once

#include <algorithm>
#include <cmath>

#include "libcore/recon/coverage.h"

namespace imgmesh {

/// Cuts columns [begin, end) off `rest` and hands on the parts.
template <typename Add>
void add_columns(CutPolygon& rest, int begin, int end, int y, Add& add) {
    for (int x = begin; x < end && !rest.empty(); ++x) {
        const auto [area, centroid] = rest.cut_off(0, x + 1).area();
        if (area > 0) add(x, y, std::min(area, 1.0), centroid);
    }
}

template <typename Add>
void for_each_covered(const std::array<Vec2d, 3>& triangle, int first_row, int last_row, int width,
                      Add&& add) {
    CutPolygon rest(triangle[0], triangle[1], triangle[2]);
    const auto [top, bottom] = rest.extent(1);
    const int first = static_cast<int>(std::max<double>(std::floor(top), first_row));
    const int last = static_cast<int>(std::min<double>(std::ceil(bottom), last_row));
    rest.cut_off(1, first);
    rest.cut_off(0, 0);
    for (int y = first; y < last && !rest.empty(); ++y) {
        CutPolygon row = rest.cut_off(1, y + 1);
        if (row.empty()) continue;
        const auto [left, right] = row.extent(0);
        const int begin = static_cast<int>(std::floor(left));
        const int end = static_cast<int>(std::min<double>(std::ceil(right), width));
        // A pixel is covered whole if its four corners are.
        const auto [upper_left, upper_right] = row.extent_at(y);
        const auto [lower_left, lower_right] = row.extent_at(y + 1);
        const double whole_left = std::ceil(std::max(upper_left, lower_left)),
                     whole_right = std::floor(std::min(upper_right, lower_right));
        if (!(whole_left < std::min<double>(whole_right, end))) {
            add_columns(row, begin, end, y, add);
            continue;
        }
        const int whole_begin = static_cast<int>(whole_left),
                  whole_end = static_cast<int>(std::min<double>(whole_right, end));
        add_columns(row, begin, whole_begin, y, add);
        for (int x = whole_begin; x < whole_end; ++x) add(x, y, 1.0, Vec2d(x + 0.5, y + 0.5));
        row.cut_off(0, whole_end);
        add_columns(row, whole_end, end, y, add);
    }
}

}  // namespace imgmesh

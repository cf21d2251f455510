// The traversal of code_points(), the same for every coder.
#pragma once

namespace imgmesh::coding {

inline int cells_of(int points, int level) {
    return points == 0 ? 0 : ((points - 1) >> level) + 1;
}

/// Returns how many of `points` lie in the 2^level ones that begin at `first`.
inline std::uint32_t room_of(int first, int level, int points) {
    return static_cast<std::uint32_t>(std::max(0, std::min(1 << level, points - first)));
}

template <class Coder>
std::vector<GridPoint> code_points(Coder& coder, HalvesModel& model, int columns, int rows,
                                   std::uint32_t count, const std::vector<GridPoint>& points) {
    if (count == 0) return {};
    int level_x = 0;
    while (1 << level_x < std::max(columns, rows)) ++level_x;
    int level_y = level_x;
    CountGrid now(1, 1);
    now.at(0, 0) = count;
    while (level_x > 0 || level_y > 0) {
        // Rows divide first.
        const bool down = level_x == level_y;
        const int next_x = down ? level_x : level_x - 1, next_y = down ? level_y - 1 : level_y;
        CountGrid next(cells_of(columns, next_x), cells_of(rows, next_y));
        CountGrid wanted(Coder::kDecodes ? 0 : next.width(), Coder::kDecodes ? 0 : next.height());
        if constexpr (!Coder::kDecodes)
            for (const auto& [x, y] : points) ++wanted.at(x >> next_x, y >> next_y);
        for (int y = 0; y < now.height(); ++y)
            for (int x = 0; x < now.width(); ++x) {
                const std::uint32_t here = now.at(x, y);
                if (here == 0) continue;
                const int fx = down ? x : 2 * x, fy = down ? 2 * y : y;
                const int sx = down ? x : fx + 1, sy = down ? fy + 1 : y;
                AroundHalves around;
                around.level = static_cast<std::uint32_t>(level_x);
                around.down = down;
                if (down) {
                    const std::uint32_t wide = room_of(x << level_x, level_x, columns);
                    around.room_first = wide * room_of(fy << next_y, next_y, rows);
                    around.room_second = wide * room_of(sy << next_y, next_y, rows);
                    around.before = 2 * next.at(x, fy - 1);
                    around.after = now.at(x, y + 1);
                    around.beside_first = next.at(x - 1, fy);
                    around.beside_second = next.at(x - 1, sy);
                    around.beside = now.at(x + 1, y);
                    around.corner_before = next.at(x - 1, fy - 1) + next.at(x + 1, fy - 1);
                    around.corner_after = (now.at(x - 1, y + 1) + now.at(x + 1, y + 1) + 1) / 2;
                } else {
                    const std::uint32_t high = room_of(y << level_y, level_y, rows);
                    around.room_first = high * room_of(fx << next_x, next_x, columns);
                    around.room_second = high * room_of(sx << next_x, next_x, columns);
                    around.before = 2 * next.at(fx - 1, y);
                    around.after = now.at(x + 1, y);
                    around.beside_first = next.at(fx, y - 1);
                    around.beside_second = next.at(sx, y - 1);
                    around.beside = now.at(x, y + 1);
                    around.corner_before = 2 * next.at(fx - 1, y - 1) + now.at(x - 1, y + 1);
                    around.corner_after = 2 * next.at(sx + 1, y - 1) + now.at(x + 1, y + 1);
                }
                const std::uint32_t first =
                    model.code(coder, Coder::kDecodes ? 0 : wanted.at(fx, fy), here, around);
                next.at(fx, fy) = first;
                if (first < here) next.at(sx, sy) = here - first;
            }
        now = std::move(next);
        level_x = next_x;
        level_y = next_y;
    }
    std::vector<GridPoint> found;
    found.reserve(count);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            if (now.at(x, y) != 0) found.push_back({x, y});
    return found;
}

}  // namespace imgmesh::coding

#include "libcore/coding/code_points.h"

#include <bit>

namespace imgmesh::coding {
namespace {

constexpr std::uint32_t kLevels = 24, kCounts = 16;

std::uint32_t pair(std::uint32_t a, std::uint32_t b, std::uint32_t most) {
    return std::min(a, most) * (most + 1) + std::min(b, most);
}
std::uint32_t level(const AroundHalves& around) {
    return std::min(around.level, kLevels - 1);
}
std::uint32_t counted(std::uint32_t number) {
    return std::min(number, kCounts - 1);
}

}  // namespace

HalvesModel::HalvesModel()
    : side_({4 * 64, 4 * 64, 4 * 64, kLevels * 4 * 2, 25 * 25 * 2}),
      tie_({kCounts * kLevels, 8 * 64, kCounts}),
      excess_({kCounts * kCounts, kLevels * kCounts, 64}) {}

BitModel<5>::Contexts HalvesModel::side_contexts(std::uint32_t count, const AroundHalves& around) {
    const std::uint32_t few = std::min(count, 4u) - 1;
    return {
        few * 64 + pair(around.before, around.after, 7),
        few * 64 + pair(around.beside_first, around.beside_second, 7),
        few * 64 + pair(around.corner_before, around.corner_after, 7),
        (level(around) * 4 + few) * 2 + around.down,
        pair(around.before + around.beside_first, around.after + around.beside_second, 24) * 2 + (few > 0)};
}

BitModel<3>::Contexts HalvesModel::tie_contexts(std::uint32_t count, const AroundHalves& around) {
    const std::uint32_t half = counted(count / 2);
    return {half * kLevels + level(around),
            std::min(around.before + around.after, 7u) * 64 +
                pair(around.beside_first + around.beside_second, around.beside, 7),
            half};
}

BitModel<3>::Contexts HalvesModel::excess_contexts(std::uint32_t count, std::uint32_t more,
                                                   const AroundHalves& around) {
    const auto size = static_cast<std::uint32_t>(std::bit_width(count));
    return {counted(size) * kCounts + counted(more), level(around) * kCounts + counted(more),
            pair(count, more, 7)};
}

namespace {

// The logarithm of a ratio, in 1/256, by the first bits of its numbers.
int log_ratio(std::uint32_t over, std::uint32_t under) {
    const auto log2 = [](std::uint32_t n) {
        const int whole = std::bit_width(n) - 1;
        const std::uint32_t rest = whole >= 7 ? n >> (whole - 7) : n << (7 - whole);
        return whole * 128 + static_cast<int>(rest) - 128;
    };
    return (log2(over) - log2(under)) * 177 >> 7;
}

// How many more of one than of the other, each counted up to 7.
int lead(std::uint32_t a, std::uint32_t b) {
    return static_cast<int>(std::min(a, 7u)) - static_cast<int>(std::min(b, 7u));
}

}  // namespace

int HalvesModel::side_odds(const AroundHalves& around) {
    const int room = std::clamp(log_ratio(around.room_first, around.room_second), -600, 600);
    return room + 14 * lead(around.before, around.after) +
           21 * lead(around.beside_first, around.beside_second) +
           13 * lead(around.corner_before, around.corner_after);
}

int HalvesModel::tie_odds(std::uint32_t count, const AroundHalves& around) {
    constexpr std::array<int, 4> kByHalf = {-38, -168, -247, -449};
    return kByHalf[std::min(count / 2, 4u) - 1] + (around.level <= 1 ? 255 : around.level == 2 ? 79 : 0);
}

}  // namespace imgmesh::coding

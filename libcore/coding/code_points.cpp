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

// The logarithm of the ratio of the rooms, in 1/256, by its first bits.
int HalvesModel::room_odds(const AroundHalves& around) {
    const auto log2 = [](std::uint32_t n) {
        const int whole = std::bit_width(n) - 1;
        const std::uint32_t rest = whole >= 7 ? n >> (whole - 7) : n << (7 - whole);
        return whole * 128 + static_cast<int>(rest) - 128;
    };
    return std::clamp((log2(around.room_first) - log2(around.room_second)) * 177 >> 7, -600, 600);
}

}  // namespace imgmesh::coding

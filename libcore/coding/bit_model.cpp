#include "libcore/coding/bit_model.h"

namespace imgmesh::coding {
namespace {

// 65536 / (1 + exp(-x / 256)) for x = -2048, -1920, ..., 2048, rounded.
constexpr std::array<int, 33> kLogistic = {22,    36,    60,    98,    162,   267,   439,   720,   1179,
                                           1921,  3108,  4971,  7812,  11955, 17625, 24743, 32768, 40793,
                                           47911, 53581, 57724, 60565, 62428, 63615, 64357, 64816, 65097,
                                           65269, 65374, 65438, 65476, 65500, 65514};

}  // namespace

constexpr std::array<int, 2 * kMaxOdds + 1> kProbabilities = [] {
    std::array<int, 2 * kMaxOdds + 1> out{};
    for (int odds = -kMaxOdds; odds <= kMaxOdds; ++odds) {
        const int x = odds + 2048, part = x & 127;
        const auto i = static_cast<std::size_t>(x >> 7);
        out[static_cast<unsigned>(odds + kMaxOdds)] =
            (kLogistic[i] * (128 - part) + kLogistic[i + 1] * part + 64) >> 7;
    }
    return out;
}();

// For probabilities in 1/2^12: the lowest log odds whose probability is not below the middle of the step.
constexpr std::array<std::int16_t, 4096> kOdds = [] {
    std::array<std::int16_t, 4096> out{};
    int odds = -kMaxOdds;
    for (int p = 0; p < 4096; ++p) {
        while (odds < kMaxOdds && kProbabilities[static_cast<unsigned>(odds + kMaxOdds)] < 16 * p + 8) ++odds;
        out[static_cast<std::size_t>(p)] = static_cast<std::int16_t>(odds);
    }
    return out;
}();

const std::array<int, 256> AdaptiveBit::kRate = [] {
    std::array<int, 256> out{};
    for (int bits = 0; bits < 256; ++bits) out[static_cast<unsigned>(bits)] = 327680 / (10 * bits + 25);
    return out;
}();

}  // namespace imgmesh::coding

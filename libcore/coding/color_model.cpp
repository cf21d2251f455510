#include "libcore/coding/color_model.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include "libcore/base/index.h"
#include "libcore/coding/integer_math.h"

namespace imgmesh::coding {
namespace {

constexpr std::uint32_t kChannels = 4, kOddsBuckets = 24, kLogBuckets = 16, kNearBuckets = 7;

// The log odds, as BitModel takes them, of two weights >= 0.
int odds_between(std::int32_t yes, std::int32_t no) {
    const int octaves =
        log2_of(static_cast<std::uint32_t>(yes) + 1) - log2_of(static_cast<std::uint32_t>(no) + 1);
    return std::clamp(octaves * 177 >> 8, -1800, 1800);
}

std::uint32_t bucket(int value, int first, int width, std::uint32_t count) {
    return static_cast<std::uint32_t>(
        std::clamp<std::int64_t>(floor_divide(value - first, width), 0, count - 1));
}
std::uint32_t odds_bucket(int odds) {
    return bucket(odds, -768, 64, kOddsBuckets);
}
std::uint32_t log_bucket(int log) {
    return bucket(log, -64, 10, kLogBuckets);
}

// Where the nearest neighbour's colour lies, by halves of a step and coarser away from it.
std::uint32_t near_bucket(const ColorGuess& guess) {
    const std::int64_t eighths = floor_divide(8 * std::int64_t{guess.nearest}, guess.step);
    const std::int64_t size = std::abs(eighths);
    const std::uint32_t from_middle = size < 2 ? 0 : size < 6 ? 1 : size < 14 ? 2 : 3;
    return eighths < 0 ? 3 - from_middle : 3 + from_middle;
}

std::uint32_t capped(int level) {
    return static_cast<std::uint32_t>(std::min(std::abs(level), 3));
}
std::uint32_t sign_of(int level) {
    return level < 0 ? 0 : level > 0 ? 2 : 1;
}

// The bits of a bit, as BitModel gives it to a coder.
double cost(int odds, bool bit) {
    const int one = std::clamp(probability_of(odds) >> 1, 16, (1 << 15) - 16);
    return 15 - log2_of(static_cast<std::uint64_t>(bit ? one : (1 << 15) - one)) / 256.0;
}

}  // namespace

ColorModel::ColorModel(const ColorPlan& plan, int channels, const std::array<std::int32_t, 4>& steps)
    : guesser_(plan, channels, steps),
      zero_({kChannels * kOddsBuckets, kChannels * kLogBuckets * 4, kChannels * kLogBuckets * kLogBuckets,
             kChannels * 4 * 4 * 4, kChannels * kNearBuckets},
            kChannels),
      sign_({kChannels * kOddsBuckets, kChannels * kNearBuckets, kChannels * 3 * 3}, kChannels),
      size_({4 * kChannels * kOddsBuckets, kEscape * kLogBuckets, kEscape * kLogBuckets}, 3) {}

ColorModel::Decision<5> ColorModel::zero_decision(const ColorGuess& guess) {
    const int odds = odds_between(guess.less + guess.more, guess.mixture.all() - guess.less - guess.more);
    const auto channel = static_cast<std::uint32_t>(guess.channel);
    const std::uint32_t spread = log_bucket(guess.spread), surprise = log_bucket(guess.surprise);
    const auto neighbors = static_cast<std::uint32_t>(std::clamp<std::size_t>(guess.neighbors, 1, 4) - 1);
    return {{channel * kOddsBuckets + odds_bucket(odds), (channel * kLogBuckets + spread) * 4 + neighbors,
             (channel * kLogBuckets + surprise) * kLogBuckets + spread,
             ((channel * 4 + capped(guess.before[0])) * 4 + capped(guess.before[1])) * 4 + surprise / 4,
             channel * kNearBuckets + near_bucket(guess)},
            odds,
            guess.channel};
}

ColorModel::Decision<3> ColorModel::sign_decision(const ColorGuess& guess) {
    const int odds = odds_between(guess.less, guess.more);
    const auto channel = static_cast<std::uint32_t>(guess.channel);
    return {{channel * kOddsBuckets + odds_bucket(odds), channel * kNearBuckets + near_bucket(guess),
             (channel * 3 + sign_of(guess.before[0])) * 3 + sign_of(guess.before[1])},
            odds,
            guess.channel};
}

ColorModel::Decision<3> ColorModel::size_decision(const ColorGuess& guess, int size, std::int32_t at_least,
                                                  std::int32_t larger) {
    const int odds = odds_between(larger, at_least - larger);
    const auto at = static_cast<std::uint32_t>(size), few = std::min(at, 3u);
    return {
        {((few * kChannels + static_cast<std::uint32_t>(guess.channel)) * kOddsBuckets) + odds_bucket(odds),
         at * kLogBuckets + log_bucket(guess.spread), at * kLogBuckets + log_bucket(guess.surprise)},
        odds,
        few - 1};
}

double ColorModel::bits(const ColorGuess& guess, int level) const {
    const Decision<5> zero = zero_decision(guess);
    double out = cost(zero_.odds(zero.contexts, zero.odds, zero.set), level != 0);
    if (level == 0) return out;
    const Decision<3> sign = sign_decision(guess);
    out += cost(sign_.odds(sign.contexts, sign.odds, sign.set), level < 0);
    std::int32_t at_least = level < 0 ? guess.less : guess.more;
    const int wanted = std::abs(level);
    for (int size = 1; size < kEscape; ++size) {
        const std::int32_t larger = guess.beyond(level < 0 ? -size : size);
        const Decision<3> more = size_decision(guess, size, at_least, larger);
        out += cost(size_.odds(more.contexts, more.odds, more.set), wanted > size);
        if (wanted == size) return out;
        at_least = larger;
    }
    return out + 2 * std::bit_width(static_cast<unsigned>(wanted - kEscape + 1)) - 1;
}

}  // namespace imgmesh::coding

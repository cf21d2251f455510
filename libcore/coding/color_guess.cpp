#include "libcore/coding/color_guess.h"

#include <algorithm>
#include <cstdlib>

#include "libcore/base/index.h"
#include "libcore/coding/integer_math.h"

namespace imgmesh::coding {
namespace {

constexpr std::int32_t kLeast = -32768, kMost = 32767;

// How a channel's mixture follows from what is known, fitted on three pictures at three sizes each
// (docs/decisions/0044-colours-of-coded-meshes.md). Logarithms are 16 log2.
struct Shape {
    int base;  // of the distance over which the guess halves
    // Factors of what adds to that, in 1/256.
    int spread, surprise, neighbors, fineness, recent;
    std::array<int, 2> before;
    int near_base, near_fineness;  // of the same around neighbours, over that: a number, a factor
    bool flat;                     // which of their weights neighbours have
    std::int32_t share, pull;      // of 256: the guess's weight, and of neighbours' offsets
};
constexpr std::array<Shape, 3> kShapes = {
    {{-3, -20, 17, -711, -58, 232, {0, 0}, -4, 75, false, 68, 217},
     {-8, 33, 17, -638, -153, 243, {671, 0}, -8, 100, true, 141, 183},
     {-35, 12, 14, -416, -165, 135, {838, 3379}, 0, 46, true, 257, 183}}};

// The mean level of late: over the last 64, of levels that are capped.
constexpr std::int32_t kRecentUnit = 4096, kRecentLength = 64, kRecentStart = 4, kMostRecent = 30;

int log16(std::int64_t number) {
    return log2_of(static_cast<std::uint64_t>(number)) >> 4;
}

// step * 2^(log / 16), times 2^(1/16)
std::int32_t half_distance(std::int32_t step, int log) {
    const int l = std::clamp(log, -80, 144) + 80;
    const std::int64_t scaled = std::int64_t{step} * half_power((15 - (l & 15)) * 64);
    return static_cast<std::int32_t>(std::max<std::int64_t>((scaled << (l >> 4)) >> 18, 1));
}

}  // namespace

ColorGuesser::ColorGuesser(const ColorPlan& plan, int channels, const std::array<std::int32_t, 4>& steps)
    : plan_(plan),
      channels_(as_index(channels)),
      steps_(steps),
      color_(plan.vertex_count() * channels_),
      calm_(color_.size()),
      surprise_(color_.size()) {
    recent_.fill(kRecentUnit);
    log_fineness_.reserve(plan.vertex_count());
    for (const std::int32_t fineness : plan.fineness) log_fineness_.push_back(log16(fineness) - 192);
}

std::int32_t ColorGuesser::step_of(std::size_t vertex, std::size_t channel) const {
    return std::max((steps_[channel] * plan_.fineness[vertex] + 2048) >> 12, 1);
}

std::int32_t ColorGuesser::mean(std::size_t vertex, std::size_t channel,
                                const std::vector<std::int32_t>& of) const {
    std::int64_t sum = 0, weight = 0;
    for (const auto& n : plan_.of(vertex)) {
        sum += std::int64_t{n.weight} * of[n.vertex * channels_ + channel];
        weight += n.weight;
    }
    return static_cast<std::int32_t>(rounded_divide(sum, weight));
}

std::int32_t ColorGuesser::spread(std::size_t vertex, std::size_t channel, std::int32_t around) const {
    std::int64_t sum = 0, weight = 0;
    for (const auto& n : plan_.of(vertex)) {
        sum += std::int64_t{n.weight} * std::abs(color_[n.vertex * channels_ + channel] - around);
        weight += n.weight;
    }
    return static_cast<std::int32_t>(floor_divide(sum, weight));
}

// Without neighbours: middle grey, opaque, or the vertex before.
std::int32_t ColorGuesser::first_color(std::size_t vertex, std::size_t channel) const {
    if (vertex > 0) return color_[(vertex - 1) * channels_ + channel];
    if (channel == 0) return channels_ < 3 ? 128 * kColorUnit : 222 * kColorUnit;
    return channels_ % 2 == 0 && channel == channels_ - 1 ? 255 * kColorUnit : 0;
}

// Colour changes with lightness as it does among the neighbours, damped by half and by how sure that is.
std::int32_t ColorGuesser::gain_with_light(std::size_t vertex, const ColorGuess& guess) const {
    std::int64_t both = 0, own = 0, weight = 0;
    for (const auto& n : plan_.of(vertex)) {
        const std::int64_t light = calm_[n.vertex * channels_] - guessed_[0];
        both += n.weight * light * (calm_[n.vertex * channels_ + guess.channel] - guess.value);
        own += n.weight * light * light;
        weight += n.weight;
    }
    const std::int64_t step = step_of(vertex, 0);
    const std::int64_t variance = floor_divide(own, weight) + (3 * step * step >> 1) + 1;
    const std::int64_t light = color_[vertex * channels_] - guessed_[0];
    const std::int64_t slope =
        std::clamp<std::int64_t>(rounded_divide(256 * floor_divide(both, weight), variance), -1024, 1024);
    return static_cast<std::int32_t>((slope * light + 256) >> 9);
}

ColorGuess ColorGuesser::guess(std::size_t vertex, std::size_t channel) {
    ColorGuess out;
    out.channel = channel;
    out.step = step_of(vertex, channel);
    const auto known = plan_.of(vertex);
    out.neighbors = known.size();
    std::int32_t spread_around = 0, surprise = 8 * out.step;
    if (known.empty()) {
        out.value = first_color(vertex, channel);
    } else {
        out.value = mean(vertex, channel, calm_);
        if (channels_ >= 3 && (channel == 1 || channel == 2))
            out.value = std::clamp(out.value + gain_with_light(vertex, out), kLeast, kMost);
        spread_around = spread(vertex, channel, out.value);
        surprise = mean(vertex, channel, surprise_);
        const auto most = std::max_element(known.begin(), known.end(),
                                           [](const auto& a, const auto& b) { return a.weight < b.weight; });
        out.nearest = color_[most->vertex * channels_ + channel] - out.value;
    }
    guessed_[channel] = out.value;
    const int step_log = log16(out.step);
    out.spread = log16(1 + out.step / 16 + spread_around) - step_log;
    out.surprise = log16(1 + out.step / 16 + surprise) - step_log;
    for (std::size_t i = 0; i < std::min<std::size_t>(channel, 2); ++i) out.before[i] = before_[i];
    set_mixture(vertex, out);
    return out;
}

void ColorGuesser::set_mixture(std::size_t vertex, ColorGuess& guess) const {
    const Shape& shape = kShapes[std::min<std::size_t>(guess.channel, 2)];
    const auto known = plan_.of(vertex);
    int sum = shape.spread * guess.spread + shape.surprise * guess.surprise +
              shape.neighbors * static_cast<int>(std::min<std::size_t>(known.size(), 5)) +
              shape.fineness * log_fineness_[vertex] +
              shape.recent * (log16(kRecentUnit / 4 + recent_[guess.channel]) - 192);
    for (std::size_t i = 0; i < 2; ++i) sum += shape.before[i] * std::min(std::abs(guess.before[i]), 3);
    const int log = shape.base + (sum >> 8);
    std::int32_t all = 0;
    for (const auto& n : known) {
        const std::int32_t offset = color_[n.vertex * channels_ + guess.channel] - guess.value;
        const int wider = shape.near_base + (shape.near_fineness * log_fineness_[n.vertex] >> 8);
        const std::int32_t weight = shape.flat ? n.flat : n.weight;
        guess.mixture.add(guess.value + (offset * shape.pull >> 8), half_distance(guess.step, log + wider),
                          weight);
        all += weight;
    }
    guess.mixture.add(guess.value, half_distance(guess.step, log), std::max(all * shape.share >> 8, 1));
    guess.less = guess.mixture.below(guess.value - (guess.step + 1) / 2);
    guess.more = guess.beyond(0);
}

void ColorGuesser::set_level(std::size_t vertex, const ColorGuess& guess, int level) {
    const std::size_t i = vertex * channels_ + guess.channel;
    color_[i] = static_cast<std::int32_t>(
        std::clamp<std::int64_t>(guess.value + std::int64_t{guess.step} * level, kLeast, kMost));
    if (guess.channel < 2) before_[guess.channel] = level;
    if (guess.neighbors == 0) {  // nothing had been known
        calm_[i] = color_[i];
        return;
    }
    // Neighbours are predicted from what is not all of the surprise: part of it is the vertex's own.
    const std::int32_t off = color_[i] - guess.value;
    calm_[i] = color_[i] - ((off * (guess.channel == 0 ? 3 : 4) + 8) >> 4);
    surprise_[i] = std::abs(off);
    std::int32_t& recent = recent_[guess.channel];
    const std::int32_t size = std::min(std::abs(level), kMostRecent) * kRecentUnit;
    recent += static_cast<std::int32_t>(
        floor_divide(size - recent, std::min<std::int64_t>(as_int(vertex) + kRecentStart, kRecentLength)));
}

}  // namespace imgmesh::coding

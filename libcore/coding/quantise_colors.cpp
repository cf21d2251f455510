#include "libcore/coding/quantise_colors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libcore/base/index.h"
#include "libcore/coding/color_model.h"
#include "libcore/coding/normal_equations.h"

namespace imgmesh::coding {
namespace {

constexpr double kMostLevel = 32767;
// Sweeps of the fit before the first vertex is set.
constexpr int kSweeps = 100;

// Counts nothing: the model learns as the encoder's will.
struct NoCoder {
    bool code(bool bit, std::uint32_t) { return bit; }
};

// What a vertex's channel should be, as an offset from its guess [grey levels].
struct Target {
    double offset, step;
    double stiffness;  // squared error over squared offset
    double bit_price;
};

// The level that costs least of the nearest one, those that are up to two steps less, and 0.
int best_level(const ColorModel& model, const ColorGuess& guess, const Target& target) {
    const int nearest =
        static_cast<int>(std::lround(std::clamp(target.offset / target.step, -kMostLevel, kMostLevel)));
    const int inward = nearest > 0 ? -1 : 1;
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    const auto consider = [&](int level) {
        const double off = level * target.step - target.offset;
        const double cost = target.stiffness * off * off + target.bit_price * model.bits(guess, level);
        if (cost >= least) return;
        best = level;
        least = cost;
    };
    consider(0);
    for (int k = 0, level = nearest; k < 3 && level != 0; ++k, level += inward) consider(level);
    return best;
}

}  // namespace

QuantisedColors quantise_colors(const CodedShape& shape, const ColorPlan& plan,
                                std::span<const FaceMoments> moments, int channels,
                                const ColorChoice& choice) {
    NormalEquations fit(shape, moments, channels);
    const std::size_t count = shape.point.size(), depth = as_index(channels);
    fit.solve(kSweeps);
    QuantisedColors out;
    out.level.resize(count * depth);
    ColorModel model(plan, channels, choice.steps);
    NoCoder coder;
    for (std::size_t v = 0; v < count; ++v) {
        const double stiffness = fit.stiffness(v);
        for (std::size_t c = 0; c < depth; ++c) {
            const ColorGuess guess = model.guess(v, c);
            const Target target{fit.value(v, c) - guess.value / double{kColorUnit},
                                guess.step / double{kColorUnit}, choice.weight[c] * stiffness,
                                choice.bit_price};
            const int level = best_level(model, guess, target);
            out.bits += model.bits(guess, level);
            out.level[v * depth + c] = model.code(coder, v, guess, level);
            fit.set(v, c, model.values()[v * depth + c] / double{kColorUnit});
        }
        fit.settle_after(v);
    }
    out.value.assign(model.values().begin(), model.values().end());
    out.error = fit.error();
    return out;
}

}  // namespace imgmesh::coding

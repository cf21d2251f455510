// How the colours of a mesh become bits: the steps are those of encoder and decoder alike.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "libcore/coding/bit_model.h"
#include "libcore/coding/color_guess.h"
#include "libcore/coding/numbers.h"

namespace imgmesh::coding {

class ColorModel {
  public:
    /// channels  1 to 4; steps: of each coded channel, 1 to ColorGuesser::kMaxStep colour units
    ColorModel(const ColorPlan& plan, int channels, const std::array<std::int32_t, 4>& steps);

    /// Vertices go in order, and the channels of each in order: a guess is followed by its level.
    ColorGuess guess(std::size_t vertex, std::size_t channel) { return guesser_.guess(vertex, channel); }
    /// Codes a level, which a decoder's coder knows, and keeps it. Returns it.
    template <class Coder>
    int code(Coder& coder, std::size_t vertex, const ColorGuess& guess, int level) {
        level = code_level(coder, guess, level);
        guesser_.set_level(vertex, guess, level);
        return level;
    }
    /// Returns the bits that a level would take.
    double bits(const ColorGuess& guess, int level) const;

    /// Size V * channels, interleaved, in coded channels (color_transform.h).
    std::span<const std::int32_t> values() const { return guesser_.values(); }

  private:
    // A bit with all that its probability depends on.
    template <std::size_t Inputs>
    struct Decision {
        typename BitModel<Inputs>::Contexts contexts;
        int odds;
        std::size_t set;
    };
    static Decision<5> zero_decision(const ColorGuess& guess);
    static Decision<3> sign_decision(const ColorGuess& guess);
    // Whether a level is larger than `size`; at_least: the mixture's weight of levels that are not smaller.
    static Decision<3> size_decision(const ColorGuess& guess, int size, std::int32_t at_least,
                                     std::int32_t larger);

    template <class Coder>
    int code_level(Coder& coder, const ColorGuess& guess, int level) {
        const Decision<5> zero = zero_decision(guess);
        if (!zero_.code(coder, level != 0, zero.contexts, zero.odds, zero.set)) return 0;
        const Decision<3> sign = sign_decision(guess);
        const int direction = sign_.code(coder, level < 0, sign.contexts, sign.odds, sign.set) ? -1 : 1;
        const int wanted = level < 0 ? -level : level;
        std::int32_t at_least = direction < 0 ? guess.less : guess.more;
        for (int size = 1; size < kEscape; ++size) {
            const std::int32_t larger = guess.beyond(direction * size);
            const Decision<3> more = size_decision(guess, size, at_least, larger);
            if (!size_.code(coder, wanted > size, more.contexts, more.odds, more.set))
                return direction * size;
            at_least = larger;
        }
        const std::uint32_t rest = code_number(coder, static_cast<std::uint32_t>(wanted - kEscape), 0);
        return direction * (kEscape + static_cast<int>(std::min<std::uint32_t>(rest, kMostRest)));
    }
    static constexpr int kEscape = 16, kMostRest = 1 << 16;

    ColorGuesser guesser_;
    BitModel<5> zero_;
    BitModel<3> sign_, size_;
};

}  // namespace imgmesh::coding

#include "formats/compact/band_encode.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "formats/compact/band_pixel.h"
#include "libcore/base/index.h"

namespace imgmesh::compact {
namespace {

// The contexts of a component by place_of().
constexpr auto kContextOf = [] {
    std::array<std::uint8_t, kClasses * kEnergies> contexts{};
    for (int place = 0; place < kClasses * kEnergies; ++place)
        contexts[static_cast<std::size_t>(place)] =
            static_cast<std::uint8_t>(place / kEnergies * kLevels + level_of(place % kEnergies));
    return contexts;
}();

// Tells the numbers of known values, and writes down their tokens.
template <bool kMasked>
struct TokenSource {
    BandTokens& band;
    const std::int16_t* values[2];
    const std::uint8_t* inside;
    BandTokens::Token* out;
    std::uint32_t* counts;  // [component][class][level][token]

    template <int kComponent>
    IMGMESH_INLINE int code(int predicted, int energy, int x, std::int16_t& value) {
        if (kMasked && !inside[x]) {
            value = value_of(predicted, 0);
            return 0;
        }
        value = values[kComponent][x];
        const auto residual = static_cast<std::int16_t>(value - whole_of(predicted));
        const int number = number_of(turned(residual, has_negative_rest(predicted))),
                  context = kContextOf.data()[place_of(predicted, energy)];
        int token = number;
        if (number >= kPlainTokens) [[unlikely]] {
            std::size_t range = kTokenFirst.size() - 1;
            while (kTokenFirst[range] > number) --range;
            band.bits.push_back(static_cast<std::uint16_t>(number - kTokenFirst[range]));
            token = kPlainTokens + static_cast<int>(range);
        }
        ++counts[((kComponent * kClasses * kLevels) + context) * kTokens + token];
        *out++ = {static_cast<std::uint8_t>(context), static_cast<std::uint8_t>(token)};
        return number;
    }
};

template <bool kMasked>
void fill_tokens(const Band& in, const std::array<Taps, 2>& taps, BandTokens& band) {
    BandRows rows(in.width, taps);
    TokenSource<kMasked> source{
        band, {in.dx.data(), in.dy.data()}, in.inside.data(), band.tokens.data(), &band.counts[0][0][0][0]};
    for (int y = 0; y < in.rows; ++y) {
        rows.next_row();
        Lane lane(rows, taps);
        for (int x = 0; x < in.width; x += Chunk::kPixels) {
            const int count = std::min(Chunk::kPixels, in.width - x);
            rows.begin_chunk(x, count);
            TokenSource<kMasked> copy = source;  // which the loop's stores cannot change
            Lane lane_copy = lane;
            for (int i = 0; i < count; ++i) code_pixel(lane_copy, i, copy);
            lane = lane_copy;
            source.out = copy.out;
            rows.end_chunk(x, count);
            for (const std::int16_t*& values : source.values) values += count;
            if (kMasked) source.inside += count;
        }
    }
    band.tokens.resize(static_cast<std::size_t>(source.out - band.tokens.data()));
}

// For each frequency the number by which division is multiplication (Encoder::put).
constexpr auto kReciprocal = [] {
    std::array<std::uint64_t, (1 << kFrequencyBits) + 1> reciprocals{};
    for (std::uint64_t frequency = 1; frequency < reciprocals.size(); ++frequency)
        reciprocals[frequency] = ~std::uint64_t{0} / frequency;
    return reciprocals;
}();

// A state of rANS that takes tokens from the last to the first, and writes words from the last to the first.
struct Encoder {
    std::uint32_t state = kLowest;

    IMGMESH_INLINE void put(Slots slots, std::uint16_t*& words) {
        const std::uint32_t frequency = slots.frequency;
        put_word(state >= std::uint64_t{frequency} << (2 * kWordBits - kFrequencyBits), words);
        // floor((2^64 - 1) / f) (s + 1) / 2^64 is less than (s + 1) / f, by so little that its whole part is
        // that of s / f.
        const auto quotient = static_cast<std::uint32_t>(
            (static_cast<unsigned __int128>(kReciprocal.data()[frequency]) * (std::uint64_t{state} + 1)) >>
            64);
        state = (quotient << kFrequencyBits) + (state - quotient * frequency) + slots.first;
    }
    void put_bits(unsigned value, int count, std::uint16_t*& words) {
        put_word(state >= std::uint64_t{1} << (2 * kWordBits - count), words);
        state = (state << count) | value;
    }
    // Without a branch, for nobody can predict it.
    IMGMESH_INLINE void put_word(bool wanted, std::uint16_t*& words) {
        words[-1] = static_cast<std::uint16_t>(state);
        words -= wanted;
        state >>= wanted * kWordBits;
    }
};

}  // namespace

BandTokens band_tokens(const Band& in, const std::array<Taps, 2>& taps) {
    BandTokens band;
    band.tokens.resize(2 * in.dx.size());
    if (in.inside.empty())
        fill_tokens<false>(in, taps, band);
    else
        fill_tokens<true>(in, taps, band);
    return band;
}

void put_band(std::vector<std::uint8_t>& out, const BandTokens& band, const BandTables& tables) {
    // The slots of all tokens: [component][context][token].
    std::vector<Slots> slots(std::size_t{2} * kClasses * kLevels * kTokens);
    for (std::size_t i = 0; i < slots.size(); ++i) {
        const std::size_t level = i / kTokens % kLevels, rest_class = i / kTokens / kLevels % kClasses;
        slots[i] = tables.tables[tables.table_of[i / (slots.size() / 2)][rest_class][level]][i % kTokens];
    }
    // A token takes at most a word, so do the bits that follow it, and the states take four. One is spare,
    // for what is written before it is known to be wanted.
    std::vector<std::uint16_t> words(band.tokens.size() + band.bits.size() + 5);
    std::uint16_t* at = words.data() + words.size();
    Encoder x, y;
    const std::uint16_t* bits = band.bits.data() + band.bits.size();
    const auto put = [&](Encoder& encoder, BandTokens::Token token, const Slots* of) {
        if (token.token >= kPlainTokens) [[unlikely]]
            encoder.put_bits(*--bits, kTokenBits[as_index(token.token - kPlainTokens)], at);
        encoder.put(of[token.context * kTokens + token.token], at);
    };
    const Slots *slots_x = slots.data(), *slots_y = slots_x + slots.size() / 2;
    for (const BandTokens::Token* token = band.tokens.data() + band.tokens.size();
         token != band.tokens.data();) {
        token -= 2;
        put(y, token[1], slots_y);
        put(x, token[0], slots_x);
    }
    for (Encoder* encoder : {&y, &x})
        for (int word = 0; word < 2; ++word) encoder->put_word(true, at);
    const auto count = static_cast<std::size_t>(words.data() + words.size() - at);
    const std::size_t before = out.size();
    out.resize(before + 2 * count);
    std::memcpy(out.data() + before, at, 2 * count);
}

}  // namespace imgmesh::compact

#include "formats/compact/band_encode.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "formats/compact/known_chunk.h"
#include "libcore/base/index.h"

namespace imgmesh::compact {
namespace {

// Gives pixels outside the values that the decoder will give them. The magnitudes of residuals are no matter.
struct OutsideSource {
    const Chunk& chunk;
    const std::uint8_t* inside;

    template <int kComponent>
    IMGMESH_INLINE int code(int predicted, int, int i, std::int16_t& value) {
        value = inside[i] ? chunk.value.data()[kComponent].data()[i] : value_of(predicted, 0);
        return 0;
    }
};

// The first number of each token's range, 0 for plain tokens.
constexpr auto kFirstOf = [] {
    std::array<std::uint16_t, kTokens> first{};
    for (std::size_t k = 0; k < kTokenFirst.size(); ++k)
        first[kPlainTokens + k] = static_cast<std::uint16_t>(kTokenFirst[k]);
    return first;
}();

// Writes down what pixels are coded as.
struct TokenWriter {
    BandTokens& band;
    std::uint16_t* out;
    std::uint32_t* counts;  // [component][class][level][token]

    // `inside` may be null.
    void put(const ChunkTokens& chunk, int count, const std::uint8_t* inside) {
        std::uint16_t bits[2 * Chunk::kPixels + 1], *next = bits;
        const auto put_one = [&](std::size_t k, int i) {
            const std::uint16_t token = chunk.tokens.data()[k].data()[i];
            ++counts[k * (kClasses * kLevels * kTokens) + token];
            *out++ = token;
            // Without a branch, for nobody can predict it.
            *next = static_cast<std::uint16_t>(chunk.numbers.data()[k].data()[i] -
                                               kFirstOf.data()[token % kTokens]);
            next += token % kTokens >= kPlainTokens;
        };
        for (int i = 0; i < count; ++i) {
            if (inside && !inside[i]) continue;
            put_one(0, i);
            put_one(1, i);
        }
        band.bits.insert(band.bits.end(), bits, next);
    }
};

void fill_tokens(const Band& in, const std::array<Taps, 2>& taps, BandTokens& band) {
    BandRows rows(in.width, taps);
    ChunkTokens found;
    TokenWriter writer{band, band.tokens.data(), &band.counts[0][0][0][0]};
    std::size_t first = 0;
    for (int y = 0; y < in.rows; ++y) {
        rows.next_row();
        Lane lane(rows, taps);
        for (int x = 0; x < in.width; x += Chunk::kPixels) {
            const int count = std::min(Chunk::kPixels, in.width - x);
            rows.begin_chunk(x, count);
            std::copy_n(in.dx.data() + first, count, rows.chunk.value[0].data());
            std::copy_n(in.dy.data() + first, count, rows.chunk.value[1].data());
            const std::uint8_t* inside = nullptr;
            if (!in.inside.empty() &&
                std::count(in.inside.data() + first, in.inside.data() + first + count, 0)) {
                inside = in.inside.data() + first;
                Lane copy = lane;
                OutsideSource source{rows.chunk, inside};
                for (int i = 0; i < count; ++i) code_pixel(copy, i, source);
            }
            find_tokens(lane, count, found);
            writer.put(found, count, inside);
            rows.end_chunk(x, count);
            first += as_index(count);
        }
    }
    band.tokens.resize(static_cast<std::size_t>(writer.out - band.tokens.data()));
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
    std::uint64_t state = kLowest;  // of 32 bits

    IMGMESH_INLINE void put(Slots slots, std::uint16_t*& words) {
        const std::uint64_t frequency = slots.frequency;
        put_word(frequency << (2 * kWordBits - kFrequencyBits), words);
        // floor((2^64 - 1) / f) (s + 1) / 2^64 is less than (s + 1) / f, by so little that its whole part is
        // that of s / f.
        const auto quotient = static_cast<std::uint64_t>(
            (static_cast<unsigned __int128>(kReciprocal.data()[frequency]) * (state + 1)) >> 64);
        state += quotient * ((1 << kFrequencyBits) - frequency) + slots.first;
    }
    void put_bits(unsigned value, int count, std::uint16_t*& words) {
        put_word(std::uint64_t{1} << (2 * kWordBits - count), words);
        state = (state << count) | value;
    }
    // Writes a word if the state is not below `limit`. Without a branch, for nobody can predict it.
    IMGMESH_INLINE void put_word(std::uint64_t limit, std::uint16_t*& words) {
        words[-1] = static_cast<std::uint16_t>(state);
#if defined(__x86_64__)
        // As for the decoder, GCC needs more instructions.
        const std::uint64_t high = state >> kWordBits;
        std::uint64_t put = 0;
        asm("cmp %[limit], %[state]\n\tcmovae %[high], %[state]\n\tsbb $-1, %[put]"
            : [state] "+r"(state), [put] "+r"(put)
            : [high] "r"(high), [limit] "r"(limit)
            : "cc");
        words -= put;
#else
        const bool put = state >= limit;
        words -= put;
        state >>= put * kWordBits;
#endif
    }
};

}  // namespace

BandTokens band_tokens(const Band& in, const std::array<Taps, 2>& taps) {
    BandTokens band;
    band.tokens.resize(2 * in.dx.size());
    fill_tokens(in, taps, band);
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
    const auto put = [&](Encoder& encoder, std::uint16_t token, const Slots* of) {
        if (token % kTokens >= kPlainTokens) [[unlikely]]
            encoder.put_bits(*--bits, kTokenBits[as_index(token % kTokens - kPlainTokens)], at);
        encoder.put(of[token], at);
    };
    const Slots *slots_x = slots.data(), *slots_y = slots_x + slots.size() / 2;
    for (const std::uint16_t* token = band.tokens.data() + band.tokens.size(); token != band.tokens.data();) {
        token -= 2;
        put(y, token[1], slots_y);
        put(x, token[0], slots_x);
    }
    for (Encoder* encoder : {&y, &x})
        for (int word = 0; word < 2; ++word) encoder->put_word(0, at);
    const auto count = static_cast<std::size_t>(words.data() + words.size() - at);
    const std::size_t before = out.size();
    out.resize(before + 2 * count);
    std::memcpy(out.data() + before, at, 2 * count);
}

}  // namespace imgmesh::compact

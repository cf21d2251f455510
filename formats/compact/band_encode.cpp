#include "formats/compact/band_encode.h"

#include <algorithm>
#include <utility>

#include "formats/compact/band_pixel.h"
#include "libcore/base/index.h"

namespace imgmesh::compact {
namespace {

// Tells residuals of known values, and writes down their tokens.
template <bool kMasked>
struct TokenSource {
    BandTokens& band;
    const std::int16_t* values[2];
    const std::uint8_t* inside;
    BandTokens::Token* out;

    template <int kComponent>
    IMGMESH_INLINE int code(int rest_class, int energy, int whole, bool negative, int x) {
        if (kMasked && !inside[x]) return 0;
        const auto residual = static_cast<std::int16_t>(values[kComponent][x] - whole);
        const int number = number_of(negative ? -residual : residual), level = level_of(energy);
        int token = number;
        if (number >= kPlainTokens) [[unlikely]] {
            std::size_t range = kTokenFirst.size() - 1;
            while (kTokenFirst[range] > number) --range;
            band.bits.push_back(static_cast<std::uint16_t>(number - kTokenFirst[range]));
            token = kPlainTokens + static_cast<int>(range);
        }
        ++band.counts[kComponent][as_index(rest_class)][as_index(level)][as_index(token)];
        *out++ = {static_cast<std::uint8_t>(rest_class * kLevels + level), static_cast<std::uint8_t>(token)};
        return residual;
    }
};

template <bool kMasked>
void fill_tokens(const Band& in, const std::array<Taps, 2>& taps, BandTokens& band) {
    BandRows rows(in.width, taps);
    TokenSource<kMasked> source{band, {in.dx.data(), in.dy.data()}, in.inside.data(), band.tokens.data()};
    for (int y = 0; y < in.rows; ++y) {
        rows.next();
        Lane lane(rows, taps);
        for (int x = 0; x < in.width; ++x) code_pixel(lane, x, source);
        source.values[0] += in.width;
        source.values[1] += in.width;
        if (kMasked) source.inside += in.width;
    }
    band.tokens.resize(static_cast<std::size_t>(source.out - band.tokens.data()));
}

// A state of rANS that takes tokens from the last to the first.
class Encoder {
  public:
    explicit Encoder(std::vector<std::uint16_t>& words) : words_(words) {}

    IMGMESH_INLINE void put(Slots slots) {
        const std::uint32_t frequency = slots.frequency;
        if (state_ >= std::uint64_t{frequency} << (2 * kWordBits - kFrequencyBits)) put_word();
        state_ = ((state_ / frequency) << kFrequencyBits) + state_ % frequency + slots.first;
    }
    void put_bits(unsigned value, int count) {
        if (state_ >= std::uint64_t{1} << (2 * kWordBits - count)) put_word();
        state_ = (state_ << count) | value;
    }
    void finish() {
        put_word();
        put_word();
    }

  private:
    IMGMESH_INLINE void put_word() {
        words_.push_back(static_cast<std::uint16_t>(state_));
        state_ >>= kWordBits;
    }

    std::vector<std::uint16_t>& words_;
    std::uint32_t state_ = kLowest;
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
    // The slots of a token by its context.
    std::array<std::array<const TokenSlots*, kClasses * kLevels>, 2> slots_of{};
    for (std::size_t component = 0; component < 2; ++component)
        for (std::size_t context = 0; context < kClasses * kLevels; ++context)
            slots_of[component][context] =
                &tables.tables[tables.table_of[component][context / kLevels][context % kLevels]];
    std::vector<std::uint16_t> words;
    words.reserve(band.tokens.size() / 2);
    std::array<Encoder, 2> encoders{Encoder(words), Encoder(words)};
    std::size_t bits = band.bits.size();
    const auto put = [&](BandTokens::Token token, std::size_t component) {
        if (token.token >= kPlainTokens) [[unlikely]]
            encoders[component].put_bits(band.bits[--bits], kTokenBits[as_index(token.token - kPlainTokens)]);
        encoders[component].put((*slots_of[component][token.context])[token.token]);
    };
    for (std::size_t i = band.tokens.size(); i > 0; i -= 2) {
        put(band.tokens[i - 1], 1);
        put(band.tokens[i - 2], 0);
    }
    encoders[1].finish();
    encoders[0].finish();
    out.reserve(out.size() + 2 * words.size());
    for (std::size_t i = words.size(); i-- > 0;) {
        out.push_back(static_cast<std::uint8_t>(words[i]));
        out.push_back(static_cast<std::uint8_t>(words[i] >> 8));
    }
}

}  // namespace imgmesh::compact

#include "formats/compact/band_decode.h"

#include <algorithm>
#include <cstring>

#include "formats/compact/band_pixel.h"
#include "libcore/base/index.h"

namespace imgmesh::compact {
namespace {

// A pixel takes at most two words for each component. So many pixels are decoded before the place in the
// words is checked, and there is room for so many words behind them.
constexpr int kChunk = 1024, kSlackWords = 4 * kChunk;

// Decodes residuals.
template <bool kMasked>
struct TokenReader {
    const DecodeTables& tables;
    const std::uint16_t* words;
    const std::uint8_t* inside;
    std::uint32_t state[2];

    template <int kComponent>
    IMGMESH_INLINE int code(int rest_class, int energy, int /*whole*/, bool negative, int x) {
        if (kMasked && !inside[x]) return 0;
        std::uint32_t s = state[kComponent];
        const std::size_t table =
            tables
                .table_of[kComponent][static_cast<std::size_t>(rest_class)][static_cast<std::size_t>(energy)];
        const std::uint32_t slot = s & ((1u << kFrequencyBits) - 1);
        const std::size_t token = tables.token_of.data()[table].data()[slot];
        const Slots slots = tables.slots.data()[table].data()[token];
        s = refilled(slots.frequency * (s >> kFrequencyBits) + slot - slots.first);
        int number = static_cast<int>(token);
        if (number >= kPlainTokens) [[unlikely]] {
            const auto range = static_cast<std::size_t>(number - kPlainTokens);
            const int count = kTokenBits[range];
            number = kTokenFirst[range] + static_cast<int>(s & ((1u << count) - 1));
            s = refilled(s >> count);
        }
        state[kComponent] = s;
        const int residual = residual_of(number);
        return negative ? -residual : residual;
    }

    // Without a branch, for nobody can predict it.
    IMGMESH_INLINE std::uint32_t refilled(std::uint32_t s) {
        const bool low = s < kLowest;
        const std::uint32_t filled = (s << kWordBits) | *words;
        words += low;
        return low ? filled : s;
    }
};

class BandDecoder {
  public:
    BandDecoder(const CodedBand& band, const DecodeTables& tables)
        : band_(band),
          tables_(tables),
          rows_(band.width, tables.taps),
          count_(band.bytes.size() / 2),
          words_(count_ + kSlackWords) {
        std::memcpy(words_.data(), band.bytes.data(), 2 * count_);
    }

    template <bool kMasked>
    bool decode() {
        if (count_ < 4) return false;
        const auto state = [&](std::size_t i) {
            return static_cast<std::uint32_t>(words_[i]) << kWordBits | words_[i + 1];
        };
        TokenReader<kMasked> reader{tables_, words_.data() + 4, band_.inside.data(), {state(0), state(2)}};
        const auto width = as_index(band_.width);
        for (int y = 0; y < band_.rows; ++y) {
            rows_.next();
            Lane lane(rows_, tables_.taps);
            for (int x = 0; x < band_.width; x += kChunk) {
                const int end = std::min(band_.width, x + kChunk);
                for (int i = x; i < end; ++i) code_pixel(lane, i, reader);
                if (as_index(reader.words - words_.data()) > count_) return false;
            }
            const std::size_t first = as_index(y) * width;
            std::copy_n(rows_.x.value.get(), width, band_.dx.data() + first);
            std::copy_n(rows_.y.value.get(), width, band_.dy.data() + first);
            if (kMasked) reader.inside += width;
        }
        return ends_well(as_index(reader.words - words_.data()), reader.state);
    }

  private:
    // The encoder has begun with the lowest states; what follows is there for a band's least size.
    bool ends_well(std::size_t at, const std::uint32_t (&state)[2]) const {
        return state[0] == kLowest && state[1] == kLowest &&
               std::ranges::all_of(band_.bytes.subspan(2 * at), [](std::uint8_t byte) { return byte == 0; });
    }

    const CodedBand& band_;
    const DecodeTables& tables_;
    BandRows rows_;
    std::size_t count_;
    std::vector<std::uint16_t> words_;
};

}  // namespace

DecodeTables::DecodeTables(const BandTables& tables) : taps(tables.taps), slots(tables.tables) {
    for (std::size_t component = 0; component < 2; ++component)
        for (std::size_t rest_class = 0; rest_class < kClasses; ++rest_class)
            for (int energy = 0; energy <= kMaxEnergy; ++energy)
                table_of[component][rest_class][as_index(energy)] =
                    tables.table_of[component][rest_class][as_index(level_of(energy))];
    token_of.resize(slots.size());
    for (std::size_t table = 0; table < slots.size(); ++table)
        for (std::size_t token = 0; token < kTokens; ++token)
            std::fill_n(token_of[table].begin() + slots[table][token].first, slots[table][token].frequency,
                        static_cast<std::uint8_t>(token));
}

bool decode_band(const CodedBand& band, const DecodeTables& tables) {
    BandDecoder decoder(band, tables);
    if (band.inside.empty()) return decoder.decode<false>();
    if (!decoder.decode<true>()) return false;
    for (std::size_t i = 0; i < band.inside.size(); ++i)
        if (!band.inside[i]) band.dx[i] = band.dy[i] = 0;
    return true;
}

}  // namespace imgmesh::compact

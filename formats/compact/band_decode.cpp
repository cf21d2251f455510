#include "formats/compact/band_decode.h"

#include <algorithm>
#include <cstring>

#include "formats/compact/band_pixel.h"
#include "libcore/base/index.h"

namespace imgmesh::compact {
namespace {

// A pixel takes at most two words for each component. The place in the words is checked once for each chunk,
// and there is room for so many words behind them.
constexpr int kSlackWords = 4 * Chunk::kPixels;

// Decodes the residuals of a band. Pointers into the tables, because nothing that a loop stores changes them.
template <bool kMasked>
struct TokenReader {
    const std::uint8_t* table_of;  // [component][class][energy]
    const DecodeTables::TableSlots* tables;
    const std::uint16_t* words;
    const std::uint8_t* inside;
    std::uint32_t state[2];

    template <int kComponent>
    IMGMESH_INLINE int code(int predicted, int energy, int x, std::int16_t& value) {
        int residual = 0, size = 0;
        if (!kMasked || inside[x]) next_residual<kComponent>(place_of(predicted, energy), residual, size);
        value = value_of(predicted, residual);
        return size;
    }

    template <int kComponent>
    IMGMESH_INLINE void next_residual(int place, int& residual, int& size) {
        std::uint32_t s = state[kComponent];
        const std::size_t table = table_of[kComponent * kClasses * kEnergies + place];
        constexpr std::uint32_t kSlotMask = (1u << kFrequencyBits) - 1;
        const std::uint32_t slot = tables[table].data()[s & kSlotMask];
        const std::uint32_t frequency = static_cast<std::uint16_t>(slot);
        s = refilled(frequency * (s >> kFrequencyBits) + ((slot >> DecodeTables::kPlaceShift) & kSlotMask));
        residual = static_cast<std::int32_t>(slot) >> DecodeTables::kResidualShift;
        size = std::abs(residual);
        if (residual >= DecodeTables::kFirstRange) [[unlikely]] {
            const auto range = static_cast<std::size_t>(residual - DecodeTables::kFirstRange);
            const int count = kTokenBits[range];
            residual = residual_of(kTokenFirst[range] + static_cast<int>(s & ((1u << count) - 1)));
            size = std::min(std::abs(residual), kMaxMagnitude);
            s = refilled(s >> count);
        }
        state[kComponent] = s;
    }

    // Without a branch, for nobody can predict it.
    IMGMESH_INLINE std::uint32_t refilled(std::uint32_t s) {
        const std::uint32_t more = s << kWordBits | *words;
#if defined(__x86_64__)
        // GCC makes a branch of what is said otherwise, or twice the instructions.
        std::uint64_t taken = 0;
        asm("cmp %[lowest], %[s]\n\tcmovb %[more], %[s]\n\tadc $0, %[taken]"
            : [s] "+r"(s), [taken] "+r"(taken)
            : [more] "r"(more), [lowest] "i"(kLowest)
            : "cc");
        words += taken;
        return s;
#else
        const std::uint32_t low = s < kLowest;
        words += low;
        return s ^ ((s ^ more) & (0u - low));
#endif
    }
};

// A band while it is decoded.
template <bool kMasked>
class BandDecoder {
  public:
    BandDecoder(const CodedBand& band, const DecodeTables& tables)
        : band_(band),
          taps_(tables.taps),
          rows_(band.width, tables.taps),
          count_(band.bytes.size() / 2),
          words_(std::max<std::size_t>(count_, 4) + kSlackWords),
          lane_(rows_, taps_),
          reader_{
              tables.table_of[0][0].data(), tables.tables.data(), words_.data() + 4, band.inside.data(), {}} {
        std::memcpy(words_.data(), band.bytes.data(), 2 * count_);
        for (std::size_t i : {0, 1})
            reader_.state[i] = static_cast<std::uint32_t>(words_[2 * i]) << kWordBits | words_[2 * i + 1];
    }

    int rows() const { return band_.rows; }

    void begin_row() {
        rows_.next_row();
        lane_ = Lane(rows_, taps_);
    }
    void begin_chunk(int x, int count) { rows_.begin_chunk(x, count); }
    void end_chunk(int x, int count) {
        rows_.end_chunk(x, count);
        if (kMasked) reader_.inside += count;
    }

    /// Decodes a chunk of two bands in turns: neither waits for the other, and together they take little more
    /// time than one. The loop works on copies, which its stores cannot change.
    static void decode_pixels(BandDecoder& a, BandDecoder& b, int count) {
        Lane lane_a = a.lane_, lane_b = b.lane_;
        TokenReader<kMasked> reader_a = a.reader_, reader_b = b.reader_;
        for (int i = 0; i < count; ++i) {
            code_pixel(lane_a, i, reader_a);
            code_pixel(lane_b, i, reader_b);
        }
        a.lane_ = lane_a;
        b.lane_ = lane_b;
        a.reader_ = reader_a;
        b.reader_ = reader_b;
    }
    void decode_pixels(int count) {
        Lane lane = lane_;
        TokenReader<kMasked> reader = reader_;
        for (int i = 0; i < count; ++i) code_pixel(lane, i, reader);
        lane_ = lane;
        reader_ = reader;
    }

    /// Returns whether the words have lasted until now.
    bool sound() const { return place() <= count_; }

    void end_row(int y) {
        const std::size_t width = as_index(band_.width), first = as_index(y) * width;
        for (std::size_t component = 0; component < 2; ++component) {
            const std::int16_t* value = rows_.values(component);
            std::int16_t* to = (component == 0 ? band_.dx : band_.dy).data() + first;
            if (kMasked)
                for (std::size_t x = 0; x < width; ++x)
                    to[x] = band_.inside[first + x] ? value[x] : std::int16_t{0};
            else
                std::copy_n(value, width, to);
        }
    }

    /// The encoder has begun with the lowest states; what follows is there for a band's least size.
    bool ended_well() const {
        return sound() && reader_.state[0] == kLowest && reader_.state[1] == kLowest &&
               std::ranges::all_of(band_.bytes.subspan(2 * place()),
                                   [](std::uint8_t byte) { return byte == 0; });
    }

  private:
    std::size_t place() const { return as_index(reader_.words - words_.data()); }

    CodedBand band_;
    std::array<Taps, 2> taps_;
    BandRows rows_;
    std::size_t count_;
    std::vector<std::uint16_t> words_;
    Lane lane_;
    TokenReader<kMasked> reader_;
};

// Decodes the rows from `first` on of both bands; of a alone if there is no b.
template <bool kMasked>
bool decode_rows(BandDecoder<kMasked>& a, BandDecoder<kMasked>* b, int width, int first, int last) {
    for (int y = first; y < last; ++y) {
        a.begin_row();
        if (b) b->begin_row();
        for (int x = 0; x < width; x += Chunk::kPixels) {
            const int count = std::min(Chunk::kPixels, width - x);
            a.begin_chunk(x, count);
            if (b) {
                b->begin_chunk(x, count);
                BandDecoder<kMasked>::decode_pixels(a, *b, count);
                b->end_chunk(x, count);
            } else {
                a.decode_pixels(count);
            }
            a.end_chunk(x, count);
            if (!a.sound() || (b && !b->sound())) return false;
        }
        a.end_row(y);
        if (b) b->end_row(y);
    }
    return true;
}

template <bool kMasked>
bool decode(const CodedBand& first, const CodedBand* second, const DecodeTables& tables) {
    BandDecoder<kMasked> a(first, tables);
    if (!second) return decode_rows<kMasked>(a, nullptr, first.width, 0, first.rows) && a.ended_well();
    BandDecoder<kMasked> b(*second, tables);
    const int both = std::min(first.rows, second->rows);
    return decode_rows<kMasked>(a, &b, first.width, 0, both) &&
           decode_rows<kMasked>(a, nullptr, first.width, both, first.rows) &&
           decode_rows<kMasked>(b, nullptr, first.width, both, second->rows) && a.ended_well() &&
           b.ended_well();
}

}  // namespace

DecodeTables::DecodeTables(const BandTables& from) : taps(from.taps), tables(from.tables.size()) {
    for (std::size_t component = 0; component < 2; ++component)
        for (std::size_t rest_class = 0; rest_class < kClasses; ++rest_class)
            for (int energy = 0; energy < kEnergies; ++energy)
                table_of[component][rest_class][as_index(energy)] =
                    from.table_of[component][rest_class][as_index(level_of(energy))];
    for (std::size_t table = 0; table < tables.size(); ++table) {
        std::uint32_t* slot = tables[table].data();
        for (int token = 0; token < kTokens; ++token) {
            const std::uint32_t frequency = from.tables[table][as_index(token)].frequency;
            const int residual =
                token < kPlainTokens ? residual_of(token) : kFirstRange + token - kPlainTokens;
            for (std::uint32_t i = 0; i < frequency; ++i)
                *slot++ =
                    static_cast<std::uint32_t>(residual) << kResidualShift | i << kPlaceShift | frequency;
        }
    }
}

bool decode_bands(const CodedBand& first, const CodedBand* second, const DecodeTables& tables) {
    return first.inside.empty() ? decode<false>(first, second, tables) : decode<true>(first, second, tables);
}

}  // namespace imgmesh::compact

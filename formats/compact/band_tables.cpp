#include "formats/compact/band_tables.h"

#include <algorithm>
#include <cmath>

namespace imgmesh::compact {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Counts = std::array<std::uint32_t, kTokens>;

// Frequencies are stored as weights with three bits behind the leading one, by their place in the order of
// such numbers. Rounding to them costs less than 0.1 % of the bits.
constexpr int kWeightCodes = 96, kFirstCodeBits = 7, kRiceBits = 2;
constexpr std::uint64_t weight_of(int code) {
    return (8 + (static_cast<std::uint64_t>(code) & 7)) << (code >> 3);
}

// Bits, the lowest of a byte first.
class BitWriter {
  public:
    explicit BitWriter(Bytes& out) : out_(out) {}
    void put(unsigned value, int count) {
        for (int i = 0; i < count; ++i) {
            if (used_ == 0) out_.push_back(0);
            out_.back() = static_cast<std::uint8_t>(out_.back() | ((value >> i) & 1) << used_);
            used_ = (used_ + 1) % 8;
        }
    }

  private:
    Bytes& out_;
    int used_ = 0;
};

// Beyond the end there are zeros, and ended() says so.
class BitReader {
  public:
    explicit BitReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
    unsigned take(int count) {
        unsigned value = 0;
        for (int i = 0; i < count; ++i, ++at_)
            if (at_ / 8 < bytes_.size()) value |= ((bytes_[at_ / 8] >> (at_ % 8)) & 1u) << i;
        return value;
    }
    bool ended() const { return at_ > 8 * bytes_.size(); }
    bool last_byte() const { return (at_ + 7) / 8 == bytes_.size(); }

  private:
    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

// How many tokens a table has to list: all up to the last that occurs.
int listed(const Counts& counts) {
    int count = kTokens;
    while (count > 1 && counts[static_cast<std::size_t>(count - 1)] == 0) --count;
    return count;
}

std::uint64_t sum(const Counts& counts) {
    std::uint64_t total = 0;
    for (const std::uint32_t count : counts) total += count;
    return total;
}

// About the bits that a table takes, and the tokens with it.
double cost(const Counts& counts) {
    constexpr double kTableBits = 12, kEntryBits = 5;
    const double total = static_cast<double>(sum(counts));
    double bits = kTableBits + kEntryBits * listed(counts);
    for (const std::uint32_t count : counts)
        if (count > 0) bits += count * std::log2(total / count);
    return bits;
}

struct Cluster {
    int first_level;
    Counts counts;
    double bits;
};

Counts added(const Counts& a, const Counts& b) {
    Counts both = a;
    for (std::size_t i = 0; i < both.size(); ++i) both[i] += b[i];
    return both;
}

// Joins neighbouring levels, the most profitable pair first, as long as that saves bits.
std::vector<Cluster> clusters_of(const std::array<Counts, kLevels>& levels) {
    std::vector<Cluster> clusters;
    for (int level = 0; level < kLevels; ++level) {
        const Counts& counts = levels[static_cast<std::size_t>(level)];
        // Levels that do not occur are joined to the one below.
        if (level == 0 || sum(counts) > 0) clusters.push_back({level, counts, cost(counts)});
    }
    while (clusters.size() > 1) {
        std::size_t best = 0;
        Cluster joined{};
        double most = -1;
        for (std::size_t i = 0; i + 1 < clusters.size(); ++i) {
            const Cluster &a = clusters[i], &b = clusters[i + 1];
            const Counts both = added(a.counts, b.counts);
            const double bits = cost(both), saved = a.bits + b.bits - bits;
            if (saved <= most) continue;
            most = saved;
            best = i;
            joined = {a.first_level, both, bits};
        }
        if (most < 0) break;
        clusters[best] = joined;
        clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(best) + 1);
    }
    return clusters;
}

// Returns the code of the weight nearest to a share of the largest count.
int weight_code(std::uint32_t count, std::uint32_t largest) {
    if (count == 0 || largest == 0) return 0;
    const double wanted =
        static_cast<double>(count) / largest * static_cast<double>(weight_of(kWeightCodes - 1));
    int code = 0;
    while (code + 1 < kWeightCodes && static_cast<double>(weight_of(code) + weight_of(code + 1)) / 2 < wanted)
        ++code;
    return code;
}

unsigned zigzag(int difference) {
    return static_cast<unsigned>(number_of(difference));
}

void put_table(BitWriter& out, const Counts& counts) {
    const int count = listed(counts);
    const std::uint32_t largest = *std::max_element(counts.begin(), counts.end());
    out.put(static_cast<unsigned>(count - 1), 5);
    int before = 0;
    for (int token = 0; token < count; ++token) {
        const int code = weight_code(counts[static_cast<std::size_t>(token)], largest);
        if (token == 0) {
            out.put(static_cast<unsigned>(code), kFirstCodeBits);
        } else {
            const unsigned difference = zigzag(code - before);
            for (unsigned i = 0; i < difference >> kRiceBits; ++i) out.put(0, 1);
            out.put(1, 1);
            out.put(difference, kRiceBits);
        }
        before = code;
    }
}

// Shares all slots among the tokens by their weights: at least one each, and what rounding leaves to the
// first of the largest.
TokenSlots shared_slots(const std::array<std::uint64_t, kTokens>& weights, int count) {
    constexpr int kAll = 1 << kFrequencyBits;
    std::uint64_t total = 0;
    for (int token = 0; token < count; ++token) total += weights[static_cast<std::size_t>(token)];
    TokenSlots slots;
    int given = 0;
    std::size_t largest = 0;
    for (std::size_t token = 0; token < static_cast<std::size_t>(count); ++token) {
        slots[token].frequency = static_cast<std::uint16_t>(
            std::max<std::uint64_t>(1, (weights[token] << kFrequencyBits) / total));
        given += slots[token].frequency;
        if (slots[token].frequency > slots[largest].frequency) largest = token;
    }
    slots[largest].frequency = static_cast<std::uint16_t>(slots[largest].frequency + kAll - given);
    for (std::size_t token = 1; token < kTokens; ++token)
        slots[token].first = static_cast<std::uint16_t>(slots[token - 1].first + slots[token - 1].frequency);
    return slots;
}

std::optional<TokenSlots> read_table(BitReader& in) {
    const int count = static_cast<int>(in.take(5)) + 1;
    std::array<std::uint64_t, kTokens> weights{};
    int code = static_cast<int>(in.take(kFirstCodeBits));
    for (int token = 0; token < count; ++token) {
        if (token > 0) {
            unsigned difference = 0;
            while (in.take(1) == 0) {
                difference += 1u << kRiceBits;
                if (difference > 2 * kWeightCodes || in.ended()) return std::nullopt;
            }
            code += residual_of(static_cast<int>(difference + in.take(kRiceBits)));
        }
        if (code < 0 || code >= kWeightCodes) return std::nullopt;
        weights[static_cast<std::size_t>(token)] = weight_of(code);
    }
    return shared_slots(weights, count);
}

}  // namespace

Bytes table_bytes(const std::array<Taps, 2>& taps, const TokenCounts& counts) {
    Bytes bytes;
    BitWriter out(bytes);
    for (const Taps& of : taps)
        for (const std::int16_t tap : of) out.put(static_cast<std::uint16_t>(tap), 16);
    for (const auto& component : counts)
        for (const auto& levels : component) {
            const std::vector<Cluster> clusters = clusters_of(levels);
            for (int level = 1; level < kLevels; ++level)
                out.put(
                    std::ranges::any_of(clusters, [&](const Cluster& c) { return c.first_level == level; }),
                    1);
            for (const Cluster& cluster : clusters) put_table(out, cluster.counts);
        }
    return bytes;
}

std::optional<BandTables> read_tables(std::span<const std::uint8_t> bytes) {
    BandTables result;
    BitReader in(bytes);
    for (Taps& of : result.taps)
        for (std::int16_t& tap : of) {
            tap = static_cast<std::int16_t>(in.take(16));
            if (std::abs(tap) > kMaxTap) return std::nullopt;
        }
    for (auto& component : result.table_of)
        for (auto& levels : component) {
            std::size_t table = result.tables.size();
            for (int level = 0; level < kLevels; ++level) {
                if (level > 0) table += in.take(1);
                levels[static_cast<std::size_t>(level)] = static_cast<std::uint8_t>(table);
            }
            while (result.tables.size() <= table) {
                const std::optional<TokenSlots> slots = read_table(in);
                if (!slots) return std::nullopt;
                result.tables.push_back(*slots);
            }
        }
    return in.ended() || !in.last_byte() ? std::nullopt : std::optional(std::move(result));
}

}  // namespace imgmesh::compact

// The compact stream's pixels decoded slowly, one after the other, straight from docs/format.md: what the
// decoder has to equal.
#pragma once

#include <algorithm>
#include <stdexcept>

#include "formats/compact/band_decode.h"
#include "libcore/base/index.h"

namespace imgmesh {

/// Decodes a band; throws if the bytes do not end as they must.
class CompactReference {
  public:
    CompactReference(const compact::CodedBand& band, const compact::BandTables& tables)
        : band_(band), tables_(tables), at_(8) {
        for (std::size_t k = 0; k < 2; ++k) {
            state_[k] = word(4 * k) << 16 | word(4 * k + 2);
            const std::size_t pixels = as_index(band.width) * as_index(band.rows);
            value_[k].resize(pixels);
            size_[k].resize(pixels);
            plain_[k].resize(pixels);
        }
    }

    void decode() {
        for (int y = 0; y < band_.rows; ++y)
            for (int x = 0; x < band_.width; ++x) pixel(x, y);
        if (state_[0] != 1 << 16 || state_[1] != 1 << 16)
            throw std::runtime_error("the states do not return");
        for (std::size_t i = 0; i < value_[0].size(); ++i) {
            const bool inside = band_.inside.empty() || band_.inside[i];
            band_.dx[i] = inside ? value_[0][i] : std::int16_t{0};
            band_.dy[i] = inside ? value_[1][i] : std::int16_t{0};
        }
    }

  private:
    unsigned word(std::size_t at) const {
        return at + 1 < band_.bytes.size() ? band_.bytes[at] + 256u * band_.bytes[at + 1] : 0;
    }
    std::size_t index(int x, int y) const { return as_index(y) * as_index(band_.width) + as_index(x); }
    bool has(int x, int y) const { return x >= 0 && x < band_.width && y >= 0; }

    // Of a neighbour: beyond the left end the row above begins, beyond the right end the row goes on.
    int value(std::size_t k, int x, int y) const {
        if (x < 0) return y > 0 ? value_[k][index(0, y - 1)] : 0;
        return value_[k][index(std::min(x, band_.width - 1), std::max(y, 0))];
    }
    int size(std::size_t k, int x, int y) const { return has(x, y) ? size_[k][index(x, y)] : 0; }

    int prediction(std::size_t k, int x, int y) const {
        const auto v = [&](int dx, int dy) { return value(k, x + dx, y + dy); };
        if (y == 0) return 256 * v(-1, 0);
        const compact::Taps& t = tables_.taps[k];
        const int nn = y == 1 ? -1 : -2;
        return t[0] * v(-1, 0) + t[1] * v(-2, 0) + t[2] * v(0, -1) + t[3] * v(-1, -1) + t[4] * v(1, -1) +
               t[5] * v(0, nn) + t[6] * v(-2, -1) + t[7] * v(2, -1) + t[8] * v(-1, nn) + t[9] * v(1, nn);
    }
    int energy(std::size_t k, int x, int y) const {
        const auto s = [&](int dx, int dy) { return size(k, x + dx, y + dy); };
        return 4 * s(-1, 0) + 2 * s(-2, 0) + 4 * s(0, -1) + 2 * (s(-1, -1) + s(1, -1) + s(0, -2)) +
               s(-2, -1) + s(2, -1) + s(-1, -2) + s(1, -2);
    }
    int slope(int x, int y) const {
        int xx = 16, xy = 0;
        const auto add = [&](int dx, int dy, int weight) {
            if (!has(x + dx, y + dy)) return;
            const std::size_t i = index(x + dx, y + dy);
            const int a = std::clamp<int>(plain_[0][i], -31, 31), b = std::clamp<int>(plain_[1][i], -31, 31);
            xx += weight * a * a;
            xy += weight * a * b;
        };
        add(0, -1, 4);
        for (const int dx : {-1, 1}) add(dx, -1, 2);
        add(0, -2, 2);
        for (const int dx : {-2, 2}) add(dx, -1, 1);
        for (const int dx : {-1, 1}) add(dx, -2, 1);
        return std::clamp(64 * xy / xx, -256, 256);
    }

    void refill(unsigned& state) {
        if (state >= 1 << 16) return;
        state = state << 16 | word(at_);
        at_ += 2;
    }
    int number(std::size_t k, int prediction, int energy) {
        const int rest = std::abs(prediction - 256 * whole(prediction));
        const std::size_t rest_class = rest < 32 ? 0 : rest < 80 ? 1 : 2;
        const compact::TokenSlots& slots =
            tables_.tables[tables_.table_of[k][rest_class][as_index(compact::level_of(energy))]];
        unsigned& state = state_[k];
        const unsigned slot = state % 1024;
        std::size_t token = 0;
        while (slot >= unsigned{slots[token].first} + slots[token].frequency) ++token;
        state = slots[token].frequency * (state / 1024) + slot - slots[token].first;
        refill(state);
        if (token < 24) return static_cast<int>(token);
        const int bits = compact::kTokenBits[token - 24];
        const int more = static_cast<int>(state % (1u << bits));
        state >>= bits;
        refill(state);
        return compact::kTokenFirst[token - 24] + more;
    }

    // The nearest whole number; halves upwards.
    static int whole(int prediction) { return (prediction + 128) >> 8; }

    void component(std::size_t k, int x, int y, int prediction, int plain_prediction, int energy) {
        const std::size_t i = index(x, y);
        const bool inside = band_.inside.empty() || band_.inside[i];
        const int n = inside ? number(k, prediction, energy) : 0, magnitude = (n + 1) / 2;
        const bool negative = (n % 2 == 0) != (prediction < 256 * whole(prediction));
        value_[k][i] = static_cast<std::int16_t>(whole(prediction) + (negative ? -magnitude : magnitude));
        size_[k][i] = std::min(magnitude, 80);
        plain_[k][i] = static_cast<std::int16_t>(value_[k][i] - whole(plain_prediction));
    }

    void pixel(int x, int y) {
        const int px = prediction(0, x, y), py = prediction(1, x, y), ey = energy(1, x, y);
        component(0, x, y, px, px, energy(0, x, y) + ey / 8);
        const std::size_t i = index(x, y);
        const std::int64_t rest = std::int64_t{256} * value_[0][i] - px;
        component(1, x, y, py + static_cast<int>((slope(x, y) * rest) >> 6), py, ey + 2 * size_[0][i]);
    }

    compact::CodedBand band_;
    const compact::BandTables& tables_;
    std::size_t at_;
    unsigned state_[2];
    std::vector<std::int16_t> value_[2], plain_[2];
    std::vector<int> size_[2];
};

}  // namespace imgmesh

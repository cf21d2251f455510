#include "tools/common/text.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace imgmesh {
namespace {

// Returns the length of the well-formed UTF-8 sequence at `i`, or 0 (Unicode 15, table 3-7); sets its code
// point.
std::size_t utf8_length(const std::string& text, std::size_t i, std::uint32_t& code) {
    const auto byte = [&](std::size_t k) {
        return k < text.size() ? static_cast<std::uint8_t>(text[k]) : std::uint8_t{0};
    };
    const std::uint8_t lead = byte(i);
    if (lead < 0x80) {
        code = lead;
        return 1;
    }
    const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    code = lead & (0xFFu >> (length + 1));
    for (std::size_t k = 1; k < length; ++k) {
        if ((byte(i + k) & 0xC0) != 0x80) return 0;
        code = code << 6 | (byte(i + k) & 0x3F);
    }
    constexpr std::array<std::uint32_t, 5> kLeastCode = {0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
    return lead < 0xC2 || lead > 0xF4 || code < kLeastCode[length] || code > 0x10FFFF || surrogate ? 0
                                                                                                   : length;
}

bool is_printable(std::uint32_t code) {
    return code >= 0x20 && !(code >= 0x7F && code < 0xA0) && code != 0x2028 && code != 0x2029;
}

}  // namespace

std::string printable_line(const std::string& text) {
    std::string line;
    for (std::size_t i = 0; i < text.size();) {
        std::uint32_t code = 0;
        const std::size_t length = utf8_length(text, i, code);
        const std::size_t step = std::max<std::size_t>(length, 1);
        if (length > 0 && is_printable(code)) {
            line.append(text, i, length);
        } else {
            for (std::size_t k = i; k < i + step; ++k) {
                std::array<char, 5> escape{};
                std::snprintf(escape.data(), escape.size(), "\\x%02x", static_cast<std::uint8_t>(text[k]));
                line += escape.data();
            }
        }
        i += step;
    }
    return line;
}

void TextTable::print(std::ostream& out, int indent) const {
    std::size_t width = 0;
    for (const auto& [name, value] : rows_) width = std::max(width, name.size());
    for (const auto& [name, value] : rows_) {
        out << std::string(static_cast<std::size_t>(indent), ' ') << name
            << std::string(width - name.size() + 2, ' ') << printable_line(value) << '\n';
    }
}

std::string format_bytes(std::uint64_t bytes) {
    if (bytes < 1000) return std::to_string(bytes) + " B";
    constexpr std::array<const char*, 4> kUnits = {"kB", "MB", "GB", "TB"};
    double value = static_cast<double>(bytes) / 1000;
    std::size_t unit = 0;
    // 999.95 would print as 1000.0
    for (; value >= 999.95 && unit + 1 < kUnits.size(); ++unit) value /= 1000;
    std::ostringstream out;
    out << std::fixed << std::setprecision(1) << value << ' ' << kUnits[unit];
    return out.str();
}

std::string format_number(double value, int digits) {
    std::ostringstream out;
    out << std::setprecision(digits) << value;
    return out.str();
}

}  // namespace imgmesh

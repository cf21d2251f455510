#include "tools/common/text.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <string_view>

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

// Controls of terminals, and what changes the direction or the lines of the text around it (Unicode Standard
// Annex 9): a name could look like another one.
bool is_printable(std::uint32_t code) {
    const auto among = [code](std::uint32_t first, std::uint32_t last) {
        return code >= first && code <= last;
    };
    return !(among(0, 0x1F) || among(0x7F, 0x9F) || code == 0x61C || among(0x200E, 0x200F) ||
             among(0x2028, 0x202E) || among(0x2066, 0x2069) || among(0xFFF9, 0xFFFB) || code == 0xFEFF ||
             among(0xE0000, 0xE007F));
}

std::string escape(const char* format, std::uint32_t number) {
    std::array<char, 16> text{};  // the compiler knows no bound of the number
    std::snprintf(text.data(), text.size(), format, number);
    return text.data();
}

// Replaces what is not printable by what `replace` makes of its code point (0 if it is not UTF-8) and its
// bytes.
template <typename Replace>
std::string escaped(const std::string& text, Replace&& replace) {
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        std::uint32_t code = 0;
        const std::size_t length = utf8_length(text, i, code);
        const std::size_t step = std::max<std::size_t>(length, 1);
        if (length > 0 && is_printable(code))
            out.append(text, i, length);
        else
            out += replace(length > 0 ? code : 0, std::string_view(text).substr(i, step));
        i += step;
    }
    return out;
}

}  // namespace

std::string printable_line(const std::string& text) {
    return escaped(text, [](std::uint32_t, std::string_view bytes) {
        std::string line;
        for (const char byte : bytes) line += escape("\\x%02x", static_cast<std::uint8_t>(byte));
        return line;
    });
}

std::string printable_text(const std::string& text) {
    std::string lines;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t end = std::min(text.find('\n', i), text.size());
        lines += printable_line(text.substr(i, end - i));
        if (end < text.size()) lines += '\n';
        i = end + 1;
    }
    return lines;
}

std::string printable_json(const std::string& json) {
    return escaped(json, [](std::uint32_t code, std::string_view bytes) {
        if (code == '\n') return std::string(bytes);
        if (code < 0x10000) return escape("\\u%04x", code);
        constexpr std::uint32_t kLead = 0xD800 - (0x10000 >> 10), kTrail = 0xDC00;
        return escape("\\u%04x", kLead + (code >> 10)) + escape("\\u%04x", kTrail + (code & 0x3FF));
    });
}

std::string shortened(const std::string& text, std::size_t most) {
    if (text.size() <= most) return text;
    const std::string_view dots = "...";
    const auto inside_character = [&](std::size_t i) {
        return (static_cast<std::uint8_t>(text[i]) & 0xC0) == 0x80;
    };
    std::size_t head = (most - dots.size()) * 2 / 3, tail = text.size() - (most - dots.size() - head);
    while (head > 0 && inside_character(head)) --head;
    while (tail < text.size() && inside_character(tail)) ++tail;
    return text.substr(0, head).append(dots).append(text, tail);
}

void TextTable::print(std::ostream& out, int indent) const {
    std::size_t width = 0;
    for (const auto& [name, value] : rows_) width = std::max(width, printable_line(name).size());
    for (const auto& [name, value] : rows_) {
        const std::string printed = printable_line(name);
        out << std::string(static_cast<std::size_t>(indent), ' ') << printed
            << std::string(width - printed.size() + 2, ' ') << printable_line(value) << '\n';
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

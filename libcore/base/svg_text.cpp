#include "libcore/base/svg_text.h"

#include <cmath>
#include <cstdlib>

namespace imgmesh {

void append_number(std::string& out, double value) {
    long hundredths = std::lround(value * 100);
    if (hundredths < 0) out += '-';
    hundredths = std::abs(hundredths);
    if (hundredths >= 100 || hundredths == 0) out += std::to_string(hundredths / 100);
    if (hundredths % 100 == 0) return;
    out += '.';
    out += static_cast<char>('0' + hundredths / 10 % 10);
    if (hundredths % 10 != 0) out += static_cast<char>('0' + hundredths % 10);
}

void append_point(std::string& out, char command, const Vec2d& p) {
    out += command;
    append_number(out, p.x());
    out += ' ';
    append_number(out, p.y());
}

void append_hex(std::string& out, const Vec3d& codes) {
    constexpr char kDigits[] = "0123456789abcdef";
    out += '#';
    for (int c = 0; c < 3; ++c) {
        const auto byte = static_cast<unsigned>(std::lround(codes[c]));
        out += kDigits[byte >> 4];
        out += kDigits[byte & 15];
    }
}

}  // namespace imgmesh

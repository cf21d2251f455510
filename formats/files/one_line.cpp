#include "formats/files/one_line.h"

namespace imgmesh {
namespace {

bool is_control(char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
}

}  // namespace

std::string one_line(const std::string& message) {
    constexpr std::size_t kMaxLength = 300;
    std::string line;
    for (const char c : message) {
        const bool end = c == '\n' || c == '\r';
        if (end && (line.empty() || line.back() == ' ')) continue;
        if (end)
            line += "; ";
        else
            line += is_control(c) ? '?' : c;
    }
    while (!line.empty() && (line.back() == ' ' || line.back() == ';' || line.back() == '.')) line.pop_back();
    if (line.size() > kMaxLength) line = line.substr(0, kMaxLength) + "...";
    return line.empty() ? "the library gives no reason" : line;
}

std::string printable(std::string text, char instead) {
    for (char& c : text)
        if (is_control(c)) c = instead;
    return text;
}

}  // namespace imgmesh

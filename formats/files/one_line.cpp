#include "formats/files/one_line.h"

namespace imgmesh {

std::string one_line(const std::string& message) {
    constexpr std::size_t kMaxLength = 300;
    std::string line;
    for (const char c : message) {
        const bool end = c == '\n' || c == '\r';
        if (end && (line.empty() || line.back() == ' ')) continue;
        if (end)
            line += "; ";
        else
            line += static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? '?' : c;
    }
    while (!line.empty() && (line.back() == ' ' || line.back() == ';' || line.back() == '.')) line.pop_back();
    if (line.size() > kMaxLength) line = line.substr(0, kMaxLength) + "...";
    return line.empty() ? "the library gives no reason" : line;
}

std::string printable(std::string name) {
    for (char& c : name)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
    return name;
}

}  // namespace imgmesh

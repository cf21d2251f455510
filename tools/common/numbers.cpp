#include "tools/common/numbers.h"

#include <charconv>

#include "libcore/base/error.h"
#include "tools/common/text.h"

namespace imgmesh {
namespace {

// Converts all of `text` or nothing.
template <typename Value>
bool parse_whole(const std::string& text, Value& value) {
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && stop == end;
}

[[noreturn]] void refuse(const std::string& name, const std::string& text, const std::string& expected) {
    throw Error(ErrorKind::kBadArgument, cat(name, " '", shortened(text), "': expected ", expected));
}

}  // namespace

std::int64_t parse_count(const std::string& name, const std::string& text, const CountRange& range) {
    std::int64_t value = 0;
    if (!parse_whole(text, value) || !contains(range, value)) refuse(name, text, describe(range));
    return value;
}

double parse_number(const std::string& name, const std::string& text, const NumberRange& range) {
    double value = 0;
    if (!parse_whole(text, value) || !contains(range, value)) refuse(name, text, describe(range));
    return value;
}

GridSize parse_size(const std::string& name, const std::string& text, int most_side,
                    std::int64_t most_pixels) {
    const std::size_t cross = text.find('x');
    if (cross == std::string::npos) refuse(name, text, "WIDTHxHEIGHT, as in 640x480");
    const CountRange range{1, most_side};
    const GridSize size{static_cast<int>(parse_count(name, text.substr(0, cross), range)),
                        static_cast<int>(parse_count(name, text.substr(cross + 1), range))};
    if (std::int64_t{size.width} * size.height > most_pixels)
        refuse(name, text, cat("at most ", most_pixels, " pixels in all"));
    return size;
}

}  // namespace imgmesh

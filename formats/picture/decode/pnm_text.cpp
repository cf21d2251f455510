#include "formats/picture/decode/pnm_text.h"

#include <charconv>
#include <cmath>

#include "formats/files/byte_reader.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

bool is_space(int c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}
bool is_digit(int c) {
    return c >= '0' && c <= '9';
}

}  // namespace

void PnmText::fail(const char* what, const char* found) const {
    throw Error(ErrorKind::kBadFile, cat(path_, ": the Netpbm file ", found, ", expected its ", what));
}

int PnmText::next() {
    if (at_ == bytes_.size()) return -1;
    const int c = bytes_[at_++];
    if (c != '#') return c;
    while (at_ < bytes_.size() && bytes_[at_] != '\n' && bytes_[at_] != '\r') ++at_;
    if (at_ < bytes_.size()) ++at_;
    return '\n';
}

int PnmText::after_space(const char* what) {
    int c = next();
    while (is_space(c)) c = next();
    if (c < 0) fail(what, "is truncated");
    return c;
}

std::int64_t PnmText::number(const char* what) {
    int c = after_space(what);
    if (!is_digit(c)) fail(what, "has another character than a digit");
    constexpr std::int64_t kLargest = 1'000'000'000;  // far above all that is accepted
    std::int64_t value = 0;
    for (; is_digit(c); c = next()) {
        value = 10 * value + (c - '0');
        if (value > kLargest) fail(what, "has too large a number");
    }
    if (c >= 0) {
        if (!is_space(c)) fail(what, "has another character than a digit");
        if (is_space(bytes_[at_ - 1])) --at_;  // a header ends with it; no comment does at the end of a file
    }
    return value;
}

float PnmText::real(const char* what) {
    after_space(what);
    const std::string_view all = text_of(bytes_.subspan(at_ - 1));
    const std::string_view word = all.substr(0, all.find_first_of(" \t\n\v\f\r"));
    const std::size_t sign = word.starts_with('+') ? 1 : 0;  // which from_chars() does not know
    float value = 0;
    const auto [end, failure] = std::from_chars(word.data() + sign, word.data() + word.size(), value);
    if (failure != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
        fail(what, "has no number");
    at_ += word.size() - 1;
    return value;
}

bool PnmText::bit() {
    const int c = after_space("pixels");
    if (c != '0' && c != '1') fail("pixels", "has another character than 0 and 1");
    return c == '1';
}

void PnmText::end_header() {
    if (!is_space(next())) fail("pixels", "is truncated");
}

std::string_view PnmText::line() {
    const std::string_view all = text_of(rest());
    const std::size_t length = all.find('\n');
    if (length == std::string_view::npos) fail("ENDHDR", "is truncated");
    at_ += length + 1;
    std::string_view line = all.substr(0, length);
    while (!line.empty() && is_space(line.back())) line.remove_suffix(1);
    while (!line.empty() && is_space(line.front())) line.remove_prefix(1);
    return line;
}

}  // namespace imgmesh

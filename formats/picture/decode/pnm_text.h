// Reads the text in Netpbm's files: their headers, and the samples of those that have no bytes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace imgmesh {

/// A '#' starts a comment that ends with its line, wherever it stands. All but rest() throw Error(kBadFile)
/// that names `path` if the text ends early or is not what is asked for.
class PnmText {
  public:
    PnmText(const std::string& path, std::span<const std::uint8_t> bytes) : path_(path), bytes_(bytes) {}

    /// Takes an unsigned decimal number after any white space; `what` it is, for messages.
    std::int64_t number(const char* what);
    /// Takes a finite number with sign, point and exponent, as C writes it.
    float real(const char* what);
    /// Takes a digit 0 or 1; others may follow it without a space.
    bool bit();
    /// Takes the one white-space character between a header and its pixels.
    void end_header();
    /// Takes the rest of a line, without white space at its ends.
    std::string_view line();

    std::span<const std::uint8_t> rest() const { return bytes_.subspan(at_); }

  private:
    int next();  // the next character, a line feed for a comment, -1 at the end
    int after_space(const char* what);
    [[noreturn]] void fail(const char* what, const char* found) const;

    const std::string& path_;
    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

}  // namespace imgmesh

// Text for people: error lines, tables, units.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

namespace imgmesh {

/// Returns `text` as one line that a terminal shows unchanged: control characters, what changes the direction
/// of text or ends lines, and bytes that are not UTF-8 become \xNN.
std::string printable_line(const std::string& text);

/// The same for a text of many lines: its line feeds stay.
std::string printable_text(const std::string& text);

/// The same for JSON in UTF-8, where these characters occur in strings alone: they become \uNNNN, so the
/// JSON stays the same to whoever parses it.
std::string printable_json(const std::string& json);

/// Returns `text`, or where it is longer than `most` bytes its beginning and its end with "..." between them:
/// whole characters of UTF-8, and at most `most` bytes. For what messages quote.
std::string shortened(const std::string& text, std::size_t most = 60);

/// Rows of a name and a value, printed with the values aligned.
class TextTable {
  public:
    void add(std::string name, std::string value) { rows_.emplace_back(std::move(name), std::move(value)); }
    void print(std::ostream& out, int indent) const;

  private:
    std::vector<std::pair<std::string, std::string>> rows_;
};

/// 999 -> "999 B", 28345 -> "28.3 kB" (units of 1000).
std::string format_bytes(std::uint64_t bytes);
/// Prints `value` with `digits` significant digits, and never with an exponent for 1e-4 <= |value| < 1e6.
std::string format_number(double value, int digits = 4);

}  // namespace imgmesh

#include "formats/findings/json_parse.h"

#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "formats/findings/findings.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using nlohmann::json;

// A container's JSON has some kilobytes; a DOM of other content takes twenty times its text.
constexpr std::size_t kMaxJsonBytes = std::size_t{64} << 20;

// Reads the text once without a DOM, so that a DOM is made only of text that is worth its memory. (The
// parser's own callback would do, but its time grows with the square of the members of an object or array.)
class Scan : public nlohmann::json_sax<json> {
  public:
    Scan(const JsonLimits& limits, Findings& findings)
        : limits_(limits), wants_names_(findings.collects()), duplicates_(findings, "json.duplicate") {}

    bool null() override { return count(); }
    bool boolean(bool) override { return count(); }
    bool number_integer(number_integer_t) override { return count(); }
    bool number_unsigned(number_unsigned_t) override { return count(); }
    bool number_float(number_float_t, const string_t&) override { return count(); }
    bool string(string_t&) override { return count(); }
    bool binary(binary_t&) override { return count(); }
    bool start_object(std::size_t) override {
        enter();
        if (wants_names_) names_.emplace_back();
        return true;
    }
    bool key(string_t& name) override {
        // The parser keeps the last member of a name.
        if (wants_names_ && !names_.back().insert(name).second)
            duplicates_.hit([&] { return std::pair(cat("\"", name, "\" is there twice"), Place()); });
        return true;
    }
    bool end_object() override {
        --depth_;
        if (wants_names_) names_.pop_back();
        return true;
    }
    bool start_array(std::size_t) override {
        enter();
        return true;
    }
    bool end_array() override {
        --depth_;
        return true;
    }
    bool parse_error(std::size_t, const std::string&, const json::exception& error) override {
        // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
        std::string what = error.what();
        if (const auto end = what.find("] "); what.starts_with('[') && end != std::string::npos)
            what.erase(0, end + 2);
        refuse("json.syntax", what);
    }

  private:
    bool count() {
        if (++values_ > limits_.max_values)
            refuse("limits.json", cat("JSON of more than ", limits_.max_values, " values"));
        return true;
    }
    void enter() {
        count();
        if (++depth_ > limits_.max_depth) refuse("json.depth", cat("nested deeper than ", limits_.max_depth));
    }

    JsonLimits limits_;
    bool wants_names_;
    Repeated duplicates_;
    std::size_t values_ = 0;
    int depth_ = 0;
    std::vector<std::set<std::string>> names_;
};

}  // namespace

json parse_json(std::string_view text, const JsonLimits& limits, Findings& findings) {
    if (text.size() > kMaxJsonBytes)
        refuse("limits.json", cat("JSON of ", text.size(), " bytes, at most ", kMaxJsonBytes));
    if (text.starts_with("\xEF\xBB\xBF")) findings.add("json.bom", "the JSON starts with a byte order mark");
    // The parser would stop here, and only other programs would read the rest.
    if (text.find('\0') != std::string_view::npos) refuse("json.syntax", "a byte of value 0");
    Scan scan(limits, findings);
    json::sax_parse(text.begin(), text.end(), &scan);
    return json::parse(text.begin(), text.end());
}

}  // namespace imgmesh

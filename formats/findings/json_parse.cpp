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

// Reports duplicate members of an object, of which the parser keeps the last.
class DuplicateFinder {
  public:
    explicit DuplicateFinder(Findings& findings) : duplicates_(findings, "json.duplicate") {}

    void see(json::parse_event_t event, const json& parsed) {
        if (event == json::parse_event_t::object_start) {
            names_.emplace_back();
        } else if (event == json::parse_event_t::object_end) {
            names_.pop_back();
        } else if (event == json::parse_event_t::key) {
            const auto& name = parsed.get_ref<const std::string&>();
            if (!names_.back().insert(name).second)
                duplicates_.hit([&] { return std::pair(cat("\"", name, "\" is there twice"), Place()); });
        }
    }

  private:
    Repeated duplicates_;
    std::vector<std::set<std::string>> names_;
};

}  // namespace

json parse_json(std::string_view text, int max_depth, Findings& findings) {
    if (text.size() > kMaxJsonBytes)
        refuse("limits.json", cat("JSON of ", text.size(), " bytes, at most ", kMaxJsonBytes));
    if (text.starts_with("\xEF\xBB\xBF")) findings.add("json.bom", "the JSON starts with a byte order mark");
    // The parser would stop here, and only other programs would read the rest.
    if (text.find('\0') != std::string_view::npos) refuse("json.syntax", "a byte of value 0");
    DuplicateFinder duplicates(findings);
    const auto guard = [&](int depth, json::parse_event_t event, json& parsed) {
        if (depth > max_depth) refuse("json.depth", cat("nested deeper than ", max_depth));
        if (findings.collects()) duplicates.see(event, parsed);
        return true;
    };
    try {
        return json::parse(text.begin(), text.end(), guard);
    } catch (const json::exception& error) {
        // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
        std::string what = error.what();
        if (const auto end = what.find("] "); what.starts_with('[') && end != std::string::npos)
            what.erase(0, end + 2);
        refuse("json.syntax", what);
    }
}

}  // namespace imgmesh

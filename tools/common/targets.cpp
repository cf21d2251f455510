#include "tools/common/targets.h"

#include <nlohmann/json.hpp>

#include "tools/common/options.h"

namespace imgmesh {
namespace {

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += (text.empty() ? "" : "; ") + line;
    return text;
}

}  // namespace

void add_strict_option(CLI::App& app, bool& strict) {
    in_group(add_flag(
                 app, "--strict", [&strict] { strict = true; },
                 "A number that cannot be reached is an error with exit code 5, and nothing is written; "
                 "without this it is a warning"),
             "General");
}

MissedTargets::MissedTargets(const std::string& input, std::vector<std::string> missed)
    : Error(ErrorKind::kUnsupported, cat(input, ": ", joined(missed))), missed_(std::move(missed)) {}

void tell_missed(const std::string& input, const std::vector<std::string>& missed, bool strict,
                 std::vector<std::string>& warnings) {
    if (strict && !missed.empty()) throw MissedTargets(input, missed);
    for (const std::string& line : missed) warnings.push_back(cat(input, ": ", line));
}

Report target_report(const std::vector<std::string>& missed) {
    Report report = {{"target_reached", missed.empty()}};
    if (!missed.empty()) report["reason"] = joined(missed);
    return report;
}

}  // namespace imgmesh

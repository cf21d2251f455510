#include "tools/common/parameters.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "tools/common/help.h"
#include "tools/common/options.h"

namespace imgmesh {
namespace {

// A word that is a number as JSON writes it becomes one.
Report value_report(const std::string& text) {
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) return text;
    if (number == std::floor(number) && std::abs(number) < 1e15) return static_cast<std::int64_t>(number);
    return number;
}

bool is_output(const Tool& tool, const std::string& name) {
    return name == "--output" || name == "--format" ||
           std::ranges::find(tool.sides, name, &SideFile::option) != tool.sides.end();
}

}  // namespace

Report parameters_report(const Tool& tool, const CLI::App& app) {
    Report report = Report::object();
    for (const OptionValue& option : option_values(app)) {
        if (option.group == kGeneralGroup || is_output(tool, option.name)) continue;
        Report& value = report[option.name.substr(2)];
        if (option.flag)
            value = !option.values.empty();
        else if (option.values.size() == 1)
            value = value_report(option.values.front());
        else if (!option.values.empty())
            for (const std::string& text : option.values) value.push_back(value_report(text));
        else if (option.otherwise)
            value = value_report(*option.otherwise);
    }
    return report;
}

}  // namespace imgmesh

#include "tools/common/parameters.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <string_view>
#include <system_error>

#include "formats/files/sha256.h"
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
    return name == "--output" || name == "--format" || name == "--skip-existing" || name == "--force" ||
           std::ranges::find(tool.sides, name, &SideFile::option) != tool.sides.end();
}

// Returns what parameters_report() does, without the options under these headings.
Report parameters_but(const Tool& tool, const CLI::App& app, std::initializer_list<std::string_view> groups) {
    Report report = Report::object();
    for (const OptionValue& option : option_values(app)) {
        if (std::ranges::find(groups, option.group) != groups.end() || is_output(tool, option.name)) continue;
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

}  // namespace

Report parameters_report(const Tool& tool, const CLI::App& app) {
    return parameters_but(tool, app, {kGeneralGroup});
}

Report journal_parameters(const Tool& tool, const CLI::App& app) {
    Report report = parameters_but(tool, app, {kGeneralGroup, kLimitsGroup});
    for (const std::string& option : tool.sources) {
        Report& value = report[option.substr(2)];
        if (!value.is_string()) continue;
        const std::string path = value.get<std::string>(), hash = file_sha256_hex(path);
        std::error_code error;
        if (!hash.empty())
            value = hash;
        else if (std::filesystem::exists(path, error))
            return nullptr;  // a name alone, as in a sprite's .json, counts as it is
    }
    return report;
}

}  // namespace imgmesh

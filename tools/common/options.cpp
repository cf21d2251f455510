#include "tools/common/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace imgmesh {

bool same_name(const std::string& a, const std::string& b) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [&](char x, char y) { return lower(x) == lower(y); });
}

CLI::Option* add_value(CLI::App& app, const std::string& name, const std::string& type,
                       std::function<void(const std::string&)> take, const Help& help) {
    CLI::Option* option = app.add_option(
        name,
        [take = std::move(take)](const CLI::results_t& results) {
            take(results.front());
            return true;
        },
        help.otherwise.empty() ? help.text : cat(help.text, " (default ", help.otherwise, ")"));
    option->type_name(type);
    if (help.exact) option->default_str(help.otherwise);
    return option;
}

CLI::Option* add_values(CLI::App& app, const std::string& name, const std::string& type,
                        std::function<void(const std::string&)> take, const Help& help) {
    CLI::Option* option = app.add_option(
        name,
        [take = std::move(take)](const CLI::results_t& results) {
            for (const std::string& result : results) take(result);
            return true;
        },
        help.text);
    // Each value needs the option's name before it, so that what follows is free for files.
    return option->type_name(type)
        ->expected(1, CLI::detail::expected_max_vector_size)
        ->allow_extra_args(false);
}

CLI::Option* add_flag(CLI::App& app, const std::string& name, std::function<void()> take,
                      const std::string& help) {
    return app.add_flag_callback(name, std::move(take), help);
}

CLI::Option* add_inputs(CLI::App& app, const std::string& name, std::vector<std::string>& inputs,
                        const std::string& help) {
    CLI::Option* option = app.add_option(
        name,
        [&inputs](const CLI::results_t& results) {
            inputs = results;
            return true;
        },
        help);
    return option->expected(1, CLI::detail::expected_max_vector_size)
        ->allow_extra_args()
        ->type_name("")
        ->required();
}

CLI::Option* require(CLI::Option* option) {
    return option->required();
}

CLI::Option* add_file(CLI::App& app, const std::string& name, std::string& target, const std::string& help) {
    const std::string long_name = name.substr(name.find("--"));
    return add_value(
        app, name, "FILE",
        [&target, long_name](const std::string& text) {
            if (text.empty())
                throw Error(ErrorKind::kBadArgument, cat(long_name, " '': expected a file name"));
            target = text;
        },
        help);
}

void exclude(CLI::App& app, CLI::Option* option, const std::vector<std::string>& names) {
    for (const std::string& name : names) option->excludes(app.get_option(name));
}

CLI::Option* needs(CLI::Option* option, CLI::Option* other) {
    return option->needs(other);
}

CLI::Option* in_group(CLI::Option* option, const std::string& group) {
    return option->group(group);
}

void after_parsing(CLI::App& app, std::function<void()> check) {
    app.final_callback(std::move(check));
}

bool given(const CLI::App& app, const std::string& name) {
    return app.count(name) > 0;
}

std::string typed(const CLI::App& app, std::initializer_list<const char*> names) {
    for (const char* name : names) {
        const CLI::Option* option = app.get_option(name);
        if (option->count() == 0) continue;
        return option->get_expected_min() == 0 ? name : cat(name, ' ', option->results().front());
    }
    return "";
}

std::vector<OptionValue> option_values(const CLI::App& app) {
    std::vector<OptionValue> values;
    for (const CLI::Option* option : app.get_options()) {
        if (!option->nonpositional() || option->get_lnames().empty()) continue;
        OptionValue& value = values.emplace_back();
        value.name = "--" + option->get_lnames().front();
        value.group = option->get_group();
        value.flag = option->get_expected_max() == 0;
        value.values = option->results();
        if (!option->get_default_str().empty()) value.otherwise = option->get_default_str();
    }
    return values;
}

std::vector<std::string> split_list(const std::string& text) {
    std::vector<std::string> items;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(',', at), text.size());
        items.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return items;
}

}  // namespace imgmesh

#include "tools/common/options.h"

#include <algorithm>

namespace imgmesh {

bool same_name(const std::string& a, const std::string& b) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [&](char x, char y) { return lower(x) == lower(y); });
}

CLI::Option* add_value(CLI::App& app, const std::string& name, const std::string& type,
                       std::function<void(const std::string&)> take, const std::string& help) {
    CLI::Option* option = app.add_option(
        name,
        [take = std::move(take)](const CLI::results_t& results) {
            take(results.front());
            return true;
        },
        help);
    option->type_name(type);
    return option;
}

CLI::Option* add_input(CLI::App& app, const std::string& name, std::string& input, const std::string& help) {
    return add_value(
               app, name, "", [&input](const std::string& text) { input = text; }, help)
        ->required();
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

CLI::Option* add_output(CLI::App& app, std::string& output, const std::string& help) {
    CLI::Option* option = add_value(
        app, "-o,--output", "FILE",
        [&output](const std::string& text) {
            if (text.empty()) throw Error(ErrorKind::kBadArgument, "--output '': expected a file name");
            output = text;
        },
        help);
    return option->required();
}

}  // namespace imgmesh

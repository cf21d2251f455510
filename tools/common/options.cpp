#include "tools/common/options.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace imgmesh {
namespace {

// Converts all of `text` or nothing.
template <typename Value>
bool parse_whole(const std::string& text, Value& value) {
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && stop == end;
}

[[noreturn]] void refuse(const std::string& name, const std::string& text, const std::string& expected) {
    throw Error(ErrorCode::kUsage, cat(name, " '", text, "': expected ", expected));
}

std::string describe(const CountRange& range) {
    if (range.most >= std::numeric_limits<int>::max()) return cat("a whole number, at least ", range.least);
    return cat("a whole number from ", range.least, " to ", range.most);
}

std::string describe(const NumberRange& range) {
    std::string words = cat("a number ", range.open ? "above " : "of at least ", range.least);
    if (std::isfinite(range.most)) words += cat(" and at most ", range.most);
    return words;
}

}  // namespace

std::int64_t parse_count(const std::string& name, const std::string& text, const CountRange& range) {
    std::int64_t value = 0;
    if (!parse_whole(text, value) || value < range.least || value > range.most)
        refuse(name, text, describe(range));
    return value;
}

double parse_number(const std::string& name, const std::string& text, const NumberRange& range) {
    double value = 0;
    if (!parse_whole(text, value) || !std::isfinite(value) || value > range.most ||
        (range.open ? value <= range.least : value < range.least))
        refuse(name, text, describe(range));
    return value;
}

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
            if (text.empty()) throw Error(ErrorCode::kUsage, "--output '': expected a file name");
            output = text;
        },
        help);
    return option->required();
}

}  // namespace imgmesh

#include "tools/common/usage_error.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "libcore/base/error.h"
#include "tools/common/container_input.h"
#include "tools/common/did_you_mean.h"
#include "tools/common/text.h"

namespace imgmesh {
namespace {

std::vector<std::string> option_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

// Where the last of several files may be the output.
std::string output_meant(const CLI::App& app) {
    for (const CLI::Option* option : app.get_options()) {
        if (option->nonpositional() || option->count() < 2) continue;
        const std::string last = option->results().back();
        std::error_code error;
        const bool fits = is_container(last) && app.get_name() == "imgmesh-build";
        if (fits || (!std::filesystem::exists(last, error) && last.find('.') != std::string::npos))
            return cat("; did you mean -o ", shortened(last), "?");
    }
    return "";
}

// "--tiles: 1 required N missing", as CLI11 says it, in words. Other texts are left as they are.
std::string in_words(const std::string& what) {
    const std::string before = ": 1 required ", after = " missing";
    const std::size_t at = what.find(before);
    if (at == std::string::npos || !what.ends_with(after)) return what;
    const std::size_t begin = at + before.size();
    return cat(what.substr(0, at), ": expected a value, ",
               what.substr(begin, what.size() - after.size() - begin));
}

}  // namespace

std::string usage_error(const CLI::App& app, const std::string& what) {
    const std::vector<std::string> left = app.remaining();
    const auto option = std::ranges::find_if(left, [](const std::string& word) {
        return word.size() > 1 && word.starts_with('-') && word != "--";
    });
    if (option != left.end()) {
        const std::string name = option->substr(0, option->find('='));
        return cat("unknown option ", shortened(name), did_you_mean(name, option_names(app)),
                   " (see --help)");
    }
    if (what == "--output is required")
        return cat("-o FILE (--output) is required", output_meant(app), " (see --help)");
    return cat(in_words(what), " (see --help)");
}

}  // namespace imgmesh

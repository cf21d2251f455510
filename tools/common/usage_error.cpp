#include "tools/common/usage_error.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

#include "libcore/base/error.h"
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

// "1 CONTAINER", or "no arguments without a name"
std::string expected_arguments(const CLI::App& app) {
    std::string list;
    for (const CLI::Option* option :
         app.get_options([](const CLI::Option* o) { return o->get_positional(); }))
        list += (list.empty() ? "" : " ") + option->get_name(true);
    return list.empty() ? "no files" : list;
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
    const std::size_t surplus = left.size() - static_cast<std::size_t>(std::ranges::count(left, "--"));
    if (surplus == 0) return cat(what, " (see --help)");
    const std::string first =
        *std::ranges::find_if(left, [](const std::string& word) { return word != "--"; });
    return cat(surplus, surplus == 1 ? " argument too many: '" : " arguments too many, the first is '",
               shortened(first), "'; expected ", expected_arguments(app), " (see --help)");
}

}  // namespace imgmesh

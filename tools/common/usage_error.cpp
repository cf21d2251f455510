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
    return cat(what, " (see --help)");
}

}  // namespace imgmesh

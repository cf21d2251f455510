#include "tools/common/help.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "libcore/base/error.h"
#include "tools/common/examples.h"

namespace imgmesh {
namespace {

constexpr std::size_t kColumn = 30;  // where descriptions begin
constexpr std::size_t kWidth = 100;

class HelpFormatter : public CLI::Formatter {
  public:
    void leave_out(const CLI::Option* option) { advanced_.insert(option); }

    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
        std::string out = make_description(app) + make_usage(app, std::move(name)) + make_positionals(app);
        for (const std::string& group : app->get_groups()) {
            if (group.empty()) continue;  // old names of options
            const std::vector<const CLI::Option*> options = app->get_options([&](const CLI::Option* option) {
                return option->get_group() == group && option->nonpositional() &&
                       (mode == CLI::AppFormatMode::All || !advanced_.count(option));
            });
            if (!options.empty()) out += make_group(group, false, options);
        }
        out += "\nExamples:\n";
        for (const Example& example : examples_of(app->get_name()))
            out += cat("  ", example.command, "\n      ", example.meaning, "\n");
        return out + "\n" + make_footer(app);
    }

    std::string make_option(const CLI::Option* option, bool is_positional) const override {
        std::string head = "  " + make_option_name(option, is_positional) + make_option_opts(option);
        // CLI11's mark of a flag name that switches the flag off.
        if (const std::size_t at = head.find("{false}"); at != std::string::npos) head.erase(at, 7);
        std::ostringstream out;
        out << head;
        std::size_t at = head.size();
        const auto break_line = [&] {
            out << '\n' << std::string(kColumn, ' ');
            at = kColumn;
        };
        if (at + 2 > kColumn)
            break_line();
        else
            out << std::string(kColumn - at, ' '), at = kColumn;
        std::istringstream words(make_option_desc(option));
        for (std::string word; words >> word;) {
            if (at > kColumn && at + 1 + word.size() > kWidth) break_line();
            if (at > kColumn) out << ' ', ++at;
            out << word;
            at += word.size();
        }
        out << '\n';
        return out.str();
    }

    std::string make_option_opts(const CLI::Option* option) const override {
        std::string text;
        if (!option->get_type_name().empty() && option->get_type_size() != 0)
            text += " " + option->get_type_name();
        if (option->get_expected_max() == CLI::detail::expected_max_vector_size) text += " ...";
        if (option->get_required()) text += " REQUIRED";
        return text;
    }

    std::string make_option_desc(const CLI::Option* option) const override {
        return option->get_description() + listed("; needs ", option->get_needs()) +
               listed("; not with ", option->get_excludes());
    }

  private:
    // Names of options, sorted: CLI11 has them in the order of their addresses.
    static std::string listed(const std::string& before, const std::set<CLI::Option*>& options) {
        std::set<std::string> names;
        for (const CLI::Option* option : options) names.insert(option->get_name());
        std::string text;
        for (const std::string& name : names) text += (text.empty() ? before : ", ") + name;
        return text;
    }

    std::set<const CLI::Option*> advanced_;
};

}  // namespace

void set_help_style(CLI::App& app) {
    app.formatter(std::make_shared<HelpFormatter>());
}

CLI::Option* advanced(CLI::App& app, CLI::Option* option) {
    dynamic_cast<HelpFormatter&>(*app.get_formatter()).leave_out(option);
    return option;
}

std::string everyday_help(const CLI::App& app) {
    return app.help() + "\n--help-all shows all options.\n";
}

std::string full_help(const CLI::App& app) {
    return app.help("", CLI::AppFormatMode::All);
}

}  // namespace imgmesh

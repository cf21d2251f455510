#include "tools/common/config_file.h"

#include <toml++/toml.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <istream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "libcore/base/error.h"
#include "tools/common/did_you_mean.h"
#include "tools/common/text.h"

namespace imgmesh {
namespace {

// No list of options is longer; a device would give text without end.
constexpr std::size_t kMostBytes = std::size_t{1} << 20;

// A table for each tool, by its name after "imgmesh-".
constexpr std::array<const char*, 9> kTables = {"build", "reconstruct", "info",   "compare", "convert",
                                                "warp",  "segment",     "encode", "decode"};

// CLI11's own reader skips short lines, cuts strings at '#' and takes the first of two equal keys, all
// without a word.
class TomlConfig : public CLI::ConfigBase {
  public:
    explicit TomlConfig(const CLI::App& app) : app_(app) {}

    // See place_in_config().
    std::string place_of(std::string_view message) const {
        for (const auto& [name, line] : line_of_) {
            const std::string start = "--" + name;
            if (message.starts_with(start + ' ') || message.starts_with(start + ':'))
                return cat(file(), ":", line, ": ");
        }
        return "";
    }

    std::vector<CLI::ConfigItem> from_config(std::istream& input) const override {
        const toml::table file = parsed(input);
        std::vector<CLI::ConfigItem> options, shared;
        if (const toml::table* own = table_of_this_tool(file)) add_options(*own, false, options);
        add_options(file, true, shared);
        // The table of this tool counts more than what stands above all tables.
        const std::size_t of_table = options.size();
        for (CLI::ConfigItem& item : shared) {
            const auto replaces = [&](const CLI::ConfigItem& other) {
                return other.name == item.name || exclude_each_other(item.name, other.name);
            };
            if (std::none_of(options.begin(), options.begin() + std::ptrdiff_t(of_table), replaces))
                options.push_back(std::move(item));
        }
        return options;
    }

  private:
    std::string file() const { return app_.get_config_ptr()->as<std::string>(); }

    [[noreturn]] void refuse(const toml::source_region& at, const std::string& what) const {
        throw Error(ErrorKind::kBadArgument, cat(file(), ":", at.begin.line, ": ", what));
    }

    // Returns the option of a key, or null if there is none that may stand in a file.
    const CLI::Option* option_of(const std::string& key) const {
        const CLI::Option* option = app_.get_option_no_throw("--" + key);
        return option != nullptr && option->get_configurable() ? option : nullptr;
    }

    bool exclude_each_other(const std::string& a, const std::string& b) const {
        const CLI::Option* other = option_of(b);
        return std::ranges::any_of(option_of(a)->get_excludes(),
                                   [other](const CLI::Option* excluded) { return excluded == other; });
    }

    // Returns the table of this tool, or null; checks the names of all.
    const toml::table* table_of_this_tool(const toml::table& file) const {
        const toml::table* own = nullptr;
        for (const auto& [key, value] : file) {
            const std::string name(key.str());
            const toml::table* table = value.as_table();
            const bool is_tool = std::find(kTables.begin(), kTables.end(), name) != kTables.end();
            if (table == nullptr && !is_tool) continue;
            if (!is_tool)
                refuse(key.source(), cat("unknown table '", shortened(name), "'",
                                         did_you_mean(name, {kTables.begin(), kTables.end()})));
            if (table == nullptr) refuse(key.source(), cat("expected a table, [", name, "]"));
            if ("imgmesh-" + name == app_.get_name()) own = table;
        }
        return own;
    }

    // Appends the options of this tool's table, or of the whole file, which has tables itself (`shared`).
    void add_options(const toml::table& table, bool shared, std::vector<CLI::ConfigItem>& options) const {
        for (const auto& [key, value] : table) {
            const std::string name(key.str());
            if (shared && value.is_table()) continue;  // that of a tool
            const CLI::Option* option = option_of(name);
            if (option == nullptr) {
                const std::string meant = did_you_mean(name, names_of_options());
                const std::string hint =
                    cat("; ", app_.get_name(),
                        " has none of this name, and options of other tools stand in their "
                        "tables, as in [build]");
                refuse(key.source(),
                       cat("unknown option '", shortened(name), "'", meant.empty() && shared ? hint : meant));
            }
            // What the command line gives counts more, also against options that contradict it.
            const auto given = [](const CLI::Option* other) { return other->count() > 0; };
            if (std::ranges::any_of(option->get_excludes(), given)) continue;
            CLI::ConfigItem item;
            item.name = name;
            // The table of this tool is read first, and counts.
            if (option->count() == 0) line_of_.emplace(name, key.source().begin.line);
            item.inputs = values_of(*option, name, key.source(), value);
            if (!item.inputs.empty()) options.push_back(std::move(item));
        }
    }

    std::vector<std::string> names_of_options() const {
        std::vector<std::string> names;
        for (const CLI::Option* option : app_.get_options())
            if (option->get_configurable())
                for (const std::string& name : option->get_lnames()) names.push_back(name);
        return names;
    }

    // Returns what the command line would give an option; nothing for an empty list.
    std::vector<std::string> values_of(const CLI::Option& option, const std::string& name,
                                       const toml::source_region& at, const toml::node& value) const {
        const auto refuse_value = [&](const std::string& what) {
            refuse(at, cat("option '", name, "': expected ", what));
        };
        if (option.get_expected_min() == 0 && !value.is_boolean()) refuse_value("true or false");
        const toml::array* list = value.as_array();
        if (list == nullptr) {
            const std::optional<std::string> text = text_of(value);
            if (!text) refuse_value("a string without control characters, a finite number, true or false");
            return {*text};
        }
        const bool several = option.get_expected_max() > 1, joined = option.get_type_name() == "LIST";
        if (!several && !joined) refuse_value("one value, not a list");
        std::vector<std::string> texts;
        for (const toml::node& element : *list) {
            const std::optional<std::string> text = text_of(element);
            if (!text || text->empty() || (joined && text->find(',') != std::string::npos))
                refuse_value("a list of values");
            if (joined && !texts.empty())
                texts.front() += "," + *text;
            else
                texts.push_back(*text);
        }
        return texts;
    }

    toml::table parsed(std::istream& input) const {
        std::string text(kMostBytes + 1, '\0');
        input.read(text.data(), static_cast<std::streamsize>(text.size()));
        text.resize(static_cast<std::size_t>(input.gcount()));
        if (text.size() > kMostBytes)
            throw Error(ErrorKind::kBadArgument, cat(file(), ": is longer than ", kMostBytes, " bytes"));
        refuse_deep_keys(text);
        try {
            return toml::parse(text, file());
        } catch (const toml::parse_error& e) {
            const bool bare = e.description().find("could not determine value type") != std::string::npos;
            throw Error(ErrorKind::kBadArgument, cat(file(), ":", e.source().begin.line, ": ",
                                                     e.description(), bare ? "; text needs quotes" : ""));
        }
    }

    // The parser calls itself once for each dot of a key, which has to stand in one line.
    void refuse_deep_keys(const std::string& text) const {
        constexpr int kMostDots = 1000;
        int line = 1, dots = 0;
        for (const char c : text) {
            if (c == '\n') ++line;
            dots = c == '\n' ? 0 : dots + (c == '.');
            if (dots > kMostDots)
                throw Error(ErrorKind::kBadArgument,
                            cat(file(), ":", line, ": a line of more than ", kMostDots, " dots"));
        }
    }

    // Returns a value as the command line would have it, where it could.
    static std::optional<std::string> text_of(const toml::node& node) {
        if (const auto* string = node.as_string()) {
            // A zero byte would end a file's name before its extension.
            const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
            if (std::any_of(string->get().begin(), string->get().end(), is_control)) return std::nullopt;
            return string->get();
        }
        if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
        if (const auto* integer = node.as_integer()) return std::to_string(integer->get());
        if (const auto* number = node.as_floating_point(); number && std::isfinite(number->get()))
            return decimal(number->get());
        return std::nullopt;
    }

    // The shortest text that gives the same number, always one that no whole number has.
    static std::string decimal(double value) {
        std::array<char, 32> digits;
        const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
        std::string text(digits.data(), end);
        return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
    }

    const CLI::App& app_;
    mutable std::map<std::string, toml::source_index> line_of_;  // by the options' names
};

}  // namespace

CLI::Option* add_config_option(CLI::App& app) {
    CLI::Option* option = app.set_config("--config", "",
                                         "Read options from a TOML file, by their long names; those in a "
                                         "table [TOOL], as in [build], are of one tool");
    app.config_formatter(std::make_shared<TomlConfig>(app));
    app.allow_config_extras(false);
    option->check([](const std::string& name) { return std::string(name.empty() ? "expected a file" : ""); });
    return option->type_name("FILE");
}

std::string place_in_config(const CLI::App& app, std::string_view message) {
    const auto config = std::dynamic_pointer_cast<TomlConfig>(app.get_config_formatter());
    return config ? config->place_of(message) : "";
}

}  // namespace imgmesh

#include "tools/common/config_file.h"

#include <toml++/toml.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// No list of options is longer; a device would give text without end.
constexpr std::size_t kMostBytes = std::size_t{1} << 20;

// CLI11's own reader skips short lines, cuts strings at '#' and takes the first of two equal keys, all
// without a word.
class TomlConfig : public CLI::ConfigBase {
  public:
    explicit TomlConfig(const CLI::App& app) : app_(app) {}

    std::vector<CLI::ConfigItem> from_config(std::istream& input) const override {
        std::vector<CLI::ConfigItem> options;
        for (const auto& [key, value] : parsed(input)) {
            const std::string name(key.str());
            const auto refuse = [&, at = key.source().begin.line](const std::string& what) {
                throw Error(ErrorKind::kBadArgument, cat(file(), ":", at, ": ", what));
            };
            const CLI::Option* option = app_.get_option_no_throw("--" + name);
            if (option == nullptr || !option->get_configurable()) refuse(cat("unknown option '", name, "'"));
            if (option->get_expected_min() == 0 && !value.is_boolean())
                refuse(cat("option '", name, "': expected true or false"));

            CLI::ConfigItem item;
            item.name = name;
            if (const toml::array* list = value.as_array()) {
                if (option->get_type_name() != "LIST")
                    refuse(cat("option '", name, "': expected one value, not a list"));
                std::string joined;
                for (const toml::node& element : *list) {
                    const std::optional<std::string> text = text_of(element);
                    if (!text || text->empty() || text->find(',') != std::string::npos)
                        refuse(cat("option '", name, "': expected a list of values"));
                    joined += (joined.empty() ? "" : ",") + *text;
                }
                item.inputs = {joined};
            } else {
                const std::optional<std::string> text = text_of(value);
                if (!text)
                    refuse(cat("option '", name,
                               "': expected a string without control characters, a finite number, true or "
                               "false"));
                item.inputs = {*text};
            }
            options.push_back(std::move(item));
        }
        return options;
    }

  private:
    std::string file() const { return app_.get_config_ptr()->as<std::string>(); }

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
            throw Error(ErrorKind::kBadArgument,
                        cat(file(), ":", e.source().begin.line, ": ", e.description()));
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
};

}  // namespace

CLI::Option* add_config_option(CLI::App& app) {
    CLI::Option* option =
        app.set_config("--config", "", "Read options from a TOML file, by their long names");
    app.config_formatter(std::make_shared<TomlConfig>(app));
    app.allow_config_extras(false);
    return option->type_name("FILE");
}

}  // namespace imgmesh

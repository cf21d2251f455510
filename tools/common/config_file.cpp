#include "tools/common/config_file.h"

#include <istream>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// CLI11's own reader skips short lines, cuts strings at '#' and takes the first of two equal keys, all
// without a word. This one reads less of TOML and refuses the rest.
class StrictConfig : public CLI::ConfigBase {
  public:
    explicit StrictConfig(const CLI::App& app) : app_(app) {}

    std::vector<CLI::ConfigItem> from_config(std::istream& input) const override {
        std::vector<CLI::ConfigItem> options;
        std::set<std::string> seen;
        std::string line;
        for (int number = 1; next_line(input, line); ++number) {
            std::size_t at = skip_space(line, 0);
            if (at == line.size() || line[at] == '#') continue;
            const auto refuse = [&](const std::string& what) {
                const auto file = app_.get_config_ptr()->as<std::string>();
                throw Error(ErrorKind::kBadArgument, cat(file, ":", number, ": ", what));
            };

            CLI::ConfigItem item;
            item.name = word(line, at);
            at = skip_space(line, at);
            if (item.name.empty() || at == line.size() || line[at] != '=') refuse("expected option = value");
            const CLI::Option* option = app_.get_option_no_throw("--" + item.name);
            if (option == nullptr || !option->get_configurable())
                refuse(cat("unknown option '", item.name, "'"));
            if (!seen.insert(item.name).second) refuse(cat("option '", item.name, "' is given twice"));

            at = skip_space(line, at + 1);
            std::string value;
            if (!read_value(line, at, value)) refuse(cat("option '", item.name, "': expected a TOML value"));
            const bool flag = option->get_expected_min() == 0;
            if (flag && value != "true" && value != "false")
                refuse(cat("option '", item.name, "': expected true or false"));
            at = skip_space(line, at);
            if (at < line.size() && line[at] != '#')
                refuse(cat("option '", item.name, "': unexpected '", line.substr(at), "' after its value"));
            item.inputs = {value};
            options.push_back(item);
        }
        return options;
    }

  private:
    // std::getline with a bound: a device would give a line without end.
    bool next_line(std::istream& input, std::string& line) const {
        constexpr std::size_t kLongest = 1 << 16;
        line.clear();
        for (int c; (c = input.get()) != std::istream::traits_type::eof();) {
            if (c == '\n') return true;
            line += static_cast<char>(c);
            if (line.size() > kLongest)
                throw Error(ErrorKind::kBadArgument, cat(app_.get_config_ptr()->as<std::string>(),
                                                         ": a line of more than ", kLongest, " bytes"));
        }
        return !line.empty();
    }

    static std::size_t skip_space(const std::string& line, std::size_t at) {
        while (at < line.size() && (line[at] == ' ' || line[at] == '\t' || line[at] == '\r')) ++at;
        return at;
    }

    // A bare key or value: letters, digits and + - . _
    static std::string word(const std::string& line, std::size_t& at) {
        const std::size_t begin = at;
        const auto is_word = [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '+' ||
                   c == '-' || c == '.' || c == '_';
        };
        while (at < line.size() && is_word(line[at])) ++at;
        return line.substr(begin, at - begin);
    }

    // 'literal', "basic" with the escapes \" and \\, or a bare number or boolean.
    static bool read_value(const std::string& line, std::size_t& at, std::string& value) {
        if (at == line.size()) return false;
        const char quote = line[at];
        if (quote != '"' && quote != '\'') {
            value = word(line, at);
            const bool boolean = value == "true" || value == "false";
            return boolean || (!value.empty() && value.find_first_of("0123456789") != std::string::npos &&
                               value.find_first_not_of("0123456789+-.eE") == std::string::npos);
        }
        for (++at; at < line.size() && line[at] != quote; ++at) {
            if (quote == '"' && line[at] == '\\') {
                ++at;
                if (at == line.size() || (line[at] != '"' && line[at] != '\\')) return false;
            }
            value += line[at];
        }
        if (at == line.size()) return false;
        ++at;
        return true;
    }

    const CLI::App& app_;
};

}  // namespace

void add_config_option(CLI::App& app) {
    app.set_config("--config", "", "Read options from a TOML file, by their long names")->type_name("FILE");
    app.config_formatter(std::make_shared<StrictConfig>(app));
    app.allow_config_extras(false);
}

}  // namespace imgmesh

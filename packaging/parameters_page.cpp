// parameters-page FILE writes docs/parameters.md from the table of build parameters. With --check before FILE
// it writes nothing, and fails where FILE differs from what it would write.
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>

#include "libcore/pipeline/param_table.h"
#include "libcore/pipeline/presets.h"

using namespace imgmesh;

namespace {

// Markdown would take a * for emphasis.
std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) out += c == '*' ? std::string("\\*") : std::string(1, c);
    return out;
}

std::string values_of(const CountParam& kind) {
    return describe(kind.range);
}
std::string values_of(const NumberParam& kind) {
    return describe(kind.range);
}
std::string values_of(const CountListParam& kind) {
    return cat("a list, each ", describe(kind.range));
}
std::string values_of(const NumberListParam& kind) {
    return cat("a list, each ", describe(kind.range));
}
std::string values_of(const FlagParam&) {
    return "given or not";
}
std::string values_of(const ChannelsParam&) {
    return "a list of NAME or NAME:WEIGHT";
}
std::string values_of(const WordParam& kind) {
    std::string text;
    for (const std::string_view word : kind.words) text += cat(text.empty() ? "" : ", ", '`', word, '`');
    return text;
}

void write_params(std::ostream& out) {
    std::string group;
    for (const Param& param : param_table()) {
        if (param.group != group) {
            group = param.group;
            out << "\n## " << group << "\n\n| name | what it is | values | default | listed |\n"
                << "|---|---|---|---|---|\n";
        }
        const std::string usual = default_text(param);
        out << "| `" << param.name << "` | " << escaped(param.help) << " | "
            << std::visit([](const auto& kind) { return values_of(kind); }, param.kind) << " | "
            << (usual.empty() ? "none" : usual) << " | " << param.listed.when << " |\n";
    }
}

void write_presets(std::ostream& out) {
    out << "\n## Presets\n\nA preset sets several parameters at once; what is given beside it counts more. "
           "The figures behind\nthem are in [decision 13](decisions/0013-defaults.md).\n\n"
           "| name | for | differs from the default in |\n|---|---|---|\n";
    for (const Preset& preset : presets()) {
        std::string differences;
        for (const Param& param : param_table()) {
            const std::string value = value_text(param, preset.params);
            if (value != value_text(param, BuildParams()))
                differences += cat(differences.empty() ? "" : ", ", '`', param.name, "` ", value);
        }
        out << "| `" << preset.name << "` | " << preset.help << " | "
            << (differences.empty() ? "nothing" : differences) << " |\n";
    }
}

std::string page() {
    std::ostringstream out;
    out << "# Build parameters\n\n"
           "Every parameter of a build, by the name that messages and containers give it. `imgmesh-build` "
           "has "
           "an option\n`--NAME` for each; `imgmesh-build --help-all` also lists the options that concern "
           "files. "
           "A program sets the\nmembers of `BuildParams` (`libcore/pipeline/build_params.h`). "
           "*Listed* says when a container's `build`\n([format.md](format.md)) lists the parameter with the "
           "value that it had.\n\n"
           "The ratio of `geometry-weight` to `color-weight` is 1e-9 to 1e9.\n\n"
           "`parameters-page docs/parameters.md` writes this page from the table in "
           "`libcore/pipeline/param_table.cpp`.\n";
    write_params(out);
    write_presets(out);
    return out.str();
}

}  // namespace

int main(int argc, char** argv) {
    const bool check = argc == 3 && std::string_view(argv[1]) == "--check";
    if (argc != 2 && !check) {
        std::cerr << "usage: parameters-page [--check] FILE\n";
        return 2;
    }
    const std::string path = argv[argc - 1], wanted = page();
    if (check) {
        std::ifstream file(path, std::ios::binary);
        const std::string found{std::istreambuf_iterator<char>(file), {}};
        if (found == wanted) return 0;
        std::cerr << path << " is stale; write it anew: parameters-page " << path << "\n";
        return 1;
    }
    std::ofstream file(path, std::ios::binary);
    file << wanted;
    file.close();
    if (file) return 0;
    std::cerr << path << ": cannot write\n";
    return 3;
}

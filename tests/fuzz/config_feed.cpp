#include <CLI/CLI.hpp>
#include <functional>

#include "tests/fuzz/feeds.h"
#include "tools/common/config_file.h"
#include "tools/common/options.h"

namespace imgmesh::fuzz {

// A tool with one option of each kind, which reads the bytes as a file for --config.
bool feed_config(std::span<const std::uint8_t> bytes) {
    const MemoryFile file(bytes);
    CLI::App app("", "fuzz");
    double density = 0;
    std::int64_t seed = 0;
    std::string name;
    add_number(app, "--density", density, {0, 1e6}, "a number");
    add_count(app, "--seed", seed, {0, 1000}, "a count");
    add_value(
        app, "--channels", "LIST", [](const std::string& text) { split_list(text); }, "a list");
    add_file(app, "--name", name, "a file");
    add_flag(
        app, "--quiet", [] {}, "a flag");
    add_config_option(app);
    try {
        app.parse(std::vector<std::string>{file.path(), "--config"});  // from the last to the first
    } catch (const CLI::ParseError&) {
        return false;
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::kBadArgument) throw;
        return false;
    }
    return true;
}

}  // namespace imgmesh::fuzz

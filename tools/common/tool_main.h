// The frame of every command line tool: common options, errors, exit codes, the report.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "libcore/base/progress.h"
#include "tools/common/exit_code.h"

namespace CLI {
class App;
}

namespace imgmesh {

/// The result of a tool: the object that --json prints. The text report is made from it. Code that makes or
/// reads one includes nlohmann/json.hpp.
using Report = nlohmann::ordered_json;

/// A mistake as the user sees it: one error line and an exit code.
struct Failure {
    ExitCode code = ExitCode::kInternal;
    std::string message;
};

/// Returns the exception being handled as a Failure. Call it only in a catch block.
Failure current_failure();

/// What a run gets besides its tool's own options.
struct Context {
    std::string generator;         ///< "imgmesh-build 0.1.0"
    bool overwrite = true;         ///< of --overwrite, --no-overwrite
    std::uint64_t max_memory = 0;  ///< of --max-memory [bytes]
    Progress progress;             ///< never empty; may be called from any thread
    /// What did not stop the run, but what its user should know, with the file's name. Each becomes a warning
    /// line and an element of the report's "warnings".
    std::vector<std::string> warnings;
    /// Mistakes that did not stop the run. Each becomes an error line, in this order. They decide the exit
    /// code: their common code, or kBadFile if they differ.
    std::vector<Failure> failures;
};

/// A tool without its options; name as in "imgmesh-build".
struct Tool {
    std::string name;
    std::string description;
    std::function<void(CLI::App&)> add_options;
    std::function<Report(Context&)> run;
    std::function<void(const Report&, std::ostream&)> print;
};

/// Parses the command line, runs, prints, and returns the exit code; throws nothing. A tool's report is
/// described by schemas/<name>.report.schema.json.
int run_tool(const Tool& tool, int argc, char** argv);

/// run_tool for a tool whose options are an `Options`.
///
/// run    does the work and returns the report's members (an object).
/// print  writes the report as text; the report is the one that --json would print.
template <typename Options>
int tool_main(const std::string& name, const std::string& description, int argc, char** argv,
              void (*add_options)(CLI::App&, Options&), Report (*run)(const Options&, Context&),
              void (*print)(const Report&, std::ostream&)) {
    Options options;
    return run_tool({name, description, [&](CLI::App& app) { add_options(app, options); },
                     [&](Context& context) { return run(options, context); }, print},
                    argc, argv);
}

}  // namespace imgmesh

// The frame of every command line tool: common options, files, errors, exit codes, the report.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "libcore/base/progress.h"
#include "tools/common/exit_code.h"
#include "tools/common/memory.h"

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

/// What the work on one file gets besides its tool's own options.
struct Context {
    std::string generator;         ///< "imgmesh-build 0.1.0"
    bool overwrite = true;         ///< of --overwrite, --no-overwrite
    std::uint64_t max_memory = 0;  ///< of --max-memory [bytes]
    JobMemory memory;              ///< the file's share of it
    Progress progress;             ///< never empty; may be called from any thread
    /// What did not stop the run, but what its user should know, with the file's name. Each becomes a warning
    /// line and an element of the report's "warnings".
    std::vector<std::string> warnings = {};
    /// Mistakes that did not stop the work on this file. Each becomes an error line, in this order.
    std::vector<Failure> failures = {};
};

/// One file's work: what a tool reads and writes.
struct Job {
    std::string input;
    std::string output;              ///< of -o; empty if the tool has none
    std::string reference;           ///< of a tool that compares: what the input is compared with, or empty
    std::vector<std::string> sides;  ///< the values of Tool::sides for this file
};

/// An option for one more output. With several inputs it names a folder.
struct SideFile {
    std::string option;     ///< "--outlines"
    std::string extension;  ///< of its files in a folder: "png"
    const std::string* value;
    std::vector<std::string> others = {};  ///< extensions that its files in a folder get if --format says so
};

/// A tool without its options; name as in "imgmesh-build".
struct Tool {
    std::string name;
    std::string description;
    std::string input_name = {};  ///< "IMAGE"
    std::string input_help = {};
    std::string output_help = {};            ///< empty: no -o
    bool output_required = true;             ///< or else something in `sides`
    std::function<std::string()> type = {};  ///< of outputs whose names do not tell it: "glb"
    bool compares = false;  ///< the first of several inputs is compared with each of the others
    std::vector<SideFile> sides = {};
    std::vector<std::string> sources = {};  ///< options that name files to read, which count by their content
    /// Whether -o is a folder that the work on one input fills, and not one for a file of each; may be empty.
    std::function<bool()> fills_output = {};
    /// What to do with a tile set, for the message of a tool that takes none; empty: it takes them, or any
    /// folder.
    std::string instead_of_sets = {};
    std::string list = "files";  ///< the report's member for several files
    bool always_list = false;    ///< the report is a list for one file, too
    std::function<void(CLI::App&)> add_options = {};
    std::function<void(const Job&)> check = {};            ///< before any work; may be empty
    std::function<Report(const Job&, Context&)> run = {};  ///< from several threads
    std::function<void(const Report&, std::ostream&)> print = {};
    std::function<std::string(const Report&)> line = {};  ///< one file of many in a few words
};

/// Parses the command line, runs, prints, and returns the exit code; throws nothing. A tool's report is
/// described by schemas/<name>.report.schema.json.
int run_tool(const Tool& tool, int argc, char** argv);

/// The functions of a tool whose options are an `Options` with the members `input` and `output`, which are
/// set for each file.
///
/// check  throws Error(kBadArgument) for mistakes that can be found before any work; may be null
/// one    does the work on one file and returns the report's members (an object)
/// print  writes the report of one file as text, if there is no other
/// line   what is said of one file of many after its names
/// sides  where Options has what Tool::sides name, in that order
template <typename Options>
struct ToolWork {
    void (*add_options)(CLI::App&, Options&);
    void (*check)(const Options&);
    Report (*one)(const Options&, Context&);
    void (*print)(const Report&, std::ostream&);
    std::string (*line)(const Report&);
    struct Side {
        const char* option;
        const char* extension;
        std::string Options::*value;
        std::vector<std::string> others = {};
    };
    std::vector<Side> sides = {};
};

/// run_tool for such a tool; `tool` lacks the functions and `sides`.
template <typename Options>
int tool_main(Tool tool, const ToolWork<Options>& work, Options& options, int argc, char** argv) {
    const auto of_job = [&](const Job& job) {
        Options own = options;
        own.input = job.input;
        own.output = job.output;
        if constexpr (requires { own.reference; }) own.reference = job.reference;
        for (std::size_t i = 0; i < work.sides.size(); ++i) own.*work.sides[i].value = job.sides[i];
        return own;
    };
    for (const auto& side : work.sides)
        tool.sides.push_back({side.option, side.extension, &(options.*side.value), side.others});
    tool.add_options = [&](CLI::App& app) { work.add_options(app, options); };
    if (work.check) tool.check = [&](const Job& job) { work.check(of_job(job)); };
    tool.run = [&](const Job& job, Context& context) { return work.one(of_job(job), context); };
    tool.print = work.print;
    tool.line = work.line;
    return run_tool(tool, argc, argv);
}

}  // namespace imgmesh

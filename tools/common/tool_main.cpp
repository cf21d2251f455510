#include "tools/common/tool_main.h"

#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "formats/files/atomic_file.h"
#include "libcore/base/parallel.h"
#include "tools/common/batch.h"
#include "tools/common/config_file.h"
#include "tools/common/console.h"
#include "tools/common/help.h"
#include "tools/common/huge_pages.h"
#include "tools/common/jobs.h"
#include "tools/common/memory.h"
#include "tools/common/options.h"
#include "tools/common/parameters.h"
#include "tools/common/pipes.h"
#include "tools/common/usage_error.h"

namespace imgmesh {
namespace {

struct ExitCodeMeaning {
    ExitCode code;
    const char* meaning;
};

// Every exit code of every tool, for --help.
constexpr ExitCodeMeaning kExitCodes[] = {
    {ExitCode::kOk, "done"},
    {ExitCode::kInternal, "internal error"},
    {ExitCode::kUsage, "wrong use of the command line"},
    {ExitCode::kIo, "cannot read or write"},
    {ExitCode::kBadFile, "a file's content is not what it must be"},
    {ExitCode::kUnsupported,
     "a valid request or file that imgmesh does not support, or with --strict a number not reached"},
    {ExitCode::kDifferent, "compared, and different"},
};

// More than any machine has, and few enough for the thread library's tables.
constexpr int kMaxThreads = 1024;

struct CommonOptions {
    bool json = false, json_lines = false;
    bool force = false;
    bool quiet = false;
    bool overwrite = true;
    std::optional<int> threads;  // none: all
    std::optional<std::uint64_t> max_memory;
};

std::string exit_code_table() {
    std::string table = "Exit codes:";
    for (const ExitCodeMeaning& e : kExitCodes)
        table += cat("\n  ", static_cast<int>(e.code), "  ", e.meaning);
    return table;
}

void add_common_options(CLI::App& app, CommonOptions& common) {
    const std::string group = kGeneralGroup;
    app.set_help_flag("-h,--help", "Print the options that most people need, and exit")->group(group);
    app.set_help_all_flag("--help-all", "Print all options, and exit")->group(group);
    app.set_version_flag("--version", app.get_name() + " " IMGMESH_VERSION, "Print the version and exit")
        ->group(group);
    app.add_flag("--json", common.json, "Print the report as one JSON object")->group(group);
    exclude(app,
            in_group(add_flag(
                         app, "--jsonl", [&common] { common.json_lines = true; },
                         "Print the report of each file as one line of JSON as it finishes, then a summary"),
                     group),
            {"--json"});
    app.add_flag("-q,--quiet", common.quiet, "Print no text report and no progress")->group(group);
    app.add_flag("--overwrite,!--no-overwrite", common.overwrite,
                 "Replace files that exist, or refuse to (default --overwrite)")
        ->group(group);
    in_group(add_count(app, "--threads", common.threads, {1, kMaxThreads},
                       {"Largest number of threads; results are the same for any number", "all"}),
             group);
    const auto memory = [&common](const std::string& text) {
        common.max_memory = parse_memory("--max-memory", text);
    };
    advanced(app, in_group(add_value(app, "--max-memory", "SIZE", memory,
                                     {"Refuse work that is estimated to take more memory, as in 2G",
                                      "three quarters of what there is"}),
                           kLimitsGroup));
    in_group(add_config_option(app), group);
    app.footer(exit_code_table());
}

// If the caller closed a standard stream, its number would go to the next file that is opened, and the report
// would end up there. Opening the null device in the wrong direction keeps writing an error.
void hold_standard_streams() {
    for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; ++fd) {
        if (::fcntl(fd, F_GETFD) == -1 && errno == EBADF) {
            ::open("/dev/null", fd == STDOUT_FILENO ? O_RDONLY : O_WRONLY);
        }
    }
}

void add_files(CLI::App& app, const Tool& tool, FileOptions& files, CommonOptions& common) {
    add_inputs(app, tool.input_name, files.inputs, tool.input_help);
    if (tool.output_help.empty()) return;
    CLI::Option* const output =
        in_group(add_file(app, "-o,--output", files.output, tool.output_help), "Files");
    if (tool.output_required) require(output);
    const auto in_files = [](CLI::Option* option) { return in_group(option, "Files"); };
    advanced(
        app,
        in_files(add_value(
            app, "--format", "NAME",
            [&files](const std::string& text) { files.type = file_type("--format", text); },
            {"Kind of the files in a folder of -o, or on standard output (-o -), as in " + tool.type()})));
    in_files(add_flag(
        app, "--skip-existing", [&files] { files.skip_existing = true; },
        "Leave outputs alone that were made from the same content by the same options and version"));
    advanced(app, in_files(add_flag(
                      app, "--force", [&common] { common.force = true; },
                      "Make them again, whatever --skip-existing says")));
}

// What standard input may have [bytes]: not more than a container may have, nor than memory.
std::uint64_t most_input(const BatchOptions& options) {
    const Report& given = options.parameters;
    if (!given.contains("max-bytes")) return options.max_memory;
    return std::min(options.max_memory, given["max-bytes"].get<std::uint64_t>());
}

// `given`, with its output to standard output.
Tool to_pipe(const Tool& given, const Pipes& pipes) {
    Tool tool = given;
    tool.run = [&](const Job& job, Context& context) {
        Report report = given.run(job, context);
        if (context.failures.empty()) pipes.deliver();
        return report;
    };
    return tool;
}

ExitCode run_parsed(const Tool& given, const CLI::App& app, FileOptions files, const CommonOptions& common) {
    BatchOptions options;
    options.generator = given.name + " " IMGMESH_VERSION;
    options.json = common.json;
    options.json_lines = common.json_lines;
    options.quiet = common.quiet;
    options.overwrite = common.overwrite;
    const CLI::Option* const strict = app.get_option_no_throw("--strict");
    options.strict = strict != nullptr && strict->count() > 0;
    options.max_memory = common.max_memory.value_or(usual_max_memory());
    options.parameters = parameters_report(given, app);
    for (const std::string& source : given.sources)
        if (typed(app, {source.c_str()}) == source + " -")
            throw Error(ErrorKind::kBadArgument,
                        cat(source, " -: only ", given.input_name, " can be standard input"));
    const Pipes pipes(given, files, most_input(options));
    const Tool tool = pipes.has_output() ? to_pipe(given, pipes) : given;
    if (pipes.has_output()) options.stream = STDERR_FILENO;
    const std::vector<Job> jobs = plan_jobs(tool, files);
    make_folders(tool, files);
    // A batch that was begun without --skip-existing goes on with it as well.
    options.skip_existing = files.skip_existing && !common.force;
    if (!tool.output_help.empty() && (files.skip_existing || fills_folder(tool, files)))
        options.journal_parameters = journal_parameters(tool, app);
    if (!options.journal_parameters.is_null()) {
        options.journal = std::make_unique<Journal>(journal_folder(jobs.front()));
        std::set<std::string> names;
        for (const Job& job : jobs) names.insert(journal_name(job));
        if (options.skip_existing) options.journal->read(names);
    }
    const ThreadLimit limit(common.threads.value_or(hardware_threads()));
    return run_batch(tool, jobs, options);
}

ExitCode parse_and_run(const Tool& tool, int argc, char** argv) {
    CLI::App app(tool.description, tool.name);
    CommonOptions common;
    FileOptions files;
    set_help_style(app);
    add_files(app, tool, files, common);
    tool.add_options(app);
    add_common_options(app, common);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        write_stream(STDOUT_FILENO, everyday_help(app));
        return ExitCode::kOk;
    } catch (const CLI::CallForAllHelp&) {
        write_stream(STDOUT_FILENO, full_help(app));
        return ExitCode::kOk;
    } catch (const CLI::CallForVersion& version) {
        write_stream(STDOUT_FILENO, cat(version.what(), '\n'));
        return ExitCode::kOk;
    } catch (const CLI::FileError& e) {
        throw Error(ErrorKind::kIo, cat("--config: ", e.what()));
    } catch (const CLI::ParseError& e) {
        throw Error(ErrorKind::kBadArgument, usage_error(app, e.what()));
    } catch (const Error& e) {
        throw Error(e.kind(), cat(place_in_config(app, e.what()), e.what()));
    }
    return run_parsed(tool, app, files, common);
}

}  // namespace

Failure current_failure() {
    try {
        throw;
    } catch (const Error& e) {
        return {exit_code(e.kind()), e.what()};
    } catch (const std::filesystem::filesystem_error& e) {
        return {ExitCode::kIo, cat(e.path1().string(), ": ", e.code().message())};
    } catch (const std::bad_alloc&) {
        return {ExitCode::kInternal, "out of memory"};
    } catch (const std::exception& e) {
        return {ExitCode::kInternal, cat("internal error: ", e.what())};
    } catch (...) {
        return {ExitCode::kInternal, "internal error: unknown exception"};
    }
}

int run_tool(const Tool& tool, int argc, char** argv) {
    hold_standard_streams();
    // A closed pipe and a limit on file size are errors of write(), not the end of the process.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    use_huge_pages();
    remove_temporaries_on_signals();
    try {
        return static_cast<int>(parse_and_run(tool, argc, argv));
    } catch (...) {
        const Failure failure = current_failure();
        print_error(tool.name, failure.message);
        return static_cast<int>(failure.code);
    }
}

}  // namespace imgmesh

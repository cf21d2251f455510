#include "tools/common/tool_main.h"

#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "formats/files/atomic_file.h"
#include "libcore/base/parallel.h"
#include "tools/common/config_file.h"
#include "tools/common/help.h"
#include "tools/common/huge_pages.h"
#include "tools/common/memory.h"
#include "tools/common/options.h"
#include "tools/common/progress_bar.h"
#include "tools/common/text.h"
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
    {ExitCode::kUnsupported, "a valid request or file that imgmesh does not support"},
    {ExitCode::kDifferent, "compared, and different"},
};

// More than any machine has, and few enough for the thread library's tables.
constexpr int kMaxThreads = 1024;

struct CommonOptions {
    bool json = false;
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
    const std::string group = "General";
    app.set_help_flag("-h,--help", "Print the options that most people need, and exit")->group(group);
    app.set_help_all_flag("--help-all", "Print all options, and exit")->group(group);
    app.set_version_flag("--version", app.get_name() + " " IMGMESH_VERSION, "Print the version and exit")
        ->group(group);
    app.add_flag("--json", common.json, "Print the report as one JSON object")->group(group);
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
                           "Limits"));
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

// Throws Error(kIo) if standard output does not take the whole text.
void write_stdout(const std::string& text) {
    std::size_t done = 0;
    while (done < text.size()) {
        const ssize_t n = ::write(STDOUT_FILENO, text.data() + done, text.size() - done);
        if (n >= 0) {
            done += static_cast<std::size_t>(n);
        } else if (errno != EINTR) {
            throw Error(ErrorKind::kIo, cat("standard output: cannot write: ", std::strerror(errno)));
        }
    }
}

// A message quotes names, and those from files may be of any length.
std::string message_line(const std::string& message) {
    constexpr std::size_t kLongest = 1000;
    return shortened(printable_line(message), kLongest);
}

void print_error(const std::string& tool, const std::string& message) {
    std::cerr << tool << ": error: " << message_line(message) << std::endl;
}

void print_warning(const std::string& tool, const std::string& message) {
    std::cerr << tool << ": warning: " << message_line(message) << std::endl;
}

// The exit code of failures that did not stop the run.
ExitCode joint_code(const std::vector<Failure>& failures) {
    if (failures.empty()) return ExitCode::kOk;
    for (const Failure& f : failures) {
        if (f.code != failures.front().code) return ExitCode::kBadFile;
    }
    return failures.front().code;
}

ExitCode run_parsed(const Tool& tool, const CommonOptions& common) {
    Context context;
    context.generator = tool.name + " " IMGMESH_VERSION;
    context.overwrite = common.overwrite;
    context.max_memory = common.max_memory.value_or(usual_max_memory());
    ProgressBar bar(!common.quiet && ::isatty(STDERR_FILENO));
    context.progress = [&bar](double fraction, std::string_view stage) { bar.show(fraction, stage); };

    const ThreadLimit limit(common.threads.value_or(hardware_threads()));
    Report report = {{"$schema", tool.name + ".report.schema.json"}, {"generator", context.generator}};
    report.update(tool.run(context));
    if (!context.warnings.empty()) report["warnings"] = context.warnings;
    bar.clear();

    for (const std::string& warning : context.warnings) print_warning(tool.name, warning);
    for (const Failure& f : context.failures) print_error(tool.name, f.message);
    std::ostringstream text;
    if (common.json) {
        // File names may not be UTF-8, which JSON requires.
        text << printable_json(report.dump(2, ' ', false, Report::error_handler_t::replace)) << '\n';
    } else if (!common.quiet) {
        std::ostringstream lines;
        tool.print(report, lines);
        text << printable_text(lines.str());
    }
    write_stdout(text.str());
    return joint_code(context.failures);
}

ExitCode parse_and_run(const Tool& tool, int argc, char** argv) {
    CLI::App app(tool.description, tool.name);
    CommonOptions common;
    set_help_style(app);
    tool.add_options(app);
    add_common_options(app, common);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        write_stdout(everyday_help(app));
        return ExitCode::kOk;
    } catch (const CLI::CallForAllHelp&) {
        write_stdout(full_help(app));
        return ExitCode::kOk;
    } catch (const CLI::CallForVersion& version) {
        write_stdout(cat(version.what(), '\n'));
        return ExitCode::kOk;
    } catch (const CLI::FileError& e) {
        throw Error(ErrorKind::kIo, cat("--config: ", e.what()));
    } catch (const CLI::ParseError& e) {
        throw Error(ErrorKind::kBadArgument, usage_error(app, e.what()));
    }
    return run_parsed(tool, common);
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

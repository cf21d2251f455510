// Works on the files of a command line, and tells of each as it finishes.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/common/journal.h"
#include "tools/common/tool_main.h"

namespace imgmesh {

/// How a batch runs and what it prints.
struct BatchOptions {
    std::string generator;    ///< "imgmesh-build 0.1.0"
    bool json = false;        ///< one object at the end
    bool json_lines = false;  ///< one object a line for each file as it finishes, then the summary
    bool quiet = false;
    int stream = 1;  ///< where reports go: standard output, or standard error if that has an output
    bool overwrite = true;
    bool strict = false;  ///< of --strict
    std::uint64_t max_memory = 0;
    Report parameters;                      ///< what the command line says of the results, for the reports
    std::unique_ptr<Journal> journal = {};  ///< of the outputs' folder; null: none is kept
    Report journal_parameters = {};         ///< what outputs depend on beside their inputs
    bool skip_existing = false;             ///< leave outputs alone that the journal knows
};

/// Does the work of `tool` on all jobs, several at a time, prints, and writes the journal. A job that fails
/// does not stop the others. Returns the exit code: that of all failures, or kBadFile if they differ. SIGINT,
/// SIGTERM and SIGHUP end a batch of several jobs with its report a second later, the second one at once, and
/// a job that fills a folder with a line that says so.
/// Throws Error(kIo) if the report cannot be written.
ExitCode run_batch(const Tool& tool, const std::vector<Job>& jobs, const BatchOptions& options);

}  // namespace imgmesh

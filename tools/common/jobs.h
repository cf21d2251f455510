// Which outputs become of which inputs.
#pragma once

#include <string>
#include <vector>

#include "tools/common/tool_main.h"

namespace imgmesh {

/// The files of a command line.
struct FileOptions {
    std::vector<std::string> inputs;
    std::string output;  ///< a file, a folder, or empty
    std::string type;    ///< of --format, without a dot; empty: the tool's own
    bool skip_existing = false;
};

/// Returns the work on each input, in their order. Throws Error(kBadArgument) for mistakes that can be found
/// before any work: several inputs for one file, two inputs for one output, an output that would replace an
/// input, and what the tool itself finds; Error(kUnsupported) for a tile set where the tool takes none.
std::vector<Job> plan_jobs(const Tool& tool, const FileOptions& files);

/// Returns the type of --format: letters and digits, in lower case and without a dot. Throws
/// Error(kBadArgument) for other text; `name` is the option.
std::string file_type(const std::string& name, const std::string& text);

/// Returns whether `path` names a folder: it ends with a slash, or it is one.
bool is_folder(const std::string& path);

/// Returns whether the outputs go into a folder, each by a name of its own.
bool fills_folder(const Tool& tool, const FileOptions& files);

/// Makes the folders that -o and the options of `tool` name.
void make_folders(const Tool& tool, const FileOptions& files);

/// Returns the file that a report calls the job's: its input, and for a comparison both.
std::string job_name(const Job& job);

}  // namespace imgmesh

// What is told of one file, and of all together.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/common/tool_main.h"

namespace imgmesh {

enum class FileStatus {
    kInterrupted,  ///< not begun, or not done when the run was ended
    kDone,
    kSkipped,  ///< an earlier run has done it
    kFailed,
};

/// Tells whether a file is still the same, without reading it.
class FileState {
  public:
    FileState() = default;
    /// Of a file that cannot be found, that of no file.
    explicit FileState(const std::string& path);
    bool operator==(const FileState&) const = default;

  private:
    std::array<std::uint64_t, 5> facts_ = {};
};

/// What has become of one job.
struct FileResult {
    FileStatus status = FileStatus::kInterrupted;
    Report report = {};  ///< the tool's; null if it has made none
    std::vector<std::string> warnings = {};
    std::vector<std::string> missed = {};  ///< what --strict refused
    std::vector<Failure> failures = {};
    std::map<std::string, std::string> hashes = {};  ///< SHA-256 of what was read, by its name
    FileState input = {};                            ///< before it was read
    std::string key = {};                            ///< journal_key(), or empty
};

/// Returns the SHA-256 of the files that `job` reads. What cannot be read, or only once, has none.
std::map<std::string, std::string> hash_inputs(const Job& job);

/// Returns the object of a job in a report. parameters: those of the command line.
Report file_report(const Job& job, const FileResult& file, const Report& parameters);

/// Returns what is printed of one file of many: "a.png -> out/a.glb: 12 faces".
std::string file_line(const Tool& tool, const Job& job, const FileResult& file);

/// Returns how many files have become what.
Report summary_report(const std::vector<FileResult>& files, double seconds);

/// Returns `report` with the members of every report in front. generator: "imgmesh-build 0.1.0"
Report with_head(const Tool& tool, const std::string& generator, const Report& report);

/// Returns the exit code of failures that did not stop the run: their common one, or kBadFile.
ExitCode joint_code(const std::vector<Failure>& failures);

}  // namespace imgmesh

// "-": standard input and standard output instead of files.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "formats/files/stream_file.h"
#include "tools/common/jobs.h"
#include "tools/common/tool_main.h"

namespace imgmesh {

/// What messages and reports call them.
inline constexpr const char* kStandardInput = "standard input";
inline constexpr const char* kStandardOutput = "standard output";

/// Returns the name of an output as people see it.
std::string shown_name(const std::string& output);

/// The pipes of a command line. Tools read and write them as files in memory.
class Pipes {
  public:
    /// Reads standard input if `files` has "-" among the inputs, and puts names for the pipes into `files`.
    /// Throws Error: kBadArgument where a pipe cannot be used: a terminal, a folder of outputs, files that
    /// must stand beside the output; kBadFile for an input of more than `most` bytes, and for a .gltf.
    Pipes(const Tool& tool, FileOptions& files, std::uint64_t most);

    bool has_output() const { return output_ != nullptr; }
    /// Writes the output to standard output. Throws Error(kIo).
    void deliver() const;

  private:
    std::unique_ptr<StreamFile> input_, output_;
};

}  // namespace imgmesh

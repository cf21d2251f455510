// Files without a name on disk: what comes from a pipe and what goes into one.
#pragma once

#include <cstdint>
#include <string>

namespace imgmesh {

/// A file in memory that this process reads and writes under `name` as if it were one on disk: read_file(),
/// AtomicFile and file_sha256_hex() know it. Its name stands for it while this object lives. Throws
/// Error(kIo) if there is no memory for it.
class StreamFile {
  public:
    explicit StreamFile(std::string name);
    ~StreamFile();
    StreamFile(const StreamFile&) = delete;
    StreamFile& operator=(const StreamFile&) = delete;

    const std::string& name() const { return name_; }
    int descriptor() const { return fd_; }

    /// Appends what comes from the descriptor `from` until its end. Throws Error(kBadFile) once there are
    /// more than `most` bytes, and Error(kIo) if it cannot be read.
    void fill(int from, std::uint64_t most);
    /// Writes the content to the descriptor `to`, which `what` names. Throws Error(kIo) if it does not take
    /// all.
    void pour(int to, const std::string& what) const;

  private:
    std::string name_;
    int fd_;
};

/// Returns the descriptor of the StreamFile of this name, or -1.
int stream_descriptor(const std::string& path);

/// Returns the path under which the system knows `path`: itself, or that of a StreamFile's descriptor.
std::string system_path(const std::string& path);

}  // namespace imgmesh

// Files that appear complete or not at all.
#pragma once

#include <csignal>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace imgmesh {

/// A file that is written under a temporary name in the target's folder. commit() flushes it to disk and
/// renames it to `path`; destruction without commit() removes it. A run that is killed leaves at most the
/// temporary file, never a partial `path`; a later run that writes to the folder removes it
/// (stale_temporaries.h). Throws Error(kIo) with the system's reason if the folder cannot be written or the
/// disk is full, and if `path` is not a regular file (but a device, a folder). Symbolic links are followed:
/// the file behind a link is replaced, not the link.
class AtomicFile {
  public:
    /// Without `overwrite`, throws Error(kIo) if `path` exists, here and again at commit().
    AtomicFile(std::string path, bool overwrite);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// The file to write, for libraries that want a file name; it ends with the extension of `path`.
    const std::string& temporary_path() const { return temporary_path_; }
    /// Replaces the temporary file's content.
    void write(std::span<const std::uint8_t> bytes) { write_parts({&bytes, 1}); }
    /// The same for several parts, one after the other.
    void write_parts(std::span<const std::span<const std::uint8_t>> parts);
    void commit();
    /// Like commit(), but until keep() destruction removes the file, which has its own name already: for a
    /// file that is useless without another. Only if no file has this name, and in a SignalBlocker.
    void place();
    void keep();

  private:
    void flush_and_rename();

    std::string path_;    ///< as given: for messages
    std::string target_;  ///< the target of the rename: `path_` with symbolic links followed
    std::string temporary_path_;
    int claim_ = -1;  ///< a descriptor that holds the claim to the temporary file
    bool overwrite_;
    bool kept_ = false;
};

/// While one lives, the signals of remove_temporaries_on_signals() wait. It is for a change of several files
/// that must happen as a whole.
class SignalBlocker {
  public:
    SignalBlocker();
    ~SignalBlocker();
    SignalBlocker(const SignalBlocker&) = delete;
    SignalBlocker& operator=(const SignalBlocker&) = delete;

  private:
    sigset_t before_;
};

/// From now on SIGINT, SIGTERM and SIGHUP remove the temporary files of living AtomicFiles and then end the
/// process as usual. Signals that the process already ignores or handles are left alone.
void remove_temporaries_on_signals();

/// Reads a whole file. Throws Error(kIo) if it cannot be read, Error(kBadFile) if longer than `max_bytes`.
std::vector<std::uint8_t> read_file(const std::string& path, std::uint64_t max_bytes);

}  // namespace imgmesh

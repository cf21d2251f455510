// Files that appear whole or not at all.
#pragma once

#include <csignal>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace imgmesh {

/// A file being written under a temporary name in the target's folder. commit() flushes it to disk and
/// renames it to `path`; destruction without commit() removes it. A run that is killed leaves at most the
/// temporary file, never a partial `path`; a later run that writes to the folder removes it
/// (stale_temporaries.h). Throws Error(kIo) with the system's reason when the folder cannot be written or the
/// disk is full, and where `path` is something else than a regular file (a device, a folder). A symbolic link
/// is followed: the file behind it is replaced, not the link.
class AtomicFile {
  public:
    /// `overwrite` false: throws Error(kIo) where `path` exists, here and again at commit().
    AtomicFile(std::string path, bool overwrite);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Where to write. Libraries that want a file name get this one; it ends with the extension of `path`.
    const std::string& temporary_path() const { return temporary_path_; }
    /// Replaces the temporary file's content.
    void write(std::span<const std::uint8_t> bytes) { write_parts({&bytes, 1}); }
    /// The same, one part behind the other.
    void write_parts(std::span<const std::span<const std::uint8_t>> parts);
    void commit();
    /// As commit(), but until keep() destruction removes the file, now under its own name: for a file that is
    /// of no use without another. Only where there was none of this name, and in a SignalBlocker.
    void place();
    void keep();

  private:
    void flush_and_rename();

    std::string path_;    ///< as given: for messages
    std::string target_;  ///< what is renamed to: `path_` with symbolic links followed
    std::string temporary_path_;
    int claim_ = -1;  ///< a descriptor that holds the claim to the temporary file
    bool overwrite_;
    bool kept_ = false;
};

/// As long as one lives, the signals of remove_temporaries_on_signals() wait: for a change of several files
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

/// From now on SIGINT, SIGTERM and SIGHUP remove the temporary files of living AtomicFiles before they end
/// the process as they would have. Signals that the process ignores or handles already are left alone.
void remove_temporaries_on_signals();

/// The whole file. Throws Error(kIo) when it cannot be read, Error(kBadFile) when longer than `max_bytes`.
std::vector<std::uint8_t> read_file(const std::string& path, std::uint64_t max_bytes);

}  // namespace imgmesh

// Files that appear complete or not at all.
#pragma once

#include <csignal>
#include <cstdint>
#include <memory>
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

    /// Gives the file the permissions and the group of `path`, if there is such a file: a replaced file keeps
    /// its own without this call. A group that this process cannot give gets no more than everybody has.
    void share_as(const std::string& path);
    /// Replaces the temporary file's content, through the descriptor that has created it: who exchanges the
    /// file under its name gets nothing, and commit() throws Error(kIo).
    void write(std::span<const std::uint8_t> bytes) { write_parts({&bytes, 1}); }
    /// The same for several parts, one after the other.
    void write_parts(std::span<const std::span<const std::uint8_t>> parts);
    /// Writes bytes from `offset` on and leaves the others, for a file that is too long for memory. Not into
    /// a stream: throws Error(kIo).
    void write_at(std::uint64_t offset, std::span<const std::uint8_t> bytes);
    /// The temporary file's descriptor, for content that comes piece by piece; it stays the file's own.
    int descriptor() const;
    /// While JointFiles live in this thread, they do the renaming.
    void commit();
    /// Like commit(), but at once, and until keep() destruction removes the file, which has its own name
    /// already: for a file that is useless without another. In a SignalBlocker; without keep() only if no
    /// file has this name.
    void place();
    void keep();

  private:
    friend class JointFiles;
    class Temporary;
    std::shared_ptr<Temporary> file_;
};

/// Several outputs of one command: while it lives, AtomicFile::commit() in this thread flushes the file to
/// disk and leaves it under its temporary name, until commit() renames all. Destruction without commit()
/// removes them. One at a time in a thread.
class JointFiles {
  public:
    JointFiles();
    ~JointFiles();
    JointFiles(const JointFiles&) = delete;
    JointFiles& operator=(const JointFiles&) = delete;

    /// Gives all files their names; signals wait meanwhile. Throws Error(kIo) if one cannot be renamed, which
    /// is checked as far as possible before the first is; if some have appeared by then, the text names them.
    void commit();

  private:
    friend class AtomicFile;
    std::vector<std::shared_ptr<AtomicFile::Temporary>> complete_;
    std::vector<std::string> appeared_;
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

/// While one lives, the other FolderLocks of the folder wait, of this process and of others, half a minute at
/// most: for changes of several files that belong together. Where a file system has no locks, it does
/// nothing.
class FolderLock {
  public:
    explicit FolderLock(const std::string& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

  private:
    int fd_;
};

/// What read_file() opens.
enum class FileKind {
    kStream,  ///< a regular file, a pipe or a named pipe
    kRegular  ///< a regular file alone: a name that comes from another file must not block or never end
};

/// Reads a whole file. Throws Error(kIo) if it cannot be read or is of another kind, such as a device;
/// Error(kBadFile) if longer than `max_bytes`.
std::vector<std::uint8_t> read_file(const std::string& path, std::uint64_t max_bytes,
                                    FileKind kind = FileKind::kStream);

}  // namespace imgmesh

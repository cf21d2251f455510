// Temporary files (atomic_file.h) that killed runs have left behind.
#pragma once

#include <string>

namespace imgmesh {

/// The start of every temporary file's name. The process number, '-', a counter and the target's extension
/// follow.
inline constexpr const char* kTemporaryPrefix = ".imgmesh-";

/// Claims the open file for this run until it is closed: remove_stale_temporaries() leaves it alone. Returns
/// false if the file has lost its name, because another run has just removed it as stale. Then take another
/// name.
bool claim_temporary(int fd, const std::string& path);

/// Returns whether `path` still names the open file, itself and not through a link.
bool is_named(int fd, const std::string& path);

/// Removes from `folder` what killed runs have left: regular files of this user, untouched for an hour, with
/// the name of a temporary file that no living run has claimed. The claim is a lock (flock). The process
/// number in the name would mean nothing where containers or machines share the folder. The hour is for file
/// systems whose locks do not reach other machines. It runs once for each folder in the life of a process,
/// and does nothing if anything fails.
void remove_stale_temporaries(const std::string& folder);

/// The same at any time and whatever the age, for a folder to which runs on other machines write no more.
void remove_unclaimed_temporaries(const std::string& folder);

}  // namespace imgmesh

// Temporary files (atomic_file.h) that killed runs have left.
#pragma once

#include <string>

namespace imgmesh {

/// The begin of every temporary file's name: ".imgmesh-", then process number, '-', a counter, and the
/// target's extension.
inline constexpr const char* kTemporaryPrefix = ".imgmesh-";

/// Makes the open file the living run's own until it is closed: remove_stale_temporaries() leaves it alone.
/// False where the name is no longer this file's, as another run has just taken it for stale: then take
/// another name.
bool claim_temporary(int fd, const std::string& path);

/// Removes from `folder` what killed runs have left: regular files of this user with the name of a temporary
/// file that no living run has claimed, untouched for an hour. The claim is a lock (flock) and not the
/// process number in the name, which says nothing where containers or machines share the folder; the hour is
/// for file systems whose locks do not reach other machines. Each folder once in the life of a process; does
/// nothing where anything fails.
void remove_stale_temporaries(const std::string& folder);

}  // namespace imgmesh

// Checks of output files, before any work.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace imgmesh {

/// Throws Error(kIo) if `path` cannot become a new file: its folder does not exist, it is a folder itself, or
/// it exists and `overwrite` is false.
void check_output(const std::string& path, bool overwrite);

/// Throws Error(kBadArgument) if one of the `outputs` is one of the files of `inputs`, by any name.
void check_distinct(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

/// Throws Error(kBadArgument) if two of the `outputs` are one file, by any name.
void check_separate(const std::vector<std::string>& outputs);

/// Returns how many bytes these files have together.
std::uint64_t size_of_files(const std::vector<std::string>& files);

/// Writes `text` as a whole file, atomically.
void write_text(const std::string& path, const std::string& text, bool overwrite);

/// Returns the size of a file that was written.
std::uint64_t output_bytes(const std::string& path);

/// Returns `path` as a folder, which is made if it does not exist. Throws Error(kIo) if that fails.
void make_folder(const std::string& path);

}  // namespace imgmesh

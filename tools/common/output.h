// Checks of where results go, before any work is done.
#pragma once

#include <string>
#include <vector>

namespace imgmesh {

/// Throws Error(kIo) where `path` cannot become a new file: its folder is not there, it is a folder itself,
/// or it exists and `overwrite` is false.
void check_output(const std::string& path, bool overwrite);

/// Throws Error(kBadArgument) where one of the `outputs` is one of the files of `inputs`, by whatever name.
void check_distinct(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

/// Throws Error(kBadArgument) where two of the `outputs` are one file, whatever their names.
void check_separate(const std::vector<std::string>& outputs);

/// Writes `text` as the whole of a file, or nothing.
void write_text(const std::string& path, const std::string& text, bool overwrite);

/// `path` as a folder, made where it is not there. Throws Error(kIo) where that fails.
void make_folder(const std::string& path);

}  // namespace imgmesh

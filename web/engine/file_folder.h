// Files between JavaScript and the readers and writers of formats, which know paths.
#pragma once

#include <emscripten/val.h>

#include <string>
#include <vector>

#include "formats/exr/exr_parts.h"

namespace imgmesh::web {

/// An empty folder in the module's memory, in which paths are bare names while it lives; one at a time.
class FileFolder {
  public:
    FileFolder();
    ~FileFolder();
    FileFolder(const FileFolder&) = delete;
    FileFolder& operator=(const FileFolder&) = delete;

    /// Puts a file there; `bytes` is a Uint8Array. Throws Error(kBadArgument) for a name that is none.
    void add(const std::string& name, const emscripten::val& bytes);
    /// Returns the content of a file as a Uint8Array.
    emscripten::val bytes(const std::string& name) const;
    /// Returns { name, bytes } of each.
    emscripten::val files(const std::vector<std::string>& names) const;
};

/// Throws Error(kBadArgument) unless it is the name of a file without a folder, which any system can store.
void check_file_name(const std::string& name);

/// Returns the bytes of an EXR of these parts as a Uint8Array (write_exr_parts()).
emscripten::val save_exr_parts(const std::vector<NamedImage>& parts);

}  // namespace imgmesh::web

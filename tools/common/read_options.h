// Options for how a tool reads images.
#pragma once

#include <string>
#include <vector>

#include "formats/picture/image_io.h"

namespace CLI {
class App;
}

namespace imgmesh {

/// Adds --color-space and --max-pixels.
void add_read_options(CLI::App& app, ReadImageOptions& options);

/// Reads an image, and appends its warnings, each after the file's name.
Image read_with_warnings(const std::string& path, const ReadImageOptions& options,
                         std::vector<std::string>& warnings);

}  // namespace imgmesh

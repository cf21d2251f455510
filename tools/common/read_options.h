// Options for how a tool reads images.
#pragma once

#include <string>
#include <vector>

#include "formats/picture/image_io.h"
#include "tools/common/tool_main.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace imgmesh {

/// Adds --color-space, --part, --layer and --non-finite, and --max-pixels unless the tool has that already.
/// They are refused without `image`, the option that names the image, if the tool has one.
void add_read_options(CLI::App& app, ReadImageOptions& options, CLI::Option* image = nullptr,
                      bool has_limits = false);

/// Adds --nodata.
void add_nodata_option(CLI::App& app, ReadImageOptions& options);

/// Reads an image, and moves its warnings to `warnings`, each after the file's name.
ReadImage read_with_warnings(const std::string& path, const ReadImageOptions& options,
                             std::vector<std::string>& warnings);

/// What a report says of how an image was read: "part" and "layer" of an EXR that left a choice, and
/// "non_finite", the number of samples that were replaced, if there were any.
Report read_report(const ReadImage& read);

}  // namespace imgmesh

// Label images and contour maps as files. Target imgmesh_pictures.
#pragma once

#include <span>
#include <string>

#include "libcore/base/types.h"

namespace imgmesh {

/// Returns whether write_labels() knows this path's extension: .exr or .png.
bool can_write_labels(const std::string& path);

/// Writes one label for each pixel, rows from top to bottom, kNone for none. `.exr`: one UINT channel `id`.
/// `.png`: 16-bit grey, where 65535 is none, so labels are the same numbers in both. Atomic; the same labels
/// give the same bytes. Throws Error: kBadArgument for another extension or a label above 65534 in a .png;
/// kIo if the file cannot be written.
void write_labels(const std::string& path, int width, int height, std::span<const Id> labels, bool overwrite);

/// Writes an EXR with one FLOAT channel of that name. Throws Error(kIo) if it cannot be written.
void write_float_layer(const std::string& path, const std::string& channel, int width, int height,
                       std::span<const float> values, bool overwrite);

}  // namespace imgmesh

// Label images and contour maps as files. Target imgmesh_pictures.
#pragma once

#include <span>
#include <string>

#include "libcore/base/types.h"

namespace imgmesh {

/// Whether write_labels knows this path's extension: .exr or .png.
bool can_write_labels(const std::string& path);

/// One label a pixel, rows from top to bottom, kNone for none. `.exr`: one UINT channel `id`. `.png`: 16-bit
/// grey, where none is 65535, so that labels are the same numbers in both. Atomic; the same bytes for the
/// same labels. Throws Error: kBadArgument for another extension or, in a .png, a label above 65534; kIo
/// where the file cannot be written.
void write_labels(const std::string& path, int width, int height, std::span<const Id> labels, bool overwrite);

/// An EXR with one FLOAT channel of that name. Throws Error(kIo) where the file cannot be written.
void write_float_layer(const std::string& path, const std::string& channel, int width, int height,
                       std::span<const float> values, bool overwrite);

}  // namespace imgmesh

// Writes label images and contour maps. Target imgmesh::pictures.
#pragma once

#include <span>
#include <string>

#include "libcore/base/types.h"

namespace imgmesh {

/// Whether write_labels() can write a file of this extension: .exr, .png, .tif, .tiff, .npy or
/// .mat.
bool can_write_labels(const std::string& path);

/// Writes one label a pixel, such as LabelImage::values: width * height of them, rows from top to bottom,
/// kNone for none. An .exr gets one UINT channel `id`; a .tif is of unsigned 32-bit integers, and an .npy an
/// array of uint32, both with 4294967295 for none; a .png is 16-bit grey, with 65535 for none. A .mat has the
/// variable `segs` as the benchmark of BSDS500 reads it: a 1 x 1 cell array with the matrix of the labels
/// plus 1, and 0 for none, of class uint16 if that holds them and else uint32.
///
/// The file appears whole or not at all; same bytes for the same labels. Throws Error: kBadArgument for
/// another extension and, in a .png, for a label above 65534; kUnsupported for a .mat of 2 GB or more; kIo if
/// the file cannot be written, or exists and `overwrite` is false.
void write_labels(const std::string& path, int width, int height, std::span<const Id> labels, bool overwrite);

/// Writes one value a pixel, such as ContourMap::values, as an EXR with one FLOAT channel of that name.
/// Throws Error(kIo) as write_labels() does.
void write_float_layer(const std::string& path, const std::string& channel, int width, int height,
                       std::span<const float> values, bool overwrite);

}  // namespace imgmesh

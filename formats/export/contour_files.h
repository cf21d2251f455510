// Writes ultrametric contour maps. Target imgmesh::pictures.
#pragma once

#include <span>
#include <string>

namespace imgmesh {

/// Whether write_contours() can write a file of this extension: .exr, .npy or .mat.
bool can_write_contours(const std::string& path);

/// Writes the values of a ContourMap: width * height of them, (2W+1) x (2H+1) for an image of W x H pixels,
/// rows from top to bottom. An .exr gets one FLOAT channel `height`, an .npy is an array of float32, height x
/// width; both hold the values as they are.
///
/// A .mat is for the benchmark of BSDS500 and has what that wants: the variable `ucm2` of class single with
/// h / (h + half) for each value h, which keeps their order and lies from 0 to 1 (infinity gives 1), and on
/// the frame, which is 0 in a ContourMap, the values beside it, so that contours reach the frame and regions
/// do not join along it. `half_height` is the number `half`, so h = half_height * ucm2 / (1 - ucm2).
///
/// half  the value that becomes 0.5; above 0
/// The file appears whole or not at all; same bytes for the same values. Throws Error: kBadArgument for
/// another extension, kUnsupported for a .mat of 2 GB or more, kIo if the file cannot be written, or exists
/// and `overwrite` is false.
void write_contours(const std::string& path, int width, int height, std::span<const float> values,
                    double half, bool overwrite);

}  // namespace imgmesh

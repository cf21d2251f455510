// The class Segmentation of JavaScript.
#pragma once

#include <emscripten/val.h>

#include <memory>
#include <string>

#include "libcore/image/mask.h"
#include "libcore/segment/segment.h"
#include "web/engine/mesh_value.h"

namespace imgmesh::web {

/// A level of a mesh cut into cells, all merges of these, and the image that they were measured on.
struct SegmentValue {
    MeshPointer mesh;
    int level = 0;
    FeatureImage picture = {};
    Segmentation result = {};
};
using SegmentPointer = std::shared_ptr<SegmentValue>;

/// Returns the labels that `table` gives: the region of every cell, regions being numbered by their first
/// cell. Throws Error(kBadArgument) for another number of cells and for other numbers.
LabelImage labels_from(const SegmentValue& value, const emscripten::val& table);

/// Returns the pixels that marks choose (choose_by_seeds()): `keep` and `drop` are lists of lines, each a
/// list of { x, y }. The labels of `value` become those of the table.
Mask mask_from(SegmentValue& value, const emscripten::val& table, const emscripten::val& keep,
               const emscripten::val& drop);

/// The same as a .png, as imgmesh-segment --mask writes it.
emscripten::val mask_png(SegmentValue& value, const emscripten::val& table, const emscripten::val& keep,
                         const emscripten::val& drop);

/// Returns a .glb of the mesh in pieces, as imgmesh-segment --mesh writes it.
emscripten::val region_pieces(const SegmentValue& value, const emscripten::val& table);

/// Returns the contour map as imgmesh-segment --ucm writes it, by the extension of `name`: .npy or .mat.
emscripten::val contour_file(const SegmentValue& value, const std::string& name);

}  // namespace imgmesh::web

// The class Segmentation of JavaScript.
#pragma once

#include <emscripten/val.h>

#include <memory>

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

}  // namespace imgmesh::web

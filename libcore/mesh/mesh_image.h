// An image as a pyramid of base meshes, each with its pixel map: the content of a container.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "libcore/image/color.h"
#include "libcore/image/image.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

/// Name and value of a parameter that shaped the result, such as {"vertices", 4000}.
using BuildParameter = std::pair<std::string, std::variant<bool, std::int64_t, double, std::string>>;

/// One level of the pyramid: a base mesh and the pixel map onto it.
struct Level {
    BaseMesh mesh;
    PixelMap map;      ///< every face id < mesh.faces.size(), or kNone
    double error = 0;  ///< largest quadric error that a collapse down to here has had [feature^2 px^2]
};

/// The image that a MeshImage was made from.
struct SourceInfo : GridSize {
    ColorSpace color_space =
        ColorSpace::kSrgb;  ///< of the image; meshes are in feature space (L*u*v*) all the same
    SampleType sample_type = SampleType::kUint8;
    /// The channels that the meshes are made of, by their names in the file. split_names() tells the colour,
    /// which is stored as L*u*v*, from the others, which are features of their own in this order.
    std::vector<std::string> channel_names = {"R", "G", "B"};
    bool has_mask = false;          ///< whether some pixels are outside (PixelCoord::face == kNone)
    Gamut gamut = Gamut::kDisplay;  ///< of the meshes' colours
};

/// The whole of it. read_container() returns one that is sound; whoever fills one keeps to the comments here
/// and in BaseMesh and PixelMap.
struct MeshImage {
    SourceInfo source;
    std::vector<Level> levels;  ///< 0 is the finest; at least one
    std::vector<Id> visits;     ///< how often the collapse touched each pixel, size width * height; or empty
    std::string generator;      ///< e.g. "imgmesh-build 0.1.0"
    std::vector<BuildParameter> parameters;
};

}  // namespace imgmesh

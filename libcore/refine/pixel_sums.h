// Sums over the pixels of a face: how far its drawing is from an image, and where less error lies.
#pragma once

#include <array>
#include <vector>

#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// An image of three channels as planes, each padded so that eight floats can be read at any pixel.
struct ImagePlanes {
    /// Pixels outside `mask`, which is empty() or of the image's size, count nowhere.
    explicit ImagePlanes(const FeatureImage& picture, const Mask& mask = {});
    int width, height;
    std::vector<float> inside;  ///< 1 inside the mask and 0 outside, padded too; empty without a mask
    std::array<std::vector<float>, 3> channel;
};

/// A corner of a face: where it is and its colour.
struct Corner {
    Vec2f position;
    Vec3f color;
};

/// With e = drawing - image and w the first corner's weight, summed over the pixels of a face.
struct CornerSums {
    double ee = 0;             ///< |e|^2: the squared error
    double ww = 0;             ///< w^2
    Vec3d we = Vec3d::Zero();  ///< w e
};

/// The same for all three corners.
struct FaceSums {
    double ee = 0;
    double ww[3][3] = {};  ///< w_i w_j
    Vec3d we[3] = {Vec3d::Zero(), Vec3d::Zero(), Vec3d::Zero()};
};

/// Of the face (a, b, c), counter-clockwise on screen, drawn with colours interpolated linearly; pixels as
/// for_each_span shares them out. Positions on kPositionStep. Same bits on every processor.
CornerSums corner_sums(const ImagePlanes& picture, const Corner& a, const Corner& b, const Corner& c);
/// CornerSums::ee alone, to the bit.
double squared_error(const ImagePlanes& picture, const Corner& a, const Corner& b, const Corner& c);
FaceSums face_sums(const ImagePlanes& picture, const Corner& a, const Corner& b, const Corner& c);

/// The pixel of the face with the largest |e|^2, the first of several; (-1, -1) for a face without pixels.
struct WorstPixel {
    int x = -1, y = -1;
    float error = -1;  ///< |e|^2
};
WorstPixel worst_pixel(const ImagePlanes& picture, const Corner& a, const Corner& b, const Corner& c);

}  // namespace imgmesh

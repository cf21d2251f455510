// Sums over the pixels of a face: the error of its drawing, and the directions in which it falls.
#pragma once

#include <array>
#include <vector>

#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// An image of three channels as planes, each padded so that eight floats can be read at any pixel.
struct ImagePlanes {
    /// Pixels outside `mask`, which is empty() or of the image's size, do not count.
    explicit ImagePlanes(const FeatureImage& image, const Mask& mask = {});
    int width, height;
    std::vector<float> inside;  ///< 1 inside the mask and 0 outside, padded too; empty without a mask
    std::array<std::vector<float>, 3> channel;
};

/// A corner of a face: its position and its colour.
struct Corner {
    Vec2f position;
    Vec3f color;
};

/// Sums over the pixels of a face, with e = drawing - image and w the first corner's weight.
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

/// Sums over the face (a, b, c), counter-clockwise on screen, drawn with colours interpolated linearly, over
/// its pixels by for_each_span(). Positions on kPositionStep. The bits are the same on every processor.
CornerSums corner_sums(const ImagePlanes& image, const Corner& a, const Corner& b, const Corner& c);
/// Returns only CornerSums::ee, to the bit.
double squared_error(const ImagePlanes& image, const Corner& a, const Corner& b, const Corner& c);
FaceSums face_sums(const ImagePlanes& image, const Corner& a, const Corner& b, const Corner& c);

/// Returns the pixel of the face with the largest |e|^2, the first of equal ones; (-1, -1) if it has no
/// pixels.
struct WorstPixel {
    int x = -1, y = -1;
    float error = -1;  ///< |e|^2
};
WorstPixel worst_pixel(const ImagePlanes& image, const Corner& a, const Corner& b, const Corner& c);

}  // namespace imgmesh

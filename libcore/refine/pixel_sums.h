// Sums over the pixels of a face: the error of its drawing, and the directions in which it falls.
#pragma once

#include <array>
#include <vector>

#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// An image of three channels as planes, each padded so that eight floats can be read at any pixel.
struct ImagePlanes : GridSize {
    /// Pixels outside `mask`, which is empty() or of the image's size, do not count.
    explicit ImagePlanes(const FeatureImage& image, const Mask& mask = {});
    std::vector<float> inside;  ///< 1 inside the mask and 0 outside, padded too; empty without a mask
    std::array<std::vector<float>, 3> channel;
};

/// A corner of a face: its position and its colour.
struct Corner {
    Vec2f position;
    Vec3f color;
};

/// Sums over the pixels of a face, with e = drawing - image and w_i the weight of corner i. As large as a
/// line of a cache.
struct FaceSums {
    float ee;          ///< |e|^2: the squared error
    float square[3];   ///< w_i^2
    float product[3];  ///< w_j w_k of the two corners other than i
    Vec3f we[3];       ///< w_i e

    /// The colour of corner i changes.
    void shift(std::size_t i, const Vec3d& change);
};

/// Sums over the face (a, b, c), counter-clockwise on screen, drawn with colours interpolated linearly, over
/// its pixels as FaceSpans has them. Positions on kPositionStep. The bits are the same on every processor.
FaceSums face_sums(const ImagePlanes& image, const Corner& a, const Corner& b, const Corner& c);
/// Returns only FaceSums::ee, before it is rounded to a float.
double squared_error(const ImagePlanes& image, const Corner& a, const Corner& b, const Corner& c);

/// Sums over pixels with h, the weight of a new vertex: it is 1 there, 0 on the edges around it, and linear
/// between. The vertex may lower the squared error by up to |he|^2 / hh.
struct HatSums {
    float hh = 0;              ///< h^2
    Vec3f he = Vec3f::Zero();  ///< h e
};
struct FaceHats {
    HatSums center;               ///< of a vertex in the middle of the face
    std::array<HatSums, 3> edge;  ///< of one on the edge opposite corner i: this face's part of it
};
/// at  where the vertex on the edge opposite corner i is: 0 is corner i + 1, and 1 is corner i + 2
FaceHats face_hats(const ImagePlanes& image, const Corner& a, const Corner& b, const Corner& c,
                   const std::array<float, 3>& at);

}  // namespace imgmesh

// Sums over the pixels that a face draws: what a least-squares fit of colours needs.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "libcore/coding/draw_coded.h"

namespace imgmesh::coding {

/// Over the face's pixels, each with its own weight, with w the barycentric weights of its corners and i the
/// picture.
struct FaceMoments {
    std::array<std::array<double, 3>, 3> ww{};  ///< sums of w w
    std::array<std::array<double, 4>, 3> wi{};  ///< sums of w i, by corner and channel
    double ii = 0;                              ///< sum of i i over all channels
    int pixels = 0;
};

/// Returns the moments of all faces, each pixel counted at the face that draws it (draw_coded). One loop over
/// pixels: the reference for faster ways.
/// picture  width * height * channels, interleaved, in grey levels, times alpha
/// weights  of the pixels, with a mean of 1; none: all are 1
std::vector<FaceMoments> face_moments(const CodedShape& shape, std::span<const float> picture, int channels,
                                      std::span<const float> weights = {});

}  // namespace imgmesh::coding

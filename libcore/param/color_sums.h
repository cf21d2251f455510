// What the fit of colours needs to know of a pixel map: sums over the pixels of each face. Internal to this
// room.
#pragma once

#include <cstddef>
#include <vector>

#include "libcore/image/image.h"
#include "libcore/mesh/face_field.h"
#include "libcore/mesh/pixel_map.h"
#include "libcore/param/relax.h"

namespace imgmesh {

/// The part of each face in the normal equations of its corners: for each corner the sums of its weight times
/// the weights of all three, then those of its weight times each feature of the pixel.
struct ColorSums {
    int channels = 3;            ///< features
    std::vector<double> values;  ///< [face][corner][3 + channels]

    std::size_t row_size() const { return as_index(3 + channels); }
    const double* row(std::size_t face, std::size_t corner) const {
        return values.data() + (face * 3 + corner) * row_size();
    }
    /// Adds `weight` times another map's sums, of the same mesh and image.
    void add(const ColorSums& other, double weight);
};

/// Sums over the pixels of a map, which has the image's size. Pixels without a face are left out. The result
/// is the same for any number of threads.
ColorSums color_sums(const FeatureImage& feature, const PixelMap& map, std::size_t faces);
/// The same for pixels that are being moved; `fields` are those of the mesh's faces.
ColorSums color_sums(const FeatureImage& feature, const PixelEmbedding& pixels,
                     const std::vector<FaceField>& fields);

}  // namespace imgmesh

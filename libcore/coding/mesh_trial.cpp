#include "libcore/coding/mesh_trial.h"

#include <algorithm>

#include "libcore/base/index.h"
#include "libcore/coding/quantise_colors.h"

namespace imgmesh::coding {

// Squared error that a bit of colour may cost, over the squared step, for each pixel of a vertex.
constexpr double kBitPrice = 0.03;

MeshTrial::MeshTrial(const CodedMesh& mesh, std::span<const float> picture, const ColorWeights& weights,
                     std::span<const float> pixel_weights)
    : content_(arranged(mesh)),
      weights_(weights),
      plan_(plan_colors(content_.shape())),
      moments_(face_moments(content_.shape(), picture, mesh.channels, pixel_weights)) {}

void MeshTrial::code(int step_index) {
    ColorChoice choice;
    choice.weight = weights_.weight;
    for (std::size_t k = 0; k < as_index(content_.channels); ++k) {
        content_.step_index[k] = std::clamp(step_index + weights_.shift[k], 0, kStepIndices - 1);
        choice.steps[k] = color_step(content_.step_index[k]);
    }
    const double step = choice.steps[0] / double{kColorUnit};
    const double pixels = double(content_.grid.width) * content_.grid.height;
    choice.bit_price = kBitPrice * step * step * pixels / static_cast<double>(vertices());
    content_.level = quantise_colors(content_.shape(), plan_, moments_, content_.channels, choice).level;
    bytes_ = write_stream(content_, &sizes_);
}

double MeshTrial::squared_error(const Bitmap& picture) const {
    const std::vector<std::uint8_t> drawn =
        draw_coded(content_.shape(), content_.color, content_.channels, picture.width, picture.height);
    double sum = 0;
    const auto channels = as_index(picture.channels);
    for (std::size_t i = 0; i < drawn.size(); i += channels) {
        if (!picture.has_alpha()) {
            for (std::size_t k = 0; k < channels; ++k) {
                const double e = double(drawn[i + k]) - picture.data[i + k];
                sum += e * e;
            }
            continue;
        }
        const double a = drawn[i + channels - 1], b = picture.data[i + channels - 1];
        sum += (a - b) * (a - b);
        for (std::size_t k = 0; k + 1 < channels; ++k) {
            const double e = (drawn[i + k] * a - picture.data[i + k] * b) / 255;
            sum += e * e;
        }
    }
    return sum;
}

}  // namespace imgmesh::coding

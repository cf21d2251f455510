// One mesh of a picture, and its colours at several step sizes: what the search for a rate tries.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "libcore/coding/bitmap.h"
#include "libcore/coding/coded_stream.h"
#include "libcore/coding/color_plan.h"
#include "libcore/coding/face_moments.h"

namespace imgmesh::coding {

/// How much finer or coarser the channels of colour are than that of lightness, and what their errors weigh.
struct ColorWeights {
    std::array<int, 4> shift{};  ///< of step indices
    std::array<double, 4> weight{1, 1, 1, 1};
};

class MeshTrial {
  public:
    /// picture  what to draw: samples of `channels`, premultiplied, 0 to 255; as long as the trial lives
    /// pixel_weights  how much each pixel's error counts; none: all alike
    MeshTrial(const CodedMesh& mesh, std::span<const float> picture, const ColorWeights& weights,
              std::span<const float> pixel_weights = {});

    std::size_t vertices() const { return content_.point.size(); }
    /// Chooses colours with steps of this index and writes them.
    void code(int step_index);
    const std::vector<std::uint8_t>& bytes() const { return bytes_; }
    const StreamSizes& sizes() const { return sizes_; }
    const StreamContent& content() const { return content_; }
    /// Returns the squared error of what a decoder draws, over all samples times alpha.
    double squared_error(const Bitmap& picture) const;

  private:
    StreamContent content_;
    ColorWeights weights_;
    ColorPlan plan_;
    std::vector<FaceMoments> moments_;
    std::vector<std::uint8_t> bytes_;
    StreamSizes sizes_;
};

}  // namespace imgmesh::coding

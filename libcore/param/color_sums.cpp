#include "libcore/param/color_sums.h"

#include <algorithm>
#include <cstring>

#include "libcore/base/parallel.h"
#include "libcore/base/simd.h"
#include "libcore/image/channel_count.h"

namespace imgmesh {
namespace {

// Sums of one run of pixels of a row in the same face. A run is short, so floats are enough. There is room
// for 4 G features.
template <int G>
struct Run {
    Float4 weights[3] = {}, features[3][G] = {};

    void add(float u, float v, const Float4 (&pixel)[G]) {
        const float w[3] = {1 - u - v, u, v};
        const Float4 all{w[0], u, v, 0};
        for (int a = 0; a < 3; ++a) {
            weights[a] += w[a] * all;
            for (int g = 0; g < G; ++g) features[a][g] += w[a] * pixel[g];
        }
    }
    void add_to(double* sums, int channels) const {
        for (int a = 0; a < 3; ++a) {
            for (int k = 0; k < 3; ++k) *sums++ += double{weights[a][k]};
            for (int c = 0; c < channels; ++c) *sums++ += double{features[a][c / 4][c % 4]};
        }
    }
};

// The sums over some rows, for the faces from `first` on.
struct PartialSums {
    std::size_t first = 0;
    std::vector<double> values;
};

// face(i) is the face of pixel i, weights(x, y, face) returns a PixelCoord.
template <typename FaceOf, typename WeightsOf>
class Summing {
  public:
    Summing(const FeatureImage& feature, FaceOf face, WeightsOf weights)
        : feature_(feature),
          face_(face),
          weights_(weights),
          stride_(3 * (3 + as_index(feature.channels))),
          last_pixel_(feature.pixel_count() - 1) {}

    PartialSums rows(int begin, int end) const {
        PartialSums part;
        Id least = kNone, most = 0;
        for (std::size_t i = as_index(begin) * as_index(feature_.width),
                         last = as_index(end) * as_index(feature_.width);
             i < last; ++i) {
            const Id face = face_(i);
            least = std::min(least, face);
            most = std::max(most, face == kNone ? 0 : face);
        }
        if (least == kNone) return part;
        part.first = least;
        part.values.resize((most - least + 1) * stride_);
        for (int y = begin; y < end; ++y)
            feature_.channels == 3 ? add_row<1>(y, part) : add_row<kGroups>(y, part);
        return part;
    }

    std::size_t stride() const { return stride_; }

  private:
    static constexpr int kGroups = (kMaxFeatures + 3) / 4;

    double* sums(PartialSums& part, Id face) const {
        return part.values.data() + (face - part.first) * stride_;
    }

    template <int G>
    void add_row(int y, PartialSums& part) const {
        const int channels = G == 1 ? 3 : feature_.channels;  // a constant in the usual case
        Run<G> run;
        Id current = kNone;
        for (int x = 0; x < feature_.width; ++x) {
            const std::size_t i = feature_.index(x, y);
            const Id face = face_(i);
            if (face != current) {
                if (current != kNone) run.add_to(sums(part, current), channels);
                run = {};
                current = face;
            }
            if (face == kNone) continue;
            const PixelCoord coord = weights_(x, y, face);
            Float4 pixel[G] = {};
            if (G == 1 && i < last_pixel_)  // read as a whole, with one float of the next pixel
                std::memcpy(pixel, feature_.pixel(i), sizeof pixel);
            else
                std::memcpy(pixel, feature_.pixel(i), as_index(channels) * sizeof(float));
            run.add(coord.u, coord.v, pixel);
        }
        if (current != kNone) run.add_to(sums(part, current), channels);
    }

    const FeatureImage& feature_;
    FaceOf face_;
    WeightsOf weights_;
    std::size_t stride_, last_pixel_;
};

template <typename FaceOf, typename WeightsOf>
ColorSums sum_up(const FeatureImage& feature, std::size_t faces, FaceOf face, WeightsOf weights) {
    // Each part has sums for up to all faces, so the number of parts is limited by the memory they take.
    constexpr int kParts = 8, kGrainFaces = 4096;
    const Summing<FaceOf, WeightsOf> summing(feature, face, weights);
    PartialSums parts[kParts];
    parallel_blocks(0, kParts, 1, [&](int part, int) {
        const auto row = [&](int p) { return static_cast<int>(std::int64_t{feature.height} * p / kParts); };
        parts[part] = summing.rows(row(part), row(part + 1));
    });
    const std::size_t stride = summing.stride();
    ColorSums sums{feature.channels, std::vector<double>(faces * stride)};
    parallel_blocks(0, as_int(faces), kGrainFaces, [&](int begin, int end) {
        for (const PartialSums& part : parts) {
            const std::size_t first = std::max(as_index(begin), part.first),
                              last = std::min(as_index(end), part.first + part.values.size() / stride);
            for (std::size_t f = first; f < last; ++f)
                for (std::size_t k = 0; k < stride; ++k)
                    sums.values[f * stride + k] += part.values[(f - part.first) * stride + k];
        }
    });
    return sums;
}

}  // namespace

void ColorSums::add(const ColorSums& other, double weight) {
    constexpr int kGrain = 1 << 16;
    values.resize(other.values.size());
    parallel_blocks(0, as_int(values.size()), kGrain, [&](int begin, int end) {
        for (std::size_t i = as_index(begin); i < as_index(end); ++i) values[i] += weight * other.values[i];
    });
}

ColorSums color_sums(const FeatureImage& feature, const PixelMap& map, std::size_t faces) {
    return sum_up(
        feature, faces, [&](std::size_t i) { return map[i].face; },
        [&](int x, int y, Id) { return map.at(x, y); });
}

ColorSums color_sums(const FeatureImage& feature, const PixelEmbedding& pixels,
                     const std::vector<FaceField>& fields) {
    return sum_up(
        feature, fields.size(), [&](std::size_t i) { return pixels.face[i]; },
        [&](int x, int y, Id face) {
            const Vec2f p = pixels.image_of(x, y);
            return PixelCoord{face, fields[face].u(p.x(), p.y()), fields[face].v(p.x(), p.y())};
        });
}

}  // namespace imgmesh

#include "libcore/warp/warp_image.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/warp/cell_raster.h"
#include "libcore/warp/footprint.h"

namespace imgmesh {
namespace {

constexpr int kMaxSide = 65535;
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;

OutputSize checked_size(const DisplacementField& field, OutputSize size) {
    if (size.width == 0 && size.height == 0) return {field.width, field.height};
    if (size.width < 1 || size.height < 1 || std::max(size.width, size.height) > kMaxSide ||
        std::int64_t{size.width} * size.height > kMaxPixels)
        throw Error(ErrorKind::kBadArgument, cat("size is ", size.width, "x", size.height, ", expected 1 to ",
                                                 kMaxSide, " a side and at most ", kMaxPixels, " pixels"));
    return size;
}

// Pixels of the drawing per pixel of the image.
Vec2f scale_of(const GridSize& out, const GridSize& in) {
    return {float(out.width) / float(in.width), float(out.height) / float(in.height)};
}

// Draws into rows of pixels with kChannels channels (0: as many as the image has).
template <int kChannels>
class ImageSink {
  public:
    ImageSink(const Image& in, const DisplacementField& field, const std::vector<float>& alpha, Image& out,
              std::vector<float>& coverage)
        : in_(in),
          field_(field),
          alpha_(alpha),
          out_(out),
          coverage_(coverage),
          scale_(scale_of(out, field)) {}

    void copy(int column, int row, int x, int y) {
        const std::size_t from = field_.index(x, y), to = out_.index(column, row);
        const float* source = in_.data.data() + from * size();
        std::copy_n(source, size(), out_.data.data() + to * size());
        coverage_[to] = alpha_.empty() ? 1.0f : alpha_[from];
    }

    void plain(int column, int row, int x, int y, float fx, float fy) {
        if (!alpha_.empty()) {
            sample(column, row, {x, y, fx, fy, {1, 0}, {0, 1}});
            return;
        }
        const std::size_t to = out_.index(column, row);
        const float *a = in_.data.data() + field_.index(x, y) * size(), *b = a + size(),
                    *c = a + in_.row_size(), *d = c + size();
        float* out = out_.data.data() + to * size();
        for (std::size_t i = 0; i < size(); ++i) {
            const float upper = a[i] + fx * (b[i] - a[i]), lower = c[i] + fx * (d[i] - c[i]);
            out[i] = upper + fy * (lower - upper);
        }
        coverage_[to] = 1.0f;
    }

    void sample(int column, int row, const CellPoint& p) {
        const std::size_t to = out_.index(column, row);
        float* out = out_.data.data() + to * size();
        const float sides = is_plain(p) && !on_rim(field_, p) ? 1.0f : side_coverage(field_, scale_, p);
        std::fill_n(out, size(), 0.0f);
        if (alpha_.empty()) {
            for_points(field_, p, [&](const Taps& taps, float share) { add(taps, share, taps.weight, out); });
            coverage_[to] = sides;
            return;
        }
        float total = 0;
        for_points(field_, p, [&](const Taps& taps, float share) {
            float weight[4];
            for (int t = 0; t < 4; ++t) {
                weight[t] = taps.weight[t] * alpha_[taps.index[t]];
                total += share * weight[t];
            }
            add(taps, share, weight, out);
        });
        if (total > 0)
            for (std::size_t c = 0; c < size(); ++c) out[c] /= total;
        coverage_[to] = std::min(total, 1.0f) * sides;
    }

  private:
    std::size_t size() const { return kChannels > 0 ? std::size_t{kChannels} : as_index(in_.channels); }
    void add(const Taps& taps, float share, const float* weight, float* out) const {
        const float *a = in_.data.data() + taps.index[0] * size(),
                    *b = in_.data.data() + taps.index[1] * size(),
                    *c = in_.data.data() + taps.index[2] * size(),
                    *d = in_.data.data() + taps.index[3] * size();
        const float wa = share * weight[0], wb = share * weight[1], wc = share * weight[2],
                    wd = share * weight[3];
        for (std::size_t i = 0; i < size(); ++i) out[i] += wa * a[i] + wb * b[i] + wc * c[i] + wd * d[i];
    }

    const Image& in_;
    const DisplacementField& field_;
    const std::vector<float>& alpha_;
    Image& out_;
    std::vector<float>& coverage_;
    Vec2f scale_;
};

class MapSink {
  public:
    MapSink(const DisplacementField& field, const std::vector<float>& alpha, InverseMap& out)
        : field_(field), alpha_(alpha), out_(out), scale_(scale_of(out, field)) {}

    void copy(int column, int row, int x, int y) {
        const std::size_t from = field_.index(x, y), to = out_.index(column, row);
        out_.source[to] = Eigen::Vector2i(x, y).cast<float>();
        out_.coverage[to] = alpha_.empty() ? 1.0f : alpha_[from];
    }

    void plain(int column, int row, int x, int y, float fx, float fy) {
        sample(column, row, {x, y, fx, fy, {1, 0}, {0, 1}});
    }

    void sample(int column, int row, const CellPoint& p) {
        const std::size_t to = out_.index(column, row);
        float total = 0;
        for_points(field_, p, [&](const Taps& taps, float share) {
            for (int t = 0; t < 4; ++t)
                total += share * taps.weight[t] * (alpha_.empty() ? 1.0f : alpha_[taps.index[t]]);
        });
        out_.source[to] = Eigen::Vector2i(p.x, p.y).cast<float>() + Vec2f(p.fx, p.fy);
        const float sides = is_plain(p) && !on_rim(field_, p) ? 1.0f : side_coverage(field_, scale_, p);
        out_.coverage[to] = (alpha_.empty() ? 1.0f : std::min(total, 1.0f)) * sides;
    }

  private:
    const DisplacementField& field_;
    const std::vector<float>& alpha_;
    InverseMap& out_;
    Vec2f scale_;
};

// Returns `image` with `alpha` as its A. An A channel is added if there is none and something is transparent.
void set_alpha(Image& image, const std::vector<float>& alpha) {
    const int channel = image.channel("A");
    if (channel >= 0) {
        for (std::size_t i = 0; i < alpha.size(); ++i) image.pixel(i)[channel] = alpha[i];
        return;
    }
    if (std::all_of(alpha.begin(), alpha.end(), [](float a) { return a == 1; })) return;
    std::vector<float> data;
    data.reserve(image.data.size() + alpha.size());
    for (std::size_t i = 0; i < alpha.size(); ++i) {
        data.insert(data.end(), image.pixel(i), image.pixel(i) + image.channels);
        data.push_back(alpha[i]);
    }
    image.data = std::move(data);
    image.channel_names.emplace_back("A");
    ++image.channels;
}

template <int kChannels>
void draw(const Image& image, const DisplacementField& field, const std::vector<float>& alpha, Image& out,
          std::vector<float>& coverage) {
    ImageSink<kChannels> sink(image, field, alpha, out, coverage);
    raster_cells(CellPlaces(field, out.width, out.height), out.width, out.height, sink);
}

// Returns the image unchanged, except that opaque pixels outside the mask become transparent.
Image clear_outside(const Image& image, const DisplacementField& field) {
    Image out = image;
    if (!field.has_mask) return out;
    std::vector<float> alpha = alpha_of(image);
    alpha.resize(image.pixel_count(), 1.0f);
    for (std::size_t i = 0; i < alpha.size(); ++i)
        if (field.role[i] != PixelRole::kInside && alpha[i] >= 1) alpha[i] = 0;
    set_alpha(out, alpha);
    return out;
}

bool moves_nothing(const DisplacementField& field) {
    return std::all_of(field.move.begin(), field.move.end(), [](const Vec2f& m) { return m.isZero(0); });
}

}  // namespace

std::vector<float> alpha_of(const Image& image) {
    std::vector<float> alpha;
    const int channel = image.channel("A");
    if (channel < 0) return alpha;
    alpha.reserve(image.pixel_count());
    for (std::size_t i = 0; i < image.pixel_count(); ++i) alpha.push_back(image.pixel(i)[channel]);
    return alpha;
}

Image warp_image(const Image& image, const DisplacementField& given, const OutputSize& wanted) {
    if (image.width != given.width || image.height != given.height)
        throw Error(ErrorKind::kBadFile, cat("the image has ", image.width, "x", image.height,
                                             " pixels, the pixel map ", given.width, "x", given.height));
    const OutputSize size = checked_size(given, wanted);
    DisplacementField extended;
    const DisplacementField& field = given.has_mask ? extended : given;
    if (size.width == given.width && size.height == given.height && moves_nothing(given))
        return clear_outside(image, given);
    std::vector<float> alpha = alpha_of(image);
    if (given.has_mask) {
        extended = given;
        extend_outside(extended, alpha);
    }
    Image out;
    out.width = size.width;
    out.height = size.height;
    out.channels = image.channels;
    out.channel_names = image.channel_names;
    out.sample_type = image.sample_type;
    out.color_space = image.color_space;
    out.data.resize(out.sample_count());
    std::vector<float> coverage(out.pixel_count());
    switch (image.channels) {
        case 1:
            draw<1>(image, field, alpha, out, coverage);
            break;
        case 3:
            draw<3>(image, field, alpha, out, coverage);
            break;
        case 4:
            draw<4>(image, field, alpha, out, coverage);
            break;
        default:
            draw<0>(image, field, alpha, out, coverage);
    }
    set_alpha(out, coverage);
    return out;
}

InverseMap inverse_map(const DisplacementField& given, std::vector<float> alpha, const OutputSize& wanted) {
    const OutputSize size = checked_size(given, wanted);
    DisplacementField field = given;
    extend_outside(field, alpha);
    InverseMap map{{size.width, size.height}, {}, {}};
    map.source.assign(map.pixel_count(), Vec2f(0, 0));
    map.coverage.assign(map.pixel_count(), 0.0f);
    MapSink sink(field, alpha, map);
    raster_cells(CellPlaces(field, size.width, size.height), size.width, size.height, sink);
    return map;
}

}  // namespace imgmesh

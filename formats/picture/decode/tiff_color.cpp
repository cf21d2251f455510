// Sources: TIFF 6.0, sections 3, 16, 18, 20, 21 and 23; Adobe Photoshop TIFF Technical Notes (ICCLAB); G.
// Ward Larson, "LogLuv encoding for full-gamut, high-dynamic range images", 1998, with libtiff's matrix.
#include "formats/picture/decode/tiff_color.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "libcore/base/parallel.h"
#include "libcore/image/color.h"

namespace imgmesh {
namespace {

using Names = std::vector<std::string>;

// The code that stands for 1.
float largest_code(const TiffLayout& layout) {
    if (layout.kind == TiffSamples::kFloat) return 1;
    return static_cast<float>(std::ldexp(1.0, layout.bits - (layout.kind == TiffSamples::kSigned ? 1 : 0)) -
                              1);
}

SampleType sample_type(const TiffLayout& layout) {
    if (layout.kind == TiffSamples::kFloat) return layout.bits == 16 ? SampleType::kHalf : SampleType::kFloat;
    return layout.bits <= 8 ? SampleType::kUint8 : SampleType::kUint16;
}

// The place among the extra samples of the one that is alpha, or -1.
int alpha_of(const TiffLayout& layout) {
    for (std::size_t i = 0; i < layout.extras.size(); ++i)
        if (layout.extras[i] == EXTRASAMPLE_ASSOCALPHA || layout.extras[i] == EXTRASAMPLE_UNASSALPHA)
            return static_cast<int>(i);
    return -1;
}

void name_extras(const TiffLayout& layout, DecodedPicture& out) {
    const auto first = static_cast<std::size_t>(layout.color_samples());
    const int alpha = alpha_of(layout);
    for (std::size_t i = 0; i < layout.extras.size(); ++i)
        out.image.channel_names.push_back(static_cast<int>(i) == alpha ? "A" : cat("channel", first + i));
    out.associated_alpha =
        alpha >= 0 && layout.extras[static_cast<std::size_t>(alpha)] == EXTRASAMPLE_ASSOCALPHA;
    if (layout.extras.size() == 1 && alpha < 0)
        out.warnings.push_back(
            cat("the file does not say what its last channel means; it is channel", first, ", not alpha"));
}

// The colour of a pixel from its colour samples, 1, 3 or (inks) 4 numbers.
struct Converter {
    int channels;
    std::function<void(const float* from, float* to)> convert;
};

Converter divided(int channels, float by) {
    return {channels, [channels, by](const float* from, float* to) {
                for (int c = 0; c < channels; ++c) to[c] = from[c] / by;
            }};
}

// Entries are 16-bit codes by the standard. Old writers stored 8-bit codes, as they are or times 256.
Converter palette(const TiffFile& file, const TiffLayout& layout, SampleType& type) {
    std::array<const std::uint16_t*, 3> maps{};
    if (TIFFGetField(file.get(), TIFFTAG_COLORMAP, &maps[0], &maps[1], &maps[2]) != 1)
        throw file.broken("the TIFF has indices of colours, but no palette");
    const std::size_t count = std::size_t{1} << layout.bits;
    bool low = true, shifted = true, repeated = true;
    for (const std::uint16_t* map : maps)
        for (std::size_t i = 0; i < count; ++i) {
            low = low && map[i] < 256;
            shifted = shifted && map[i] % 256 == 0;
            repeated = repeated && map[i] % 257 == 0;
        }
    const float by = low ? 255 : shifted ? 65280 : 65535;
    type = low || shifted || repeated ? SampleType::kUint8 : SampleType::kUint16;
    std::vector<float> colors;
    for (std::size_t i = 0; i < count; ++i)
        for (const std::uint16_t* map : maps) colors.push_back(static_cast<float>(map[i]) / by);
    return {3, [colors = std::move(colors), count](const float* from, float* to) {
                const auto index = static_cast<std::int64_t>(from[0]);  // signed indices wrap
                std::copy_n(colors.begin() + 3 * (index & static_cast<std::int64_t>(count - 1)), 3, to);
            }};
}

Converter chroma(const TiffFile& file, float by) {
    const float* weights = nullptr;
    const float* reference = nullptr;
    TIFFGetFieldDefaulted(file.get(), TIFFTAG_YCBCRCOEFFICIENTS, &weights);
    TIFFGetFieldDefaulted(file.get(), TIFFTAG_REFERENCEBLACKWHITE, &reference);
    if (!weights || !reference) throw file.broken("the TIFF's YCbCr has no coefficients");
    const std::array<float, 3> luma{weights[0], weights[1], weights[2]};
    std::array<float, 6> range{};
    std::copy_n(reference, 6, range.begin());
    if (!(luma[1] > 0) || !(range[1] > range[0]) || !(range[3] > range[2]) || !(range[5] > range[4]))
        throw file.broken("the TIFF's YCbCr has coefficients or a range of 0");
    return {3, [luma, range, by](const float* from, float* to) {
                const float y = (from[0] - range[0]) / (range[1] - range[0]);
                const float half = (by - 1) / 2;  // 127 for 8 bits, as the standard has it
                const float b = (from[1] - range[2]) / (range[3] - range[2]) * half / by;
                const float r = (from[2] - range[4]) / (range[5] - range[4]) * half / by;
                to[0] = y + r * (2 - 2 * luma[0]);
                to[2] = y + b * (2 - 2 * luma[2]);
                to[1] = (y - luma[0] * to[0] - luma[2] * to[2]) / luma[1];
                for (int c = 0; c < 3; ++c) to[c] = std::clamp(to[c], 0.0f, 1.0f);
            }};
}

Converter log_luv(const TiffLayout& layout) {
    if (layout.photometric == PHOTOMETRIC_LOGL) return divided(1, 1);
    return {3, [](const float* xyz, float* to) {  // for an equal-energy white, as libtiff's TIFFXYZToRGB24()
                to[0] = 2.690f * xyz[0] - 1.276f * xyz[1] - 0.414f * xyz[2];
                to[1] = -1.022f * xyz[0] + 1.978f * xyz[1] + 0.044f * xyz[2];
                to[2] = 0.061f * xyz[0] - 0.224f * xyz[1] + 1.163f * xyz[2];
            }};
}

// L*a*b* under D50 unless the file names another white, adapted to D65 in cone responses (Bradford).
Converter lab(const TiffFile& file, const TiffLayout& layout) {
    const float* xy = nullptr;
    Eigen::Vector3d white(0.9642, 1, 0.8249);
    if (TIFFGetField(file.get(), TIFFTAG_WHITEPOINT, &xy) == 1 && xy && xy[0] > 0 && xy[1] > 0 &&
        xy[0] + xy[1] < 1)
        white = {static_cast<double>(xy[0] / xy[1]), 1, static_cast<double>((1 - xy[0] - xy[1]) / xy[1])};
    Eigen::Matrix3d cones;
    cones << 0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296;
    const Eigen::Vector3d d65(0.95047, 1, 1.08883), gain = (cones * d65).cwiseQuotient(cones * white);
    const Eigen::Matrix3d rgb =
        rgb_from_xyz(ColorSpace::kSrgb) * cones.inverse() * gain.asDiagonal() * cones * white.asDiagonal();
    const bool icc = layout.photometric == PHOTOMETRIC_ICCLAB, wide = layout.bits == 16;
    return {3, [rgb, icc, wide](const float* from, float* to) {
                // Signed a* and b* arrive as unsigned codes; ICC's have an offset instead.
                const double unit = wide ? 256 : 1, turn = 256 * unit;
                const auto chroma_of = [&](float code) {
                    const double c = static_cast<double>(code);
                    return (icc ? c - turn / 2 : c >= turn / 2 ? c - turn : c) / unit;
                };
                const double l = 100 * static_cast<double>(from[0]) / (wide ? icc ? 65280 : 65535 : 255);
                const double y = (l + 16) / 116, x = y + chroma_of(from[1]) / 500,
                             z = y - chroma_of(from[2]) / 200;
                const auto part = [](double t) {
                    return t > 6.0 / 29 ? t * t * t : (t - 4.0 / 29) * 3 * 36 / 841;
                };
                const Eigen::Vector3d linear = rgb * Eigen::Vector3d(part(x), part(y), part(z));
                const Vec3f encoded = encoded_from_linear(ColorSpace::kSrgb,
                                                          linear.cast<float>().cwiseMax(0.0f).cwiseMin(1.0f));
                for (int c = 0; c < 3; ++c) to[c] = encoded[c];
            }};
}

Converter converter(const TiffFile& file, const TiffLayout& layout, SampleType& type) {
    const float by = largest_code(layout);
    switch (layout.photometric) {
        case PHOTOMETRIC_MINISWHITE:
            return {1, [by](const float* from, float* to) { to[0] = 1 - from[0] / by; }};
        case PHOTOMETRIC_PALETTE:
            return palette(file, layout, type);
        case PHOTOMETRIC_YCBCR:
            return chroma(file, by);
        case PHOTOMETRIC_CIELAB:
        case PHOTOMETRIC_ICCLAB:
            return lab(file, layout);
        case PHOTOMETRIC_LOGL:
        case PHOTOMETRIC_LOGLUV:
            return log_luv(layout);
        default:
            return divided(layout.color_samples(), by);
    }
}

// Rows of one block: enough work to be worth handing over.
constexpr int kGrainRows = 64;

bool is_divided_alone(const TiffLayout& layout) {
    return layout.photometric == PHOTOMETRIC_MINISBLACK || layout.photometric == PHOTOMETRIC_MASK ||
           layout.photometric == PHOTOMETRIC_RGB || layout.photometric == PHOTOMETRIC_SEPARATED;
}

Names value_names(const TiffLayout& layout) {
    switch (layout.photometric) {
        case PHOTOMETRIC_RGB:
            return {"R", "G", "B"};
        case PHOTOMETRIC_SEPARATED:
            return {"cyan", "magenta", "yellow", "black"};
        case PHOTOMETRIC_YCBCR:
            return {"luma", "Cb", "Cr"};
        case PHOTOMETRIC_CIELAB:
        case PHOTOMETRIC_ICCLAB:
            return {"L", "a", "b"};
        case PHOTOMETRIC_LOGLUV:
            return {"X", "luminance", "Z"};
        default:
            return {"Y"};
    }
}

void set_shape(const TiffLayout& layout, int channels, Image& image) {
    image.width = static_cast<int>(layout.width);
    image.height = static_cast<int>(layout.height);
    image.channels = channels;
    image.sample_type = sample_type(layout);
}

}  // namespace

void image_from_samples(const TiffFile& file, const TiffLayout& layout, std::vector<float> samples,
                        DecodedPicture& out) {
    SampleType type = sample_type(layout);
    const Converter color = converter(file, layout, type);
    const float by = largest_code(layout);
    const std::size_t from = static_cast<std::size_t>(layout.samples), extras = layout.extras.size(),
                      to = static_cast<std::size_t>(color.channels) + extras;
    set_shape(layout, static_cast<int>(to), out.image);
    out.image.sample_type = type;
    out.image.channel_names = color.channels == 4   ? Names{"C", "M", "Y", "K"}
                              : color.channels == 3 ? Names{"R", "G", "B"}
                                                    : Names{"Y"};
    out.color.inks = color.channels == 4;
    name_extras(layout, out);
    const std::size_t pixels = samples.size() / from;
    if (is_divided_alone(layout)) {
        parallel_blocks(0, static_cast<int>(layout.height), kGrainRows, [&](int first, int last) {
            const std::size_t row = samples.size() / static_cast<std::size_t>(layout.height);
            for (std::size_t i = static_cast<std::size_t>(first) * row;
                 i < static_cast<std::size_t>(last) * row; ++i)
                samples[i] /= by;
        });
        out.image.data = std::move(samples);
        return;
    }
    const auto convert = [&](const float* in, float* put) {
        std::array<float, 4> converted{};
        color.convert(in, converted.data());
        for (std::size_t i = 0; i < extras; ++i)
            put[static_cast<std::size_t>(color.channels) + i] = in[from - extras + i] / by;
        std::copy_n(converted.begin(), color.channels, put);
    };
    if (to > from) {
        out.image.data.resize(pixels * to);
        for (std::size_t i = 0; i < pixels; ++i) convert(&samples[i * from], &out.image.data[i * to]);
        return;
    }
    for (std::size_t i = 0; i < pixels; ++i) convert(&samples[i * from], &samples[i * to]);
    samples.resize(pixels * to);
    out.image.data = std::move(samples);
}

Names sample_names(const TiffLayout& layout) {
    Names names = value_names(layout);
    const int alpha = alpha_of(layout);
    for (std::size_t i = 0; i < layout.extras.size(); ++i)
        names.push_back(static_cast<int>(i) == alpha ? "A" : cat("channel", names.size()));
    return names;
}

void values_from_samples(const TiffLayout& layout, std::vector<float> samples, DecodedPicture& out) {
    set_shape(layout, layout.samples, out.image);
    out.image.channel_names = sample_names(layout);
    out.image.data = std::move(samples);
    const int alpha = alpha_of(layout);
    if (alpha < 0) return;
    const auto step = static_cast<std::size_t>(layout.samples);
    const std::size_t first =
        static_cast<std::size_t>(layout.color_samples()) + static_cast<std::size_t>(alpha);
    for (std::size_t i = first; i < out.image.data.size(); i += step)
        out.image.data[i] /= largest_code(layout);
}

}  // namespace imgmesh

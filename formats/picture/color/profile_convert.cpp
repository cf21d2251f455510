#include "formats/picture/color/profile_convert.h"

#include <Eigen/LU>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "libcore/base/parallel.h"
#include "libcore/image/color.h"

namespace imgmesh {
namespace {

constexpr int kGrainRows = 16;

// Where the colour is: one channel of grey, or three.
struct ColorPlaces {
    std::vector<std::size_t> at;

    explicit ColorPlaces(const Image& image) {
        const int r = image.channel("R"), g = image.channel("G"), b = image.channel("B"),
                  grey = image.channel("Y");
        if (std::min({r, g, b}) >= 0)
            for (const int c : {r, g, b}) at.push_back(static_cast<std::size_t>(c));
        else if (grey >= 0)
            at.push_back(static_cast<std::size_t>(grey));
    }
    Vec3f color(const float* pixel) const {
        return at.size() == 1 ? Vec3f::Constant(pixel[at[0]])
                              : Vec3f(pixel[at[0]], pixel[at[1]], pixel[at[2]]);
    }
    void set(float* pixel, const Vec3f& color) const {
        if (at.size() == 1) pixel[at[0]] = color[1];  // grey is the same in all three
        for (std::size_t c = 0; at.size() == 3 && c < 3; ++c) pixel[at[c]] = color[static_cast<int>(c)];
    }
};

Image without_ink(const Image& image) {
    Image out = make_image(image.width, image.height, image.channels - 1);
    out.channel_names = {"R", "G", "B"};
    out.channel_names.insert(out.channel_names.end(), image.channel_names.begin() + 4,
                             image.channel_names.end());
    out.sample_type = image.sample_type;
    return out;
}

// What Little CMS is given for a pixel, of floats.
struct Source {
    cmsUInt32Number format;
    std::vector<std::size_t> channels;
    float scale = 1;
};

std::optional<Source> source_of(const Image& image, const ColorPlaces& places, cmsUInt32Number model,
                                bool inks) {
    const std::vector<std::size_t>& at = places.at;
    if (inks) {
        constexpr float kPercent = 100;  // as which Little CMS counts ink
        if (model != cmsSigCmykData || image.channels < 4) return std::nullopt;
        return Source{TYPE_CMYK_FLT, {0, 1, 2, 3}, kPercent};
    }
    if (model == cmsSigRgbData && at.size() == 3) return Source{TYPE_RGB_FLT, at};
    if (model == cmsSigRgbData && at.size() == 1) return Source{TYPE_RGB_FLT, {at[0], at[0], at[0]}};
    if (model == cmsSigGrayData && at.size() == 1) return Source{TYPE_GRAY_FLT, at};
    return std::nullopt;
}

bool is_inside(const Vec3f& linear) {
    // Colours of sRGB that Rec.2020 has rounded to 8 bits come back up to 0.0067 below and 0.0099 above.
    constexpr float kTolerance = 0.01f;
    return linear.minCoeff() >= -kTolerance && linear.maxCoeff() <= 1 + kTolerance;
}

// The pixels outside of the space's gamut; `image` is linear.
std::int64_t outside(const Image& image, ColorSpace space) {
    const ColorPlaces places(image);
    const Eigen::Matrix3f to_space =
        (rgb_from_xyz(space) * rgb_from_xyz(ColorSpace::kLinear).inverse()).cast<float>();
    std::atomic<std::int64_t> count = 0;
    parallel_blocks(0, image.height, kGrainRows, [&](int first, int last) {
        std::int64_t here = 0;
        for (int y = first; y < last; ++y)
            for (int x = 0; x < image.width; ++x)
                here += !is_inside(to_space * places.color(image.pixel(x, y)));
        count += here;
    });
    return count;
}

}  // namespace

std::optional<Image> linear_from_profile(const Image& image, const LcmsProfile& profile, bool inks) {
    // Links and named colours lead to no colour space, abstract profiles come from none.
    // As a number: a broken profile has values that the enumeration does not have.
    const cmsUInt32Number kind = cmsGetDeviceClass(profile.get());
    if (kind != cmsSigInputClass && kind != cmsSigDisplayClass && kind != cmsSigOutputClass &&
        kind != cmsSigColorSpaceClass)
        return std::nullopt;
    Image out = inks ? without_ink(image) : image;
    const ColorPlaces places(out);
    const std::optional<Source> source = source_of(image, places, cmsGetColorSpace(profile.get()), inks);
    if (!source) return std::nullopt;
    const LcmsProfile linear = profile_from_color_space(ColorSpace::kLinear);
    const LcmsTransform transform(cmsCreateTransform(profile.get(), source->format, linear.get(),
                                                     TYPE_RGB_FLT, INTENT_RELATIVE_COLORIMETRIC,
                                                     cmsFLAGS_NOOPTIMIZE | cmsFLAGS_NOCACHE));
    if (!transform) return std::nullopt;
    std::atomic<bool> finite = true;
    const auto width = static_cast<std::size_t>(image.width);
    parallel_blocks(0, image.height, kGrainRows, [&](int first, int last) {
        std::vector<float> in(width * source->channels.size()), rgb(width * 3);
        for (int y = first; y < last; ++y) {
            auto to = in.begin();
            for (int x = 0; x < image.width; ++x)
                for (const std::size_t c : source->channels) *to++ = source->scale * image.pixel(x, y)[c];
            cmsDoTransform(transform.get(), in.data(), rgb.data(), static_cast<cmsUInt32Number>(width));
            if (!std::ranges::all_of(rgb, [](float v) { return std::isfinite(v); })) finite = false;
            for (int x = 0; x < image.width; ++x) {
                const float* color = rgb.data() + 3 * static_cast<std::size_t>(x);
                places.set(out.pixel(x, y), {color[0], color[1], color[2]});
                for (int c = 4; inks && c < image.channels; ++c)
                    out.pixel(x, y)[c - 1] = image.pixel(x, y)[c];
            }
        }
    });
    if (!finite) return std::nullopt;
    out.color_space = ColorSpace::kLinear;
    return out;
}

void count_outside(const Image& image, OutsideGamut& counts) {
    counts.srgb += outside(image, ColorSpace::kSrgb);
    counts.display_p3 += outside(image, ColorSpace::kDisplayP3);
    counts.adobe_rgb += outside(image, ColorSpace::kAdobeRgb);
}

ColorSpace narrowest_space(const OutsideGamut& counts) {
    if (counts.srgb == 0) return ColorSpace::kSrgb;
    return counts.adobe_rgb < counts.display_p3 ? ColorSpace::kAdobeRgb : ColorSpace::kDisplayP3;
}

void encode_in_narrowest(Image& image) {
    OutsideGamut counts;
    if (outside(image, ColorSpace::kSrgb) > 0) count_outside(image, counts);
    encode_in(image, narrowest_space(counts));
}

void encode_in(Image& image, ColorSpace space) {
    const ColorPlaces places(image);
    parallel_blocks(0, image.height, kGrainRows, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            for (int x = 0; x < image.width; ++x)
                places.set(image.pixel(x, y), encoded_from_linear(space, places.color(image.pixel(x, y))));
    });
    image.color_space = space;
}

}  // namespace imgmesh

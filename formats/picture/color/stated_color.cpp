#include "formats/picture/color/stated_color.h"

#include <algorithm>
#include <cmath>

#include "formats/files/one_line.h"
#include "formats/picture/color/profile_convert.h"
#include "libcore/base/error.h"
#include "libcore/image/color.h"

namespace imgmesh {
namespace {

bool is_integer(SampleType type) {
    return type == SampleType::kUint8 || type == SampleType::kUint16;
}

// What the user wants of an image that has to be converted.
struct Wish {
    std::optional<ColorSpace> asked;    ///< this space
    std::optional<ColorSpace> fitting;  ///< for integers
};

// Linear floats stay so: they hold every colour. Integers are stored again, in a space that fits.
void encode(Image& image, const Wish& wish) {
    if (wish.asked)
        encode_in(image, *wish.asked);
    else if (is_integer(image.sample_type) && wish.fitting)
        encode_in(image, *wish.fitting);
    else if (is_integer(image.sample_type))
        encode_in_narrowest(image);
}

// Returns whether the image could be converted.
bool convert(const LcmsProfile& profile, bool inks, const Wish& wish, Image& image) {
    std::optional<Image> linear = linear_from_profile(image, profile, inks);
    if (!linear) return false;
    image = std::move(*linear);
    encode(image, wish);
    return true;
}

// The next three return whether the statement could be used.
bool use_code_points(const StatedColor& stated, Image& image, std::vector<std::string>& warnings) {
    const CodePoints& codes = *stated.code_points;
    const LcmsProfile profile = profile_from_code_points(codes);
    if (!profile) {
        warnings.push_back(cat("its colours are by code points ", codes.primaries, " and ", codes.transfer,
                               " of ITU-T H.273 (primaries and transfer), which imgmesh cannot convert"));
        return false;
    }
    if (is_hdr(codes)) {
        decode_hdr(codes, image);
        image.sample_type = image.sample_type == SampleType::kUint8 ? SampleType::kHalf : SampleType::kFloat;
        return convert(profile, false, {}, image);
    }
    if (const auto ours = color_space_of(profile)) {
        image.color_space = *ours;
        return true;
    }
    return convert(profile, false, {{}, stated.fitting}, image);
}

bool use_icc(const StatedColor& stated, const Wish& wish, Image& image, std::vector<std::string>& warnings) {
    const std::vector<std::uint8_t>& icc = stated.icc;
    const bool inks = stated.inks;
    const LcmsProfile profile = profile_from_icc(icc);
    const bool grey_profile = profile && cmsGetColorSpace(profile.get()) == cmsSigGrayData;
    if (profile && !inks && !(grey_profile && image.channel("R") >= 0)) {
        // color_space_of() takes the tables away, which the conversion needs.
        if (const auto ours = color_space_of(profile_from_icc(icc))) {
            image.color_space = *ours;
            return true;
        }
    }
    if (profile && convert(profile, inks, wish, image)) return true;
    warnings.push_back(
        cat("its ICC profile ",
            profile ? profile_name(profile) + " cannot be used for its channels" : "is broken"));
    return false;
}

bool use_chromaticities(const StatedColor& stated, Image& image, std::vector<std::string>& warnings) {
    constexpr Chromaticities kRec709 = {0.3127, 0.3290, 0.64, 0.33, 0.30, 0.60, 0.15, 0.06};
    constexpr float kLeast = 0.1f, kMost = 10;  // nothing that shows an image is beyond
    const bool gamma = stated.gamma >= kLeast && stated.gamma <= kMost;
    if (!gamma && !stated.chromaticities) return false;
    const LcmsCurve curve = gamma ? power_curve(double(stated.gamma))
                                  : broken_curve({2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045});
    const LcmsProfile profile = profile_from_primaries(stated.chromaticities.value_or(kRec709), *curve);
    if (profile) {
        if (const auto ours = color_space_of(profile)) {
            image.color_space = *ours;
            return true;
        }
        if (convert(profile, false, {{}, stated.fitting}, image)) return true;
    }
    warnings.push_back("its chromaticities span no colours");
    return false;
}

// What printers' four inks leave of white paper if nothing is known of them.
void mix_inks(Image& image) {
    Image out = make_image(image.width, image.height, image.channels - 1);
    out.channel_names = {"R", "G", "B"};
    out.channel_names.insert(out.channel_names.end(), image.channel_names.begin() + 4,
                             image.channel_names.end());
    out.sample_type = image.sample_type;
    const auto from = static_cast<std::size_t>(image.channels);
    float* to = out.data.data();
    for (const float* p = image.data.data(); p != image.data.data() + image.data.size(); p += from) {
        for (std::size_t c = 0; c < 3; ++c) *to++ = (1 - p[c]) * (1 - p[3]);
        to = std::copy(p + 4, p + from, to);
    }
    image = std::move(out);
}

}  // namespace

void settle_color(const StatedColor& stated, std::optional<ColorSpace> asked, Image& image,
                  std::vector<std::string>& warnings) {
    const ColorSpace usual = is_integer(image.sample_type) ? ColorSpace::kSrgb : ColorSpace::kLinear;
    image.color_space = asked.value_or(usual);
    const std::size_t before = warnings.size();
    if (stated.inks) {
        if (!stated.icc.empty() && use_icc(stated, {asked, stated.fitting}, image, warnings)) return;
        mix_inks(image);
        image.color_space = asked.value_or(ColorSpace::kSrgb);
    } else {
        if (asked) return;
        const bool color = image.channel("R") >= 0 || image.channel("Y") >= 0;
        if (color && stated.code_points && use_code_points(stated, image, warnings)) return;
        if (color && !stated.icc.empty() && use_icc(stated, {{}, stated.fitting}, image, warnings)) return;
        if (const auto named = parse_color_space(stated.name))
            image.color_space = *named;
        else if (color)
            use_chromaticities(stated, image, warnings);
    }
    for (std::size_t i = before; i < warnings.size(); ++i)
        warnings[i] += cat("; its colours are read as ", color_space_name(image.color_space));
}

}  // namespace imgmesh

// TIFF through libtiff, which only undoes the compression: what its own conversion to RGBA does not know
// would come back wrong without a word.
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "formats/picture/decode/nodata.h"
#include "formats/picture/decode/tiff_color.h"
#include "formats/picture/decode/tiff_picture.h"
#include "formats/picture/decode/tiff_samples.h"

namespace imgmesh {
namespace {

// GDAL writes the number as text; "nan" is one of them. Other texts name none.
std::optional<double> nodata_of(const TiffFile& file) {
    // The library does not know the tag, and gives the length of such.
    if (!TIFFFindField(file.get(), kGdalNoData, TIFF_ASCII)) return {};
    std::uint32_t count = 0;
    const char* stored = nullptr;
    if (TIFFGetField(file.get(), kGdalNoData, &count, &stored) != 1 || !stored) return {};
    const std::string text(stored, count);
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return end == text.c_str() ? std::optional<double>() : value;
}

// A curve has no place in StatedColor; the usual ones need no word.
void warn_of_curve(const TiffFile& file, const TiffLayout& layout, std::vector<std::string>& warnings) {
    const std::uint16_t *red = nullptr, *green = nullptr, *blue = nullptr;
    if (layout.kind != TiffSamples::kUnsigned || layout.bits > 16 ||
        TIFFGetField(file.get(), TIFFTAG_TRANSFERFUNCTION, &red, &green, &blue) != 1 || !red)
        return;
    constexpr float kMiddle = 0.2155f,
                    kTolerance = 0.02f;  // of code 1/2 by sRGB's curve and by a gamma of 2.2
    const float middle = static_cast<float>(red[std::size_t{1} << (layout.bits - 1)]) / 65535;
    if (!(std::abs(middle - kMiddle) < kTolerance))
        warnings.emplace_back("the file states a transfer function of its own, which is not applied");
}

void state_color(const TiffFile& file, const TiffLayout& layout, DecodedPicture& out) {
    // L*a*b* and LogLuv are converted already.
    if (layout.photometric == PHOTOMETRIC_CIELAB || layout.photometric == PHOTOMETRIC_ICCLAB ||
        layout.photometric == PHOTOMETRIC_LOGL || layout.photometric == PHOTOMETRIC_LOGLUV)
        return;
    std::uint32_t length = 0;
    const void* profile = nullptr;
    if (TIFFGetField(file.get(), TIFFTAG_ICCPROFILE, &length, &profile) == 1 && profile && length > 0) {
        const auto* bytes = static_cast<const std::uint8_t*>(profile);
        out.color.icc.assign(bytes, bytes + length);
        return;
    }
    if (out.image.channel("R") < 0) return;
    const float *white = nullptr, *p = nullptr;
    if (TIFFGetField(file.get(), TIFFTAG_PRIMARYCHROMATICITIES, &p) == 1 && p &&
        TIFFGetField(file.get(), TIFFTAG_WHITEPOINT, &white) == 1 && white) {
        out.color.chromaticities = {white[0], white[1], p[0], p[1], p[2], p[3], p[4], p[5]};
        if (layout.kind == TiffSamples::kFloat) out.color.gamma = 1;
    }
    warn_of_curve(file, layout, out.warnings);
}

// The same as for images, on the file's own numbers; alpha is not among them.
Mask take_nodata_out(std::vector<float>& samples, const TiffLayout& layout, double nodata) {
    Image image;
    image.width = static_cast<int>(layout.width);
    image.height = static_cast<int>(layout.height);
    image.channels = layout.samples;
    image.channel_names = sample_names(layout);
    image.data = std::move(samples);
    Mask mask = imgmesh::take_nodata_out(image, nodata);
    samples = std::move(image.data);
    return mask;
}

}  // namespace

TiffPicture::TiffPicture(TiffFile& file, const ReadImageOptions& options, const ImageLimits& limits)
    : file_(file), options_(options) {
    const bool thumbnail = choose_page(file);
    if (thumbnail && TIFFCurrentDirectory(file.get()) == 0)
        warnings_.emplace_back(
            "every image of the TIFF is flagged as a thumbnail or a mask; the first is read");
    layout_ = tiff_layout(file, limits, options.limits);
    check_block_count(file, layout_);
    nodata_ = nodata_of(file);
    spool_ = spool_info(file);
    is_copy_ = is_copy(file);
}

DecodedPicture TiffPicture::read(const PixelRect& area) {
    std::optional<float> fill;  // GDAL leaves blocks out that hold nothing else
    if (nodata_ && !is_copy_) fill = static_cast<float>(*nodata_);
    return picture(area.width(), area.height(), read_samples(file_, layout_, area, fill, rows_.get()));
}

DecodedPicture TiffPicture::zero_pixel() {
    return picture(1, 1, std::vector<float>(static_cast<std::size_t>(layout_.samples)));
}

DecodedPicture TiffPicture::picture(int width, int height, std::vector<float> samples) {
    TiffLayout layout = layout_;  // of what has been read
    layout.width = width;
    layout.height = height;
    if (spool_) return spooled(layout, std::move(samples));
    DecodedPicture out;
    out.warnings = warnings_;
    const std::optional<double> nodata = options_.nodata || !options_.file_nodata ? options_.nodata : nodata_;
    if (nodata) out.data = take_nodata_out(samples, layout, *nodata);
    out.knows_nodata = true;
    if (options_.values) out.largest_code = 1;
    if (options_.values)
        values_from_samples(layout, std::move(samples), out);
    else
        image_from_samples(file_, layout, std::move(samples), out);
    if (!options_.values && layout.kind == TiffSamples::kSigned)
        out.warnings.push_back(cat("the samples are signed integers, which are values rather than colours; ",
                                   "as colours, the largest, ", std::ldexp(1.0, layout.bits - 1) - 1,
                                   ", is 1"));
    out.orientation = file_.defaulted_tag<std::uint16_t>(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    if (!options_.values) state_color(file_, layout, out);
    return out;
}

// As the decoders of PNG and JPEG leave it.
DecodedPicture TiffPicture::spooled(const TiffLayout& layout, std::vector<float> samples) {
    DecodedPicture out;
    image_from_samples(file_, layout, std::move(samples), out);
    out.color = spool_->color;
    if (spool_->inks_upside_down)
        for (float& sample : out.image.data) sample = 1 - sample;
    out.orientation = file_.tag<std::uint16_t>(TIFFTAG_ORIENTATION, 0);
    return out;
}

DecodedPicture decode_tiff(const PictureFile& picture) {
    TiffFile file(picture.path, picture.bytes);
    TiffPicture tiff(file, picture.options, picture.options.limits);
    const TiffLayout& layout = tiff.layout();
    return tiff.read({0, 0, static_cast<int>(layout.width), static_cast<int>(layout.height)});
}

}  // namespace imgmesh

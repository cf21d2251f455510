#include "tools/build_mask.h"

#include <iomanip>

#include "libcore/image/mask_value.h"
#include "tools/common/in_file.h"
#include "tools/common/read_options.h"

namespace imgmesh {
namespace {

// The code of an integer sample, of its largest. Samples of 32 bits may be smaller than any code.
std::string code_text(float value, SampleType type) {
    const int most = type == SampleType::kUint8 ? 255 : type == SampleType::kUint16 ? 65535 : 0;
    const auto code = static_cast<long>(value * static_cast<float>(most) + 0.5f);
    if (most == 0) return cat(value);
    return code == 0 && value > 0 ? cat(value, " of 1") : cat(code, " of ", most);
}

}  // namespace

Mask read_mask(const std::string& path, double threshold, const ImageLimits& limits, const Image& image,
               const std::string& name, std::vector<std::string>& warnings) {
    std::vector<std::string> own;
    const Image picture = read_with_warnings(path, {.limits = limits}, own).image;
    if (picture.width != image.width || picture.height != image.height)
        throw Error(ErrorKind::kBadFile, cat(path, ": the mask is ", picture.width, "x", picture.height, ", ",
                                             name, " is ", image.width, "x", image.height));
    const auto least = static_cast<float>(threshold);
    Mask mask = in_file(path, [&] { return image_mask(picture, least); });
    if (mask.count() > 0) {
        warnings.insert(warnings.end(), own.begin(), own.end());
        return mask;
    }
    const float largest = largest_mask_value(picture, least);
    const std::string found = cat(path, ": no pixel is inside the mask: its largest value is ",
                                  code_text(largest, picture.sample_type));
    if (largest <= 0) throw Error(ErrorKind::kUnsupported, cat(found, ", and pixels inside are above 0"));
    // Half of the largest value is between the two values of a mask that has only two.
    throw Error(ErrorKind::kUnsupported,
                cat(found, ", below the threshold of ", threshold, "; --alpha-threshold ",
                    std::setprecision(2), largest / 2, " takes the mask"));
}

}  // namespace imgmesh

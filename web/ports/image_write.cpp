// Image files of a page: PNG. A canvas makes JPEG and WebP, and imgmesh's programs the others.
#include "formats/files/atomic_file.h"
#include "formats/files/extension.h"
#include "formats/picture/color/icc_profile.h"
#include "formats/picture/encode/picture_encoders.h"
#include "formats/picture/image_io.h"
#include "libcore/base/error.h"

namespace imgmesh {

bool can_write_image(const std::string& path) {
    return lower_extension(path) == ".png";
}

std::vector<std::uint8_t> encode_image(const std::string& path, const Image& image,
                                       std::optional<SampleType> sample_type, const ExrMetadata&) {
    const SampleType type = sample_type.value_or(image.sample_type);
    if (!can_write_image(path))
        throw Error(ErrorKind::kBadArgument, cat(path, ": in a browser images are written as .png alone"));
    if ((type != SampleType::kUint8 && type != SampleType::kUint16) || image.channels > 4 ||
        image.color_space != ColorSpace::kSrgb)
        throw Error(ErrorKind::kUnsupported,
                    cat(path, ": expected an image of one to four channels in sRGB, in 8 or 16 bits"));
    return encode_png(image, type);
}

void write_image(const std::string& path, const Image& image, const WriteImageOptions& options) {
    AtomicFile file(path, options.overwrite);
    file.write(encode_image(path, image, options.sample_type, options.metadata));
    file.commit();
}

// encode_image() has refused other colours than sRGB, which no profile describes.
std::vector<std::uint8_t> icc_from_color_space(ColorSpace) {
    throw Error(ErrorKind::kInternal, "a browser writes no colour profiles");
}

}  // namespace imgmesh

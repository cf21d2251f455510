#include "formats/export/label_files.h"

#include <algorithm>
#include <array>

#include "formats/export/label_tiff.h"
#include "formats/export/mat_file.h"
#include "formats/export/npy.h"
#include "formats/exr/exr_parts.h"
#include "formats/files/extension.h"
#include "formats/picture/image_io.h"
#include "libcore/base/error.h"
#include "libcore/base/index.h"

namespace imgmesh {
namespace {

constexpr Id kPngNone = 65535;
constexpr std::array kExtensions = {".exr", ".png", ".tif", ".tiff", ".npy", ".mat"};

// Label 0 is 1 there, and 0 is none.
void write_segs(const std::string& path, std::size_t width, std::size_t height, std::span<const Id> labels,
                bool overwrite) {
    const auto number = [&](std::size_t i) { return labels[i] + 1; };
    static_assert(kNone + 1 == 0);
    const bool large = std::ranges::any_of(labels, [](Id l) { return l != kNone && l >= kPngNone; });
    const MatVariable segs = {"segs",
                              large ? MatType::kUint32 : MatType::kUint16,
                              height,
                              width,
                              /*in_cell=*/true,
                              large ? by_columns<std::uint32_t>(width, height, number)
                                    : by_columns<std::uint16_t>(width, height, [&](std::size_t i) {
                                          return static_cast<std::uint16_t>(number(i));
                                      })};
    write_mat(path, {&segs, 1}, overwrite);
}

}  // namespace

bool can_write_labels(const std::string& path) {
    const std::string extension = lower_extension(path);
    return std::ranges::any_of(kExtensions, [&](const char* known) { return extension == known; });
}

void write_labels(const std::string& path, int width, int height, std::span<const Id> labels,
                  bool overwrite) {
    if (!can_write_labels(path))
        throw Error(ErrorKind::kBadArgument,
                    cat(path, ": labels are written as .exr, .png, .tif, .npy or .mat"));
    const std::string extension = lower_extension(path);
    if (extension == ".exr") {
        write_exr_channel(path, "id", width, height, labels, overwrite);
        return;
    }
    if (extension == ".npy") {
        write_npy(path, {"", "u4", {as_index(height), as_index(width)}, bytes_of(labels)}, overwrite);
        return;
    }
    if (extension == ".mat") {
        write_segs(path, as_index(width), as_index(height), labels, overwrite);
        return;
    }
    if (extension != ".png") {
        LabelTiff file(path, width, height, overwrite);
        file.put(labels);
        file.commit();
        return;
    }
    Image image = make_image(width, height, 1);
    image.sample_type = SampleType::kUint16;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (labels[i] != kNone && labels[i] >= kPngNone)
            throw Error(ErrorKind::kBadArgument,
                        cat(path, ": a 16-bit PNG holds labels up to ", kPngNone - 1, ", there is label ",
                            *std::ranges::max_element(labels, {}, [](Id l) { return l == kNone ? 0 : l; }),
                            "; expected .exr, .tif, .npy or .mat"));
        image.data[i] = static_cast<float>(std::min(labels[i], kPngNone)) / float(kPngNone);
    }
    write_image(path, image, {overwrite, SampleType::kUint16});
}

void write_float_layer(const std::string& path, const std::string& channel, int width, int height,
                       std::span<const float> values, bool overwrite) {
    write_exr_channel(path, channel, width, height, values, overwrite);
}

}  // namespace imgmesh

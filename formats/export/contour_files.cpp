#include "formats/export/contour_files.h"

#include <algorithm>
#include <cmath>

#include "formats/export/label_files.h"
#include "formats/export/mat_file.h"
#include "formats/export/npy.h"
#include "formats/files/extension.h"
#include "libcore/base/error.h"
#include "libcore/base/index.h"

namespace imgmesh {
namespace {

void write_ucm2(const std::string& path, std::size_t width, std::size_t height, std::span<const float> values,
                double half, bool overwrite) {
    const auto scaled = [&](std::size_t i) {
        const std::size_t x = std::clamp<std::size_t>(i % width, 1, width - 2);
        const std::size_t y = std::clamp<std::size_t>(i / width, 1, height - 2);
        const double h = double(values[y * width + x]);
        return static_cast<float>(std::isinf(h) ? 1 : h / (h + half));
    };
    const MatVariable variables[] = {
        {"ucm2", MatType::kSingle, height, width, false, by_columns<float>(width, height, scaled)},
        {"half_height", MatType::kDouble, 1, 1, false,
         by_columns<double>(1, 1, [&](std::size_t) { return half; })}};
    write_mat(path, variables, overwrite);
}

}  // namespace

bool can_write_contours(const std::string& path) {
    const std::string extension = lower_extension(path);
    return extension == ".exr" || extension == ".npy" || extension == ".mat";
}

void write_contours(const std::string& path, int width, int height, std::span<const float> values,
                    double half, bool overwrite) {
    if (!can_write_contours(path))
        throw Error(ErrorKind::kBadArgument, cat(path, ": contour maps are written as .exr, .npy or .mat"));
    const std::string extension = lower_extension(path);
    if (extension == ".exr")
        write_float_layer(path, "height", width, height, values, overwrite);
    else if (extension == ".npy")
        write_npy(path, {"", "f4", {as_index(height), as_index(width)}, bytes_of(values)}, overwrite);
    else
        write_ucm2(path, as_index(width), as_index(height), values, half, overwrite);
}

}  // namespace imgmesh

#include "tools/common/read_options.h"

#include <utility>

#include "libcore/base/error.h"
#include "tools/common/help.h"
#include "tools/common/names.h"
#include "tools/common/options.h"

namespace imgmesh {

void add_read_options(CLI::App& app, ReadImageOptions& options) {
    CLI::Option* const space = add_choice(app, "--color-space", options.color_space, color_space_choices(),
                                          {"Colour space of the images, whatever their files say", ""});
    advanced(app, in_group(space, "Image"));
    CLI::Option* const pixels =
        add_count(app, "--max-pixels", options.limits.max_pixels, {1}, "Refuse an image of more pixels");
    advanced(app, in_group(pixels, "Limits"));
}

Image read_with_warnings(const std::string& path, const ReadImageOptions& options,
                         std::vector<std::string>& warnings) {
    ReadImage read = read_image_file(path, options);
    for (const std::string& warning : read.warnings) warnings.push_back(cat(path, ": ", warning));
    return std::move(read.image);
}

}  // namespace imgmesh

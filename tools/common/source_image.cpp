#include "tools/common/source_image.h"

#include "libcore/base/error.h"
#include "tools/common/read_options.h"

namespace imgmesh {

Image read_source_image(const std::string& path, const SourceInfo& source, const std::string& container,
                        const ReadImageOptions& options, std::vector<std::string>& warnings) {
    Image image = read_with_warnings(path, options, warnings).image;
    if (image.width != source.width || image.height != source.height)
        throw Error(ErrorKind::kBadFile,
                    cat(path, ": has ", image.width, "x", image.height, " pixels, the image of ", container,
                        " has ", source.width, "x", source.height));
    return image;
}

}  // namespace imgmesh

#include "tools/common/source_image.h"

#include "formats/picture/image_io.h"
#include "libcore/base/error.h"

namespace imgmesh {

Image read_source_image(const std::string& path, const SourceInfo& source, const std::string& container) {
    Image image = read_image(path);
    if (image.width != source.width || image.height != source.height)
        throw Error(ErrorKind::kBadFile,
                    cat(path, ": has ", image.width, "x", image.height, " pixels, the image of ", container,
                        " has ", source.width, "x", source.height));
    return image;
}

}  // namespace imgmesh

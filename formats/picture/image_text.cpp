#include "formats/picture/image_text.h"

#include "formats/picture/oiio_module.h"

namespace imgmesh {

void draw_text(Image& image, const TextLabel& label) {
    oiio_module().draw_text(image, label);
}

}  // namespace imgmesh

#include "formats/picture/decode/nodata.h"

#include <algorithm>
#include <cmath>

namespace imgmesh {

Mask take_nodata_out(Image& image, double nodata, float scale) {
    const float value = static_cast<float>(nodata) / scale;  // as the samples were made
    const int alpha = image.channel("A");
    Mask mask(image, 1);
    bool any = false;
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        float* p = image.pixel(i);
        bool is_data = image.channels == 1 && alpha == 0;
        for (int c = 0; c < image.channels && !is_data; ++c)
            is_data = c != alpha && p[c] != value && !(std::isnan(value) && std::isnan(p[c]));
        if (is_data) continue;
        std::fill_n(p, image.channels, 0.0f);
        mask.values[i] = 0;
        any = true;
    }
    return any ? mask : Mask();
}

}  // namespace imgmesh

#include "libcore/image/image.h"

#include "libcore/base/error.h"
#include "libcore/base/parallel_vector.h"

namespace imgmesh {

int Image::channel(const std::string& name) const {
    for (std::size_t c = 0; c < channel_names.size(); ++c)
        if (channel_names[c] == name) return as_int(c);
    return -1;
}

Image make_image(int width, int height, int channels) {
    Image image;
    image.width = width;
    image.height = height;
    image.channels = channels;
    image.data = parallel_vector<float>(image.sample_count());
    switch (channels) {
        case 1:
            image.channel_names = {"Y"};
            break;
        case 2:
            image.channel_names = {"Y", "A"};
            break;
        case 3:
            image.channel_names = {"R", "G", "B"};
            break;
        case 4:
            image.channel_names = {"R", "G", "B", "A"};
            break;
        default:
            for (int c = 0; c < channels; ++c) image.channel_names.push_back(cat("C", c));
    }
    return image;
}

}  // namespace imgmesh

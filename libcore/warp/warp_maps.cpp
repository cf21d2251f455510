#include "libcore/warp/warp_maps.h"

namespace imgmesh {
namespace {

Image float_image(int width, int height, std::vector<std::string> channels) {
    Image image = make_image(width, height, as_int(channels.size()));
    image.channel_names = std::move(channels);
    image.sample_type = SampleType::kFloat;
    image.color_space = ColorSpace::kLinear;
    return image;
}

}  // namespace

Image forward_map_image(const DisplacementField& field) {
    Image image = float_image(field.width, field.height, {"displacement.x", "displacement.y"});
    float* out = image.data.data();
    for (std::size_t i = 0; i < field.move.size(); ++i) {
        *out++ = field.move[i].x();
        *out++ = field.move[i].y();
    }
    return image;
}

Image st_map_image(const InverseMap& map, int image_width, int image_height) {
    Image image = float_image(map.width, map.height, {"R", "G", "A"});
    float* out = image.data.data();
    for (std::size_t i = 0; i < map.source.size(); ++i, out += 3) {
        if (map.coverage[i] == 0) continue;
        out[0] = static_cast<float>((double(map.source[i].x()) + 0.5) / image_width);
        out[1] = static_cast<float>(1 - (double(map.source[i].y()) + 0.5) / image_height);
        out[2] = map.coverage[i];
    }
    return image;
}

}  // namespace imgmesh

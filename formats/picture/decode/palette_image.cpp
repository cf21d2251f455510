#include "formats/picture/decode/palette_image.h"

#include <algorithm>

#include "libcore/base/error.h"

namespace imgmesh {

Image image_from_palette(int width, int height, std::span<const std::uint16_t> indices,
                         std::span<const PaletteColor> palette, bool alpha,
                         std::vector<std::string>& warnings) {
    const bool grey =
        std::ranges::all_of(palette, [](const PaletteColor& c) { return c[0] == c[1] && c[1] == c[2]; });
    const std::size_t colors = grey ? 1 : 3, channels = colors + (alpha ? 1 : 0);
    Image image = make_image(width, height, static_cast<int>(channels));
    std::int64_t beyond = 0;
    constexpr PaletteColor kBlack = {0, 0, 0, 255};
    for (std::size_t i = 0; i < indices.size(); ++i) {
        const bool inside = indices[i] < palette.size();
        const PaletteColor& color = inside ? palette[indices[i]] : kBlack;
        beyond += inside ? 0 : 1;
        for (std::size_t c = 0; c < channels; ++c)
            image.data[i * channels + c] = static_cast<float>(color[c < colors ? c : 3]) / 255;
    }
    if (beyond > 0)
        warnings.push_back(cat("pixels with an index beyond the palette's ", palette.size(),
                               " colours, which are black: ", beyond));
    return image;
}

void drop_empty_alpha(Image& image, std::vector<std::string>& warnings) {
    const int alpha = image.channel("A");
    if (alpha < 0) return;
    const auto channels = static_cast<std::size_t>(image.channels), at = static_cast<std::size_t>(alpha);
    for (std::size_t i = at; i < image.data.size(); i += channels)
        if (image.data[i] != 0) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < image.data.size(); ++i)
        if (i % channels != at) image.data[kept++] = image.data[i];
    image.data.resize(kept);
    image.channel_names.erase(image.channel_names.begin() + alpha);
    --image.channels;
    warnings.push_back("its alpha is 0 in every pixel and was left out");
}

}  // namespace imgmesh

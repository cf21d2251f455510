#include "formats/picture/decode/keep_channels.h"

#include <algorithm>

namespace imgmesh {

void keep_channels(Image& image, const std::vector<char>& keep) {
    const auto kept =
        static_cast<std::size_t>(keep.size()) - static_cast<std::size_t>(std::ranges::count(keep, char{0}));
    if (kept == keep.size()) return;
    std::vector<std::string> names;
    for (std::size_t c = 0; c < keep.size(); ++c)
        if (keep[c]) names.push_back(image.channel_names[c]);
    // In place: the samples that stay move towards the start.
    std::size_t to = 0;
    for (std::size_t i = 0; i < image.data.size(); ++i)
        if (keep[i % keep.size()]) image.data[to++] = image.data[i];
    image.data.resize(to);
    image.channels = static_cast<int>(kept);
    image.channel_names = std::move(names);
}

}  // namespace imgmesh

#include "libcore/metrics/compare_channels.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/error.h"
#include "libcore/image/feature_space.h"

namespace imgmesh {
namespace {

bool is_hidden(const Image& image, int alpha, int x, int y) {
    return alpha >= 0 && image.pixel(x, y)[alpha] <= 0;
}

}  // namespace

std::vector<ChannelDifference> compare_channels(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height)
        throw Error(ErrorKind::kBadArgument,
                    cat("images differ in size: ", a.width, "x", a.height, " and ", b.width, "x", b.height));
    const int alpha_a = a.channel("A"), alpha_b = b.channel("A");
    const std::vector<std::string> of_b = split_names(b.channel_names).auxiliary;
    std::vector<ChannelDifference> out;
    for (const std::string& name : split_names(a.channel_names).auxiliary) {
        if (name == "A" || std::ranges::count(of_b, name) == 0) continue;
        const int in_a = a.channel(name), in_b = b.channel(name);
        ChannelDifference difference{name, 0, 0};
        std::int64_t pixels = 0;
        for (int y = 0; y < a.height; ++y)
            for (int x = 0; x < a.width; ++x) {
                if (is_hidden(a, alpha_a, x, y) || is_hidden(b, alpha_b, x, y)) continue;
                const double d = std::abs(double(a.pixel(x, y)[in_a]) - double(b.pixel(x, y)[in_b]));
                difference.rms += d * d;
                difference.max = std::max(difference.max, d);
                ++pixels;
            }
        if (pixels == 0) return {};
        difference.rms = std::sqrt(difference.rms / double(pixels));
        out.push_back(difference);
    }
    return out;
}

}  // namespace imgmesh

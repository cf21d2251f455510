#include "formats/picture/color/stated_color.h"

#include <cmath>

#include "formats/picture/color/icc_profile.h"
#include "libcore/image/color.h"

namespace imgmesh {

std::optional<ColorSpace> stated_color_space(const StatedColor& stated, Image& image) {
    if (!stated.icc.empty())
        if (const auto space = color_space_from_icc(stated.icc)) return space;
    if (stated.gamma > 0 && std::isfinite(stated.gamma)) {
        constexpr float kOurs = 2.2f, kTolerance = 0.05f;
        if (std::abs(stated.gamma - kOurs) <= kTolerance) return ColorSpace::kGamma22;
        if (std::abs(stated.gamma - 1) <= kTolerance) return ColorSpace::kLinear;
        const int alpha = image.channel("A");
        for (std::size_t i = 0; i < image.data.size(); ++i)
            if (alpha < 0 || i % static_cast<std::size_t>(image.channels) != static_cast<std::size_t>(alpha))
                image.data[i] = std::pow(image.data[i], stated.gamma / kOurs);
        return ColorSpace::kGamma22;
    }
    return parse_color_space(stated.name);
}

}  // namespace imgmesh

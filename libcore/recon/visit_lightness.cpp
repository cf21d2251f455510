#include "libcore/recon/visit_lightness.h"

#include <algorithm>

#include "libcore/base/error.h"

namespace imgmesh {

std::vector<float> visit_lightness(const MeshImage& mesh_image) {
    const std::vector<Id>& visits = mesh_image.visits;
    if (visits.empty()) throw Error(ErrorKind::kUnsupported, "the mesh image has no visit map");
    const PixelMap& map = mesh_image.levels.front().map;
    std::vector<Id> sorted;
    for (std::size_t i = 0; i < visits.size(); ++i)
        if (map[i].face != kNone) sorted.push_back(visits[i]);
    std::vector<float> lightness(visits.size(), 0.0f);
    if (sorted.empty()) return lightness;
    // A few pixels beside long thin triangles have several times the visits of most; others have hardly any.
    const auto percentile = [&](std::ptrdiff_t percent) {
        const auto at = std::ranges::next(sorted.begin(), (std::ssize(sorted) - 1) * percent / 100);
        std::nth_element(sorted.begin(), at, sorted.end());
        return static_cast<float>(*at);
    };
    const float least = percentile(2), most = percentile(98);
    for (std::size_t i = 0; i < visits.size(); ++i)
        if (map[i].face != kNone)
            lightness[i] =
                most > least
                    ? std::clamp(100 * (most - static_cast<float>(visits[i])) / (most - least), 0.0f, 100.0f)
                    : 100.0f;
    return lightness;
}

}  // namespace imgmesh

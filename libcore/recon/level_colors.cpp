#include "libcore/recon/level_colors.h"

#include <algorithm>

#include "libcore/base/error.h"
#include "libcore/image/feature_space.h"

namespace imgmesh {

const Level& checked_level(const MeshImage& mesh_image, int level_index) {
    if (level_index < 0 || level_index >= std::ssize(mesh_image.levels))
        throw Error(ErrorKind::kBadArgument,
                    cat("level is ", level_index, ", expected 0 to ", std::ssize(mesh_image.levels) - 1));
    return mesh_image.levels[as_index(level_index)];
}

const Level& level_to_draw(const MeshImage& mesh_image, int level_index) {
    const Level& level = checked_level(mesh_image, level_index);
    std::string names;
    for (const std::string& name : mesh_image.source.channel_names)
        names += (names.empty() ? "" : ", ") + name;
    if (level.mesh.channels < 3 || split_names(mesh_image.source.channel_names).color.empty())
        throw Error(ErrorKind::kUnsupported,
                    cat("the base mesh has no colour, its channels are ", names, "; an EXR holds them"));
    return level;
}

int alpha_feature(const SourceInfo& source) {
    const SplitNames names = split_names(source.channel_names);
    const auto alpha = std::ranges::find(names.auxiliary, "A");
    if (names.color.empty() || alpha == names.auxiliary.end()) return -1;
    return 3 + as_int(static_cast<std::size_t>(alpha - names.auxiliary.begin()));
}

std::vector<Vec3f> face_means(const BaseMesh& mesh) {
    std::vector<Vec3f> means;
    means.reserve(mesh.faces.size());
    for (const auto& [a, b, c] : mesh.faces) {
        const auto feature = [&](Id v) { return Eigen::Map<const Vec3f>(mesh.feature_of(v)); };
        means.push_back((feature(a) + feature(b) + feature(c)) / 3);
    }
    return means;
}

Image drawing_canvas(const SourceInfo& source, int width, int height, bool clear) {
    Image image = make_image(width, height, clear ? 4 : 3);
    image.color_space = source.gamut == Gamut::kHdr ? ColorSpace::kLinear : source.color_space;
    image.sample_type = source.sample_type;
    return image;
}

}  // namespace imgmesh

#include "libcore/recon/level_colors.h"

#include "libcore/base/error.h"

namespace imgmesh {

const Level& level_to_draw(const MeshImage& mesh_image, int level_index) {
    if (level_index < 0 || static_cast<std::size_t>(level_index) >= mesh_image.levels.size())
        throw Error(ErrorCode::kUsage, cat("level is ", level_index, ", expected 0 to ",
                                           static_cast<int>(mesh_image.levels.size()) - 1));
    const Level& level = mesh_image.levels[static_cast<std::size_t>(level_index)];
    if (level.mesh.channels < 3)
        throw Error(ErrorCode::kUnsupported, cat("the base mesh has ", level.mesh.channels,
                                                 " channels, expected colour as L*, u*, v*"));
    return level;
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

}  // namespace imgmesh

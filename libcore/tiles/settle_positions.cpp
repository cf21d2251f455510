#include "libcore/tiles/settle_positions.h"

#include <algorithm>

#include "libcore/mesh/fan_chain.h"
#include "libcore/mesh/round_positions.h"
#include "libcore/mesh/triangulate.h"

namespace imgmesh {
namespace {

bool is_round(const Vec2f& place) {
    return snapped(place.x()) == place.x() && snapped(place.y()) == place.y();
}

// Few vertices are asked for, so nothing is kept up to date that would answer faster.
std::vector<Id> faces_at(const BaseMesh& mesh, Id v) {
    std::vector<Id> faces;
    for (Id f = 0; f < mesh.faces.size(); ++f)
        if (std::ranges::find(mesh.faces[f], v) != mesh.faces[f].end()) faces.push_back(f);
    return faces;
}

// Replaces the faces around v by others of its neighbours alone. Returns false for a vertex of the boundary.
bool cut_out(BaseMesh& mesh, Id v) {
    const std::vector<Id> faces = faces_at(mesh, v);
    const std::vector<Id> around = fan_chain(mesh, v, faces);
    if (around.size() != faces.size()) return false;
    Loop loop;
    for (const Id n : around) loop.push_back(mesh.position[n].cast<double>());
    const BaseMesh filled = triangulated({loop});
    for (std::size_t n = 0; n < faces.size(); ++n) {
        Face& face = mesh.faces[faces[n]];
        if (n >= filled.faces.size()) {
            face.fill(kNone);
            continue;
        }
        for (std::size_t k = 0; k < 3; ++k) face[k] = around[filled.faces[n][k]];
    }
    std::erase_if(mesh.faces, [](const Face& f) { return f[0] == kNone; });
    return true;
}

void drop(BaseMesh& mesh, const std::vector<bool>& gone) {
    std::vector<Id> number(gone.size());
    const auto channels = static_cast<std::size_t>(mesh.channels);
    Id count = 0;
    for (Id v = 0; v < gone.size(); ++v) {
        if (gone[v]) continue;
        mesh.position[count] = mesh.position[v];
        std::copy_n(mesh.feature.data() + v * channels, channels, mesh.feature.data() + count * channels);
        number[v] = count++;
    }
    mesh.position.resize(count);
    mesh.feature.resize(count * channels);
    for (Face& face : mesh.faces)
        for (Id& v : face) v = number[v];
}

}  // namespace

void settle_positions(BaseMesh& mesh) {
    while (round_positions(mesh, kPositionStep) > 0) {
        std::vector<bool> gone(mesh.vertex_count(), false);
        bool some = false;
        for (Id v = 0; v < gone.size(); ++v)
            if (!is_round(mesh.position[v]) && cut_out(mesh, v)) some = gone[v] = true;
        if (!some) return;
        drop(mesh, gone);
    }
}

}  // namespace imgmesh

#include "libcore/coding/grid_state.h"

#include <algorithm>

namespace imgmesh {
namespace {

// The bits of a number, each followed by a zero.
std::uint64_t spread_bits(std::uint64_t n) {
    n = (n | n << 16) & 0x0000FFFF0000FFFFu;
    n = (n | n << 8) & 0x00FF00FF00FF00FFu;
    n = (n | n << 4) & 0x0F0F0F0F0F0F0F0Fu;
    n = (n | n << 2) & 0x3333333333333333u;
    return (n | n << 1) & 0x5555555555555555u;
}
// The place along a Z-shaped curve that fills the plane.
std::uint64_t along_curve(const Place& place) {
    return spread_bits(static_cast<std::uint32_t>(place.x)) | spread_bits(static_cast<std::uint32_t>(place.y))
                                                                  << 1;
}

}  // namespace

GridState::GridState(const RowSums& sums, const CodedMesh& mesh)
    : sums_(&sums),
      grid_(mesh.grid),
      mesh_(mesh.faces, mesh.point.size()),
      vertex_(mesh.point.size()),
      spot_(mesh.point.size()),
      error_(mesh.faces.size()) {
    for (std::size_t v = 0; v < vertex_.size(); ++v) {
        vertex_[v].column = mesh.point[v][0];
        vertex_[v].row = mesh.point[v][1];
        spot_[v].place = place(vertex_[v].column, vertex_[v].row);
        for (std::size_t c = 0; c < as_index(mesh.channels) && !mesh.color.empty(); ++c)
            spot_[v].color[c] = mesh.color[v * as_index(mesh.channels) + c];
    }
    for (Id f = 0; f < error_.size(); ++f) error_[f] = face_error(mesh_.face(f));
}

double GridState::face_error(const Face& face) const {
    const auto [a, b, c] = face;
    const FaceFit fit = face_fit(*sums_, spot_[a].place, spot_[b].place, spot_[c].place);
    return fit.error(spot_[a].color, spot_[b].color, spot_[c].color);
}

double GridState::squared_error() const {
    double sum = 0;
    for (Id f = 0; f < error_.size(); ++f)
        if (mesh_.live_face(f)) sum += error_[f];
    return sum;
}

CodedMesh GridState::result() const {
    CodedMesh out{grid_, sums_->channels(), {}, {}, {}};
    std::vector<Id> id(mesh_.vertices(), kNone);
    for (Id v = 0; v < mesh_.vertices(); ++v) {
        if (!mesh_.live_vertex(v)) continue;
        id[v] = as_id(out.point.size());
        out.point.push_back({vertex_[v].column, vertex_[v].row});
        for (std::size_t c = 0; c < as_index(out.channels); ++c)
            out.color.push_back(static_cast<float>(spot_[v].color[c]));
    }
    for (Id f = 0; f < error_.size(); ++f)
        if (const auto [a, b, c] = mesh_.face(f); mesh_.live_face(f))
            out.faces.push_back({id[a], id[b], id[c]});
    return out;
}

void GridState::reorder() {
    std::vector<std::pair<std::uint64_t, Id>> order;
    for (Id v = 0; v < mesh_.vertices(); ++v)
        if (mesh_.live_vertex(v)) order.emplace_back(along_curve(spot_[v].place), v);
    std::sort(order.begin(), order.end());
    std::vector<Id> id(mesh_.vertices(), kNone);
    std::vector<Vertex> vertices;
    std::vector<Spot> spots;
    for (const auto& [curve, v] : order) {
        id[v] = as_id(vertices.size());
        vertices.push_back(vertex_[v]);
        spots.push_back(spot_[v]);
        vertices.back().removal_holds = false;
    }
    std::vector<std::pair<Face, double>> faces;
    for (Id f = 0; f < error_.size(); ++f) {
        if (!mesh_.live_face(f)) continue;
        Face face = mesh_.face(f);
        for (Id& v : face) v = id[v];
        // The lowest corner first: so faces have one order.
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
        faces.emplace_back(face, error_[f]);
    }
    std::sort(faces.begin(), faces.end());
    std::vector<Face> corners;
    error_.clear();
    for (const auto& [face, error] : faces) {
        corners.push_back(face);
        error_.push_back(error);
    }
    vertex_ = std::move(vertices);
    spot_ = std::move(spots);
    mesh_ = EditMesh(std::move(corners), vertex_.size());
}

void GridState::fit_colors(int passes) {
    std::vector<FaceFit> fits(error_.size());
    // The faces of each vertex, one after the other: `first` is where its own begin.
    std::vector<Id> first(mesh_.vertices() + 1, 0), corners;
    for (Id f = 0; f < error_.size(); ++f) {
        if (!mesh_.live_face(f)) continue;
        const auto [a, b, c] = mesh_.face(f);
        fits[f] = face_fit(*sums_, spot_[a].place, spot_[b].place, spot_[c].place);
        for (const Id v : mesh_.face(f)) ++first[v + 1];
    }
    for (std::size_t v = 0; v < mesh_.vertices(); ++v) first[v + 1] += first[v];
    corners.resize(first.back());
    std::vector<Id> next(first.begin(), first.end() - 1);
    for (Id f = 0; f < error_.size(); ++f)
        for (std::size_t i = 0; i < 3 && mesh_.live_face(f); ++i)
            corners[next[mesh_.face(f)[i]]++] = 3 * f + static_cast<Id>(i);
    for (int pass = 0; pass < passes; ++pass)
        for (std::size_t v = 0; v < mesh_.vertices(); ++v) {
            if (first[v] == first[v + 1]) continue;
            double weight = kColorPull;
            Double4 rhs = kColorPull * spot_[v].color;
            for (Id k = first[v]; k < first[v + 1]; ++k) {
                const FaceFit& fit = fits[corners[k] / 3];
                const Face& face = mesh_.face(corners[k] / 3);
                const std::size_t i = corners[k] % 3, j = (i + 1) % 3, m = (i + 2) % 3;
                weight += fit.gram[i][i];
                rhs += fit.rhs[i] - fit.gram[i][j] * spot_[face[j]].color -
                       fit.gram[i][m] * spot_[face[m]].color;
            }
            spot_[v].color = rhs / weight;
        }
    for (Id f = 0; f < error_.size(); ++f)
        if (const auto [a, b, c] = mesh_.face(f); mesh_.live_face(f))
            error_[f] = fits[f].error(spot_[a].color, spot_[b].color, spot_[c].color);
    for (Vertex& v : vertex_) v.removal_holds = false;
}

bool GridState::on_side(Id v, bool column) const {
    if (column) return vertex_[v].column == 0 || vertex_[v].column == grid_.columns() - 1;
    return vertex_[v].row == 0 || vertex_[v].row == grid_.rows() - 1;
}

void GridState::changed(Id f) {
    for (const Id v : mesh_.face(f))
        if (v != kNone) vertex_[v].removal_holds = false;
}

}  // namespace imgmesh

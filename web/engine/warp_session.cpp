#include "web/engine/warp_session.h"

#include "formats/container/edit_file.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/warp/cover.h"
#include "libcore/warp/warp_mesh.h"

namespace imgmesh::web {
namespace {

// As imgmesh-warp writes it into its containers.
constexpr char kGenerator[] = "imgmesh-warp " IMGMESH_VERSION;

std::vector<float> flat(const std::vector<Vec2f>& points) {
    std::vector<float> numbers;
    numbers.reserve(2 * points.size());
    for (const Vec2f& p : points) numbers.insert(numbers.end(), {p.x(), p.y()});
    return numbers;
}

}  // namespace

void WarpSession::solve(const std::string& edits, bool drag) {
    const WarpEdits parsed = edits_from_json(edits, "edits");
    solution_ = drag ? live_.follow(parsed) : live_.solve(parsed);
}

std::vector<float> WarpSession::moves(int level) const {
    mesh_->level(level);
    return flat(solution_.moves[as_index(level)]);
}

const std::vector<Vec2f>& WarpSession::from_others(std::size_t level) {
    FromOthers& known = from_others_[level];
    std::vector<VertexMoves> others = solution_.moves;
    others[level].clear();
    const std::vector<Vec2f>& rest = mesh_image().levels[level].mesh.position;
    if (known.moves == others && known.sum.size() == rest.size()) return known.sum;
    std::vector<Vec2f> sum(rest.size(), Vec2f(0, 0));
    for (std::size_t k = 0; k < others.size(); ++k)
        if (!others[k].empty()) add_moves_at(mesh_image().levels[k], others[k], rest, sum);
    known = {std::move(others), std::move(sum)};
    return known.sum;
}

std::vector<Vec2f> WarpSession::level_places(int level) {
    const BaseMesh& mesh = mesh_->level(level).mesh;
    const std::vector<Vec2f>& others = from_others(as_index(level));
    std::vector<Vec2f> places = mesh.position;
    for (std::size_t v = 0; v < places.size(); ++v) places[v] += others[v];
    if (solution_.moves[as_index(level)].empty()) return places;
    for (std::size_t v = 0; v < places.size(); ++v) places[v] += solution_.moves[as_index(level)][v];
    return places;
}

std::vector<float> WarpSession::places(int level) {
    return flat(level_places(level));
}

std::vector<std::uint32_t> WarpSession::turned_faces(int level) {
    std::vector<Vec2f> places = level_places(level);
    for (Vec2f& p : places) p = {snapped(p.x()), snapped(p.y())};
    std::vector<std::uint32_t> turned;
    const std::vector<Face>& faces = mesh_->level(level).mesh.faces;
    for (Id f = 0; f < faces.size(); ++f)
        if (!(signed_area2(places[faces[f][0]], places[faces[f][1]], places[faces[f][2]]) > 0))
            turned.push_back(f);
    return turned;
}

DisplacementField WarpSession::field() const {
    return edit_field(mesh_image(), solution_);
}

MeshPointer WarpSession::warped_mesh() const {
    const auto warped =
        std::make_shared<MeshValue>(MeshValue{warp_mesh_image(mesh_image(), solution_.moves)});
    warped->mesh_image.generator = kGenerator;
    warped->texture = mesh_->texture;  // moves along: vertices keep their texture coordinates
    warped->metadata = mesh_->metadata;
    warped->draco = mesh_->draco;
    return warped;  // with an EXR: on the moved mesh pixels lie on no grid
}

}  // namespace imgmesh::web

// The class WarpSession of JavaScript: edits of one mesh, solved again and again while a hand drags.
#pragma once

#include <emscripten/val.h>

#include <string>
#include <vector>

#include "libcore/warp/displacement.h"
#include "libcore/warp/live_edits.h"
#include "libcore/warp/solve_edits.h"
#include "web/engine/mesh_value.h"

namespace imgmesh::web {

/// Holds what edits do to a mesh: the moves of all vertices, and what follows from them. Levels, vertices and
/// faces are numbered as in the mesh.
class WarpSession {
  public:
    explicit WarpSession(MeshPointer mesh)
        : mesh_(std::move(mesh)), live_(mesh_->mesh_image), from_others_(mesh_->mesh_image.levels.size()) {
        solution_.moves.resize(from_others_.size());
        solution_.injective.resize(from_others_.size());
    }

    /// Solves the edits, a text as imgmesh-warp --edits reads it; during a drag with LiveEdits::follow().
    /// Throws as edits_from_json() and edit_solution() do; then the moves are as before.
    void solve(const std::string& edits, bool drag);
    /// A line for each level where a handle is not where it should be.
    std::vector<std::string> missed() const { return missed_places(solution_); }

    /// Returns how far each vertex of a level moves by the level's own edits, x and y; empty if none moves.
    std::vector<float> moves(int level) const;
    /// Returns where each vertex of a level is in the warped image: moved by its own level's edits and by
    /// what the other levels' meshes do there. Costs O(pixels) after another level has changed.
    std::vector<float> places(int level);
    /// Returns the faces of a level that turn over or lose their area, for which no container is written.
    std::vector<std::uint32_t> turned_faces(int level);

    /// How far each pixel moves. Costs O(pixels).
    DisplacementField field() const;
    /// Returns the mesh with its vertices moved. Throws as warp_mesh_image() does.
    MeshPointer warped_mesh() const;
    const MeshImage& mesh_image() const { return mesh_->mesh_image; }

  private:
    // What the meshes of other levels do at a level's vertices, and the moves for which that holds.
    struct FromOthers {
        std::vector<VertexMoves> moves;
        std::vector<Vec2f> sum;
    };
    const std::vector<Vec2f>& from_others(std::size_t level);
    std::vector<Vec2f> level_places(int level);

    MeshPointer mesh_;
    LiveEdits live_;
    EditSolution solution_;
    std::vector<FromOthers> from_others_;
};

}  // namespace imgmesh::web

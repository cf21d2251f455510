// A base mesh whose vertices and edges change one at a time.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// The faces around a vertex in order, counter-clockwise on screen.
struct Star {
    static constexpr int kMost = 24;  ///< faces; a vertex with more is left alone
    std::array<Id, kMost> face;
    std::array<std::uint8_t, kMost> corner;  ///< which corner of the face the vertex is
    int size = 0;
    bool closed = false;  ///< the vertex is inside the mesh
};

/// An editable triangle mesh with neighbours. Vertices and faces that are removed stay as holes until
/// compact().
class RefineMesh {
  public:
    /// Coordinates that a vertex keeps, as bits.
    static constexpr std::uint8_t kFree = 0, kFixedX = 1, kFixedY = 2, kFixed = 3;

    /// `mesh` has three channels and faces of positive area. Vertices of its boundary may slide along where
    /// the boundary runs straight on along one side of its bounding box; all others of the boundary are
    /// fixed.
    explicit RefineMesh(const BaseMesh& mesh);
    BaseMesh compact() const;

    std::vector<Vec2f> position;
    std::vector<Vec3f> color;
    std::vector<std::uint8_t> fixed;
    std::vector<Face> faces;   ///< faces[f][0] == kNone: a hole
    std::vector<Face> across;  ///< the face across the edge opposite each corner, or kNone

    bool live_vertex(Id v) const { return face_of_[v] != kNone; }
    bool live_face(Id f) const { return faces[f][0] != kNone; }
    std::size_t vertex_count() const { return live_vertices_; }

    /// False where there are more than Star::kMost faces or the vertex is removed. Of a vertex with several
    /// fans one fan alone.
    bool star(Id v, Star& out) const;

    /// The edge opposite corner i of face f becomes the other diagonal of the quad; the two faces keep their
    /// numbers: f = (p, a, q), across = (q, b, p), where f was (p, a, b). The quad must be convex.
    void flip(Id f, int i);
    /// A vertex inside face f; the new faces' numbers are not the old one's.
    Id split_face(Id f, const Vec2f& p, const Vec3f& c);
    /// A vertex on the edge opposite corner i of f, on the border too.
    Id split_edge(Id f, int i, const Vec2f& p, const Vec3f& c);
    /// Vertex v, with its star, goes into its neighbour u. The caller has checked that the faces stay
    /// positive.
    void collapse(const Star& star, Id v, Id u);

  private:
    int corner_towards(Id f, Id other) const;  // corner of f whose edge `other` lies across
    void link(Id f, int i, Id g);              // both ways; g finds its own side by vertices
    Id new_face(const Face& face);
    Id new_vertex(const Vec2f& p, const Vec3f& c, std::uint8_t fixed_axes);

    std::vector<Id> face_of_;  // one face of each vertex, kNone where it is removed
    std::vector<Id> free_faces_, free_vertices_;
    std::size_t live_vertices_ = 0;
};

}  // namespace imgmesh

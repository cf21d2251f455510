// The connectivity of a mesh whose edges flip, split and collapse one at a time, with ids that stay.
//
// Every vertex has a list of its faces, linked through the faces' corners: 52 bytes a vertex in all. An
// operator moves faces from one list to another.
#pragma once

#include <vector>

#include "libcore/mesh/one_ring.h"

namespace imgmesh {

/// Returns the corner of the face that the vertex is; it must be one.
inline std::size_t corner_of(const Face& face, Id v) {
    return face[0] == v ? 0 : face[1] == v ? 1 : 2;
}

/// Faces are counter-clockwise on screen. No two faces have the same directed edge, and the faces of a vertex
/// form one fan. Removed faces and vertices leave holes. Later ones take the ids of the holes, last hole
/// first.
///
/// The ring of an inner vertex begins with the first face of its list: at the start the lowest id, later as
/// the operators and begin_ring() say. Sums over rings get other last bits if they begin elsewhere.
class EditMesh {
  public:
    EditMesh(std::vector<Face> faces, std::size_t vertices);

    /// Corners of all faces by id; those of a hole are kNone.
    const std::vector<Face>& faces() const { return faces_; }
    const Face& face(Id f) const { return faces_[f]; }
    std::size_t vertices() const { return first_.size(); }  ///< includes holes and vertices without a face
    std::size_t live_vertices() const { return live_vertices_; }
    bool live_face(Id f) const { return faces_[f][0] != kNone; }
    bool live_vertex(Id v) const { return first_[v] != kNone; }

    /// Returns the face across the edge opposite corner i of f, or kNone on the border.
    Id across(Id f, std::size_t i) const;
    /// Returns the corner of f that is not on its edge to the face g.
    Id apex(Id f, Id g) const;
    /// Returns the face with the corners a, b, c in this cyclic order, or kNone.
    Id find_face(Id a, Id b, Id c) const;
    /// Returns false if the vertex has no face, or more than OneRing::kMaxFaces. An open ring begins at the
    /// border. If a vertex has several fans, it is the one with its first face.
    bool ring(Id v, OneRing& out) const;
    /// From now on the ring of v, if it is closed, begins with its face f.
    void begin_ring(Id v, Id f);

    /// Returns whether the edge opposite corner i of f has two faces, their other diagonal is not an edge
    /// yet, and its ends will have at most OneRing::kMaxFaces.
    bool may_flip(Id f, std::size_t i) const;
    /// Turns the edge into the other diagonal of its two faces: f = (p, a, b) becomes (p, a, q), and across
    /// it g = (q, b, a) becomes (q, b, p). The rings of p, a, q begin with f, that of b with g.
    void flip(Id f, std::size_t i);

    /// Adds a vertex inside face f = (a, b, c), which becomes (v, a, b), with two new faces (v, b, c), (v, c,
    /// a). The rings of v, a, b begin with f, that of c with (v, b, c).
    Id split_face(Id f);
    /// Adds a vertex on the edge opposite corner i of f = (o, a, b), which becomes (v, o, a) beside a new
    /// face (v, b, o). Across an inner edge (q, b, a) becomes (v, q, b) beside a new face (v, a, q). The
    /// rings of v, o, a begin with f, that of b with (v, b, o), that of q with (v, q, b).
    Id split_edge(Id f, std::size_t i);

    /// Returns whether two vertices with a ring may merge: they share an edge and no neighbours except the
    /// corners of the faces at that edge (link condition), an inner edge has an inner end, and the merged
    /// vertex has faces around it, at most OneRing::kMaxFaces.
    bool may_collapse(const OneRing& removed, Id kept) const;
    /// Moves the faces of a vertex, given its ring, to its neighbour `kept`; those at the edge are removed.
    /// They follow the faces that `kept` has, in the order of their list.
    void collapse(const OneRing& removed, Id kept);

  private:
    Id next(Id f, Id v) const { return next_[f][corner_of(faces_[f], v)]; }
    Id& link_to(Id f, Id v);  // the link to f in the list of v; f kNone: the end of the list
    void attach(Id f);        // as the first face of its corners
    void detach(Id f);        // from the lists of its corners
    Id add_face(const Face& face);
    Id add_vertex();

    std::vector<Face> faces_;
    std::vector<Face> next_;  // for each corner the next face in the list of its vertex
    std::vector<Id> first_;   // of the list of each vertex
    Id last_hole_ = kNone;    // of a list of faces, by their next_[f][0]
    std::vector<Id> free_vertices_;
    std::size_t live_vertices_ = 0;
};

}  // namespace imgmesh

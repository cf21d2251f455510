// A triangulation of points in a rectangle whose faces change in place: Delaunay at first, then under edges
// that are fixed one by one. Positions are whole numbers, so every test is exact on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "libcore/base/index.h"
#include "libcore/optimize/place.h"

namespace imgmesh::coding {

/// Returns whether d lies inside the circle through a, b, c, which run counter-clockwise on screen.
bool inside_circle(const Place& a, const Place& b, const Place& c, const Place& d);

/// One face: its corners, counter-clockwise on screen, and the face across the edge opposite each corner.
struct LinkedFace {
    std::array<Id, 3> corner;
    std::array<Id, 3> across;  ///< kNone at the border
    bool known = false;        ///< stays as it is
};

class Triangulation {
  public:
    /// Makes the Delaunay triangulation. places: distinct, inside a rectangle whose corners are among them.
    /// order: all vertices; near ones should follow each other. Takes O(n) time then, up to O(n^2) otherwise.
    Triangulation(std::span<const Place> places, std::span<const Id> order);

    const LinkedFace& face(Id f) const { return faces_[f]; }
    std::size_t face_count() const { return faces_.size(); }
    Place place(Id v) const { return places_[v]; }
    /// Returns the face on the left of the directed edge from a to b, or kNone if there is none.
    Id face_at(Id a, Id b) const;
    /// Returns which corner of the face is opposite its edge that starts at vertex a.
    std::size_t opposite(Id f, Id a) const;

    /// Returns which corner of f is opposite its edge to the face g.
    std::size_t corner_facing(Id f, Id g) const;

    /// Makes (a, b, c) a known face, where (a, b) is an edge of strip[0] and c the apex of strip.back(). Each
    /// face of the strip lies across an edge of the one before that separates c from (a, b). What else the
    /// strip covers is triangulated by Delaunay's rule again.
    void fix_face(Id a, Id b, Id c, std::span<const Id> strip);

  private:
    void insert(Id v, Id& near);
    void legalise(Id v, std::vector<std::pair<Id, std::size_t>>& edges);
    void set_across(Id f, Id g, Id from, Id to);  // f is across the edge of g that is from -> to, seen from g
    void fill(std::span<const Id> chain, Id from, Id to, std::vector<Face>& out) const;

    std::span<const Place> places_;
    std::vector<LinkedFace> faces_;
    std::vector<Id> face_of_;  // of each vertex one face
    // Reused by fix_face().
    struct Side {
        Id from, to, face;
    };
    std::vector<Side> sides_;
    std::vector<Id> left_, right_;
    std::vector<Face> filled_;
};

}  // namespace imgmesh::coding

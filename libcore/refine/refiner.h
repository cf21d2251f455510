// The state of a refinement, and its steps.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "libcore/mesh/touched_faces.h"
#include "libcore/refine/pixel_sums.h"
#include "libcore/refine/refine.h"
#include "libcore/refine/refine_vertices.h"
#include "libcore/refine/vertex_tiles.h"

namespace imgmesh {

/// Source and steps: refine.cpp. Every step keeps the sums of each face up to date.
class Refiner {
  public:
    Refiner(const BaseMesh& mesh, const ImagePlanes& image, const RefineParams& params);

    double total_error() const;
    BaseMesh result() const { return compact(mesh_, vertex_); }

    void fit_colors();
    std::int64_t move_vertices();
    std::int64_t flip_edges();
    struct Rewired {
        std::int64_t flips = 0, relocations = 0;
    };
    /// Flips edges, then relocates vertices where no edge has flipped: the pixels are read once for both.
    Rewired flip_and_relocate();

  private:
    // The cost of some faces: squared error, and the summed and the worst shape.
    struct Cost {
        double error = 0;   // summed squared error
        double shape = 0;   // sum of 1/q - 1
        double worst = 1;   // largest 1/q
        bool legal = true;  // whether every area is positive and there is no sliver
    };
    // Vertex v at some position, with its best colour there.
    struct Placement {
        Vec2f position;
        Vec3f color;
        Cost cost;
        std::array<FaceSums, OneRing::kMaxFaces> sums;
        std::array<double, OneRing::kMaxFaces> inverse_q;
    };
    // What a new vertex would do in the middle of a face and on its edges. Where an edge may flip, its vertex
    // is at the other diagonal.
    struct FaceTrial {
        std::array<Id, 3> across = {kNone, kNone, kNone};  // the face across the edge opposite each corner
        std::array<float, 3> at = {0.5f, 0.5f, 0.5f};      // see face_hats()
        std::array<std::uint8_t, 3> may_flip = {};
        FaceHats hats;  // at edges, those of both faces in the face of the lower number
    };

    // refiner.cpp
    Corner corner(Id v) const { return {vertex_.position[v], vertex_.color[v]}; }
    Vec3f allowed(const Vec3f& color) const;
    float snapped(float x) const { return std::round(x / params_.position_step) * params_.position_step; }
    bool better(const Cost& now, const Cost& before) const;
    // Adds a triangle, and returns its 1/q.
    double add_shape(Cost& cost, const Vec2f& a, const Vec2f& b, const Vec2f& c) const;
    void add_face(Cost& cost, Id f) const;
    bool too_thin(const Cost& now, const Cost& before) const;
    Cost cost_of(const OneRing& ring) const;
    FaceSums sums_of(const Face& face) const;
    void measure(Id f);  // its sums and its shape
    void measure_changed();
    double face_error(const Face& face) const;
    const VertexTiles& tiles();
    void changed(Id f);  // it is measured later, by all threads
    void changed(const OneRing& ring);

    // moves.cpp
    // Costs the ring with v at `position`, without and with its best colour. Returns false if that is not
    // legal.
    bool place(const OneRing& ring, const Vec2f& position, const Vec3f& color, const Cost& before,
               Placement& out) const;
    Vec2f newton_step(const OneRing& ring, Id v) const;
    bool move_vertex(Id v);
    void set(const OneRing& ring, Id v, const Placement& placement);

    // flips.cpp
    std::vector<FaceTrial> trials() const;
    void divide_edge(Id f, std::size_t i, std::vector<FaceTrial>& trials) const;
    // The shapes of the two faces with the other diagonal instead of the edge opposite corner i of f.
    Cost flip_shapes(Id f, std::size_t i, Id g) const;
    bool flip_seems_better(const std::vector<FaceTrial>& trials, Id f, std::size_t i) const;
    struct Edge {
        Id face;
        std::size_t corner;  // opposite the edge
        auto operator<=>(const Edge&) const = default;
    };
    bool flip_is_better(const Edge& edge) const;
    std::vector<Id> flip(const std::vector<Edge>& edges);
    // Tries the edges of some faces, and those of the faces that change by it; returns both faces of each
    // flip.
    std::vector<Id> flip_near(std::vector<Id> faces);
    std::int64_t flip_edges(const std::vector<FaceTrial>& trials, TouchedFaces& touched);

    // insertions.cpp
    struct Insertion {
        Id face;
        int edge;  // on the edge opposite this corner, or -1 for the inside
        Vec2f position;
        Vec3f color;
        double gain;
        bool border;  // whether it is on an edge of one face
    };
    std::vector<Insertion> insertions(const std::vector<FaceTrial>& trials,
                                      const TouchedFaces& touched) const;
    Insertion best_insertion(const std::vector<FaceTrial>& trials, const TouchedFaces& touched, Id f) const;
    void try_insertion(Id f, int edge, const FaceTrial& trial, const HatSums& hat, Insertion& best) const;
    Id across(const Insertion& insertion) const;  // the other face that it divides, or kNone
    Id insert(const Insertion& insertion);

    // removals.cpp
    struct Removal {
        Id v, into;
        double cost;
        bool border;  // v is one of a side
    };
    // The best removal of each of `some` vertices that seem to cost least, in order of cost.
    std::vector<Removal> removals(std::size_t some) const;
    bool may_become(const OneRing& ring, std::size_t n) const;
    void add_fan(Cost& cost, const OneRing& ring, Id u) const;
    // A neighbour and what it seems to cost in error, in any order; returns how many.
    using Estimates = std::array<std::pair<double, Id>, OneRing::kMaxFaces + 1>;
    std::size_t estimate(const OneRing& ring, Estimates& out) const;
    double estimated_removal(Id v) const;
    Removal best_removal(Id v) const;
    void remove(const Removal& removal);

    // relocate.cpp
    // Moves vertices without a common face.
    void move(const std::vector<Id>& vertices);
    std::vector<Id> faces_around(const std::vector<Id>& vertices) const;
    void relocate(std::size_t most, const std::vector<Removal>& removals,
                  const std::vector<Insertion>& insertions, bool border, TouchedFaces& touched,
                  std::vector<Id>& fresh);

    const ImagePlanes& image_;
    RefineParams params_;
    EditMesh mesh_;
    RefineVertices vertex_;
    std::vector<FaceSums> sums_;        // of each face
    std::vector<double> inverse_q_;     // of each face, 1/q
    std::vector<Id> unmeasured_;        // perhaps removed, or several times the same
    std::optional<VertexTiles> tiles_;  // of the present faces
    double shape_unit_ = 0;             // the squared error that weighs as much as a shape cost of 1
};

}  // namespace imgmesh

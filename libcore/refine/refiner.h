// The state of a refinement, and its steps.
#pragma once

#include <cmath>
#include <vector>

#include "libcore/mesh/touched_faces.h"
#include "libcore/refine/pixel_sums.h"
#include "libcore/refine/refine.h"
#include "libcore/refine/refine_vertices.h"

namespace imgmesh {

/// Source and steps: refine.cpp. Every step keeps `error` of each face up to date.
class Refiner {
  public:
    Refiner(const BaseMesh& mesh, const ImagePlanes& image, const RefineParams& params);

    double total_error() const;
    BaseMesh result() const { return compact(mesh_, vertex_); }

    void fit_colors();
    std::int64_t move_vertices();
    std::int64_t flip_edges();
    std::int64_t relocate();
    /// Adds vertices where they gain most, runs all steps, removes as many where they cost least, and runs
    /// all steps again. All of it is undone unless the error has fallen.
    bool exchange(double share);
    /// Exchanges vertices inside the mesh: at most `most`, none next to another. Returns how many.
    std::int64_t insert_best(std::int64_t most);
    std::int64_t remove_cheapest(std::int64_t most);

    struct Removal {
        Id v, into;
        double cost;
        bool border;  ///< v is one of a side
        bool operator==(const Removal&) const = default;
    };
    /// Finds the best removal of each vertex that can be removed, in order of cost. Results are remembered
    /// while nothing near them has changed, until forget().
    std::vector<Removal> removals();
    void forget();

  private:
    // The cost of a ring or a pair of faces: squared error, and the worst and the summed shape.
    struct Cost {
        double error = 0;    // summed squared error
        double shape = 0;    // sum of 1/q - 1
        double least_q = 1;  // least q
        bool legal = true;   // whether every area is positive and there is no sliver
    };
    // Vertex v at some position, with its best colour there.
    struct Placement {
        Vec2f position;
        Vec3f color;
        Cost cost;
        std::array<double, OneRing::kMaxFaces> face_error;
    };

    Corner corner(Id v) const { return {vertex_.position[v], vertex_.color[v]}; }
    Vec3f allowed(const Vec3f& color) const;
    float snapped(float x) const { return std::round(x / params_.position_step) * params_.position_step; }
    bool better(const Cost& now, const Cost& before) const;
    void add_shape(Cost& cost, const Vec2f& a, const Vec2f& b, const Vec2f& c) const;
    Cost cost_of(const OneRing& ring) const;
    // Costs the ring with v at `position`, without and with its best colour. Returns false if that is not
    // legal.
    bool place(const OneRing& ring, const Vec2f& position, const Vec3f& color, double least_q,
               Placement& out) const;
    Vec2f newton_step(const OneRing& ring, Id v) const;
    bool move_vertex(Id v);
    // Costs the edge opposite corner i of f, across which g lies; `first` and `second` are their present
    // errors.
    bool flip_is_better(Id f, std::size_t i, Id g, double& first, double& second) const;
    bool flip_if_better(Id f, std::size_t i, Id g);
    void set(const OneRing& ring, Id v, const Placement& placement);

    struct Insertion {
        Id face;
        int edge;  // on the edge opposite this corner, or -1 for the inside
        Vec2f position;
        Vec3f color;
        double gain;
        bool border;  // whether it is on an edge of one face
    };
    Id across(const Insertion& insertion) const;  // the other face that it divides, or kNone
    void relocate(std::size_t most, const std::vector<Removal>& removals,
                  const std::vector<Insertion>& insertions, bool border, TouchedFaces& touched,
                  std::vector<Id>& fresh);
    void changed(const OneRing& ring);  // forgets what was remembered of its vertices
    void changed(Id f);
    std::vector<Insertion> insertions() const;
    Removal best_removal(Id v) const;
    Insertion best_insertion(Id f) const;
    void try_insertion(Id f, int edge, const Vec2f& position, Insertion& best) const;
    void remove(const Removal& removal);
    Id insert(const Insertion& insertion);
    double face_error(const Face& face) const;

    const ImagePlanes& image_;
    RefineParams params_;
    EditMesh mesh_;
    RefineVertices vertex_;
    std::vector<double> error_;  // of each face
    // The best removal of each vertex, and whether nothing that it depends on has changed since then.
    std::vector<Removal> removal_;
    std::vector<std::uint8_t> removal_holds_;
    double shape_unit_ = 0;  // the squared error that weighs as much as a shape cost of 1
};

}  // namespace imgmesh

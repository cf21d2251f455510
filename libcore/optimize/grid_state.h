// The state of an optimisation of a PlacedMesh, and its steps.
#pragma once

#include <vector>

#include "libcore/mesh/edit_mesh.h"
#include "libcore/optimize/face_rules.h"
#include "libcore/optimize/grid_random.h"
#include "libcore/optimize/grid_tiles.h"
#include "libcore/optimize/placed_mesh.h"

namespace imgmesh {

/// Source and steps: grid_optimizer.h. Every step keeps the cost of each face up to date: its squared error
/// and what its shape costs.
class GridState {
  public:
    GridState(const RowSums& sums, const PlacedMesh& mesh, const PlaceGrid& grid, const FaceRules& rules);

    std::size_t vertices() const { return mesh_.live_vertices(); }
    std::size_t faces() const;
    std::size_t border_vertices() const;
    /// Squared error and shapes, over all faces.
    double cost() const;
    double squared_error() const;
    PlacedMesh result() const;
    /// From now on these rules hold.
    void set_rules(const FaceRules& rules);
    /// How far vertices go at once by their patterns, at most and at first [grid steps].
    void set_pattern(int longest, int first);
    /// Moves begin with a Gauss-Newton step.
    void use_newton_steps() { newton_ = true; }

    /// Numbers vertices and faces by where they are, so that the next steps find in caches what they need.
    void reorder();
    /// Least squares over all pixels, by Gauss-Seidel.
    void fit_colors(int passes);
    /// Flips each edge where that lowers the cost.
    void flip_edges();
    /// Does so, and moves each vertex to better grid points, along patterns of eight directions.
    void flip_and_move();
    /// Adds vertices where they gain most, none next to another. Returns how many.
    std::size_t insert_best(std::size_t most);
    /// Removes vertices where they cost least, none next to another. Returns how many. Of these at most
    /// `border` are on the boundary and at most `inner` are not.
    std::size_t remove_cheapest(std::size_t most, std::size_t border, std::size_t inner);
    /// Tries random moves of each vertex, with a spread in grid steps, and then all flips; `passes` times in
    /// each part of the mesh. Some that raise the cost are taken, by `temperature` on average. Each tile has
    /// random numbers of its own, which follow from the seed.
    void anneal(int passes, int trials, double spread, double temperature, std::uint64_t seed);

  private:
    using Turn = GridTiles::Turn;
    struct Vertex {
        std::int32_t column = 0, row = 0;
        std::uint8_t step = 1;       // of its pattern [grid steps]
        std::uint8_t direction = 0;  // in which it went last
        std::uint8_t fixed = 0;      // bits of fixed_axes.h
        bool removal_holds = false;  // whether removal_ is up to date
        // When its edges to later vertices were found not worth a flip.
        std::uint64_t checked = 0;
    };
    // What happens in a turn of a tile: its own time, random numbers and claims.
    struct Worker {
        const Turn* turn = nullptr;  // none: everything is claimed
        std::uint64_t tick = 0;
        GridRandom random{0};

        bool claims(Id v) const { return turn == nullptr || turn->claims_vertex(v); }
    };
    struct Removal {
        Id v = kNone, into = kNone;
        double cost = 0;
    };
    struct Insertion {
        Id face;
        int edge;  // on the edge opposite this corner, or -1 for the inside
        std::int32_t column, row;
        Double4 color;
        double gain;
    };
    // A flip of the edge opposite corner i of f, from `a` to `b`; across it lies g with the corner q.
    struct Flip {
        Id f, g;
        std::size_t i;
        Id p, a, b, q;
        double cost = 0;               // the change
        double first = 0, second = 0;  // costs of f and g then
    };

    Place place(std::int32_t column, std::int32_t row) const { return {grid_.x(column), grid_.y(row)}; }
    // The coordinates that a vertex on an edge of one face keeps, as bits of fixed_axes.h.
    std::uint8_t side_of(Id a, Id b) const;
    double face_cost(const Face& face) const;
    // Finds the ring of v. Returns false if it has none, is a corner of the image, or is not claimed.
    bool may_move(Id v, OneRing& ring, const Worker& worker) const;
    void fan_of(const OneRing& ring, Fan& fan) const;
    double cost_of(const OneRing& ring) const;
    // Fits v at a grid point; returns false if it may not be there.
    bool try_place(const Fan& fan, Id v, std::int32_t column, std::int32_t row, FanFit& fit) const;
    // Fits a fan that the rules admit, in its best allowed colour.
    void fit_admitted(const Fan& fan, const Place& at, const Double4& color, FanFit& fit) const;
    void set(const OneRing& ring, std::int32_t column, std::int32_t row, const FanFit& fit, Worker& worker);
    void move_vertex(Id v, Worker& worker);
    // Tries the Gauss-Newton step of v, and shorter ones. Returns the cost that a move has to beat.
    double step_to_minimum(Id v, const OneRing& ring, const Fan& fan, double best, Worker& worker);
    void anneal_flips(Id v, double temperature, Worker& worker);
    void anneal_vertex(Id v, int trials, double spread, double temperature, Worker& worker);
    bool cost_flip(Flip& flip) const;
    bool do_flip(const Flip& flip, Worker& worker);
    // Visits the edges of v to later vertices; visit(flip) returns whether it flipped. Returns false if an
    // edge was left out because its faces have corners that are not claimed.
    template <class Visit>
    bool for_each_flip(Id v, const Worker& worker, Visit&& visit);
    void flip_edges(Id v, Worker& worker);
    // Calls work(first, last, worker) for consecutive vertices, on all threads.
    template <class Work>
    void for_each_part(std::uint64_t seed, Work&& work);
    Removal best_removal(Id v) const;
    void remove(const Removal& removal);
    Insertion best_insertion(Id f) const;
    void try_insertion(Id f, int edge, std::int32_t column, std::int32_t row, Insertion& best) const;
    Id insert(const Insertion& insertion);
    void changed(Id f, std::uint64_t& tick);  // the face and its corners
    void changed(Id f) { changed(f, tick_); }
    void all_changed();  // every face

    const RowSums* sums_;
    PlaceGrid grid_;
    FaceRules rules_;
    Place low_, high_;               // of the box around the mesh
    std::int32_t longest_step_ = 8;  // of a pattern [grid steps]
    std::uint8_t first_step_ = 1;
    bool newton_ = false;

    EditMesh mesh_;
    std::vector<Vertex> vertex_;
    std::vector<Spot> spot_;              // of each vertex
    std::vector<double> cost_;            // of each face
    std::vector<std::uint64_t> changed_;  // when each face has changed last
    std::uint64_t tick_ = 1;
    std::vector<Removal> removal_;  // of each vertex
};

}  // namespace imgmesh

// The state of an optimisation of a CodedMesh, and its steps.
#pragma once

#include <utility>
#include <vector>

#include "libcore/coding/coded_mesh.h"
#include "libcore/coding/fan_fit.h"
#include "libcore/coding/grid_random.h"
#include "libcore/mesh/edit_mesh.h"

namespace imgmesh {

/// Source and steps: grid_optimizer.h. Every step keeps the error of each face up to date.
class GridState {
  public:
    GridState(const RowSums& sums, const CodedMesh& mesh);

    std::size_t vertices() const { return mesh_.live_vertices(); }
    double squared_error() const;
    CodedMesh result() const;

    /// Numbers vertices and faces by where they are, so that the next steps find in caches what they need.
    void reorder();
    /// Least squares over all pixels, by Gauss-Seidel.
    void fit_colors(int passes);
    /// Flips each edge where that lowers the cost.
    void flip_edges() { flip_edges({0, as_id(error_.size())}); }
    /// Does so, and moves each vertex to better grid points, along patterns of eight directions.
    void flip_and_move();
    /// Adds vertices where they gain most, none next to another. Returns how many.
    std::size_t insert_best(std::size_t most);
    /// Removes vertices where they cost least, none next to another. Returns how many.
    std::size_t remove_cheapest(std::size_t most);
    /// Tries random moves of each vertex, with a spread in grid steps, and then all flips; `passes` times in
    /// each part of the mesh. Some that raise the cost are taken, by `temperature` on average.
    void anneal(int passes, int trials, double spread, double temperature, GridRandom& random);

  private:
    using IdRange = std::pair<Id, Id>;  // the first, and the one after the last
    struct Vertex {
        std::int32_t column = 0, row = 0;
        std::uint8_t step = 1;       // of its pattern [grid steps]
        std::uint8_t direction = 0;  // in which it went last
        bool removal_holds = false;  // whether removal_ is up to date
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
    // A flip of the edge opposite corner i of f, across which g lies.
    struct Flip {
        Id f, g;
        std::size_t i;
        double cost = 0;               // the change
        double first = 0, second = 0;  // errors of f and g then
    };

    Place place(std::int32_t column, std::int32_t row) const { return {grid_.x(column), grid_.y(row)}; }
    bool on_side(Id v, bool column) const;
    double face_error(const Face& face) const;
    // Describes the ring of v. Returns false if it has none, or is a corner of the image.
    bool fan_of(Id v, OneRing& ring, Fan& fan) const;
    double error_of(const OneRing& ring) const;
    // Fits v at a grid point; returns false if it may not be there.
    bool try_place(const Fan& fan, Id v, std::int32_t column, std::int32_t row, FanFit& fit) const;
    void set(const OneRing& ring, std::int32_t column, std::int32_t row, const FanFit& fit);
    void move_vertex(Id v);
    void anneal_flips(const IdRange& faces, double temperature, GridRandom& random);
    void anneal_vertex(Id v, int trials, double spread, double temperature, GridRandom& random);
    bool cost_flip(Flip& flip) const;
    bool do_flip(const Flip& flip);
    template <class Accept>
    void flip_where(const IdRange& faces, Accept&& accept);
    void flip_edges(const IdRange& faces);
    template <class Work>
    void for_each_part(Work&& work);
    Removal best_removal(Id v) const;
    void remove(const Removal& removal);
    void best_insertion(Id f, std::vector<Insertion>& all) const;
    void try_insertion(Id f, int edge, std::int32_t column, std::int32_t row, Insertion& best) const;
    Id insert(const Insertion& insertion);
    void changed(Id f);

    const RowSums* sums_;
    CodedGrid grid_;
    EditMesh mesh_;
    std::vector<Vertex> vertex_;
    std::vector<Spot> spot_;        // of each vertex
    std::vector<double> error_;     // of each face
    std::vector<Removal> removal_;  // of each vertex
};

}  // namespace imgmesh

// How much work an optimisation of a coded mesh does, and in which order.
#pragma once

namespace imgmesh {

/// Rounds that exchange vertices, then annealing, then rounds again. Shares are of the vertices.
struct GridSchedule {
    int settles = 2;                ///< flips, moves and colours after each growth and each insertion
    int rounds = 3;                 ///< exchanges before annealing
    double share = 1;               ///< of vertices that these add and remove
    int sweeps = 40;                ///< of annealing a mesh of 2000 vertices; 0 leaves it out
    int passes = 4;                 ///< over each part of the mesh in a sweep
    int trials = 4;                 ///< of a vertex in a sweep
    double temperature = 1;         ///< at its start, over half the squared error of a vertex
    double last_temperature = 0.1;  ///< at its end, over that at the start
    double spread = 1.2;            ///< of the trials at its start [grid steps]
    double last_spread = 1.0 / 3;   ///< and at its end
    int last_rounds = 4;            ///< exchanges after annealing
    double last_share = 0.5;        ///< of vertices that these add and remove
};

/// Returns the schedule of an effort from 1 to 5. Figures: docs/decisions/0043-optimising-on-a-grid.md.
const GridSchedule& grid_schedule(int effort);

/// Returns the schedule for a mesh that was optimised before its number of vertices changed by a few percent:
/// short, and cool enough to keep what was found.
const GridSchedule& touch_up_schedule();

}  // namespace imgmesh

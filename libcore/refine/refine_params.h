// The parameters of refinement, which adjusts the vertices, edges and colours of a base mesh to the image.
#pragma once

#include <limits>

namespace imgmesh {

/// The colours that a vertex may have: those of a container (in_gamut), or [0, 1] in each channel.
enum class ColorRange { kLuv, kUnit };

struct RefineParams {
    int rounds = 2;          ///< of colours, moves, flips and relocations; >= 0
    double min_quality = 0;  ///< no new triangle has a lesser q = 4 sqrt(3) area / sum of squared edges
    double max_face_area = std::numeric_limits<double>::infinity();  ///< no new triangle is larger [px^2]
    double shape_weight = 0.22;  ///< of sum (1/q - 1) over faces, in mean squared errors of a face; >= 0
    double relocations = 0.05;   ///< share of the vertices that a round may relocate; 0 to 1
    /// Share of the vertices that a round adds, then removes elsewhere; 0 to 1. Exchanges and annealing are
    /// optimize_mesh()'s; refine() has none.
    double exchange = 0;
    int anneal = 0;          ///< sweeps of random moves between the exchanges, and then twice as many rounds
    bool keep_faces = true;  ///< exchanges keep the number of faces too, by that of boundary vertices
    /// The image is a tile of a larger one: vertices on its sides keep their places and
    /// colours.
    bool keep_sides = false;
    float position_step = 1.0f / 32;  ///< new positions are multiples of this power of two [pixels]
    ColorRange range = ColorRange::kLuv;
};

}  // namespace imgmesh

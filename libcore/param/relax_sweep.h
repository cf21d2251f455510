// One sweep of relax(): the moves of single pixels, and of pixels side by side. Internal to relax().
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "libcore/base/simd.h"
#include "libcore/param/relax.h"
#include "libcore/param/relax_step.h"

namespace imgmesh {

// Where a step would fold the grid, it is first turned aside from the triangle that it folds most, then made
// shorter.
inline constexpr int kTurns = 3, kHalvings = 2;

// A turned step leaves its triangle so much more than the least area [px^2], as it still has to be rounded to
// the grid.
inline constexpr float kSpareArea = 0.03f;

// Rounding to half weights moves a pixel by up to 2/3 of a side / 2048, and changes the areas of triangles of
// usual shape by four times that [px^2 / px]. Above half of the area at rest too little could move.
inline constexpr float kAreaPerSide = 8.0f / 3 / 2048, kMostLeastArea = 0.5f;

// Displacements up to here [pixels], so that distances between neighbours stay below 2^11 steps: products of
// two of them are then exact in floats, and so is every test of an area. Colours move pixels by a few pixels.
inline constexpr float kFarthest = 31;

// The eight pixels around one, from the east over the south. Even indices are straight neighbours.
inline constexpr int kStepX[8] = {1, 1, 0, -1, -1, -1, 0, 1};
inline constexpr int kStepY[8] = {0, 1, 1, 1, 0, -1, -1, -1};

/// A pixel's step is written twice. move_pixel() is the clear form; move_lanes() does the same for pixels
/// side by side, bit for bit (a test compares them).
struct RelaxSweep {
    PixelEmbedding& pixels;
    const BaseMesh& mesh;
    const std::vector<FaceField>& fields;
    const std::vector<Face>& neighbors;
    const FeatureImage& feature;
    const AuxiliaryFields& auxiliary;
    float mu, rate, steps, least, stride;

    // relax_pixel.cpp
    void move_pixel(int x, int y) const;
    // Moves a pixel to a place in another face if it is better off there, else half as far if that is better.
    void cross(int x, int y, float qx, float qy) const;
    float energy(std::size_t index, Id face, float px, float py, float tx, float ty) const;
    bool may_lie_in(Id face, const Vec2f& p) const;

    // relax_row.cpp
    template <typename T>
    void move_lanes(int x, int y, int resting) const;
    bool all_free(std::size_t index, std::size_t lanes) const;
    template <typename T>
    int move_in_lanes(int x, int y) const;
    template <typename T>
    void move_row(int y, int parity) const;

    // The least area of triangles around a pixel of a face: the larger the face, the more weights of half
    // precision change areas.
    template <typename T>
    IMGMESH_INLINE T least_in(T longest_side) const {
        return clamped(longest_side * kAreaPerSide, least, kMostLeastArea);
    }

    // The nearest displacement on the grid.
    template <typename T>
    IMGMESH_INLINE T on_grid(T displacement) const {
        return clamped(rounded(displacement * steps) / steps, -kFarthest, kFarthest);
    }

    // Whether a step inside a face is worth taking. With a rate that has been decided already.
    template <typename T>
    IMGMESH_INLINE auto is_better(const NewtonStep<T>& step, T sx, T sy) const {
        return step.change(sx, sy) < T{} + (rate > 0 ? std::numeric_limits<float>::max() : 0);
    }

    template <typename T>
    static IMGMESH_INLINE T on_image(T position, int side) {
        return clamped(position, 0, static_cast<float>(side - 1));
    }

    // Changes the step (sx, sy) to the best place into one to the cheapest.
    template <typename T>
    IMGMESH_INLINE void make_cheap(const NewtonStep<T>& step, T own_x, T own_y, const T* ndx, const T* ndy,
                                   T& sx, T& sy) const {
        T x = (own_x + sx) * steps, y = (own_y + sy) * steps;
        take_cheapest(step, AroundPixel<T>(own_x, ndx, steps), AroundPixel<T>(own_y, ndy, steps), steps, rate,
                      x, y);
        sx = x / steps - own_x;
        sy = y / steps - own_y;
    }

    void place(std::size_t index, float dx, float dy, Id face) const {
        pixels.dx[index] = dx;
        pixels.dy[index] = dy;
        pixels.face[index] = face;
    }
};

/// Moves the pixels of one parity in row y.
using MoveRow = void (*)(const RelaxSweep&, int y, int parity);
/// Returns the one with the widest lanes that the processor has.
MoveRow widest_move_row();

}  // namespace imgmesh

// Source: docs/decisions/0002-relaxed-map.md. The paper tracks pixels through every collapse instead (sec.
// 3.3). The steps of pixels are in relax_pixel.cpp and relax_row.cpp.
#include "libcore/param/relax.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <limits>

#include "libcore/base/parallel.h"
#include "libcore/base/parallel_vector.h"
#include "libcore/mesh/mask_fans.h"
#include "libcore/param/relax_sweep.h"

namespace imgmesh {
namespace {

// Rows of a block: enough work for the cost of a hand-over, few enough for all threads.
constexpr int kSweptRows = 16;
constexpr int kCopiedRows = 64;

std::uint8_t freedom_of(const Mask& mask, int x, int y) {
    // The places where a boundary begins and ends at a pixel do not depend on diagonals.
    const PixelFans fans = fans_at(mask, x, y, [](int) { return false; });
    if (fans.count != 1) return kPinnedX | kPinnedY;
    const Fan& fan = fans.fan[0];
    if (!fan.closed) {
        const int from = fan.direction[0], to = fan.direction[fan.count - 1];
        if (std::abs(from - to) != 4 || from % 2 != 0) return kPinnedX | kPinnedY;
        return from % 4 == 0 ? kPinnedY : kPinnedX;
    }
    return kFree;
}

}  // namespace

PixelEmbedding resting_pixels(const PixelMap& trivial, const Mask& mask) {
    PixelEmbedding pixels{trivial, parallel_vector<float>(trivial.size()),
                          parallel_vector<float>(trivial.size()), parallel_vector<Id>(trivial.size())};
    parallel_blocks(0, trivial.height, kCopiedRows, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            for (int x = 0; x < trivial.width; ++x) pixels.face[pixels.index(x, y)] = trivial.at(x, y).face;
    });
    if (mask.empty()) return pixels;
    pixels.freedom.reserve(trivial.size());
    for (int y = 0; y < trivial.height; ++y)
        for (int x = 0; x < trivial.width; ++x) pixels.freedom.push_back(freedom_of(mask, x, y));
    for (std::size_t i = 0; i < pixels.face.size(); ++i)
        if (pixels.outside(i)) pixels.dx[i] = pixels.dy[i] = std::numeric_limits<float>::quiet_NaN();
    return pixels;
}

void place_sides(PixelEmbedding& pixels, const TileSides& sides, const std::vector<FaceField>& fields,
                 const std::vector<Face>& neighbors) {
    pixels.sides_stay = true;
    const auto place = [&](const Side& side, std::vector<float>& displacement, std::size_t first,
                           std::size_t step) {
        for (std::size_t k = 0; k < side.shifts.size(); ++k) {
            const std::size_t i = first + k * step;
            if (side.shifts[k] == 0 || pixels.outside(i)) continue;
            displacement[i] = side.shifts[k];
            pixels.face[i] = locate_face(pixels.image_of(pixels.x_of(i), pixels.y_of(i)), pixels.face[i],
                                         fields, neighbors);
        }
    };
    place(sides.top, pixels.dx, 0, 1);
    place(sides.bottom, pixels.dx, pixels.row_begin(pixels.height - 1), 1);
    place(sides.left, pixels.dy, 0, as_index(pixels.width));
    place(sides.right, pixels.dy, as_index(pixels.width - 1), as_index(pixels.width));
}

Displacements displacements(const PixelEmbedding& pixels, int steps) {
    Displacements out{pixels,
                      steps,
                      parallel_vector<std::int16_t>(pixels.pixel_count()),
                      parallel_vector<std::int16_t>(pixels.pixel_count()),
                      {}};
    if (!pixels.freedom.empty()) out.inside = Mask(pixels);
    const auto scale = static_cast<float>(steps);
    parallel_blocks(0, pixels.height, kCopiedRows, [&](int first, int last) {
        for (std::size_t i = pixels.row_begin(first); i < as_index(last) * as_index(pixels.width); ++i) {
            if (pixels.outside(i)) continue;
            if (!out.inside.empty()) out.inside[i] = 1;
            out.dx[i] = static_cast<std::int16_t>(pixels.dx[i] * scale);
            out.dy[i] = static_cast<std::int16_t>(pixels.dy[i] * scale);
        }
    });
    return out;
}

void relax(PixelEmbedding& pixels, const BaseMesh& mesh, const std::vector<FaceField>& fields,
           const std::vector<Face>& neighbors, const FeatureImage& feature, const RelaxParams& params) {
    const AuxiliaryFields auxiliary = auxiliary_fields(mesh, fields);
    assert(as_int(auxiliary.features) == std::max(0, feature.channels - 3));
    const RelaxSweep sweep{pixels,
                           mesh,
                           fields,
                           neighbors,
                           feature,
                           auxiliary,
                           params.smoothness,
                           params.rate,
                           static_cast<float>(params.steps),
                           least_moving_area(params.steps),
                           params.stride};
    const MoveRow move_row = widest_move_row();
    const int h = pixels.height;
    for (int n = 0; n < params.sweeps; ++n)
        for (int parity = 0; parity < 4; ++parity)
            parallel_blocks(0, (h + 1) / 2, kSweptRows, [&](int first, int last) {
                for (int row = first; row < last; ++row)
                    if (const int y = 2 * row + parity / 2; y < h) move_row(sweep, y, parity % 2);
            });
}

}  // namespace imgmesh

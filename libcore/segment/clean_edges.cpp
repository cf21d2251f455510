#include "libcore/segment/clean_edges.h"

#include <algorithm>

#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

constexpr int kGrain = 16;  // rows a block

// The pixels around a centre that lie inside the frame and the mask. Without any both are 0.
struct Square {
    Vec3f mean = Vec3f::Zero();
    float variance = 0;  // summed over the channels
};

Square square_at(const FeatureImage& image, const Cells& cells, int x, int y) {
    const int left = std::max(0, x - 1), right = std::min(cells.width - 1, x + 1);
    const int top = std::max(0, y - 1), bottom = std::min(cells.height - 1, y + 1);
    const auto for_pixels = [&](const auto& visit) {
        for (int row = top; row <= bottom; ++row)
            for (int column = left; column <= right; ++column)
                if (cells.at(column, row) != kNone) visit(Eigen::Map<const Vec3f>(image.pixel(column, row)));
    };
    Square square;
    float count = 0;
    for_pixels([&](const Eigen::Map<const Vec3f>& color) {
        square.mean += color;
        ++count;
    });
    if (count == 0) return square;
    square.mean /= count;
    for_pixels([&](const Eigen::Map<const Vec3f>& color) {
        square.variance += (color - square.mean).squaredNorm();
    });
    square.variance /= count;
    return square;
}

}  // namespace

FeatureImage clean_edges(const FeatureImage& image, const Cells& cells) {
    Grid<Square> squares{GridSize(cells)};
    parallel_blocks(0, cells.height, kGrain, [&](int begin, int end) {
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < cells.width; ++x) squares.at(x, y) = square_at(image, cells, x, y);
    });
    FeatureImage result(image.width, image.height, 3, std::vector<float>(image.sample_count()));
    parallel_blocks(0, cells.height, kGrain, [&](int begin, int end) {
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < cells.width; ++x) {
                if (cells.at(x, y) == kNone) continue;
                const int columns[] = {std::max(0, x - 1), std::min(cells.width - 1, x + 1)};
                const int rows[] = {std::max(0, y - 1), std::min(cells.height - 1, y + 1)};
                const Square* best = nullptr;
                for (const int row : rows)
                    for (const int column : columns) {
                        const Square& square = squares.at(column, row);
                        if (best == nullptr || square.variance < best->variance) best = &square;
                    }
                Eigen::Map<Vec3f>(result.pixel(x, y)) = best->mean;
            }
    });
    return result;
}

}  // namespace imgmesh

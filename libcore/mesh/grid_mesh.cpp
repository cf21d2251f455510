#include "libcore/mesh/grid_mesh.h"

#include <utility>

#include "libcore/base/parallel.h"
#include "libcore/mesh/mask_fans.h"

namespace imgmesh {
namespace {

float squared_distance(const float* a, const float* b, int channels) {
    float sum = 0;
    for (int c = 0; c < channels; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
    return sum;
}

// Repeats a single column or row, so that every grid has an area.
FeatureImage doubled_sides(FeatureImage in) {
    if (in.width >= 2 && in.height >= 2) return in;
    FeatureImage out{std::max(2, in.width), std::max(2, in.height), in.channels, {}};
    out.data.resize(out.sample_count());
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x)
            std::copy_n(in.pixel(std::min(x, in.width - 1), std::min(y, in.height - 1)), in.channels,
                        out.pixel(x, y));
    return out;
}

// One block is about the rows of a small tile and some around them.
constexpr int kRowsPerBlock = 80;

// Returns how many vertices pixel (x, y) has after its first one.
std::size_t further_vertices(const GridMesh& mesh, int x, int y) {
    switch (strip_at(mesh.mask, x, y)) {
        case Strip::kAlongX:
        case Strip::kAlongY:
            return 1;
        case Strip::kAlone:
            return 3;
        case Strip::kNoStrip:
            break;
    }
    // The diagonal of a cell does not change the number of fans: it only joins faces of that cell.
    const std::size_t fans = fans_at(mesh.mask, x, y, [](int) { return false; }).count;
    return fans > 0 ? fans - 1 : 0;
}

void append_copies(const std::vector<Id>& copies, FeatureImage& feature) {
    const std::size_t channels = as_index(feature.channels);
    feature.data.reserve(feature.data.size() + copies.size() * channels);
    for (const Id pixel : copies)
        for (std::size_t c = 0; c < channels; ++c) feature.data.push_back(feature.data[pixel * channels + c]);
}

}  // namespace

GridMesh grid_mesh(FeatureImage feature, Mask mask) {
    GridMesh mesh;
    mesh.mask = std::move(mask);
    if (mesh.mask.empty()) {
        mesh.origin_x = feature.width == 1 ? -0.5f : 0.0f;
        mesh.origin_y = feature.height == 1 ? -0.5f : 0.0f;
        mesh.feature = doubled_sides(std::move(feature));
    } else {
        mesh.feature = std::move(feature);
    }
    const FeatureImage& f = mesh.feature;
    mesh.diagonal = Grid<std::uint8_t>({f.width - 1, f.height - 1});
    parallel_blocks(0, f.height - 1, kRowsPerBlock, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            for (int x = 0; x + 1 < f.width; ++x) {
                const float falling = squared_distance(f.pixel(x, y), f.pixel(x + 1, y + 1), f.channels);
                const float rising = squared_distance(f.pixel(x + 1, y), f.pixel(x, y + 1), f.channels);
                mesh.diagonal.at(x, y) = falling <= rising;
            }
    });
    if (mesh.mask.empty()) return mesh;
    for (int y = 0; y < f.height; ++y)
        for (int x = 0; x < f.width; ++x)
            mesh.copies.insert(mesh.copies.end(), further_vertices(mesh, x, y), as_id(f.index(x, y)));
    append_copies(mesh.copies, mesh.feature);
    return mesh;
}

FeatureImage smoothed(FeatureImage image, int passes) {
    const int c = image.channels, w = image.width * c, h = image.height;
    FeatureImage other(image.width, h, c, std::vector<float>(image.data.size()));
    for (int pass = 0; pass < passes; ++pass) {
        parallel_blocks(0, h, kRowsPerBlock, [&](int first, int last) {
            for (int y = first; y < last; ++y) {
                const float* in = image.row(y).data();
                float* out = other.row(y).data();
                for (int i = 0; i < w; ++i) {
                    const float before = in[i >= c ? i - c : i], after = in[i + c < w ? i + c : i];
                    out[i] = 0.25f * (before + after) + 0.5f * in[i];
                }
            }
        });
        parallel_blocks(0, h, kRowsPerBlock, [&](int first, int last) {
            for (int y = first; y < last; ++y) {
                const float *above = other.row(std::max(0, y - 1)).data(), *here = other.row(y).data(),
                            *below = other.row(std::min(h - 1, y + 1)).data();
                float* out = image.row(y).data();
                for (int i = 0; i < w; ++i) out[i] = 0.25f * (above[i] + below[i]) + 0.5f * here[i];
            }
        });
    }
    return image;
}

FeaturePatch smoothed_patch(const GridMesh& grid, int passes, const PixelRect& rect) {
    const FeatureImage& feature = grid.feature;
    const int c = feature.channels, reach = passes + 1;
    const int left = std::max(0, rect.left - reach), top = std::max(0, rect.top - reach);
    const int right = std::min(feature.width, rect.right + reach),
              bottom = std::min(feature.height, rect.bottom + reach);
    FeaturePatch patch{{right - left, bottom - top, c, {}}, left, top};
    if (grid.mask.empty()) {
        patch.image.data.reserve(patch.image.sample_count());
        for (int y = top; y < bottom; ++y)
            patch.image.data.insert(patch.image.data.end(), feature.pixel(left, y),
                                    feature.pixel(left, y) + patch.image.row_size());
        patch.image = smoothed(std::move(patch.image), passes);
        return patch;
    }
    // Smoothed (colour times inside) divided by smoothed inside.
    FeatureImage weighted{right - left, bottom - top, c + 1, {}};
    weighted.data.assign(weighted.sample_count(), 0.0f);
    float* out = weighted.data.data();
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x, out += c + 1) {
            if (!grid.mask.at(x, y)) continue;
            std::copy_n(feature.pixel(x, y), c, out);
            out[c] = 1;
        }
    weighted = smoothed(std::move(weighted), passes);
    patch.image.data.assign(patch.image.sample_count(), 0.0f);
    for (std::size_t i = 0; i < weighted.pixel_count(); ++i) {
        const float* sum = weighted.pixel(i);
        if (sum[c] > 0)
            for (int k = 0; k < c; ++k) patch.image.pixel(i)[k] = sum[k] / sum[c];
    }
    return patch;
}

}  // namespace imgmesh

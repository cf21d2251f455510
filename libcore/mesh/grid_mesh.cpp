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
    out.data.resize(out.pixel_count() * static_cast<std::size_t>(in.channels));
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x)
            std::copy_n(in.pixel(std::min(x, in.width - 1), std::min(y, in.height - 1)), in.channels,
                        out.pixel(static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) +
                                  static_cast<std::size_t>(x)));
    return out;
}

// One block is about the rows of a small tile and some around them.
constexpr int kRowsPerBlock = 80;

// Returns how many vertices pixel (x, y) has after its first one.
int further_vertices(const GridMesh& mesh, int x, int y) {
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
    return std::max(0, fans_at(mesh.mask, x, y, [](int) { return false; }).count - 1);
}

void append_copies(const std::vector<Id>& copies, FeatureImage& feature) {
    const auto channels = static_cast<std::size_t>(feature.channels);
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
    const int cells = f.width - 1;
    mesh.diagonal.resize(static_cast<std::size_t>(cells) * static_cast<std::size_t>(f.height - 1));
    parallel_blocks(0, f.height - 1, kRowsPerBlock, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            for (int x = 0; x < cells; ++x) {
                const float falling = squared_distance(f.pixel(x, y), f.pixel(x + 1, y + 1), f.channels);
                const float rising = squared_distance(f.pixel(x + 1, y), f.pixel(x, y + 1), f.channels);
                mesh.diagonal[static_cast<std::size_t>(y) * static_cast<std::size_t>(cells) +
                              static_cast<std::size_t>(x)] = falling <= rising;
            }
    });
    if (mesh.mask.empty()) return mesh;
    for (int y = 0; y < f.height; ++y)
        for (int x = 0; x < f.width; ++x)
            mesh.copies.insert(mesh.copies.end(), static_cast<std::size_t>(further_vertices(mesh, x, y)),
                               static_cast<Id>(y * f.width + x));
    append_copies(mesh.copies, mesh.feature);
    return mesh;
}

FeatureImage smoothed(FeatureImage image, int passes) {
    const int c = image.channels, w = image.width * c, h = image.height;
    std::vector<float> other(image.data.size());
    for (int pass = 0; pass < passes; ++pass) {
        parallel_blocks(0, h, kRowsPerBlock, [&](int first, int last) {
            for (int y = first; y < last; ++y) {
                const float* in =
                    image.data.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(w);
                float* out = other.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(w);
                for (int i = 0; i < w; ++i) {
                    const float before = in[i >= c ? i - c : i], after = in[i + c < w ? i + c : i];
                    out[i] = 0.25f * (before + after) + 0.5f * in[i];
                }
            }
        });
        parallel_blocks(0, h, kRowsPerBlock, [&](int first, int last) {
            for (int y = first; y < last; ++y) {
                const auto row = [&](int r) {
                    return other.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(w);
                };
                const float *above = row(std::max(0, y - 1)), *here = row(y),
                            *below = row(std::min(h - 1, y + 1));
                float* out = image.data.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(w);
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
        const auto row = static_cast<std::size_t>((right - left) * c);
        patch.image.data.reserve(patch.image.pixel_count() * static_cast<std::size_t>(c));
        for (int y = top; y < bottom; ++y)
            patch.image.data.insert(patch.image.data.end(), feature.pixel(left, y),
                                    feature.pixel(left, y) + row);
        patch.image = smoothed(std::move(patch.image), passes);
        return patch;
    }
    // Smoothed (colour times inside) divided by smoothed inside.
    FeatureImage weighted{right - left, bottom - top, c + 1, {}};
    weighted.data.assign(weighted.pixel_count() * static_cast<std::size_t>(c + 1), 0.0f);
    float* out = weighted.data.data();
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x, out += c + 1) {
            if (!grid.mask.at(x, y)) continue;
            std::copy_n(feature.pixel(x, y), c, out);
            out[c] = 1;
        }
    weighted = smoothed(std::move(weighted), passes);
    patch.image.data.assign(patch.image.pixel_count() * static_cast<std::size_t>(c), 0.0f);
    for (std::size_t i = 0; i < weighted.pixel_count(); ++i) {
        const float* sum = weighted.pixel(i);
        if (sum[c] > 0)
            for (int k = 0; k < c; ++k) patch.image.pixel(i)[k] = sum[k] / sum[c];
    }
    return patch;
}

}  // namespace imgmesh

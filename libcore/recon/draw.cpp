// Most drawings have a map for the output's pixels: the level's own, or the mesh rasterised. Rows of L*u*v*
// are made from it and encoded. The others are in draw_smooth.cpp.
#include "libcore/recon/draw.h"

#include <algorithm>
#include <functional>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/base/parallel_vector.h"
#include "libcore/base/simd.h"
#include "libcore/image/luv_encoder.h"
#include "libcore/mesh/bounded_raster.h"
#include "libcore/recon/draw_smooth.h"
#include "libcore/recon/level_colors.h"
#include "libcore/recon/patch_colors.h"
#include "libcore/recon/visit_lightness.h"

namespace imgmesh {
namespace {

constexpr int kGrainRows = 4, kChunkRows = 8 * kGrainRows;

// Larger drawings are surely a mistake; one of this size takes 8 GB.
constexpr double kMaxPixels = 1 << 28;

// Fills one row of an output: L*, u*, v* as three planes of `width` values.
using RowFunction = std::function<void(int y, float* planes)>;

void store(float* planes, int width, std::size_t x, const Vec3f& luv) {
    for (int c = 0; c < 3; ++c) planes[as_index(c * width) + x] = luv[c];
}

// A feature at a place on the mesh.
float at_coord(const BaseMesh& mesh, const PixelCoord& at, int feature) {
    const auto [a, b, c] = mesh.faces[at.face];
    return (1 - at.u - at.v) * mesh.feature_of(a)[feature] + at.u * mesh.feature_of(b)[feature] +
           at.v * mesh.feature_of(c)[feature];
}

// The colour of each vertex, in one register.
std::vector<Float4> vertex_colors(const BaseMesh& mesh) {
    std::vector<Float4> colors;
    colors.reserve(mesh.vertex_count());
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const float* const f = mesh.feature_of(v);
        colors.push_back(Float4{f[0], f[1], f[2], 0});
    }
    return colors;
}

// Fills a row through the map. The map is read from memory once and the rows stay in cache; only the corners'
// colours are gathered. Face ids are known to be valid or kNone.
void interpolate_row(const BaseMesh& mesh, const std::vector<Float4>& colors, const PixelMap& map, int y,
                     float* planes) {
    const std::span<const PixelCoord> row = map.row(y);
    const Face* const faces = mesh.faces.data();
    const Float4* const of_vertex = colors.data();
    float *l = planes, *u = l + map.width, *v = u + map.width;
    for (std::size_t x = 0; x < row.size(); ++x) {
        if (row[x].face == kNone) {
            l[x] = u[x] = v[x] = 0;
            continue;
        }
        const Face& face = faces[row[x].face];
        const float wb = row[x].u, wc = row[x].v, wa = 1 - wb - wc;
        const Float4 color = wa * of_vertex[face[0]] + wb * of_vertex[face[1]] + wc * of_vertex[face[2]];
        l[x] = color[0];
        u[x] = color[1];
        v[x] = color[2];
    }
}

// One colour for each face.
void face_row(const std::vector<Vec3f>& colors, const PixelMap& map, int y, float* planes) {
    const std::span<const PixelCoord> row = map.row(y);
    for (std::size_t x = 0; x < row.size(); ++x)
        store(planes, map.width, x, row[x].face == kNone ? Vec3f(Vec3f::Zero()) : colors[row[x].face]);
}

// Darkens pixels whose right or lower neighbour belongs to another patch.
void darken_borders(const PixelMap& map, int y, float* planes) {
    constexpr float kDarker = 0.6f;
    const std::span<const PixelCoord> row = map.row(y), below = map.row(std::min(y + 1, map.height - 1));
    for (std::size_t x = 0; x < row.size(); ++x) {
        const Id right = row[std::min(x + 1, row.size() - 1)].face;
        if (right == row[x].face && below[x].face == row[x].face) continue;
        for (int c = 0; c < 3; ++c) planes[as_index(c * map.width) + x] *= kDarker;
    }
}

// Alpha of a pixel inside; empty: 1.
using AlphaFunction = std::function<float(const PixelCoord&)>;

Image encode_rows(const SourceInfo& source, const PixelMap& map, const RowFunction& row_function,
                  const AlphaFunction& alpha = {}) {
    const bool clear = source.has_mask || alpha;
    Image image = drawing_canvas(source, map.width, 0, clear);
    image.height = map.height;
    image.data.reserve(image.sample_count());
    touch_pages(image.data.data(), image.sample_count() * sizeof(float));
    const LuvEncoder encoder(image.color_space);
    // Memory is set to zero a little before it is drawn on, so that it is in the processor's cache.
    for (int top = 0; top < map.height; top += kChunkRows) {
        const int bottom = std::min(map.height, top + kChunkRows);
        image.data.resize(image.row_size() * as_index(bottom));
        parallel_blocks(top, bottom, kGrainRows, [&](int first, int last) {
            std::vector<float> planes(as_index(map.width) * 3);
            for (int y = first; y < last; ++y) {
                row_function(y, planes.data());
                float* out = image.row(y).data();
                encoder.encode_row(planes, map.width, out, image.channels);
                if (!clear) continue;
                for (const PixelCoord& c : map.row(y)) {
                    out[3] = c.face == kNone ? 0.0f : alpha ? std::clamp(alpha(c), 0.0f, 1.0f) : 1.0f;
                    out += image.channels;
                }
            }
        });
    }
    return image;
}

bool may_scale(DrawMode mode) {
    return mode == DrawMode::kGouraud || mode == DrawMode::kWire || mode == DrawMode::kFlat;
}

}  // namespace

double checked_scale(const SourceInfo& source, const DrawParams& params) {
    if (params.scale == 1) return 1;
    if (!may_scale(params.mode))
        throw Error(ErrorKind::kBadArgument,
                    cat("scale is ", params.scale, ": this drawing has the image's own size"));
    if (!(params.scale > 0 && params.scale * source.width * params.scale * source.height <= kMaxPixels))
        throw Error(ErrorKind::kBadArgument,
                    cat("scale is ", params.scale, ", expected above 0 and at most ", kMaxPixels,
                        " pixels of a ", source.width, "x", source.height, " image"));
    return params.scale;
}

Image draw(const MeshImage& mesh_image, int level_index, const DrawParams& params) {
    const SourceInfo& source = mesh_image.source;
    const Level& level = level_to_draw(mesh_image, level_index);
    const BaseMesh& mesh = level.mesh;
    checked_scale(source, params);

    if (params.mode == DrawMode::kFlat || params.mode == DrawMode::kWire)
        return draw_smooth(mesh_image, level_index, params);
    PixelMap raster;
    if (params.mode == DrawMode::kGouraud)
        raster = bounded_raster(mesh, sample_grid(source.width, source.height, params.scale));
    const PixelMap& map = params.mode == DrawMode::kGouraud ? raster : level.map;
    const int a = alpha_feature(source);
    switch (params.mode) {
        case DrawMode::kMap:
        case DrawMode::kGouraud: {
            const std::vector<Float4> colors = vertex_colors(mesh);
            return encode_rows(
                source, map, [&](int y, float* planes) { interpolate_row(mesh, colors, map, y, planes); },
                a < 0 ? AlphaFunction() : [&mesh, a](const PixelCoord& c) { return at_coord(mesh, c, a); });
        }
        case DrawMode::kPatches: {
            const std::vector<Vec3f> colors = patch_colors(mesh, map);
            return encode_rows(source, map, [&](int y, float* planes) {
                face_row(colors, map, y, planes);
                darken_borders(map, y, planes);
            });
        }
        default:
            break;
    }
    if (level_index != 0)
        throw Error(ErrorKind::kBadArgument, cat("level is ", level_index, ": visits are those of level 0"));
    const std::vector<float> lightness = visit_lightness(mesh_image);
    return encode_rows(source, map, [&](int y, float* planes) {
        std::fill_n(planes, 3 * map.width, 0.0f);
        std::copy_n(lightness.data() + map.row_begin(y), map.width, planes);
    });
}

}  // namespace imgmesh

// Faces are cut along pixels (coverage.h). Each pixel sums their colours by area, in the order of faces,
// within bands of rows that depend on nothing but the drawing. Lines are laid over the sums.
#include "libcore/recon/draw_smooth.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "libcore/base/parallel.h"
#include "libcore/image/luv_encoder.h"
#include "libcore/mesh/bounded_raster.h"
#include "libcore/recon/coverage.h"
#include "libcore/recon/level_colors.h"
#include "libcore/recon/svg_places.h"
#include "libcore/recon/wire_lines.h"

namespace imgmesh {
namespace {

constexpr int kRows = WireLines::kRows;

// What is above this is whole: sums of areas have rounding errors of about 1e-6.
constexpr float kWhole = 1 - 1e-5f;

// The sums of a pixel.
struct Covered {
    Vec3f color{0, 0, 0};  // L*u*v* times weight
    float weight = 0;      // area times alpha, but never 0 where something covers
    float alpha = 0;       // area times alpha
};

// A face's colour at a place of the drawing, and its alpha.
struct FaceColor {
    std::array<Vec2d, 3> corner;  // [output pixels]
    std::array<Vec3f, 3> color;
    float alpha = 1;
    bool flat = false;
    double inverse_area2 = 0;

    Vec3f at(const Vec2d& p) const {
        if (flat) return color[0];
        const auto weight = [&](const Vec2d& q, const Vec2d& r) {
            const Vec2d a = q - p, b = r - p;
            return std::clamp((a.x() * b.y() - a.y() * b.x()) * inverse_area2, 0.0, 1.0);
        };
        const double w0 = weight(corner[1], corner[2]), w1 = weight(corner[2], corner[0]),
                     w2 = weight(corner[0], corner[1]), sum = w0 + w1 + w2;
        if (!(sum > 0)) return color[0];  // a sliver, of which rounding leaves nothing
        return static_cast<float>(w0 / sum) * color[0] + static_cast<float>(w1 / sum) * color[1] +
               static_cast<float>(w2 / sum) * color[2];
    }
};

class SmoothDrawing {
  public:
    SmoothDrawing(const MeshImage& mesh_image, int level_index, const DrawParams& params)
        : source_(mesh_image.source),
          mesh_(mesh_image.levels[as_index(level_index)].mesh),
          flat_(params.mode == DrawMode::kFlat),
          alpha_(flat_ ? alpha_feature(source_) : -1),
          scale_(params.scale) {
        const SampleGrid grid = sample_grid(source_.width, source_.height, scale_);
        constexpr double kFree = 1 << 20;
        check_cover(mesh_, grid, kFree);
        width_ = as_int(grid.x.size());
        height_ = as_int(grid.y.size());
        for (const Vec2d& p : outward(mesh_image.levels[as_index(level_index)], source_))
            points_.push_back((p + Vec2d(0.5, 0.5)) * scale_);
        sort_faces();
    }

    Image draw() const {
        const bool clear = source_.has_mask || alpha_ >= 0;
        Image image = drawing_canvas(source_, width_, height_, clear);
        const LuvEncoder encoder(image.color_space);
        std::optional<WireLines> lines;
        if (!flat_)
            lines.emplace(mesh_, points_, Vec2d(source_.width, source_.height) * scale_, scale_,
                          double(source_.width) * source_.height + double(width_) * height_);
        parallel_blocks(0, height_, kRows, [&](int first, int last) {
            const std::size_t pixels = as_index(last - first) * as_index(width_);
            std::vector<Covered> sums(pixels);
            add_faces(first, last, sums);
            std::vector<float> ink(lines ? pixels : 0), planes(as_index(width_) * 3);
            if (lines) lines->cover(first, last, width_, ink);
            for (int y = first; y < last; ++y) {
                const std::size_t begin = as_index(y - first) * as_index(width_);
                float* out = image.row(y).data();
                for (int x = 0; x < width_; ++x) {
                    const std::size_t i = begin + as_index(x);
                    const float whole = part_of_image(x, source_.width) * part_of_image(y, source_.height);
                    float alpha = sums[i].alpha / whole;
                    const Vec3f color = with_line(mean_of(sums[i]), lines ? ink[i] : 0, alpha);
                    for (int c = 0; c < 3; ++c) planes[as_index(c * width_ + x)] = color[c];
                    if (clear) out[as_index(x * image.channels) + 3] = alpha;
                }
                encoder.encode_row(planes, width_, out, image.channels);
            }
        });
        return image;
    }

  private:
    static Vec3f mean_of(const Covered& sum) {
        return sum.weight > 0 ? Vec3f(sum.color / sum.weight) : Vec3f(Vec3f::Zero());
    }

    // The part of an output pixel that lies in the image: the last one may reach beyond it.
    float part_of_image(int i, int side) const {
        return static_cast<float>(std::clamp(side * scale_ - i, 1e-3, 1.0));
    }

    // Lays a line over a colour with this alpha, which changes.
    Vec3f with_line(const Vec3f& color, float ink, float& alpha) const {
        alpha = alpha > kWhole ? 1 : alpha;
        if (flat_) return color;
        constexpr float kLighter = 0.35f;                 // share of white in the image below
        const Vec3f white(100, 0, 0), line(15, -3, -15);  // L*u*v*; a line is a dark blue
        const float below = (1 - ink) * (source_.has_mask ? alpha : 1);
        if (below + ink == 0) return color;
        const Vec3f lighter = (1 - kLighter) * color + kLighter * white;
        alpha = below + ink;
        return Vec3f(below * lighter + ink * line) / alpha;
    }

    // Faces that are turned over cover nothing, as in rasterize().
    void sort_faces() {
        bands_.resize(as_index((height_ + kRows - 1) / kRows));
        for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
            const auto [a, b, c] = mesh_.faces[f];
            if (!(twice_area(f) > 0)) continue;
            const double top = std::min({points_[a].y(), points_[b].y(), points_[c].y()}),
                         bottom = std::max({points_[a].y(), points_[b].y(), points_[c].y()});
            const auto band_at = [&](double y) {
                return static_cast<std::size_t>(std::clamp(y, 0.0, height_ - 1.0) / kRows);
            };
            for (std::size_t band = band_at(top); band <= band_at(bottom); ++band)
                bands_[band].push_back(as_id(f));
        }
    }

    double twice_area(std::size_t f) const {
        const auto [a, b, c] = mesh_.faces[f];
        const Vec2d p = points_[b] - points_[a], q = points_[c] - points_[a];
        return p.y() * q.x() - p.x() * q.y();
    }

    FaceColor color_of(Id f) const {
        const Face& face = mesh_.faces[f];
        FaceColor color;
        color.flat = flat_;
        for (std::size_t k = 0; k < 3; ++k) {
            color.corner[k] = points_[face[k]];
            color.color[k] = Eigen::Map<const Vec3f>(mesh_.feature_of(face[k]));
        }
        if (flat_) color.color[0] = (color.color[0] + color.color[1] + color.color[2]) / 3;
        color.inverse_area2 = -1 / twice_area(f);
        if (alpha_ >= 0) {
            float sum = 0;
            for (const Id v : face) sum += mesh_.feature_of(v)[alpha_];
            color.alpha = std::clamp(sum / 3, 0.0f, 1.0f);
        }
        return color;
    }

    void add_faces(int first, int last, std::vector<Covered>& sums) const {
        constexpr float kLeastWeight = 1e-6f;  // so that what is clear keeps its colour
        for (const Id f : bands_[as_index(first / kRows)]) {
            const FaceColor color = color_of(f);
            for_each_covered(color.corner, first, last, width_,
                             [&](int x, int y, double area, const Vec2d& centroid) {
                                 Covered& sum = sums[as_index(y - first) * as_index(width_) + as_index(x)];
                                 const auto part = static_cast<float>(area);
                                 const float weight = part * std::max(color.alpha, kLeastWeight);
                                 sum.color += weight * color.at(centroid);
                                 sum.weight += weight;
                                 sum.alpha += part * color.alpha;
                             });
        }
    }

    const SourceInfo& source_;
    const BaseMesh& mesh_;
    bool flat_;
    int alpha_;  // the feature, or -1
    double scale_;
    int width_ = 0, height_ = 0;
    std::vector<Vec2d> points_;           // the vertices [output pixels]
    std::vector<std::vector<Id>> bands_;  // the faces that reach into each band of kRows rows
};

}  // namespace

Image draw_smooth(const MeshImage& mesh_image, int level_index, const DrawParams& params) {
    return SmoothDrawing(mesh_image, level_index, params).draw();
}

}  // namespace imgmesh

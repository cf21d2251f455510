// Steps of a collapse: (1) the layouts are made, and may forbid it; (2) the pixels around the edge, and its
// ends where they are pixels, are carried to the faces that stay; (3) the mesh merges the ends; (4) the
// pixels are filed under their new faces.
#include "libcore/param/track.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "libcore/mesh/weight_grid.h"
#include "libcore/param/collapse_flattening.h"

namespace imgmesh {
namespace {

std::size_t index(int k) {
    return static_cast<std::size_t>(k);
}

}  // namespace

PixelTracker::PixelTracker(TrackStart start, const TrackParams& params)
    : width_(start.width),
      height_(start.height),
      dimensions_(2 + start.channels),
      params_(params),
      mesh_(std::move(start.faces), start.position.size()),
      pixel_(std::move(start.pixel)),
      first_(mesh_.face_count(), kNone),
      pixels_(index(width_) * index(height_)),
      visits_(pixels_.size(), 0) {
    const auto scale = static_cast<float>(std::sqrt(params.color_weight));
    points_.reserve(start.position.size() * index(dimensions_));
    for (std::size_t v = 0; v < start.position.size(); ++v) {
        points_.push_back(start.position[v].x());
        points_.push_back(start.position[v].y());
        for (std::size_t c = 0; c < index(start.channels); ++c)
            points_.push_back(scale * start.feature[v * index(start.channels) + c]);
    }
    for (std::size_t p = 0; p < start.off_vertex.size(); ++p)
        if (const PixelCoord& coord = start.off_vertex[p]; coord.face != kNone)
            put(static_cast<Id>(p), coord.face,
                {1.0 - double(coord.u) - double(coord.v), double(coord.u), double(coord.v)});
}

void PixelTracker::put(Id pixel, Id face, const std::array<double, 3>& weight) {
    // On the grid weights sum to 1 exactly, and those that are 0 stay so: sides keep their pixels.
    const PixelCoord coord = on_weight_grid(face, weight, weight_steps(WeightPrecision::kFloat));
    pixels_[pixel] = {coord.u, coord.v, first_[face]};
    first_[face] = pixel;
}

// The weights of a pixel of a star's face: of the center, and of the two ring vertices in order.
std::array<double, 3> PixelTracker::star_weights(const Star& star, int face, Id pixel) const {
    const double u = pixels_[pixel].u, v = pixels_[pixel].v;
    const std::array<double, 3> weight{1 - u - v, u, v};
    const std::size_t at = mesh_.corner_of(star.face[index(face)], star.center);
    return {weight[at], weight[(at + 1) % 3], weight[(at + 2) % 3]};
}

// Step 2, for the pixels of faces that do not rest.
void PixelTracker::carry(const CollapseFlattening& flat, const std::array<Star, 2>& stars) {
    const auto add = [&](Id pixel, const StarPoint& from) {
        const StarPoint to = flat.carry(from);
        const Star& star = stars[index(to.star)];
        const Id face = star.face[index(to.at.triangle)];
        const std::size_t at = mesh_.corner_of(face, star.center);
        Moved moved{pixel, face, {}};
        for (std::size_t k = 0; k < 3; ++k) moved.weight[(at + k) % 3] = to.at.weight[k];
        moved_.push_back(moved);
    };
    for (int s = 0; s < 2; ++s) {
        const Star& star = stars[index(s)];
        for (int k = 0; k < star.faces(); ++k) {
            const bool shared = flat.is_shared(s, k);
            if (shared && s == 1) continue;  // with star 0
            Id& first = first_[star.face[index(k)]];
            for (Id p = first; p != kNone; p = pixels_[p].next) {
                ++visits_[p];
                if (shared || !flat.rests(s)) add(p, {s, {k, star_weights(star, k, p)}});
            }
            if (shared || !flat.rests(s)) first = kNone;
        }
        if (pixel_[star.center] != kNone && !flat.rests(s)) add(pixel_[star.center], {s, {0, {1, 0, 0}}});
    }
}

bool PixelTracker::collapse(Id kept, Id removed, const Vec2f& position, std::span<const float> feature) {
    assert(feature.size() + 2 >= index(dimensions_));
    const std::array<Star, 2> stars{mesh_.star(kept), mesh_.star(removed)};
    const auto scale = static_cast<float>(std::sqrt(params_.color_weight));
    merged_.assign({position.x(), position.y()});
    for (const float f : feature.first(index(dimensions_ - 2))) merged_.push_back(scale * f);

    moved_.clear();
    std::array<Id, 2> resting{kNone, kNone};  // pixels that are an end where the merged vertex is
    const std::array<Id, 2> ends{pixel_[kept], pixel_[removed]};
    if (params_.space == TrackSpace::kConformal) {
        CollapseFlattening flat;
        if (!flat.lay_out({&stars[0], &stars[1]}, points_.data(), merged_.data(), dimensions_,
                          any_shared(stars))) {
            ++rejected_;
            return false;
        }
        carry(flat, stars);
        for (std::size_t s = 0; s < 2; ++s)
            if (flat.rests(static_cast<int>(s))) resting[s] = ends[s];
    } else {
        for (const Star& star : stars)
            for (int k = 0; k < star.faces(); ++k) {
                Id& first = first_[star.face[index(k)]];
                for (Id p = first; p != kNone; p = pixels_[p].next) {
                    ++visits_[p];
                    moved_.push_back({p, kNone, {}});
                }
                first = kNone;
            }
        for (const Id p : ends)
            if (p != kNone) moved_.push_back({p, kNone, {}});
    }
    for (const Id p : ends)
        if (p != kNone) ++visits_[p];

    pixel_[kept] = pixel_[removed] = kNone;
    mesh_.merge(kept, removed);
    std::copy(merged_.begin(), merged_.end(), points_.begin() + std::ptrdiff_t{kept} * dimensions_);
    if (params_.space == TrackSpace::kPlane) find_in_plane(mesh_.star(kept));
    for (const Moved& moved : moved_) put(moved.pixel, moved.face, moved.weight);
    for (const Id p : resting)
        if (p != kNone) put_at(kept, p);
    return true;
}

bool PixelTracker::any_shared(const std::array<Star, 2>& stars) const {
    for (int k = 0; k < stars[0].faces(); ++k) {
        const Face& corners = mesh_.corners(stars[0].face[index(k)]);
        if (first_[stars[0].face[index(k)]] != kNone &&
            std::find(corners.begin(), corners.end(), stars[1].center) != corners.end())
            return true;
    }
    return false;
}

// A pixel that lies on a vertex may be in any of its faces.
void PixelTracker::put_at(Id vertex, Id pixel) {
    const Id face = mesh_.star(vertex).face[0];
    std::array<double, 3> weight{};
    weight[mesh_.corner_of(face, vertex)] = 1;
    put(pixel, face, weight);
}

// The face and the weights of moved_ by where each pixel is in the image.
void PixelTracker::find_in_plane(const Star& star) {
    const auto place = [&](Id v) {
        const float* p = points_.data() + std::ptrdiff_t{v} * dimensions_;
        return Vec2d(double(p[0]), -double(p[1]));  // y up, as fans have it
    };
    std::array<Vec2d, Star::kMax> ring;
    for (int k = 0; k < star.size; ++k) ring[index(k)] = place(star.ring[index(k)]);
    FlatFan fan;
    const bool sound = fan.set(place(star.center), {ring.data(), index(star.size)}, !star.open);
    assert(sound);  // the collapse keeps fatter triangles
    static_cast<void>(sound);
    const auto width = static_cast<Id>(width_);
    for (Moved& moved : moved_) {
        const FanPoint at = fan.locate({double(moved.pixel % width), -double(moved.pixel / width)});
        moved.face = star.face[index(at.triangle)];
        const std::size_t corner = mesh_.corner_of(moved.face, star.center);
        for (std::size_t k = 0; k < 3; ++k) moved.weight[(corner + k) % 3] = at.weight[k];
    }
}

PixelMap PixelTracker::map(const BaseMesh& mesh) const {
    PixelMap map{width_, height_, std::vector<PixelCoord>(pixels_.size()), WeightPrecision::kFloat};
    std::vector<Id> live;
    for (Id v = 0; v < mesh_.vertex_count(); ++v)
        if (mesh_.live(v)) live.push_back(v);
    assert(live.size() == mesh.vertex_count());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto [a, b, c] = mesh.faces[f];
        const Id own = mesh_.find(live[a], live[b], live[c]);
        assert(own != kNone);
        const std::size_t at = mesh_.corner_of(own, live[a]);  // the two faces' corners differ by a rotation
        for (Id p = first_[own]; p != kNone; p = pixels_[p].next) {
            const float u = pixels_[p].u, v = pixels_[p].v;
            const std::array<float, 3> weight{1 - u - v, u, v};
            map[p] = {static_cast<Id>(f), weight[(at + 1) % 3], weight[(at + 2) % 3]};
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const Id pixel = pixel_[live[mesh.faces[f][k]]];
            if (pixel != kNone && map[pixel].face == kNone)
                map[pixel] = {static_cast<Id>(f), k == 1 ? 1.0f : 0.0f, k == 2 ? 1.0f : 0.0f};
        }
    }
    return map;
}

}  // namespace imgmesh

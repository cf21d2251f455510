// Steps of a collapse: (1) the layouts are made, and may reject it; (2) the pixels around the edge, and ends
// that are pixels, are carried to the faces that stay; (3) the mesh merges the ends; (4) the pixels are put
// into the lists of their new faces.
#include "libcore/param/track.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

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
      first_(mesh_.faces().size(), kNone),
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
    // On the grid weights sum to 1 exactly, and weights of 0 stay 0, so sides keep their pixels.
    const PixelCoord coord = on_weight_grid(face, weight, weight_steps(WeightPrecision::kFloat));
    pixels_[pixel] = {coord.u, coord.v, first_[face]};
    first_[face] = pixel;
}

// The weights of a pixel of a ring's face: of the center, and of the two ring vertices in order.
std::array<double, 3> PixelTracker::ring_weights(const OneRing& ring, std::size_t face, Id pixel) const {
    const double u = pixels_[pixel].u, v = pixels_[pixel].v;
    const std::array<double, 3> weight{1 - u - v, u, v};
    const std::size_t at = ring.corner[face];
    return {weight[at], weight[(at + 1) % 3], weight[(at + 2) % 3]};
}

PixelTracker::Moved PixelTracker::in_ring(Id pixel, const OneRing& ring, const FanPoint& at) {
    const std::size_t k = index(at.triangle), corner = ring.corner[k];
    Moved moved{pixel, ring.face[k], {}};
    for (std::size_t n = 0; n < 3; ++n) moved.weight[(corner + n) % 3] = at.weight[n];
    return moved;
}

// Step 2, for the pixels of faces that do not rest.
void PixelTracker::carry(const CollapseFlattening& flat, const std::array<OneRing, 2>& rings) {
    const auto add = [&](Id pixel, const StarPoint& from) {
        const StarPoint to = flat.carry(from);
        moved_.push_back(in_ring(pixel, rings[index(to.star)], to.at));
    };
    for (int s = 0; s < 2; ++s) {
        const OneRing& ring = rings[index(s)];
        for (std::size_t k = 0; k < ring.faces; ++k) {
            const int triangle = static_cast<int>(k);
            const bool shared = flat.is_shared(s, triangle);
            if (shared && s == 1) continue;  // with ring 0
            Id& first = first_[ring.face[k]];
            for (Id p = first; p != kNone; p = pixels_[p].next) {
                ++visits_[p];
                if (shared || !flat.rests(s)) add(p, {s, {triangle, ring_weights(ring, k, p)}});
            }
            if (shared || !flat.rests(s)) first = kNone;
        }
        if (pixel_[ring.center] != kNone && !flat.rests(s)) add(pixel_[ring.center], {s, {0, {1, 0, 0}}});
    }
}

bool PixelTracker::collapse(Id kept, Id removed, const Vec2f& position, std::span<const float> feature) {
    assert(feature.size() + 2 >= index(dimensions_));
    std::array<OneRing, 2> rings;
    const bool both = mesh_.ring(kept, rings[0]) && mesh_.ring(removed, rings[1]);
    assert(both && mesh_.may_collapse(rings[1], kept));  // the simplifier has checked this
    static_cast<void>(both);
    const auto scale = static_cast<float>(std::sqrt(params_.color_weight));
    merged_.assign({position.x(), position.y()});
    for (const float f : feature.first(index(dimensions_ - 2))) merged_.push_back(scale * f);

    moved_.clear();
    std::array<Id, 2> resting{kNone, kNone};  // pixels that are an end where the merged vertex is
    const std::array<Id, 2> ends{pixel_[kept], pixel_[removed]};
    if (params_.space == TrackSpace::kConformal) {
        CollapseFlattening flat;
        if (!flat.lay_out({&rings[0], &rings[1]}, points_.data(), merged_.data(), dimensions_,
                          any_shared(rings))) {
            ++rejected_;
            return false;
        }
        carry(flat, rings);
        for (std::size_t s = 0; s < 2; ++s)
            if (flat.rests(static_cast<int>(s))) resting[s] = ends[s];
    } else {
        for (const OneRing& ring : rings)
            for (std::size_t k = 0; k < ring.faces; ++k) {
                Id& first = first_[ring.face[k]];
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
    mesh_.collapse(rings[1], kept);
    std::copy(merged_.begin(), merged_.end(),
              points_.begin() + static_cast<std::ptrdiff_t>(kept) * dimensions_);
    OneRing& merged = rings[0];
    if (params_.space == TrackSpace::kPlane || resting != std::array<Id, 2>{kNone, kNone})
        mesh_.ring(kept, merged);
    if (params_.space == TrackSpace::kPlane) find_in_plane(merged);
    for (const Moved& moved : moved_) put(moved.pixel, moved.face, moved.weight);
    for (const Id p : resting)
        if (p != kNone) put_at(merged, p);
    return true;
}

bool PixelTracker::any_shared(const std::array<OneRing, 2>& rings) const {
    for (std::size_t k = 0; k < rings[0].faces; ++k)
        if (first_[rings[0].face[k]] != kNone && rings[0].has(k, rings[1].center)) return true;
    return false;
}

// A pixel that lies on a vertex may be in any of its faces.
void PixelTracker::put_at(const OneRing& ring, Id pixel) {
    std::array<double, 3> weight{};
    weight[ring.corner[0]] = 1;
    put(pixel, ring.face[0], weight);
}

// The face and the weights in moved_ by the pixel's place in the image.
void PixelTracker::find_in_plane(const OneRing& ring) {
    const auto place = [&](Id v) {
        const float* p = points_.data() + static_cast<std::ptrdiff_t>(v) * dimensions_;
        return Vec2d(double(p[0]), -double(p[1]));  // y up, as fans have it
    };
    std::array<Vec2d, kMaxFlatRing> around;
    for (std::size_t k = 0; k < ring.vertices(); ++k) around[k] = place(ring.vertex[k]);
    FlatFan fan;
    const bool sound = fan.set(place(ring.center), {around.data(), ring.vertices()}, ring.closed);
    assert(sound);  // the collapse keeps fatter triangles
    static_cast<void>(sound);
    const auto width = static_cast<Id>(width_);
    for (Moved& moved : moved_)
        moved = in_ring(moved.pixel, ring,
                        fan.locate({double(moved.pixel % width), -double(moved.pixel / width)}));
}

PixelMap PixelTracker::map(const BaseMesh& mesh) const {
    PixelMap map{width_, height_, std::vector<PixelCoord>(pixels_.size()), WeightPrecision::kFloat};
    std::vector<Id> live;
    for (Id v = 0; v < mesh_.vertices(); ++v)
        if (mesh_.live_vertex(v)) live.push_back(v);
    assert(live.size() == mesh.vertex_count());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto [a, b, c] = mesh.faces[f];
        const Id own = mesh_.find_face(live[a], live[b], live[c]);
        assert(own != kNone);
        const std::size_t at =
            corner_of(mesh_.face(own), live[a]);  // the two faces' corners differ by a rotation
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

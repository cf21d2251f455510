// The tracked pixel map: every pixel is carried through every collapse (paper sec. 3.3).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/edit_mesh.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

class CollapseFlattening;
struct FanPoint;

/// The dense mesh that tracking starts from.
struct TrackStart {
    int width = 0, height = 0;    ///< of the image
    int channels = 0;             ///< features a vertex
    std::vector<Vec2f> position;  ///< of the vertices [pixels]
    std::vector<float> feature;   ///< of the vertices, size vertices * channels
    std::vector<Face> faces;
    std::vector<Id> pixel;  ///< of each vertex; kNone for a vertex that is no pixel
    std::vector<PixelCoord>
        off_vertex;  ///< for each pixel that is no vertex its place in `faces`; size width
                     ///< * height, or empty
};

enum class TrackSpace {
    kConformal,  ///< pixels move with the flattened rings (the paper)
    kPlane       ///< every pixel stays at its own place in the image; no collapse is forbidden
};

struct TrackParams {
    TrackSpace space = TrackSpace::kConformal;
    /// Weight of squared distances of features against squared pixels, in angles and distances of rings; >= 0
    double color_weight = 0.1;
};

/// Follows a collapse. At first a pixel is a vertex. When that vertex is the end of a collapse, the pixel is
/// projected into a face, and projected anew whenever a collapse touches its face. Vertices made by collapses
/// are no pixels. Takes about 150 bytes a pixel for three channels.
class PixelTracker {
  public:
    PixelTracker(TrackStart start, const TrackParams& params);

    /// Carries the pixels through the collapse of `removed` into `kept`, which moves to `position`. Returns
    /// false, with nothing changed, if a flattened triangle would degenerate.
    bool collapse(Id kept, Id removed, const Vec2f& position, std::span<const float> feature);

    /// Returns the pixels' present places as a map onto `mesh`, whose vertices are those not removed, in the
    /// order of their ids. Weights lie on the kFloatWeightStep grid.
    PixelMap map(const BaseMesh& mesh) const;

    /// Returns how often each pixel's vertex was the end of a collapse or the pixel was projected anew (paper
    /// sec. 3.2); width * height.
    const std::vector<Id>& visits() const { return visits_; }
    std::int64_t rejected() const { return rejected_; }

  private:
    struct Pixel {
        float u = 0, v = 0;  // weights of its face's second and third corner
        Id next = kNone;     // in its face's list
    };
    struct Moved {
        Id pixel, face;
        std::array<double, 3> weight;  // of the face's corners
    };
    void put(Id pixel, Id face, const std::array<double, 3>& weight);
    void put_at(const OneRing& ring, Id pixel);
    static Moved in_ring(Id pixel, const OneRing& ring, const FanPoint& at);
    std::array<double, 3> ring_weights(const OneRing& ring, std::size_t face, Id pixel) const;
    bool any_shared(const std::array<OneRing, 2>& rings) const;
    void carry(const CollapseFlattening& flat, const std::array<OneRing, 2>& rings);
    void find_in_plane(const OneRing& ring);

    int width_, height_, dimensions_;
    TrackParams params_;
    EditMesh mesh_;
    std::vector<float> points_;  // of each vertex: position, features times the root of their weight
    std::vector<Id> pixel_;      // of each vertex that is still a pixel
    std::vector<Id> first_;      // of each face's list
    std::vector<Pixel> pixels_;
    std::vector<Id> visits_;
    std::vector<float> merged_;  // the merged vertex's point
    std::vector<Moved> moved_;   // by the present collapse
    std::int64_t rejected_ = 0;
};

}  // namespace imgmesh

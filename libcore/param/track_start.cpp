#include "libcore/param/track_start.h"

#include <numeric>

#include "libcore/collapse/ring_mesh.h"
#include "libcore/param/trivial_map.h"

namespace imgmesh {

TrackStart track_start(const GridMesh& grid, int width, int height) {
    TrackStart start;
    start.width = width;
    start.height = height;
    start.channels = grid.feature.channels;
    start.feature = grid.feature.data;
    const RingMesh rings = ring_mesh(grid);
    for (const Ring& ring : rings) start.position.emplace_back(ring.x, ring.y);
    std::vector<Id> live;
    start.faces = ring_faces(rings, live);
    start.pixel.assign(rings.size(), kNone);
    if (rings.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
        std::iota(start.pixel.begin(), start.pixel.end(), Id{0});
    } else {
        const BaseMesh dense{start.channels, start.position, start.feature, start.faces};
        start.off_vertex = trivial_map(dense, width, height).coords;
    }
    return start;
}

}  // namespace imgmesh

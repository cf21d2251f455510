#include "libcore/param/track_start.h"

#include <algorithm>

#include "libcore/mesh/ring_mesh.h"
#include "libcore/mesh/trivial_map.h"

namespace imgmesh {

TrackStart track_start(const GridMesh& grid, int width, int height) {
    TrackStart start;
    start.width = width;
    start.height = height;
    start.channels = grid.feature.channels;
    start.feature = grid.feature.data;
    const RingMesh rings = ring_mesh(grid);
    for (const Ring& ring : rings) start.position.emplace_back(ring.x, ring.y);
    const std::vector<Id> live = live_list(rings);
    start.faces = ring_faces(rings, live);
    for (Face& face : start.faces)
        for (Id& v : face) v = live[v];

    // Pixels that are vertices; if a pixel is several, the first. A strip's vertices lie beside its pixels.
    start.pixel.assign(rings.size(), kNone);
    const auto columns = static_cast<Id>(width);
    std::vector<bool> is_vertex(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), false);
    if (grid.feature.width == width && grid.feature.height == height)
        for (const Id v : live) {
            const Id pixel = grid.pixel_of(v);
            if (is_vertex[pixel] || rings[v].x != static_cast<float>(pixel % columns) ||
                rings[v].y != static_cast<float>(pixel / columns))
                continue;
            is_vertex[pixel] = true;
            start.pixel[v] = pixel;
        }
    if (std::find(is_vertex.begin(), is_vertex.end(), false) == is_vertex.end()) return start;
    const BaseMesh dense{start.channels, start.position, start.feature, start.faces};
    start.off_vertex = trivial_map(dense, width, height, grid.mask).values;
    for (std::size_t p = 0; p < is_vertex.size(); ++p)
        if (is_vertex[p]) start.off_vertex[p] = {};
    return start;
}

}  // namespace imgmesh

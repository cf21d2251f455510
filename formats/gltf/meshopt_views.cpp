// Source: the glTF extension EXT_meshopt_compression, versions 0 of its vertices' and 1 of its triangles'
// codec.
#include "formats/gltf/meshopt_views.h"

#include <meshoptimizer.h>

#include <mutex>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// The codecs' versions are the library's global state, and the extension allows only these.
void choose_versions() {
    static std::once_flag once;
    std::call_once(once, [] {
        meshopt_encodeVertexVersion(0);
        meshopt_encodeIndexVersion(1);
    });
}

template <typename T>
std::vector<T> reordered(const std::vector<T>& values, const std::vector<unsigned>& place,
                         std::size_t count) {
    if (values.empty()) return {};
    std::vector<T> out(count);
    for (std::size_t v = 0; v < values.size(); ++v)
        if (place[v] != ~0u) out[place[v]] = values[v];
    return out;
}

}  // namespace

StoredMesh ordered_for_meshopt(const StoredMesh& mesh) {
    static_assert(sizeof(Id) == sizeof(unsigned) && sizeof(Face) == 3 * sizeof(unsigned));
    const std::size_t vertices = mesh.position.size(), indices = 3 * mesh.faces.size();
    std::vector<unsigned> from;
    for (const Face& face : mesh.faces) from.insert(from.end(), face.begin(), face.end());
    std::vector<unsigned> order(indices), place(vertices);
    meshopt_optimizeVertexCacheStrip(order.data(), from.data(), indices, vertices);
    const std::size_t used = meshopt_optimizeVertexFetchRemap(place.data(), order.data(), indices, vertices);
    StoredMesh out;
    out.position = reordered(mesh.position, place, used);
    out.color = reordered(mesh.color, place, used);
    out.hdr = reordered(mesh.hdr, place, used);
    for (const std::vector<float>& channel : mesh.channels)
        out.channels.push_back(reordered(channel, place, used));
    out.texcoord = reordered(mesh.texcoord, place, used);
    for (std::size_t i = 0; i < indices; i += 3)
        out.faces.push_back({place[order[i]], place[order[i + 1]], place[order[i + 2]]});
    return out;
}

ByteRange MeshoptWriter::add_array(std::span<const std::uint8_t> bytes, std::size_t stride, bool triangles) {
    choose_versions();
    const std::size_t count = bytes.size() / stride;
    // Indices refer to fewer vertices than there are indices.
    std::vector<std::uint8_t> encoded(triangles ? meshopt_encodeIndexBufferBound(count, count)
                                                : meshopt_encodeVertexBufferBound(count, stride));
    encoded.resize(
        triangles ? meshopt_encodeIndexBuffer(encoded.data(), encoded.size(),
                                              reinterpret_cast<const unsigned*>(bytes.data()), count)
                  : meshopt_encodeVertexBuffer(encoded.data(), encoded.size(), bytes.data(), count, stride));
    if (encoded.empty()) throw Error(ErrorKind::kInternal, "meshoptimizer could not compress an array");
    views_.push_back({append_values(buffer_, encoded), {fallback_, bytes.size()}, stride, count, triangles});
    fallback_ += (bytes.size() + 3) / 4 * 4;
    return views_.back().decoded;
}

}  // namespace imgmesh

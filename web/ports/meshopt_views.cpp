// There is no meshoptimizer in the page: what is packed with it can be made with Draco.
#include "formats/gltf/meshopt_views.h"

#include "libcore/base/error.h"

namespace imgmesh {

StoredMesh ordered_for_meshopt(const StoredMesh&) {
    throw Error(ErrorKind::kUnsupported,
                "meshopt compression is not to be had in a browser; imgmesh-convert makes it");
}

ByteRange MeshoptWriter::add_array(std::span<const std::uint8_t>, std::size_t, bool) {
    ordered_for_meshopt({});
    return {};
}

}  // namespace imgmesh

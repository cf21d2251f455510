// WarpSession: edits of a mesh, the image that they make, and maps of them. The same steps as those of
// imgmesh-warp, so the same bits.
#include <emscripten/bind.h>

#include "libcore/base/error.h"
#include "libcore/warp/warp_image.h"
#include "libcore/warp/warp_maps.h"
#include "web/engine/file_folder.h"
#include "web/engine/guarded.h"
#include "web/engine/pixels.h"
#include "web/engine/warp_session.h"

namespace imgmesh::web {
namespace {

using WarpPointer = std::shared_ptr<WarpSession>;

WarpPointer warp_session(const MeshPointer& mesh) {
    return guarded([&] { return std::make_shared<WarpSession>(mesh); });
}

// Returns a line for each level where a handle is not where it should be.
val solve(WarpSession& session, const std::string& edits, bool drag) {
    return guarded([&] {
        session.solve(edits, drag);
        val lines = val::array();
        for (const std::string& line : session.missed()) lines.call<void>("push", line);
        return lines;
    });
}

val moves(const WarpSession& session, int level) {
    return guarded([&] { return typed_array(session.moves(level), "Float32Array"); });
}

val places(WarpSession& session, int level) {
    return guarded([&] { return typed_array(session.places(level), "Float32Array"); });
}

val turned_faces(WarpSession& session, int level) {
    return guarded([&] { return typed_array(session.turned_faces(level), "Uint32Array"); });
}

// The pixels whose cells (to the right and below) are turned over in the warped image.
val folded_pixels(const WarpSession& session) {
    return guarded([&] {
        std::vector<std::uint32_t> pixels;
        for (const std::size_t pixel : list_folded_cells(session.field()))
            pixels.push_back(static_cast<std::uint32_t>(pixel));
        return typed_array(pixels, "Uint32Array");
    });
}

// Throws Error(kBadFile) for pixels of another size than the mesh's image.
Image source_image(const WarpSession& session, const val& pixels) {
    Image image = image_from_pixels(pixels);
    const SourceInfo& source = session.mesh_image().source;
    if (image.width != source.width || image.height != source.height)
        throw Error(ErrorKind::kBadFile, cat("the image has ", image.width, "x", image.height,
                                             " pixels, that of the mesh ", source.width, "x", source.height));
    return image;
}

// The warped pixels, of the given size; 0: that of the image.
val picture(const WarpSession& session, const val& pixels, int width, int height) {
    return guarded([&] {
        return pixels_from_image(warp_image(source_image(session, pixels), session.field(), {width, height}));
    });
}

val map_value(const Image& map) {
    val channels = val::array();
    for (const std::string& name : map.channel_names) channels.call<void>("push", name);
    val value = val::object();
    value.set("width", map.width);
    value.set("height", map.height);
    value.set("channels", channels);
    value.set("data", typed_array(map.data, "Float32Array"));
    return value;
}

// The alpha of the pixels counts where they are given.
Image st_map_of(const WarpSession& session, const val& pixels) {
    std::vector<float> alpha;
    if (!pixels.isNull() && !pixels.isUndefined()) alpha = alpha_of(source_image(session, pixels));
    const SourceInfo& source = session.mesh_image().source;
    return st_map_image(inverse_map(session.field(), std::move(alpha)), source.width, source.height);
}

val displacement(const WarpSession& session) {
    return guarded([&] { return map_value(forward_map_image(session.field())); });
}

val st_map(const WarpSession& session, const val& pixels) {
    return guarded([&] { return map_value(st_map_of(session, pixels)); });
}

val displacement_exr(const WarpSession& session) {
    return guarded([&] { return save_exr_parts({{"displacement", forward_map_image(session.field())}}); });
}

val st_map_exr(const WarpSession& session, const val& pixels) {
    return guarded([&] { return save_exr_parts({{"stmap", st_map_of(session, pixels)}}); });
}

MeshPointer warped_mesh(const WarpSession& session) {
    return guarded([&] { return session.warped_mesh(); });
}

}  // namespace

EMSCRIPTEN_BINDINGS(imgmesh_warp) {
    emscripten::function("warpSession", warp_session);
    emscripten::class_<WarpSession>("WarpSession")
        .smart_ptr<WarpPointer>("WarpPointer")
        .function("solve", solve)
        .function("moves", moves)
        .function("places", places)
        .function("turnedFaces", turned_faces)
        .function("foldedPixels", folded_pixels)
        .function("picture", picture)
        .function("displacement", displacement)
        .function("stMap", st_map)
        .function("displacementExr", displacement_exr)
        .function("stMapExr", st_map_exr)
        .function("warpedMesh", warped_mesh);
}

}  // namespace imgmesh::web

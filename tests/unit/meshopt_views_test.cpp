// Arrays compressed for EXT_meshopt_compression decode to the same mesh.
#include "formats/gltf/meshopt_views.h"

#include <doctest/doctest.h>
#include <meshoptimizer.h>

#include "tests/support/random_mesh_image.h"

using namespace imgmesh;

TEST_CASE("meshopt: arrays decode to the same faces, bit for bit, and have the versions of the extension") {
    std::mt19937 random(5);
    const std::array<std::array<int, 4>, 4> sizes = {
        {{1, 1, 1, 1}, {1, 40, 1, 9}, {200, 100, 60, 40}, {131000, 3, 2000, 1}}};
    for (const auto [width, height, cells_x, cells_y] : sizes) {
        INFO(width << "x" << height);
        const StoredMesh mesh = stored_from_base(random_mesh(width, height, cells_x, cells_y, random));
        const StoredMesh ordered = ordered_for_meshopt(mesh);
        CHECK_NOTHROW(match_faces(mesh, ordered));
        std::vector<std::uint8_t> buffer = {1, 2, 3, 4};
        MeshoptWriter writer(buffer);
        writer.add(ordered.faces);
        writer.add(ordered.position);
        writer.add(ordered.color);
        StoredMesh decoded = ordered;
        const auto& views = writer.views();
        REQUIRE(views.size() == 3);
        CHECK(buffer[views[0].encoded.offset] == 0xe1);
        CHECK(buffer[views[1].encoded.offset] == 0xa0);
        std::vector<unsigned> indices(views[0].count);
        CHECK(meshopt_decodeIndexBuffer(indices.data(), indices.size(), 4, &buffer[views[0].encoded.offset],
                                        views[0].encoded.length) == 0);
        for (std::size_t i = 0; i < indices.size(); ++i) decoded.faces[i / 3][i % 3] = indices[i];
        decoded.position.assign(decoded.position.size(), {});
        CHECK(meshopt_decodeVertexBuffer(decoded.position.data(), views[1].count, views[1].stride,
                                         &buffer[views[1].encoded.offset], views[1].encoded.length) == 0);
        decoded.color.assign(decoded.color.size(), {});
        CHECK(meshopt_decodeVertexBuffer(decoded.color.data(), views[2].count, views[2].stride,
                                         &buffer[views[2].encoded.offset], views[2].encoded.length) == 0);
        CHECK(decoded.position == ordered.position);
        CHECK(decoded.color == ordered.color);
        CHECK_NOTHROW(match_faces(ordered, decoded));
        CHECK(views[2].decoded.offset + views[2].decoded.length == writer.fallback_length());
    }
}

TEST_CASE("meshopt: vertices without a face are left out") {
    StoredMesh mesh;
    mesh.position = {{9, 9, 0}, {0, 0, 0}, {0, -1, 0}, {1, 0, 0}};
    mesh.faces = {{1, 2, 3}};
    CHECK(ordered_for_meshopt(mesh).position.size() == 3);
}

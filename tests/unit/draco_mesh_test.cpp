#include "formats/gltf/draco_mesh.h"

#include <doctest/doctest.h>

#include "formats/findings/finding_error.h"
#include "libcore/base/error.h"
#include "libcore/image/color_levels.h"
#include "tests/support/random_mesh_image.h"

using namespace imgmesh;

namespace {

std::string finding(const auto& action) {
    try {
        action();
    } catch (const FindingError& error) {
        return std::string(error.code());
    }
    return "";
}

}  // namespace

TEST_CASE("draco: sequential returns the same mesh, edgebreaker the same faces, bit for bit") {
    std::mt19937 random(1);
    const std::array<std::array<int, 4>, 6> sizes = {
        {{1, 1, 1, 1}, {1, 40, 1, 9}, {30, 1, 7, 1}, {9, 7, 4, 3}, {200, 100, 60, 40}, {131000, 3, 2000, 1}}};
    for (const auto& size : sizes) {
        INFO(size[0] << "x" << size[1]);
        const auto [width, height, cells_x, cells_y] = size;
        const StoredMesh mesh = stored_from_base(random_mesh(width, height, cells_x, cells_y, random));
        const auto decode = [&](DracoMode mode) {
            const auto bytes = encode_draco_mesh(mesh, mode).bytes;
            CHECK(draco_mode(bytes) == mode);
            return decode_draco_mesh(bytes, {}, mesh.position.size(), mesh.faces.size());
        };
        CHECK(decode(DracoMode::kSequential) == mesh);
        CHECK_NOTHROW(match_faces(mesh, decode(DracoMode::kEdgebreaker)));
    }
}

TEST_CASE("draco: coarse positions and few levels of colour take fewer bytes, and come back alike") {
    std::mt19937 random(3);
    const StoredMesh fine = stored_from_base(random_mesh(800, 600, 80, 60, random));
    const auto size = [](const StoredMesh& mesh) {
        for (const DracoMode mode : {DracoMode::kSequential, DracoMode::kEdgebreaker}) {
            const DracoMesh draco = encode_draco_mesh(mesh, mode);
            CHECK_NOTHROW(match_faces(mesh, draco.decoded));
            if (mode == DracoMode::kSequential) CHECK(draco.decoded == mesh);
        }
        return encode_draco_mesh(mesh, DracoMode::kEdgebreaker).bytes.size();
    };
    const auto rounded = [&](float step, std::size_t but) {
        StoredMesh mesh = fine;
        for (std::size_t v = but; v < mesh.position.size(); ++v)
            for (float& x : mesh.position[v]) x = std::round(x / step) * step;
        return mesh;
    };
    const std::size_t vertices = fine.position.size();
    const std::size_t exact = size(fine);
    CHECK(size(rounded(0.25f, 0)) < exact - vertices / 2);
    CHECK(size(rounded(1, 0)) < exact - vertices);
    // A few fine vertices do not undo it.
    CHECK(size(rounded(0.25f, vertices / 50)) < exact - vertices / 2);
    StoredMesh levels = fine;
    const ColorLevels few(90);
    for (auto& color : levels.color)
        for (std::uint16_t& code : color) code = few.nearest(code);
    CHECK(size(levels) < exact - 3 * vertices);
}

TEST_CASE("stored mesh: to a base mesh and back, and what it refuses") {
    std::mt19937 random(2);
    const BaseMesh base = random_mesh(9, 7, 4, 3, random);
    const StoredMesh mesh = stored_from_base(base);
    CHECK(stored_from_base(base_from_stored(mesh)) == mesh);
    CHECK(base_from_stored(mesh).feature == base.feature);

    const auto broken = [&](const auto& change) {
        StoredMesh copy = mesh;
        change(copy);
        return finding([&] { base_from_stored(copy); });
    };
    CHECK(broken([](StoredMesh& m) { m.faces[3][1] = 20; }) == "mesh.index");
    CHECK(broken([](StoredMesh& m) { m.position[5][2] = 1; }) == "mesh.position");
    CHECK(broken([](StoredMesh& m) { m.position[5][0] += 0.01f; }) == "mesh.position");
    CHECK(broken([](StoredMesh& m) { m.position[5][1] = NAN; }) == "mesh.position");
    CHECK(broken([](StoredMesh& m) { m.position[5][1] = -INFINITY; }) == "mesh.position");
    CHECK(broken([](StoredMesh& m) { m.position[5][1] = float{kMaxCoordinate}; }) == "mesh.position");
    CHECK(broken([](StoredMesh& m) { m.color[0][3] = 65534; }) == "mesh.color");
    CHECK(broken([](StoredMesh& m) { std::swap(m.faces[0][0], m.faces[0][1]); }) == "mesh.orientation");
    CHECK(broken([](StoredMesh& m) { m.faces[0][0] = m.faces[0][1]; }) == "mesh.orientation");

    BaseMesh off_grid = base;
    off_grid.position[0].x() += 0.01f;
    CHECK_THROWS_AS(stored_from_base(off_grid), Error);
    BaseMesh empty = base;
    empty.faces.clear();
    CHECK_THROWS_AS(stored_from_base(empty), Error);
}

TEST_CASE("topology hash: the published one of a known mesh, and every index and position counts") {
    StoredMesh mesh;
    mesh.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.color.resize(3);
    mesh.faces = {{0, 1, 2}};
    // python3: sha256(struct.pack('<3I9f', 0,1,2, 0,0,0, 1,0,0, 0,1,0)).hexdigest()
    CHECK(topology_hash(mesh) == "c904c2b0a95991fde3f716468e689b254de2d474b3fe983db2eadaaf9732346b");
    const std::string before = topology_hash(mesh);
    mesh.faces[0] = {1, 2, 0};
    CHECK(topology_hash(mesh) != before);
    mesh.faces[0] = {0, 1, 2};
    mesh.position[1][0] = 2;
    CHECK(topology_hash(mesh) != before);
}

TEST_CASE("matching: coinciding vertices are told apart by colour, and a changed mesh is noticed") {
    std::mt19937 random(3);
    StoredMesh mesh = stored_from_base(random_mesh(9, 7, 4, 3, random));
    // The same mesh again on top, in other colours: only they distinguish a face from its twin.
    StoredMesh twice = mesh;
    const auto count = static_cast<Id>(mesh.position.size());
    for (std::size_t v = 0; v < count; ++v) {
        twice.position.push_back(mesh.position[v]);
        twice.color.push_back(mesh.color[v]);
        twice.color.back()[0] ^= 1;
    }
    for (const Face& f : mesh.faces) twice.faces.push_back({f[0] + count, f[1] + count, f[2] + count});
    StoredMesh shuffled = twice;
    std::reverse(shuffled.faces.begin(), shuffled.faces.end());
    for (Face& face : shuffled.faces) std::rotate(face.begin(), face.begin() + random() % 3, face.end());
    const FaceMatch match = match_faces(twice, shuffled);
    for (std::size_t f = 0; f < twice.faces.size(); ++f)
        for (std::size_t c = 0; c < 3; ++c)
            CHECK(shuffled.faces[match.face[f]][(c + match.shift[f]) % 3] == twice.faces[f][c]);

    StoredMesh changed = mesh;
    changed.color[4][1] ^= 1;
    CHECK_THROWS_AS(match_faces(mesh, changed), Error);
    changed = mesh;
    std::swap(changed.faces[0][0], changed.faces[0][1]);
    CHECK_THROWS_AS(match_faces(mesh, changed), Error);
    changed.faces.pop_back();
    CHECK_THROWS_AS(match_faces(mesh, changed), Error);
}

TEST_CASE("draco: broken bytes give a finding, never a crash or another mesh's sizes") {
    std::mt19937 random(4);
    const StoredMesh mesh = stored_from_base(random_mesh(20, 15, 9, 7, random));
    const auto vertices = mesh.position.size(), faces = mesh.faces.size();
    for (const DracoMode mode : {DracoMode::kEdgebreaker, DracoMode::kSequential}) {
        const auto bytes = encode_draco_mesh(mesh, mode).bytes;
        for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 64)
            CHECK(finding([&] { decode_draco_mesh(std::span(bytes).first(length), {}, vertices, faces); }) !=
                  "");
        for (int i = 0; i < 3000; ++i) {
            auto flipped = bytes;
            // Half of the flips hit the first bytes, where the sizes are.
            const std::size_t at = random() % (i % 2 ? flipped.size() : 40);
            flipped[at] = static_cast<std::uint8_t>(flipped[at] ^ (1 + random() % 255));
            try {
                const StoredMesh decoded = decode_draco_mesh(flipped, {}, vertices, faces);
                CHECK(decoded.faces.size() == faces);
                for (const Face& face : decoded.faces)
                    CHECK(*std::max_element(face.begin(), face.end()) < vertices);
            } catch (const FindingError&) {
            }
        }
        CHECK(finding([&] { decode_draco_mesh(bytes, {}, vertices, faces + 1); }) == "mesh.counts");
        CHECK(finding([&] { decode_draco_mesh(bytes, {}, vertices + 1, faces); }) == "mesh.counts");
        CHECK(finding([&] { decode_draco_mesh(bytes, {1, 0}, vertices, faces); }) == "draco.attributes");
        CHECK(finding([&] { decode_draco_mesh(bytes, {0, 7}, vertices, faces); }) == "draco.attributes");
    }
}

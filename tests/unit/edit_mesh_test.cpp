// The editable mesh: each operator on meshes small enough to draw, then thousands of operations and guards
// against plain lists of faces.
#include <doctest/doctest.h>

#include <random>

#include "libcore/mesh/edit_mesh.h"
#include "tests/support/face_lists.h"
#include "tests/support/meshes.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

std::vector<Face> live_faces(const EditMesh& mesh) {
    std::vector<Face> faces;
    for (const Face& face : mesh.faces())
        if (face[0] != kNone) faces.push_back(face);
    return faces;
}

// The ring of a vertex as its ring vertices, and whether it is closed.
std::pair<std::vector<Id>, bool> ring_of(const EditMesh& mesh, Id v) {
    OneRing ring;
    REQUIRE(mesh.ring(v, ring));
    return {{ring.vertex.begin(), ring.vertex.begin() + static_cast<std::ptrdiff_t>(ring.vertices())},
            ring.closed};
}
using Ring = std::pair<std::vector<Id>, bool>;

// A wheel: 0 in the middle, 1 to n around it, counter-clockwise. Face k is (0, k + 1, k + 2).
EditMesh wheel(Id n) {
    std::vector<Face> faces;
    for (Id k = 0; k < n; ++k) faces.push_back({0, k + 1, (k + 1) % n + 1});
    return {faces, n + 1};
}

// Two triangles:   3 - 2    Face 0 is (0, 1, 2), seen from below: y is up.
//                  | / |    Face 1 is (0, 2, 3).
//                  0 - 1
EditMesh square() {
    return {{{0, 1, 2}, {0, 2, 3}}, 4};
}

// Rings, neighbours and counts against those that the faces alone give.
void check_links(const EditMesh& mesh) {
    const auto& faces = mesh.faces();
    std::set<Id> used;
    for (Id f = 0; f < faces.size(); ++f) {
        if (!mesh.live_face(f)) continue;
        used.insert(faces[f].begin(), faces[f].end());
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [a, b] = others(faces[f], faces[f][i]);
            Id across = kNone;
            for (Id g = 0; g < faces.size(); ++g)
                if (mesh.live_face(g) && has_vertex(faces[g], b) && others(faces[g], b).first == a)
                    across = g;
            CHECK(mesh.across(f, i) == across);
            CHECK(mesh.find_face(faces[f][i], a, b) == f);
            CHECK(mesh.find_face(faces[f][i], b, a) != f);
            if (across == kNone) continue;
            CHECK(mesh.apex(f, across) == faces[f][i]);
        }
    }
    CHECK(mesh.live_vertices() == used.size());
    for (Id v = 0; v < mesh.vertices(); ++v) {
        CHECK(mesh.live_vertex(v) == used.contains(v));
        std::set<Id> around;
        for (Id f = 0; f < faces.size(); ++f)
            if (mesh.live_face(f) && has_vertex(faces[f], v)) around.insert(f);
        OneRing ring;
        CHECK(mesh.ring(v, ring) == (!around.empty() && around.size() <= OneRing::kMaxFaces));
        if (around.empty() || around.size() > OneRing::kMaxFaces) continue;
        CHECK(ring.center == v);
        CHECK(std::set<Id>(ring.face.begin(), ring.face.begin() + static_cast<std::ptrdiff_t>(ring.faces)) ==
              around);
        CHECK(ring.faces == around.size());
        CHECK(ring.closed == (ring.vertex[0] == ring.vertex[ring.faces]));
        for (std::size_t k = 0; k < ring.faces; ++k) {
            CHECK(faces[ring.face[k]][ring.corner[k]] == v);
            CHECK(others(faces[ring.face[k]], v) == std::pair(ring.vertex[k], ring.vertex[k + 1]));
        }
    }
}

}  // namespace

TEST_CASE("edit mesh: rings of a wheel begin with the first face, or where they are told to") {
    EditMesh mesh = wheel(5);
    check_links(mesh);
    CHECK(ring_of(mesh, 0) == Ring{{1, 2, 3, 4, 5}, true});
    CHECK(ring_of(mesh, 1) == Ring{{2, 0, 5}, false});
    mesh.begin_ring(0, 3);
    CHECK(ring_of(mesh, 0) == Ring{{4, 5, 1, 2, 3}, true});
    mesh.begin_ring(1, 4);  // it stays where the border is
    CHECK(ring_of(mesh, 1) == Ring{{2, 0, 5}, false});
    check_links(mesh);
}

TEST_CASE("edit mesh: a flip turns the diagonal of a square") {
    EditMesh mesh = square();
    CHECK(mesh.across(0, 1) == 1);
    CHECK(mesh.apex(0, 1) == 1);
    REQUIRE(mesh.may_flip(0, 1));
    mesh.flip(0, 1);  // p = 1, a = 2, b = 0, q = 3
    CHECK(mesh.faces() == std::vector<Face>{{1, 2, 3}, {3, 0, 1}});
    CHECK(ring_of(mesh, 1) == Ring{{2, 3, 0}, false});
    CHECK(ring_of(mesh, 2) == Ring{{3, 1}, false});
    check_links(mesh);
    // The other corners of face 0 lie opposite the border.
    CHECK_FALSE(mesh.may_flip(0, 0));
    CHECK_FALSE(mesh.may_flip(0, 2));
}

// The middle of a wheel of three: flipping a spoke would join two vertices that are neighbours already.
TEST_CASE("edit mesh: no flip makes an edge that is there") {
    const EditMesh three = wheel(3);
    for (Id f = 0; f < 3; ++f) {
        CHECK_FALSE(three.may_flip(f, 1));
        CHECK_FALSE(three.may_flip(f, 2));
    }
    CHECK(wheel(4).may_flip(0, 1));
}

TEST_CASE("edit mesh: a face splits into three around a vertex") {
    EditMesh mesh({{0, 1, 2}}, 3);
    const Id v = mesh.split_face(0);
    CHECK(v == 3);
    CHECK(mesh.faces() == std::vector<Face>{{3, 0, 1}, {3, 1, 2}, {3, 2, 0}});
    CHECK(ring_of(mesh, 3) == Ring{{0, 1, 2}, true});
    CHECK(ring_of(mesh, 2) == Ring{{0, 3, 1}, false});
    CHECK(mesh.live_vertices() == 4);
    check_links(mesh);
}

TEST_CASE("edit mesh: an edge splits with the faces on both sides, or the one on a border") {
    EditMesh mesh = square();
    CHECK(mesh.split_edge(0, 1) == 4);  // the diagonal: o = 1, a = 2, b = 0, q = 3
    CHECK(mesh.faces() == std::vector<Face>{{4, 1, 2}, {4, 3, 0}, {4, 0, 1}, {4, 2, 3}});
    CHECK(ring_of(mesh, 4) == Ring{{1, 2, 3, 0}, true});
    check_links(mesh);

    EditMesh triangle({{0, 1, 2}}, 3);
    CHECK(triangle.split_edge(0, 0) == 3);  // on the border between 1 and 2
    CHECK(triangle.faces() == std::vector<Face>{{3, 0, 1}, {3, 2, 0}});
    CHECK(ring_of(triangle, 3) == Ring{{2, 0, 1}, false});
    check_links(triangle);
}

TEST_CASE("edit mesh: a collapse takes the faces at its edge, and later splits fill the holes") {
    EditMesh mesh = wheel(5);
    OneRing ring;
    REQUIRE(mesh.ring(0, ring));
    REQUIRE(mesh.may_collapse(ring, 1));
    mesh.collapse(ring, 1);
    CHECK(live_faces(mesh) == std::vector<Face>{{1, 2, 3}, {1, 3, 4}, {1, 4, 5}});
    CHECK_FALSE(mesh.live_vertex(0));
    CHECK_FALSE(mesh.live_face(0));
    CHECK_FALSE(mesh.live_face(4));
    CHECK_FALSE(mesh.ring(0, ring));
    CHECK(ring_of(mesh, 1) == Ring{{2, 3, 4, 5}, false});
    CHECK(mesh.live_vertices() == 5);
    check_links(mesh);
    // The vertex 0 again, and the face that went last before the one that went first.
    CHECK(mesh.split_face(2) == 0);
    CHECK(mesh.faces() == std::vector<Face>{{0, 4, 1}, {1, 2, 3}, {0, 1, 3}, {1, 4, 5}, {0, 3, 4}});
    check_links(mesh);
}

// Faces of the vertex that goes come behind those of the one that stays.
TEST_CASE("edit mesh: after a collapse a ring begins with the oldest face of the vertex that stays") {
    //  4 x 3 vertices, diagonals like \; y is down, so faces turn the other way than drawn.
    std::vector<Face> faces;
    for (Id y = 0; y < 2; ++y)
        for (Id x = 0; x < 3; ++x) {
            const Id a = 4 * y + x, b = a + 1, c = a + 4, d = a + 5;
            faces.push_back({a, c, d});
            faces.push_back({a, d, b});
        }
    EditMesh mesh(faces, 12);
    CHECK(ring_of(mesh, 6) == Ring{{1, 5, 10, 11, 7, 2}, true});
    OneRing ring;
    REQUIRE(mesh.ring(5, ring));
    REQUIRE(mesh.may_collapse(ring, 6));
    mesh.collapse(ring, 6);
    // The face (1, 5, 6) was the first of 6; the next is (1, 6, 2).
    CHECK(ring_of(mesh, 6) == Ring{{2, 1, 0, 4, 9, 10, 11, 7}, true});
    check_links(mesh);
}

TEST_CASE("edit mesh: link condition, borders and what must be left") {
    const auto may = [](const EditMesh& mesh, Id removed, Id kept) {
        OneRing ring;
        return mesh.ring(removed, ring) && mesh.may_collapse(ring, kept);
    };
    // One triangle, and a tetrahedron: nothing sound would be left.
    CHECK_FALSE(may(EditMesh({{0, 1, 2}}, 3), 0, 1));
    CHECK_FALSE(may(EditMesh({{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}, 4), 0, 1));
    // The diagonal of a square joins two border vertices inside the mesh.
    CHECK_FALSE(may(square(), 0, 2));
    CHECK(may(square(), 0, 1));
    CHECK_FALSE(may(square(), 1, 3));  // no edge
    // A ring of six faces around a hole 0 1 2: without one of its sides the hole would close.
    const EditMesh hole({{0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 5, 3}, {2, 3, 0}}, 6);
    CHECK_FALSE(may(hole, 0, 1));
    CHECK_FALSE(may(hole, 4, 1));  // both are on borders
    // 0 and 1 share the neighbour 4, which is no corner of a face at their edge.
    EditMesh mesh = wheel(6);
    CHECK(may(mesh, 1, 0));
    mesh.split_face(0);  // 7 inside (0, 1, 2)
    CHECK(may(mesh, 7, 0));
    CHECK_FALSE(may(mesh, 1, 2));  // they share 0, beside 7
}

TEST_CASE("edit mesh: a vertex with too many faces has no ring, and guards make none") {
    constexpr Id kMost = OneRing::kMaxFaces;
    OneRing ring;
    EditMesh full = wheel(kMost);
    CHECK(full.ring(0, ring));
    CHECK_FALSE(wheel(kMost + 1).ring(0, ring));
    // Splitting the edge from 1 to 2 leaves 0 with one more.
    EditMesh more = full;
    more.split_edge(0, 0);
    CHECK_FALSE(more.ring(0, ring));
    // A triangle outside on 1 and 2: a flip of its edge would give 0 one more.
    std::vector<Face> faces = full.faces();
    faces.push_back({2, 1, kMost + 1});
    CHECK_FALSE(EditMesh(faces, kMost + 2).may_flip(0, 0));
    faces = wheel(kMost - 1).faces();
    faces.push_back({2, 1, kMost});
    CHECK(EditMesh(faces, kMost + 1).may_flip(0, 0));
}

namespace {

// Two wheels of i and j faces with a common spoke, its ends 0 and 1, both inside.
EditMesh two_wheels(Id i, Id j) {
    // Around 0: 1, 2, then those of its own, then 3; around 1: 0, 3, then those of its own, then 2.
    std::vector<Face> faces;
    std::vector<Id> ring{1, 2};
    Id next = 4;
    while (ring.size() + 1 < i) ring.push_back(next++);
    ring.push_back(3);
    for (std::size_t k = 0; k < ring.size(); ++k) faces.push_back({0, ring[k], ring[(k + 1) % ring.size()]});
    ring = {0, 3};
    while (ring.size() + 1 < j) ring.push_back(next++);
    ring.push_back(2);
    for (std::size_t k = 1; k + 1 < ring.size(); ++k) faces.push_back({1, ring[k], ring[k + 1]});
    return {faces, next};
}

}  // namespace

TEST_CASE("edit mesh: a collapse may fill a ring to the limit, not beyond") {
    constexpr Id kMost = OneRing::kMaxFaces;
    for (const Id i : {4u, 10u, 14u, kMost})
        for (const Id j : {4u, 5u, 13u, 14u, 15u}) {
            const EditMesh mesh = two_wheels(i, j);
            check_links(mesh);
            OneRing ring;
            REQUIRE(mesh.ring(0, ring));
            CHECK(mesh.may_collapse(ring, 1) == (i + j - 4 <= kMost));
        }
}

namespace {

std::vector<Face> collapsed(std::vector<Face> faces, Id removed, Id kept) {
    std::erase_if(faces,
                  [&](const Face& face) { return has_vertex(face, removed) && has_vertex(face, kept); });
    for (Face& face : faces)
        for (Id& v : face)
            if (v == removed) v = kept;
    return faces;
}

std::size_t faces_of(const std::vector<Face>& faces, Id v) {
    return static_cast<std::size_t>(
        std::count_if(faces.begin(), faces.end(), [v](const Face& face) { return has_vertex(face, v); }));
}

// A collapse may happen exactly where a mesh of the same topology with one vertex less comes out.
bool collapse_is_sound(const std::vector<Face>& faces, Id removed, Id kept) {
    const auto before = topology(faces), after = topology(collapsed(faces, removed, kept));
    return after && after->vertices == before->vertices - 1 && after->euler() == before->euler() &&
           after->boundaries == before->boundaries;
}

bool flip_is_sound(std::vector<Face> faces, Id p, Id a, Id b) {
    const auto face_at = [&](Id from, Id to) {
        return std::find_if(faces.begin(), faces.end(), [&](const Face& face) {
            return has_vertex(face, from) && others(face, from).first == to;
        });
    };
    const auto g = face_at(b, a);
    if (g == faces.end()) return false;
    const Id q = others(*g, b).second;
    *face_at(a, b) = {p, a, q};
    *g = {q, b, p};
    return topology(faces).has_value();
}

// A random mesh: a grid with two holes, one of them a single face.
EditMesh random_start(std::uint32_t seed) {
    const BaseMesh grid = jittered_grid(0, 0, 60, 60, 6, 6, seed);
    std::vector<Face> faces = grid.faces;
    std::erase_if(faces, [](const Face& face) { return has_vertex(face, 16); });
    for (auto at = faces.begin(); at != faces.end(); ++at)
        if (has_vertex(*at, 32) && !has_vertex(*at, 24)) {
            faces.erase(at);
            break;
        }
    return {faces, grid.vertex_count()};
}

}  // namespace

TEST_CASE("edit mesh: guards refuse what breaks a list of faces, whatever has been done before") {
    int flips = 0, collapses = 0, splits = 0, refused_flips = 0, refused_collapses = 0;
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        INFO("seed " << seed);
        EditMesh mesh = random_start(seed);
        const Topology start = topology(live_faces(mesh)).value();
        REQUIRE(start.boundaries == 3);
        std::mt19937 random(seed);
        for (int step = 0; step < 1500; ++step) {
            const Id f = static_cast<Id>(random() % mesh.faces().size());
            const std::size_t i = random() % 3;
            if (!mesh.live_face(f)) continue;
            const std::vector<Face> before = live_faces(mesh);
            const Id p = mesh.face(f)[i];
            const auto [a, b] = others(mesh.face(f), p);
            // Now more splits than collapses, now fewer: small meshes have the most to refuse.
            const std::uint32_t choice = random() % 8, split_below = step / 300 % 2 == 0 ? 1u : 3u;
            if (choice < split_below) {
                const Id v = random() % 2 == 0 ? mesh.split_face(f) : mesh.split_edge(f, i);
                CHECK(std::none_of(before.begin(), before.end(),
                                   [v](const Face& face) { return has_vertex(face, v); }));
                ++splits;
            } else if (choice < 5) {
                const Id g = mesh.across(f, i);
                const bool room = faces_of(before, p) < OneRing::kMaxFaces &&
                                  (g == kNone || faces_of(before, mesh.apex(g, f)) < OneRing::kMaxFaces);
                const bool may = mesh.may_flip(f, i);
                CHECK(may == (room && flip_is_sound(before, p, a, b)));
                refused_flips += !may && g != kNone;
                if (!may) continue;
                mesh.flip(f, i);
                ++flips;
            } else {
                OneRing ring, other;
                if (!mesh.ring(p, ring) || !mesh.ring(a, other)) continue;
                const std::vector<Face> after = collapsed(before, p, a);
                const bool may = mesh.may_collapse(ring, a);
                CHECK(may == (collapse_is_sound(before, p, a) && faces_of(after, a) <= OneRing::kMaxFaces));
                ++(may ? collapses : refused_collapses);
                if (!may) continue;
                mesh.collapse(ring, a);
                CHECK(live_faces(mesh) == after);
            }
            const auto now = topology(live_faces(mesh));
            REQUIRE(now.has_value());
            CHECK(now->euler() == start.euler());
            CHECK(now->boundaries == start.boundaries);
            if (step % 25 == 0) check_links(mesh);
        }
        check_links(mesh);
    }
    INFO(flips << " flips, " << collapses << " collapses, " << splits << " splits, refused " << refused_flips
               << " flips, " << refused_collapses << " collapses");
    CHECK(flips > 500);
    CHECK(collapses > 500);
    CHECK(splits > 500);
    CHECK(refused_flips > 50);
    CHECK(refused_collapses > 50);
}

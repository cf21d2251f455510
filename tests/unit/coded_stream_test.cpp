// A coded picture as bytes: what is written is read, and nothing else is.
#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <set>

#include "libcore/base/error.h"
#include "libcore/coding/code_points.h"
#include "libcore/coding/coded_stream.h"
#include "libcore/coding/encode_picture.h"
#include "libcore/coding/numbers.h"
#include "libcore/coding/range_coder.h"
#include "libcore/optimize/place.h"

using namespace imgmesh;
using namespace imgmesh::coding;

namespace {

std::set<GridPoint> random_points(std::mt19937& random, int columns, int rows, std::size_t count) {
    std::set<GridPoint> points;
    while (points.size() < count)
        points.insert({static_cast<int>(random() % static_cast<unsigned>(columns)),
                       static_cast<int>(random() % static_cast<unsigned>(rows))});
    return points;
}

// A mesh of random vertices, whose edges then flip at random wherever that keeps areas positive.
CodedMesh random_mesh(std::uint32_t seed, const CodedGrid& grid, std::size_t vertices, int flips) {
    std::mt19937 random(seed);
    const int right = grid.columns() - 1, bottom = grid.rows() - 1;
    std::set<GridPoint> points = random_points(random, grid.columns(), grid.rows(), vertices);
    for (const GridPoint& corner : {GridPoint{0, 0}, {right, 0}, {0, bottom}, {right, bottom}})
        points.insert(corner);
    CodedMesh mesh;
    mesh.grid = grid;
    mesh.point.assign(points.begin(), points.end());
    mesh.faces = arranged(mesh).faces;  // no faces are wanted: the first candidates, by Delaunay
    mesh.point = arranged(mesh).point;
    const auto at = [&](Id v) { return Place{grid.x(mesh.point[v][0]), grid.y(mesh.point[v][1])}; };
    for (int k = 0; k < flips; ++k) {
        Face& f = mesh.faces[random() % mesh.faces.size()];
        std::rotate(f.begin(), f.begin() + random() % 3, f.end());
        for (Face& g : mesh.faces) {
            for (int turn = 0; turn < 3 && (g[1] != f[0] || g[0] != f[1]); ++turn)
                std::rotate(g.begin(), g.begin() + 1, g.end());
            if (g[1] != f[0] || g[0] != f[1]) continue;
            const Id a = f[0], b = f[1], c = f[2], d = g[2];
            if (area2(at(a), at(d), at(c)) > 0 && area2(at(d), at(b), at(c)) > 0) {
                f = {a, d, c};
                g = {d, b, c};
            }
            break;
        }
    }
    return mesh;
}

std::set<Face> face_set(std::vector<Face> faces) {
    for (Face& face : faces)
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    return {faces.begin(), faces.end()};
}

std::vector<std::uint8_t> coded_bytes(std::uint32_t seed, int channels) {
    CodedMesh mesh = random_mesh(seed, {50, 30, 4}, 120, 200);
    mesh.channels = channels;
    StreamContent content = arranged(mesh);
    content.step_index = {30, 32, 28, 30};
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < content.point.size() * static_cast<std::size_t>(channels); ++i)
        content.level.push_back(static_cast<int>(random() % 7) - 3);
    return write_stream(content);
}

}  // namespace

TEST_CASE("numbers of any size come back") {
    const std::vector<std::uint32_t> numbers = {0, 1, 2, 127, 128, 5000, 0x7FFFFFFF};
    for (const int order : {0, 4, 7}) {
        RangeEncoder encoder;
        for (const std::uint32_t number : numbers) code_number(encoder, number, order);
        const std::vector<std::uint8_t> bytes = encoder.finish();
        RangeDecoder decoder(bytes);
        for (const std::uint32_t number : numbers) CHECK(code_number(decoder, 0, order) == number);
        CHECK(decoder.missing() <= 4);
        CHECK(decoder.left() == 0);
    }
}

TEST_CASE("a carry goes through all bytes before it") {
    // Improbable zeros move the low end of the range to its top, until it overflows.
    RangeEncoder encoder;
    std::mt19937 random(5);
    std::vector<bool> bits;
    for (int i = 0; i < 20000; ++i) {
        bits.push_back(random() % 1000 == 0);
        encoder.code(bits.back(), 32767);
    }
    const std::vector<std::uint8_t> bytes = encoder.finish();
    RangeDecoder decoder(bytes);
    for (const bool bit : bits) REQUIRE(decoder.code(false, 32767) == bit);
}

TEST_CASE("points come back, from none to all") {
    std::mt19937 random(7);
    for (const auto& [columns, rows] : {std::pair{1, 1}, {1, 9}, {17, 1}, {5, 3}, {40, 70}}) {
        const auto room = static_cast<std::size_t>(columns * rows);
        for (const std::size_t count : {std::size_t{0}, std::size_t{1}, room / 3, room - 1, room}) {
            const std::set<GridPoint> points = random_points(random, columns, rows, count);
            const std::vector<GridPoint> given(points.begin(), points.end());
            RangeEncoder encoder;
            HalvesModel model;
            code_points(encoder, model, columns, rows, static_cast<std::uint32_t>(count), given);
            const std::vector<std::uint8_t> bytes = encoder.finish();
            RangeDecoder decoder(bytes);
            HalvesModel same;
            const std::vector<GridPoint> found =
                code_points(decoder, same, columns, rows, static_cast<std::uint32_t>(count), {});
            CHECK(std::set<GridPoint>(found.begin(), found.end()) == points);
            CHECK(std::is_sorted(found.begin(), found.end(), [](const GridPoint& a, const GridPoint& b) {
                return a[1] != b[1] ? a[1] < b[1] : a[0] < b[0];
            }));
        }
    }
}

TEST_CASE("faces that are far from Delaunay come back") {
    for (const std::uint32_t seed : {1u, 2u, 3u})
        for (const int flips : {0, 50, 2000}) {
            const CodedMesh mesh = random_mesh(seed, {60, 45, 4}, 150, flips);
            CHECK(face_set(arranged(mesh).faces) == face_set(mesh.faces));
        }
}

TEST_CASE("needles that cross two hundred Delaunay edges come back") {
    // Two vertices in the middle of the left and right sides, joined by an edge below a row of vertices and
    // above another one.
    constexpr int kColumns = 100;
    CodedMesh mesh;
    mesh.grid = {kColumns, 5, 4};
    for (const int row : {0, 4})
        for (int column = 0; column < kColumns; ++column) mesh.point.push_back({column, row});
    const Id left = 2 * kColumns, right = left + 1;
    mesh.point.push_back({0, 2});
    mesh.point.push_back({kColumns - 1, 2});
    for (Id k = 0; k + 1 < kColumns; ++k) {
        mesh.faces.push_back({left, k + 1, k});
        mesh.faces.push_back({right, kColumns + k, kColumns + k + 1});
    }
    mesh.faces.push_back({left, right, kColumns - 1});
    mesh.faces.push_back({left, kColumns, right});
    // Vertices come back in another order: faces by their places.
    const auto places = [](const CodedMesh& m) {
        std::set<std::array<GridPoint, 3>> out;
        for (const Face& face : face_set(m.faces)) {
            std::array<GridPoint, 3> corner = {m.point[face[0]], m.point[face[1]], m.point[face[2]]};
            std::rotate(corner.begin(), std::min_element(corner.begin(), corner.end()), corner.end());
            out.insert(corner);
        }
        return out;
    };
    const StreamContent content = arranged(mesh);
    CodedMesh again = mesh;
    again.point = content.point;
    again.faces = content.faces;
    CHECK(places(again) == places(mesh));
}

TEST_CASE("a mesh whose faces do not fit together is replaced by one that does") {
    CodedMesh mesh = random_mesh(4, {40, 40, 4}, 60, 0);
    std::mt19937 random(4);
    for (Face& face : mesh.faces)
        if (random() % 3 == 0) face[2] = static_cast<Id>(random() % mesh.point.size());
    const StreamContent content = arranged(mesh);
    std::int64_t area = 0;
    for (const auto& [a, b, c] : content.faces) {
        const auto at = [&](Id v) {
            return Place{content.grid.x(content.point[v][0]), content.grid.y(content.point[v][1])};
        };
        CHECK(area2(at(a), at(b), at(c)) > 0);
        area += area2(at(a), at(b), at(c));
    }
    CHECK(area == 2 * 156 * 156);
}

TEST_CASE("what is written is read") {
    for (int channels = 1; channels <= 4; ++channels) {
        CodedMesh mesh = random_mesh(9, {33, 21, 3}, 80, 100);
        mesh.channels = channels;
        StreamContent content = arranged(mesh);
        content.step_index = {40, 41, 39, 52};
        content.level.assign(content.point.size() * static_cast<std::size_t>(channels), 1);
        const std::vector<std::uint8_t> bytes = write_stream(content);
        const StreamContent again = read_stream(bytes);
        CHECK(again.point == content.point);
        CHECK(again.faces == content.faces);
        CHECK(again.level == content.level);
        CHECK(again.color == content.color);
        CHECK(again.grid.width == 33);
        CHECK(again.grid.height == 21);
        CHECK(again.grid.step == 3);
        CHECK(again.channels == channels);
    }
}

TEST_CASE("a file that ends early or late is refused") {
    const std::vector<std::uint8_t> bytes = coded_bytes(3, 3);
    // A few bytes at the end may be missing, or there, without notice.
    for (std::size_t size = 0; size + 8 < bytes.size(); ++size) {
        INFO(size);
        CHECK_THROWS_AS(read_stream(std::span(bytes).first(size)), Error);
    }
    std::vector<std::uint8_t> longer = bytes;
    longer.resize(bytes.size() + 5, 1);
    CHECK_THROWS_AS(read_stream(longer), Error);
}

TEST_CASE("changed bytes give a picture or an error") {
    std::mt19937 random(11);
    const std::vector<std::uint8_t> bytes = coded_bytes(5, 4);
    int read = 0;
    for (int k = 0; k < 2000; ++k) {
        std::vector<std::uint8_t> changed = bytes;
        for (unsigned n = 0; n <= random() % 3; ++n)
            changed[random() % changed.size()] = static_cast<std::uint8_t>(random());
        try {
            const StreamContent content = read_stream(changed);
            if (content.grid.width * content.grid.height < 1000000)
                draw_coded(content.shape(), content.color, content.channels, content.grid.width,
                           content.grid.height);
            ++read;
        } catch (const Error& error) {
            const bool of_the_file =
                error.kind() == ErrorKind::kBadFile || error.kind() == ErrorKind::kUnsupported;
            CHECK(of_the_file);
        }
    }
    CHECK(read > 0);
}

TEST_CASE("sizes are refused before memory is taken for them") {
    const auto refused = [](std::vector<std::uint8_t> bytes) {
        bytes.insert(bytes.begin(), {0x9A, 'I', 'M'});
        CHECK_THROWS_AS(read_stream(bytes), Error);
    };
    refused({});
    refused({0x22, 1, 1, 0});                                // another version
    refused({0x16, 1, 1, 0});                                // bits that version 1 does not know
    refused({0x12, 0xFF, 0xFF, 0x03, 0xFF, 0xFF, 0x03, 0});  // 65536 x 65536 pixels
    refused({0x12, 0xFF, 0xFF, 0xFF, 0xFF, 0x7F, 1, 0});     // a size of five bytes
    refused({0x12, 0x7F, 0x7F, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF});
}

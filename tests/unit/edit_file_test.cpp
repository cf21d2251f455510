// Files of edits: the reader agrees with the schema, and reports where a file is wrong.
#include "formats/container/edit_file.h"

#include <doctest/doctest.h>

#include <filesystem>

#include "libcore/base/error.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;

namespace {

std::string refusal(const std::string& text) {
    try {
        edits_from_json(text, "e.json");
    } catch (const Error& e) {
        const std::string what = e.what();
        CHECK(e.kind() == ErrorKind::kBadFile);
        CHECK(what.find('\n') == std::string::npos);
        return what;
    }
    return "";
}

// A file with this handle only.
std::string with_handle(const std::string& handle) {
    return R"({"edits": [{"handles": [)" + handle + "]}]}";
}

}  // namespace

TEST_CASE("edits_from_json: the examples are judged as the schema judges them") {
    int count[2] = {0, 0};
    for (const bool valid : {false, true})
        for (const auto& entry : std::filesystem::directory_iterator(
                 std::string(IMGMESH_SCHEMAS "/examples/") + (valid ? "valid" : "invalid"))) {
            if (!entry.path().filename().string().starts_with("imgmesh-warp.edits.")) continue;
            const std::vector<std::uint8_t> bytes = load(entry.path().string());
            CAPTURE(entry.path());
            CHECK((refusal({bytes.begin(), bytes.end()}) == "") == valid);
            ++count[valid];
        }
    CHECK(count[0] >= 15);
    CHECK(count[1] >= 2);
}

TEST_CASE("edits_from_json: every member arrives") {
    const WarpEdits edits = edits_from_json(R"({"edits": [
        {"handles": [], "solver": "injective"},
        {"handles": []},
        {"name": "n", "level": 3, "solver": "arap",
         "handles": [{"vertices": [5, 2.0], "move": [1.5, -2], "rotate": 30, "scale": [2, 0.5], "center": [7, 8]},
                     {"near": [1, 2], "scale": 3}],
         "pins": [{"circle": [1, 2, 3]}, {"box": [4, 5, 6, 7]}, {"border": true}, {"vertex": 9}, {"beyond": [9, 8, 7]}]}]})",
                                            "e.json");
    REQUIRE(edits.size() == 3);
    CHECK(edits[0].solver == WarpSolver::kInjective);
    CHECK(edits[1].level == 0);
    CHECK(edits[1].solver == WarpSolver::kDirect);
    const WarpEdit& e = edits[2];
    CHECK(e.level == 3);
    CHECK(e.where == "e.json: /edits/2/level");
    CHECK(e.solver == WarpSolver::kArap);
    REQUIRE(e.handles.size() == 2);
    CHECK(e.handles[0].vertices.vertices == std::vector<Id>{5, 2});
    CHECK(e.handles[0].vertices.where == "e.json: /edits/2/handles/0/vertices");
    CHECK(e.handles[0].move == Vec2d(1.5, -2));
    CHECK(e.handles[0].rotate_deg == 30);
    CHECK(e.handles[0].scale == Vec2d(2, 0.5));
    CHECK(*e.handles[0].center == Vec2d(7, 8));
    CHECK(*e.handles[1].vertices.near == Vec2d(1, 2));
    CHECK(e.handles[1].scale == Vec2d(3, 3));
    CHECK_FALSE(e.handles[1].center);
    REQUIRE(e.pins.size() == 5);
    CHECK(*e.pins[0].circle == std::array<double, 3>{1, 2, 3});
    CHECK(*e.pins[1].box == std::array<double, 4>{4, 5, 6, 7});
    CHECK(e.pins[2].border);
    CHECK(e.pins[3].vertices == std::vector<Id>{9});
    CHECK(*e.pins[4].beyond == std::array<double, 3>{9, 8, 7});
}

TEST_CASE("edits_from_json: one line names the place") {
    CHECK(refusal("[]") == "e.json: expected an object, found array");
    CHECK(refusal("{}") == "e.json: member \"edits\" is missing");
    CHECK(refusal(R"({"edits": 3})") == "e.json: /edits: expected an array, found number");
    CHECK(refusal(R"({"edits": [{"handles": []}, 7]})") ==
          "e.json: /edits/1: expected an object, found number");
    CHECK(refusal(R"({"edits": [{"handles": [], "levle": 1}]})") ==
          "e.json: /edits/0: unknown member \"levle\"");
    CHECK(refusal(R"({"edits": [{"handles": [], "level": "1"}]})") ==
          "e.json: /edits/0/level: expected a whole number, found string");
    CHECK(refusal(with_handle(R"({"vertex": -1, "move": [0, 0]})")) ==
          "e.json: /edits/0/handles/0/vertex: expected a whole number from 0 to 4294967294, found -1");
    CHECK(refusal(with_handle(R"({"vertex": 1, "move": [0, "x"]})")) ==
          "e.json: /edits/0/handles/0/move/1: expected a number, found string");
    CHECK(refusal(with_handle(R"({"vertex": 1, "move": [0]})")) ==
          "e.json: /edits/0/handles/0/move: expected 2 items, found 1");
    CHECK(refusal(with_handle(R"({"vertex": 1})")) ==
          "e.json: /edits/0/handles/0: expected move, rotate or scale");
    for (const char* number : {"NaN", "Infinity", "1e999", "-1e400", "0x10", "1,", "+1"})
        CHECK(refusal(with_handle(std::string(R"({"vertex": 1, "move": [0, )") + number + "]}"))
                  .find("e.json: no JSON: ") == 0);
}

TEST_CASE("edits_from_json: nothing makes it do more than refuse") {
    CHECK(refusal("").find("no JSON") != std::string::npos);
    CHECK(refusal(std::string(1000000, '[')).find("nested deeper than 16") != std::string::npos);
    CHECK(refusal(R"({"edits": [{"name": )" + std::string(100, '[') + std::string(100, ']') +
                  R"(, "handles": []}]})")
              .find("nested deeper") != std::string::npos);
    CHECK(refusal("{\"\xff\xfe\": 1}").find("no JSON") != std::string::npos);
    CHECK(refusal(R"({"edits": [], "\u0000\n": 1})") == "e.json: unknown member \"\\u0000\\n\"");
    const TemporaryFolder folder;
    const std::string path = folder / "large.json";
    save(path, std::vector<std::uint8_t>(1001, ' '));
    CHECK_THROWS_AS(read_edits(path, {1000, 16}), Error);
    CHECK_THROWS_AS(read_edits(folder / "missing.json"), Error);
}

TEST_CASE("edits_from_json: nothing behind the file's end, and no member twice") {
    using namespace std::string_literals;
    CHECK(refusal("{\"edits\":[]}") == "");
    CHECK(refusal("{\"edits\":[]}\0{"s) != "");
    CHECK(refusal("{\"edits\":[],\"edits\":[]}").find("\"edits\" is there twice") != std::string::npos);
    CHECK(refusal(with_handle("{\"vertex\":0,\"vertex\":1,\"move\":[1,1]}"))
              .find("\"vertex\" is there twice") != std::string::npos);
}

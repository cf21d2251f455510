// Files in memory that stand for pipes.
#include "formats/files/stream_file.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "formats/files/atomic_file.h"
#include "formats/files/sha256.h"
#include "libcore/base/error.h"

using namespace imgmesh;

namespace {

std::vector<std::uint8_t> bytes_of(const std::string& text) {
    return {text.begin(), text.end()};
}

// The end of a pipe that has `text` and no more.
int pipe_with(const std::string& text) {
    int ends[2];
    REQUIRE(::pipe(ends) == 0);
    REQUIRE(::write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size()));
    ::close(ends[1]);
    return ends[0];
}

}  // namespace

TEST_CASE("StreamFile: what comes from a pipe is read by name, as often as one likes") {
    const int from = pipe_with("content");
    StreamFile stream("some pipe");
    stream.fill(from, 7);
    ::close(from);
    for (int i = 0; i < 2; ++i) CHECK(read_file("some pipe", 100) == bytes_of("content"));
    CHECK(file_sha256_hex("some pipe") == sha256_hex(bytes_of("content")));
    CHECK_THROWS_WITH_AS(read_file("some pipe", 6), "some pipe: longer than the limit of 6 bytes", Error);
}

TEST_CASE("StreamFile: more than the limit is refused") {
    const int from = pipe_with("content");
    StreamFile stream("some pipe");
    CHECK_THROWS_WITH_AS(stream.fill(from, 6), "some pipe: longer than the limit of 6 bytes", Error);
    ::close(from);
}

TEST_CASE("StreamFile: AtomicFile writes into it, alone or jointly, and replaces what was there") {
    StreamFile stream("out.txt");
    for (const char* text : {"longer content", "short"}) {
        AtomicFile file("out.txt", /*overwrite=*/false);
        file.write(bytes_of(text));
        file.commit();
    }
    CHECK(read_file("out.txt", 100) == bytes_of("short"));
    {
        JointFiles together;
        AtomicFile file("out.txt", true);
        file.write(bytes_of("joint"));
        file.commit();
        together.commit();
    }
    int ends[2];
    REQUIRE(::pipe(ends) == 0);
    stream.pour(ends[1], "pipe");
    char got[8] = {};
    CHECK(::read(ends[0], got, sizeof(got)) == 5);
    CHECK(std::string(got) == "joint");
    ::close(ends[0]);
    ::close(ends[1]);
    CHECK(::access("out.txt", F_OK) != 0);
}

TEST_CASE("StreamFile: a name means the file on disk again when it is gone") {
    { const StreamFile stream("gone"); }
    CHECK(stream_descriptor("gone") == -1);
    CHECK(system_path("gone") == "gone");
    CHECK_THROWS_AS(read_file("gone", 100), Error);
}

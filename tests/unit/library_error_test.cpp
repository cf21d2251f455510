#include <doctest/doctest.h>

#include <stdexcept>

#include "formats/files/library_error.h"

using namespace imgmesh;

namespace {

template <typename Exception>
void rethrow(const Exception& exception) {
    translate_errors(ErrorKind::kIo, "a.exr: cannot write", [&] { throw exception; });
}

}  // namespace

TEST_CASE("library errors: a library's reason in one line, of the kind that was asked for") {
    CHECK_THROWS_WITH_AS(rethrow(std::runtime_error("no\nroom.")), "a.exr: cannot write: no; room", Error);
    try {
        rethrow(std::out_of_range("x"));
    } catch (const Error& error) {
        CHECK(error.kind() == ErrorKind::kIo);
    }
}

TEST_CASE("library errors: ours and a lack of memory pass, and so does the result") {
    CHECK_THROWS_WITH_AS(rethrow(Error(ErrorKind::kUnsupported, "deep")), "deep", Error);
    CHECK_THROWS_AS(rethrow(std::bad_alloc()), std::bad_alloc);
    CHECK(translate_errors(ErrorKind::kIo, "a", [] { return 7; }) == 7);
}

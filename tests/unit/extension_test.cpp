#include <doctest/doctest.h>

#include "formats/files/extension.h"

using namespace imgmesh;

TEST_CASE("extension: lower case, with the dot, of the last part of the path alone") {
    CHECK(lower_extension("a.glb") == ".glb");
    CHECK(lower_extension("folder.d/A.PnG") == ".png");
    CHECK(lower_extension("a.tar.GZ") == ".gz");
    CHECK(lower_extension("a.") == ".");
}

TEST_CASE("extension: none for a bare name, a folder's dot and a hidden file") {
    for (const char* path : {"", "a", "folder.d/a", ".png", "x/.png", "..", "x/"}) {
        INFO(std::string(path));
        CHECK(lower_extension(path).empty());
    }
}

// Bytes of UTF-8 are no letters, whatever the locale says of them alone.
TEST_CASE("extension: letters beyond ASCII stay") {
    CHECK(lower_extension("a.\xC3\x84X") == ".\xC3\x84x");
}

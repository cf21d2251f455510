#include "formats/files/atomic_file.h"

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <optional>

#include <csignal>
#include <filesystem>

#include "libcore/base/error.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;
namespace fs = std::filesystem;

namespace {

using Bytes = std::vector<std::uint8_t>;

std::size_t entries(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

std::optional<ErrorKind> code_of(const auto& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.kind();
    }
    return std::nullopt;
}

}  // namespace

TEST_CASE("atomic file: appears with commit, and without it nothing stays") {
    const TemporaryFolder folder;
    const std::string path = folder / "a b.txt";
    {
        AtomicFile file(path, true);
        file.write(Bytes{1, 2, 3, 4});
        file.write(Bytes{5, 6});  // replaces
        CHECK_FALSE(fs::exists(path));
        CHECK(fs::path(file.temporary_path()).extension() == ".txt");
        CHECK(fs::path(file.temporary_path()).parent_path() == folder.path());
        file.commit();
    }
    CHECK(read_file(path, 100) == Bytes{5, 6});
    {
        AtomicFile file(path, true);
        file.write(Bytes{7});
    }
    CHECK(read_file(path, 100) == Bytes{5, 6});
    CHECK(entries(folder.path()) == 1);
}

TEST_CASE("atomic file: does not overwrite unless told to, not even at the last moment") {
    const TemporaryFolder folder;
    const std::string path = folder / "x";
    AtomicFile late(path, false);
    AtomicFile first(path, false);
    first.write(Bytes{1});
    first.commit();
    CHECK(code_of([&] { late.commit(); }) == ErrorKind::kIo);
    CHECK(code_of([&] { AtomicFile(path, false); }) == ErrorKind::kIo);
    CHECK(read_file(path, 1) == Bytes{1});
}

TEST_CASE("atomic file: devices, folders and missing folders are refused, links are followed") {
    const TemporaryFolder folder;
    CHECK(code_of([&] { AtomicFile("/dev/null", true); }) == ErrorKind::kIo);
    CHECK(code_of([&] { AtomicFile(folder.path().string(), true); }) == ErrorKind::kIo);
    CHECK(code_of([&] { AtomicFile(folder / "no/such/folder", true); }) == ErrorKind::kIo);

    const std::string target = folder / "target", link = folder / "link";
    AtomicFile(target, true).commit();
    fs::create_symlink(target, link);
    AtomicFile file(link, true);
    file.write(Bytes{9});
    file.commit();
    CHECK(fs::is_symlink(link));
    CHECK(read_file(target, 1) == Bytes{9});
}

TEST_CASE("atomic file: a killed process leaves nothing behind") {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const TemporaryFolder folder;
        const pid_t child = ::fork();
        if (child == 0) {
            ::signal(signal, SIG_DFL);  // doctest has handlers of its own
            remove_temporaries_on_signals();
            AtomicFile file(folder / "x", true);
            file.write(Bytes{1});
            if (entries(folder.path()) == 1) ::raise(signal);
            ::_exit(1);
        }
        int status = 0;
        REQUIRE(::waitpid(child, &status, 0) == child);
        CHECK(WIFSIGNALED(status));
        CHECK(WTERMSIG(status) == signal);
        CHECK(entries(folder.path()) == 0);
    }
}

TEST_CASE("read_file: limits and errors") {
    const TemporaryFolder folder;
    CHECK(code_of([&] { read_file(folder / "none", 10); }) == ErrorKind::kIo);
    CHECK(code_of([&] { read_file(folder.path().string(), 10); }) == ErrorKind::kIo);
    AtomicFile file(folder / "x", true);
    file.write(Bytes(11, 1));
    file.commit();
    CHECK(code_of([&] { read_file(folder / "x", 10); }) == ErrorKind::kBadFile);
    CHECK(read_file(folder / "x", 11).size() == 11);
    CHECK(code_of([&] { read_file("/dev/zero", 1000); }) == ErrorKind::kBadFile);
}

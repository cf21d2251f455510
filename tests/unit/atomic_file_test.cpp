#include "formats/files/atomic_file.h"

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <optional>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "formats/files/stale_temporaries.h"
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

TEST_CASE("atomic file: a replaced file keeps its permissions, a new one may be shared like another") {
    const TemporaryFolder folder;
    const std::string path = folder / "x", other = folder / "y";
    const auto mode = [](const std::string& file) { return fs::status(file).permissions(); };
    AtomicFile(path, true).commit();
    for (const auto wanted : {fs::perms(0640), fs::perms(0600), fs::perms(0444), fs::perms(0666)}) {
        fs::permissions(path, wanted);
        AtomicFile(path, true).commit();
        CHECK(mode(path) == wanted);
        AtomicFile file(other, true);
        file.share_as(path);
        file.commit();
        CHECK(mode(other) == wanted);
        fs::remove(other);
    }
    struct stat info = {};
    if (::geteuid() == 0 && ::chown(path.c_str(), 0, 33) == 0) {
        AtomicFile(path, true).commit();
        REQUIRE(::stat(path.c_str(), &info) == 0);
        CHECK(info.st_gid == 33);
    }
}

TEST_CASE("atomic file: a temporary that somebody exchanges is neither written nor kept") {
    const TemporaryFolder folder;
    const std::string path = folder / "x", target = folder / "target";
    AtomicFile(target, true).commit();
    AtomicFile file(path, true);
    for (const fs::directory_entry& entry : fs::directory_iterator(folder.path()))
        if (entry.path() != target) {
            fs::remove(entry.path());
            fs::create_symlink(target, entry.path());
        }
    file.write(Bytes{1, 2, 3});
    CHECK(code_of([&] { file.commit(); }) == ErrorKind::kIo);
    CHECK(read_file(target, 10).empty());
    CHECK_FALSE(fs::exists(path));
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

TEST_CASE(
    "temporaries that nobody has claimed go at once, those of a living run and other hidden files stay") {
    const TemporaryFolder folder;
    const std::string left = folder / ".imgmesh-12-3.json", other = folder / ".imgmesh-done.jsonl";
    for (const std::string& path : {left, other}) std::ofstream(path) << "{}";
    AtomicFile living(folder / "x.json", true);
    living.write(Bytes{1});
    remove_stale_temporaries(folder.path().string());
    CHECK(fs::exists(left));  // a run on another machine may have it
    remove_unclaimed_temporaries(folder.path().string());
    CHECK_FALSE(fs::exists(left));
    CHECK(fs::exists(other));
    living.commit();
    CHECK(entries(folder.path()) == 2);
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
    CHECK(code_of([&] { read_file("/dev/zero", 1000); }) == ErrorKind::kIo);
    // Opening a named pipe without a writer would wait.
    const std::string pipe = folder / "pipe";
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    CHECK(code_of([&] { read_file(pipe, 1000, FileKind::kRegular); }) == ErrorKind::kIo);
}

TEST_CASE("JointFiles: all get their names, or none does") {
    const TemporaryFolder folder;
    const auto write = [&](const char* name) {
        AtomicFile file(folder / name, true);
        file.write(Bytes{1, 2});
        file.commit();
    };
    {
        JointFiles together;
        write("a");
        write("b");
        CHECK_FALSE(fs::exists(folder / "a"));
        together.commit();
        CHECK(fs::exists(folder / "a"));
        CHECK(fs::exists(folder / "b"));
    }
    write("c");  // alone again
    CHECK(fs::exists(folder / "c"));
    {
        JointFiles together;
        write("d");
        write("e");
        fs::create_directory(folder / "e");  // by somebody else, meanwhile
        CHECK_THROWS_AS(together.commit(), Error);
    }
    CHECK_FALSE(fs::exists(folder / "d"));
    {
        JointFiles never;
        write("f");
    }
    CHECK_FALSE(fs::exists(folder / "f"));
    {
        JointFiles together;
        AtomicFile first(folder / "g", true);
        first.place();
        first.keep();
        write("h");
        fs::create_directory(folder / "h");
        std::string text;
        try {
            together.commit();
        } catch (const Error& error) {
            text = error.what();
        }
        CHECK(text.find("written before: " + (folder / "g")) != std::string::npos);
    }
    CHECK(entries(folder.path()) == 6);  // and no temporary files
}

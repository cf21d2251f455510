// mutation-run COUNT [SEED [FOLDER]]: COUNT mutated inputs of all targets (targets.h) through their readers.
// Fails on a crash, on a hang of more than 10 s, on more than 2 GiB, and on an exception that no reader
// documents; the input is then kept in FOLDER (default: the working folder). The same inputs for the same
// SEED. mutation-run --replay FOLDER: every file there, which is named after its target: container-*, png-*.
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>

#include "tests/fuzz/targets.h"

namespace fs = std::filesystem;
using namespace imgmesh::fuzz;

namespace {

constexpr unsigned kSeconds = 10;
constexpr rlim_t kBytes = rlim_t{2} << 30;
constexpr std::uint32_t kBlock = 200;  // inputs for one child process

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // whose shadow memory takes terabytes of addresses
#else
constexpr bool kSanitized = false;
#endif

// A third are containers. imgmesh does not read the formats of imgmesh-codecs in its own process.
Target target_at(std::uint32_t index) {
    constexpr Target kShares[] = {Target::kContainer, Target::kPng,     Target::kJpeg,   Target::kContainer,
                                  Target::kTiff,      Target::kExr,     Target::kWebp,   Target::kContainer,
                                  Target::kBmp,       Target::kTga,     Target::kPnm,    Target::kEdits,
                                  Target::kContainer, Target::kProfile, Target::kConfig, Target::kCompact,
                                  Target::kCoded};
    return kShares[index % std::size(kShares)];
}

Bytes input(Target target, std::uint32_t seed, const std::vector<Bytes>& good) {
    Mutator mutator(seed);
    const Bytes& start = good[mutator.below(good.size())];
    return mutated(target, start, mutator);
}

// Shared with the child, so that it is known which input a child died of.
struct Progress {
    std::uint32_t index;
    std::uint32_t accepted;
    std::uint32_t failed;
};

// What a child does: the inputs [progress.index, end).
template <typename Input>
void run_block(Progress& progress, std::uint32_t end, Input&& at) {
    if (!kSanitized) {
        const rlimit limit = {kBytes, kBytes};
        ::setrlimit(RLIMIT_AS, &limit);
    }
    for (; progress.index < end; ++progress.index) {
        const auto [target, bytes] = at(progress.index);
        ::alarm(kSeconds);
        try {
            progress.accepted += feed(target, bytes);
        } catch (const std::exception& e) {
            std::cerr << "input " << progress.index << " (" << name_of(target) << "): " << e.what()
                      << std::endl;
            ::_exit(9);
        }
        ::alarm(0);
    }
    ::_exit(0);
}

// Runs all inputs in children; tells `failed` of each that one died of.
template <typename Input, typename Failed>
Progress run_all(std::uint32_t count, Input&& at, Failed&& failed) {
    auto* progress = static_cast<Progress*>(
        ::mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
    if (progress == MAP_FAILED) throw std::runtime_error("mmap");
    *progress = {};
    while (progress->index < count) {
        const std::uint32_t end = std::min(count, progress->index + kBlock);
        const pid_t child = ::fork();
        if (child < 0) throw std::runtime_error("fork");
        if (child == 0) run_block(*progress, end, at);
        int status = 0;
        ::waitpid(child, &status, 0);
        if (status == 0) continue;
        std::cerr << "input " << progress->index << ": "
                  << (WIFSIGNALED(status) ? ::strsignal(WTERMSIG(status)) : "refused wrongly") << std::endl;
        ++progress->failed;
        failed(progress->index);
        ++progress->index;
    }
    return *progress;
}

int replay(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().filename() != "README.md") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    const auto at = [&](std::uint32_t i) {
        std::ifstream in(files[i], std::ios::binary);
        const Bytes bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
        const std::string name = files[i].filename().string();
        const std::optional<Target> target = target_of(name.substr(0, name.find('-')));
        if (!target) throw std::runtime_error(name + ": not named after a target");
        return std::pair(*target, bytes);
    };
    const Progress done = run_all(static_cast<std::uint32_t>(files.size()), at,
                                  [&](std::uint32_t i) { std::cerr << files[i] << std::endl; });
    std::cout << files.size() << " files, " << done.failed << " failures\n";
    return done.failed > 0 || files.empty();
}

int mutate(std::uint32_t count, std::uint32_t seed, const fs::path& folder) {
    std::map<Target, std::vector<Bytes>> good;
    for (int t = 0; t <= static_cast<int>(kLastTarget); ++t) {
        const auto target = static_cast<Target>(t);
        good[target] = seeds(target);
        for (const Bytes& bytes : good[target])
            if (!feed(target, bytes))
                throw std::runtime_error(std::string("a seed is refused: ") + name_of(target));
    }
    const auto at = [&](std::uint32_t i) {
        const Target target = target_at(i);
        return std::pair(target, input(target, seed + i, good[target]));
    };
    const Progress done = run_all(count, at, [&](std::uint32_t i) {
        const auto [target, bytes] = at(i);
        const fs::path path = folder / (std::string(name_of(target)) + "-" + std::to_string(seed + i));
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        std::cerr << "kept as " << path << std::endl;
    });
    std::cout << count << " inputs, " << done.accepted << " accepted, " << done.failed << " failures\n";
    return done.failed > 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc == 3 && std::string(argv[1]) == "--replay") return replay(argv[2]);
        if (argc < 2 || argc > 4)
            throw std::runtime_error("usage: mutation-run COUNT [SEED [FOLDER]] | --replay FOLDER");
        return mutate(static_cast<std::uint32_t>(std::stoul(argv[1])),
                      argc > 2 ? static_cast<std::uint32_t>(std::stoul(argv[2])) : 1,
                      argc > 3 ? argv[3] : ".");
    } catch (const std::exception& e) {
        std::cerr << "mutation-run: " << e.what() << '\n';
        return 2;
    }
}

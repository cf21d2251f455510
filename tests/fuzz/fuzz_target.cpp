// libFuzzer's program for all readers, with the mutations of mutate.h beside libFuzzer's own. The name that
// it is started by tells the reader: fuzz-png and so on. With an empty corpus it starts from seeds().
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>

#include "tests/fuzz/targets.h"

using namespace imgmesh::fuzz;

namespace {
std::optional<Target> target;
}

extern "C" int LLVMFuzzerInitialize(int*, char*** argv) {
    const std::string name = std::filesystem::path((*argv)[0]).filename().string();
    if (name.starts_with("fuzz-")) target = target_of(name.substr(5));
    if (target) return 0;
    std::cerr << name << " is no reader's name: run fuzz-png or another of its kind" << std::endl;
    std::exit(2);
}

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        feed(*target, {data, size});
    } catch (const std::exception& e) {
        std::cerr << e.what() << std::endl;
        std::abort();
    }
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
    static const std::vector<Bytes> good = seeds(*target);
    Mutator mutator(seed);
    Bytes bytes(data, data + size);
    if (size < 16 || mutator.below(64) == 0) bytes = good[mutator.below(good.size())];
    // Libfuzzer's own mutations know what comparisons failed.
    if (mutator.below(3) == 0) {
        std::copy_n(bytes.begin(), std::min(bytes.size(), max_size), data);
        return LLVMFuzzerMutate(data, std::min(bytes.size(), max_size), max_size);
    }
    bytes = mutated(*target, bytes, mutator);
    const std::size_t length = std::min(bytes.size(), max_size);
    std::copy_n(bytes.begin(), length, data);
    return length;
}

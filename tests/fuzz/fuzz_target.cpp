// One libFuzzer target per reader (IMGMESH_FUZZ_TARGET), with the mutations of mutate.h beside libFuzzer's
// own. With an empty corpus it starts from seeds().
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>

#include "tests/fuzz/targets.h"

using namespace imgmesh::fuzz;

namespace {
constexpr Target kTarget = Target::IMGMESH_FUZZ_TARGET;
}

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        feed(kTarget, {data, size});
    } catch (const std::exception& e) {
        std::cerr << e.what() << std::endl;
        std::abort();
    }
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
    static const std::vector<Bytes> good = seeds(kTarget);
    Mutator mutator(seed);
    Bytes bytes(data, data + size);
    if (size < 16 || mutator.below(64) == 0) bytes = good[mutator.below(good.size())];
    // Libfuzzer's own mutations know what comparisons failed.
    if (mutator.below(3) == 0) {
        std::copy_n(bytes.begin(), std::min(bytes.size(), max_size), data);
        return LLVMFuzzerMutate(data, std::min(bytes.size(), max_size), max_size);
    }
    if (kTarget == Target::kContainer)
        bytes = mutator.glb(bytes);
    else if (kTarget == Target::kPicture || kTarget == Target::kSmall)
        bytes = mutator.any(bytes);
    else {
        const std::string text = mutator.json_text({bytes.begin(), bytes.end()});
        bytes.assign(text.begin(), text.end());
    }
    const std::size_t length = std::min(bytes.size(), max_size);
    std::copy_n(bytes.begin(), length, data);
    return length;
}

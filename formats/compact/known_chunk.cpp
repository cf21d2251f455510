#include "formats/compact/known_chunk.h"

#include <algorithm>

namespace imgmesh::compact {
namespace {

using Short8 = std::int16_t __attribute__((vector_size(16)));
using UShort8 = std::uint16_t __attribute__((vector_size(16)));

template <typename V, typename T>
IMGMESH_INLINE V load(const T* from) {
    V v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
}
template <typename V, typename T>
IMGMESH_INLINE void store(T* to, V v) {
    __builtin_memcpy(to, &v, sizeof v);
}
IMGMESH_INLINE Int8 load_wide(const std::int16_t* from) {
    return __builtin_convertvector(load<Short8>(from), Int8);
}
template <typename T>
IMGMESH_INLINE void store_narrow(T* to, Int8 v) {
    store(to, __builtin_convertvector(v, Short8));
}

// The functions of residual_model.h, for eight numbers. A comparison is -1 where it holds.
IMGMESH_INLINE Int8 wholes_of(Int8 predicted) {
    return (predicted + (1 << (kTapBits - 1))) >> kTapBits;
}
IMGMESH_INLINE Int8 magnitudes(Int8 v) {
    const Int8 sign = v >> 31;
    return (v ^ sign) - sign;
}
IMGMESH_INLINE Int8 wrapped(Int8 v) {
    return (v << 16) >> 16;
}
IMGMESH_INLINE Int8 numbers_of(Int8 residual, Int8 magnitude, Int8 predicted) {
    const Int8 turn = (predicted << (32 - kTapBits)) >> 31, turned = (residual ^ turn) - turn;
    return 2 * magnitude + (turned > 0);
}
IMGMESH_INLINE Int8 first_contexts(Int8 predicted, Int8 whole) {
    const Int8 rest = magnitudes(predicted - (whole << kTapBits));
    return ((rest > 31) & kLevels) + ((rest > 79) & kLevels);
}
// A float's exponent and the bit behind its leading one are the level of what it stands for, from 2 on.
IMGMESH_INLINE Int8 levels_of(Int8 energy) {
    constexpr int kExponentOfOne = 2 * 127;
    const Int8 level =
        (reinterpret_cast<Int8>(__builtin_convertvector(energy, Float8)) >> 22) - kExponentOfOne;
    const Int8 low = energy > 1 ? Int8{} + 1 : energy;
    return level > low ? level : low;
}
IMGMESH_INLINE Int8 tokens_of(Int8 number) {
    Int8 token = number < kPlainTokens ? number : Int8{} + (kPlainTokens - 1);
#pragma GCC unroll 8
    for (std::size_t k = 0; k < kTokenFirst.size(); ++k) token -= number >= kTokenFirst.data()[k];
    return token;
}

// A row of the chunk with the two pixels on its left.
template <typename T>
struct WithLeft {
    static constexpr int kLeft = 8;
    T all[kLeft + Chunk::kPixels + 8];
    T* get() { return all + kLeft; }
    WithLeft(int w, int ww) {
        get()[-1] = static_cast<T>(w);
        get()[-2] = static_cast<T>(ww);
    }
};

struct Finder {
    Lane& lane;
    Chunk& chunk;
    ChunkTokens& found;
    WithLeft<std::int16_t> values[2], sizes[2];
    Chunk::Pixels<std::int16_t> contexts[2];  // of the lowest level

    IMGMESH_INLINE Finder(Lane& of, ChunkTokens& to)
        : lane(of),
          chunk(*of.chunk),
          found(to),
          values{{of.x.w, of.x.ww}, {of.y.w, of.y.ww}},
          sizes{{of.x.size_w, of.x.size_ww}, {of.y.size_w, of.y.size_ww}} {}

    IMGMESH_INLINE Int8 predicted(std::size_t k, const ComponentLane& left, int i) {
        const std::int16_t* value = values[k].get() + i;
        return load<Int8>(chunk.prediction.data()[k].data() + i) + left.tap_w * load_wide(value - 1) +
               left.tap_ww * load_wide(value - 2);
    }

    // Finds the number that the prediction leaves. Returns the value and the prediction's whole number.
    IMGMESH_INLINE Int8 leave(std::size_t k, Int8 predicted, Int8 value, int i) {
        const Int8 whole = wholes_of(predicted), residual = wrapped(value - whole),
                   magnitude = magnitudes(residual),
                   size = magnitude < kMaxMagnitude ? magnitude : Int8{} + kMaxMagnitude;
        store(found.numbers.data()[k].data() + i, numbers_of(residual, magnitude, predicted));
        store_narrow(contexts[k].data() + i, first_contexts(predicted, whole));
        store_narrow(sizes[k].get() + i, size);
        return whole;
    }

    IMGMESH_INLINE void find_numbers(int i) {
        const Int8 x = load_wide(values[0].get() + i), y = load_wide(values[1].get() + i);
        const Int8 predicted_x = predicted(0, lane.x, i), whole_x = leave(0, predicted_x, x, i);
        store_narrow(chunk.plain.data()[0].data() + i, wrapped(x - whole_x));

        // The product has more than 32 bits, so the bits that are shifted out are multiplied alone.
        const Int8 exact_x = (x << kTapBits) - predicted_x, slope = load_wide(chunk.slope.data() + i),
                   plain_y = predicted(1, lane.y, i),
                   predicted_y = plain_y + slope * (exact_x >> kSlopeBits) +
                                 ((slope * (exact_x & ((1 << kSlopeBits) - 1))) >> kSlopeBits);
        leave(1, predicted_y, y, i);
        store_narrow(chunk.plain.data()[1].data() + i, wrapped(y - wholes_of(plain_y)));
    }

    // Needs the sizes on the left.
    IMGMESH_INLINE void find_contexts(int i) {
        const auto above = [&](std::size_t k) {
            const std::int16_t* size = sizes[k].get() + i;
            return load<Short8>(chunk.energy.data()[k].data() + i) + 4 * load<Short8>(size - 1) +
                   2 * load<Short8>(size - 2);
        };
        const Short8 energy_y = above(1),
                     energies[2] = {static_cast<Short8>(above(0) + (energy_y >> 3)),
                                    static_cast<Short8>(energy_y + 2 * load<Short8>(sizes[0].get() + i))};
        for (std::size_t k = 0; k < 2; ++k) {
            const Int8 level = levels_of(__builtin_convertvector(energies[k], Int8)),
                       context = load_wide(contexts[k].data() + i) + level,
                       token = tokens_of(load<Int8>(found.numbers.data()[k].data() + i));
            store_narrow(found.tokens.data()[k].data() + i, context * kTokens + token);
        }
    }

    IMGMESH_INLINE void find(int count) {
        const auto pixels = static_cast<std::size_t>(count);
        for (std::size_t k = 0; k < 2; ++k)
            std::copy_n(chunk.value.data()[k].data(), pixels, values[k].get());
        for (int i = 0; i < count; i += 8) find_numbers(i);
        for (int i = 0; i < count; i += 8) find_contexts(i);
        for (std::size_t k = 0; k < 2; ++k) {
            std::copy_n(sizes[k].get(), pixels, chunk.size.data()[k].data());
            ComponentLane& left = k == 0 ? lane.x : lane.y;
            left.w = values[k].get()[count - 1];
            left.ww = values[k].get()[count - 2];
            left.size_w = sizes[k].get()[count - 1];
            left.size_ww = sizes[k].get()[count - 2];
        }
    }
};

#if defined(__x86_64__)
__attribute__((target("avx2"))) void find_tokens_avx2(Lane& lane, int count, ChunkTokens& found) {
    Finder(lane, found).find(count);
}
const bool kAvx2 = has_avx2();
#endif

}  // namespace

void find_tokens(Lane& lane, int count, ChunkTokens& found) {
#if defined(__x86_64__)
    if (kAvx2) return find_tokens_avx2(lane, count, found);
#endif
    Finder(lane, found).find(count);
}

}  // namespace imgmesh::compact

// Colours of a coded mesh: what is coded comes back, and the encoder's choice draws the picture.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "libcore/coding/color_model.h"
#include "libcore/coding/color_transform.h"
#include "libcore/coding/integer_math.h"
#include "libcore/coding/later_bits.h"
#include "libcore/coding/quantise_colors.h"
#include "libcore/coding/range_coder.h"
#include "tests/support/coded_shapes.h"

using namespace imgmesh;
using namespace imgmesh::coding;

namespace {

struct Coded {
    std::vector<int> level;
    std::vector<std::int32_t> value;
};

template <class Coder>
Coded code(Coder& coder, const ColorPlan& plan, int channels, const std::array<std::int32_t, 4>& steps,
           std::vector<int> level) {
    ColorModel model(plan, channels, steps);
    const std::size_t depth = as_index(channels);
    for (std::size_t i = 0; i < level.size(); ++i)
        level[i] = model.code(coder, i / depth, model.guess(i / depth, i % depth), level[i]);
    return {level, {model.values().begin(), model.values().end()}};
}

// Waves of two lengths in each channel, with an edge.
std::vector<float> picture(const CodedGrid& grid, int channels) {
    std::vector<float> out;
    for (int y = 0; y < grid.height; ++y)
        for (int x = 0; x < grid.width; ++x)
            for (int c = 0; c < channels; ++c)
                out.push_back(static_cast<float>(120 + 50 * std::sin(0.2 * x + c) +
                                                 30 * std::cos(0.3 * y - c) + (x > y ? 40 : 0)));
    return out;
}

}  // namespace

TEST_CASE("coded channels are orthonormal and come back in integers") {
    std::mt19937 random(3);
    for (int i = 0; i < 1000; ++i) {
        std::array<double, 4> real{};
        std::array<std::int32_t, 4> whole{};
        double before = 0, after = 0;
        for (double& r : real) {
            r = static_cast<double>(random() % (256 * kColorUnit));
            before += r * r;
        }
        const std::array<double, 4> wanted = real;
        to_coded(real);
        for (std::size_t c = 0; c < 4; ++c) {
            after += real[c] * real[c];
            whole[c] = static_cast<std::int32_t>(std::lround(real[c]));
        }
        CHECK(after == doctest::Approx(before));
        from_coded(whole);
        for (std::size_t c = 0; c < 4; ++c) CHECK(std::abs(whole[c] - wanted[c]) < 2.5);
    }
}

TEST_CASE("powers of two have exact logarithms, and others are near") {
    for (int i = 0; i < 50; ++i) CHECK(log2_of(std::uint64_t{1} << i) == 256 * i);
    for (int i = 0; i < 14; ++i) CHECK(half_power(1024 * i) == 1 << (14 - i));
    for (std::uint64_t n = 1; n < 100000; n += 7)
        REQUIRE(std::abs(log2_of(n) - 256 * std::log2(static_cast<double>(n))) < 1.5);
    for (int t = 0; t < 4096; ++t) REQUIRE(std::abs(half_power(t) - 16384 * std::exp2(-t / 1024.0)) < 6);
    CHECK(floor_divide(-7, 2) == -4);
    CHECK(rounded_divide(-7, 2) == -3);
    for (std::int64_t n = 1; n < (std::int64_t{1} << 25); n = 2 * n + 1)
        for (const std::int64_t square : {n * n - 1, n * n})
            CHECK(floor_root(square) == n - (square < n * n));
}

TEST_CASE("levels come back as they were, whatever they are") {
    std::mt19937 random(4);
    for (const auto& [width, height] : {std::array{1, 1}, {1, 9}, {9, 1}, {2, 2}, {40, 30}})
        for (int channels = 1; channels <= 4; ++channels)
            for (const int range : {1, 3, 30, 5000}) {
                const CrossedLines lines({width, height, 3}, 8, random);
                const ColorPlan plan = plan_colors(lines.shape());
                const std::array<std::int32_t, 4> steps{range > 100 ? 1 : 300, 200, 100,
                                                        ColorGuesser::kMaxStep};
                std::vector<int> level;
                for (std::size_t i = 0; i < lines.point.size() * as_index(channels); ++i)
                    level.push_back(static_cast<int>(random() % as_index(2 * range + 1)) - range);
                RangeEncoder encoder;
                const Coded in = code(encoder, plan, channels, steps, level);
                const std::vector<std::uint8_t> bytes = encoder.finish();
                RangeDecoder decoder(bytes);
                const Coded out = code(decoder, plan, channels, steps, std::vector<int>(level.size()));
                REQUIRE(out.level == level);
                REQUIRE(out.value == in.value);
                CHECK(decoder.missing() <= 4);
            }
}

// Any bytes decode to some colours; they stay within what the drawing takes.
TEST_CASE("colours of random bytes are within bounds") {
    std::mt19937 random(5);
    for (int i = 0; i < 200; ++i) {
        const CrossedLines lines({20, 20, 1}, 9, random);
        std::vector<std::uint8_t> bytes;
        for (int k = 0; k < 300; ++k) bytes.push_back(static_cast<std::uint8_t>(random()));
        RangeDecoder decoder(bytes);
        const std::int32_t step = 1 << (random() % 15);
        Coded out = code(decoder, plan_colors(lines.shape()), 3, {step, step, step, step},
                         std::vector<int>(3 * lines.point.size()));
        for (std::size_t k = 0; k < out.value.size(); k += 3) from_coded(std::span(out.value).subspan(k, 3));
        for (const std::int32_t value : out.value) REQUIRE(std::abs(value) <= kMaxColor);
    }
}

TEST_CASE("moments count every pixel as much as it weighs") {
    std::mt19937 random(8);
    const CrossedLines lines({33, 21, 2}, 7, random);
    const std::vector<float> image = picture(lines.grid, 3);
    std::vector<float> weights;
    for (int i = 0; i < 33 * 21; ++i) weights.push_back(static_cast<float>(i % 5));
    double ones = 0, sum = 0, squares = 0, all = 0, all_sum = 0, all_squares = 0;
    for (const FaceMoments& m : face_moments(lines.shape(), image, 3, weights)) {
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) ones += m.ww[i][j];
            for (const double wi : m.wi[i]) sum += wi;
        }
        squares += m.ii;
    }
    for (std::size_t i = 0; i < weights.size(); ++i) {
        all += weights[i];
        for (std::size_t c = 0; c < 3; ++c) {
            all_sum += double{weights[i]} * image[3 * i + c];
            all_squares += double{weights[i]} * image[3 * i + c] * image[3 * i + c];
        }
    }
    CHECK(ones == doctest::Approx(all));
    CHECK(sum == doctest::Approx(all_sum));
    CHECK(squares == doctest::Approx(all_squares));
}

TEST_CASE("moments count every pixel once, and their fit has the error of the drawing") {
    std::mt19937 random(6);
    for (int channels = 1; channels <= 4; ++channels) {
        const CrossedLines lines({33, 21, 2}, 7, random);
        const std::vector<float> image = picture(lines.grid, channels);
        const auto moments = face_moments(lines.shape(), image, channels);
        double ones = 0, squares = 0, sum = 0;
        for (const FaceMoments& m : moments) {
            for (std::size_t i = 0; i < 3; ++i) {
                for (std::size_t j = 0; j < 3; ++j) ones += m.ww[i][j];
                for (const double wi : m.wi[i]) sum += wi;
            }
            squares += m.ii;
        }
        double all = 0, all_squares = 0;
        for (const float value : image) {
            all += value;
            all_squares += double{value} * value;
        }
        CHECK(ones == doctest::Approx(33 * 21));
        CHECK(sum == doctest::Approx(all));
        CHECK(squares == doctest::Approx(all_squares));

        const ColorPlan plan = plan_colors(lines.shape());
        ColorChoice choice;
        choice.steps = {20, 20, 20, 20};
        const QuantisedColors colors = quantise_colors(lines.shape(), plan, moments, channels, choice);
        std::vector<std::int32_t> value = colors.value;
        for (std::size_t i = 0; i < value.size(); i += as_index(channels))
            from_coded(std::span(value).subspan(i, as_index(channels)));
        if (channels % 2 == 0) continue;  // the drawing divides by alpha
        const auto drawn = draw_coded(lines.shape(), value, channels, 33, 21);
        double error = 0;
        for (std::size_t i = 0; i < drawn.size(); ++i) error += (drawn[i] - image[i]) * (drawn[i] - image[i]);
        CHECK(colors.error == doctest::Approx(error).epsilon(0.02));
    }
}

TEST_CASE("bits are counted as they are written, and a price of bits saves them") {
    std::mt19937 random(7);
    const CrossedLines lines({200, 150, 4}, 20, random);
    const ColorPlan plan = plan_colors(lines.shape());
    const auto moments = face_moments(lines.shape(), picture(lines.grid, 3), 3);
    ColorChoice choice;
    choice.steps = {400, 400, 400, 400};
    const QuantisedColors free = quantise_colors(lines.shape(), plan, moments, 3, choice);
    RangeEncoder encoder;
    const Coded coded = code(encoder, plan, 3, choice.steps, free.level);
    CHECK(coded.value == free.value);
    CHECK(static_cast<double>(8 * encoder.finish().size()) == doctest::Approx(free.bits).epsilon(0.02));
    choice.bit_price = 100;
    const QuantisedColors priced = quantise_colors(lines.shape(), plan, moments, 3, choice);
    CHECK(priced.bits < free.bits);
    CHECK(priced.error > free.error);
}

TEST_CASE("a constant picture takes its first colour only") {
    std::mt19937 random(8);
    const CrossedLines lines({50, 40, 4}, 9, random);
    const std::vector<float> grey(50 * 40 * 3, 90.0f);
    ColorChoice choice;
    choice.steps = {64, 64, 64, 64};
    choice.bit_price = 1;
    const QuantisedColors out = quantise_colors(lines.shape(), plan_colors(lines.shape()),
                                                face_moments(lines.shape(), grey, 3), 3, choice);
    CHECK(out.bits < 60);
}

TEST_CASE("a plan has the neighbours before a vertex, and steps by the areas of stars") {
    // Two columns of three rows, 1 and 7 pixels apart.
    const CodedGrid grid{9, 9, 4};
    const std::vector<GridPoint> point{{0, 0}, {8, 0}, {0, 1}, {8, 1}, {0, 8}, {8, 8}};
    const std::vector<Face> faces{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}};
    const ColorPlan plan = plan_colors({grid, point, faces});
    CHECK(plan.of(0).empty());
    REQUIRE(plan.of(3).size() == 2);
    CHECK(plan.of(3)[0].vertex == 2);
    CHECK(plan.of(3)[1].vertex == 1);
    for (std::size_t v = 1; v < 6; ++v) {
        std::int32_t most = 0;
        for (const auto& n : plan.of(v)) most = std::max(most, n.weight);
        CHECK(most == 4096);
    }
    // Doubled areas: 8 for vertex 0, 64 on average.
    CHECK(plan.fineness[0] == static_cast<std::int32_t>(4096 * std::sqrt(8.0)));
    CHECK(plan.fineness[5] == static_cast<std::int32_t>(64 * std::sqrt(std::floor(4096 * 64.0 / 56))));
}

TEST_CASE("a colour like that of its followers costs nothing later, and more the less it is like them") {
    std::mt19937 random(9);
    const CrossedLines lines({30, 30, 4}, 5, random);
    const ColorPlan plan = plan_colors(lines.shape());
    const std::vector<double> value(lines.point.size(), 90.0);
    LaterBits later(plan, 1, 8.0);
    for (std::size_t v = 0; v + 1 < lines.point.size(); ++v) {
        later.look_at(v, value);
        CHECK(later(0, 90) == doctest::Approx(0));
        CHECK(later(0, 95) > 0);
        CHECK(later(0, 110) > later(0, 95));
        CHECK(later(0, 85) == doctest::Approx(later(0, 95)));
    }
    later.look_at(lines.point.size() - 1, value);
    CHECK(later(0, 200) == 0);
}

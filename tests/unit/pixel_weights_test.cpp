// Weights of pixels for SSIM, and what they do to a coded picture.
#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "libcore/base/index.h"
#include "libcore/coding/coded_stream.h"
#include "libcore/coding/encode_picture.h"
#include "libcore/coding/error_space.h"
#include "libcore/coding/pixel_weights.h"

using namespace imgmesh;
using namespace imgmesh::coding;

namespace {

constexpr int kWidth = 96, kHeight = 64;

// Slow waves on the left; on the right noise, of which a mesh can draw little.
Bitmap half_noisy() {
    Bitmap picture{kWidth, kHeight, 3, {}};
    std::mt19937 random(1);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const int noise = x < kWidth / 2 ? 0 : static_cast<int>(random() % 201) - 100;
            const auto value = std::lround(128 + 20 * std::sin(0.2 * x) * std::cos(0.15 * y)) + noise;
            for (int k = 0; k < 3; ++k) picture.data.push_back(static_cast<std::uint8_t>(value));
        }
    return picture;
}

double error_on_the_left(const Bitmap& picture, Tune tune) {
    EncodeParams params;
    params.bytes = 500;
    params.effort = 1;
    params.tune = tune;
    const EncodedPicture coded = encode_picture(picture, params);
    REQUIRE(coded.bytes.size() <= 500);
    const StreamContent mesh = read_stream(coded.bytes);
    const auto drawn = draw_coded(mesh.shape(), mesh.color, 3, kWidth, kHeight);
    double sum = 0;
    for (std::size_t i = 0; i < drawn.size(); ++i)
        if (i / 3 % kWidth < kWidth / 2) sum += (drawn[i] - picture.data[i]) * (drawn[i] - picture.data[i]);
    return sum;
}

}  // namespace

TEST_CASE("weights have a mean of 1, are more where a picture is smooth, and are there for SSIM alone") {
    const Bitmap picture = half_noisy();
    const std::vector<float> samples = premultiplied(picture);
    const std::vector<float> weights = pixel_weights(picture, samples, Tune::kSsim);
    REQUIRE(weights.size() == as_index(kWidth * kHeight));
    CHECK(std::accumulate(weights.begin(), weights.end(), 0.0) / (kWidth * kHeight) == doctest::Approx(1));
    CHECK(weights[as_index(30 * kWidth + 20)] > 2 * weights[as_index(30 * kWidth + 76)]);
    CHECK(pixel_weights(picture, samples, Tune::kLuma).empty());
    CHECK(pixel_weights(picture, samples, Tune::kPsnr).empty());
}

TEST_CASE("pixels of one grey weigh the same, and pictures of one row have no weights") {
    for (const int channels : {1, 2, 3, 4}) {
        const Bitmap grey{20, 9, channels, std::vector<std::uint8_t>(as_index(20 * 9 * channels), 77)};
        for (const float w : pixel_weights(grey, premultiplied(grey), Tune::kSsim))
            CHECK(w == doctest::Approx(1));
        const Bitmap row{180, 1, channels, grey.data};
        CHECK(pixel_weights(row, premultiplied(row), Tune::kSsim).empty());
    }
}

TEST_CASE("the smooth half of a picture is drawn better for SSIM than for luma") {
    const Bitmap picture = half_noisy();
    const double luma = error_on_the_left(picture, Tune::kLuma);
    CHECK(error_on_the_left(picture, Tune::kSsim) < 0.8 * luma);
}

#include "libcore/pipeline/build_source.h"

#include <doctest/doctest.h>

#include "libcore/base/error.h"

using namespace imgmesh;

namespace {

std::string spelt(std::string_view name, std::string_view value) {
    return cat("<", name, "=", value, ">");
}

// Eight pixels in a row of one colour with these alphas.
Image row_of(const std::vector<float>& alphas) {
    Image image = make_image(static_cast<int>(alphas.size()), 1, 4);
    for (std::size_t p = 0; p < alphas.size(); ++p) image.pixel(p)[3] = alphas[p];
    return image;
}

std::string message_of(const Image& picture, const Image& image) {
    try {
        picture_mask(picture, image, "a.png", 0.5, spelt);
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

}  // namespace

// Alpha of 0 and 1 alone is a mask. Half transparent pixels are kept, unless another image is the mask.
TEST_CASE("plan_source: soft alpha becomes a channel, hard alpha a mask") {
    const Image hard = row_of({0, 0, 1, 1}), soft = row_of({0, 0.5, 0.5, 1});
    CHECK(plan_source(hard, {}, false, {}, spelt).alpha == AlphaUse::kCut);
    CHECK(plan_source(soft, {}, true, {}, spelt).alpha == AlphaUse::kIgnore);
    CHECK(plan_source(make_image(2, 2, 3), {AlphaUse::kKeep, {}}, false, {}, spelt).alpha ==
          AlphaUse::kIgnore);
    const SourcePlan plan = plan_source(soft, {}, false, {}, spelt);
    CHECK(plan.alpha == AlphaUse::kKeep);
    REQUIRE(plan.params.channels.size() == 4);
    CHECK(plan.params.channels[3].name == "A");
    CHECK(plan.params.channels[3].weight == kAlphaWeight);
    CHECK(plan.warnings.empty());
}

// Refinement cannot keep alpha. Who asks for both gets an error from the build; who asks for the rounds alone
// gets a mesh without them and is told so in the program's own words.
TEST_CASE("plan_source: rounds of refinement are left out for alpha that nobody has asked for") {
    BuildParams params;
    params.refine = 5;
    const Image soft = row_of({0, 0.5, 0.5, 1});
    const SourcePlan plan = plan_source(soft, {}, false, params, spelt);
    CHECK(plan.params.refine == 0);
    REQUIRE(plan.warnings.size() == 1);
    CHECK(plan.warnings[0].find("<alpha=cut> refines it") != std::string::npos);
    CHECK(plan_source(soft, {AlphaUse::kKeep, {}}, false, params, spelt).params.refine == 5);
}

TEST_CASE("source_mask: the pixels with the threshold's alpha; none is an error") {
    const Image image = row_of({0, 0.4f, 0.6f, 1});
    const SourcePlan plan = plan_source(image, {AlphaUse::kCut, {}}, false, {}, spelt);
    CHECK(source_mask(image, plan, spelt).values == std::vector<std::uint8_t>{0, 0, 1, 1});
    const Image clear = row_of({0, 0.1f});
    CHECK_THROWS_WITH_AS(
        source_mask(clear, plan_source(clear, {AlphaUse::kCut, {}}, false, {}, spelt), spelt),
        "no pixel is inside the mask: alpha is below 0.5 everywhere; <alpha=ignore> meshes "
        "the colours without it",
        Error);
}

// A mask that reaches no threshold names its largest value, and a threshold that takes it: half of that.
TEST_CASE("picture_mask: what is wrong with a mask is told") {
    Image picture = make_image(2, 1, 1);
    CHECK(message_of(picture, make_image(3, 1, 3)) == "the mask is 2x1, a.png is 3x1");
    CHECK(message_of(picture, make_image(2, 1, 3)) ==
          "no pixel is inside the mask: its largest value is 0 of 255, and pixels inside are above 0");
    picture.data[0] = 1.f / 255;
    CHECK(message_of(picture, make_image(2, 1, 3)) ==
          "no pixel is inside the mask: its largest value is 1 of 255, below the threshold of 0.5; "
          "<alpha-threshold=0.002> takes the mask");
}

#include "libcore/pipeline/param_table.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>

#include "libcore/pipeline/params.h"
#include "libcore/pipeline/presets.h"

using namespace imgmesh;

namespace {

const Param& row(const std::string& name) {
    const auto at = std::find_if(param_table().begin(), param_table().end(),
                                 [&](const Param& param) { return param.name == name; });
    REQUIRE(at != param_table().end());
    return *at;
}

std::map<std::string, std::string> listed(const BuildParams& params) {
    const SimplifyTarget target = collapse_targets(params, 1e4).front();
    const SimplifyParams collapse = collapse_params(params, target, 1e4);
    std::map<std::string, std::string> out;
    for (const auto& [name, value] : list_params(closed_params(params, collapse, WeightPrecision::kHalf)))
        out[name] = std::visit([](const auto& v) { return cat(v); }, value);
    return out;
}

}  // namespace

TEST_CASE("parameters: names are told apart, and exclude others that there are") {
    std::set<std::string> names;
    for (const Param& param : param_table()) CHECK(names.insert(param.name).second);
    for (const Param& param : param_table())
        for (const std::string& other : param.excludes) {
            INFO(param.name << " excludes " << other);
            CHECK(names.count(other) == 1);
            CHECK(other != param.name);
        }
}

// A row that reached another row's member, or none, would not give back what it has put there.
TEST_CASE("parameters: each row sets a member of its own") {
    for (const Param& param : param_table()) {
        if (param.name == "map-smoothness") continue;  // another row's member, by its reciprocal
        INFO(param.name);
        BuildParams params;
        std::visit(
            [&](const auto& kind) {
                using Kind = std::remove_cvref_t<decltype(kind)>;
                typename Kind::Value value{};
                if constexpr (std::is_same_v<Kind, ChannelsParam>)
                    value = {{"Z", 2}};
                else if constexpr (std::is_same_v<Kind, WordParam>)
                    value = (kind.get(params).value_or(kind.words.size() - 1) + 1) % kind.words.size();
                else if constexpr (std::is_same_v<Kind, FlagParam>)
                    value = true;
                else if constexpr (std::is_same_v<Kind, CountParam>)
                    value = kind.range.least + 3;
                else if constexpr (std::is_same_v<Kind, NumberParam>)
                    value = 0.625;
                else
                    value = {7, 5};
                kind.set(params, value);
                const auto got = kind.get(params);
                REQUIRE(got.has_value());
                if constexpr (std::is_same_v<Kind, ChannelsParam>)
                    CHECK(value_text(param, params) == "Z:2");
                else
                    CHECK(*got == value);
            },
            param.kind);
        for (const Param& other : param_table())
            if (other.name != param.name)
                CHECK(value_text(other, params) == value_text(other, BuildParams()));
    }
}

TEST_CASE("parameters: map-smoothness is the weight's reciprocal, which alone has a value") {
    const auto& kind = std::get<NumberParam>(row("map-smoothness").kind);
    BuildParams params;
    kind.set(params, 4);
    CHECK(params.projection_color_weight == 0.25);
    CHECK_FALSE(kind.get(params).has_value());
    CHECK(default_text(row("map-smoothness")) == "20, for a tracked map 10");
    CHECK(listed(params).at("projection-color-weight") == "0.25");
    CHECK(listed(params).count("map-smoothness") == 0);
}

TEST_CASE("parameters: what is outside its range is refused by name, with what is expected") {
    BuildParams params;
    params.stop.density = 100.5;
    CHECK_THROWS_WITH_AS(check_params(params), "density is 100.5, expected a number above 0 and at most 100",
                         Error);
    params = {};
    params.levels.count = 33;
    CHECK_THROWS_WITH_AS(check_params(params), "levels is 33, expected a whole number from 1 to 32", Error);
    params = {};
    params.levels.faces = {100, 1};
    CHECK_THROWS_WITH_AS(check_params(params),
                         "level-faces of level 1 is 1, expected a whole number, at least 2", Error);
    params = {};
    params.stop.error = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(check_params(params), doctest::Contains("error is nan"), Error);
    for (const Preset& preset : presets()) CHECK_NOTHROW(check_params(preset.params));
}

// The help and docs/parameters.md show these.
TEST_CASE("parameters: defaults are those of BuildParams, or what is told") {
    CHECK(default_text(row("geometry-weight")) == "0.3");
    CHECK(default_text(row("metric")) == "flattened");
    CHECK(default_text(row("faces")).empty());
    CHECK(default_text(row("visits")).empty());
    CHECK(default_text(row("projection-color-weight")) == "0.05, for a tracked map 0.1");
    CHECK(default_text(row("refine")) == "2, or 0 where refinement is not possible");
}

TEST_CASE("parameters: a container lists what shaped it, and only that") {
    CHECK(listed({}) == std::map<std::string, std::string>{{"bary", "half"},
                                                           {"color-weight", "1"},
                                                           {"colors", "fitted"},
                                                           {"density", "1"},
                                                           {"exchange", "0"},
                                                           {"geometry-weight", "0.3"},
                                                           {"map", "relaxed"},
                                                           {"map-rounds", "3"},
                                                           {"map-step", "1/16"},
                                                           {"metric", "flattened"},
                                                           {"objective", "luv"},
                                                           {"priority", "increment"},
                                                           {"projection-color-weight", "0.05"},
                                                           {"quadrics", "accumulated"},
                                                           {"refine", "2"},
                                                           {"shape-weight", "0.22"},
                                                           {"smoothing", "2"},
                                                           {"solver", "closed"}});
    BuildParams params = preset_params("fast");
    params.metric = Metric::kHoppe;
    params.levels.faces = {50, 20};
    params.channels = {{"R", 1}, {"Z", 0.5f}};
    const auto list = listed(params);
    CHECK(list.at("level-faces") == "50,20");
    CHECK(list.at("channels") == "R,Z:0.5");
    CHECK(list.at("priority") == "total");
    for (const char* name :
         {"density", "geometry-weight", "shape-weight", "exchange", "visits", "max-cluster"})
        CHECK(list.count(name) == 0);
}

// The table of build parameters. The checks of a build, the command line with its help, the list in a
// container, the manuals and docs/parameters.md are all made from it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "libcore/base/range.h"
#include "libcore/mesh/mesh_image.h"
#include "libcore/pipeline/build_params.h"

namespace imgmesh {

/// How a parameter is read from BuildParams and stored there. `get` returns none if nothing is chosen.
template <typename T>
struct ParamAccess {
    using Value = T;
    std::function<std::optional<T>(const BuildParams&)> get;
    std::function<void(BuildParams&, const T&)> set;
};

struct CountParam : ParamAccess<std::int64_t> {
    CountRange range;
};
struct NumberParam : ParamAccess<double> {
    NumberRange range;
};
struct CountListParam : ParamAccess<std::vector<std::int64_t>> {
    CountRange range;  ///< of each
};
struct NumberListParam : ParamAccess<std::vector<double>> {
    NumberRange range;  ///< of each
};
struct FlagParam : ParamAccess<bool> {};
struct ChannelsParam : ParamAccess<std::vector<ChannelChoice>> {};
/// One of several words; the value is its number.
struct WordParam : ParamAccess<std::size_t> {
    std::vector<std::string_view> words;
};
using ParamKind = std::variant<CountParam, NumberParam, CountListParam, NumberListParam, FlagParam,
                               ChannelsParam, WordParam>;

/// Whether a container lists a parameter that has a value.
struct ParamListing {
    std::string_view when = "always";  ///< as docs tell it
    /// of parameters with nothing left open
    bool (*holds)(const BuildParams& params) = [](const BuildParams&) { return true; };
};

struct Param {
    std::string name;  ///< in containers, in messages and, with dashes before it, on the command line
    std::string group;
    bool everyday = false;  ///< whether most people need it
    ParamKind kind;
    std::string help;            ///< its meaning, without its words and its default
    std::string otherwise = {};  ///< the default in words, if nothing chosen means something
    ParamListing listed = {};
    std::vector<std::string> excludes = {};  ///< parameters that are not given together with it
};

const std::vector<Param>& param_table();

/// Returns the parameter's value as containers, messages and the command line write it; "" if nothing is
/// chosen.
std::string value_text(const Param& param, const BuildParams& params);
/// Returns the default: the value in BuildParams, or `otherwise`; "" for a flag.
std::string default_text(const Param& param);

/// Throws Error(kBadArgument) for the first parameter outside its own range.
void check_ranges(const BuildParams& params);

/// Returns the parameters that a container lists. `params` has nothing left open.
std::vector<BuildParameter> list_params(const BuildParams& params);

}  // namespace imgmesh

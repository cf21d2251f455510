#include "tools/build_options.h"

#include "libcore/pipeline/param_table.h"
#include "libcore/pipeline/presets.h"
#include "tools/build_contradictions.h"
#include "tools/common/channel_list.h"
#include "tools/common/help.h"
#include "tools/common/names.h"
#include "tools/common/options.h"
#include "tools/common/read_options.h"
#include "tools/common/targets.h"

namespace imgmesh {
namespace {

// Returns the value that `text` means for a parameter's option.
std::int64_t parse(const std::string& name, const std::string& text, const CountParam& kind) {
    return parse_count(name, text, kind.range);
}
double parse(const std::string& name, const std::string& text, const NumberParam& kind) {
    return parse_number(name, text, kind.range);
}
std::vector<std::int64_t> parse(const std::string& name, const std::string& text,
                                const CountListParam& kind) {
    std::vector<std::int64_t> values;
    for (const std::string& item : split_list(text)) values.push_back(parse_count(name, item, kind.range));
    return values;
}
std::vector<double> parse(const std::string& name, const std::string& text, const NumberListParam& kind) {
    std::vector<double> values;
    for (const std::string& item : split_list(text)) values.push_back(parse_number(name, item, kind.range));
    return values;
}
std::vector<ChannelChoice> parse(const std::string& name, const std::string& text, const ChannelsParam&) {
    return parse_channels(name, text);
}

Choices<std::size_t> choices_of(const WordParam& kind) {
    Choices<std::size_t> choices;
    for (const std::string_view word : kind.words) choices.emplace_back(word, choices.size());
    return choices;
}
std::size_t parse(const std::string& name, const std::string& text, const WordParam& kind) {
    return parse_choice(name, text, choices_of(kind));
}

// Returns the name of the argument in the help.
const char* type_of(const CountParam&) {
    return "N";
}
const char* type_of(const NumberParam&) {
    return "X";
}
const char* type_of(const WordParam&) {
    return "NAME";
}
template <typename Kind>
const char* type_of(const Kind&) {
    return "LIST";
}

CLI::Option* add_param(CLI::App& app, const Param& param, BuildOptions& o) {
    const std::string name = "--" + param.name;
    return std::visit(
        [&](const auto& kind) {
            using Kind = std::remove_cvref_t<decltype(kind)>;
            if constexpr (std::is_same_v<Kind, FlagParam>) {
                return add_flag(
                    app, name,
                    [&o, set = kind.set] { o.given.emplace_back([set](BuildParams& p) { set(p, true); }); },
                    param.help);
            } else {
                Help help(param.help, default_text(param));
                if constexpr (std::is_same_v<Kind, WordParam>)
                    help.text += ": " + choice_names(choices_of(kind));
                return add_value(
                    app, name, type_of(kind),
                    [&o, &kind, name](const std::string& text) {
                        o.given.emplace_back(
                            [&kind, value = parse(name, text, kind)](BuildParams& p) { kind.set(p, value); });
                    },
                    help);
            }
        },
        param.kind);
}

void add_params(CLI::App& app, BuildOptions& o) {
    std::vector<std::pair<CLI::Option*, const Param*>> added;
    for (const Param& param : param_table()) {
        CLI::Option* const option = in_group(add_param(app, param, o), param.group);
        if (!param.everyday) advanced(app, option);
        added.emplace_back(option, &param);
    }
    for (const auto& [option, param] : added)
        for (const std::string& other : param->excludes) exclude(app, option, {"--" + other});
}

// Returns how the maps are stored. Throws Error(kBadArgument) where they are to be compact and cannot.
LayerLayout layers_of(const BuildOptions& o) {
    if (o.no_map) return LayerLayout::kOff;
    const bool tracked = map_kind(o.params) == MapKind::kTracked, texture = o.texture.wanted.has_value();
    if (o.compression.layers == LayerLayout::kCompact && (tracked || texture))
        throw Error(ErrorKind::kBadArgument,
                    tracked
                        ? "--layers compact and --map tracked: a tracked map puts pixels anywhere, and "
                          "compact layers need them on a grid"
                        : "--layers compact and --texture: the meshes of a texture are stretched, so that "
                          "pixels leave the grid that compact layers need");
    // A rate counts the bits of compact layers.
    const bool counted = o.params.map_rate > 0 && !tracked && !texture;
    return o.compression.layers.value_or(counted ? LayerLayout::kCompact : LayerLayout::kExr);
}

}  // namespace

void add_build_options(CLI::App& app, BuildOptions& o) {
    Choices<BuildParams> choices;
    std::string help = "Values for many options at once";
    for (const Preset& preset : presets()) {
        choices.emplace_back(preset.name, preset.params);
        help += cat("; ", preset.name, " for ", preset.help);
    }
    in_group(
        add_value(
            app, "--preset", "NAME",
            [&o, choices](const std::string& text) { o.preset = parse_choice("--preset", text, choices); },
            help + ": " + choice_names(choices)),
        "Preset");

    const std::string image = "Image";
    in_group(add_file(app, "--mask", o.mask,
                      "Image of the same size: only pixels where its alpha, or else its brightness, reaches "
                      "the threshold are meshed, whatever the images' own alpha; with --alpha keep that is a "
                      "channel all the same"),
             image);
    CLI::Option* const alpha = add_choice(
        app, "--alpha", o.alpha.use, alpha_choices(),
        "Use of an alpha channel: keep it as a channel of the mesh, cut the image where it is below "
        "the threshold, or ignore it; auto keeps what is soft and cuts the rest");
    in_group(alpha, image);
    CLI::Option* const threshold =
        add_number(app, "--alpha-threshold", o.alpha.threshold, {0, 1, true},
                   {"Least alpha, or brightness of a mask, of the pixels that are meshed",
                    "0.5; where alpha is kept 1/510, or 7.5/255 if specks are fainter"});
    advanced(app, in_group(threshold, image));
    add_read_options(app, o.read);
    add_nodata_option(app, o.read);

    add_params(app, o);

    in_group(add_flag(
                 app, "--no-map", [&o] { o.no_map = true; },
                 "Write the meshes alone, without pixel maps: a plain glTF asset for engines, that imgmesh "
                 "cannot read. Colours are then fitted to what engines draw"),
             "Container");
    add_compression_options(app, o.compression, "edgebreaker; with --no-map none",
                            "compact with --map-rate or the preset small, else exr; exr with a texture");
    add_texture_options(app, o.texture, "Put the image on the meshes, for engines and viewers", false);
    add_tile_options(app, o.tiles);
    add_strict_option(app, o.strict);
    after_parsing(app, [&] {
        o.density = given(app, "--density");
        // Other options count more than the preset, wherever either was given: on the command line or in a
        // file.
        o.params = o.preset;
        for (const auto& set : o.given) set(o.params);
        o.read.values = o.params.values;
        if (o.params.values && o.alpha.use == AlphaUse::kKeep)
            throw Error(
                ErrorKind::kBadArgument,
                "--values and --alpha keep: alpha is a mask beside values, or with --channels one of them");
        check_contradictions(app, o.params);
        check_compression(o.compression, !o.no_map);
        if (o.tiles.size) check_tile_options(app);
        o.layers = layers_of(o);
        if (!o.no_map) return;
        check_no_map(app, o.params);
        o.params = without_map(o.params);
    });
}

}  // namespace imgmesh

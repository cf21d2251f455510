#include "formats/picture/decode/exr_choice.h"

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPartType.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "formats/files/one_line.h"
#include "formats/picture/decode/exr_layers_of.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// A line with more names than this would not be read.
constexpr std::size_t kMaxListed = 24;

using Names = std::vector<std::string>;

std::string listed(const Names& names) {
    std::string list;
    for (std::size_t i = 0; i < std::min(names.size(), kMaxListed); ++i)
        list += cat(i == 0 ? "" : ", ", names[i].empty() ? "(unnamed)" : printable(names[i]));
    return names.size() > kMaxListed ? cat(list, " and ", names.size() - kMaxListed, " more") : list;
}

bool is_deep(const Imf::Header& header) {
    return header.hasType() && Imf::isDeepData(header.type());
}

struct Part {
    int index;
    std::string name;
    std::vector<ExrLayer> layers;
    const Imf::ChannelList* channels;
};

Names channel_names(const Part& part) {
    Names names;
    for (auto it = part.channels->begin(); it != part.channels->end(); ++it)
        names.push_back(cat(it.name(), it.channel().type == Imf::UINT ? " (integers)" : ""));
    return names;
}

std::vector<Part> find_parts(const std::string& path, const Imf::MultiPartInputFile& file,
                             const std::optional<std::string>& wanted) {
    std::vector<Part> flat;
    std::optional<int> only;
    Names names;
    for (int i = 0; i < file.parts(); ++i) {
        names.push_back(exr_part_name(file, i));
        if (wanted && !only && names.back() == *wanted) only = i;
    }
    if (wanted && !only) {
        int number = -1;
        const char* const end = wanted->data() + wanted->size();
        const auto [at, error] = std::from_chars(wanted->data(), end, number);
        if (error != std::errc() || at != end || number < 0 || number >= file.parts())
            throw Error(ErrorKind::kBadFile,
                        cat(path, ": has no part ", printable(*wanted), ", its parts are ", listed(names)));
        only = number;
    }
    for (int i = only.value_or(0); i < (only ? *only + 1 : file.parts()); ++i) {
        const Imf::Header& header = file.header(i);
        if (!is_deep(header))
            flat.push_back({i, names[static_cast<std::size_t>(i)], exr_layers_of(header.channels()),
                            &header.channels()});
    }
    if (flat.empty()) throw Error(ErrorKind::kUnsupported, cat(path, ": deep EXR images are not supported"));
    return flat;
}

// A part, and a layer of it.
struct Place {
    const Part* part;
    const ExrLayer* layer;
};

// Returns the layer of the part's colour; null if there is none.
const ExrLayer* color_layer(const Part& part) {
    const ExrLayer* best = nullptr;
    for (const ExrLayer& layer : part.layers) {
        if (layer.color == ExrColor::kNothing) continue;
        if (layer.name.empty()) return &layer;
        if (!best || layer.color > best->color) best = &layer;
    }
    return best;
}

// Returns the places to look in, the best first: those with colour.
std::vector<Place> find_places(const std::string& path, const std::vector<Part>& parts,
                               const std::optional<std::string>& wanted) {
    static const ExrLayer kNoLayer;
    std::vector<Place> colored, others;
    Names names;
    for (const Part& part : parts) {
        if (!wanted) {
            const ExrLayer* const color = color_layer(part);
            const bool unnamed = !part.layers.empty() && part.layers.front().name.empty();
            (color ? colored : others)
                .push_back({&part, color     ? color
                                   : unnamed ? &part.layers.front()
                                             : &kNoLayer});
            continue;
        }
        for (const ExrLayer& layer : part.layers) {
            if (layer.name == *wanted)
                (layer.color != ExrColor::kNothing ? colored : others).push_back({&part, &layer});
            if (std::ranges::count(names, layer.name) == 0) names.push_back(layer.name);
        }
    }
    colored.insert(colored.end(), others.begin(), others.end());
    if (colored.empty())
        throw Error(ErrorKind::kBadFile,
                    cat(path, parts.size() == 1 ? cat(": part ", parts[0].name) : ":", " has no layer ",
                        printable(*wanted), ", its layers are ", listed(names)));
    return colored;
}

class Chooser {
  public:
    Chooser(const std::string& path, Place place) : path_(path), place_(place) {}

    // Adds the channel that `name` means; returns false if there is none.
    bool add_named(const std::string& name) {
        const ExrLayer& layer = *place_.layer;
        if (const std::string color = color_name(name); !color.empty())
            return add(name, layer.full(color), layer.channels.at(color));
        if (is_made(name)) return make(name);
        if (const auto at = layer.channels.find(name); at != layer.channels.end())
            return add(name, layer.full(name), at->second);
        const Imf::Channel* const channel = place_.part->channels->findChannel(name);
        return channel && add(name, name, *channel);
    }
    void add_color() {
        if (place_.layer->color == ExrColor::kGrey)
            add_named("Y");
        else if (place_.layer->color != ExrColor::kNothing)
            for (const char* name : {"R", "G", "B"}) add_named(name);
    }
    void add_alpha() {
        if (!place_.layer->alpha.empty() && !has("A")) add_named("A");
    }
    // Adds all other channels that can be read, at most `most` in all.
    void add_others(std::size_t most) {
        const bool made = !choice.luma.empty();
        for (auto it = place_.part->channels->begin(); it != place_.part->channels->end(); ++it) {
            const std::string full = it.name(), prefix = place_.layer->full("");
            if (made && (full == choice.luma || full == choice.red_chroma || full == choice.blue_chroma))
                continue;
            if (std::ranges::count(choice.channels, full, &ExrChannel::full) > 0) continue;
            std::string name = full.starts_with(prefix) ? full.substr(prefix.size()) : full;
            // A coordinate of that name would be taken for grey.
            if (name == "Y" && place_.layer->color == ExrColor::kNothing) name = full;
            if (has(name)) name = full;
            if (has(name)) {
                leave_out(full, "has the name of another channel");
            } else if (choice.channels.size() >= most) {
                leave_out(full, cat("is beyond the ", most, " channels that are read"));
            } else if (it.channel().xSampling != 1 || it.channel().ySampling != 1) {
                leave_out(full, "is subsampled");
            } else {
                choice.channels.push_back({name, full, it.channel().type, false});
            }
        }
    }
    bool has(const std::string& name) const {
        return std::ranges::count(choice.channels, name, &ExrChannel::name) > 0;
    }

    ExrChoice choice;

  private:
    // Returns the layer's own name for one of our colours, or "".
    std::string color_name(const std::string& name) const {
        const ExrLayer& layer = *place_.layer;
        const std::pair<const char*, const std::string*> kNames[] = {
            {"R", &layer.red}, {"G", &layer.green}, {"B", &layer.blue}, {"A", &layer.alpha}};
        for (const auto& [ours, theirs] : kNames)
            if (name == ours && (layer.color == ExrColor::kRgb || name == "A")) return *theirs;
        return "";
    }
    bool is_made(const std::string& name) const {
        return place_.layer->color == ExrColor::kLumaChroma && (name == "R" || name == "G" || name == "B");
    }
    bool make(const std::string& name) {
        choice.luma = place_.layer->full("Y");
        choice.red_chroma = place_.layer->full("RY");
        choice.blue_chroma = place_.layer->full("BY");
        choice.channels.push_back({name, "", place_.layer->channels.at("Y").type, true});
        return true;
    }
    bool add(const std::string& name, const std::string& full, const Imf::Channel& channel) {
        if (channel.xSampling != 1 || channel.ySampling != 1)
            throw Error(ErrorKind::kUnsupported, cat(path_, ": channel ", printable(full), " is subsampled"));
        if (name == "Y" && name != full && place_.layer->channels.contains("X"))
            choice.warnings.push_back(cat("channel Y of layer ", printable(place_.layer->name),
                                          " is taken for grey; as ", printable(full), " it is a number"));
        choice.channels.push_back({name, full, channel.type, true});
        return true;
    }
    void leave_out(const std::string& name, const std::string& why) {
        choice.warnings.push_back(cat("channel ", printable(name), " is left out: it ", why));
    }

    const std::string& path_;
    Place place_;
};

[[noreturn]] void refuse_colorless(const std::string& path, const Place& place) {
    throw Error(ErrorKind::kUnsupported,
                cat(path, ": the image has no colour, neither channels R, G, B nor Y, but ",
                    listed(channel_names(*place.part)), "; channels can be chosen"));
}

// Returns nothing, and the name that is missing, if the place lacks one.
std::optional<Chooser> choose_at(const std::string& path, const Place& place, const ReadImageOptions& options,
                                 std::string& missing) {
    Chooser chooser(path, place);
    if (options.channels) {
        for (const std::string& name : *options.channels) {
            if (chooser.has(name) || chooser.add_named(name)) continue;
            missing = name;
            return {};
        }
        if (options.channels->empty()) {
            if (place.layer->color == ExrColor::kNothing) refuse_colorless(path, place);
            chooser.add_color();
        }
        chooser.add_alpha();
    } else {
        chooser.add_color();
        chooser.add_alpha();
        chooser.add_others(static_cast<std::size_t>(options.limits.max_channels));
    }
    return chooser;
}

bool leaves_choice(const Imf::MultiPartInputFile& file, const Place& place) {
    const auto colored = std::ranges::count_if(
        place.part->layers, [](const ExrLayer& layer) { return layer.color != ExrColor::kNothing; });
    return file.parts() > 1 || !place.layer->name.empty() || colored > 1;
}

void sort_channels(std::vector<ExrChannel>& channels) {
    const auto rank = [](const ExrChannel& channel) {
        constexpr std::array<std::string_view, 5> kColor = {"R", "G", "B", "Y", "A"};
        return std::ranges::find(kColor, channel.name) - kColor.begin();
    };
    std::ranges::stable_sort(channels, {}, rank);
}

}  // namespace

std::string exr_part_name(const Imf::MultiPartInputFile& file, int part) {
    return file.header(part).hasName() ? file.header(part).name() : cat(part);
}

ExrChoice choose_exr(const std::string& path, const Imf::MultiPartInputFile& file,
                     const ReadImageOptions& options) {
    const std::vector<Part> parts = find_parts(path, file, options.part);
    const std::vector<Place> places = find_places(path, parts, options.layer);
    std::string first_missing;
    for (const Place& place : places) {
        std::string missing;
        std::optional<Chooser> chooser = choose_at(path, place, options, missing);
        if (first_missing.empty()) first_missing = missing;
        if (!chooser) continue;
        ExrChoice choice = std::move(chooser->choice);
        sort_channels(choice.channels);
        choice.part = place.part->index;
        choice.layer = place.layer->name;
        choice.chosen = leaves_choice(file, place);
        return choice;
    }
    throw Error(ErrorKind::kBadFile, cat(path, ": the image has no channel ", printable(first_missing),
                                         ", it has ", listed(channel_names(*places.front().part))));
}

}  // namespace imgmesh

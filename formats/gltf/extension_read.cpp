#include "formats/gltf/extension_read.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "formats/findings/json_members.h"
#include "formats/gltf/gltf_names.h"
#include "libcore/image/color.h"
#include "libcore/image/feature_space.h"

namespace imgmesh {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxName = 255;  // of a channel of an EXR

void check_channels(const std::vector<std::string>& names) {
    const auto refuse_names = [](const std::string& text) {
        refuse("ext.channels", text, at_pointer("channels"));
    };
    for (const std::string& name : names) {
        if (name.empty() || name.size() > kMaxName)
            refuse_names(cat("a channel's name has ", name.size(), " bytes, expected 1 to ", kMaxName));
        if (name.find('\0') != std::string::npos) refuse_names("a channel's name holds a byte of value 0");
        if (std::ranges::count(names, name) > 1) refuse_names(cat("two channels have the name ", name));
    }
    const int features = split_names(names).features();
    if (features < 1 || features > kMaxFeatures)
        refuse_names(cat("the channels are ", features, " features, expected 1 to ", kMaxFeatures));
}

}  // namespace

SourceInfo read_image_member(const json& image, const ContainerLimits& limits) {
    SourceInfo source;
    const std::uint64_t width = unsigned_member(image, "width", "ext.member");
    const std::uint64_t height = unsigned_member(image, "height", "ext.member");
    if (width < 1 || height < 1 || width > kMaxCoordinate || height > kMaxCoordinate)
        refuse("limits.pixels", cat("an image of ", width, "x", height, ", sides are 1 to ", kMaxCoordinate));
    if (width * height > static_cast<std::uint64_t>(limits.max_pixels))
        refuse("limits.pixels",
               cat("an image of ", width, "x", height, ", at most ", limits.max_pixels, " pixels"));
    source.width = static_cast<int>(width);
    source.height = static_cast<int>(height);

    const std::string space = string_member(image, "colorSpace", "ext.member");
    const auto color_space = parse_color_space(space);
    if (!color_space) refuse("ext.value", cat("unknown colorSpace ", space), at_pointer("colorSpace"));
    source.color_space = *color_space;

    const std::string sample = string_member(image, "sampleType", "ext.member");
    const auto type = std::find(std::begin(kSampleTypes), std::end(kSampleTypes), sample);
    if (type == std::end(kSampleTypes))
        refuse("ext.value", cat("unknown sampleType ", sample), at_pointer("sampleType"));
    source.sample_type = static_cast<SampleType>(type - std::begin(kSampleTypes));

    const json& channels = member(image, "channels", "ext.member");
    if (!channels.is_array() ||
        !std::all_of(channels.begin(), channels.end(), [](const json& c) { return c.is_string(); }))
        refuse("ext.member", "\"channels\" is not an array of names", at_pointer("channels"));
    if (channels.size() > kMaxFeatures)
        refuse("ext.channels", cat(channels.size(), " channels, at most ", kMaxFeatures),
               at_pointer("channels"));
    source.channel_names = channels.get<std::vector<std::string>>();
    check_channels(source.channel_names);
    const json& mask = member(image, "hasMask", "ext.member");
    if (!mask.is_boolean()) refuse("ext.member", "\"hasMask\" is not true or false", at_pointer("hasMask"));
    source.has_mask = mask.get<bool>();
    return source;
}

ExrMetadata read_metadata_member(const json& image, const SourceInfo& source) {
    const json* const metadata = find(image, "metadata");
    if (!metadata) return {};
    const auto refuse_it = [](const std::string& text) {
        refuse("ext.metadata", text, at_pointer("metadata"));
    };
    if (!metadata->is_object()) refuse_it("\"metadata\" is not an object");
    if (metadata->size() > kMaxMetadataEntries)
        refuse_it(cat(metadata->size(), " attributes, at most ", kMaxMetadataEntries));
    ExrMetadata out;
    for (const auto& [name, stated] : metadata->items()) {
        const json* const type = find(stated, "type");
        const json* const value = find(stated, "value");
        if (!type || !type->is_string() || !value)
            refuse_it(cat("attribute ", name, " has not a type and a value"));
        ExrAttribute attribute{name, type->get<std::string>(), {}, {}};
        if (value->is_string())
            attribute.text = value->get<std::string>();
        else if (value->is_number())
            attribute.numbers = {value->get<double>()};
        else if (value->is_array() && value->size() > 1 &&
                 std::ranges::all_of(*value, [](const json& x) { return x.is_number(); }))
            attribute.numbers = value->get<std::vector<double>>();
        else
            refuse_it(cat("attribute ", name, " is no text, number or list of numbers"));
        out.push_back(std::move(attribute));
    }
    const std::string fault = exr_metadata_fault(out, source.width, source.height);
    if (!fault.empty()) refuse_it(fault);
    return out;
}

void read_build_member(const json& build, Asset& asset) {
    asset.generator = string_member(build, kGenerator, "ext.member");
    for (const auto& [name, value] : build.items()) {
        if (name == kGenerator) continue;
        if (value.is_boolean())
            asset.parameters.emplace_back(name, value.get<bool>());
        else if (value.is_string())
            asset.parameters.emplace_back(name, value.get<std::string>());
        else if (value.is_number_float())
            asset.parameters.emplace_back(name, value.get<double>());
        else if (value.is_number_integer() &&
                 (!value.is_number_unsigned() || value.get<std::uint64_t>() <= std::uint64_t{INT64_MAX}))
            asset.parameters.emplace_back(name, value.get<std::int64_t>());
        else
            refuse("ext.member",
                   cat("the build parameter \"", name, "\" is not a number, a string or a boolean"),
                   at_pointer(pointer_token(name)));
    }
}

AssetLevel read_level_member(const json& extension, const SourceInfo& source, const ContainerLimits& limits) {
    AssetLevel level;
    level.vertices = unsigned_member(extension, "vertices", "ext.member");
    level.faces = unsigned_member(extension, "faces", "ext.member");
    // There are at most two faces for each pixel: the finest mesh has its vertices at the pixels' centres.
    const auto most = std::min<std::uint64_t>(
        static_cast<std::uint64_t>(limits.max_faces),
        2 * static_cast<std::uint64_t>(source.width) * static_cast<std::uint64_t>(source.height));
    if (level.faces < 1 || level.faces > most)
        refuse("limits.faces", cat("a mesh of ", level.faces, " faces, expected 1 to ", most),
               at_pointer("faces"));
    if (level.vertices < 3 || level.vertices > 3 * level.faces)
        refuse("mesh.counts", cat("a mesh of ", level.vertices, " vertices and ", level.faces, " faces"),
               at_pointer("vertices"));
    const json& error = member(extension, "error", "ext.member");
    if (!error.is_number() || !(error.get<double>() >= 0))
        refuse("ext.member", "\"error\" is not a number >= 0", at_pointer("error"));
    level.error = error.get<double>();
    level.topology = string_member(extension, "topology", "ext.member");
    if (level.topology.size() != 64 ||
        level.topology.find_first_not_of("0123456789abcdef") != std::string::npos)
        refuse("ext.member", "\"topology\" is not a SHA-256 in lower-case hex", at_pointer("topology"));
    return level;
}

}  // namespace imgmesh

#include "tools/common/channel_list.h"

namespace imgmesh {
namespace {

ChannelChoice parse_choice(const std::string& text, const std::string& item) {
    ChannelChoice choice;
    const std::size_t colon = item.rfind(':');
    choice.name = item.substr(0, colon);
    if (choice.name.empty())
        throw Error(ErrorKind::kBadArgument,
                    cat("--channels '", text, "': expected NAME or NAME:WEIGHT, with commas between"));
    if (colon != std::string::npos)
        choice.weight =
            parse_number(cat("--channels ", choice.name), item.substr(colon + 1), {0, kNoLimit, true});
    return choice;
}

}  // namespace

CLI::Option* add_channels(CLI::App& app, std::vector<ChannelChoice>& channels) {
    return add_value(
        app, "--channels", "LIST",
        [&channels](const std::string& text) {
            channels.clear();
            for (std::size_t at = 0; at <= text.size();) {
                const std::size_t end = std::min(text.find(',', at), text.size());
                channels.push_back(parse_choice(text, text.substr(at, end - at)));
                at = end + 1;
            }
            try {
                check_channels(channels);
            } catch (const Error& e) {
                throw Error(e.kind(), cat("--channels ", text, ": ", e.what()));
            }
        },
        "Channels that the mesh follows and keeps, each perhaps with a weight, as R,G,B,depth.Z:0.5 (default "
        "the "
        "colour)");
}

}  // namespace imgmesh

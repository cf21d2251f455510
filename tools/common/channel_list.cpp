#include "tools/common/channel_list.h"

#include "tools/common/options.h"
#include "tools/common/text.h"

namespace imgmesh {
namespace {

ChannelChoice parse_channel(const std::string& name, const std::string& text, const std::string& item) {
    ChannelChoice choice;
    const std::size_t colon = item.rfind(':');
    choice.name = item.substr(0, colon);
    if (choice.name.empty())
        throw Error(ErrorKind::kBadArgument,
                    cat(name, " '", shortened(text), "': expected NAME or NAME:WEIGHT, with commas between"));
    if (colon != std::string::npos)
        choice.weight =
            parse_number(cat(name, " ", shortened(choice.name)), item.substr(colon + 1), {0, kNoLimit, true});
    return choice;
}

}  // namespace

std::vector<ChannelChoice> parse_channels(const std::string& name, const std::string& text) {
    std::vector<ChannelChoice> channels;
    for (const std::string& item : split_list(text)) channels.push_back(parse_channel(name, text, item));
    try {
        check_channels(channels);
    } catch (const Error& e) {
        throw Error(e.kind(), cat(name, " ", shortened(text), ": ", e.what()));
    }
    return channels;
}

}  // namespace imgmesh

#include "tests/fuzz/mutate.h"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "formats/findings/findings.h"
#include "formats/gltf/glb.h"

namespace imgmesh::fuzz {
namespace {

using nlohmann::json;

constexpr std::size_t kHeadBytes = 700;  // of an EXR or image: where its header is

void collect(json& value, std::vector<json*>& all) {
    all.push_back(&value);
    if (value.is_structured())
        for (json& item : value) collect(item, all);
}

json interesting(std::uint32_t which) {
    const json values[] = {nullptr,
                           false,
                           -1,
                           0,
                           1,
                           2,
                           3,
                           255,
                           65536,
                           2147483647,
                           2147483648u,
                           4294967295u,
                           std::int64_t{1} << 53,
                           std::uint64_t{1} << 63,
                           -(std::int64_t{1} << 62),
                           1e308,
                           -0.5,
                           "",
                           "../x",
                           std::string(300, 'a'),
                           json::array(),
                           json::object(),
                           json::array({0, 0, 0}),
                           json::array({json::array({json::array()})})};
    return values[which % std::size(values)];
}

// Where in the binary chunk a bufferView lies; an empty range for what makes no sense.
std::pair<std::size_t, std::size_t> range_of(const json& document, const json& index, std::size_t size) {
    if (!index.is_number_unsigned() || !document.contains("bufferViews")) return {0, 0};
    const json& views = document["bufferViews"];
    if (!views.is_array() || index.get<std::size_t>() >= views.size()) return {0, 0};
    const json& view = views[index.get<std::size_t>()];
    if (!view.is_object()) return {0, 0};
    // The document may have been mutated before: a member may be of any type.
    const auto member = [&](const char* name) {
        const auto it = view.find(name);
        return it != view.end() && it->is_number_unsigned() ? it->get<std::size_t>() : 0;
    };
    const std::size_t begin = member("byteOffset"), length = member("byteLength");
    return begin <= size && length <= size - begin ? std::pair(begin, length)
                                                   : std::pair<std::size_t, std::size_t>(0, 0);
}

}  // namespace

void Mutator::change_bytes(Bytes& bytes, std::size_t begin, std::size_t length) {
    if (length == 0 || begin + length > bytes.size()) return;
    for (std::uint32_t times = 1 + below(4); times > 0; --times) {
        const std::size_t at = begin + below(length);
        switch (below(6)) {
            case 0:
                bytes[at] ^= static_cast<std::uint8_t>(1u << below(8));
                break;
            case 1:
                bytes[at] = static_cast<std::uint8_t>(random_());
                break;
            case 2:
                bytes[at] = below(2) ? 0xFF : 0;
                break;
            case 3: {  // a number of 32 bits
                const std::uint32_t numbers[] = {0,          1,       0x7FFFFFFF, 0x80000000,
                                                 0xFFFFFFFF, 0x10000, below(1000)};
                const std::uint32_t number = numbers[below(std::size(numbers))];
                if (begin + length - at >= 4) std::memcpy(bytes.data() + at, &number, 4);
                break;
            }
            case 4: {  // a piece over another
                const std::size_t from = begin + below(length);
                const std::size_t count =
                    std::min({std::size_t{1} + below(32), begin + length - at, begin + length - from});
                std::memmove(bytes.data() + at, bytes.data() + from, count);
                break;
            }
            default:  // a run
                std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                            std::min<std::size_t>(1 + below(16), begin + length - at),
                            static_cast<std::uint8_t>(random_()));
        }
    }
}

void Mutator::change_value(json& document) {
    std::vector<json*> all;
    collect(document, all);
    json& value = *all[below(all.size())];
    switch (below(6)) {
        case 0:
            if (value.is_number_integer()) {
                // Unsigned, so that the largest may wrap around.
                value = static_cast<std::int64_t>(static_cast<std::uint64_t>(value.get<std::int64_t>()) +
                                                  (below(2) ? 1u : ~std::uint64_t{0}));
                break;
            }
            [[fallthrough]];
        case 1:
            value = interesting(below(1u << 16));
            break;
        case 2:
            if (value.is_structured() && !value.empty()) {
                auto it = value.begin();
                std::advance(it, below(value.size()));
                value.erase(it);
            }
            break;
        case 3:
            if (value.is_array() && !value.empty()) value.push_back(value[below(value.size())]);
            break;
        case 4: {  // a copy of another value
            const json copy = *all[below(all.size())];
            value = copy;
            break;
        }
        default:
            if (value.is_string() && !value.get<std::string>().empty()) {
                std::string text = value.get<std::string>();
                text[below(text.size())] = static_cast<char>(32 + below(95));
                value = text;
            }
    }
}

Bytes Mutator::any(const Bytes& file) {
    Bytes bytes = file;
    const std::size_t head = std::min(kHeadBytes, bytes.size());
    if (below(10) == 0) bytes.resize(below(bytes.size() + 1));
    if (below(20) == 0) bytes.insert(bytes.end(), below(64), static_cast<std::uint8_t>(random_()));
    if (bytes.size() >= head && below(3) != 0) change_bytes(bytes, 0, head);
    if (below(2) == 0) change_bytes(bytes, 0, bytes.size());
    return bytes;
}

std::string Mutator::json_text(const std::string& text) {
    json document = json::parse(text, nullptr, false);
    if (document.is_discarded() || below(8) == 0) {
        const Bytes bytes = any({text.begin(), text.end()});
        return {bytes.begin(), bytes.end()};
    }
    for (std::uint32_t times = 1 + below(3); times > 0; --times) change_value(document);
    return document.dump(-1, ' ', false, json::error_handler_t::replace);
}

Bytes Mutator::glb(const Bytes& file) {
    json document;
    Bytes binary;
    try {
        Findings findings = Findings::strict();
        const GlbView view = unpack_glb(file, findings);
        document = json::parse(view.json);
        binary.assign(view.binary.begin(), view.binary.end());
    } catch (const std::exception&) {
        return any(file);
    }
    const auto range = [&](const json& index) { return range_of(document, index, binary.size()); };
    const json none;
    const json* layers = &none;
    if (const json* root = document.contains("/extensions/IMGMESH_pixel_map/layers/bufferView"_json_pointer)
                               ? &document["/extensions/IMGMESH_pixel_map/layers/bufferView"_json_pointer]
                               : nullptr)
        layers = root;
    const auto [exr, exr_length] = range(*layers);
    switch (below(6)) {
        case 0:
            return any(file);
        case 1:
            for (std::uint32_t times = 1 + below(3); times > 0; --times) change_value(document);
            break;
        case 2:  // the EXR's header
            change_bytes(binary, exr, std::min(kHeadBytes, exr_length));
            break;
        case 3:
            change_bytes(binary, exr, exr_length);
            break;
        default: {  // a mesh: anything but the EXR
            const json* views = document.contains("bufferViews") ? &document["bufferViews"] : &none;
            const std::uint32_t index = below(views->is_array() ? views->size() : 1);
            const auto [begin, length] = range(json(index));
            if (begin != exr || length != exr_length)
                change_bytes(binary, begin, below(2) ? length : std::min<std::size_t>(length, 48));
        }
    }
    return pack_glb(document.dump(-1, ' ', false, json::error_handler_t::replace), binary);
}

}  // namespace imgmesh::fuzz

// Source: the Draco bitstream specification 2.2, sections "Decode header" and "Decode connectivity".
#include "formats/gltf/draco_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "formats/files/byte_reader.h"
#include "formats/findings/findings.h"
#include "formats/gltf/draco_codec.h"
#include "libcore/base/error.h"
#include "libcore/image/color_levels.h"

namespace imgmesh {
namespace {

constexpr std::size_t kHeaderBytes = 11;  // "DRACO", major, minor, type, method, flags
constexpr std::uint8_t kVersion[] = {2, 2}, kTriangles = 1, kEdgebreakerMethod = 1;

// Returns the largest power of two, at most a pixel, of which all positions are multiples away from `low`;
// at least kPositionStep.
float common_step(const StoredMesh& mesh, const std::array<float, 3>& low) {
    std::uint32_t bits = 32;  // a pixel in steps of kPositionStep
    for (const auto& p : mesh.position)
        for (std::size_t i = 0; i < 2; ++i)
            bits |= static_cast<std::uint32_t>((p[i] - low[i]) / kPositionStep);
    return static_cast<float>(1 << std::countr_zero(bits)) * kPositionStep;
}

// With range = (2^bits - 1) step Draco's step is exactly that of the mesh, and origin + q step has no
// rounding: all are multiples of the step and below 2^23 of them (kMaxCoordinate).
DracoGrid grid_of(const StoredMesh& mesh) {
    const auto [low, high] = bounds_of(mesh.position);
    const float step = common_step(mesh, low);
    const float extent = std::max(high[0] - low[0], high[1] - low[1]);
    const auto bits = static_cast<int>(std::bit_width(static_cast<std::uint32_t>(extent / step)));
    return {bits, low, static_cast<float>((1 << bits) - 1) * step};
}

// Whether colours have few levels (ColorLevels). Differences of levels have as many values as colours of 16
// bits, so a prediction would lose what the levels gain.
bool has_color_levels(const StoredMesh& mesh) {
    std::vector<bool> used(std::size_t{1} << 16);
    for (const auto& color : mesh.color)
        for (const std::uint16_t code : color) used[code] = true;
    return std::ranges::count(used, true) <= kMostColorLevels;
}

// Whether most positions, but not all, are on a coarser grid. A parallelogram of such is on it too, a mean of
// several need not be.
bool is_mostly_coarse(const StoredMesh& mesh) {
    constexpr float kCoarser = 4;
    const std::array<float, 3> low = bounds_of(mesh.position).low;
    const float step = kCoarser * common_step(mesh, low);
    const auto coarse = std::ranges::count_if(mesh.position, [&](const std::array<float, 3>& p) {
        const float x = (p[0] - low[0]) / step, y = (p[1] - low[1]) / step;
        return x == std::floor(x) && y == std::floor(y);
    });
    return 4 * static_cast<std::size_t>(coarse) >= 3 * mesh.position.size();
}

struct Header {
    std::uint8_t method;
    std::uint64_t vertices;  // edgebreaker: before vertices are split at seams
    std::uint64_t faces;
    std::uint8_t seams;  // edgebreaker: attributes with connectivity of their own
};

// LEB128, at most 32 bits.
std::uint64_t varint(ByteReader& in) {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
        const std::uint32_t b = in.number(1);
        value |= std::uint64_t{b & 127} << shift;
        if (b < 128) return value;
    }
    refuse("draco.header", "a number in the Draco mesh's header is longer than 32 bits",
           at_byte("draco", in.position()));
}

// The numbers behind the fixed part.
Header read_numbers(ByteReader in, std::uint8_t method) {
    Header header{method, 0, 0, 0};
    if (method == kEdgebreakerMethod) {
        in.take(1);  // how the traversal is coded
        header.vertices = varint(in);
        header.faces = varint(in);
        header.seams = in.take(1)[0];
    } else {
        header.faces = varint(in);
        header.vertices = varint(in);
    }
    return header;
}

Header read_header(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < kHeaderBytes || text_of(bytes.first(5)) != "DRACO")
        refuse("draco.header", "the mesh does not start with DRACO", at_byte("draco", 0));
    if (bytes[5] != kVersion[0] || bytes[6] != kVersion[1])
        refuse("draco.version",
               cat("Draco bitstream version ", int{bytes[5]}, ".", int{bytes[6]}, ", expected 2.2"),
               at_byte("draco", 5));
    if (bytes[7] != kTriangles || bytes[8] > kEdgebreakerMethod)
        refuse("draco.header", "the Draco data is not a triangle mesh of a known method",
               at_byte("draco", 7));
    // Metadata has nested sizes of its own and nothing that a container needs.
    if (bytes[9] != 0 || bytes[10] != 0)
        refuse("draco.metadata", "the Draco mesh has metadata or unknown flags", at_byte("draco", 9));

    try {
        return read_numbers({bytes.subspan(kHeaderBytes), ByteOrder::kLittle, kHeaderBytes}, bytes[8]);
    } catch (const EndOfBytes& end) {
        refuse("draco.header", "the Draco mesh ends in its header", at_byte("draco", end.position));
    }
}

}  // namespace

DracoAttributeIds draco_ids(const StoredLayout& layout) {
    DracoAttributeIds ids;
    std::uint32_t next = ids.position + 1;
    ids.color.reset();
    if (layout.color) ids.color = next++;
    if (layout.hdr) ids.hdr = next++;
    for (std::size_t c = 0; c < layout.channels; ++c) ids.channels.push_back(next++);
    if (layout.texture) ids.texcoord = next++;
    return ids;
}

int attribute_count(const DracoAttributeIds& ids) {
    return 1 + ids.color.has_value() + ids.hdr.has_value() + ids.texcoord.has_value() +
           static_cast<int>(ids.channels.size());
}

DracoMesh encode_draco_mesh(const StoredMesh& mesh, DracoMode mode) {
    const DracoAttributeIds ids = draco_ids(mesh.layout());
    const DracoGrid grid = grid_of(mesh);
    DracoMesh result{draco_encode(mesh, ids, mode, grid, {}), {}};
    DracoPredictions best;
    const auto improve = [&](DracoPredictions other) {
        std::vector<std::uint8_t> bytes = draco_encode(mesh, ids, mode, grid, other);
        if (bytes.size() >= result.bytes.size()) return;
        result.bytes = std::move(bytes);
        best = other;
    };
    if (draco_takes_predictions()) {
        if (ids.color && has_color_levels(mesh)) improve({best.parallelogram, true});
        if (mode == DracoMode::kEdgebreaker && is_mostly_coarse(mesh)) improve({true, best.plain_color});
    }
    Findings findings = Findings::strict();
    result.decoded = draco_decode(result.bytes, ids, mode, findings);
    return result;
}

DracoMode draco_mode(std::span<const std::uint8_t> bytes) {
    return read_header(bytes).method == kEdgebreakerMethod ? DracoMode::kEdgebreaker : DracoMode::kSequential;
}

StoredMesh decode_draco_mesh(std::span<const std::uint8_t> bytes, const DracoAttributeIds& ids,
                             std::uint64_t vertices, std::uint64_t faces, Findings& findings) {
    const Header header = read_header(bytes);
    // Edgebreaker may split vertices but not merge them; each face has three.
    const bool edgebreaker = header.method == kEdgebreakerMethod;
    if (header.faces != faces || vertices > 3 * faces ||
        (edgebreaker ? header.vertices > vertices : header.vertices != vertices))
        refuse("mesh.counts", cat("the Draco mesh has ", header.vertices, " vertices and ", header.faces,
                                  " faces, expected ", vertices, " and ", faces));
    if (header.seams >= attribute_count(ids))
        refuse("draco.attributes", cat("the Draco mesh has ", header.seams + 1,
                                       " attributes or more, expected ", attribute_count(ids)));

    StoredMesh mesh =
        draco_decode(bytes, ids, edgebreaker ? DracoMode::kEdgebreaker : DracoMode::kSequential, findings);
    if (mesh.faces.size() != faces || mesh.position.size() != vertices)
        refuse("mesh.counts", cat("the decoded mesh has ", mesh.position.size(), " vertices and ",
                                  mesh.faces.size(), " faces, expected ", vertices, " and ", faces));
    return mesh;
}

StoredMesh decode_draco_mesh(std::span<const std::uint8_t> bytes, const DracoAttributeIds& ids,
                             std::uint64_t vertices, std::uint64_t faces) {
    Findings findings = Findings::strict();
    return decode_draco_mesh(bytes, ids, vertices, faces, findings);
}

}  // namespace imgmesh

// Source: the Draco bitstream specification 2.2, sections "Decode header" and "Decode connectivity".
#include "formats/gltf/draco_mesh.h"

#include <draco/compression/expert_encode.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <type_traits>

#include "formats/files/byte_reader.h"
#include "formats/findings/findings.h"
#include "libcore/base/error.h"
#include "libcore/image/color_levels.h"

namespace imgmesh {
namespace {

constexpr std::size_t kHeaderBytes = 11;  // "DRACO", major, minor, type, method, flags

// Adds one attribute with a value per vertex, from its bytes in memory.
template <typename T, std::size_t N>
int add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType data_type,
                  bool normalized, std::uint32_t unique_id, const std::vector<std::array<T, N>>& values) {
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, static_cast<std::int8_t>(N), data_type, normalized, sizeof(values[0]), 0);
    const int id = mesh.AddAttribute(attribute, true, static_cast<std::uint32_t>(values.size()));
    mesh.attribute(id)->set_unique_id(unique_id);
    mesh.attribute(id)->buffer()->Write(0, values.data(), values.size() * sizeof(values[0]));
    return id;
}

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
void quantize_positions(draco::ExpertEncoder& encoder, int attribute, const StoredMesh& mesh) {
    const auto [low, high] = bounds_of(mesh.position);
    const float step = common_step(mesh, low);
    const float extent = std::max(high[0] - low[0], high[1] - low[1]);
    const auto bits = static_cast<int>(std::bit_width(static_cast<std::uint32_t>(extent / step)));
    const float range = static_cast<float>((1 << bits) - 1) * step;
    encoder.SetAttributeExplicitQuantization(attribute, bits, 3, low.data(), range);
}

// How Draco predicts values, where its usual choice is not the smallest.
struct Predictions {
    bool parallelogram = false;  // positions by one parallelogram, not the mean of several
    bool plain_color = false;    // colours not at all
};

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
    if (method == draco::MESH_EDGEBREAKER_ENCODING) {
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
    if (bytes[5] != draco::kDracoMeshBitstreamVersionMajor ||
        bytes[6] != draco::kDracoMeshBitstreamVersionMinor)
        refuse("draco.version",
               cat("Draco bitstream version ", int{bytes[5]}, ".", int{bytes[6]}, ", expected 2.2"),
               at_byte("draco", 5));
    if (bytes[7] != draco::TRIANGULAR_MESH || bytes[8] > draco::MESH_EDGEBREAKER_ENCODING)
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

template <typename T, std::size_t N>
bool is_attribute(const draco::PointAttribute& a, draco::GeometryAttribute::Type type) {
    const draco::DataType data = std::is_same_v<T, float> ? draco::DT_FLOAT32 : draco::DT_UINT16;
    return a.attribute_type() == type && a.data_type() == data && a.num_components() == static_cast<int>(N);
}

int attribute_count(const DracoAttributeIds& ids) {
    return 1 + ids.color.has_value() + ids.hdr.has_value() + ids.texcoord.has_value() +
           static_cast<int>(ids.channels.size());
}

// A Draco decoder that checks the attributes' shapes before it takes memory for their values: a few bytes can
// declare thousands of attributes of 2 kB a vertex.
template <typename Decoder>
class GuardedDecoder : public Decoder {
  public:
    explicit GuardedDecoder(int attributes) : attributes_(attributes) {}

  protected:
    bool DecodeAllAttributes() override {
        const draco::PointCloud& cloud = *this->point_cloud();
        if (cloud.num_attributes() != attributes_)
            refuse("draco.attributes",
                   cat("the Draco mesh has ", cloud.num_attributes(), " attributes, expected ", attributes_));
        for (int i = 0; i < attributes_; ++i) {
            const draco::PointAttribute& a = *cloud.attribute(i);
            if (!is_attribute<float, 3>(a, draco::GeometryAttribute::POSITION) &&
                !is_attribute<std::uint16_t, 4>(a, draco::GeometryAttribute::COLOR) &&
                !is_attribute<float, 2>(a, draco::GeometryAttribute::TEX_COORD) &&
                !is_attribute<float, 3>(a, draco::GeometryAttribute::GENERIC) &&
                !is_attribute<float, 1>(a, draco::GeometryAttribute::GENERIC))
                refuse("draco.attributes",
                       "expected a float POSITION of three, a uint16 COLOR of four and a float TEX_COORD of "
                       "two components, other attributes floats of one or three");
        }
        return Decoder::DecodeAllAttributes();
    }

  private:
    int attributes_;
};

template <typename Decoder>
std::unique_ptr<draco::Mesh> decode_with(std::span<const std::uint8_t> bytes, int attributes,
                                         Findings& findings) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    auto mesh = std::make_unique<draco::Mesh>();
    const draco::Status status =
        GuardedDecoder<Decoder>(attributes).Decode(draco::DecoderOptions(), &buffer, mesh.get());
    if (!status.ok())
        refuse("draco.data",
               cat("Draco cannot decode the mesh: ",
                   status.error_msg_string().empty() ? "broken data" : status.error_msg_string()));
    if (buffer.remaining_size() > 0)
        findings.add("draco.tail", cat(buffer.remaining_size(), " bytes after the mesh"),
                     at_byte("draco", static_cast<std::uint64_t>(buffer.decoded_size())));
    return mesh;
}

// The values of one attribute, one for each point.
template <typename T, std::size_t N>
void copy_values(const draco::Mesh& mesh, std::uint32_t unique_id, draco::GeometryAttribute::Type type,
                 std::vector<std::array<T, N>>& out) {
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(unique_id);
    if (!attribute || !is_attribute<T, N>(*attribute, type))
        refuse("draco.attributes", cat("the Draco mesh has no such attribute with id ", unique_id));
    out.resize(mesh.num_points());
    for (std::uint32_t p = 0; p < mesh.num_points(); ++p) {
        const draco::AttributeValueIndex index = attribute->mapped_index(draco::PointIndex(p));
        if (index.value() >= attribute->size())
            refuse("draco.data", cat("vertex ", p, " of the Draco mesh has no value"));
        attribute->GetValue(index, out[p].data());
    }
}

// Decodes a mesh whose header has been checked.
StoredMesh decode(std::span<const std::uint8_t> bytes, const DracoAttributeIds& ids, bool edgebreaker,
                  Findings& findings) {
    const int attributes = attribute_count(ids);
    const std::unique_ptr<draco::Mesh> mesh =
        edgebreaker ? decode_with<draco::MeshEdgebreakerDecoder>(bytes, attributes, findings)
                    : decode_with<draco::MeshSequentialDecoder>(bytes, attributes, findings);
    StoredMesh out;
    copy_values(*mesh, ids.position, draco::GeometryAttribute::POSITION, out.position);
    if (ids.color) copy_values(*mesh, *ids.color, draco::GeometryAttribute::COLOR, out.color);
    if (ids.hdr) copy_values(*mesh, *ids.hdr, draco::GeometryAttribute::GENERIC, out.hdr);
    for (const std::uint32_t id : ids.channels) {
        std::vector<std::array<float, 1>> values;
        copy_values(*mesh, id, draco::GeometryAttribute::GENERIC, values);
        std::vector<float>& channel = out.channels.emplace_back();
        for (const auto& [value] : values) channel.push_back(value);
    }
    if (ids.texcoord) copy_values(*mesh, *ids.texcoord, draco::GeometryAttribute::TEX_COORD, out.texcoord);
    out.faces.resize(mesh->num_faces());
    for (std::uint32_t f = 0; f < mesh->num_faces(); ++f) {
        const draco::Mesh::Face& face = mesh->face(draco::FaceIndex(f));
        for (std::size_t i = 0; i < 3; ++i) {
            // The sequential decoder does not check this.
            if (face[i].value() >= mesh->num_points())
                refuse("mesh.index", cat("face ", f, " has vertex ", face[i].value(), ", the mesh has ",
                                         mesh->num_points()));
            out.faces[f][i] = face[i].value();
        }
    }
    return out;
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

DracoMesh encode_draco_mesh(const StoredMesh& mesh, DracoMode mode) {
    draco::Mesh out;
    out.set_num_points(static_cast<std::uint32_t>(mesh.position.size()));
    out.SetNumFaces(mesh.faces.size());
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        const auto [a, b, c] = mesh.faces[f];
        out.SetFace(draco::FaceIndex(f), {draco::PointIndex(a), draco::PointIndex(b), draco::PointIndex(c)});
    }
    const DracoAttributeIds ids = draco_ids(mesh.layout());
    const int position = add_attribute(out, draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, false,
                                       ids.position, mesh.position);
    int color = -1;
    if (ids.color)
        color = add_attribute(out, draco::GeometryAttribute::COLOR, draco::DT_UINT16, true, *ids.color,
                              mesh.color);
    const auto add = [&](draco::DataType type, std::uint32_t id, const auto& values) {
        add_attribute(out, draco::GeometryAttribute::GENERIC, type, false, id, values);
    };
    // Floats without quantisation are stored unchanged.
    if (ids.hdr) add(draco::DT_FLOAT32, *ids.hdr, mesh.hdr);
    for (std::size_t c = 0; c < mesh.channels.size(); ++c) {
        std::vector<std::array<float, 1>> values;
        for (const float value : mesh.channels[c]) values.push_back({value});
        add(draco::DT_FLOAT32, ids.channels[c], values);
    }

    if (ids.texcoord)
        add_attribute(out, draco::GeometryAttribute::TEX_COORD, draco::DT_FLOAT32, false, *ids.texcoord,
                      mesh.texcoord);

    const auto encode = [&](const Predictions& predictions) {
        draco::ExpertEncoder encoder(out);
        encoder.SetEncodingMethod(mode == DracoMode::kEdgebreaker ? draco::MESH_EDGEBREAKER_ENCODING
                                                                  : draco::MESH_SEQUENTIAL_ENCODING);
        encoder.SetSpeedOptions(0, 0);  // smallest; base meshes are small
        quantize_positions(encoder, position, mesh);
        if (predictions.parallelogram)
            encoder.SetAttributePredictionScheme(position, draco::MESH_PREDICTION_PARALLELOGRAM);
        if (predictions.plain_color) encoder.SetAttributePredictionScheme(color, draco::PREDICTION_NONE);
        draco::EncoderBuffer buffer;
        const draco::Status status = encoder.EncodeToBuffer(&buffer);
        if (!status.ok())
            throw Error(ErrorKind::kInternal,
                        cat("Draco cannot encode the mesh: ", status.error_msg_string()));
        return std::vector<std::uint8_t>(buffer.data(), buffer.data() + buffer.size());
    };
    DracoMesh result{encode({}), {}};
    Predictions best;
    const auto improve = [&](Predictions other) {
        std::vector<std::uint8_t> bytes = encode(other);
        if (bytes.size() >= result.bytes.size()) return;
        result.bytes = std::move(bytes);
        best = other;
    };
    if (ids.color && has_color_levels(mesh)) improve({best.parallelogram, true});
    if (mode == DracoMode::kEdgebreaker && is_mostly_coarse(mesh)) improve({true, best.plain_color});
    Findings findings = Findings::strict();
    result.decoded = decode(result.bytes, ids, mode == DracoMode::kEdgebreaker, findings);
    return result;
}

DracoMode draco_mode(std::span<const std::uint8_t> bytes) {
    return read_header(bytes).method == draco::MESH_EDGEBREAKER_ENCODING ? DracoMode::kEdgebreaker
                                                                         : DracoMode::kSequential;
}

StoredMesh decode_draco_mesh(std::span<const std::uint8_t> bytes, const DracoAttributeIds& ids,
                             std::uint64_t vertices, std::uint64_t faces, Findings& findings) {
    const Header header = read_header(bytes);
    // Edgebreaker may split vertices but not merge them; each face has three.
    const bool edgebreaker = header.method == draco::MESH_EDGEBREAKER_ENCODING;
    if (header.faces != faces || vertices > 3 * faces ||
        (edgebreaker ? header.vertices > vertices : header.vertices != vertices))
        refuse("mesh.counts", cat("the Draco mesh has ", header.vertices, " vertices and ", header.faces,
                                  " faces, expected ", vertices, " and ", faces));
    if (header.seams >= attribute_count(ids))
        refuse("draco.attributes", cat("the Draco mesh has ", header.seams + 1,
                                       " attributes or more, expected ", attribute_count(ids)));

    StoredMesh mesh = decode(bytes, ids, edgebreaker, findings);
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

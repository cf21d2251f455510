// Draco by its library.
#include <draco/compression/expert_encode.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/mesh/mesh.h>

#include <memory>
#include <type_traits>

#include "formats/findings/findings.h"
#include "formats/gltf/draco_codec.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

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

template <typename T, std::size_t N>
bool is_attribute(const draco::PointAttribute& a, draco::GeometryAttribute::Type type) {
    const draco::DataType data = std::is_same_v<T, float> ? draco::DT_FLOAT32 : draco::DT_UINT16;
    return a.attribute_type() == type && a.data_type() == data && a.num_components() == static_cast<int>(N);
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

}  // namespace

StoredMesh draco_decode(std::span<const std::uint8_t> bytes, const DracoAttributeIds& ids, DracoMode mode,
                        Findings& findings) {
    const int attributes = attribute_count(ids);
    const bool edgebreaker = mode == DracoMode::kEdgebreaker;
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

bool draco_takes_predictions() {
    return true;
}

std::vector<std::uint8_t> draco_encode(const StoredMesh& mesh, const DracoAttributeIds& ids, DracoMode mode,
                                       const DracoGrid& grid, const DracoPredictions& predictions) {
    draco::Mesh out;
    out.set_num_points(static_cast<std::uint32_t>(mesh.position.size()));
    out.SetNumFaces(mesh.faces.size());
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        const auto [a, b, c] = mesh.faces[f];
        out.SetFace(draco::FaceIndex(f), {draco::PointIndex(a), draco::PointIndex(b), draco::PointIndex(c)});
    }
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

    draco::ExpertEncoder encoder(out);
    encoder.SetEncodingMethod(mode == DracoMode::kEdgebreaker ? draco::MESH_EDGEBREAKER_ENCODING
                                                              : draco::MESH_SEQUENTIAL_ENCODING);
    encoder.SetSpeedOptions(0, 0);  // smallest; base meshes are small
    encoder.SetAttributeExplicitQuantization(position, grid.bits, 3, grid.origin.data(), grid.range);
    if (predictions.parallelogram)
        encoder.SetAttributePredictionScheme(position, draco::MESH_PREDICTION_PARALLELOGRAM);
    if (predictions.plain_color) encoder.SetAttributePredictionScheme(color, draco::PREDICTION_NONE);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeToBuffer(&buffer);
    if (!status.ok())
        throw Error(ErrorKind::kInternal, cat("Draco cannot encode the mesh: ", status.error_msg_string()));
    return {buffer.data(), buffer.data() + buffer.size()};
}

}  // namespace imgmesh

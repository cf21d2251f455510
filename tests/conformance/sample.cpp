#include "tests/conformance/sample.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "formats/gltf/draco_mesh.h"
#include "formats/gltf/glb.h"
#include "tests/support/small_pictures.h"

namespace imgmesh::conformance {
namespace {

constexpr int kSide = 3;

AssetLevel store(const StoredMesh& mesh, DracoMode mode, double error, Bytes& buffer) {
    AssetLevel level;
    const StoredMesh* stored = &mesh;
    DracoMesh draco;
    if (mode == DracoMode::kOff) {
        level.indices = append_values(buffer, mesh.faces);
        level.positions = append_values(buffer, mesh.position);
        level.colors = append_values(buffer, mesh.color);
        level.hdr = append_values(buffer, mesh.hdr);
        for (const std::vector<float>& channel : mesh.channels)
            level.channels.push_back(append_values(buffer, channel));
        level.texcoords = append_values(buffer, mesh.texcoord);
    } else {
        draco = encode_draco_mesh(mesh, mode);
        level.is_draco = true;
        level.draco = append_values(buffer, draco.bytes);
        stored = &draco.decoded;
    }
    level.has_texcoords = !mesh.texcoord.empty();
    level.vertices = stored->position.size();
    level.faces = stored->faces.size();
    level.error = error;
    level.topology = topology_hash(*stored);
    level.bounds = bounds_of(stored->position);
    return level;
}

Bytes encode_compact(const std::vector<LayerPart>& parts, const std::function<void(CompactPart&)>& edit) {
    std::vector<CompactPart> all;
    for (const LayerPart& part : parts) {
        const std::size_t pixels = part.map.size();
        CompactPart compact{part.name, {}, part.map.precision, part.visits, part.topology};
        compact.map = {{part.map.width, part.map.height},
                       8,
                       std::vector<std::int16_t>(pixels),
                       std::vector<std::int16_t>(pixels),
                       Mask(part.map)};
        for (std::size_t i = 0; i < pixels; ++i) compact.map.inside[i] = part.map[i].face != kNone;
        if (edit) edit(compact);
        all.push_back(compact);
    }
    return encode_compact_layers(all);
}

}  // namespace

void write_bytes(const std::filesystem::path& path, const Bytes& bytes) {
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
}

Exr::Exr(int width, int height, const std::string& topology)
    : header(width, height),
      face(static_cast<std::size_t>(width * height), 0),
      u(face.size(), 0.25f),
      v(face.size(), 0.5f) {
    header.setName("lod0");
    header.compression() = Imf::ZIP_COMPRESSION;
    header.insert("imgmesh:version", Imf::StringAttribute("1.0"));
    header.insert("imgmesh:topology", Imf::StringAttribute(topology));
    header.channels().insert("face.id", Imf::Channel(Imf::UINT));
    header.channels().insert("bary.u", Imf::Channel(Imf::FLOAT));
    header.channels().insert("bary.v", Imf::Channel(Imf::FLOAT));
}

Bytes Exr::bytes() const {
    const Imath::Box2i window = header.dataWindow();
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
    Imf::FrameBuffer frame;
    const auto insert = [&](const char* name, Imf::PixelType type, const void* data) {
        if (header.channels().findChannel(name))
            frame.insert(name, Imf::Slice(type, static_cast<char*>(const_cast<void*>(data)), 4, 4 * width));
    };
    insert("face.id", Imf::UINT, face.data());
    insert("bary.u", Imf::FLOAT, u.data());
    insert("bary.v", Imf::FLOAT, v.data());
    insert("G", Imf::FLOAT, v.data());
    const std::filesystem::path path = std::filesystem::temp_directory_path() /
                                       ("imgmesh-conformance-" + std::to_string(::getpid()) + ".exr");
    if (tiled) {
        Imf::TiledOutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        for (int level = 0; level < file.numLevels(); ++level)
            file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    } else {
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writePixels(window.max.y - window.min.y + 1);
    }
    std::ifstream in(path, std::ios::binary);
    Bytes result{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    std::filesystem::remove(path);
    return result;
}

Sample::Sample(int levels, DracoMode mode) {
    asset.version = "1.1";
    asset.generator = "imgmesh-conformance 1";
    asset.source.width = asset.source.height = kSide;
    for (int k = 0; k < levels; ++k) {
        StoredMesh mesh;
        mesh.position = {{0, 0, 0}, {0, -2, 0}, {2, -2, 0}, {2, 0, 0}};
        mesh.color = {{0, 0, 0, 65535}, {65535, 0, 0, 65535}, {0, 65535, 0, 65535}, {9, 9, 65535, 65535}};
        mesh.faces = {{0, 1, 2}, {0, 2, 3}};
        meshes.push_back(mesh);
        PixelMap map{kSide, kSide, {}, WeightPrecision::kHalf};
        for (Id i = 0; i < kSide * kSide; ++i) map.values.push_back({i % 2, 0.25f, 0.5f});
        parts.push_back({level_name(static_cast<std::size_t>(k)), map, {}, {}});
        modes.push_back(mode);
    }
}

void Sample::add_texture() {
    texture = red_png();
    for (StoredMesh& mesh : meshes)
        mesh.texcoord = {
            {0.5f / 3, 0.5f / 3}, {0.5f / 3, 2.5f / 3}, {2.5f / 3, 2.5f / 3}, {2.5f / 3, 0.5f / 3}};
}

void Sample::write(const std::filesystem::path& folder, bool glb) const {
    std::filesystem::create_directories(folder);
    Asset a = asset;
    Bytes buffer;
    std::vector<LayerPart> layers = parts;
    for (std::size_t k = 0; k < meshes.size(); ++k) {
        a.levels.push_back(store(meshes[k], modes[k], static_cast<double>(k), buffer));
        if (layers[k].topology.empty()) layers[k].topology = a.levels[k].topology;
    }
    if (!texture.empty()) {
        a.texture_type = "image/png";
        a.texture = append_values(buffer, texture);
    }
    Bytes layer_bytes;
    if (a.layout == LayerLayout::kCompact) {
        layer_bytes = encode_compact(layers, edit_compact);
    } else if (edit_exr) {
        Exr exr(kSide, kSide, a.levels[0].topology);
        edit_exr(exr);
        layer_bytes = exr.bytes();
    } else {
        layer_bytes = encode_exr_layers(layers);
    }
    if (edit_layers) edit_layers(layer_bytes);
    if (edit_bin) edit_bin(buffer);
    a.buffer_length = buffer.size();
    if (glb) {
        a.layers = append_values(buffer, layer_bytes);
        a.buffer_length = buffer.size();
    } else {
        a.buffer_name = "x.bin";
        a.layers_name = std::string("x") + sidecar_extension(a.layout);
    }
    json document = json::parse(json_from_asset(a));
    if (edit_json) edit_json(document);
    std::string text = document.dump();
    if (edit_text) edit_text(text);
    if (glb) {
        Bytes file = pack_glb(text, buffer);
        if (edit_glb) edit_glb(file);
        write_bytes(folder / "x.glb", file);
        return;
    }
    write_bytes(folder / "x.gltf", {text.begin(), text.end()});
    write_bytes(folder / "x.bin", buffer);
    write_bytes(folder / a.layers_name, layer_bytes);
}

}  // namespace imgmesh::conformance

// EXR files of any parts and channels for tests, written by OpenEXR.
#pragma once

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledOutputPart.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

/// A channel of which all samples are `value`, except those of `values`.
struct ExrPlane {
    std::string name;
    float value = 0;
    Imf::PixelType type = Imf::HALF;
    std::vector<float> values = {};  ///< of all pixels, or empty
    int sampling = 1;
    std::uint32_t integer = 0;  ///< of UINT
};

struct ExrPart {
    std::string name;
    std::vector<ExrPlane> planes;
    std::function<void(Imf::Header&)> change = {};
};

/// Writes a file of one part without a name, or of several. A part to which `change` gives tiles has them;
/// the smaller levels are cut out of the largest.
inline void write_exr_file(const std::string& path, const std::vector<ExrPart>& parts, int width = 4,
                           int height = 4) {
    std::vector<Imf::Header> headers;
    for (const ExrPart& part : parts) {
        Imf::Header& header = headers.emplace_back(width, height);
        for (const ExrPlane& plane : part.planes)
            header.channels().insert(plane.name, Imf::Channel(plane.type, plane.sampling, plane.sampling));
        if (parts.size() > 1) header.setName(part.name);
        if (part.change) part.change(header);
        header.setType(header.hasTileDescription() ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
    }
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const Imath::Box2i window = headers[k].dataWindow();
        const auto w = static_cast<std::size_t>(window.size().x) + 1,
                   h = static_cast<std::size_t>(window.size().y) + 1;
        std::deque<std::vector<float>> floats;
        std::deque<std::vector<Imath::half>> halves;
        std::deque<std::vector<std::uint32_t>> integers;
        Imf::FrameBuffer buffer;
        for (const ExrPlane& plane : parts[k].planes) {
            const auto s = static_cast<std::size_t>(plane.sampling);
            const auto insert = [&](const auto& samples) {
                const std::size_t size = sizeof(samples[0]), stride = size * (w / s);
                const auto origin = static_cast<std::ptrdiff_t>(size) * (window.min.x / plane.sampling) +
                                    static_cast<std::ptrdiff_t>(stride) * (window.min.y / plane.sampling);
                buffer.insert(
                    plane.name,
                    Imf::Slice(plane.type,
                               const_cast<char*>(reinterpret_cast<const char*>(samples.data())) - origin,
                               size, stride, plane.sampling, plane.sampling));
            };
            std::vector<float> samples = plane.values;
            samples.resize(w / s * (h / s), plane.value);
            if (plane.type == Imf::UINT)
                insert(integers.emplace_back(samples.size(), plane.integer));
            else if (plane.type == Imf::FLOAT)
                insert(floats.emplace_back(std::move(samples)));
            else
                insert(halves.emplace_back(samples.begin(), samples.end()));
        }
        if (headers[k].hasTileDescription()) {
            Imf::TiledOutputPart out(file, static_cast<int>(k));
            out.setFrameBuffer(buffer);
            for (int v = 0; v < out.numYLevels(); ++v)
                for (int u = 0; u < out.numXLevels(); ++u)
                    if (out.isValidLevel(u, v))
                        out.writeTiles(0, out.numXTiles(u) - 1, 0, out.numYTiles(v) - 1, u, v);
            continue;
        }
        Imf::OutputPart out(file, static_cast<int>(k));
        out.setFrameBuffer(buffer);
        out.writePixels(static_cast<int>(h));
    }
}

/// Channels PREFIX.R, PREFIX.G and PREFIX.B of these values, or R, G and B.
inline std::vector<ExrPlane> exr_colors(const std::string& prefix, float red, float green, float blue) {
    const std::string dot = prefix.empty() ? "" : prefix + ".";
    return {{dot + "R", red}, {dot + "G", green}, {dot + "B", blue}};
}

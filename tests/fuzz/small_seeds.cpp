#include "tests/fuzz/small_seeds.h"

#include <string_view>

#include "tests/support/bmp_file.h"
#include "tests/support/small_pictures.h"
#include "tests/support/tga_file.h"

namespace imgmesh::fuzz {
namespace {

FileBytes noise(std::size_t count) {
    FileBytes out;
    std::mt19937 random(static_cast<std::uint32_t>(count));
    for (std::size_t i = 0; i < count; ++i) out.put({static_cast<int>(random() % 256)});
    return out;
}

}  // namespace

std::vector<Bytes> bmp_seeds() {
    std::vector<Bytes> all;
    const auto add = [&](const Bmp& bmp) { all.push_back(bmp.file().bytes); };
    const int width = 7, height = 5;
    for (const std::uint32_t header : {12u, 16u, 40u, 52u, 56u, 64u, 108u, 124u})
        for (const int bits : {1, 2, 4, 8, 24, 32}) {
            const std::size_t row = static_cast<std::size_t>((width * bits + 31) / 32 * 4);
            const std::size_t colors = bits <= 8 ? std::size_t{1} << bits : 0;
            add({width, height, bits, 0, header, {}, noise(colors * (header == 12 ? 3 : 4)), noise(row * 5)});
        }
    for (const std::uint32_t header : {40u, 52u, 56u, 124u})
        add({width, height, 16, 3, header, {0xF800, 0x7E0, 0x1F}, {}, noise(16 * 5)});
    add({width, -height, 32, 6, 40, {0xFF, 0xFF00, 0xFF0000, 0xFF000000}, {}, noise(28 * 5)});
    add({width, height, 32, 3, 124, {0xFFC00000, 0x3FF000, 0xFFC, 3, 0, 1, 2, 3}, {}, noise(28 * 5)});
    const FileBytes runs8 =
        FileBytes().put({7, 1, 0, 0, 0, 5, 1, 2, 3, 4, 5, 0, 2, 9, 0, 0, 0, 2, 1, 2, 3, 3, 0, 1});
    add({width, height, 8, 1, 40, {}, noise(64), runs8, 16});
    const FileBytes runs4 =
        FileBytes().put({7, 0x12, 0, 0, 0, 5, 0x12, 0x34, 0x50, 0, 0, 2, 2, 2, 3, 0x44, 0, 1});
    add({width, height, 4, 2, 40, {}, noise(64), runs4, 16});
    FileBytes png;
    png.bytes = red_png();
    add({1, 1, 0, 5, 40, {}, {}, png});
    return all;
}

std::vector<Bytes> tga_seeds() {
    std::vector<Bytes> all;
    const int width = 7, height = 5;
    for (const int type : {1, 2, 3})
        for (const int bits : {8, 15, 16, 24, 32}) {
            if ((type == 2) == (bits == 8) || (type != 2 && bits > 8 && bits != 16)) continue;
            Tga tga{
                type,  bits,  type == 2 ? 0x28 : 0x10, noise(static_cast<std::size_t>(35 * ((bits + 7) / 8))),
                width, height};
            if (type == 1) {
                tga.palette_size = 200;
                tga.palette_bits = bits == 8 ? 16 : 32;
                tga.palette = noise(static_cast<std::size_t>(200 * tga.palette_bits / 8));
            }
            all.push_back(tga.file().bytes);
            tga.type += 8;
            FileBytes runs;
            for (int left = 35; left > 0; left -= 5)  // runs and pieces in turn, across rows
                runs.put({left % 2 ? 0x84 : 4})
                    .put(noise(static_cast<std::size_t>((left % 2 ? 1 : 5) * ((bits + 7) / 8))));
            tga.pixels = runs;
            tga.attributes = 3;
            tga.id = "an image";
            all.push_back(tga.file().bytes);
        }
    return all;
}

std::vector<Bytes> netpbm_seeds() {
    std::vector<Bytes> all;
    const auto add = [&](std::string_view header, std::size_t pixels) {
        all.push_back(FileBytes(header).put(noise(pixels)).bytes);
    };
    add("P1\n# bits\n5 3\n01010 1 1 0 0 1\n11111", 0);
    add("P2 3 2 1000\n1 2 3 # four\n999 1000 0\n", 0);
    add("P3 2 1 255 1 2 3 4 5 6", 0);
    add("P4 11 3\n", 6);
    add("P5\n7 5 200\n", 35);
    add("P5 7 5 65535\n", 70);
    add("P6 7 5 255\n", 105);
    add("PF 3 2 -1.0\n", 72);
    add("Pf 3 2 2.5e0\n", 24);
    add("P7\nWIDTH 7\nHEIGHT 5\nDEPTH 4\nMAXVAL 255\nTUPLTYPE RGB_ALPHA\nENDHDR\n", 140);
    add("P7\nWIDTH 7\nHEIGHT 5\nDEPTH 2\nMAXVAL 999\nTUPLTYPE GRAYSCALE_ALPHA\nENDHDR\n", 140);
    add("P7\nWIDTH 3\nHEIGHT 2\nDEPTH 5\nMAXVAL 255\nTUPLTYPE CMYK_ALPHA\nENDHDR\n", 30);
    return all;
}

}  // namespace imgmesh::fuzz

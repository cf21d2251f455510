// PNG files that are damaged where no pixel is, that state their colours and orientation in every way, and
// some that cannot be read.
#include <doctest/doctest.h>
#include <libdeflate.h>

#include <algorithm>

#include "formats/picture/color/icc_profile.h"
#include "formats/picture/image_io.h"
#include "libcore/image/color.h"
#include "tests/support/picture_files.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;
using Bytes = std::vector<std::uint8_t>;

namespace {

struct Chunk {
    std::string name;
    std::string content;
    bool sound = true;  ///< its checksum is right
};

std::string big(std::uint32_t value) {
    std::string out;
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xFF);
    return out;
}

std::uint32_t checksum(const std::string& bytes) {
    return static_cast<std::uint32_t>(libdeflate_crc32(0, bytes.data(), bytes.size()));
}

std::string zlib(const std::string& content) {
    libdeflate_compressor* const packer = libdeflate_alloc_compressor(6);
    std::string out(libdeflate_zlib_compress_bound(packer, content.size()), '\0');
    out.resize(libdeflate_zlib_compress(packer, content.data(), content.size(), out.data(), out.size()));
    libdeflate_free_compressor(packer);
    return out;
}

// The chunks of a file of ours: IHDR, sRGB, gAMA, IDAT, IEND.
std::vector<Chunk> chunks_of(const Bytes& file) {
    std::vector<Chunk> out;
    for (std::size_t at = 8; at + 12 <= file.size();) {
        const std::size_t size = std::size_t{file[at + 2]} << 8 | file[at + 3];
        const auto name = file.begin() + static_cast<std::ptrdiff_t>(at + 4);
        out.push_back({{name, name + 4}, {name + 4, name + 4 + static_cast<std::ptrdiff_t>(size)}});
        at += 12 + size;
    }
    return out;
}

std::string text_of(const std::vector<Chunk>& chunks) {
    std::string out = "\x89PNG\r\n\x1a\n";
    for (const Chunk& chunk : chunks)
        out += big(static_cast<std::uint32_t>(chunk.content.size())) + chunk.name + chunk.content +
               big(checksum(chunk.name + chunk.content) ^ (chunk.sound ? 0 : 1));
    return out;
}

class Damaged {
  public:
    Damaged() : made(random_picture(20, 10, 3)) {
        write_image(path, made);
        chunks = chunks_of(load(path));
        std::erase_if(chunks, [](const Chunk& c) { return c.name == "sRGB" || c.name == "gAMA"; });
        REQUIRE(chunks.size() == 3);
    }

    Chunk& pixels() {
        return *std::ranges::find_if(chunks, [](const Chunk& c) { return c.name == "IDAT"; });
    }
    void add(const Chunk& chunk) { chunks.insert(chunks.begin() + 1, chunk); }

    ReadImage read() { return read(text_of(chunks)); }
    ReadImage read(const std::string& file) {
        save(path, {file.begin(), file.end()});
        return read_image_file(path);
    }
    void check_whole(std::size_t warnings) {
        const ReadImage found = read();
        CHECK(found.image.data == made.data);
        CHECK(found.warnings.size() == warnings);
    }
    void check_refused(ErrorKind kind, const std::string& words) {
        std::string text;
        CHECK(error_of([&] { read(); }, &text) == kind);
        CHECK_MESSAGE(text.find(words) != std::string::npos, text);
    }

    TemporaryFolder folder;
    std::string path = folder / "d.png";
    Image made;
    std::vector<Chunk> chunks;
};

// Orientation 6 as EXIF.
const std::string kExif("MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0", 26);

std::string hexadecimal(const std::string& bytes) {
    std::string out;
    for (const char c : bytes) {
        constexpr char kDigits[] = "0123456789abcdef";
        out += kDigits[static_cast<unsigned char>(c) >> 4];
        out += kDigits[c & 15];
        if (out.size() % 73 == 72) out += '\n';
    }
    return out;
}

}  // namespace

TEST_CASE("png: what is not a pixel may be broken") {
    const std::string text("Comment\0hello", 13);
    SUBCASE("a text with a wrong checksum") {
        Damaged png;
        png.add({"tEXt", text, false});
        png.check_whole(0);
    }
    SUBCASE("chunks that no one knows") {
        Damaged png;
        png.add({"zzZz", std::string(5000, 'x'), false});
        png.check_whole(0);
    }
    SUBCASE("a profile with a wrong checksum, one that does not unpack, one that is none") {
        for (const auto& [content, sound] : {std::pair(std::string("n\0\0", 3) + zlib("abc"), false),
                                             std::pair(std::string("n\0\0abcdefgh", 11), true),
                                             std::pair(std::string("n\0\0", 3) + zlib("abc"), true)}) {
            Damaged png;
            png.add({"iCCP", content, sound});
            png.check_whole(1);
        }
    }
    SUBCASE("no end, half an end, bytes after the end") {
        Damaged png;
        const std::string whole = text_of(png.chunks);
        for (std::size_t cut = 1; cut <= 20;
             ++cut) {  // IEND, the checksum of the pixels, and theirs unpacked
            INFO("without the last " << cut);
            const ReadImage found = png.read(whole.substr(0, whole.size() - cut));
            CHECK(found.image.data == png.made.data);
            CHECK(found.warnings.size() == 1);
        }
        CHECK(png.read(whole + "more").warnings.empty());
        png.chunks.pop_back();
        CHECK(png.read(text_of(png.chunks) + "\x01\x02garbage and more of it").image.data == png.made.data);
    }
    SUBCASE("one of the two checksums of the pixels is wrong") {
        Damaged png;
        png.pixels().sound = false;
        png.check_whole(1);
        png.pixels().sound = true;
        png.pixels().content.back() ^= 1;
        png.check_whole(1);
        png.pixels().sound = false;
        png.check_refused(ErrorKind::kBadFile, "the checksum of its pixels is wrong");
    }
    SUBCASE("more pixels than the header says, and in many pieces") {
        Damaged png;
        const std::string whole = png.pixels().content;
        png.chunks.erase(png.chunks.begin() + 1);
        for (std::size_t i = whole.size(); i-- > 0;) png.add({"IDAT", whole.substr(i, 1)});
        png.check_whole(0);
        png.chunks[0].content[7] = 9;  // rows
        const ReadImage found = png.read();
        CHECK(found.image.height == 9);
        CHECK(found.warnings.size() == 1);
        png.chunks[0].content[7] = 11;
        png.check_refused(ErrorKind::kBadFile, "truncated: it has 610 bytes of pixels, expected 671");
    }
}

TEST_CASE("png: what pixels need must be sound") {
    Damaged png;
    png.chunks[0].sound = false;
    png.check_refused(ErrorKind::kBadFile, "the checksum of its header");
    png.chunks[0].sound = true;
    png.add({"ABCD", ""});
    png.check_refused(ErrorKind::kUnsupported, "ABCD");
    png.chunks[1] = {"PLTE", "abcd"};
    png.check_refused(ErrorKind::kBadFile, "its palette has 4 bytes");
    png.chunks.erase(png.chunks.begin() + 1);
    png.chunks.insert(png.chunks.begin(), {"CgBI", std::string("P\0 \x02", 4)});
    png.check_refused(ErrorKind::kUnsupported, "CgBI");
    png.chunks.erase(png.chunks.begin());
    png.pixels().content[0] = '\x79';
    png.check_refused(ErrorKind::kBadFile, "packed in an unknown way");
    std::erase_if(png.chunks, [](const Chunk& c) { return c.name == "IDAT"; });
    png.check_refused(ErrorKind::kBadFile, "no pixels");
    png.chunks.erase(png.chunks.begin());
    png.check_refused(ErrorKind::kBadFile, "no header");
}

// Each of the texts would inflate to more than any file of metadata has; none is looked at.
TEST_CASE("png: texts that inflate without end cost nothing") {
    Damaged png;
    const std::string bomb = zlib(std::string(std::size_t{40} << 20, '0'));
    for (int i = 0; i < 50; ++i) {
        png.add({"zTXt", std::string("Comment\0\0", 9) + bomb});
        png.add({"zTXt", std::string("Raw profile type exif\0\0", 23) + bomb});
    }
    png.check_whole(0);
    png.add({"iCCP", std::string("n\0\0", 3) + bomb});
    png.check_whole(1);
}

TEST_CASE("png: orientation wherever it is said, EXIF before XMP") {
    const std::string raw = "\nexif\n      32\n" + hexadecimal(std::string("Exif\0\0", 6) + kExif) + "\n";
    const std::string attribute = "<rdf:Description tiff:Orientation=\"6\"/>",
                      element = "<tiff:Orientation>8</tiff:Orientation>";
    const std::string itxt("XML:com.adobe.xmp\0\0\0\0\0", 22), packed("XML:com.adobe.xmp\0\1\0en\0x\0", 25);
    const auto top_left = [](const std::vector<Chunk>& added) {
        Damaged png;
        for (const Chunk& chunk : added) png.add(chunk);
        const ReadImage found = png.read();
        CHECK(found.warnings.empty());
        REQUIRE(found.image.width == 10);
        // 6 shows the bottom left of what is stored at the top left, 8 the top right.
        const float first = found.image.pixel(0, 0)[0];
        return first == png.made.pixel(0, 9)[0] ? 6 : first == png.made.pixel(19, 0)[0] ? 8 : 0;
    };
    CHECK(top_left({{"eXIf", kExif}}) == 6);
    CHECK(top_left({{"zTXt", std::string("Raw profile type exif\0\0", 23) + zlib(raw)}}) == 6);
    CHECK(top_left({{"tEXt", std::string("Raw profile type APP1\0", 22) + raw}}) == 6);
    CHECK(top_left({{"iTXt", std::string("Raw profile type exif\0\0\0\0\0", 26) + raw}}) == 6);
    CHECK(top_left({{"iTXt", itxt + attribute}}) == 6);
    CHECK(top_left({{"iTXt", itxt + element}}) == 8);
    CHECK(top_left({{"iTXt", packed + zlib(element)}}) == 8);
    CHECK(top_left({{"iTXt", itxt + element}, {"eXIf", kExif}}) == 6);
    CHECK(top_left({{"eXIf", kExif}, {"iTXt", itxt + element}}) == 6);
}

// PNG, third edition, section 4.3: cICP, then iCCP, then sRGB, then cHRM and gAMA.
TEST_CASE("png: of several statements about colours the first of the specification's order counts") {
    const auto icc = icc_from_color_space(ColorSpace::kDisplayP3);
    const Chunk cicp{"cICP", std::string("\x01\x08\x00\x01", 4)},
        iccp{"iCCP", std::string("n\0\0", 3) + zlib({icc.begin(), icc.end()})},
        srgb{"sRGB", std::string(1, '\0')}, gama{"gAMA", big(45470)},
        chrm{"cHRM", big(31270) + big(32900) + big(64000) + big(33000) + big(21000) + big(71000) +
                         big(15000) + big(6000)};
    const auto space = [](std::vector<Chunk> added) {
        ColorSpace found[2];
        for (ColorSpace& each : found) {  // their order in the file does not matter
            Damaged png;
            for (const Chunk& chunk : added) png.add(chunk);
            const ReadImage read = png.read();
            CHECK(read.warnings.empty());
            CHECK(read.image.data == png.made.data);
            each = read.image.color_space;
            std::ranges::reverse(added);
        }
        CHECK(found[0] == found[1]);
        return found[0];
    };
    CHECK(space({cicp, iccp, srgb, chrm, gama}) == ColorSpace::kLinear);
    CHECK(space({iccp, srgb, chrm, gama}) == ColorSpace::kDisplayP3);
    CHECK(space({srgb, chrm, gama}) == ColorSpace::kSrgb);
    CHECK(space({chrm, gama}) == ColorSpace::kAdobeRgb);
    CHECK(space({gama}) == ColorSpace::kGamma22);

    Damaged png;
    png.add({"cICP", std::string("\x09\x10\x00\x01", 4)});
    const Image pq = png.read().image;
    CHECK(pq.color_space == ColorSpace::kLinear);
    CHECK(pq.sample_type == SampleType::kHalf);
    CHECK(*std::ranges::max_element(pq.data) > 10);
    png.chunks[1].content = std::string("\x09\x10\x09\x00", 4);  // neither RGB nor of full range
    CHECK(png.read().warnings.size() == 1);
}

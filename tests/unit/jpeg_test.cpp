// JPEG compared with OpenImageIO on every kind, and files that are damaged where no pixel is, or where one
// is.
#include <doctest/doctest.h>

#include <algorithm>

#include "formats/picture/color/icc_profile.h"
#include "formats/picture/image_io.h"
#include "tests/support/jpeg_writer.h"
#include "tests/support/picture_files.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;
using Bytes = std::vector<std::uint8_t>;

namespace {

Image smooth(int width, int height, int channels) {
    Image image = make_image(width, height, channels);
    std::mt19937 random(5);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c)
                image.pixel(x, y)[c] =
                    static_cast<float>((x * 3 + y * 2 + c * 40 + static_cast<int>(random() % 20)) % 256) /
                    255.0f;
    return image;
}

std::vector<float> oiio_samples(const std::string& path) {
    const auto input = OIIO::ImageInput::open(path);
    REQUIRE(input);
    const OIIO::ImageSpec spec = input->spec();
    Bytes codes(static_cast<std::size_t>(spec.width * spec.height * spec.nchannels));
    REQUIRE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeUInt8, codes.data()));
    std::vector<float> out;
    for (const std::uint8_t code : codes) out.push_back(static_cast<float>(code) / 255.0f);
    return out;
}

// Puts a segment after SOI.
Bytes with_segment(const Bytes& file, int marker, const std::string& content) {
    Bytes out(file.begin(), file.begin() + 2);
    const std::size_t size = content.size() + 2;
    for (const std::size_t byte :
         {std::size_t{0xFF}, static_cast<std::size_t>(marker), size >> 8, size & 0xFF})
        out.push_back(static_cast<std::uint8_t>(byte));
    out.insert(out.end(), content.begin(), content.end());
    out.insert(out.end(), file.begin() + 2, file.end());
    return out;
}

// The place of the first marker of that number, from `from` on.
std::size_t find_marker(const Bytes& file, int marker, std::size_t from = 2) {
    for (std::size_t i = from; i + 1 < file.size(); ++i)
        if (file[i] == 0xFF && file[i + 1] == marker) return i;
    FAIL("no such marker");
    return 0;
}

void insert(Bytes& file, std::size_t at, const Bytes& more) {
    file.insert(file.begin() + static_cast<std::ptrdiff_t>(at), more.begin(), more.end());
}

struct Reader {
    TemporaryFolder folder;
    std::string path = folder / "j.jpg";

    ReadImage read(const Bytes& file) {
        save(path, file);
        return read_image_file(path);
    }
    void check_same(const Bytes& damaged, const Image& whole, std::size_t warnings) {
        const ReadImage found = read(damaged);
        CHECK(found.image.data == whole.data);
        CHECK(found.warnings.size() == warnings);
    }
    void check_refused(const Bytes& file, ErrorKind kind, const std::string& words) {
        std::string text;
        CHECK(error_of([&] { read(file); }, &text) == kind);
        CHECK_MESSAGE(text.find(words) != std::string::npos, text);
    }
};

}  // namespace

TEST_CASE("jpeg: every kind reads as OpenImageIO reads it") {
    Reader reader;
    for (const int channels : {1, 3, 4})
        for (const auto& [horizontal, vertical] : {std::pair(1, 1), {2, 1}, {1, 2}, {2, 2}, {4, 1}})
            for (const bool progressive : {false, true})
                for (const bool arithmetic : {false, true})
                    for (const int restart : {0, 1}) {
                        INFO(channels << " channels " << horizontal << "x" << vertical << " progressive "
                                      << progressive << " arithmetic " << arithmetic << " restart "
                                      << restart);
                        const Bytes file =
                            encoded(smooth(61, 43, channels),
                                    {channels, horizontal, vertical, progressive, arithmetic, restart});
                        ReadImage read = reader.read(file);
                        CHECK(read.warnings.empty());
                        const std::vector<float> theirs = oiio_samples(reader.path);
                        REQUIRE(read.image.data.size() == theirs.size());
                        float worst = 0;
                        for (std::size_t i = 0; i < theirs.size(); ++i)
                            worst = std::max(worst, std::abs(read.image.data[i] - theirs[i]));
                        // It rounds what it mixes of inks to 8 bits.
                        CHECK(worst <= (channels == 4 ? 1.0f / 255 : 0.0f));
                        CHECK(read.image.sample_type == SampleType::kUint8);
                    }
}

TEST_CASE("jpeg: ink is upside down if the file is Adobe's, and else not") {
    Reader reader;
    Image ink = make_image(16, 16, 4);  // full light is no ink
    std::ranges::fill(ink.data, 1.0f);
    for (const J_COLOR_SPACE space : {JCS_CMYK, JCS_YCCK}) {
        const Bytes file = encoded(ink, {.channels = 4, .ink = space});
        const Image white = reader.read(file).image;
        CHECK(white.channel_names == std::vector<std::string>{"R", "G", "B"});
        CHECK(*std::ranges::min_element(white.data) > 0.98f);
    }
    const Image black = reader.read(encoded(ink, {.channels = 4, .ink = JCS_CMYK, .adobe = false})).image;
    CHECK(*std::ranges::max_element(black.data) < 0.02f);
}

TEST_CASE("jpeg: stray bytes and a missing end are warnings, missing pixels are an error") {
    Reader reader;
    const Bytes file = encoded(smooth(64, 48, 3), {});
    const Image whole = reader.read(file).image;
    const std::size_t scan = find_marker(file, 0xDA);

    Bytes stray = file;
    insert(stray, scan, {0x11, 0x22, 0x33});  // between two markers
    reader.check_same(stray, whole, 1);
    stray = file;
    insert(stray, file.size() - 2, {0x11, 0x22, 0x33});  // after the pixels
    reader.check_same(stray, whole, 0);
    stray = file;
    insert(stray, file.size(), Bytes(100, 0xAB));  // after the end
    reader.check_same(stray, whole, 0);

    Bytes cut(file.begin(), file.end() - 2);
    reader.check_same(cut, whole, 1);
    cut.resize(cut.size() - 20);
    reader.check_refused(cut, ErrorKind::kBadFile, "premature end");
    cut.resize(scan + 200);
    reader.check_refused(cut, ErrorKind::kBadFile, "cannot read the image");
    cut.resize(scan + 14);
    reader.check_refused(cut, ErrorKind::kBadFile, "truncated");
    cut.resize(scan);
    reader.check_refused(cut, ErrorKind::kBadFile, "truncated");
    cut.resize(40);
    reader.check_refused(cut, ErrorKind::kBadFile, "no image");
}

TEST_CASE("jpeg: a progressive file without its last scans is truncated") {
    Reader reader;
    const Bytes file = encoded(smooth(64, 48, 3), {.progressive = true});
    const Image whole = reader.read(file).image;
    reader.check_same({file.begin(), file.end() - 2}, whole, 1);
    std::size_t last = 0;
    for (std::size_t i = 2; i + 1 < file.size(); ++i)
        if (file[i] == 0xFF && file[i + 1] == 0xDA) last = i;
    const Bytes early(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(last));
    reader.check_refused(early, ErrorKind::kBadFile, "a part of its pixels is missing");
    Bytes arithmetic = encoded(smooth(64, 48, 3), {.arithmetic = true});
    arithmetic.resize(arithmetic.size() - 40);
    reader.check_refused(arithmetic, ErrorKind::kBadFile, "a part of its pixels is missing");
}

TEST_CASE("jpeg: a lost interval between restarts is an error") {
    Reader reader;
    const Bytes file = encoded(smooth(64, 64, 3), {.restart = 1});
    const std::size_t first = find_marker(file, 0xD0), second = find_marker(file, 0xD1);
    Bytes lost(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(first));
    lost.insert(lost.end(), file.begin() + static_cast<std::ptrdiff_t>(second), file.end());
    reader.check_refused(lost, ErrorKind::kBadFile, "cannot read the image");
}

TEST_CASE("jpeg: kinds that are not supported are named") {
    Reader reader;
    Bytes file = encoded(smooth(16, 16, 3), {});
    const std::size_t frame = find_marker(file, 0xC0);
    file[frame + 4] = 12;
    reader.check_refused(file, ErrorKind::kUnsupported, "12 bits");
    file[frame + 4] = 8;
    file[frame + 1] = 0xC3;
    reader.check_refused(file, ErrorKind::kUnsupported, "lossless JPEG");
    // One tiny scan after another.
    Bytes scans = encoded(smooth(16, 16, 3), {.progressive = true});
    const std::size_t first = find_marker(scans, 0xDA), second = find_marker(scans, 0xC4, first);
    const Bytes one(scans.begin() + static_cast<std::ptrdiff_t>(first),
                    scans.begin() + static_cast<std::ptrdiff_t>(second));
    for (int i = 0; i < 150; ++i) insert(scans, second, one);
    reader.check_refused(scans, ErrorKind::kUnsupported, "scans");
}

TEST_CASE("jpeg: profiles in pieces, and Adobe RGB by EXIF") {
    Reader reader;
    const Bytes file = encoded(smooth(16, 16, 3), {});
    const auto icc = icc_from_color_space(ColorSpace::kDisplayP3);
    const std::string profile(icc.begin(), icc.end());
    const auto piece = [&](int number, int count, const std::string& content) {
        return std::string("ICC_PROFILE\0", 12) + static_cast<char>(number) + static_cast<char>(count) +
               content;
    };
    // In any order.
    const Bytes second = with_segment(file, 0xE2, piece(1, 2, profile.substr(0, 100)));
    const Bytes both = with_segment(second, 0xE2, piece(2, 2, profile.substr(100)));
    CHECK(reader.read(both).image.color_space == ColorSpace::kDisplayP3);
    const ReadImage half = reader.read(second);
    CHECK(half.image.color_space == ColorSpace::kSrgb);
    REQUIRE(half.warnings.size() == 1);
    CHECK(half.warnings[0].find("a piece of its ICC profile is missing") != std::string::npos);

    // ColorSpace = 0xFFFF in the EXIF directory, index R03 in the directory of interoperability (DCF 2.0).
    const std::string exif(
        "Exif\0\0MM\0*\0\0\0\x08\0\x01\x87\x69\0\x04\0\0\0\x01\0\0\0\x1A\0\0\0\0"
        "\0\x02\xA0\x01\0\x03\0\0\0\x01\xFF\xFF\0\0\xA0\x05\0\x04\0\0\0\x01\0\0\0\x38\0\0\0\0"
        "\0\x01\0\x01\0\x02\0\0\0\x04R03\0\0\0\0\0",
        6 + 26 + 30 + 18);
    const Image adobe = reader.read(with_segment(file, 0xE1, exif)).image;
    CHECK(adobe.color_space == ColorSpace::kAdobeRgb);
    CHECK(reader.read(with_segment(both, 0xE1, exif)).image.color_space == ColorSpace::kDisplayP3);
    std::string other = exif;
    other[other.find("R03") + 2] = '4';
    CHECK(reader.read(with_segment(file, 0xE1, other)).image.color_space == ColorSpace::kSrgb);
}

TEST_CASE("jpeg: orientation of XMP, and an image behind the first") {
    Reader reader;
    const Bytes file = encoded(smooth(32, 16, 3), {});
    const std::string xmp =
        std::string("http://ns.adobe.com/xap/1.0/\0", 29) + "<rdf:Description tiff:Orientation='8'/>";
    CHECK(reader.read(with_segment(file, 0xE1, xmp)).image.width == 16);
    Bytes two = file;
    const Bytes other = encoded(smooth(8, 8, 1), {.channels = 1, .horizontal = 1, .vertical = 1});
    two.insert(two.end(), other.begin(), other.end());
    CHECK(reader.read(two).image.width == 32);
}

// Sources of the signatures: the formats' specifications, and the magic numbers of file(1).
#include "formats/picture/decode/other_formats.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "formats/files/byte_reader.h"
#include "formats/files/image_signature.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using namespace std::string_view_literals;

constexpr const char* kSave = "save it as PNG, TIFF or EXR";
constexpr const char* kDevelop = "develop it to TIFF, EXR or PNG";
constexpr const char* kDraw = "draw it as PNG first";
constexpr const char* kUnpack = "unpack it first";
constexpr const char* kFrames = "take its frames out as PNG first";
constexpr const char* kData = "write its values as TIFF or EXR";

struct Signature {
    std::size_t offset;
    std::string_view bytes;
    const char* name;
    const char* advice;
};
constexpr Signature kSignatures[] = {
    {0, "8BPS"sv, "a Photoshop file (PSD)", kSave},
    {0, "\xFF\x0A"sv, "JPEG XL", kSave},
    {0, "\0\0\0\x0CJXL "sv, "JPEG XL", kSave},
    {0, "II\xBC"sv, "JPEG XR", kSave},
    {0, "gimp xcf"sv, "a GIMP file (XCF)", kSave},
    {0, "DDS "sv, "a DirectDraw surface (DDS)", kSave},
    {0, "\xABKTX "sv, "a Khronos texture (KTX)", kSave},
    {0, "qoif"sv, "a QOI image", kSave},
    {0, "SDPX"sv, "a DPX image", kSave},
    {0, "XPDS"sv, "a DPX image", kSave},
    {0, "\x80\x2A\x5F\xD7"sv, "a Cineon image", kSave},
    {0, "\x01\xDA\x00"sv, "an SGI image", kSave},
    {0, "\x01\xDA\x01"sv, "an SGI image", kSave},
    {0, "\x59\xA6\x6A\x95"sv, "a Sun raster image", kSave},
    {0, "\x8AMNG"sv, "an MNG animation", kFrames},
    {0, "\x97JB2"sv, "a JBIG2 image", kSave},
    {0, "AT&TFORM"sv, "a DjVu document", kDraw},
    {8, "ILBM"sv, "an Amiga image (ILBM)", kSave},
    {0, "/* XPM */"sv, "an XPM image", kSave},
    {0, "P7 332"sv, "a thumbnail of XV", kSave},
    {0, "SIMPLE  ="sv, "a FITS file", kData},
    {128, "DICM"sv, "a DICOM file", kData},
    {0, "\x93NUMPY"sv, "a NumPy array", kData},
    {0, "\x89HDF\r\n"sv, "an HDF5 file", kData},
    {0, "CDF\x01"sv, "a NetCDF file", kData},
    {0, "CDF\x02"sv, "a NetCDF file", kData},
    {0, "MATLAB 5.0"sv, "a MATLAB file", kData},
    {4, "ftypcrx "sv, "a camera raw file (CR3)", kDevelop},
    {0, "FUJIFILMCCD-RAW"sv, "a camera raw file (RAF)", kDevelop},
    {0, "IIU\0"sv, "a camera raw file (RW2)", kDevelop},
    {0, "IIRO"sv, "a camera raw file (ORF)", kDevelop},
    {0, "IIRS"sv, "a camera raw file (ORF)", kDevelop},
    {0, "MMOR"sv, "a camera raw file (ORF)", kDevelop},
    {0, "FOVb"sv, "a camera raw file (X3F)", kDevelop},
    {0, "\0MRM"sv, "a camera raw file (MRW)", kDevelop},
    {6, "HEAPCCDR"sv, "a camera raw file (CRW)", kDevelop},
    {0, "%PDF-"sv, "a PDF document", kDraw},
    {0, "%!PS"sv, "a PostScript document", kDraw},
    {40, " EMF"sv, "a Windows metafile", kDraw},
    {0, "\xD7\xCD\xC6\x9A"sv, "a Windows metafile", kDraw},
    {0, "PK\x03\x04"sv, "a ZIP archive, or a document in one", kUnpack},
    {0, "\x1F\x8B"sv, "a gzip file", kUnpack},
    {0, "BZh"sv, "a bzip2 file", kUnpack},
    {0,
     "\xFD"
     "7zXZ"sv,
     "an XZ file", kUnpack},
    {0, "7z\xBC\xAF"sv, "a 7-Zip archive", kUnpack},
    {0, "Rar!"sv, "a RAR archive", kUnpack},
    {0, "\x28\xB5\x2F\xFD"sv, "a Zstandard file", kUnpack},
    {257, "ustar"sv, "a tar archive", kUnpack},
    {8, "AVI "sv, "a video (AVI)", kFrames},
    {0, "\x1A\x45\xDF\xA3"sv, "a video (Matroska, WebM)", kFrames},
    {4, "ftypisom"sv, "a video (MP4)", kFrames},
    {4, "ftypmp4"sv, "a video (MP4)", kFrames},
    {4, "ftypqt"sv, "a video (QuickTime)", kFrames},
    {0, "version https://git-lfs"sv, "a pointer of Git LFS", "fetch the image with git lfs pull"},
};

// The first 4 KB in lower case, without white space and a byte order mark at their begin.
std::string begin_of_text(std::span<const std::uint8_t> bytes) {
    std::string text(text_of(bytes.first(std::min<std::size_t>(bytes.size(), 4096))));
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    text.erase(0, text.find_first_not_of(" \t\r\n"));
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::string not_read(const std::string& name, const std::string& advice) {
    return cat(name, ", which imgmesh does not read; ", advice);
}

std::string name_text(const std::string& text, const std::string& extension) {
    const auto has = [&](std::string_view part) { return text.find(part) != std::string::npos; };
    if (text.starts_with("<") && has("<svg")) return not_read("an SVG drawing", kDraw);
    if (text.starts_with("<!doctype html") || text.starts_with("<html"))
        return not_read("a web page (HTML)", "save the image itself");
    if (text.starts_with("<?xml")) return not_read("an XML file", "an image is expected");
    if (!text.starts_with("{") && !text.starts_with("[")) return {};
    if (extension == ".gltf" || has("\"asset\""))
        return "a glTF file, not an image; imgmesh-reconstruct draws a container, imgmesh-info describes it";
    if (extension == ".json")
        return "a JSON file, not an image; files of edits are for imgmesh-warp, which takes them beside a "
               "container";
    return {};
}

}  // namespace

std::string name_other_format(std::span<const std::uint8_t> bytes, const std::string& extension) {
    const ByteReader in(bytes, ByteOrder::kLittle);
    if (in.has_at(0, "glTF"))
        return "a glTF file, not an image; imgmesh-reconstruct draws a container, imgmesh-info describes it";
    if (has_coded_signature(bytes)) return "a coded picture (.imgm), not an image; imgmesh-decode draws it";
    for (const Signature& s : kSignatures)
        if (in.has_at(s.offset, s.bytes)) return not_read(s.name, s.advice);
    const bool is_icon = in.has_at(0, {"\0\0\1\0", 4}) && in.number_at(4, 2) > 0 && in.number_at(4, 2) < 100;
    // A cursor begins as a TGA may.
    if (is_icon || (extension == ".cur" && in.has_at(0, {"\0\0\2\0", 4})))
        return not_read("a file of icons or cursors (ICO)", kSave);
    // Version, coding by runs, bits of a plane.
    if (in.has_at(0, "\x0A") && in.number_at(1, 1) <= 5 && in.number_at(2, 1) == 1 && extension == ".pcx")
        return not_read("a PCX image", kSave);
    return name_text(begin_of_text(bytes), extension);
}

}  // namespace imgmesh

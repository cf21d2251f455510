// Files of other formats are refused by name.
#include <doctest/doctest.h>

#include "tests/support/file_bytes.h"

using namespace imgmesh;
using namespace std::string_view_literals;

namespace {

// The kind and text of the refusal, without the folder.
std::pair<ErrorKind, std::string> refused(const FileBytes& file, const std::string& name) {
    const auto error = refusal(file, name);
    REQUIRE(error);
    const std::string text = error->what();
    return {error->kind(), text.substr(text.find(name))};
}

}  // namespace

TEST_CASE("other formats: one line names the format and what helps") {
    struct Case {
        std::string_view begin;
        const char* name;
        const char* words;
    };
    const Case cases[] = {{"8BPS\0\1"sv, "a.psd", "a Photoshop file (PSD)"},
                          {"\xFF\x0A\x10"sv, "a.jxl", "JPEG XL"},
                          {"\0\0\0\x0CJXL \r\n"sv, "a.jxl", "JPEG XL"},
                          {"\0\0\1\0\2\0\x10\x10"sv, "a.ico", "icons or cursors"},
                          {"\0\0\2\0\2\0\x10\x10"sv, "a.cur", "icons or cursors"},
                          {"<?xml version=\"1.0\"?>\n<svg>"sv, "a.svg", "an SVG drawing"},
                          {"\xEF\xBB\xBF <SVG width='1'>"sv, "a.svg", "an SVG drawing"},
                          {"%PDF-1.7"sv, "a.pdf", "a PDF document"},
                          {"\x0A\x05\x01\x08"sv, "a.pcx", "a PCX image"},
                          {"DDS |"sv, "a.dds", "DirectDraw"},
                          {"\xABKTX 20\xBB"sv, "a.ktx2", "a Khronos texture"},
                          {"qoif"sv, "a.qoi", "a QOI image"},
                          {"gimp xcf v011"sv, "a.xcf", "a GIMP file"},
                          {"SIMPLE  =   T"sv, "a.fits", "a FITS file"},
                          {"\x93NUMPY\1\0"sv, "a.npy", "a NumPy array"},
                          {"PK\3\4"sv, "a.zip", "a ZIP archive"},
                          {"\x1F\x8B\x08"sv, "a.png.gz", "a gzip file"},
                          {"<!DOCTYPE html><p>404"sv, "a.png", "a web page"},
                          {"version https://git-lfs.github.com/spec/v1"sv, "a.png", "Git LFS"},
                          {"FUJIFILMCCD-RAW "sv, "a.raf", "a camera raw file"},
                          {"\0\0\0\x18"
                           "ftypcrx "sv,
                           "a.cr3", "a camera raw file"},
                          {"\0\0\0\x20"
                           "ftypisom"sv,
                           "a.mp4", "a video"},
                          {"glTF\2\0\0\0"sv, "a.glb", "imgmesh-reconstruct"},
                          {"{\"asset\": {\"version\": \"2.0\"}}"sv, "a.gltf", "imgmesh-reconstruct"},
                          {" {\"edits\": []}"sv, "a.json", "imgmesh-warp"}};
    for (const Case& c : cases) {
        INFO(std::string(c.name));
        const auto result = refused(FileBytes(c.begin).zeros(40), c.name);
        CHECK(result.first == ErrorKind::kUnsupported);
        CHECK_MESSAGE((result.second.find(c.words) != std::string::npos), result.second);
    }
    CHECK(refused(FileBytes().zeros(128).put(FileBytes("DICM")), "a.dcm").second.find("a DICOM file") !=
          std::string::npos);
    CHECK(refused(FileBytes("only a text\n"), "a.png").first == ErrorKind::kBadFile);
    CHECK(refused(FileBytes("{ no image }"), "a.png").first == ErrorKind::kBadFile);
}

#include "tools/common/examples.h"

#include <utility>

namespace imgmesh {
namespace {

constexpr Example kBuild[] = {
    {"imgmesh-build photo.png -o photo.glb", "A mesh with one vertex for every 100 pixels"},
    {"imgmesh-build photo.png -o photo.glb --faces 2000 --preset best", "The best mesh of 2000 faces"},
    {"imgmesh-build sprite.png -o sprite.glb --level-faces 800,200 --texture",
     "The opaque part of a sprite, for an engine: two levels of detail, and the image as a texture"},
    {"imgmesh-build *.jpg -o meshes/ --rms 6",
     "A container of each image, with as few faces as a mean error of 6 in L*u*v* allows"},
    {"imgmesh-build *.jpg -o meshes/ --skip-existing --jsonl > night.jsonl",
     "A night's batch that goes on where it was ended, with a line of JSON for each file"},
};

constexpr Example kReconstruct[] = {
    {"imgmesh-reconstruct photo.glb -o again.png", "The image, from the mesh's colours and the pixel map"},
    {"imgmesh-reconstruct photo.glb -o poster.png --mode flat --scale 4",
     "Triangles of one colour each, four times as large as the image, antialiased"},
    {"imgmesh-reconstruct photo.glb -o wire.svg --mode wire", "The edges of the mesh, for print and the web"},
};

constexpr Example kInfo[] = {
    {"imgmesh-info photo.glb", "What is in a container, and how its bytes are shared out"},
    {"imgmesh-info download.glb --validate", "Every mistake in a container that is not your own"},
    {"imgmesh-info photo.glb --json > facts.json", "The same facts for a program"},
};

constexpr Example kCompare[] = {
    {"imgmesh-compare photo.png photo.glb", "How far a container's reconstruction is from its image"},
    {"imgmesh-compare photo.glb", "The quality of a container's triangles and map"},
    {"imgmesh-compare before.png after.png --tolerance 1",
     "Exit code 7 if the error (RMS in L*u*v*) is larger than 1, for scripts"},
};

constexpr Example kConvert[] = {
    {"imgmesh-convert photo.glb -o photo.gltf", "JSON with the binary files beside it"},
    {"imgmesh-convert photo.glb -o compact.glb --layers compact",
     "The same pixel map in a sixth of the bytes; --layers exr goes back"},
    {"imgmesh-convert photo.glb -o small.glb --levels 1 --no-map",
     "The mesh of one level without its pixel map, for engines and viewers"},
    {"imgmesh-convert photo.glb -o photo.svg --shading gradient", "The mesh as a vector drawing"},
    {"imgmesh-convert sprite.glb -o sprite.json --outline-tolerance 2",
     "A sprite's mesh as TexturePacker writes it, with an outline of few corners"},
};

constexpr Example kWarp[] = {
    {"imgmesh-warp sprite.glb --image sprite.png -o bent.png --handle 70,20:-12,-10 --pin 24,30",
     "Pull one place and hold another: what is between bends. --pin can be repeated"},
    {"imgmesh-warp photo.glb --image photo.png -o pulled.png --level 1 --handle 48,32:8,-4 --pin-border",
     "A large smooth move on a coarse level, within the frame"},
    {"imgmesh-warp photo.glb --image photo.png -o narrow.png --retarget 64x64",
     "Another shape, in which detail keeps its proportions"},
    {"imgmesh-warp photo.glb --edits edits.json --displacement maps.exr",
     "Edits from a file, as maps for a compositor"},
};

constexpr Example kSegment[] = {
    {"imgmesh-segment photo.glb -o labels.png --segments 20", "20 regions, as a label for each pixel"},
    {"imgmesh-segment photo.glb -o labels.exr --threshold 8 --outlines borders.png --image photo.png",
     "Regions with contours of at least 8 between them, drawn over the image"},
    {"imgmesh-segment photo.glb -o cells.png --superpixels 50", "50 superpixels that follow edges"},
    {"imgmesh-segment photo.glb -o labels.png --keep 20,20 --drop 0,0 --mask object.png",
     "The object that pixel 20,20 is inside, and pixel 0,0 is not, as a mask for imgmesh-build"},
};

constexpr Example kEncode[] = {
    {"imgmesh-encode photo.png -o photo.imgm",
     "A mesh of one vertex for every 108 pixels, in a few kilobytes"},
    {"imgmesh-encode photo.png -o small.imgm --bytes 2000", "As good as 2000 bytes allow"},
    {"imgmesh-encode *.jpg -o coded/ --psnr 25", "As small as an error of 25 dB allows, of each image"},
};

constexpr Example kDecode[] = {
    {"imgmesh-decode photo.imgm -o again.png", "The image"},
    {"imgmesh-decode photo.imgm -o large.png --scale 2", "The image at twice its size, from the same mesh"},
    {"imgmesh-decode photo.imgm -o plain.glb", "Its mesh, for engines and viewers"},
    {"imgmesh-decode photo.imgm --info", "Size, channels and vertices"},
};

}  // namespace

std::span<const Example> examples_of(const std::string& tool) {
    const std::pair<const char*, std::span<const Example>> all[] = {
        {"imgmesh-build", kBuild},     {"imgmesh-reconstruct", kReconstruct}, {"imgmesh-info", kInfo},
        {"imgmesh-compare", kCompare}, {"imgmesh-convert", kConvert},         {"imgmesh-warp", kWarp},
        {"imgmesh-segment", kSegment}, {"imgmesh-encode", kEncode},           {"imgmesh-decode", kDecode}};
    for (const auto& [name, examples] : all)
        if (tool == name) return examples;
    return {};
}

}  // namespace imgmesh

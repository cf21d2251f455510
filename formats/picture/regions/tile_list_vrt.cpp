// Source: GDAL's documentation, "VRT -- GDAL Virtual Format". Of it only what puts files side by side.
#include <cmath>
#include <filesystem>
#include <map>
#include <pugixml.hpp>

#include "formats/files/atomic_file.h"
#include "formats/files/extension.h"
#include "formats/files/one_line.h"
#include "formats/picture/regions/tile_list.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// pugixml holds about twenty times the text; it expands no entities that a document defines.
constexpr std::uint64_t kMostBytes = std::uint64_t{64} << 20;
constexpr int kMostSide = 1000000;

class VrtReader {
  public:
    explicit VrtReader(const std::string& path) : path_(path) {
        const std::vector<std::uint8_t> bytes = read_file(path, kMostBytes);
        const pugi::xml_parse_result result = document_.load_buffer(bytes.data(), bytes.size());
        if (!result)
            throw Error(ErrorKind::kBadFile, cat(path, ": not XML: ", result.description(), " at byte ",
                                                 static_cast<long long>(result.offset)));
    }

    TileList list() {
        const pugi::xml_node root = document_.child("VRTDataset");
        if (!root) throw broken("expected the element VRTDataset");
        if (root.attribute("subClass")) throw beyond(cat("a VRT of ", root.attribute("subClass").value()));
        TileList list;
        list.width = number(root, "rasterXSize", 1);
        list.height = number(root, "rasterYSize", 1);
        int bands = 0;
        for (const pugi::xml_node band : root.children("VRTRasterBand")) {
            if (band.attribute("subClass"))
                throw beyond(cat("bands of ", band.attribute("subClass").value()));
            read_band(band, ++bands, list.tiles);
        }
        if (list.tiles.empty()) throw broken("it names no files");
        return list;
    }

  private:
    Error broken(const std::string& what) const {
        return {ErrorKind::kBadFile, cat(path_, ": the VRT is broken: ", one_line(what))};
    }
    Error beyond(const std::string& what) const {
        return {
            ErrorKind::kUnsupported,
            cat(path_, ": ", one_line(what),
                " is not supported, only files side by side at their own size; gdal_translate makes a TIFF "
                "of it")};
    }

    int number(const pugi::xml_node& node, const char* name, int least) const {
        const pugi::xml_attribute attribute = node.attribute(name);
        const double value = attribute.as_double(NAN);
        if (!(value >= least && value <= kMostSide)) throw broken(cat(node.name(), " has no sound ", name));
        if (value != std::floor(value)) throw beyond("a rectangle between pixels");
        return static_cast<int>(value);
    }

    // All bands have the same sources; band n of the picture is band n of each file.
    void read_band(const pugi::xml_node& band, int index, std::vector<ListedTile>& tiles) {
        std::size_t count = 0;
        for (const pugi::xml_node node : band.children()) {
            const std::string name = node.name();
            if (!name.ends_with("Source")) {
                if (name == "MaskBand" || name == "Overview") throw beyond("an element " + name);
                continue;
            }
            if (name != "SimpleSource" && name != "ComplexSource") throw beyond("an element " + name);
            const ListedTile tile = source(node, index);
            if (index == 1) {
                if (tiles.size() == kMostTiles) throw broken("it names too many files");
                tiles.push_back(tile);
            } else if (count >= tiles.size() || tiles[count].path != tile.path || tiles[count].x != tile.x ||
                       tiles[count].y != tile.y || tiles[count].from_x != tile.from_x ||
                       tiles[count].from_y != tile.from_y || tiles[count].width != tile.width ||
                       tiles[count].height != tile.height) {
                throw beyond("bands of different files");
            }
            ++count;
        }
        if (index > 1 && count != tiles.size()) throw beyond("bands of different files");
    }

    ListedTile source(const pugi::xml_node& node, int band) {
        for (const char* name : {"ScaleOffset", "ScaleRatio", "LUT", "ColorTableComponent", "Exponent"})
            if (node.child(name)) throw beyond(cat("a source with ", name));
        const pugi::xml_node file = node.child("SourceFilename");
        const std::string name = file.text().get();
        if (name.empty()) throw broken("a source names no file");
        if (const std::string own = node.child("SourceBand").text().as_string("");
            !own.empty() && own != cat(band))
            throw beyond(cat("band ", own, " of a file as band ", band));
        const bool relative = file.attribute("relativeToVRT").as_int() != 0;
        ListedTile tile;
        tile.path = relative ? (std::filesystem::path(path_).parent_path() / name).string() : name;
        const pugi::xml_node from = node.child("SrcRect"), to = node.child("DstRect");
        if (!from || !to) throw broken("a source has no SrcRect or no DstRect");
        tile.from_x = number(from, "xOff", 0);
        tile.from_y = number(from, "yOff", 0);
        tile.width = number(from, "xSize", 1);
        tile.height = number(from, "ySize", 1);
        tile.x = number(to, "xOff", 0);
        tile.y = number(to, "yOff", 0);
        if (number(to, "xSize", 1) != tile.width || number(to, "ySize", 1) != tile.height)
            throw beyond("a source of another size than its place");
        tile.exact = false;
        return tile;
    }

    const std::string& path_;
    pugi::xml_document document_;
};

}  // namespace

bool is_vrt(const std::string& path) {
    return lower_extension(path) == ".vrt";
}

TileList read_vrt(const std::string& path) {
    return VrtReader(path).list();
}

}  // namespace imgmesh

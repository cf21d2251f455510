#include <charconv>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>

#include "formats/picture/regions/tile_list.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

namespace fs = std::filesystem;

struct NamedTile {
    std::string series;  ///< all before the column, and the extension
    int column = 0, row = 0;
};

// Takes a number of at most 7 digits from the end of `text`.
std::optional<int> take_number(std::string_view& text) {
    std::size_t begin = text.size();
    while (begin > 0 && text[begin - 1] >= '0' && text[begin - 1] <= '9') --begin;
    constexpr std::size_t kMostDigits = 7;
    if (begin == text.size() || text.size() - begin > kMostDigits) return {};
    int number = 0;
    std::from_chars(text.data() + begin, text.data() + text.size(), number);
    text = text.substr(0, begin);
    return number;
}

std::optional<NamedTile> tile_of_name(const fs::path& name) {
    const std::string stem = name.stem().string();
    std::string_view text = stem;
    const std::optional<int> row = take_number(text);
    if (!row || text.empty() || (text.back() != '_' && text.back() != '-')) return {};
    text.remove_suffix(1);
    const std::optional<int> column = take_number(text);
    if (!column || (!text.empty() && text.back() != '_' && text.back() != '-')) return {};
    return NamedTile{cat(text, '*', name.extension().string()), *column, *row};
}

// Widths of columns or heights of rows: of the first file that says it. 0 if none does.
using Sizes = std::map<int, int>;

// Places from sizes. Throws for one that nothing tells.
std::map<int, int> places(const std::string& path, const Sizes& sizes, const char* what) {
    std::map<int, int> out;
    std::int64_t at = 0;
    for (const auto& [number, size] : sizes) {
        if (!out.empty() && number != out.rbegin()->first + 1)
            throw Error(ErrorKind::kBadFile,
                        cat(path, ": no file is of ", what, ' ', out.rbegin()->first + 1));
        if (size == 0)
            throw Error(ErrorKind::kBadFile, cat(path, ": no file of ", what, ' ', number, " can be read"));
        constexpr std::int64_t kMostSide = 1000000;
        if (at > kMostSide)
            throw Error(ErrorKind::kBadFile,
                        cat(path, ": the files are of more than ", kMostSide, " pixels a side"));
        out[number] = static_cast<int>(at);
        at += size;
    }
    return out;
}

}  // namespace

TileList list_folder(const std::string& path, const ReadImageOptions& options) {
    std::map<std::pair<int, int>, std::string> files;  // by row and column
    std::string series;
    std::error_code error;
    for (fs::directory_iterator it(path, error), end; !error && it != end; it.increment(error)) {
        const std::optional<NamedTile> tile = tile_of_name(it->path().filename());
        if (!tile || it->path().filename().string().front() == '.') continue;
        if (!series.empty() && series != tile->series)
            throw Error(ErrorKind::kBadFile,
                        cat(path, ": the folder has tiles of two pictures, ", series, " and ", tile->series));
        series = tile->series;
        if (!files.emplace(std::pair(tile->row, tile->column), it->path().string()).second)
            throw Error(ErrorKind::kBadFile,
                        cat(path, ": two files are column ", tile->column, " of row ", tile->row));
        if (files.size() > kMostTiles)
            throw Error(ErrorKind::kBadFile, cat(path, ": the folder has more than ", kMostTiles, " tiles"));
    }
    if (error) throw Error(ErrorKind::kIo, cat(path, ": cannot read: ", error.message()));
    if (files.empty())
        throw Error(ErrorKind::kBadFile,
                    cat(path, ": the folder has no files that are named by column and row, as 3_5.png"));

    Sizes widths, heights;
    for (const auto& [place, file] : files) {
        int& width = widths[place.second];
        int& height = heights[place.first];
        if (width > 0 && height > 0) continue;
        try {
            const auto reader = open_picture_regions(file, options);
            if (width == 0) width = reader->facts().width;
            if (height == 0) height = reader->facts().height;
        } catch (const Error&) {  // another file of the column and of the row may tell
        }
    }
    const std::map<int, int> lefts = places(path, widths, "column"), tops = places(path, heights, "row");
    TileList list;
    list.width = lefts.rbegin()->second + widths.rbegin()->second;
    list.height = tops.rbegin()->second + heights.rbegin()->second;
    for (const auto& [row, top] : tops)
        for (const auto& [column, left] : lefts) {
            ListedTile tile;
            const auto file = files.find({row, column});
            // A file that is missing is an error where it is read, under the name that it would have.
            tile.path = file != files.end()
                            ? file->second
                            : (fs::path(path) / (series.substr(0, series.find('*')) + cat(column, '_', row) +
                                                 series.substr(series.find('*') + 1)))
                                  .string();
            tile.x = left;
            tile.y = top;
            tile.width = widths.at(column);
            tile.height = heights.at(row);
            list.tiles.push_back(std::move(tile));
        }
    return list;
}

}  // namespace imgmesh

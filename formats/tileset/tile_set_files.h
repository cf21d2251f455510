// Reads and writes a tile set's JSON: schemas/imgmesh-tileset.*.schema.json describe it.
#pragma once

#include <string>

#include "formats/tileset/tile_set.h"

namespace imgmesh {

// Each writer replaces the file FOLDER/NAME as a whole and throws Error(kIo). Each reader is safe for any
// bytes and throws Error: kIo if a file cannot be read; kUnsupported for a newer version; kBadFile for
// anything else that is wrong, such as a path that leaves the folder or a tile that the picture does not
// have. Equal values give equal bytes.

void write_plan(const std::string& folder, const TileSetPlan& plan);
TileSetPlan read_plan(const std::string& folder);

/// Writes FOLDER/tile_record(record.tile). Its files must be there.
void write_record(const std::string& folder, const TileRecord& record);
TileRecord read_record(const std::string& folder, const TileName& tile);

void write_index(const std::string& folder, const TileSetIndex& index);
/// Takes one to two seconds for 100,000 tiles. Error(kBadFile) for a set that is not complete.
TileSetIndex read_index(const std::string& folder);

/// Returns whether a tile needs no work: its record is there, has the key, does not tell that the tile is
/// missing, and its files are as it says.
bool is_finished(const std::string& folder, const TileName& tile, const std::string& key);

/// Returns whether a path names a tile set: a folder with an index or at least a plan, or the index itself.
bool is_tile_set(const std::string& path);
/// Returns the folder of what is_tile_set() accepts.
std::string tile_set_folder(const std::string& path);

}  // namespace imgmesh

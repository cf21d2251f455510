#include "tools/tiles/tile_memory.h"

#include <algorithm>
#include <cmath>

#include "formats/tileset/tile_files.h"
#include "libcore/base/error.h"
#include "libcore/tiles/error_density.h"
#include "tools/common/memory.h"

namespace imgmesh {
namespace {

// Where --error keeps more than this share of the pixels, it is too small for a mesh to be of any use.
constexpr double kMostUseful = 0.5;

constexpr const char* kExamples = "; about 20000 keeps 1 % of a photograph's, 1000 keeps 5 %";

std::string kept_by(const PlannedTileSet& planned, double density) {
    return cat(std::llround(100 * density), " % of its pixels as vertices by --error ",
               planned.params.stop.error.value_or(0));
}

}  // namespace

// Measured: docs/scale.md. What up to two hundredths of the pixels take as vertices is among the bytes of a
// pixel.
double tile_bytes(double pixels, double density) {
    constexpr double kBytesOfPixel = 130, kBytesOfVertex = 1500, kOwnBytes = 120e6, kUsualDensity = 0.02;
    return kOwnBytes + pixels * (kBytesOfPixel + kBytesOfVertex * std::max(0.0, density - kUsualDensity));
}

void check_density(const Image& tile, const PlannedTileSet& planned, std::uint64_t max_memory) {
    // Smaller tiles cannot have too many vertices.
    constexpr std::size_t kLeastPixels = 1 << 20;
    if (planned.jobs.first_pass || tile.pixel_count() < kLeastPixels || tile.width < 128 || tile.height < 128)
        return;
    const double density = error_density(tile, planned.params, planned.common);
    try {
        check_memory(cat("keeping ", kept_by(planned, density)),
                     tile_bytes(static_cast<double>(tile.pixel_count()), density), max_memory);
    } catch (const Error& error) {
        throw Error(ErrorKind::kUnsupported,
                    cat(error.what(), kExamples));  // of the command line, not of this tile alone
    }
}

std::string density_warning(const TileRecord& record, const PlannedTileSet& planned) {
    if (planned.jobs.first_pass || record.tile.level > 0) return "";
    const PixelRect rect = planned.jobs.grid.rect(record.tile);
    const double density =
        static_cast<double>(record.vertices) / (static_cast<double>(rect.width()) * rect.height());
    if (density <= kMostUseful) return "";
    return cat("tile ", tile_text(record.tile), " keeps ", kept_by(planned, density), kExamples);
}

}  // namespace imgmesh

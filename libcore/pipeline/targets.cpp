#include "libcore/pipeline/targets.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/error.h"
#include "libcore/pipeline/params.h"

namespace imgmesh {
namespace {

// Why a mesh may have more faces than wanted: what the collapse may not do.
std::string limits_of(const BuildParams& params, const MeshImage& mesh_image) {
    std::string list;
    const auto add = [&](const std::string& limit) { list += (list.empty() ? "" : " and ") + limit; };
    if (mesh_image.source.has_mask) add("the mask's outline");
    if (params.max_cluster) add(cat("max-cluster ", *params.max_cluster));
    if (params.min_quality > 0) add(cat("min-quality ", params.min_quality));
    if (map_kind(params) == MapKind::kTracked) add("the tracked map");
    return list.empty() ? "the image" : list;
}

// Returns the line for a number of things that is not the wanted one. `fewest` allow no less.
std::string missed(std::int64_t wanted, std::int64_t found, const char* things, const std::string& fewest) {
    if (found > wanted)
        return cat(wanted, " ", things, " were wanted, ", found, " are the fewest that ", fewest, " allows");
    return cat(wanted, " ", things, " were wanted, the mesh of all pixels has ", found);
}

class Targets {
  public:
    Targets(const BuildParams& params, const BuildResult& result, bool density)
        : params_(params), result_(result), fewest_(limits_of(params, result.mesh_image)) {
        finest(density);
        further();
        left_out();
    }
    std::vector<std::string> missed_lines;

  private:
    const BaseMesh& mesh(std::size_t k) const { return result_.mesh_image.levels[k].mesh; }
    std::int64_t faces(std::size_t k) const { return std::ssize(mesh(k).faces); }

    void check_faces(std::size_t k, std::int64_t wanted) {
        if (faces(k) != wanted && faces(k) != wanted - 1)
            missed_lines.push_back(missed(wanted, faces(k), "faces", fewest_));
    }

    // The limits of level 0; the first that is reached counts.
    void finest(bool density) {
        const StopParams& stop = params_.stop;
        if (!params_.levels.faces.empty()) {
            for (std::size_t k = 0; k < result_.report.levels.size(); ++k)
                check_faces(k, params_.levels.faces[result_.report.levels[k].target]);
            return;
        }
        if (!params_.levels.errors.empty()) return;
        if (stop.rms) {
            const double rms = result_.report.levels.front().map_rms;
            if (rms > *stop.rms)
                missed_lines.push_back(
                    cat("an RMS error of ", *stop.rms, " was wanted, the mesh of all pixels has ", rms));
            return;
        }
        if (stop.error) return;  // is where the collapse has stopped, unless another limit came first
        std::optional<std::int64_t> vertices = stop.vertices;
        if (!stop.faces && !stop.vertices && density)
            vertices = collapse_targets(params_, static_cast<double>(result_.report.pixels)).front().vertices;
        const auto count = static_cast<std::int64_t>(mesh(0).vertex_count());
        const bool by_faces = stop.faces && (faces(0) == *stop.faces || faces(0) == *stop.faces - 1);
        if (by_faces || (vertices && count == *vertices)) return;
        // A limit that the mesh of all pixels keeps ends the collapse before it begins, whatever the other
        // says.
        const bool too_few = (stop.faces && faces(0) < *stop.faces) || (vertices && count < *vertices);
        if (stop.faces && (!too_few || faces(0) < *stop.faces)) check_faces(0, *stop.faces);
        if (vertices && (!too_few || count < *vertices))
            missed_lines.push_back(missed(*vertices, count, "vertices", fewest_));
    }

    // Levels by their share of the level before.
    void further() {
        if (!params_.levels.faces.empty() || !params_.levels.errors.empty()) return;
        for (std::size_t k = 1; k < result_.mesh_image.levels.size(); ++k) {
            const std::int64_t quarter = std::max<std::int64_t>(2, faces(k - 1) / 4);
            if (faces(k) > quarter)
                missed_lines.push_back(cat("level ", k, ": ", missed(quarter, faces(k), "faces", fewest_)));
        }
    }

    void left_out() {
        const std::size_t wanted = std::max({static_cast<std::size_t>(params_.levels.count),
                                             params_.levels.faces.size(), params_.levels.errors.size()});
        const std::vector<LevelReport>& kept = result_.report.levels;
        for (std::size_t k = 0; k < kept.size(); ++k) {
            const std::size_t first = kept[k].target + 1,
                              end = k + 1 < kept.size() ? kept[k + 1].target : wanted;
            if (first == end) continue;
            missed_lines.push_back(
                first + 1 == end
                    ? cat("level ", first, " would be the same as level ", first - 1, " and is left out")
                    : cat("levels ", first, " to ", end - 1, " would be the same as level ", first - 1,
                          " and are left out"));
        }
    }

    const BuildParams& params_;
    const BuildResult& result_;
    std::string fewest_;
};

}  // namespace

std::vector<std::string> missed_targets(const BuildParams& params, const BuildResult& result, bool density) {
    return Targets(params, result, density).missed_lines;
}

}  // namespace imgmesh

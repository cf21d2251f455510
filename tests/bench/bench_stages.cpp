#include "tests/bench/bench_stages.h"

#include <filesystem>
#include <utility>

#include "formats/container/container.h"
#include "formats/exr/exr_layers.h"
#include "formats/picture/image_io.h"
#include "libcore/base/error.h"
#include "libcore/image/feature_space.h"
#include "libcore/mesh/grid_mesh.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/metrics/metrics.h"
#include "libcore/param/fit_colors.h"
#include "libcore/param/fit_map.h"
#include "libcore/pipeline/params.h"
#include "libcore/pipeline/refine_level.h"
#include "libcore/recon/draw.h"
#include "libcore/simplify/quadrics/vertex_quadrics.h"
#include "libcore/simplify/simplify.h"

namespace imgmesh::bench {
namespace {

class Bench {
  public:
    explicit Bench(int repeats) : repeats_(repeats) {}

    // The value that `work` gives; every run makes it anew.
    template <typename Work>
    auto stage(const std::string& name, const Work& work) {
        auto result = measured(name, work);
        for (int i = 1; i < repeats_; ++i) {
            result = {};  // what the run before has made is no memory of this one's
            result = measured(name, work);
        }
        return result;
    }
    void rms(double value) { rows_.back().rms = value; }
    std::vector<StageRow> rows() && { return std::move(rows_); }

  private:
    template <typename Work>
    auto measured(const std::string& name, const Work& work) {
        UsageMeter meter;
        auto result = work();
        const Usage usage = meter.stop();
        if (rows_.empty() || rows_.back().stage != name) rows_.push_back({name, usage});
        Usage& least = rows_.back().usage;
        if (usage.user_seconds + usage.system_seconds < least.user_seconds + least.system_seconds)
            least = usage;
        return result;
    }

    int repeats_;
    std::vector<StageRow> rows_;
};

// What has come back is what was written: a faster writer must not lose anything.
void check_same(const MeshImage& written, const MeshImage& read, const FeatureImage& feature) {
    const Level &a = written.levels.front(), &b = read.levels.front();
    if (a.mesh.faces.size() != b.mesh.faces.size() ||
        std::abs(map_rms(a.mesh, a.map, feature) - map_rms(b.mesh, b.map, feature)) > 1e-4)
        throw Error(ErrorKind::kInternal, "the container read is not the one written");
}

}  // namespace

std::vector<StageRow> measure_stages(const std::string& path, const std::string& folder,
                                     const BuildParams& params, int repeats) {
    Bench bench(repeats);
    const Image image = bench.stage("decode", [&] { return read_image(path); });
    const FeatureSpace space = feature_space(image, {});
    FeatureImage feature = bench.stage("luv", [&] { return extract_features(image, space); });
    GridMesh grid = bench.stage("grid", [&] { return grid_mesh(feature); });
    const auto pixels = static_cast<double>(image.pixel_count());
    const std::vector<SimplifyTarget> targets = collapse_targets(params, pixels);
    const SimplifyParams limits = collapse_params(params, targets.front(), pixels);
    bench.stage("quadrics", [&] {
        return vertex_quadrics<3>(grid, smoothed_patch(grid, limits.smoothing, whole_rect(grid)),
                                  limits.geometry_weight);
    });
    const SimplifyResult collapsed =
        bench.stage("collapse", [&] { return simplify(grid, limits, targets.front()); });
    bench.rms(map_rms(collapsed.mesh, trivial_map(collapsed.mesh, image.width, image.height), feature));
    grid = {};

    const RefineParams refinement = refine_params(params);
    BaseMesh refined = bench.stage("refine", [&] {
        BaseMesh mesh = collapsed.mesh;
        if (refinement.rounds > 0) refine_level(mesh, feature, {}, params.objective, refinement, {});
        return mesh;
    });
    const PixelMap trivial = trivial_map(refined, image.width, image.height);
    BaseMesh refitted = bench.stage("refit", [&] {
        BaseMesh mesh = refined;
        fit_colors(mesh, feature, {{&trivial, 1}}, space);
        return mesh;
    });
    bench.rms(map_rms(refitted, trivial, feature));
    auto [mesh, map] = bench.stage("map", [&] {
        BaseMesh fitted = refined;
        PixelMap fitted_map = fit_map(fitted, feature, fit_params(params, space));
        return std::pair(std::move(fitted), std::move(fitted_map));
    });
    bench.rms(map_rms(mesh, map, feature));

    MeshImage mesh_image;
    mesh_image.source = {image.width, image.height, image.color_space, image.sample_type,
                         image.channel_names};
    mesh_image.levels.push_back({std::move(mesh), std::move(map), collapsed.error});
    bench.stage("encode", [&] {
        return encode_exr_layers({{"lod0", mesh_image.levels.front().map, {}, "of no mesh"}});
    });
    const std::string container = (std::filesystem::path(folder) / "stages.glb").string();
    bench.stage("write", [&] {
        write_container(container, mesh_image);
        return 0;
    });
    const Container read = bench.stage("read", [&] { return read_container(container); });
    check_same(mesh_image, read.mesh_image, feature);
    const std::string compact = (std::filesystem::path(folder) / "compact.glb").string();
    bench.stage("write compact", [&] {
        ContainerOptions options;
        options.layers = LayerLayout::kCompact;
        write_container(compact, mesh_image, options);
        return 0;
    });
    const Container again = bench.stage("read compact", [&] { return read_container(compact); });
    check_same(mesh_image, again.mesh_image, feature);
    const Image drawn = bench.stage("reconstruct", [&] { return draw(read.mesh_image, 0, {}); });
    bench.rms(map_rms(read.mesh_image.levels[0].mesh, read.mesh_image.levels[0].map, feature));
    bench.stage("encode picture", [&] {
        write_image((std::filesystem::path(folder) / "stages.png").string(), drawn);
        return 0;
    });
    return std::move(bench).rows();
}

}  // namespace imgmesh::bench

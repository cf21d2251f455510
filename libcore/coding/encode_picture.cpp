#include "libcore/coding/encode_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "libcore/base/error.h"
#include "libcore/base/index.h"
#include "libcore/coding/check_request.h"
#include "libcore/coding/error_space.h"
#include "libcore/coding/mesh_trial.h"
#include "libcore/coding/pixel_weights.h"
#include "libcore/optimize/grid_optimizer.h"
#include "libcore/optimize/grid_schedule.h"

namespace imgmesh {
namespace {

using coding::MeshTrial;

// The step of colours at which most error is saved for a bit, over the root mean squared error of the mesh
// with exact colours, all pixels alike or with weights; sides of the mesh over the step of its grid. All
// optima are broad.
constexpr double kStepOverError = 1.2, kStepOverWeighedError = 1.9, kSideOverGrid = 9;
// Bits of a vertex, before anything is known.
constexpr double kVertexBits = 16.5;
// Below this mean distance of vertices the grid is that of the pixels; at half of it there is little to
// optimise [px].
constexpr double kDenseSide = 4;
constexpr int kHeaderBytes = 8;
// Above this PSNR no error can be seen; above that one, meshes have flat parts, and their colours decide
// [dB].
constexpr double kExact = 60, kFlat = 38;
// Decibels that twice the vertices gain, before anything is known; how far a mesh may be below a PSNR and
// above it, at first and at last, before the steps of its colours do the rest.
constexpr double kDecibels = 1.8, kBelow = 0.04, kFirstAbove = 0.3, kAbove = 0.15;

// The optimiser's places per quarter pixel.
constexpr int kPlacesPerQuarter = kPlacesPerPixel / 4;

// A mesh whose places are points of a grid.
CodedMesh on_grid(const PlacedMesh& mesh, const CodedGrid& grid, int channels) {
    const PlaceGrid places{grid.width, grid.height, grid.step * kPlacesPerQuarter};
    CodedMesh out{grid, channels, {}, {}, mesh.faces};
    for (const Spot& spot : mesh.spot) {
        out.point.push_back({places.column(spot.place.x), places.row(spot.place.y)});
        for (int c = 0; c < channels; ++c) out.color.push_back(static_cast<float>(spot.color[c]));
    }
    return out;
}

class PictureEncoder {
  public:
    PictureEncoder(const Bitmap& picture, const EncodeParams& params, const Progress& progress)
        : picture_(picture),
          params_(params),
          progress_(progress),
          samples_(coding::premultiplied(picture)),
          weights_(coding::pixel_weights(picture, samples_, params.tune)),
          sums_(coding::objective(picture, samples_, params.tune), weights_) {}

    EncodedPicture encode() {
        if (params_.bytes)
            reach_bytes(*params_.bytes);
        else if (params_.psnr)
            reach_psnr(*params_.psnr);
        else
            reach_vertices(params_.vertices ? *params_.vertices : vertices_of_quality());
        best_.report.reached = reached_;
        return std::move(best_);
    }

  private:
    double pixels() const { return double(picture_.width) * picture_.height; }
    double samples() const { return pixels() * picture_.channels; }
    void report(double fraction, std::string_view stage) const {
        if (progress_) progress_(fraction, stage);
    }
    std::size_t vertices_of_quality() const {
        return std::max<std::size_t>(
            4, static_cast<std::size_t>(std::llround(pixels() / 8192 * std::exp2(*params_.quality / 8))));
    }

    // The grid for so many vertices, in quarter pixels. Where vertices are dense it is that of the pixels, as
    // only there a mesh can draw every pixel as it is.
    int grid_step(std::size_t vertices) const {
        const double side = std::sqrt(pixels() / static_cast<double>(vertices));
        if (side < kDenseSide) return 4;
        return std::clamp(static_cast<int>(std::lround(4 * side / kSideOverGrid)), 2, 4 * coding::kMaxSide);
    }
    std::size_t most_vertices(int step) const {
        const CodedGrid grid{picture_.width, picture_.height, step};
        return static_cast<std::size_t>(grid.columns()) * static_cast<std::size_t>(grid.rows());
    }
    // Of any grid: one at each pixel.
    std::size_t most_vertices() const { return most_vertices(4); }
    // So many, or as many as their grid has room for.
    std::size_t possible(std::size_t vertices) const {
        vertices = std::clamp<std::size_t>(vertices, 4, most_vertices());
        return std::min(vertices, most_vertices(grid_step(vertices)));
    }
    void start(std::size_t vertices) {
        step_ = grid_step(vertices);
        OptimizeParams params;
        params.effort = params_.effort;
        params.step = step_ * kPlacesPerQuarter;
        optimizer_ =
            std::make_unique<GridOptimizer>(sums_, regular_mesh(sums_, params.step, vertices), params);
    }
    void optimize(const GridSchedule& schedule) {
        static const GridSchedule dense{.rounds = 1, .sweeps = 0, .last_rounds = 0};
        const double side = std::sqrt(pixels() / static_cast<double>(optimizer_->vertices()));
        optimizer_->optimize(side < kDenseSide / 2 ? dense : schedule);
    }

    // The mesh as it is now, without colours.
    void take_mesh() {
        CodedMesh mesh =
            on_grid(optimizer_->result(), {sums_.width(), sums_.height(), step_}, sums_.channels());
        mesh.grid.width = picture_.width;
        mesh.grid.height = picture_.height;
        trial_ = std::make_unique<MeshTrial>(
            mesh, samples_, coding::color_weights(params_.tune, picture_.channels), weights_);
    }
    int usual_step_index() const {
        const double error = std::sqrt(optimizer_->squared_error() / samples());
        const double step_over_error = weights_.empty() ? kStepOverError : kStepOverWeighedError;
        int index = 0;
        while (index + 1 < coding::kStepIndices &&
               coding::color_step(index) < step_over_error * error * coding::kColorUnit)
            ++index;
        return index;
    }
    double psnr() const { return psnr_of(trial_->squared_error(picture_)); }
    double psnr_of(double error) const {
        return error == 0 ? std::numeric_limits<double>::infinity()
                          : 10 * std::log10(255.0 * 255 * samples() / error);
    }

    // Keeps what is coded if its error is the least so far, or the same in fewer bytes. Returns whether it
    // is.
    bool keep_if_best() {
        const double error = trial_->squared_error(picture_);
        const bool better = best_.bytes.empty() || error < best_error_ ||
                            (error == best_error_ && trial_->bytes().size() < best_.bytes.size());
        if (better) {
            best_ = result(error);
            best_error_ = error;
        }
        return better;
    }

    void reach_vertices(std::size_t wanted) {
        const std::size_t vertices = possible(wanted);
        start(vertices);
        optimizer_->set_vertex_count(vertices);
        report(0.1, "optimise");
        optimize(grid_schedule(params_.effort));
        take_mesh();
        trial_->code(usual_step_index());
        // A picture of few colours may take too few bytes for its vertices.
        for (std::size_t most; (most = coding::most_vertices(trial_->bytes().size())) < trial_->vertices();) {
            optimizer_->set_vertex_count(most);
            take_mesh();
            trial_->code(usual_step_index());
        }
        reached_ = !params_.vertices || trial_->vertices() == wanted;
        keep_if_best();
    }

    // Codes with the finest steps of colours that fit, and keeps that if it is the best. Returns whether it
    // is.
    bool fill(std::size_t wanted) {
        int low = 0, high = coding::kStepIndices - 1;
        while (low < high) {
            const int middle = (low + high) / 2;
            trial_->code(middle);
            if (trial_->bytes().size() <= wanted)
                high = middle;
            else
                low = middle + 1;
        }
        trial_->code(low);
        return trial_->bytes().size() <= wanted && keep_if_best();
    }

    // Whether a mesh of the corners alone, which it codes, has the PSNR in so many bytes: of a constant
    // picture.
    bool corners_do(double wanted, std::size_t most_bytes) {
        start(4);
        take_mesh();
        trial_->code(usual_step_index());
        if (trial_->bytes().size() > most_bytes || psnr() < wanted) return false;
        return keep_if_best();
    }

    void reach_bytes(std::size_t wanted) {
        if (corners_do(kExact, wanted)) return;
        const double bits = 8 * std::max(1.0, double(wanted) - kHeaderBytes);
        const std::size_t vertices = possible(static_cast<std::size_t>(bits / kVertexBits));
        start(vertices);
        optimizer_->set_vertex_count(vertices);
        report(0.1, "optimise");
        optimize(grid_schedule(params_.effort));
        // The number of vertices follows the bits that they have taken.
        constexpr int kRounds = 6;
        for (int round = 0; round < kRounds; ++round) {
            report(0.7 + 0.2 * round / kRounds, "rate");
            take_mesh();
            trial_->code(usual_step_index());
            const double ratio = double(wanted) / static_cast<double>(trial_->bytes().size());
            const auto next = static_cast<std::size_t>(
                std::max(4.0, std::floor(static_cast<double>(trial_->vertices()) * ratio)));
            // What is drawn almost exactly needs no more vertices.
            if (std::abs(ratio - 1) < 0.03 || next == trial_->vertices() || (ratio > 1 && psnr() > kExact))
                break;
            optimizer_->set_vertex_count(std::min(next, most_vertices(step_)));
            optimize(touch_up_schedule());
        }
        // The steps of colours make up for the rest.
        report(0.9, "rate");
        for (fill(wanted); best_.bytes.empty(); fill(wanted)) {
            if (trial_->vertices() == 4)
                throw Error(ErrorKind::kBadArgument, cat("a picture of this size takes at least ",
                                                         trial_->bytes().size(), " bytes, not ", wanted));
            use_fewer_vertices();
        }
        // A drawing may have had more vertices than it needs, so that too few bytes are left for colours.
        int misses = 0;
        while (best_.report.psnr > kFlat && trial_->vertices() > 4 && misses < 3) {
            use_fewer_vertices();
            misses = fill(wanted) ? 0 : misses + 1;
        }
    }
    void use_fewer_vertices() {
        optimizer_->set_vertex_count(std::max<std::size_t>(4, trial_->vertices() * 2 / 3));
        optimize(touch_up_schedule());
        take_mesh();
    }

    // Optimises so many vertices on a grid that suits them, and codes them; again: after a change of a mesh
    // that was optimised already. Returns the PSNR.
    double try_vertices(std::size_t vertices, int effort, bool again, double wanted) {
        const int step = grid_step(vertices);
        const bool fresh = !optimizer_ || step * 4 < step_ * 3 || step * 3 >= step_ * 4;
        if (fresh) start(vertices);
        optimizer_->set_vertex_count(std::min(vertices, most_vertices(step_)));
        optimize(again && !fresh ? touch_up_schedule() : grid_schedule(effort));
        take_mesh();
        // Where vertices are exact enough, colours may be what is missing.
        double reached = 0;
        constexpr int kOctave = 16;
        for (int index = usual_step_index();; index = std::max(0, index - kOctave)) {
            trial_->code(index);
            reached = psnr();
            if (reached >= wanted || index == 0 || (reached < kFlat && vertices < most_vertices())) break;
        }
        keep_if_best();
        return reached;
    }

    // Looks for the smallest mesh that has the PSNR, and leaves it in trial_ if there is one. Returns the
    // number of vertices to try next. More vertices are better on average alone.
    double search_psnr(double wanted, double vertices, int effort, double above) {
        constexpr int kRounds = 5;
        const auto most = static_cast<double>(most_vertices());
        // The most vertices that missed it, and the fewest that reached it.
        double few = 3, many = most + 1, few_psnr = 0, many_psnr = 0, slope = kDecibels;
        std::unique_ptr<MeshTrial> best;
        for (int round = 0; round < kRounds && many - few >= 2; ++round) {
            report(0.1 + 0.8 * round / kRounds, "rate");
            // The last round settles whether it can be had at all.
            if (round + 1 == kRounds && !best) vertices = most;
            vertices = std::clamp(std::round(vertices), few + 1, many - 1);
            const double reached =
                try_vertices(static_cast<std::size_t>(vertices), effort, round > 0, wanted);
            const auto taken = static_cast<double>(trial_->vertices());
            if (reached < wanted - kBelow) {
                few = std::min(std::max(few, taken), many - 1);
                few_psnr = reached;
            } else if (taken < many) {
                many = taken;
                many_psnr = reached;
                best = std::move(trial_);
            }
            if (few_psnr > 0 && many_psnr > 0)
                slope = std::clamp((many_psnr - few_psnr) / std::log2(many / few), 0.5, 6.0);
            vertices = taken * std::exp2(std::clamp((wanted - std::min(reached, 100.0)) / slope, -3.0, 3.0));
            if (reached >= wanted - kBelow && reached < wanted + above) break;
        }
        reached_ = best != nullptr;
        if (best) trial_ = std::move(best);
        return std::min(vertices, most);
    }

    void reach_psnr(double wanted) {
        if (corners_do(wanted, std::numeric_limits<std::size_t>::max())) return;
        // Short optimisations find about how many vertices it takes.
        const double vertices = search_psnr(wanted, std::max(4.0, pixels() / 400), 1, kFirstAbove);
        search_psnr(wanted, vertices, params_.effort, kAbove);
        if (!reached_) {
            reached_ = best_.report.psnr >= wanted - 0.1;
            return;
        }
        // The steps of colours make up for the rest: the coarsest that reaches it.
        int low = 0, high = coding::kStepIndices - 1;
        while (low < high) {
            const int middle = (low + high + 1) / 2;
            trial_->code(middle);
            if (psnr() >= wanted)
                low = middle;
            else
                high = middle - 1;
        }
        trial_->code(low);
        best_ = result(trial_->squared_error(picture_));
        reached_ = best_.report.psnr >= wanted - 0.1;
    }

    // What is coded, whose squared error is known.
    EncodedPicture result(double error) const {
        EncodedPicture out;
        out.bytes = trial_->bytes();
        out.report.vertices = trial_->vertices();
        out.report.faces = trial_->content().faces.size();
        out.report.grid_step = trial_->content().grid.step / 4.0;
        out.report.psnr = psnr_of(error);
        const coding::StreamSizes& sizes = trial_->sizes();
        out.report.header_bytes = sizes.header;
        out.report.point_bytes = sizes.points;
        out.report.face_bytes = sizes.faces;
        out.report.color_bytes = sizes.colors;
        return out;
    }

    const Bitmap& picture_;
    const EncodeParams& params_;
    const Progress& progress_;
    std::vector<float> samples_, weights_;  // of pixels, which all weigh the same if there are no weights
    RowSums sums_;
    int step_ = 4;
    bool reached_ = true;
    std::unique_ptr<GridOptimizer> optimizer_;
    std::unique_ptr<MeshTrial> trial_;
    EncodedPicture best_;  // of what was tried
    double best_error_ = 0;
};

}  // namespace

EncodedPicture encode_picture(const Bitmap& picture, const EncodeParams& params, const Progress& progress) {
    coding::check_request(picture, params);
    return PictureEncoder(picture, params, progress).encode();
}

}  // namespace imgmesh

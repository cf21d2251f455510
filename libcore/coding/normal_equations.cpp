#include "libcore/coding/normal_equations.h"

#include <algorithm>
#include <array>

#include "libcore/base/index.h"
#include "libcore/coding/color_transform.h"

namespace imgmesh::coding {

NormalEquations::NormalEquations(const CodedShape& shape, std::span<const FaceMoments> moments, int channels)
    : channels_(as_index(channels)),
      first_(shape.point.size() + 1),
      own_(shape.point.size()),
      right_(shape.point.size() * channels_),
      value_(right_.size()) {
    struct Entry {
        Id row, column;
        double gram;
    };
    std::vector<Entry> entries;
    entries.reserve(6 * moments.size());
    for (std::size_t f = 0; f < moments.size(); ++f) {
        const FaceMoments& m = moments[f];
        const Face& face = shape.faces[f];
        total_ += m.ii;
        for (std::size_t i = 0; i < 3; ++i) {
            own_[face[i]] += m.ww[i][i];
            for (std::size_t j = 0; j < 3; ++j)
                if (i != j) entries.push_back({face[i], face[j], m.ww[i][j]});
            std::array<double, 4> coded = m.wi[i];
            to_coded(std::span(coded).first(channels_));
            for (std::size_t c = 0; c < channels_; ++c) right_[face[i] * channels_ + c] += coded[c];
        }
    }
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return a.row != b.row ? a.row < b.row : a.column < b.column;
    });
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const Entry& e = entries[i];
        if (i > 0 && entries[i - 1].row == e.row && entries[i - 1].column == e.column) {
            terms_.back().gram += e.gram;
            continue;
        }
        terms_.push_back({e.column, e.gram});
        ++first_[e.row + 1];
    }
    for (std::size_t v = 0; v + 1 < first_.size(); ++v) first_[v + 1] += first_[v];
}

void NormalEquations::relax(std::size_t vertex) {
    if (own_[vertex] < 1e-6) return;
    std::array<double, 4> rest{};
    for (std::size_t c = 0; c < channels_; ++c) rest[c] = right_[vertex * channels_ + c];
    for (std::size_t i = first_[vertex]; i < first_[vertex + 1]; ++i)
        for (std::size_t c = 0; c < channels_; ++c)
            rest[c] -= terms_[i].gram * value_[terms_[i].vertex * channels_ + c];
    for (std::size_t c = 0; c < channels_; ++c) value_[vertex * channels_ + c] = rest[c] / own_[vertex];
}

void NormalEquations::solve(int sweeps) {
    for (int i = 0; i < sweeps; ++i)
        for (std::size_t v = 0; v < own_.size(); ++v) relax(v);
}

void NormalEquations::settle_after(std::size_t vertex) {
    for (int sweep = 0; sweep < 2; ++sweep)
        for (std::size_t i = first_[vertex]; i < first_[vertex + 1]; ++i)
            if (terms_[i].vertex > vertex) {
                const std::size_t next = terms_[i].vertex;
                relax(next);
                if (sweep == 0)
                    for (std::size_t j = first_[next]; j < first_[next + 1]; ++j)
                        if (terms_[j].vertex > vertex) relax(terms_[j].vertex);
            }
}

double NormalEquations::stiffness(std::size_t vertex) const {
    double out = own_[vertex];
    for (std::size_t i = first_[vertex]; i < first_[vertex + 1]; ++i)
        if (terms_[i].vertex > vertex)
            out -= terms_[i].gram * terms_[i].gram / std::max(own_[terms_[i].vertex], 1e-6);
    return std::max(out, 0.3 * own_[vertex]);
}

double NormalEquations::error() const {
    double out = total_;
    for (std::size_t v = 0; v < own_.size(); ++v)
        for (std::size_t c = 0; c < channels_; ++c) {
            double across = own_[v] * value_[v * channels_ + c];
            for (std::size_t i = first_[v]; i < first_[v + 1]; ++i)
                across += terms_[i].gram * value_[terms_[i].vertex * channels_ + c];
            out += value_[v * channels_ + c] * (across - 2 * right_[v * channels_ + c]);
        }
    return out;
}

}  // namespace imgmesh::coding

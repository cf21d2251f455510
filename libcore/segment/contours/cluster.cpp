// k-means with few centres. Vectors hold the values of several centres or pixels, never parts of one sum, so
// their width changes no bit.
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "libcore/base/parallel.h"
#include "libcore/segment/contours/codes.h"

namespace imgmesh {
namespace {

constexpr std::size_t kSample = 8000;  // pixels that centres are learned from
constexpr int kRounds = 10;            // of learning; more change few pixels' codes
constexpr int kGrain = 16;             // rows a block
constexpr std::size_t kCount = kCodes;

// Points with `dimensions` coordinates each, one after another.
struct Points {
    std::size_t dimensions = 0;
    std::vector<float> values;

    std::size_t count() const { return values.size() / dimensions; }
    const float* at(std::size_t i) const { return values.data() + i * dimensions; }
};

// Centres stored by coordinate: values[d * kCodes + k].
struct Centres {
    std::size_t dimensions = 0;
    std::vector<float> values;

    void set(std::size_t k, const float* point) {
        for (std::size_t d = 0; d < dimensions; ++d) values[d * kCount + k] = point[d];
    }
};

float squared_distance(const float* a, const float* b, std::size_t dimensions) {
    float sum = 0;
    for (std::size_t d = 0; d < dimensions; ++d) sum += (a[d] - b[d]) * (a[d] - b[d]);
    return sum;
}

using OfCentres = Eigen::Array<float, kCodes, 1>;

OfCentres squared_distances(const Centres& centres, const float* point) {
    OfCentres sums = OfCentres::Zero();
    for (std::size_t d = 0; d < centres.dimensions; ++d)
        sums += (Eigen::Map<const OfCentres>(centres.values.data() + d * kCount) - point[d]).square();
    return sums;
}

std::size_t nearest(const Centres& centres, const float* point) {
    const OfCentres all = squared_distances(centres, point);
    return as_index(std::min_element(all.data(), all.data() + kCount) - all.data());
}

Points sample_points(const std::vector<Plane>& planes, const Grid<std::uint8_t>& inside) {
    std::vector<std::size_t> pixels;
    for (std::size_t i = 0; i < inside.size(); ++i)
        if (inside[i]) pixels.push_back(i);
    const std::size_t count = std::min(kSample, pixels.size());
    Points points{planes.size(), {}};
    for (std::size_t n = 0; n < count; ++n)
        for (const Plane& plane : planes) points.values.push_back(plane[pixels[n * pixels.size() / count]]);
    return points;
}

// Each centre is a point drawn with a chance in proportion to its squared distance from those before. If all
// points lie on centres, the others repeat the last one and remain without points.
Centres first_centres(const Points& points) {
    std::mt19937 random(1);
    Centres centres{points.dimensions, std::vector<float>(points.dimensions * kCount)};
    std::vector<double> far(points.count(), 0);
    std::size_t chosen = random() % points.count();
    for (std::size_t k = 0; k < kCount; ++k) {
        centres.set(k, points.at(chosen));
        double total = 0;
        for (std::size_t i = 0; i < points.count(); ++i) {
            const auto distance =
                double(squared_distance(points.at(chosen), points.at(i), points.dimensions));
            far[i] = k == 0 ? distance : std::min(far[i], distance);
            total += far[i];
        }
        if (total == 0) {
            for (std::size_t rest = k + 1; rest < kCount; ++rest) centres.set(rest, points.at(chosen));
            break;
        }
        double left = total * (double(random()) / double(std::mt19937::max()));
        for (std::size_t i = 0; i < points.count(); ++i) {
            if (far[i] > 0) chosen = i;
            left -= far[i];
            if (left < 0) break;
        }
    }
    return centres;
}

// One round of learning. Returns whether some centre moved.
bool learn(Centres& centres, const Points& points) {
    std::vector<double> sums(centres.values.size(), 0);
    std::array<int, kCount> counts{};
    for (std::size_t i = 0; i < points.count(); ++i) {
        const std::size_t k = nearest(centres, points.at(i));
        ++counts[k];
        for (std::size_t d = 0; d < points.dimensions; ++d) sums[d * kCount + k] += double(points.at(i)[d]);
    }
    bool moved = false;
    for (std::size_t j = 0; j < sums.size(); ++j) {
        const int count = counts[j % kCount];
        if (count == 0) continue;
        const auto mean = static_cast<float>(sums[j] / count);
        moved |= mean != centres.values[j];
        centres.values[j] = mean;
    }
    return moved;
}

}  // namespace

Codes cluster(const std::vector<Plane>& planes, const Grid<std::uint8_t>& inside) {
    const Points points = sample_points(planes, inside);
    Centres centres = first_centres(points);
    for (int round = 0; round < kRounds && learn(centres, points); ++round) {
    }
    Codes codes{inside};
    parallel_blocks(0, inside.height, kGrain, [&](int begin, int end) {
        const Eigen::Index width = inside.width;
        Eigen::ArrayXf least(width), sums(width);
        for (int y = begin; y < end; ++y) {
            const std::size_t first = inside.row_begin(y);
            for (std::size_t k = 0; k < kCount; ++k) {
                sums.setZero();
                for (std::size_t d = 0; d < planes.size(); ++d)
                    sums += (Eigen::Map<const Eigen::ArrayXf>(planes[d].data() + first, width) -
                             centres.values[d * kCount + k])
                                .square();
                for (Eigen::Index x = 0; x < width; ++x)
                    if (k == 0 || sums[x] < least[x]) {
                        least[x] = sums[x];
                        codes[first + as_index(x)] = static_cast<std::uint8_t>(k);
                    }
            }
        }
    });
    return codes;
}

float rounded(float value, float step) {
    return std::round(value / step) * step;
}

Codes palette(const SmallImage& image) {
    std::vector<Plane> planes(3, Plane(image.inside.size()));
    for (std::size_t i = 0; i < image.inside.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) planes[c][i] = rounded(image.luv.pixel(i)[c], kColorStep);
    return cluster(planes, image.inside);
}

}  // namespace imgmesh

// Values on pixels: rows from top to bottom, each from left to right. Only here a column and a row become an
// index.
#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "libcore/base/index.h"

namespace imgmesh {

/// The size of an image, and of everything that has the same pixels.
struct GridSize {
    int width = 0;
    int height = 0;

    bool operator==(const GridSize&) const = default;
    std::size_t pixel_count() const { return as_index(width) * as_index(height); }
    bool contains(int x, int y) const { return x >= 0 && x < width && y >= 0 && y < height; }
    std::size_t index(int x, int y) const {
        assert(contains(x, y));
        return as_index(y) * as_index(width) + as_index(x);
    }
    /// Returns the index of a row's first pixel.
    std::size_t row_begin(int y) const {
        assert(y >= 0 && y < height);
        return as_index(y) * as_index(width);
    }
    /// Return the column and the row of a pixel.
    int x_of(std::size_t pixel) const { return as_int(pixel % as_index(width)); }
    int y_of(std::size_t pixel) const { return as_int(pixel / as_index(width)); }
};

/// One value for each pixel.
template <typename T>
struct Grid : GridSize {
    std::vector<T> values;  ///< size width * height

    Grid() = default;
    /// `values` may be empty, to be filled by push_back.
    Grid(int columns, int rows, std::vector<T> all) : GridSize{columns, rows}, values(std::move(all)) {}
    /// Fills the grid with one value.
    explicit Grid(const GridSize& size, const T& value = {})
        : GridSize(size), values(size.pixel_count(), value) {}

    bool operator==(const Grid&) const = default;
    bool empty() const { return values.empty(); }
    std::size_t size() const { return values.size(); }
    auto begin() const { return values.begin(); }
    auto begin() { return values.begin(); }
    auto end() const { return values.end(); }
    auto end() { return values.end(); }

    const T& operator[](std::size_t pixel) const { return values[pixel]; }
    T& operator[](std::size_t pixel) { return values[pixel]; }
    const T& at(int x, int y) const { return values[index(x, y)]; }
    T& at(int x, int y) { return values[index(x, y)]; }
    std::span<const T> row(int y) const { return {values.data() + row_begin(y), as_index(width)}; }
    std::span<T> row(int y) { return {values.data() + row_begin(y), as_index(width)}; }
};

/// Several floats for each pixel, interleaved.
struct ChannelGrid : GridSize {
    int channels = 0;
    std::vector<float> data;  ///< size width * height * channels

    ChannelGrid() = default;
    /// `samples` may be empty, to be filled by push_back.
    ChannelGrid(int columns, int rows, int planes, std::vector<float> samples)
        : GridSize{columns, rows}, channels(planes), data(std::move(samples)) {}

    std::size_t sample_count() const { return pixel_count() * as_index(channels); }
    std::size_t row_size() const { return as_index(width) * as_index(channels); }
    std::span<const float> row(int y) const {
        return {data.data() + row_begin(y) * as_index(channels), row_size()};
    }
    std::span<float> row(int y) { return {data.data() + row_begin(y) * as_index(channels), row_size()}; }

    /// Returns a pointer to the first of a pixel's samples.
    const float* pixel(std::size_t index) const { return data.data() + index * as_index(channels); }
    float* pixel(std::size_t index) { return data.data() + index * as_index(channels); }
    const float* pixel(int x, int y) const { return pixel(index(x, y)); }
    float* pixel(int x, int y) { return pixel(index(x, y)); }
};

}  // namespace imgmesh

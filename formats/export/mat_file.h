// Variables for MATLAB, Octave and SciPy: .mat files of level 5. Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>

namespace imgmesh {

/// What the numbers of a matrix are; the value is MATLAB's number of the class.
enum class MatType : std::uint8_t { kDouble = 6, kSingle = 7, kUint16 = 11, kUint32 = 13 };

/// A matrix of numbers.
struct MatVariable {
    std::string name;
    MatType type = MatType::kDouble;
    std::size_t rows = 1;
    std::size_t columns = 1;
    bool in_cell = false;  ///< the variable is a 1 x 1 cell array that holds the matrix
    /// Writes the numbers, in this machine's order, column after column. They are not held twice.
    std::function<void(std::uint8_t* to)> fill;
};

/// Returns a MatVariable::fill for a grid of `width` x `height` values that has them row after row: `value`
/// gives the stored value of a place.
template <typename Value, typename ValueAt>
std::function<void(std::uint8_t*)> by_columns(std::size_t width, std::size_t height, ValueAt value) {
    return [=](std::uint8_t* to) {
        for (std::size_t x = 0; x < width; ++x)
            for (std::size_t y = 0; y < height; ++y, to += sizeof(Value)) {
                const Value v = value(y * width + x);
                std::memcpy(to, &v, sizeof v);
            }
    };
}

/// Writes a .mat, each variable compressed (MathWorks' "MAT-File Format", level 5), which MATLAB 7, Octave
/// and scipy.io.loadmat() read. The same variables give the same bytes. The file appears whole or not at all.
/// Throws Error: kUnsupported for a variable of 2 GB or more, which MATLAB does not read; kIo if the file
/// cannot be written, or exists and `overwrite` is false.
void write_mat(const std::string& path, std::span<const MatVariable> variables, bool overwrite);

}  // namespace imgmesh

// Variables for MATLAB, Octave and SciPy: .mat files of level 5. Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace imgmesh {

/// What the numbers of a matrix are; the value is MATLAB's number of the class.
enum class MatType : std::uint8_t { kDouble = 6, kSingle = 7, kUint16 = 11, kUint32 = 13 };

/// A matrix of numbers.
struct MatVariable {
    std::string name;
    MatType type = MatType::kDouble;
    std::size_t rows = 1;
    std::size_t columns = 1;
    std::vector<std::uint8_t> bytes;  ///< of this machine's order, column after column
    bool in_cell = false;             ///< the variable is a 1 x 1 cell array that holds the matrix
};

/// Returns the bytes of a grid of `width` x `height` values, row after row, in MATLAB's order: column after
/// column. `value` gives the stored value of a place.
template <typename Value, typename ValueAt>
std::vector<std::uint8_t> column_bytes(std::size_t width, std::size_t height, ValueAt value) {
    std::vector<std::uint8_t> bytes(width * height * sizeof(Value));
    std::size_t k = 0;
    for (std::size_t x = 0; x < width; ++x)
        for (std::size_t y = 0; y < height; ++y) {
            const Value v = value(y * width + x);
            const auto* const from = reinterpret_cast<const std::uint8_t*>(&v);
            for (std::size_t b = 0; b < sizeof v; ++b) bytes[k++] = from[b];
        }
    return bytes;
}

/// Writes a .mat, each variable compressed (MathWorks' "MAT-File Format", level 5), which MATLAB 7, Octave
/// and scipy.io.loadmat() read. The same variables give the same bytes. The file appears whole or not at all.
/// Throws Error: kUnsupported for a variable of 2 GB or more, which MATLAB does not read; kIo if the file
/// cannot be written, or exists and `overwrite` is false.
void write_mat(const std::string& path, std::span<const MatVariable> variables, bool overwrite);

}  // namespace imgmesh

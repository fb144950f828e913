// NumPy arrays (.npy), the exchange format with other tools.
#pragma once

#include "ostraka/files/file.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

/// A .npy file in memory whose header has been read and checked against the number of bytes. The bytes must outlive the view.
struct NpyView {
    std::string type;                ///< NumPy's name of the number type: "<f8", "<i8" ...
    bool columns_first = false;      ///< true: Fortran order (column-major)
    std::vector<std::size_t> shape;  ///< size of each of the one or two dimensions
    std::string_view data;           ///< bytes of the numbers

    [[nodiscard]] std::size_t count() const;  ///< number of numbers
    [[nodiscard]] std::size_t rows() const { return shape.front(); }
    [[nodiscard]] std::size_t columns() const { return shape.size() < 2 ? 1 : shape[1]; }
    /// Copies the numbers in row-major order to `values` (room for count() numbers), whatever the order of the numbers in the
    /// file. Integers and booleans are converted to double (integers above 2^53 are rounded). Throws Error (input) for big-endian
    /// numbers, complex numbers and text.
    void copy_to(double* values) const;
    /// Copies the numbers in row-major order to `values` (room for count() numbers). Throws Error (input) unless all values are
    /// integers within the range of int64.
    void copy_to(std::int64_t* values) const;

    std::string where;  ///< file name for error messages
};

/// Reads the header of a .npy file. Throws Error (input), with the remedy, if the bytes are no .npy file, if the header is not
/// the dictionary with three members that NumPy writes, if the array does not have one or two dimensions, or if its shape does
/// not match the number of bytes. The amount of memory allocated does not depend on the header.
NpyView view_npy(std::string_view bytes, const std::string& where);

/// An array in memory, in row-major order.
template <class Number>
struct NpyArray {
    std::vector<std::size_t> shape;  ///< size of each of the one or two dimensions
    std::vector<Number> values;      ///< the numbers, in row-major order
    [[nodiscard]] std::size_t rows() const { return shape.front(); }
    [[nodiscard]] std::size_t columns() const { return shape.size() < 2 ? 1 : shape[1]; }
};
NpyArray<double> read_npy(const Path& file);                 ///< converts integers to double
NpyArray<std::int64_t> read_npy_integers(const Path& file);  ///< the file must hold integers

/// Writes an array as little-endian float64 or int64 in C order, atomically; `shape` has one or two sizes whose product is the
/// number of values. Returns the SHA-256 of the file. Throws the errors of AtomicFile, and std::logic_error if the shape does not
/// match the values.
std::string write_npy(const Path& file, std::span<const double> values, const std::vector<std::size_t>& shape);
std::string write_npy(const Path& file, std::span<const std::int64_t> values, const std::vector<std::size_t>& shape);

}  // namespace ostraka

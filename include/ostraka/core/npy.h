// NumPy arrays (.npy): what is shared with other tools.
#pragma once

#include "ostraka/core/file.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

/// The bytes of a .npy file, its head read and held against their number. What it points to must outlive it.
struct NpyView {
    std::string type;                ///< NumPy's name: "<f8", "<i8" ...
    bool columns_first = false;      ///< Fortran order
    std::vector<std::size_t> shape;  ///< one or two sizes
    std::string_view data;           ///< the numbers

    [[nodiscard]] std::size_t count() const;
    [[nodiscard]] std::size_t rows() const { return shape.front(); }
    [[nodiscard]] std::size_t columns() const { return shape.size() < 2 ? 1 : shape[1]; }
    /// Copies the numbers, row by row, whatever their order in the file, to `values` (room for count() numbers). Integers and
    /// booleans become doubles (those above 2^53 are rounded). Error (input) for big-endian numbers, complex ones, text.
    void copy_to(double* values) const;
    /// As above; Error (input) unless they are integers that fit.
    void copy_to(std::int64_t* values) const;

    std::string where;  ///< for errors: the file
};

/// Error (input), with the remedy, if the bytes are no .npy file, its head is not the dictionary of three members that NumPy
/// writes, the array has another number of dimensions than one or two, or the shape asks for another number of bytes than there
/// are. Allocates nothing that a head could ask for.
NpyView view_npy(std::string_view bytes, const std::string& where);

/// An array in memory, row by row.
template <class Number>
struct NpyArray {
    std::vector<std::size_t> shape;
    std::vector<Number> values;
    [[nodiscard]] std::size_t rows() const { return shape.front(); }
    [[nodiscard]] std::size_t columns() const { return shape.size() < 2 ? 1 : shape[1]; }
};
NpyArray<double> read_npy(const Path& file);
NpyArray<std::int64_t> read_npy_integers(const Path& file);

/// Writes little-endian float64 or int64 in C order, atomically; `shape` has one or two sizes whose product is the number of
/// values. Returns the SHA-256 of the file's bytes. Errors as AtomicFile; std::logic_error for a shape that does not fit.
std::string write_npy(const Path& file, std::span<const double> values, const std::vector<std::size_t>& shape);
std::string write_npy(const Path& file, std::span<const std::int64_t> values, const std::vector<std::size_t>& shape);

}  // namespace ostraka

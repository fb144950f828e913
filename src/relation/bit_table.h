// A relation between two index sets as a table of bits. Private to the module.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace ostraka::detail {

/// A table of bits; rows are padded to 64-bit words.
class BitTable {
public:
    BitTable(std::size_t rows, std::size_t columns) : words_((columns + 63) / 64), bits_(rows * words_, 0) {}
    [[nodiscard]] std::uint64_t* row(std::size_t r) { return bits_.data() + r * words_; }  ///< first 64-bit word of row r
    /// First 64-bit word of row r.
    [[nodiscard]] const std::uint64_t* row(std::size_t r) const { return bits_.data() + r * words_; }
    /// Whether the bit in row r and column c is set.
    [[nodiscard]] bool test(std::size_t r, std::size_t c) const { return (row(r)[c / 64] >> (c % 64) & 1U) != 0; }
    /// Sets the bit in row r and column c.
    void set(std::size_t r, std::size_t c) { row(r)[c / 64] |= std::uint64_t{1} << (c % 64); }
    void clear(std::size_t r, std::size_t c) { row(r)[c / 64] &= ~(std::uint64_t{1} << (c % 64)); }
    /// Sets all bits of a row.
    void fill(std::size_t r) { std::fill_n(row(r), words_, ~std::uint64_t{0}); }
    /// Clears all bits of a row.
    void zero(std::size_t r) { std::fill_n(row(r), words_, 0); }
    /// Clears the bits of a row that are not set in the mask; `first`, `last`: range of 64-bit words.
    void keep(std::size_t r, const std::vector<std::uint64_t>& mask) { keep(r, mask, 0, words_); }
    void keep(std::size_t r, const std::vector<std::uint64_t>& mask, std::size_t first, std::size_t last) {
        for (std::size_t w = first; w < last; ++w) row(r)[w] &= mask[w];
    }
    /// Sets the bits of a row that are set in the mask; `first`, `last`: range of 64-bit words.
    void add(std::size_t r, const std::uint64_t* mask) { add(r, mask, 0, words_); }
    void add(std::size_t r, const std::uint64_t* mask, std::size_t first, std::size_t last) {
        for (std::size_t w = first; w < last; ++w) row(r)[w] |= mask[w];
    }
    [[nodiscard]] std::size_t words() const { return words_; }  ///< number of 64-bit words of a row
    /// Calls visit(column) for each set bit of a row.
    template <class Visit>
    void each(std::size_t r, Visit&& visit) const {
        for (std::size_t w = 0; w < words_; ++w)
            for (std::uint64_t left = row(r)[w]; left != 0; left &= left - 1)
                visit(w * 64 + static_cast<std::size_t>(std::countr_zero(left)));
    }

private:
    std::size_t words_;                ///< number of 64-bit words of a row
    std::vector<std::uint64_t> bits_;  ///< words of all rows
};

}  // namespace ostraka::detail

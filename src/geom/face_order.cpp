#include "geom/face_order.h"

#include "ostraka/execution/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace ostraka {

namespace {

constexpr unsigned axis_bits = 21, code_bits = 3 * axis_bits, bucket_bits = 12;
constexpr std::size_t block_size = std::size_t{1} << 15;

/// Inserts two zeros before each of 21 bits.
std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x001f00000000ffff;
    x = (x | x << 16) & 0x001f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

/// Morton code of a position relative to the centre, in units of the diagonal.
std::uint64_t morton_code(const Vector& place) {
    constexpr double cells = 1U << axis_bits;
    const auto cell = [](double x) {
        return static_cast<std::uint64_t>(x > -0.5 ? std::min((x + 0.5) * cells, cells - 1) : 0.0);
    };
    return spread(cell(place.x())) << 2 | spread(cell(place.y())) << 1 | spread(cell(place.z()));
}

struct Lists {
    std::uint64_t* codes;
    Index* faces;
    void copy(std::size_t i, const Lists& from, std::size_t k) const {
        codes[i] = from.codes[k];
        faces[i] = from.faces[k];
    }
};

/// Stable radix sort by the last `bits` bits, from the last digit on. `other`: working memory of the same size.
void sort_by_last(unsigned bits, const Lists& list, const Lists& other, std::size_t count) {
    constexpr unsigned digit_bits = 9;
    constexpr std::size_t digits = std::size_t{1} << digit_bits;
    Lists from = list, to = other;
    for (unsigned shift = 0; shift < bits; shift += digit_bits) {
        const auto digit = [shift](std::uint64_t code) { return (code >> shift) % digits; };
        std::array<std::uint32_t, digits> places{};
        for (std::size_t i = 0; i < count; ++i) ++places[digit(from.codes[i])];
        if (places[digit(from.codes[0])] == count) continue;
        std::uint32_t next = 0;
        for (std::uint32_t& place : places) next += std::exchange(place, next);
        for (std::size_t i = 0; i < count; ++i) to.copy(places[digit(from.codes[i])]++, from, i);
        std::swap(from, to);
    }
    if (from.codes == list.codes) return;
    for (std::size_t i = 0; i < count; ++i) list.copy(i, from, i);
}

/// Sorts into buckets by the leading bits of the codes, then sorts each bucket. Each block of the list counts its own codes,
/// which determines the positions of its entries in the buckets.
void sort_by_code(FaceOrder& order) {
    constexpr std::size_t buckets = std::size_t{1} << bucket_bits;
    const std::size_t count = order.count, blocks = (count + block_size - 1) / block_size;
    auto codes = std::make_unique_for_overwrite<std::uint64_t[]>(count);
    auto faces = std::make_unique_for_overwrite<Index[]>(count);
    const Lists unsorted{order.codes.get(), order.faces.get()}, sorted{codes.get(), faces.get()};
    if (blocks <= 1) {
        if (count > 0) sort_by_last(code_bits, unsorted, sorted, count);
        return;
    }
    const auto bucket = [](std::uint64_t code) { return code >> (code_bits - bucket_bits); };
    std::vector<std::uint32_t> places(blocks * buckets, 0);
    parallel_blocks(count, block_size, [&](std::size_t begin, std::size_t end) {
        std::uint32_t* const own = &places[begin / block_size * buckets];
        for (std::size_t i = begin; i < end; ++i) ++own[bucket(unsorted.codes[i])];
    });
    std::vector<std::uint32_t> first(buckets + 1, 0);
    std::uint32_t next = 0;
    for (std::size_t d = 0; d < buckets; ++d) {
        for (std::size_t b = 0; b < blocks; ++b) next += std::exchange(places[b * buckets + d], next);
        first[d + 1] = next;
    }
    parallel_blocks(count, block_size, [&](std::size_t begin, std::size_t end) {
        std::uint32_t* const own = &places[begin / block_size * buckets];
        for (std::size_t i = begin; i < end; ++i) sorted.copy(own[bucket(unsorted.codes[i])]++, unsorted, i);
    });
    parallel_for(buckets, 16, [&](std::size_t d) {
        const std::size_t begin = first[d], size = first[d + 1] - begin;
        const Lists list{sorted.codes + begin, sorted.faces + begin}, other{unsorted.codes + begin, unsorted.faces + begin};
        if (size > 1) sort_by_last(code_bits - bucket_bits, list, other, size);
    });
    order.codes = std::move(codes);
    order.faces = std::move(faces);
}

}  // namespace

FaceOrder order_faces(const Mesh& mesh, const Point& middle, double diagonal) {
    const std::size_t faces = mesh.number_of_faces(), blocks = (faces + block_size - 1) / block_size;
    FaceOrder order;
    order.codes = std::make_unique_for_overwrite<std::uint64_t[]>(faces);
    order.faces = std::make_unique_for_overwrite<Index[]>(faces);
    // Each block fills its own part of the list, starting at the beginning of the part.
    std::vector<std::size_t> filled(blocks, 0);
    std::vector<double> areas(blocks, 0);
    parallel_blocks(faces, block_size, [&](std::size_t begin, std::size_t end) {
        std::size_t next = begin;
        for (std::size_t f = begin; f < end; ++f) {
            const auto [a, b, c] = corners(mesh, Face(static_cast<Index>(f)));
            const Point &pa = mesh.point(a), &pb = mesh.point(b), &pc = mesh.point(c);
            const double squared = (0.5 * CGAL::cross_product(pb - pa, pc - pa)).squared_length();
            if (!(squared > 0)) continue;
            areas[begin / block_size] += std::sqrt(squared);
            order.codes[next] = morton_code(((pa - middle) + (pb - middle) + (pc - middle)) / (3 * diagonal));
            order.faces[next++] = static_cast<Index>(f);
        }
        filled[begin / block_size] = next - begin;
    });
    for (std::size_t b = 0; b < blocks; ++b) {
        const std::size_t begin = b * block_size;
        if (order.count < begin) {
            std::copy_n(&order.codes[begin], filled[b], &order.codes[order.count]);
            std::copy_n(&order.faces[begin], filled[b], &order.faces[order.count]);
        }
        order.count += static_cast<std::uint32_t>(filled[b]);
    }
    order.area = std::accumulate(areas.begin(), areas.end(), 0.0);
    sort_by_code(order);
    return order;
}

}  // namespace ostraka

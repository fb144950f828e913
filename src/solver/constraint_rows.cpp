#include "solver/constraint_rows.h"

#include "ostraka/execution/parallel.h"
#include "ostraka/mesh/disjoint_sets.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka::solver {

namespace {
constexpr Eigen::Index largest_dense_group = 12;
}

Unknowns number_unknowns(std::span<const std::unique_ptr<Constraint>> constraints, Eigen::Index points) {
    Unknowns result;
    result.of_point.assign(static_cast<std::size_t>(points), -1);
    for (const auto& constraint : constraints)
        for (const int id : constraint->ids()) {
            if (id < 0 || id >= points) fail_usage("a constraint names point " + std::to_string(id) + ", which does not exist");
            result.of_point[id] = 0;
        }
    for (std::size_t i = 0; i < result.of_point.size(); ++i)
        if (result.of_point[i] == 0) {
            result.of_point[i] = static_cast<int>(result.point.size());
            result.point.push_back(static_cast<int>(i));
        }
    result.count = static_cast<int>(result.point.size());
    RowMatrix& rows = result.rows;
    const auto add = [&](int unknown, double value) {
        rows.unknown.push_back(unknown);
        rows.value.push_back(value);
    };
    for (const auto& constraint : constraints) {
        result.first_row.push_back(rows.rows());
        const Constraint::Map& map = constraint->map();
        const auto unknown = [&](Eigen::Index position) { return result.of_point[constraint->ids()[position]]; };
        const bool dense = map.centred && map.direct <= largest_dense_group;
        const int mean = map.centred && !dense ? result.count++ : -1;
        for (Eigen::Index i = 0; i < map.direct; ++i) {
            if (dense) {
                for (Eigen::Index j = 0; j < map.direct; ++j)
                    add(unknown(j), (i == j ? 1.0 : 0.0) - 1.0 / static_cast<double>(map.direct));
            } else {
                add(unknown(i), 1.0);
                if (mean >= 0) add(mean, -1.0);
            }
            rows.begin.push_back(rows.unknown.size());
        }
        std::size_t at = 0;
        for (Eigen::Index r = 0; r < map.rows - map.direct; ++r) {
            for (; at < map.entries.size() && map.entries[at].row == r; ++at)
                if (r < map.rows - map.direct - map.observed) add(unknown(map.entries[at].position), map.entries[at].value);
            rows.begin.push_back(rows.unknown.size());
        }
    }
    result.first_row.push_back(rows.rows());
    return result;
}

RowMatrix transposed(const RowMatrix& matrix, int columns) {
    RowMatrix result;
    result.begin.assign(static_cast<std::size_t>(columns) + 1, 0);
    for (const int u : matrix.unknown) ++result.begin[u + 1];
    std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());
    result.unknown.resize(matrix.unknown.size());
    result.value.resize(matrix.unknown.size());
    std::vector<std::size_t> next(result.begin.begin(), result.begin.end() - 1);
    for (std::size_t r = 0; r < matrix.rows(); ++r)
        for (std::size_t k = matrix.begin[r]; k < matrix.begin[r + 1]; ++k) {
            const std::size_t at = next[matrix.unknown[k]]++;
            result.unknown[at] = static_cast<int>(r);
            result.value[at] = matrix.value[k];
        }
    return result;
}

LowerTriangle normal_matrix(const RowMatrix& rows, const RowMatrix& columns, std::span<const double> row_weight) {
    const auto n = columns.rows();
    constexpr std::size_t block = 2048;
    struct Part {
        std::vector<int> size, index;
        std::vector<double> value;
    };
    std::vector<Part> parts((n + block - 1) / block);
    parallel_blocks(n, block, [&](std::size_t begin, std::size_t end) {
        Part& part = parts[begin / block];
        std::vector<std::pair<int, double>> column;
        for (std::size_t j = begin; j < end; ++j) {
            column.clear();
            column.emplace_back(static_cast<int>(j), 0.0);
            for (std::size_t k = columns.begin[j]; k < columns.begin[j + 1]; ++k) {
                const auto r = static_cast<std::size_t>(columns.unknown[k]);
                const double factor = columns.value[k] * row_weight[r];
                for (std::size_t e = rows.begin[r]; e < rows.begin[r + 1]; ++e)
                    if (rows.unknown[e] >= static_cast<int>(j)) column.emplace_back(rows.unknown[e], factor * rows.value[e]);
            }
            std::stable_sort(column.begin(), column.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
            const std::size_t before = part.index.size();
            for (const auto& [i, value] : column) {
                if (part.index.size() == before || part.index.back() != i) {
                    part.index.push_back(i);
                    part.value.push_back(value);
                } else {
                    part.value.back() += value;
                }
            }
            part.size.push_back(static_cast<int>(part.index.size() - before));
        }
    });
    std::size_t entries = 0;
    for (const Part& part : parts) entries += part.index.size();
    if (entries > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw Error(ErrorKind::failure, "solver", "the normal matrix has too many entries",
                    "solve through a cage, or a coarser mesh");
    LowerTriangle matrix(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
    matrix.resizeNonZeros(static_cast<Eigen::Index>(entries));
    std::size_t at = 0, j = 0;
    matrix.outerIndexPtr()[0] = 0;
    for (const Part& part : parts) {
        std::copy(part.index.begin(), part.index.end(), matrix.innerIndexPtr() + at);
        std::copy(part.value.begin(), part.value.end(), matrix.valuePtr() + at);
        for (const int size : part.size) {
            at += static_cast<std::size_t>(size);
            matrix.outerIndexPtr()[++j] = static_cast<int>(at);
        }
    }
    return matrix;
}

Floating floating_parts(const Unknowns& unknowns, std::span<const double> row_weight) {
    DisjointSets sets(static_cast<std::size_t>(unknowns.count));
    std::vector<char> active(sets.size(), 0), held(sets.size(), 0);
    const RowMatrix& rows = unknowns.rows;
    for (int pass = 0; pass < 2; ++pass)  // the first pass joins connected unknowns, the second finds sets with a fixed
                                          // position
        for (std::size_t r = 0; r < rows.rows(); ++r) {
            if (!(row_weight[r] > 0) || rows.begin[r] == rows.begin[r + 1]) continue;
            const int first = rows.unknown[rows.begin[r]];
            double sum = 0, size = 0;
            for (std::size_t k = rows.begin[r]; k < rows.begin[r + 1]; ++k) {
                active[rows.unknown[k]] = 1;
                sum += rows.value[k];
                size += std::abs(rows.value[k]);
                if (pass == 0) sets.unite(first, rows.unknown[k]);
            }
            if (pass == 1 && std::abs(sum) > 1e-9 * size) held[sets.find(first)] = 1;
        }
    Floating result;
    std::vector<int> part_of(sets.size(), -1);
    for (int i = 0; i < unknowns.count; ++i) {
        if (!active[i]) {
            result.idle.push_back(i);
            continue;
        }
        const Index r = sets.find(i);
        if (held[r] || i >= static_cast<int>(unknowns.point.size())) continue;
        if (part_of[r] < 0) {
            part_of[r] = static_cast<int>(result.parts.size());
            result.parts.emplace_back();
        }
        result.parts[part_of[r]].push_back(i);
    }
    return result;
}

}  // namespace ostraka::solver

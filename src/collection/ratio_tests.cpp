#include "collection/ratio_tests.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/inference.h"
#include "ostraka/stats/random.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace ostraka::proportions {

namespace {

constexpr double unknown_value = std::numeric_limits<double>::quiet_NaN();
/// Sums in a different order differ by rounding; differences up to this tolerance count as equal.
constexpr double rounding = 1e-12;

bool is_known(double value) { return !std::isnan(value); }

/// Variance of a difference over rows that have both values, from moments about 0 of columns that are already centred.
Variance variance_of(const double* a, const double* b, Eigen::Index rows) {
    double sum = 0, square = 0, n = 0;
    for (Eigen::Index i = 0; i < rows; ++i)
        if (const double d = a[i] - b[i]; is_known(d)) sum += d, square += d * d, n += 1;
    if (n < 2) return {0, static_cast<std::size_t>(n)};
    return {std::max(0.0, square - sum * sum / n) / (n - 1), static_cast<std::size_t>(n)};
}

/// Correlation of the deviations of the first two columns from the mean of the others, corrected for the error of that mean.
/// `columns`: rows that have the first two values and at least two others.
double residual_correlation(const Eigen::MatrixXd& columns) {
    const Eigen::Index n = columns.rows(), m = columns.cols();
    std::vector<double> da, db;
    double error = 0, sum_a = 0, sum_b = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
        double sum = 0, square = 0, k = 0;
        for (Eigen::Index j = 2; j < m; ++j)
            if (const double y = columns(i, j); is_known(y)) sum += y, square += y * y, k += 1;
        const double mean = sum / k;
        error += std::max(0.0, square - sum * mean) / (k - 1) / k;
        da.push_back(columns(i, 0) - mean);
        db.push_back(columns(i, 1) - mean);
        sum_a += da.back();
        sum_b += db.back();
    }
    double aa = 0, bb = 0, ab = 0;
    for (std::size_t i = 0; i < da.size(); ++i) {
        const double a = da[i] - sum_a / static_cast<double>(n), b = db[i] - sum_b / static_cast<double>(n);
        aa += a * a;
        bb += b * b;
        ab += a * b;
    }
    return aa > 0 && bb > 0 ? (ab - error) / std::sqrt(aa * bb) : 0;
}

}  // namespace

Eigen::MatrixXd centred_columns(const Eigen::MatrixXd& logs) {
    const Eigen::Index n = logs.rows(), m = logs.cols();
    // Subtracts the first value of each column first, to avoid cancellation if all values are large.
    Eigen::MatrixXd x = logs;
    for (Eigen::Index j = 0; j < m; ++j) {
        double first = 0;
        for (Eigen::Index i = n; i-- > 0;)
            if (is_known(logs(i, j))) first = logs(i, j);
        x.col(j).array() -= first;
    }
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(m, m);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(m);
    for (Eigen::Index i = 0; i < n; ++i) {
        double sum = 0, k = 0;
        for (Eigen::Index j = 0; j < m; ++j)
            if (is_known(x(i, j))) sum += x(i, j), k += 1;
        for (Eigen::Index j = 0; j < m; ++j) {
            if (!is_known(x(i, j))) continue;
            normal(j, j) += 1;
            right[j] += x(i, j) - sum / k;
            for (Eigen::Index l = 0; l < m; ++l)
                if (is_known(x(i, l))) normal(j, l) -= 1 / k;
        }
    }
    // The columns are determined up to a constant, which the sizes can absorb: take the minimum-norm solution.
    const Eigen::VectorXd centre = solve_least_squares(normal, right);
    return x.rowwise() - centre.transpose();
}

Variance ratio_variance(const Eigen::MatrixXd& logs, const Pair& pair) {
    return variance_of(logs.col(pair.a).data(), logs.col(pair.b).data(), logs.rows());
}

std::vector<double> pairing_test(const Eigen::MatrixXd& centred, const std::vector<Pair>& pairs, int permutations,
                                 std::uint64_t seed) {
    std::vector<double> p(pairs.size(), 1.0);
    parallel_for(pairs.size(), 1, [&](std::size_t r) {
        std::vector<double> a, b;
        for (Eigen::Index i = 0; i < centred.rows(); ++i)
            if (is_known(centred(i, pairs[r].a)) && is_known(centred(i, pairs[r].b)))
                a.push_back(centred(i, pairs[r].a)), b.push_back(centred(i, pairs[r].b));
        // The variance of the difference decreases as the sum of products increases.
        const auto products = [&] {
            double sum = 0;
            for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
            return sum;
        };
        double size = 0;
        for (std::size_t i = 0; i < a.size(); ++i) size += std::abs(a[i] * b[i]);
        const double observed = products() - rounding * size;
        Random random(seed, r);
        std::vector<double> chance;
        for (int k = 0; k < permutations; ++k) {
            random.shuffle(b);
            chance.push_back(products());
        }
        p[r] = permutation_p_value(observed, chance);
    });
    return p;
}

std::vector<double> others_test(const Eigen::MatrixXd& centred, const std::vector<Pair>& pairs, int permutations,
                                std::uint64_t seed) {
    const Eigen::Index n = centred.rows();
    Eigen::MatrixXd row_centred = centred;
    std::vector<std::vector<Eigen::Index>> present(static_cast<std::size_t>(n));
    for (Eigen::Index i = 0; i < n; ++i) {
        double sum = 0;
        auto& columns = present[static_cast<std::size_t>(i)];
        for (Eigen::Index j = 0; j < row_centred.cols(); ++j)
            if (is_known(row_centred(i, j))) sum += row_centred(i, j), columns.push_back(j);
        row_centred.row(i).array() -= columns.empty() ? 0 : sum / static_cast<double>(columns.size());
    }
    // Under the null hypothesis, ratios over the same number of objects have the same variance: they are pooled.
    std::map<std::size_t, std::vector<double>> observed;
    std::vector<Variance> variances;
    for (const Pair& pair : pairs) {
        variances.push_back(ratio_variance(row_centred, pair));
        observed[variances.back().count].push_back(variances.back().value);
    }
    for (auto& [count, values] : observed) std::sort(values.begin(), values.end());

    // For each block of permutations, the number of ratios that vary no more than each of the observed ones.
    const std::size_t block = 64, blocks = (static_cast<std::size_t>(permutations) + block - 1) / block;
    std::vector<std::map<std::size_t, std::vector<std::size_t>>> counted(blocks);
    parallel_for(blocks, 1, [&](std::size_t part) {
        for (const auto& [count, values] : observed) counted[part][count].assign(values.size() + 1, 0);
        Eigen::MatrixXd permuted = row_centred;
        for (std::size_t k = part * block; k < std::min((part + 1) * block, static_cast<std::size_t>(permutations)); ++k) {
            Random random(seed, k);
            for (Eigen::Index i = 0; i < n; ++i) {
                const auto& columns = present[static_cast<std::size_t>(i)];
                std::vector<Eigen::Index> order = columns;
                random.shuffle(order);
                for (std::size_t c = 0; c < columns.size(); ++c) permuted(i, columns[c]) = row_centred(i, order[c]);
            }
            for (const Pair& pair : pairs) {
                const Variance v = ratio_variance(permuted, pair);
                const std::vector<double>& values = observed.at(v.count);
                // The first observed variance that is at least as large.
                const auto at = std::lower_bound(values.begin(), values.end(), v.value * (1 - rounding)) - values.begin();
                ++counted[part].at(v.count)[static_cast<std::size_t>(at)];
            }
        }
    });
    std::vector<double> p;
    for (const Variance& v : variances) {
        const std::vector<double>& values = observed.at(v.count);
        const auto at = static_cast<std::size_t>(std::upper_bound(values.begin(), values.end(), v.value) - values.begin());
        double below = 0;
        for (const auto& part : counted)
            for (std::size_t i = 0; i < at; ++i) below += static_cast<double>(part.at(v.count)[i]);
        p.push_back(v.count < 2 ? 1.0
                                : (1 + below) / (1 + static_cast<double>(permutations) * static_cast<double>(values.size())));
    }
    return p;
}

std::optional<double> size_test(const Eigen::MatrixXd& centred, const Pair& pair, const std::vector<int>& groups,
                                int permutations, std::uint64_t seed) {
    const auto group_of = [&](Eigen::Index column) { return groups[static_cast<std::size_t>(column)]; };
    std::map<int, std::vector<Eigen::Index>> other_groups;
    for (Eigen::Index j = 0; j < centred.cols(); ++j)
        if (group_of(j) != group_of(pair.a) && group_of(j) != group_of(pair.b)) other_groups[group_of(j)].push_back(j);
    if (other_groups.size() < 2) return std::nullopt;

    Eigen::MatrixXd columns(centred.rows(), static_cast<Eigen::Index>(other_groups.size()) + 2);
    Eigen::Index rows = 0;
    for (Eigen::Index i = 0; i < centred.rows(); ++i) {
        columns(rows, 0) = centred(i, pair.a);
        columns(rows, 1) = centred(i, pair.b);
        Eigen::Index next = 2;
        int known_groups = 0;
        for (const auto& [group, members] : other_groups) {
            double sum = 0, k = 0;
            for (const Eigen::Index j : members)
                if (is_known(centred(i, j))) sum += centred(i, j), k += 1;
            columns(rows, next++) = k > 0 ? sum / k : unknown_value;
            known_groups += k > 0 ? 1 : 0;
        }
        if (is_known(columns(rows, 0)) && is_known(columns(rows, 1)) && known_groups >= 2) ++rows;
    }
    if (rows < 4) return std::nullopt;
    columns.conservativeResize(rows, Eigen::NoChange);

    // Subtract the mean of each object, then the mean of each column.
    for (Eigen::Index i = 0; i < rows; ++i) {
        double sum = 0, k = 0;
        for (Eigen::Index j = 0; j < columns.cols(); ++j)
            if (is_known(columns(i, j))) sum += columns(i, j), k += 1;
        columns.row(i).array() -= sum / k;
    }
    for (Eigen::Index j = 0; j < columns.cols(); ++j) {
        double sum = 0, k = 0;
        for (Eigen::Index i = 0; i < rows; ++i)
            if (is_known(columns(i, j))) sum += columns(i, j), k += 1;
        if (k > 0) columns.col(j).array() -= sum / k;
    }
    const double observed = residual_correlation(columns) - rounding;
    std::vector<double> chance(static_cast<std::size_t>(permutations));
    parallel_for(chance.size(), 64, [&](std::size_t k) {
        Random random(seed, k);
        Eigen::MatrixXd shuffled = columns;
        for (Eigen::Index j = 0; j < columns.cols(); ++j) {
            std::vector<double> values;
            for (Eigen::Index i = 0; i < rows; ++i)
                if (is_known(columns(i, j))) values.push_back(columns(i, j));
            random.shuffle(values);
            std::size_t next = 0;
            for (Eigen::Index i = 0; i < rows; ++i)
                if (is_known(columns(i, j))) shuffled(i, j) = values[next++];
        }
        chance[k] = residual_correlation(shuffled);
    });
    return permutation_p_value(observed, chance);
}

std::optional<std::vector<double>> own_deviations(const Eigen::MatrixXd& centred) {
    const Eigen::Index m = centred.cols();
    if (m < 3) return std::nullopt;
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(m);
    for (Eigen::Index j = 0; j < m; ++j)
        for (Eigen::Index l = 0; l < j; ++l) {
            const Variance v = ratio_variance(centred, {j, l});
            if (v.count < 2) return std::nullopt;
            sums[j] += v.value;
            sums[l] += v.value;
        }
    // Friedman and Alm 2012, equation 6: var(log x_j / x_l) = psi_j + psi_l for independent deviations.
    std::vector<double> result;
    for (const double sum : sums)
        result.push_back(
            std::sqrt(std::max(0.0, (sum - sums.sum() / (2 * static_cast<double>(m - 1))) / static_cast<double>(m - 2))));
    return result;
}

}  // namespace ostraka::proportions

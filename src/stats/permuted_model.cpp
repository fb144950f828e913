#include "ostraka/stats/permuted_model.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/inference.h"
#include "ostraka/stats/random.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace ostraka {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double dependent = 1e-7;  ///< a column whose remainder is below this share of its length depends on earlier columns

constexpr const char *residuals_name = "residuals", *total_name = "total";

std::vector<std::string> split_at(const std::string& text, char separator) {
    std::vector<std::string> parts{""};
    for (const char c : text) {
        if (c == separator) parts.emplace_back();
        else parts.back() += c;
    }
    for (std::string& part : parts) part = std::string(trimmed(part));
    return parts;
}

/// Columns of a variable: the number, or the sum-to-zero contrasts of the factor.
MatrixXd coding(const ModelVariable& variable) {
    if (!variable.factor)
        return Eigen::Map<const VectorXd>(variable.values.data(), static_cast<Eigen::Index>(variable.values.size()));
    const std::set<std::string> levels(variable.labels.begin(), variable.labels.end());
    const std::vector<std::string> ordered(levels.begin(), levels.end());
    const auto last = static_cast<Eigen::Index>(ordered.size()) - 1;
    MatrixXd columns = MatrixXd::Zero(static_cast<Eigen::Index>(variable.labels.size()), std::max<Eigen::Index>(0, last));
    for (Eigen::Index i = 0; i < columns.rows(); ++i) {
        const auto level = std::lower_bound(ordered.begin(), ordered.end(), variable.labels[static_cast<std::size_t>(i)]);
        const Eigen::Index place = level - ordered.begin();
        if (place == last) columns.row(i).setConstant(-1);
        else columns(i, place) = 1;
    }
    return columns;
}

/// Columns of a term: products of the columns of its variables, centred numbers, so that interactions are well conditioned.
MatrixXd columns_of(const ModelTerm& term, const std::vector<ModelVariable>& variables) {
    MatrixXd product;
    for (const std::size_t v : term.variables) {
        MatrixXd factor = coding(variables[v]);
        if (!variables[v].factor) factor.rowwise() -= factor.colwise().mean().eval();
        if (product.cols() == 0) {
            product = factor;
            continue;
        }
        MatrixXd next(product.rows(), product.cols() * factor.cols());
        for (Eigen::Index a = 0; a < product.cols(); ++a)
            for (Eigen::Index b = 0; b < factor.cols(); ++b)
                next.col(a * factor.cols() + b) = product.col(a).cwiseProduct(factor.col(b));
        product = next;
    }
    return product;
}

/// Orthonormal columns that span what columns add to a basis (Gram-Schmidt, twice).
MatrixXd added_basis(const MatrixXd& basis, const MatrixXd& columns) {
    MatrixXd all(basis.rows(), basis.cols() + columns.cols());
    all.leftCols(basis.cols()) = basis;
    Eigen::Index count = basis.cols();
    for (Eigen::Index c = 0; c < columns.cols(); ++c) {
        VectorXd column = columns.col(c);
        const double length = column.norm();
        if (!(length > 0)) continue;
        for (int pass = 0; pass < 2; ++pass) column -= all.leftCols(count) * (all.leftCols(count).transpose() * column).eval();
        const double rest = column.norm();
        if (rest > dependent * length) all.col(count++) = column / rest;
    }
    return all.middleCols(basis.cols(), count - basis.cols());
}

MatrixXd joined_columns(const MatrixXd& a, const MatrixXd& b) {
    MatrixXd result(a.rows(), a.cols() + b.cols());
    result.leftCols(a.cols()) = a;
    result.rightCols(b.cols()) = b;
    return result;
}

MatrixXd intercept(Eigen::Index samples) { return MatrixXd::Constant(samples, 1, 1 / std::sqrt(static_cast<double>(samples))); }

MatrixXd basis_of(const std::vector<ModelTerm>& terms, const std::vector<ModelVariable>& variables, Eigen::Index samples) {
    MatrixXd basis = intercept(samples);
    for (const ModelTerm& term : terms) basis = joined_columns(basis, added_basis(basis, columns_of(term, variables)));
    return basis;
}

/// Whether all variables of a are variables of b.
bool is_contained(const ModelTerm& a, const ModelTerm& b) {
    return std::includes(b.variables.begin(), b.variables.end(), a.variables.begin(), a.variables.end());
}

/// The terms of the reduced model of term j.
std::vector<ModelTerm> reduced_terms(const std::vector<ModelTerm>& terms, std::size_t j, SumsOfSquares type) {
    std::vector<ModelTerm> reduced;
    for (std::size_t i = 0; i < terms.size(); ++i) {
        if (i == j || (type == SumsOfSquares::sequential && i > j)) continue;
        if (type == SumsOfSquares::hierarchical && is_contained(terms[j], terms[i])) continue;
        reduced.push_back(terms[i]);
    }
    return reduced;
}

/// Rows in fewer columns with the same distances.
MatrixXd reduced_columns(const MatrixXd& Y) {
    const MatrixXd centred = Y.rowwise() - Y.colwise().mean();
    if (centred.cols() <= centred.rows()) return centred;
    const SymmetricEigenX eigen(centred * centred.transpose());
    return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

void check(const MatrixXd& Y, const std::vector<ModelVariable>& variables) {
    if (Y.rows() < 2) fail_input("model", fmt::format("has {} samples", Y.rows()), "give at least two");
    if (!Y.allFinite()) fail_input("model", "a value is not a finite number", "leave that sample out");
    for (const ModelVariable& variable : variables) {
        const std::size_t count = variable.factor ? variable.labels.size() : variable.values.size();
        if (count != static_cast<std::size_t>(Y.rows()))
            fail_input("model", fmt::format("'{}' has {} values for {} samples", variable.name, count, Y.rows()),
                       "give one value for each sample");
        if (!variable.factor &&
            !std::all_of(variable.values.begin(), variable.values.end(), [](double x) { return std::isfinite(x); }))
            fail_input("model", fmt::format("a value of '{}' is not a finite number", variable.name), "leave that sample out");
    }
}

/// The analysis of one model.
class ModelAnalysis {
public:
    ModelAnalysis(const MatrixXd& Y, const std::vector<ModelVariable>& variables, const std::vector<ModelTerm>& terms,
                  const PermutationOptions& options, const std::map<std::string, std::string>& errors)
        : terms_(terms), options_(options), y_(reduced_columns(Y)) {
        const Eigen::Index n = Y.rows();
        full_ = basis_of(terms, variables, n);
        for (std::size_t j = 0; j < terms.size(); ++j) {
            reduced_.push_back(basis_of(reduced_terms(terms, j, options.type), variables, n));
            added_.push_back(added_basis(reduced_.back(), columns_of(terms[j], variables)));
        }
        freedom_ = n - full_.cols();
        for (const ModelTerm& term : terms) {
            const auto named = errors.find(term.name);
            const bool by_residuals = named == errors.end() || named->second == residuals_name;
            const auto other = by_residuals ? terms.end() : std::find_if(terms.begin(), terms.end(), [&](const ModelTerm& t) {
                return t.name == named->second;
            });
            if (!by_residuals && other == terms.end())
                fail_usage(fmt::format("the error term '{}' of '{}' is not in the model", named->second, term.name),
                           "use one of: " + joined(terms, ", ", &ModelTerm::name));
            error_.push_back(by_residuals ? terms.size() : static_cast<std::size_t>(other - terms.begin()));
        }
    }

    Anova run() {
        Anova result;
        const double total = y_.squaredNorm();
        for (std::size_t j = 0; j < terms_.size(); ++j) {
            AnovaRow row{terms_[j].name, static_cast<int>(added_[j].cols()), squares(j, y_), {}, 0, {}, {}, {}, {}};
            if (row.degrees_of_freedom == 0)
                result.notes.push_back(
                    fmt::format("'{}' is confounded with other terms: it has no degrees of freedom", row.term));
            result.rows.push_back(std::move(row));
        }
        const double rest = std::max(0.0, total - (full_.transpose() * y_).squaredNorm());
        result.rows.push_back({residuals_name, static_cast<int>(freedom_), rest, {}, 0, {}, {}, {}, {}});
        result.rows.push_back({total_name, static_cast<int>(y_.rows()) - 1, total, {}, 0, {}, {}, {}, {}});
        for (AnovaRow& row : result.rows) {
            if (row.degrees_of_freedom > 0 && row.term != total_name)
                row.mean_square = row.sum_of_squares / row.degrees_of_freedom;
            row.r_squared = total > 0 ? row.sum_of_squares / total : 0;
        }
        for (std::size_t j = 0; j < terms_.size(); ++j) test(j, total, result);
        return result;
    }

private:
    [[nodiscard]] double squares(std::size_t term, const MatrixXd& y) const {
        return (added_[term].transpose() * y).squaredNorm();
    }

    /// F of term j for the data y.
    [[nodiscard]] double ratio(std::size_t j, const MatrixXd& y) const {
        const double above = squares(j, y) / static_cast<double>(added_[j].cols());
        if (error_[j] < terms_.size()) return above / (squares(error_[j], y) / static_cast<double>(added_[error_[j]].cols()));
        const double below = std::max(0.0, y.squaredNorm() - (full_.transpose() * y).squaredNorm());
        return above / (below / static_cast<double>(freedom_));
    }

    void test(std::size_t j, double total, Anova& result) const {
        AnovaRow& row = result.rows[j];
        const bool by_term = error_[j] < terms_.size();
        const AnovaRow& error = result.rows[by_term ? error_[j] : terms_.size()];
        if (row.degrees_of_freedom == 0 || error.degrees_of_freedom == 0 || error_[j] == j ||
            !(error.sum_of_squares > 1e-20 * total)) {
            if (row.degrees_of_freedom > 0)
                result.notes.push_back(
                    fmt::format("'{}' is not tested: {} left for its error", row.term,
                                error.degrees_of_freedom == 0 ? "no degrees of freedom are" : "no variation is"));
            return;
        }
        row.error = error.term;
        row.f = *row.mean_square / *error.mean_square;
        if (options_.permutations == 0) return;
        const MatrixXd fitted = reduced_[j] * (reduced_[j].transpose() * y_);
        const MatrixXd rest = y_ - fitted;
        std::vector<double> chance(static_cast<std::size_t>(options_.permutations));
        parallel_for(chance.size(), 8, [&](std::size_t i) {
            const std::vector<std::size_t> order = Random(options_.seed, i).permutation(static_cast<std::size_t>(y_.rows()));
            MatrixXd y = fitted;
            for (Eigen::Index r = 0; r < y.rows(); ++r)
                y.row(r) += rest.row(static_cast<Eigen::Index>(order[static_cast<std::size_t>(r)]));
            chance[i] = ratio(j, y);
        });
        // Orders that only differ by rounding count as equal.
        row.p = permutation_p_value(*row.f * (1 - 1e-10), chance);
        std::vector<double> logs{std::log(*row.f)};
        for (const double f : chance) logs.push_back(std::log(std::max(f, std::numeric_limits<double>::min())));
        double mean = 0, variance = 0;
        for (const double x : logs) mean += x / static_cast<double>(logs.size());
        for (const double x : logs) variance += (x - mean) * (x - mean) / static_cast<double>(logs.size());
        if (variance > 0) row.z = (logs.front() - mean) / std::sqrt(variance);
    }

    const std::vector<ModelTerm>& terms_;
    const PermutationOptions& options_;
    MatrixXd y_, full_;
    std::vector<MatrixXd> reduced_, added_;
    std::vector<std::size_t> error_;  ///< for each term, the index of its error term; number of terms: residuals
    Eigen::Index freedom_ = 0;        ///< degrees of freedom of the residuals
};

}  // namespace

std::vector<std::string> names_in_model(const std::string& text) {
    std::vector<std::string> names;
    for (const std::string& part : split_at(text, '+'))
        for (const std::string& factor : split_at(part, '*'))
            for (const std::string& name : split_at(factor, ':'))
                if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    return names;
}

std::vector<ModelTerm> parse_model(const std::string& text, const std::vector<ModelVariable>& variables) {
    std::vector<std::string> names;
    for (const ModelVariable& variable : variables) names.push_back(variable.name);
    const auto index_of = [&](const std::string& name) {
        const auto place = std::find(names.begin(), names.end(), name);
        if (place == names.end())
            fail_usage(fmt::format("the model names '{}', which is not a variable", printable(name, 60)),
                       names.empty() ? "give a table of variables" : "use one of: " + joined(names));
        return static_cast<std::size_t>(place - names.begin());
    };
    std::vector<std::vector<std::size_t>> sets;
    const auto add = [&](std::vector<std::size_t> set) {
        std::sort(set.begin(), set.end());
        set.erase(std::unique(set.begin(), set.end()), set.end());
        if (std::find(sets.begin(), sets.end(), set) == sets.end()) sets.push_back(std::move(set));
    };
    for (const std::string& part : split_at(text, '+')) {
        const std::vector<std::string> factors = split_at(part, '*');
        std::vector<std::vector<std::size_t>> crossed;
        for (const std::string& factor : factors) {
            std::vector<std::size_t> set;
            for (const std::string& name : split_at(factor, ':')) set.push_back(index_of(name));
            crossed.push_back(std::move(set));
        }
        if (crossed.size() > 8) fail_usage("the model crosses more than eight variables", "use fewer");
        for (std::size_t bits = 1; bits < (std::size_t{1} << crossed.size()); ++bits) {
            std::vector<std::size_t> set;
            for (std::size_t k = 0; k < crossed.size(); ++k)
                if ((bits >> k & 1U) != 0) set.insert(set.end(), crossed[k].begin(), crossed[k].end());
            add(std::move(set));
        }
    }
    std::stable_sort(sets.begin(), sets.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
    std::vector<ModelTerm> terms;
    for (const auto& set : sets) {
        std::vector<std::string> words;
        for (const std::size_t v : set) words.push_back(names[v]);
        terms.push_back({joined(words, ":"), set});
    }
    return terms;
}

const AnovaRow& Anova::row(const std::string& term) const {
    for (const AnovaRow& candidate : rows)
        if (candidate.term == term) return candidate;
    throw std::logic_error("no term " + term);
}

Anova permuted_anova(const MatrixXd& Y, const std::vector<ModelVariable>& variables, const std::vector<ModelTerm>& terms,
                     const PermutationOptions& options, const std::map<std::string, std::string>& errors) {
    check_options(options, "permutation test");
    check(Y, variables);
    return ModelAnalysis(Y, variables, terms, options, errors).run();
}

MatrixXd fitted_values(const MatrixXd& Y, const std::vector<ModelVariable>& variables, const std::vector<ModelTerm>& terms) {
    check(Y, variables);
    const MatrixXd basis = basis_of(terms, variables, Y.rows());
    return basis * (basis.transpose() * Y);
}

std::optional<Repeatability> repeatability(const MatrixXd& Y, const std::vector<std::string>& individuals) {
    const std::vector<ModelVariable> variables{{"individual", true, individuals, {}}};
    check(Y, variables);
    std::map<std::string, double> counts;
    for (const std::string& individual : individuals) counts[individual] += 1;
    const auto n = static_cast<double>(individuals.size()), groups = static_cast<double>(counts.size());
    if (counts.size() < 2 || counts.size() == individuals.size()) return {};
    PermutationOptions no_tests;
    no_tests.permutations = 0;
    const Anova anova = permuted_anova(Y, variables, {{"individual", {0}}}, no_tests);
    const double among = *anova.rows[0].mean_square, within = *anova.rows[1].mean_square;
    double squares = 0;
    for (const auto& [individual, count] : counts) squares += count * count;
    Repeatability result;
    result.individuals = static_cast<int>(counts.size());
    result.repeats = (n - squares / n) / (groups - 1);
    const double variance = std::max(0.0, (among - within) / result.repeats);
    result.repeatability = variance + within > 0 ? variance / (variance + within) : 1;
    result.error_share = 1 - result.repeatability;
    return result;
}

void PermutationOptions::declare_options(OptionList& list) {
    list("sums-of-squares", type,
         "each term after the terms before it (sequential, type I), after all terms that do not contain it (hierarchical, type "
         "II), or after all others (marginal, type III)",
         Choices{"sequential", "hierarchical", "marginal"});
    list("permutations", permutations, "number of permutations of each test; 0: no tests", Range{0, 1e6});
    list("seed", seed, "random seed", Range{0, 1e18});
}

}  // namespace ostraka

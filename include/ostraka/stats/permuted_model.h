// Analysis of variance of multivariate data by distances, with permutation tests: linear models of factors and numbers (Goodall
// 1991; Anderson 2001; Collyer, Sekora and Adams 2015).
#pragma once

#include "ostraka/core/options.h"

#include <Eigen/Core>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// An independent variable of a model.
struct ModelVariable {
    std::string name;                 ///< name of the variable
    bool factor = true;               ///< true: `labels` are levels of a factor; false: `values` are numbers
    std::vector<std::string> labels;  ///< level of each sample
    std::vector<double> values;       ///< value of each sample
};

/// A term of a model: a variable, or the interaction of several.
struct ModelTerm {
    std::string name;                    ///< "species", "species:site"
    std::vector<std::size_t> variables;  ///< indices of the variables, ascending
};

/// Reads a model such as "log(size) + species * site": terms are joined by +; a:b is an interaction, a*b stands for a + b + a:b.
/// Main effects come before interactions, otherwise the order is kept. Throws Error (usage)
/// for an unknown variable name; the message lists all variables.
std::vector<ModelTerm> parse_model(const std::string& text, const std::vector<ModelVariable>& variables);

/// The names that a model uses, in the order of the text.
std::vector<std::string> names_in_model(const std::string& text);

/// How the sum of squares of a term is defined.
enum class SumsOfSquares {
    sequential,    ///< type I: each term after the terms before it
    hierarchical,  ///< type II: each term after all terms that do not contain it
    marginal       ///< type III: each term after all other terms
};

struct PermutationOptions {
    SumsOfSquares type = SumsOfSquares::sequential;
    int permutations = 999;                  ///< number of permutations; 0: no tests
    std::uint64_t seed = 1;                  ///< random seed
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A row of an analysis of variance.
struct AnovaRow {
    std::string term;                   ///< name of the term; "residuals" and "total" at the end
    int degrees_of_freedom = 0;         ///< degrees of freedom, of samples; not multiplied by the number of coordinates
    double sum_of_squares = 0;          ///< sum of squared distances
    std::optional<double> mean_square;  ///< sum_of_squares / degrees_of_freedom
    double r_squared = 0;               ///< sum_of_squares / sum of squares of the total
    std::optional<double> f;            ///< mean square divided by the mean square of the error term
    std::optional<double> z, p;         ///< effect size and p-value of the permutation test of F
    std::string error = {};             ///< name of the error term of F; empty: no F
};

/// An analysis of variance: one row for each term, then residuals and total.
struct Anova {
    std::vector<AnovaRow> rows;
    std::vector<std::string> notes;  ///< messages about terms that are confounded with others, or not tested
    [[nodiscard]] const AnovaRow& row(const std::string& term) const;  ///< throws std::logic_error if there is none
};

/// Analysis of variance of the rows of Y. Squares are summed over all columns, so that they are squared distances. F is tested by
/// residual randomisation: the residuals of the model without the term (by `type`) are permuted among the samples and added to
/// its fitted values; p counts the observed order as one permutation, z is the standard deviate of log F among the permutations.
/// Permutation i of a seed is the same for all terms. `errors`: for a term, the name of the term by whose mean square it is
/// divided; residuals if not given. Factors are coded by sum-to-zero contrasts; columns that depend on earlier ones are dropped.
/// Throws Error (input) unless there is one value of each variable for each row, at least two rows, all finite.
Anova permuted_anova(const Eigen::MatrixXd& Y, const std::vector<ModelVariable>& variables, const std::vector<ModelTerm>& terms,
                     const PermutationOptions& options = {}, const std::map<std::string, std::string>& errors = {});

/// The fitted values of the model with these terms and an intercept: the projection of Y.
Eigen::MatrixXd fitted_values(const Eigen::MatrixXd& Y, const std::vector<ModelVariable>& variables,
                              const std::vector<ModelTerm>& terms);

/// Agreement of repeated measurements of the same individuals.
struct Repeatability {
    double repeatability = 0;  ///< intraclass correlation: variance among individuals / (among + within individuals)
    double error_share = 0;    ///< 1 - repeatability
    double repeats = 0;        ///< mean number of measurements of an individual, corrected for unequal numbers
    int individuals = 0;       ///< number of individuals
};
/// Repeatability of the rows of Y, which belong to these individuals (Lessells and Boag 1987; Fruciano 2016). None if no
/// individual was measured twice, or if there is one individual.
std::optional<Repeatability> repeatability(const Eigen::MatrixXd& Y, const std::vector<std::string>& individuals);

}  // namespace ostraka

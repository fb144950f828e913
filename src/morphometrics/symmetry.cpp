#include "ostraka/morphometrics/symmetry.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace ostraka {

namespace {

constexpr const char *individual_term = "individual", *side_term = "side", *interaction_term = "individual:side";

/// Observations of an analysis: specimens, and for object symmetry their mirrors.
struct Observations {
    std::vector<Landmarks> configurations;
    std::vector<std::string> individuals, sides;
    std::vector<bool> second;  ///< true: second side
};

Observations observations_of(const ShapeSample& sample, const SymmetryDesign& design) {
    Observations result;
    const bool matching = !design.sides.empty();
    const std::set<std::string> sides(design.sides.begin(), design.sides.end());
    if (matching && sides.size() != 2)
        fail_input("sides", fmt::format("there are {} sides", sides.size()), "give two, such as left and right");
    if (!matching && design.pairs.pairs.empty())
        fail_input("pairs", "there are no pairs of landmarks", "give the landmarks that correspond on both sides");
    for (std::size_t s = 0; s < sample.specimens.size(); ++s) {
        const Landmarks& x = sample.configurations[s];
        if (!is_complete(x)) fail_input(sample.specimens[s], "lacks landmarks", "estimate missing landmarks first");
        const bool second = matching && design.sides[s] == *sides.rbegin();
        result.configurations.push_back(second ? relabelled_mirror(x, {}) : x);
        result.individuals.push_back(design.individuals[s]);
        result.sides.push_back(matching ? design.sides[s] : "1 as recorded");
        result.second.push_back(second);
    }
    if (!matching)
        for (std::size_t s = 0; s < sample.specimens.size(); ++s) {
            result.configurations.push_back(relabelled_mirror(sample.configurations[s], design.pairs));
            result.individuals.push_back(design.individuals[s]);
            result.sides.emplace_back("2 mirrored");
            result.second.push_back(true);
        }
    return result;
}

/// Mean of the aligned observations of one side of an individual.
struct SideMean {
    Landmarks sum;
    double count = 0;
    [[nodiscard]] Landmarks mean() const { return sum / count; }
};

void add_components(const Observations& observations, const GeneralisedProcrustes& aligned, SymmetryAnalysis& result) {
    std::map<std::string, std::array<SideMean, 2>> sides;
    for (std::size_t i = 0; i < observations.configurations.size(); ++i) {
        const std::string& name = observations.individuals[i];
        if (!sides.contains(name)) result.individuals.push_back(name);
        SideMean& side = sides[name].at(observations.second[i] ? 1 : 0);
        if (side.count == 0) side.sum = Landmarks::Zero(aligned.mean.rows(), 3);
        side.sum += aligned.aligned[i];
        side.count += 1;
    }
    if (result.individuals.size() < 2) fail_input("individuals", "there is one individual", "give at least two");
    std::vector<Landmarks> differences;
    Landmarks grand = Landmarks::Zero(aligned.mean.rows(), 3), directional = grand;
    const auto count = static_cast<double>(result.individuals.size());
    for (const std::string& name : result.individuals) {
        const auto& [first, second] = sides.at(name);
        if (first.count == 0 || second.count == 0)
            fail_input(name, "has one side alone", "give both sides of each individual, or leave it out");
        result.symmetric.push_back((first.mean() + second.mean()) / 2);
        differences.push_back((first.mean() - second.mean()) / 2);
        grand += result.symmetric.back() / count;
        directional += differences.back() / count;
    }
    result.mean = grand;
    result.directional = grand + directional;
    double symmetric = 0, asymmetric = 0;
    for (std::size_t i = 0; i < differences.size(); ++i) {
        result.asymmetric.push_back(grand + differences[i]);
        result.asymmetry.push_back(differences[i].norm());
        result.fluctuating.push_back((differences[i] - directional).norm());
        symmetric += (result.symmetric[i] - grand).squaredNorm();
        asymmetric += differences[i].squaredNorm();
    }
    result.symmetric_share = symmetric + asymmetric > 0 ? symmetric / (symmetric + asymmetric) : 1;
}

}  // namespace

SymmetryAnalysis symmetry_analysis(const ShapeSample& sample, const SymmetryDesign& design, const PermutationOptions& options) {
    if (design.individuals.size() != sample.specimens.size() ||
        (!design.sides.empty() && design.sides.size() != sample.specimens.size()))
        fail_usage("a symmetry analysis needs the individual (and the side) of each specimen");
    const Observations observations = observations_of(sample, design);
    const GeneralisedProcrustes aligned = generalised_procrustes(observations.configurations, sample.procrustes_options());
    SymmetryAnalysis result;
    add_components(observations, aligned, result);
    const std::vector<ModelVariable> variables{{individual_term, true, observations.individuals, {}},
                                               {side_term, true, observations.sides, {}}};
    const std::vector<ModelTerm> terms{{individual_term, {0}}, {side_term, {1}}, {interaction_term, {0, 1}}};
    const std::map<std::string, std::string> errors{{individual_term, interaction_term}, {side_term, interaction_term}};
    const Eigen::MatrixXd shapes = shape_rows(aligned.aligned);
    const std::set<std::string> distinct(design.individuals.begin(), design.individuals.end());
    const bool replicates = observations.configurations.size() > 2 * distinct.size();
    const auto analyse = [&](const Eigen::MatrixXd& y) {
        // Without replicates, individual:side is what remains.
        if (replicates) return permuted_anova(y, variables, terms, options, errors);
        Anova anova = permuted_anova(y, variables, {terms[0], terms[1]}, options);
        for (AnovaRow& row : anova.rows) {
            if (row.term == "residuals") row.term = interaction_term;
            if (row.error == "residuals") row.error = interaction_term;
        }
        return anova;
    };
    result.shape = analyse(shapes);
    if (!replicates)
        result.notes.emplace_back("without replicates, fluctuating asymmetry cannot be distinguished from measurement error");
    if (!design.sides.empty()) {
        Eigen::MatrixXd sizes(shapes.rows(), 1);
        for (Eigen::Index i = 0; i < sizes.rows(); ++i)
            sizes(i, 0) = std::log(aligned.centroid_sizes[static_cast<std::size_t>(i)]);
        result.size = analyse(sizes);
    }
    if (replicates) {
        // Replicates of one side of one individual.
        std::vector<std::string> cells;
        for (std::size_t i = 0; i < observations.individuals.size(); ++i)
            cells.push_back(observations.individuals[i] + "\n" + observations.sides[i]);
        result.replicate = repeatability(shapes, cells);
    }
    return result;
}

}  // namespace ostraka

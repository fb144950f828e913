// Analyses of variance against published tables of R, laws of permutation tests.
#include "ostraka/stats/permuted_model.h"

#include "ostraka/core/error.h"
#include "ostraka/stats/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

Eigen::MatrixXd column(const std::vector<double>& values) {
    return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

ModelVariable factor(const std::string& name, const std::vector<std::string>& labels) { return {name, true, labels, {}}; }

TEST(PermutedModel, OneWayAnalysisOfPlantGrowth) {
    // Dobson (1983), data set PlantGrowth of R: F = 4.846 on 2 and 27 degrees of freedom, sums of squares 3.766 and 10.492.
    const std::vector<double> weights{4.17, 5.58, 5.18, 6.11, 4.50, 4.61, 5.17, 4.53, 5.33, 5.14, 4.81, 4.17, 4.41, 3.59, 5.87,
                                      3.83, 6.03, 4.89, 4.32, 4.69, 6.31, 5.12, 5.54, 5.50, 5.37, 5.29, 4.92, 6.15, 5.80, 5.26};
    std::vector<std::string> groups;
    for (const char* group : {"ctrl", "trt1", "trt2"}) groups.insert(groups.end(), 10, group);
    const std::vector<ModelVariable> variables{factor("group", groups)};
    const Anova anova = permuted_anova(column(weights), variables, parse_model("group", variables));
    EXPECT_EQ(anova.row("group").degrees_of_freedom, 2);
    EXPECT_EQ(anova.row("residuals").degrees_of_freedom, 27);
    EXPECT_NEAR(anova.row("group").sum_of_squares, 3.76634, 5e-6);
    EXPECT_NEAR(anova.row("residuals").sum_of_squares, 10.49209, 5e-6);
    EXPECT_NEAR(*anova.row("group").f, 4.8461, 5e-5);
    EXPECT_NEAR(*anova.row("group").p, 0.0159, 0.01);
    EXPECT_EQ(anova.row("group").error, "residuals");
}

TEST(PermutedModel, TwoWayAnalysisOfWarpBreaks) {
    // Tippett (1950), data set warpbreaks of R: sums of squares 450.7, 2034.3, 1002.8 and 5745.4.
    const std::vector<double> breaks{26, 30, 54, 25, 70, 52, 51, 26, 67, 18, 21, 29, 17, 12, 18, 35, 30, 36,
                                     36, 21, 24, 18, 10, 43, 28, 15, 26, 27, 14, 29, 19, 29, 31, 41, 20, 44,
                                     42, 26, 19, 16, 39, 28, 21, 39, 29, 20, 21, 24, 17, 13, 15, 15, 16, 28};
    std::vector<std::string> wool, tension;
    for (const char* w : {"A", "B"})
        for (const char* t : {"L", "M", "H"}) wool.insert(wool.end(), 9, w), tension.insert(tension.end(), 9, t);
    const std::vector<ModelVariable> variables{factor("wool", wool), factor("tension", tension)};
    PermutationOptions options;
    options.permutations = 0;
    for (const auto type : {SumsOfSquares::sequential, SumsOfSquares::hierarchical, SumsOfSquares::marginal}) {
        options.type = type;
        const Anova anova = permuted_anova(column(breaks), variables, parse_model("wool * tension", variables), options);
        EXPECT_NEAR(anova.row("wool").sum_of_squares, 450.67, 0.005) << "balanced: all types agree";
        EXPECT_NEAR(anova.row("tension").sum_of_squares, 2034.26, 0.005);
        EXPECT_NEAR(anova.row("wool:tension").sum_of_squares, 1002.78, 0.005);
        EXPECT_NEAR(anova.row("residuals").sum_of_squares, 5745.11, 0.005);
        EXPECT_NEAR(*anova.row("tension").f, 8.498, 0.0005);
        EXPECT_FALSE(anova.row("tension").p);
    }
    const Anova nested =
        permuted_anova(column(breaks), variables, parse_model("wool * tension", variables), options, {{"wool", "wool:tension"}});
    EXPECT_NEAR(*nested.row("wool").f, 450.6667 / (1002.7778 / 2), 1e-4);
    EXPECT_EQ(nested.row("wool").error, "wool:tension");
    EXPECT_THROW(permuted_anova(column(breaks), variables, parse_model("wool", variables), options, {{"wool", "colour"}}), Error);
}

TEST(PermutedModel, UnbalancedTypesFollowTheirDefinitions) {
    Random random(2);
    std::vector<std::string> a, b;
    std::vector<double> x;
    Eigen::MatrixXd Y(23, 4);
    for (Eigen::Index i = 0; i < 23; ++i) {
        a.emplace_back(i % 3 == 0 ? "p" : "q");
        b.emplace_back(i % 5 < 2 ? "u" : i % 5 == 2 ? "v" : "w");
        x.push_back(random.normal());
        for (Eigen::Index c = 0; c < 4; ++c) Y(i, c) = random.normal() + (a.back() == "p" ? 1 : 0) + x.back();
    }
    const std::vector<ModelVariable> variables{factor("a", a), factor("b", b), {"x", false, {}, x}};
    PermutationOptions options;
    options.permutations = 0;
    const auto analysis = [&](const std::string& model, SumsOfSquares type) {
        options.type = type;
        return permuted_anova(Y, variables, parse_model(model, variables), options);
    };
    const Anova first = analysis("a * b + x", SumsOfSquares::sequential),
                second = analysis("a * b + x", SumsOfSquares::hierarchical),
                third = analysis("a * b + x", SumsOfSquares::marginal);
    EXPECT_NEAR(first.row("a:b").sum_of_squares, third.row("a:b").sum_of_squares, 1e-10) << "the last term";
    EXPECT_NEAR(second.row("b").sum_of_squares, analysis("a + x + b", SumsOfSquares::sequential).row("b").sum_of_squares, 1e-10);
    EXPECT_NEAR(third.row("x").sum_of_squares, second.row("x").sum_of_squares, 1e-10) << "no term contains x";
    double sum = 0;
    for (const char* term : {"a", "b", "x", "a:b", "residuals"}) sum += first.row(term).sum_of_squares;
    EXPECT_NEAR(sum, first.row("total").sum_of_squares, 1e-10);
    const Eigen::MatrixXd fitted = fitted_values(Y, variables, parse_model("a * b + x", variables));
    EXPECT_NEAR((Y - fitted).squaredNorm(), first.row("residuals").sum_of_squares, 1e-10);
    // More coordinates than samples: the same distances, the same sums of squares.
    Eigen::MatrixXd wide = Eigen::MatrixXd::Zero(23, 100);
    wide.leftCols(4) = Y;
    EXPECT_NEAR(permuted_anova(wide, variables, parse_model("a", variables), options).row("a").sum_of_squares,
                analysis("a", options.type).row("a").sum_of_squares, 1e-9);
}

TEST(PermutedModel, ModelsAreReadAndConfoundedTermsNoted) {
    const std::vector<ModelVariable> variables{
        factor("a", {"1", "2", "1", "2"}), factor("b", {"x", "y", "x", "y"}), {"log(size)", false, {}, {1, 2, 3, 5}}};
    const auto names = [&](const std::string& model) {
        std::string text;
        for (const ModelTerm& term : parse_model(model, variables)) text += term.name + " ";
        return text;
    };
    EXPECT_EQ(names("a*b+log(size)"), "a b log(size) a:b ");
    EXPECT_EQ(names(" b : a + a "), "a a:b ");
    EXPECT_EQ(names_in_model("a*b + log(size) + a:c"), (std::vector<std::string>{"a", "b", "log(size)", "c"}));
    EXPECT_THROW(names("c"), Error);
    EXPECT_THROW(names(""), Error);
    const Anova anova = permuted_anova(column({1, 2, 4, 3}), variables, parse_model("a + b", variables));
    EXPECT_EQ(anova.row("b").degrees_of_freedom, 0);
    EXPECT_FALSE(anova.notes.empty());
    EXPECT_THROW(permuted_anova(column({1, 2, 3}), variables, parse_model("a", variables)), Error) << "four labels";
    const Anova same = permuted_anova(column({1, 1, 1, 1}), variables, parse_model("a", variables));
    EXPECT_FALSE(same.row("a").f) << "no variation";
}

TEST(PermutedModel, PValuesAreUniformWithoutAnEffectAndRepeat) {
    std::vector<std::string> groups;
    for (int i = 0; i < 20; ++i) groups.emplace_back(i % 2 == 0 ? "a" : "b");
    const std::vector<ModelVariable> variables{factor("group", groups)};
    PermutationOptions options;
    options.permutations = 99;
    int below = 0;
    for (std::uint64_t trial = 0; trial < 200; ++trial) {
        Random random(7, trial);
        Eigen::MatrixXd Y(20, 3);
        for (double& y : Y.reshaped()) y = random.normal();
        options.seed = trial;
        const double p = *permuted_anova(Y, variables, parse_model("group", variables), options).row("group").p;
        EXPECT_EQ(*permuted_anova(Y, variables, parse_model("group", variables), options).row("group").p, p);
        below += p <= 0.1 ? 1 : 0;
    }
    EXPECT_GE(below, 8);
    EXPECT_LE(below, 34);
}

TEST(PermutedModel, RepeatabilityIsTheIntraclassCorrelation) {
    // Two measurements of three individuals: mean squares 8 among and 1 within, (8 - 1) / (8 + 1).
    const auto result = repeatability(column({-2 - std::sqrt(0.5), -2 + std::sqrt(0.5), -std::sqrt(0.5), std::sqrt(0.5),
                                              2 - std::sqrt(0.5), 2 + std::sqrt(0.5)}),
                                      {"a", "a", "b", "b", "c", "c"});
    ASSERT_TRUE(result);
    EXPECT_NEAR(result->repeats, 2, 1e-12);
    EXPECT_NEAR(result->repeatability, 7.0 / 9, 1e-12);
    EXPECT_FALSE(repeatability(column({1, 2}), {"a", "b"}));
    EXPECT_FALSE(repeatability(column({1, 2}), {"a", "a"}));
}

}  // namespace
}  // namespace ostraka

#include "ostraka/morphometrics/symmetry.h"

#include "ostraka/core/error.h"
#include "ostraka/morphometrics/allometry.h"
#include "samples.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

using test::moved;
using test::random_configuration;

const LandmarkPairs face_pairs{{{0, 1}, {2, 3}, {4, 5}}};

/// A face with three pairs and three landmarks on the midline, symmetric, changed by `change`.
Landmarks face(Random& random, double variation, double directional, double fluctuating) {
    Landmarks x(9, 3);
    x << 1, 2, 0, -1, 2, 0, 3, 1, -2, -3, 1, -2, 2, -2, 1, -2, -2, 1, 0, 0, 2, 0, -3, 1, 0, 5, -1;
    Landmarks change = random_configuration(random, 9, 3, variation);
    change = (change + relabelled_mirror(change, face_pairs)).eval() / 2;
    x += change;
    x(0, 1) += directional;
    Landmarks noise = random_configuration(random, 9, 3, fluctuating);
    return x + (noise - relabelled_mirror(noise, face_pairs)) / 2;
}

ShapeSample faces(double directional, double fluctuating, double error, int repeats, SymmetryDesign& design) {
    Random random(12);
    ShapeSample sample;
    for (int k = 0; k < 9; ++k) sample.landmarks.push_back(std::to_string(k));
    design.pairs = face_pairs;
    for (int s = 0; s < 15; ++s) {
        const Landmarks own = face(random, 0.2, directional, fluctuating);
        for (int r = 0; r < repeats; ++r) {
            sample.specimens.push_back("face " + std::to_string(s) + " " + std::to_string(r));
            design.individuals.push_back("face " + std::to_string(s));
            sample.configurations.push_back(moved(own + random_configuration(random, 9, 3, error), random, 3));
        }
    }
    return sample;
}

TEST(Symmetry, SymmetricObjectsHaveNoAsymmetry) {
    SymmetryDesign design;
    const ShapeSample sample = faces(0, 0, 0, 1, design);
    const SymmetryAnalysis result = symmetry_analysis(sample, design);
    EXPECT_NEAR(result.symmetric_share, 1, 1e-12);
    for (const double asymmetry : result.asymmetry) EXPECT_LT(asymmetry, 1e-8);
    EXPECT_LT(procrustes(relabelled_mirror(result.mean, face_pairs), result.mean).sum_of_squares, 1e-14);
}

TEST(Symmetry, DirectionalAsymmetryAndErrorAreTested) {
    SymmetryDesign plain_design, tilted_design;
    PermutationOptions options;
    options.permutations = 199;
    const ShapeSample plain = faces(0, 0.1, 0.03, 2, plain_design), tilted = faces(0.5, 0.1, 0.03, 2, tilted_design);
    const SymmetryAnalysis none = symmetry_analysis(plain, plain_design, options),
                           some = symmetry_analysis(tilted, tilted_design, options);
    EXPECT_GT(*none.shape.row("side").p, 0.05);
    EXPECT_LE(*some.shape.row("side").p, 0.01);
    EXPECT_LE(*some.shape.row("individual:side").p, 0.01) << "fluctuating asymmetry exceeds the error";
    EXPECT_EQ(some.shape.row("individual").error, "individual:side");
    EXPECT_EQ(some.shape.row("individual").degrees_of_freedom, 14);
    EXPECT_EQ(some.shape.row("side").degrees_of_freedom, 1);
    EXPECT_EQ(some.shape.row("individual:side").degrees_of_freedom, 14);
    EXPECT_EQ(some.shape.row("residuals").degrees_of_freedom, 30);
    double sum = 0;
    for (const char* term : {"individual", "side", "individual:side", "residuals"}) sum += some.shape.row(term).sum_of_squares;
    EXPECT_NEAR(sum, some.shape.row("total").sum_of_squares, 1e-10);
    ASSERT_TRUE(some.replicate);
    EXPECT_GT(some.replicate->repeatability, 0.8);
    // Squares of sides: two observations of each measurement, each half the difference from the mean.
    EXPECT_NEAR(some.shape.row("side").sum_of_squares, 60 * (some.directional - some.mean).squaredNorm(), 1e-10);
}

TEST(Symmetry, MatchingPairsAreCompared) {
    Random random(3);
    ShapeSample sample;
    SymmetryDesign design;
    const Landmarks mean = random_configuration(random, 8, 2), shift = random_configuration(random, 8, 2, 0.05);
    sample.dimension = 2;
    for (int k = 0; k < 8; ++k) sample.landmarks.push_back(std::to_string(k));
    for (int s = 0; s < 12; ++s) {
        const Landmarks own = mean + random_configuration(random, 8, 2, 0.1);
        for (const bool right : {false, true}) {
            Landmarks x = own + random_configuration(random, 8, 2, 0.01) + (right ? shift : Landmarks(-shift));
            if (right) x.col(0) *= -1;
            sample.specimens.push_back(std::to_string(s) + (right ? " right" : " left"));
            sample.configurations.push_back(moved(x, random, 2));
            design.individuals.push_back(std::to_string(s));
            design.sides.emplace_back(right ? "right" : "left");
        }
    }
    PermutationOptions options;
    options.permutations = 99;
    const SymmetryAnalysis result = symmetry_analysis(sample, design, options);
    EXPECT_EQ(result.individuals.size(), 12U);
    EXPECT_LE(*result.shape.row("side").p, 0.02);
    EXPECT_LE(*result.shape.row("individual").p, 0.02);
    EXPECT_FALSE(result.shape.row("individual:side").p) << "no replicates";
    ASSERT_TRUE(result.size);
    EXPECT_FALSE(result.replicate);
    design.sides[3] = "middle";
    EXPECT_THROW(symmetry_analysis(sample, design), Error);
    design.sides.assign(24, "left");
    EXPECT_THROW(symmetry_analysis(sample, design), Error);
    design.sides.clear();
    EXPECT_THROW(symmetry_analysis(sample, design), Error) << "object symmetry without pairs";
}

TEST(Allometry, TheSlopeIsFound) {
    Random random(5);
    const Landmarks mean = random_configuration(random, 10, 3), slope = random_configuration(random, 10, 3, 0.02);
    std::vector<Landmarks> configurations;
    for (int s = 0; s < 25; ++s) {
        const double log_size = random.uniform(-1, 1);
        Landmarks x = mean + log_size * slope;
        x *= std::exp(log_size) / centroid_size(x);
        configurations.push_back(x);
    }
    ProcrustesOptions options;
    options.scaling = true;
    const Allometry result = allometry(generalised_procrustes(configurations, options));
    EXPECT_GT(result.share, 0.999);
    for (std::size_t s = 0; s < configurations.size(); ++s) {
        EXPECT_NEAR(result.log_sizes[s], std::log(centroid_size(configurations[s])), 1e-12);
        EXPECT_NEAR(result.scores[s], result.predicted[s], 0.01 * std::abs(result.predicted[s]) + 1e-3);
    }
    configurations.assign(5, mean);
    EXPECT_THROW(allometry(generalised_procrustes(configurations, options)), Error) << "one size";
}

}  // namespace
}  // namespace ostraka

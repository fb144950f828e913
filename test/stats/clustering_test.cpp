#include "ostraka/stats/clustering.h"

#include "ostraka/core/error.h"
#include "ostraka/stats/embedding.h"
#include "ostraka/stats/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ostraka {
namespace {

Eigen::MatrixXd column(const std::vector<double>& values) {
    return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Eigen::MatrixXd random_samples(int count, int dimensions, std::uint64_t seed) {
    Random random(seed);
    Eigen::MatrixXd samples(count, dimensions);
    for (Eigen::Index i = 0; i < count; ++i)
        for (Eigen::Index j = 0; j < dimensions; ++j) samples(i, j) = random.normal();
    return samples;
}

TEST(Dbscan, ByHand) {
    const Eigen::MatrixXd samples = column({0, 1, 2, 10, 11, 12, 50});
    EXPECT_EQ(dbscan(samples, 1, 2), (std::vector<int>{0, 0, 0, 1, 1, 1, -1}));
    EXPECT_EQ(dbscan(samples, 1, 3), (std::vector<int>{0, 0, 0, 1, 1, 1, -1})) << "ends are reached from the middle";
    EXPECT_EQ(dbscan(samples, 1, 4), std::vector<int>(7, -1));
    EXPECT_EQ(dbscan(samples, 1, 1), (std::vector<int>{0, 0, 0, 1, 1, 1, 2})) << "minimum 1 knows no noise";
    EXPECT_EQ(dbscan(samples, 8, 1), (std::vector<int>{0, 0, 0, 0, 0, 0, 1}));
    EXPECT_EQ(dbscan(samples, 0, 1), (std::vector<int>{0, 1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(dbscan(samples, std::numeric_limits<double>::infinity(), 1), std::vector<int>(7, 0));
}

TEST(Dbscan, ASampleFirstMarkedAsNoiseMayBecomeABorderPoint) {
    // 0 has one neighbour only; 1 has three.
    EXPECT_EQ(dbscan(column({0, 1, 1.5, 2}), 1, 3), (std::vector<int>{0, 0, 0, 0}));
}

TEST(Dbscan, OfARingInsideARing) {
    Eigen::MatrixXd samples(120, 2);
    for (int i = 0; i < 120; ++i) {
        const double angle = 2 * std::numbers::pi * i / 60, r = i < 60 ? 1 : 5;
        samples.row(i) << r * std::cos(angle), r * std::sin(angle);
    }
    const std::vector<int> labels = dbscan(samples, 0.6, 2);
    for (int i = 0; i < 120; ++i) ASSERT_EQ(labels[i], i < 60 ? 0 : 1);
}

TEST(Dbscan, HandlesIdenticalSamplesAndInvalidInput) {
    EXPECT_EQ(dbscan(Eigen::MatrixXd::Constant(4, 3, 2.0), 0, 4), std::vector<int>(4, 0));
    EXPECT_EQ(dbscan(column({1}), 0, 1), std::vector<int>{0});
    EXPECT_THROW(dbscan(Eigen::MatrixXd(0, 1), 1, 1), Error);
    EXPECT_THROW(dbscan(column({1}), -1, 1), Error);
    EXPECT_THROW(dbscan(column({1}), std::nan(""), 1), Error);
    EXPECT_THROW(dbscan(column({1}), 1, 0), Error);
    EXPECT_THROW(dbscan(column({std::nan("")}), 1, 1), Error);
}

TEST(DbscanNeighbourhood, ByHand) {
    // 5 samples on a length of 10: each has 2 of length, so radius 1 holds one sample; in a square, pi r^2 = area / n.
    EXPECT_NEAR(volume_epsilon(column({0, 1, 2, 3, 10}), 1), 1, 1e-12);
    Eigen::MatrixXd square(4, 3);
    square << 0, 0, 7, 2, 0, 7, 0, 2, 7, 2, 2, 7;
    EXPECT_NEAR(volume_epsilon(square, 1), 1 / std::sqrt(std::numbers::pi), 1e-12) << "the flat third column does not count";
    EXPECT_EQ(volume_epsilon(column({4, 4}), 1), 0);
}

TEST(Linkage, ByHand) {
    // 0 and 1 at 1; 5 and 7 at 2; the pairs at the mean of 5, 7, 4, 6.
    const Linkage tree = linkage(distance_matrix(column({0, 5, 1, 7})));
    ASSERT_EQ(tree.merges.size(), 3u);
    EXPECT_EQ(tree.merges[0].first, 0);
    EXPECT_EQ(tree.merges[0].second, 2);
    EXPECT_EQ(tree.merges[0].height, 1);
    EXPECT_EQ(tree.merges[1].first, 1);
    EXPECT_EQ(tree.merges[1].second, 3);
    EXPECT_EQ(tree.merges[1].height, 2);
    EXPECT_EQ(tree.merges[2].first, 4);
    EXPECT_EQ(tree.merges[2].second, 5);
    EXPECT_DOUBLE_EQ(tree.merges[2].height, 5.5);
    EXPECT_EQ(tree.merges[2].size, 4);
    EXPECT_EQ(linkage(distance_matrix(column({0, 5, 1, 7})), LinkageMethod::single).merges[2].height, 4);
    EXPECT_EQ(linkage(distance_matrix(column({0, 5, 1, 7})), LinkageMethod::complete).merges[2].height, 7);
    EXPECT_EQ(cut_at(tree, 0.5), (std::vector<int>{0, 1, 2, 3}));
    EXPECT_EQ(cut_at(tree, 2), (std::vector<int>{0, 1, 0, 1}));
    EXPECT_EQ(leaf_order(tree), (std::vector<int>{0, 2, 1, 3}));
}

/// The textbook algorithm: joins the two clusters with the smallest mean distance between their samples.
std::vector<double> slow_heights(const Eigen::MatrixXd& distances) {
    std::vector<std::vector<int>> clusters;
    for (int i = 0; i < distances.rows(); ++i) clusters.push_back({i});
    std::vector<double> heights;
    while (clusters.size() > 1) {
        double minimum = std::numeric_limits<double>::infinity();
        std::size_t a = 0, b = 0;
        for (std::size_t i = 0; i < clusters.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                double sum = 0;
                for (const int x : clusters[i])
                    for (const int y : clusters[j]) sum += distances(x, y);
                if (const double mean = sum / static_cast<double>(clusters[i].size() * clusters[j].size()); mean < minimum)
                    minimum = mean, a = j, b = i;
            }
        heights.push_back(minimum);
        clusters[a].insert(clusters[a].end(), clusters[b].begin(), clusters[b].end());
        clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(b));
    }
    return heights;
}

TEST(Linkage, AgreesWithItsDefinition) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const Eigen::MatrixXd distances = distance_matrix(random_samples(25, 3, seed));
        const std::vector<double> heights = slow_heights(distances);
        const Linkage tree = linkage(distances);
        ASSERT_EQ(tree.merges.size(), heights.size());
        for (std::size_t i = 0; i < heights.size(); ++i) EXPECT_NEAR(tree.merges[i].height, heights[i], 1e-12);
        std::vector<int> leaves = leaf_order(tree);
        std::sort(leaves.begin(), leaves.end());
        for (int i = 0; i < 25; ++i) EXPECT_EQ(leaves[static_cast<std::size_t>(i)], i);
    }
}

TEST(Linkage, SingleLinkageCutIsDbscanWithMinimumOne) {
    const Eigen::MatrixXd samples = random_samples(60, 2, 3);
    const Linkage tree = linkage(distance_matrix(samples), LinkageMethod::single);
    for (const double epsilon : {0.1, 0.3, 0.5, 1.0}) EXPECT_EQ(cut_at(tree, epsilon), dbscan(samples, epsilon, 1));
}

TEST(Linkage, HandlesSingleAndIdenticalSamplesAndInvalidInput) {
    const Linkage single_sample = linkage(Eigen::MatrixXd::Zero(1, 1));
    EXPECT_TRUE(single_sample.merges.empty());
    EXPECT_EQ(leaf_order(single_sample), std::vector<int>{0});
    const Linkage same = linkage(Eigen::MatrixXd::Zero(5, 5));
    EXPECT_EQ(same.merges.size(), 4u);
    EXPECT_EQ(same.merges.back().size, 5);
    EXPECT_EQ(leaf_order(same).size(), 5u);
    EXPECT_THROW(linkage(Eigen::MatrixXd(0, 0)), Error);
    Eigen::MatrixXd distances(2, 2);
    distances << 0, 1, 2, 0;
    EXPECT_THROW(linkage(distances), Error) << "not symmetric";
    distances << 0, -1, -1, 0;
    EXPECT_THROW(linkage(distances), Error) << "negative";
    EXPECT_THROW(linkage(Eigen::MatrixXd::Zero(2, 3)), Error);
}

TEST(SpectralEmbedding, TakesTheLargestMagnitudes) {
    // Eigenvalues 3, -2, 1 with known vectors.
    Eigen::Matrix3d q;
    q.col(0) = Eigen::Vector3d(2, 1, 2) / 3;
    q.col(1) = Eigen::Vector3d(-2, 2, 1) / 3;
    q.col(2) = Eigen::Vector3d(1, 2, -2) / 3;
    const Eigen::Matrix3d a = q * Eigen::Vector3d(1, -2, 3).asDiagonal() * q.transpose();
    const Embedding embedding = spectral_embedding(a, 2);
    ASSERT_EQ(embedding.coordinates.cols(), 2);
    EXPECT_NEAR(embedding.eigenvalues[0], 3, 1e-12);
    EXPECT_NEAR(embedding.eigenvalues[1], -2, 1e-12);
    EXPECT_LT((embedding.coordinates.col(0) - q.col(2)).norm(), 1e-12) << "2/3 comes before -2/3: its sign is positive";
    EXPECT_LT((embedding.coordinates.col(1) + q.col(1)).norm(), 1e-12) << "-2/3 comes first: it is turned";
    EXPECT_EQ(spectral_embedding(a, 9).coordinates.cols(), 3);
    EXPECT_EQ(spectral_embedding(Eigen::MatrixXd::Zero(2, 2), 1).eigenvalues[0], 0);
    const Embedding single_entry = spectral_embedding(Eigen::MatrixXd::Constant(1, 1, -4), 3);
    EXPECT_EQ(single_entry.eigenvalues[0], -4);
    EXPECT_EQ(single_entry.coordinates(0, 0), 1);
}

TEST(SpectralEmbedding, RefusesAsymmetricMatrices) {
    Eigen::Matrix2d a;
    a << 1, 2, 3, 4;
    EXPECT_THROW(spectral_embedding(a, 1), Error);
    EXPECT_THROW(spectral_embedding(Eigen::MatrixXd(0, 0), 1), Error);
    EXPECT_THROW(spectral_embedding(Eigen::MatrixXd::Identity(2, 2), 0), Error);
}

TEST(PrincipalComponents, OfAnElongatedCloud) {
    Eigen::MatrixXd samples(4, 2);
    samples << 1, 1, 3, 3, 5, 5, 3, 3;
    samples.array() += 1e6;
    const PrincipalComponents components = principal_components(samples, 2);
    EXPECT_NEAR(components.variances[0], 16.0 / 3, 1e-9);
    EXPECT_NEAR(components.variances[1], 0, 1e-9);
    EXPECT_NEAR(components.total_variance, 16.0 / 3, 1e-9);
    EXPECT_LT((components.directions.col(0) - Eigen::Vector2d(1, 1).normalized()).norm(), 1e-9);
    EXPECT_NEAR(components.scores(2, 0), 2 * std::sqrt(2.0), 1e-9);
    EXPECT_EQ(principal_components(samples.topRows(1), 5).variances[0], 0);
}

}  // namespace
}  // namespace ostraka

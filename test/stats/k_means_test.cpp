#include "ostraka/stats/k_means.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace ostraka {
namespace {

Eigen::MatrixXd column(const std::vector<double>& values) {
    return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Balls of deviation 1 about centres that lie `apart` from each other on an axis each.
Eigen::MatrixXd balls(int clusters, int each, double apart, std::uint64_t seed) {
    Random random(seed);
    Eigen::MatrixXd samples(clusters * each, clusters);
    for (Eigen::Index i = 0; i < samples.rows(); ++i)
        for (Eigen::Index j = 0; j < samples.cols(); ++j) samples(i, j) = random.normal() + (i % clusters == j ? apart : 0);
    return samples;
}

TEST(KMeans, OfPilesByHand) {
    const KMeansResult clustering = k_means(column({0, 1, 10, 11, 12, 100}), {.clusters = 3});
    EXPECT_EQ(clustering.labels, (std::vector<int>{1, 1, 0, 0, 0, 2})) << "by falling size";
    EXPECT_NEAR(clustering.centres(0, 0), 11, 1e-12);
    EXPECT_NEAR(clustering.centres(1, 0), 0.5, 1e-12);
    EXPECT_NEAR(clustering.centres(2, 0), 100, 1e-12);
    EXPECT_NEAR(clustering.cost, 0.5 + 2, 1e-12);
    EXPECT_TRUE(clustering.converged);
}

TEST(KMeans, FindsBallsAtAnyPositionAndScale) {
    const Eigen::MatrixXd samples = balls(4, 30, 20, 1);
    for (const double scale : {1.0, 1e-150, 1e150})
        for (const double shift : {0.0, 1e6}) {
            const KMeansResult clustering = k_means(scale * (samples.array() + shift).matrix(), {.clusters = 4});
            for (int i = 0; i < samples.rows(); ++i)
                ASSERT_EQ(clustering.labels[i], clustering.labels[i % 4]) << scale << ' ' << shift;
            ASSERT_EQ(std::set<int>(clustering.labels.begin(), clustering.labels.end()).size(), 4u);
        }
}

TEST(KMeans, NoSampleLiesNearerToAnotherCentre) {
    const Eigen::MatrixXd samples = balls(3, 40, 2, 7);
    const KMeansResult clustering = k_means(samples, {.clusters = 5});
    ASSERT_TRUE(clustering.converged);
    double cost = 0;
    for (Eigen::Index i = 0; i < samples.rows(); ++i) {
        const double own_distance = (samples.row(i) - clustering.centres.row(clustering.labels[i])).squaredNorm();
        cost += own_distance;
        for (Eigen::Index k = 0; k < 5; ++k)
            EXPECT_LE(own_distance, (samples.row(i) - clustering.centres.row(k)).squaredNorm() + 1e-12);
    }
    EXPECT_NEAR(clustering.cost, cost, 1e-9 * cost);
    for (int k = 0; k < 5; ++k) {
        Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(3);
        int count = 0;
        for (Eigen::Index i = 0; i < samples.rows(); ++i)
            if (clustering.labels[i] == k) mean += samples.row(i), ++count;
        ASSERT_GT(count, 0);
        EXPECT_LT((mean / count - clustering.centres.row(k)).norm(), 1e-12);
    }
}

TEST(KMeans, HandlesIdenticalAndFewSamples) {
    const KMeansResult same = k_means(Eigen::MatrixXd::Constant(6, 2, 0.3), {.clusters = 3});
    EXPECT_EQ(same.labels, std::vector<int>(6, 0));
    EXPECT_EQ(same.centres.rows(), 1);
    EXPECT_EQ(same.centres(0, 1), 0.3);
    EXPECT_EQ(same.cost, 0);

    const KMeansResult two = k_means(column({5, 7, 5, 7, 7}), {.clusters = 4});
    EXPECT_EQ(two.labels, (std::vector<int>{1, 0, 1, 0, 0}));
    EXPECT_EQ(two.centres.rows(), 2);

    const KMeansResult single_sample = k_means(column({5}), {.clusters = 1});
    EXPECT_EQ(single_sample.labels, std::vector<int>{0});
    EXPECT_EQ(single_sample.centres(0, 0), 5);

    const KMeansResult each = k_means(column({1, 2, 3, 4, 5}), {.clusters = 5});
    EXPECT_EQ(each.labels, (std::vector<int>{0, 1, 2, 3, 4}));
    EXPECT_EQ(each.cost, 0);
}

TEST(KMeans, NeverLosesACluster) {
    // A distant initial centre and duplicates elsewhere cause empty clusters.
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        Random random(seed);
        Eigen::MatrixXd samples(20, 2);
        for (Eigen::Index i = 0; i < 20; ++i)
            for (Eigen::Index j = 0; j < 2; ++j) samples(i, j) = static_cast<double>(random.below(4));
        std::set<std::pair<double, double>> distinct;
        for (Eigen::Index i = 0; i < 20; ++i) distinct.insert({samples(i, 0), samples(i, 1)});
        const int k = static_cast<int>(distinct.size());
        const KMeansResult clustering = k_means(samples, {.clusters = k, .restarts = 1, .seed = seed});
        EXPECT_EQ(std::set<int>(clustering.labels.begin(), clustering.labels.end()).size(), distinct.size());
        EXPECT_LT(clustering.cost, 1e-20) << "as many clusters as distinct samples";
    }
}

TEST(KMeans, IsTheSameForAnyNumberOfThreads) {
    const Eigen::MatrixXd samples = balls(5, 40, 3, 11);
    const int original_threads = threads();
    set_threads(1);
    const KMeansResult single_thread = k_means(samples, {.clusters = 6});
    const ClusterCount count_one = propose_cluster_count(samples, {.max_clusters = 4, .references = 5});
    set_threads(3);
    const KMeansResult three = k_means(samples, {.clusters = 6});
    const ClusterCount count_three = propose_cluster_count(samples, {.max_clusters = 4, .references = 5});
    set_threads(original_threads);
    EXPECT_EQ(single_thread.labels, three.labels);
    EXPECT_EQ(single_thread.centres, three.centres);
    EXPECT_EQ(single_thread.cost, three.cost);
    for (std::size_t k = 0; k < count_one.rows.size(); ++k) EXPECT_EQ(count_one.rows[k].gap, count_three.rows[k].gap);
}

TEST(KMeans, RefusesInvalidInput) {
    EXPECT_THROW(k_means(Eigen::MatrixXd(0, 2)), Error);
    EXPECT_THROW(k_means(Eigen::MatrixXd(2, 0)), Error);
    Eigen::MatrixXd bad = Eigen::MatrixXd::Zero(4, 2);
    bad(2, 1) = std::nan("");
    try {
        k_means(bad);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_NE(std::string(error.what()).find("row 2, column 1"), std::string::npos);
    }
    EXPECT_THROW(k_means(column({1, 2}), {.clusters = 0}), Error);
    EXPECT_THROW(k_means(column({1, 2}), {.restarts = 0}), Error);
}

TEST(Standardised, HasMeanZeroAndDeviationOne) {
    Eigen::MatrixXd samples(4, 3);
    samples << 1, 1e9, 0.1, 2, 1e9 + 1, 0.1, 3, 1e9 + 2, 0.1, 6, 1e9 + 5, 0.1;
    const Eigen::MatrixXd s = standardised(samples);
    for (int j = 0; j < 2; ++j) {
        EXPECT_NEAR(s.col(j).mean(), 0, 1e-12);
        EXPECT_NEAR(s.col(j).squaredNorm() / 3, 1, 1e-12);
    }
    EXPECT_TRUE(s.col(2).isZero(0)) << "a column without variation";
    EXPECT_TRUE(standardised(samples.topRows(1)).isZero(0));
}

TEST(Silhouette, ByHand) {
    // 0 and 1 against 10: a = 1, b = 10 and 9; 10 is alone.
    const std::vector<double> s = silhouettes_of_samples(column({0, 1, 10}), {0, 0, 1});
    EXPECT_DOUBLE_EQ(s[0], 9.0 / 10);
    EXPECT_DOUBLE_EQ(s[1], 8.0 / 9);
    EXPECT_EQ(s[2], 0);
    Eigen::MatrixXd distances(3, 3);
    distances << 0, 1, 10, 1, 0, 9, 10, 9, 0;
    EXPECT_EQ(silhouettes_of_distances(distances, {0, 0, 1}), s);
    // Noise samples have no silhouette and do not affect others.
    const std::vector<double> with_noise = silhouettes_of_samples(column({0, 1, 3, 10}), {0, 0, -1, 1});
    EXPECT_EQ(with_noise[2], 0);
    EXPECT_DOUBLE_EQ(with_noise[0], 9.0 / 10);
    EXPECT_EQ(silhouettes_of_samples(column({1, 2}), {0, 0}), std::vector<double>(2, 0.0)) << "one cluster";
    EXPECT_EQ(silhouettes_of_samples(column({1, 1, 1}), {0, 0, 1}), std::vector<double>(3, 0.0)) << "identical samples";
    EXPECT_THROW(silhouettes_of_samples(column({1, 2}), {0}), Error);
}

TEST(ClusterCount, FindsThePlantedNumber) {
    for (const int planted : {2, 3, 4}) {
        const ClusterCount proposed = propose_cluster_count(balls(planted, 30, 15, 5), {.max_clusters = 7, .references = 20});
        EXPECT_EQ(proposed.by_silhouette, planted);
        EXPECT_EQ(proposed.by_gap, planted);
        EXPECT_EQ(proposed.proposed, planted);
        ASSERT_EQ(proposed.rows.size(), 7u);
        for (std::size_t k = 1; k < 7; ++k) EXPECT_LE(proposed.rows[k].cost, proposed.rows[k - 1].cost * (1 + 1e-9));
    }
}

TEST(ClusterCount, GapDetectsTheAbsenceOfClusters) {
    Random random(2);
    Eigen::MatrixXd samples(200, 2);
    for (Eigen::Index i = 0; i < 200; ++i) samples.row(i) << random.uniform(), random.uniform();
    const ClusterCount proposed =
        propose_cluster_count(samples, {.max_clusters = 6, .criterion = ClusterCountOptions::Criterion::gap, .references = 20});
    EXPECT_EQ(proposed.proposed, 1);
    EXPECT_GT(proposed.by_silhouette, 1) << "which the silhouette cannot";
}

TEST(ClusterCount, HandlesFewAndIdenticalSamples) {
    EXPECT_EQ(propose_cluster_count(Eigen::MatrixXd::Constant(5, 2, 1.0)).proposed, 1);
    EXPECT_EQ(propose_cluster_count(column({3})).proposed, 1);
    EXPECT_EQ(propose_cluster_count(column({3, 4})).rows.size(), 1u) << "a sample each is no clustering";
    for (const auto criterion : {ClusterCountOptions::Criterion::silhouette, ClusterCountOptions::Criterion::gap})
        EXPECT_EQ(propose_cluster_count(column({3, 3, 3, 8, 8, 8}), {.criterion = criterion}).proposed, 2);
    ClusterCountOptions options;
    EXPECT_THROW(set_option(options, "criterion", "elbow"), Error);
}

}  // namespace
}  // namespace ostraka

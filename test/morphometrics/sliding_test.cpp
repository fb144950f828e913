#include "ostraka/morphometrics/sliding.h"

#include "ostraka/core/error.h"
#include "samples.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

using test::moved;
using test::random_sample;

/// Four corners of a square, and on each side of the square three points at shares that noise changes.
ShapeSample squares(double noise, SemiLandmarks& semi) {
    Random random(8);
    ShapeSample sample;
    sample.dimension = 2;
    for (int k = 0; k < 16; ++k) sample.landmarks.push_back(std::to_string(k + 1));
    for (int s = 0; s < 10; ++s) {
        Landmarks x = Landmarks::Zero(16, 3);
        const double corners[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
        for (int side = 0; side < 4; ++side)
            for (int i = 0; i < 4; ++i) {
                const double share = i == 0 ? 0 : i / 4.0 + noise * random.uniform(-1, 1);
                for (int c = 0; c < 2; ++c) x(4 * side + i, c) = (1 - share) * corners[side][c] + share * corners[side + 1][c];
            }
        sample.specimens.push_back(std::to_string(s));
        sample.configurations.push_back(moved(x, random, 2));
    }
    semi = {};
    for (std::size_t side = 0; side < 4; ++side)
        for (std::size_t i = 1; i < 4; ++i) semi.curves.push_back({4 * side + i - 1, 4 * side + i, (4 * side + i + 1) % 16});
    return sample;
}

double spread(const ShapeSample& sample) {
    return generalised_procrustes(sample.configurations, sample.procrustes_options()).sum_of_squares;
}

TEST(Sliding, PointsOnStraightSidesBecomeAlike) {
    SemiLandmarks semi;
    const ShapeSample sample = squares(0.08, semi);
    const double before = spread(sample);
    for (const auto criterion : {SlidingCriterion::bending_energy, SlidingCriterion::procrustes_distance}) {
        SlidingOptions options;
        options.criterion = criterion;
        options.iterations = 500;
        const SlidSample slid = slide_semilandmarks(sample, semi, options);
        EXPECT_TRUE(slid.converged);
        EXPECT_LT(spread(slid.sample), 1e-4 * before) << "squares with points that only differ along their sides";
        EXPECT_LT(slid.energy_after, slid.energy_before + 1e-9);
        for (std::size_t s = 0; s < sample.specimens.size(); ++s) {
            const Landmarks &x = slid.sample.configurations[s], &old = sample.configurations[s];
            for (const Eigen::Index corner : {0, 4, 8, 12})
                EXPECT_LT((x.row(corner) - old.row(corner)).norm(), 1e-12) << "corners do not slide";
            for (Eigen::Index k = 0; k < 16; ++k) {
                const Eigen::Index a = k / 4 * 4, b = (a + 4) % 16;
                const Eigen::RowVector3d along = (old.row(b) - old.row(a)).normalized(), off = x.row(k) - old.row(a);
                EXPECT_LT((off - off.dot(along) * along).norm(), 1e-9 * centroid_size(old)) << "points stay on straight sides";
            }
        }
    }
}

TEST(Sliding, OnASurfacePointsStayOnItAndEnergyFalls) {
    // Landmarks on a sphere: the poles of three axes are fixed, other points slide.
    Random random(3);
    ShapeSample sample;
    std::vector<Eigen::RowVector3d> places;
    for (int c = 0; c < 3; ++c)
        for (const double sign : {-1.0, 1.0}) places.push_back(sign * Eigen::RowVector3d::Unit(c));
    for (int k = 0; k < 12; ++k)
        places.push_back(Eigen::RowVector3d(random.normal(), random.normal(), random.normal()).normalized());
    for (std::size_t k = 0; k < places.size(); ++k) sample.landmarks.push_back(std::to_string(k));
    for (int s = 0; s < 8; ++s) {
        Landmarks x(18, 3);
        for (Eigen::Index k = 0; k < 18; ++k) {
            x.row(k) = places[static_cast<std::size_t>(k)];
            if (k >= 6)
                x.row(k) = (x.row(k) + 0.1 * Eigen::RowVector3d(random.normal(), random.normal(), random.normal())).normalized();
        }
        sample.specimens.push_back(std::to_string(s));
        sample.configurations.push_back(x);
    }
    SemiLandmarks semi;
    for (std::size_t k = 6; k < 18; ++k) semi.surface.push_back(k);
    const double before = spread(sample);
    const SlidSample fitted = slide_semilandmarks(sample, semi);
    EXPECT_LT(spread(fitted.sample), before);
    semi.surface_of = [](std::size_t, const Eigen::RowVector3d& point) {
        return SurfacePlace{point.normalized(), point.normalized()};
    };
    const SlidSample slid = slide_semilandmarks(sample, semi);
    EXPECT_LT(spread(slid.sample), 0.1 * before);
    for (const Landmarks& x : slid.sample.configurations)
        for (Eigen::Index k = 0; k < 18; ++k) EXPECT_NEAR(x.row(k).norm(), 1, 1e-12);
}

TEST(Sliding, WrongSlidersAreRefused) {
    const ShapeSample sample = random_sample(1, 5, 8, 3, 0.1);
    const auto refused = [&](const SemiLandmarks& semi) { EXPECT_THROW(slide_semilandmarks(sample, semi), Error); };
    refused({{{0, 1, 9}}, {}, {}});
    refused({{{0, 0, 1}}, {}, {}});
    refused({{{0, 1, 2}}, {1}, {}});
    refused({{}, {0, 1, 2, 3, 4, 5}, {}});
    const SlidSample same = slide_semilandmarks(sample, {});
    EXPECT_EQ(same.sample.configurations[2], sample.configurations[2]);
}

}  // namespace
}  // namespace ostraka

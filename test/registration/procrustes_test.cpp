#include "ostraka/registration/procrustes.h"

#include "scratch.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/interchange/landmarks.h"
#include "ostraka/stats/embedding.h"
#include "ostraka/stats/random.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>

namespace ostraka {
namespace {

Landmarks random_landmarks(int count, std::uint64_t seed) {
    Random random(seed);
    Landmarks x(count, 3);
    for (Eigen::Index i = 0; i < count; ++i)
        for (Eigen::Index c = 0; c < 3; ++c) x(i, c) = random.normal();
    return x;
}

SimilarityMap motion(double scale, double angle, const Eigen::Vector3d& shift) {
    SimilarityMap map;
    map.scale = scale;
    map.rotation = Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
    map.translation = shift;
    return map;
}

TEST(Procrustes, UndoesAMotionAnywhereAndInAnyUnit) {
    const Landmarks x = random_landmarks(12, 1);
    for (const double unit : {1.0, 1e-100, 1e100})
        for (const double far : {0.0, 1e5}) {
            const SimilarityMap true_map = motion(2.5, 2.9, far * unit * Eigen::Vector3d(1, -1, 2));
            const Landmarks from = unit * x, to = true_map.apply(from);
            const SimilarityMap map = procrustes(from, to, {.scaling = true});
            EXPECT_NEAR(map.scale, 2.5, 1e-9);
            EXPECT_LT((map.rotation - true_map.rotation).norm(), 1e-9);
            EXPECT_LT((map.apply(from) - to).norm() / unit, 1e-9 * (1 + far));
            EXPECT_NEAR(map.rotation.determinant(), 1, 1e-12);
        }
    const SimilarityMap rigid = procrustes(x, motion(1, -1, {1, 2, 3}).apply(x));
    EXPECT_EQ(rigid.scale, 1);
    EXPECT_LT(rigid.sum_of_squares, 1e-24);
}

TEST(Procrustes, MirrorImagesDifferUnlessReflectionIsAllowed) {
    const Landmarks x = random_landmarks(8, 2);
    Landmarks mirrored = x;
    mirrored.col(0) *= -1;
    const SimilarityMap rotated = procrustes(x, mirrored);
    EXPECT_NEAR(rotated.rotation.determinant(), 1, 1e-12);
    EXPECT_GT(rotated.sum_of_squares, 0.1);
    EXPECT_LT(procrustes(x, mirrored, {.reflection = true}).sum_of_squares, 1e-24);
}

TEST(Procrustes, IsTheBestOfManyMotions) {
    const Landmarks x = random_landmarks(7, 3), y = random_landmarks(7, 4);
    for (const bool scaling : {false, true}) {
        const SimilarityMap best = procrustes(x, y, {.scaling = scaling});
        EXPECT_NEAR((best.apply(x) - y).squaredNorm(), best.sum_of_squares, 1e-12);
        Random random(5);
        for (int trial = 0; trial < 200; ++trial) {
            SimilarityMap other = best;
            other.rotation = Eigen::AngleAxisd(random.normal(0, 0.2),
                                               Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized()) *
                             best.rotation;
            other.translation += 0.1 * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
            if (scaling) other.scale *= std::exp(random.normal(0, 0.1));
            EXPECT_GE((other.apply(x) - y).squaredNorm(), best.sum_of_squares - 1e-12);
        }
    }
}

TEST(Procrustes, LandmarksOnALineAndInAPlane) {
    Landmarks line(4, 3), goal(4, 3);
    line << 0, 0, 0, 1, 0, 0, 2, 0, 0, 5, 0, 0;
    goal << 3, 0, 0, 3, 1, 0, 3, 2, 0, 3, 5, 0;
    const SimilarityMap map = procrustes(line, goal);
    EXPECT_LT(map.sum_of_squares, 1e-24);
    EXPECT_NEAR(map.rotation.determinant(), 1, 1e-12);
    Landmarks triangle(3, 3);
    triangle << 0, 0, 0, 1, 0, 0, 0, 1, 0;
    EXPECT_LT(procrustes(triangle, motion(1, 1, {0, 0, 1}).apply(triangle)).sum_of_squares, 1e-24);
}

TEST(Procrustes, RefusesInvalidConfigurations) {
    const Landmarks x = random_landmarks(5, 6);
    EXPECT_THROW(procrustes(x, random_landmarks(4, 6)), Error);
    EXPECT_THROW(procrustes(x.topRows(2), x.topRows(2)), Error);
    EXPECT_THROW(procrustes(Landmarks::Ones(5, 3), x), Error) << "all in one place";
    Landmarks bad = x;
    bad(1, 1) = std::nan("");
    EXPECT_THROW(procrustes(x, bad), Error);
    EXPECT_THROW(generalised_procrustes({}), Error);
    EXPECT_THROW(generalised_procrustes({x, random_landmarks(6, 1)}), Error);
}

TEST(GeneralisedProcrustes, MovedCopiesHaveNoResidual) {
    const Landmarks x = random_landmarks(10, 7);
    std::vector<Landmarks> copies{x};
    for (int i = 1; i < 6; ++i) copies.push_back(motion(i, 0.9 * i, Eigen::Vector3d(i, 0, -i)).apply(x));
    const GeneralisedProcrustes shape = generalised_procrustes(copies, {.scaling = true});
    EXPECT_TRUE(shape.converged);
    EXPECT_LT(shape.sum_of_squares, 1e-24);
    EXPECT_NEAR(centroid_size(shape.mean), 1, 1e-12);
    for (std::size_t i = 1; i < 6; ++i) {
        EXPECT_NEAR(shape.centroid_sizes[i], static_cast<double>(i) * shape.centroid_sizes[0], 1e-9);
        EXPECT_LT((shape.maps[i].apply(copies[i]) - shape.aligned[i]).norm(), 1e-12);
    }
    // The mean has the orientation of the first.
    const Landmarks first = (x.rowwise() - x.colwise().mean()) / centroid_size(x);
    EXPECT_LT((shape.mean - first).norm(), 1e-9);
    EXPECT_GT(generalised_procrustes(copies).sum_of_squares, 1) << "sizes differ";
}

TEST(GeneralisedProcrustes, OneAndTwoConfigurations) {
    const Landmarks x = random_landmarks(9, 8), y = random_landmarks(9, 9);
    EXPECT_LT(generalised_procrustes({x}).sum_of_squares, 1e-24);
    // The deviation from the mean of two is half of their distance.
    EXPECT_NEAR(generalised_procrustes({x, y}).sum_of_squares, procrustes(x, y).sum_of_squares / 2, 1e-9);
}

TEST(GeneralisedProcrustes, IsAFixedPointAndTheSameForAnyNumberOfThreads) {
    std::vector<Landmarks> configurations;
    const Landmarks base = random_landmarks(15, 10);
    for (std::uint64_t i = 0; i < 12; ++i)
        configurations.push_back(motion(1, static_cast<double>(i), {1, 1, 1}).apply(base + 0.2 * random_landmarks(15, 20 + i)));
    const int before = threads();
    set_threads(1);
    const GeneralisedProcrustes single_threaded = generalised_procrustes(configurations);
    set_threads(3);
    const GeneralisedProcrustes three = generalised_procrustes(configurations);
    set_threads(before);
    EXPECT_EQ(single_threaded.mean, three.mean);
    ASSERT_TRUE(single_threaded.converged);
    Landmarks mean = Landmarks::Zero(15, 3);
    for (const Landmarks& x : single_threaded.aligned) {
        mean += x / 12;
        EXPECT_LT((procrustes(x, single_threaded.mean).rotation - Eigen::Matrix3d::Identity()).norm(), 1e-7)
            << "no turn is better";
    }
    EXPECT_LT((mean - single_threaded.mean).norm(), 1e-12);
    const PrincipalComponents components = principal_components(shape_rows(single_threaded.aligned), 3);
    EXPECT_NEAR(components.total_variance * 11, single_threaded.sum_of_squares, 1e-9)
        << "the variance of the shapes is what is left";
}

std::vector<Landmarks> configurations_in(const Path& folder) {
    std::vector<Path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().string().ends_with(".mrk.json")) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::vector<Landmarks> skulls;
    for (const Path& file : files) {
        const LandmarkSet set = read_landmarks(file, LandmarkFormat::mrk);
        Landmarks x(static_cast<Eigen::Index>(set.landmarks.size()), 3);
        for (std::size_t i = 0; i < set.landmarks.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c)
                x(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) = set.landmarks[i].position[c];
        skulls.push_back(x);
    }
    return skulls;
}

/// Mean centroid size, size of the mean and sum of squares without scaling, sum of squares with it. Ten digits are given.
void expect_figures(const std::vector<Landmarks>& skulls, const std::array<double, 4>& expected) {
    const GeneralisedProcrustes partial = generalised_procrustes(skulls),
                                full = generalised_procrustes(skulls, {.scaling = true});
    double mean_size = 0;
    for (const double size : partial.centroid_sizes) mean_size += size / static_cast<double>(skulls.size());
    EXPECT_NEAR(mean_size, expected[0], 1e-8 * expected[0]);
    EXPECT_NEAR(partial.mean.norm(), expected[1], 1e-8 * expected[1]);
    EXPECT_NEAR(partial.sum_of_squares, expected[2], 1e-8 * expected[2]);
    EXPECT_NEAR(full.sum_of_squares, expected[3], 1e-8 * expected[3]);
}

TEST(GeneralisedProcrustes, ReproducesPublishedLandmarksOfMouseSkulls) {
    const Path folder = Path(OSTRAKA_SHARED_DATA) / "landmarks-mouse-skulls" / "LMs";
    if (!std::filesystem::is_directory(folder)) {
        std::cerr << "SKIPPED: " << folder << " is not there, the figures of the mouse skulls are not compared\n";
        GTEST_SKIP();
    }
    const std::vector<Landmarks> skulls = configurations_in(folder);
    ASSERT_EQ(skulls.size(), 31u);
    expect_figures(skulls, {43.93584448, 43.9042953, 233.5286065, 0.04497425199});
}

/// The gorilla skulls' landmarks come as an archive.
TEST(GeneralisedProcrustes, ReproducesPublishedLandmarksOfGorillaSkulls) {
    const Path archive = Path(OSTRAKA_SHARED_DATA) / "landmarks-mouse-skulls" / "gorilla" / "Gorilla_Skull_LMs.zip";
    const test::Scratch scratch;
    const std::string command = "unzip -q -j '" + archive.string() + "' -d '" + scratch.path().string() + "' 2>/dev/null";
    if (!std::filesystem::exists(archive) || std::system(command.c_str()) != 0) {
        std::cerr << "SKIPPED: " << archive
                  << " is not there or cannot be unpacked, the figures of the gorillas are not compared\n";
        GTEST_SKIP();
    }
    const std::vector<Landmarks> skulls = configurations_in(scratch.path());
    ASSERT_EQ(skulls.size(), 23u);
    expect_figures(skulls, {462.2120139, 461.3047085, 62518.30109, 0.0895902745});
}

}  // namespace
}  // namespace ostraka

// The class's prediction of the part that a fragment lacks.
#include "ostraka/reconstruction/reconstruct.h"

#include "pieces.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

using namespace test;
using Eigen::Vector3d;

/// The class of the body: taller or shorter (by 10 per cent in a standard deviation), bent forward, wider on one side.
ShapePrior prior_of_bodies(const Mesh& mesh) {
    ShapePrior prior;
    prior.modes.setZero(3 * static_cast<Eigen::Index>(mesh.number_of_vertices()), 3);
    for (const Vertex v : mesh.vertices()) {
        const Vector3d p = eigen(mesh.point(v));
        prior.mean.push_back(p);
        const Eigen::Index i = 3 * static_cast<Eigen::Index>(v);
        prior.modes(i + 2, 0) = p.z();
        prior.modes(i, 1) = p.z() * p.z() / 2;
        prior.modes(i + 1, 2) = std::max(p.y(), 0.0);
    }
    prior.deviations = {0.1, 0.1, 0.1};
    return prior;
}

Mesh member(const Mesh& mesh, const ShapePrior& prior, const Vector3d& deviations) {
    Mesh result = mesh;
    for (const Vertex v : mesh.vertices()) {
        const Vector3d move = prior.modes.middleRows<3>(3 * static_cast<Eigen::Index>(v)) * (0.1 * deviations);
        result.point(v) = point_of(prior.mean[v] + move);
    }
    return result;
}

double missing_error(const Mesh& original, const Cut& cut_piece, const Reconstruction& result) {
    const Motion frame = result.placement.fragments[0].pose.after(cut_piece.piece.pose.inverse());
    std::vector<bool> observed(original.number_of_vertices(), false);
    for (const Index v : cut_piece.piece.vertices) observed[v] = true;
    double sum = 0, count = 0;
    for (const Vertex v : original.vertices()) {
        if (observed[v]) continue;
        sum += (eigen(result.points[v]) - frame(eigen(original.point(v)))).squaredNorm();
        ++count;
    }
    return std::sqrt(sum / count);
}

TEST(ShapePrior, TheMissingPartIsThatOfTheObservedMember) {
    const Mesh mesh = body();
    const AnnotationSet set = landmarks_of(mesh);
    const ShapePrior prior = prior_of_bodies(mesh);
    for (const Vector3d& b : {Vector3d(1.5, -1, 0.5), Vector3d(-1, 1, 1), Vector3d(0, 0, 0)}) {
        const Mesh original = member(mesh, prior, b);
        FragmentOptions options;
        options.share = 0.35;
        options.noise = 0.001;
        const Cut cut_piece = cut({original, set}, Point(0, 0, 1.9), options);
        const Reconstruction with_prior = reconstruct({mesh, set}, {}, {&cut_piece.fragment}, {}, {}, &prior);
        const Reconstruction without_prior = reconstruct({mesh, set}, {}, {&cut_piece.fragment});
        ASSERT_TRUE(with_prior.prior.has_value());
        EXPECT_FALSE(without_prior.prior.has_value());
        const double diagonal = box_diagonal(original);
        EXPECT_LT(missing_error(original, cut_piece, with_prior), 0.01 * diagonal);
        if (b.norm() > 0) {
            EXPECT_LT(missing_error(original, cut_piece, with_prior), 0.3 * missing_error(original, cut_piece, without_prior));
        }
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(with_prior.prior->coefficients[static_cast<std::size_t>(k)], b[k], 0.35) << k;
        EXPECT_EQ(with_prior.crossings, 0U);
    }
}

TEST(ShapePrior, HoldsCoefficientsWithinItsLimitAndIsTheSameForAnyNumberOfThreads) {
    const Mesh mesh = body(3);
    const AnnotationSet set = landmarks_of(mesh);
    const ShapePrior prior = prior_of_bodies(mesh);
    const Mesh original = member(mesh, prior, Vector3d(6, 0, 0));
    FragmentOptions half;
    half.share = 0.5;
    const Cut cut_piece = cut({original, set}, Point(0, 0, 1.9), half);
    ReconstructOptions options;
    options.prior.maximum = 1;
    const int before = threads();
    set_threads(1);
    const Reconstruction alone = reconstruct({mesh, set}, {}, {&cut_piece.fragment}, options, {}, &prior);
    set_threads(3);
    const Reconstruction many = reconstruct({mesh, set}, {}, {&cut_piece.fragment}, options, {}, &prior);
    set_threads(before);
    for (const double b : alone.prior->coefficients) EXPECT_LE(std::abs(b), 1 + 1e-12);
    EXPECT_GT(alone.prior->coefficients[0], 0.99);
    EXPECT_EQ(alone.points, many.points);
    EXPECT_EQ(alone.prior->coefficients, many.prior->coefficients);
}

TEST(ShapePrior, WithoutModesItIsTheMean) {
    const Mesh mesh = body(3);
    const AnnotationSet set = landmarks_of(mesh);
    ShapePrior prior = prior_of_bodies(mesh);
    prior.modes.resize(prior.modes.rows(), 0);
    prior.deviations.clear();
    const Cut cut_piece = cut({mesh, set}, Point(0, 0, 1.9), {});
    const Reconstruction result = reconstruct({mesh, set}, {}, {&cut_piece.fragment}, {}, {}, &prior);
    ASSERT_TRUE(result.prior.has_value());
    EXPECT_TRUE(result.prior->coefficients.empty());
    EXPECT_LT(missing_error(mesh, cut_piece, result), 1e-3 * box_diagonal(mesh));
}

TEST(ShapePrior, RefusesWhatDoesNotFitTheTemplate) {
    const Mesh mesh = body(3);
    const AnnotationSet set = landmarks_of(mesh);
    const Cut cut_piece = cut({mesh, set}, Point(0, 0, 1.9), {});
    const auto refused = [&](const ShapePrior& prior, const std::string& word) {
        try {
            reconstruct({mesh, set}, {}, {&cut_piece.fragment}, {}, {}, &prior);
            ADD_FAILURE() << word;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
        }
    };
    refused(prior_of_bodies(body(2)), "vertices");
    ShapePrior prior = prior_of_bodies(mesh);
    prior.deviations.pop_back();
    refused(prior, "modes");
    prior = prior_of_bodies(mesh);
    prior.deviations[1] = 0;
    refused(prior, "zero variance");
}

}  // namespace
}  // namespace ostraka

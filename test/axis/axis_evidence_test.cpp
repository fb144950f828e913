#include "ostraka/axis/axis_evidence.h"

#include "meshes.h"
#include "ostraka/geom/eigen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace ostraka {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;
using test::grid;

/// A wall about the z axis that widens upwards and bulges, over the given angle.
Mesh wall(double degrees) {
    return build_mesh(grid(80, 40, false, false, [&](double s, double t) {
        const double a = s * degrees * M_PI / 180, r = 10 + 4 * t - 3 * t * t;
        return std::array<double, 3>{r * std::cos(a), r * std::sin(a), 12 * t};
    }));
}

AxisEvidence evidence_at(const Mesh& mesh, const AxisGuess& guess) {
    std::vector<Index> faces(mesh.number_of_faces());
    std::iota(faces.begin(), faces.end(), Index(0));
    return AxisEvidenceEvaluator(mesh, faces).at(guess);
}

TEST(AxisEvidence, StepsConvergeToTheAxis) {
    const Mesh mesh = wall(100);
    AxisGuess guess{{0.2, -0.1, 3}, Vector3d(0.02, 0.03, 1).normalized(), Vector3d::UnitX(), Vector3d::UnitY()};
    for (int round = 0; round < 8; ++round) {
        const AxisEvidence evidence = evidence_at(mesh, guess);
        EXPECT_GT(evidence.round, 0.9);
        const Vector4d step = -evidence.information.ldlt().solve(evidence.gradient);
        guess.point = evidence.place + step[0] * guess.u + step[1] * guess.w;
        guess.direction = (guess.direction + step[2] * guess.u + step[3] * guess.w).normalized();
    }
    EXPECT_LT(guess.direction.head<2>().norm(), 1e-3);
    EXPECT_LT((guess.point - guess.direction * (guess.point.z() / guess.direction.z())).head<2>().norm(), 0.01);
}

TEST(AxisEvidence, AShortArcHasLessInformation) {
    const AxisGuess truth{{0, 0, 0}, Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d::UnitY()};
    double previous_information = 0;
    for (const double degrees : {10.0, 30.0, 90.0, 180.0}) {
        const AxisEvidence evidence = evidence_at(wall(degrees), truth);
        EXPECT_GT(evidence.round, 0.99);
        EXPECT_LT(evidence.gradient.norm(), 1e-2 * std::sqrt(evidence.information.trace())) << degrees;
        // Smallest information on a shift, with free tilts.
        const Eigen::Matrix4d covariance =
            (evidence.information + 1e-12 * evidence.information.trace() * Eigen::Matrix4d::Identity()).inverse();
        const double information = 1 / covariance.topLeftCorner<2, 2>().trace();
        EXPECT_GT(information, 2 * previous_information) << degrees;
        previous_information = information;
    }
}

TEST(AxisEvidence, ShapesThatAreNotRoundHaveLittleEvidence) {
    const AxisGuess wrong_axis{
        {7, 7, 6}, Vector3d(1, -1, 1).normalized(), Vector3d(1, 1, 0).normalized(), Vector3d(-1, 1, 2).normalized()};
    EXPECT_LT(evidence_at(wall(90), wrong_axis).round, 0.5);
    const Mesh coarse = build_mesh(grid(2, 1, false, false, [](double s, double t) { return std::array<double, 3>{s, t, 0}; }));
    std::vector<Index> faces(coarse.number_of_faces());
    std::iota(faces.begin(), faces.end(), Index(0));
    const AxisEvidenceEvaluator evaluator(coarse, faces);
    EXPECT_FALSE(evaluator.enough());
    EXPECT_EQ(evaluator.at(wrong_axis).round, 0);
}

}  // namespace
}  // namespace ostraka

// Verdicts from sizes and landmarks of fragments if these depend on posture.
#include "../../src/reconstruction/reconstruction_verdict.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace ostraka {
namespace {

using Eigen::Vector3d;

/// Five landmarks on either side of a joint at the origin, bent by an angle; of one size with the template times `scale`.
std::vector<LandmarkPair> bent(double angle, double scale) {
    const Eigen::AngleAxisd joint(angle, Vector3d::UnitZ());
    std::vector<LandmarkPair> pairs;
    for (const double side : {-1.0, 1.0})
        for (const auto& p :
             {Vector3d(4, 0, 0), Vector3d(5, 1, 0), Vector3d(5, 0, 1), Vector3d(6, 0.5, 0.3), Vector3d(5.5, -0.8, 0.4)}) {
            LandmarkPair pair;
            pair.name = std::to_string(pairs.size());
            pair.on_template = Vector3d(side * p.x(), p.y(), p.z());
            pair.on_fragment = scale * (side > 0 ? Vector3d(joint * pair.on_template) : pair.on_template);
            pairs.push_back(pair);
        }
    return pairs;
}

Reconstruction judged(const std::vector<std::vector<LandmarkPair>>& pairs, double residual = 10) {
    Reconstruction result;
    result.placement = place_by_landmarks(pairs);
    ReconstructOptions options;
    options.residual = residual;  // of 10: only sizes are tested
    judge_reconstruction(result, pairs, {}, options);
    return result;
}

TEST(VerdictOfSizes, PostureIsNotAnotherSize) {
    const Reconstruction same = judged({bent(0, 1), bent(0, 1)});
    EXPECT_EQ(same.verdict, Compatibility::compatible) << same.undecided;
    const Reconstruction posture = judged({bent(0, 1), bent(1.2, 1)});
    EXPECT_LT(posture.placement.fragments[1].own_scale, 0.9) << "by all landmarks it is another size";
    EXPECT_EQ(posture.verdict, Compatibility::undecided);
    EXPECT_TRUE(posture.objections.empty());
    EXPECT_NE(posture.undecided.find("posture"), std::string::npos) << posture.undecided;
}

TEST(VerdictOfSizes, AFragmentPlacedByItsShapeHasTheSizeOfTheOthers) {
    // Its two landmarks are a fifth farther apart than the template's: one distance does not determine a size.
    auto two = bent(0, 1.2);
    two.resize(2);
    const std::vector<std::vector<LandmarkPair>> pairs{bent(0, 1), two};
    Reconstruction result;
    result.placement = place_by_landmarks(pairs);
    FragmentPlacement& placement = result.placement.fragments[1];
    ASSERT_FALSE(placement.problem.empty()) << "two landmarks place nothing";
    placement.problem.clear();
    placement.own_scale = result.placement.scale;
    ReconstructOptions options;
    options.residual = 10;
    judge_reconstruction(result, pairs, {}, options);
    EXPECT_EQ(result.verdict, Compatibility::compatible) << result.undecided;
}

TEST(VerdictOfSizes, AnotherSizeIsDetected) {
    for (const double angle : {0.0, 0.2}) {
        const Reconstruction other = judged({bent(0, 1), bent(angle, 1.4)});
        EXPECT_EQ(other.verdict, Compatibility::incompatible) << angle;
        ASSERT_FALSE(other.objections.empty());
        EXPECT_EQ(other.objections.front().kind, ObjectionKind::size);
    }
}

TEST(VerdictOfLandmarks, PostureIsNotAnotherShape) {
    const Reconstruction posture = judged({bent(0, 1), bent(1.2, 1)}, 0.1);
    // A sixth of their spread of 4.2.
    EXPECT_GT(posture.placement.fragments[1].residual, 0.15 * 4.2) << "by all landmarks it is another shape";
    EXPECT_EQ(posture.verdict, Compatibility::undecided);
    EXPECT_TRUE(posture.objections.empty());
}

TEST(VerdictOfLandmarks, AnotherShapeIsDetected) {
    auto stretched = bent(0, 1);
    for (LandmarkPair& pair : stretched) pair.on_fragment = Vector3d(0.6, 2.5, 1).cwiseProduct(pair.on_fragment);
    const Reconstruction other = judged({bent(0, 1), stretched}, 0.1);
    EXPECT_EQ(other.verdict, Compatibility::incompatible);
    EXPECT_TRUE(std::any_of(other.objections.begin(), other.objections.end(),
                            [](const Objection& objection) { return objection.kind == ObjectionKind::landmarks; }));
    // Three landmarks do not show whether they belong to parts that move relative to each other.
    std::vector<LandmarkPair> few = bent(1.2, 1);
    few.erase(few.begin() + 1, few.begin() + 5);
    few.erase(few.begin() + 3, few.end());
    EXPECT_TRUE(judged({bent(0, 1), few}, 0.01).verdict == Compatibility::incompatible);
}

}  // namespace
}  // namespace ostraka

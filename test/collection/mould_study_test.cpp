#include "ostraka/collection/mould_study.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

/// Two groups of two heads and one head alone; the first two groups lie next to each other.
MouldStudy five_heads() {
    MouldStudy study;
    study.matrices.names = {"a", "b", "c", "d", "e"};
    study.groups.labels = {0, 0, 1, 1, 2};
    study.groups.head_silhouettes = {0.6, 0.8, 0.5, 0.5, 0};
    study.distances.setConstant(5, 5, 0.9);
    study.distances.topLeftCorner(4, 4).setConstant(0.6);
    study.distances.diagonal().setZero();
    study.distances(0, 1) = study.distances(1, 0) = 0.1;
    study.distances(2, 3) = study.distances(3, 2) = 0.2;
    study.distances(0, 2) = study.distances(2, 0) = 0.4;
    return study;
}

TEST(MouldSummaries, ReportNearestGroupAndDistances) {
    const MouldStudy study = five_heads();
    EXPECT_EQ(study.group_count(), 3);
    EXPECT_DOUBLE_EQ(study.mean_distance(0, 0), 0.1);
    EXPECT_TRUE(std::isnan(study.mean_distance(4, 2))) << "alone in its group";
    EXPECT_EQ(study.second_group(0).first, 1);
    EXPECT_DOUBLE_EQ(study.second_group(0).second, 0.5);
    const auto groups = summarise_groups(study);
    ASSERT_EQ(groups.size(), 3U);
    EXPECT_EQ(groups[0].members, (std::vector<std::string>{"a", "b"}));
    EXPECT_DOUBLE_EQ(*groups[0].within, 0.1);
    EXPECT_DOUBLE_EQ(groups[0].silhouette, 0.7);
    EXPECT_EQ(groups[0].nearest, 1);
    EXPECT_NEAR(*groups[0].to_nearest, 0.55, 1e-15);
    EXPECT_FALSE(groups[2].within);
    EXPECT_EQ(groups[2].nearest, 0) << "the first of equally near ones";
}

TEST(MouldSummaries, OneGroupHasNoOther) {
    MouldStudy study = five_heads();
    study.groups.labels = {0, 0, 0, 0, 0};
    EXPECT_EQ(study.second_group(0).first, -1);
    EXPECT_FALSE(summarise_groups(study)[0].nearest);
}

TEST(MouldSummaries, AgreementIsOverKnownAnswers) {
    EXPECT_DOUBLE_EQ(agreement_with_answers({0, 0, 1, 1, 2}, {"x", "x", "y", "y", ""}), 1);
    EXPECT_LT(agreement_with_answers({0, 0, 1, 1, 2}, {"x", "y", "x", "y", ""}), 0.5);
}

}  // namespace
}  // namespace ostraka

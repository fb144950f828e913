#include "ostraka/shape_classes/dissimilarity.h"

#include "shape_classes/towers.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

/// Three members whose logarithms of three quantities are -0.1, 0 and 0.1; "distance" is a residual.
ShapeClass synthetic_class() {
    ShapeClass learnt;
    learnt.resolution = 0;
    learnt.members.resize(3);
    for (const char* name : {"compactness", "geodesic mean", "distance"}) {
        LearntRange& range = learnt.ranges.emplace_back();
        range.quantity.name = name;
        range.quantity.one_sided = std::string(name) == "distance";
        for (const double log : {-0.1, 0.0, 0.1}) range.values.emplace_back(0.1 * std::exp(log));
        range.count = 3;
    }
    return learnt;
}

std::vector<std::optional<double>> logs(double a, double b, double c) {
    return {0.1 * std::exp(a), 0.1 * std::exp(b), 0.1 * std::exp(c)};
}

TEST(Dissimilarity, IsTheMeanDeviationOfAFurtherMember) {
    const ShapeClass learnt = synthetic_class();
    const double deviation = 0.1 * std::sqrt(4.0 / 3);
    EXPECT_NEAR(dissimilarity(learnt, logs(0, 0, 0))->value, 0, 1e-9);
    const auto dissimilar = dissimilarity(learnt, logs(0.3, -0.6, 0.3));
    ASSERT_TRUE(dissimilar);
    EXPECT_NEAR(dissimilar->value, (0.3 + 0.6 + 0.3) / 3 / deviation, 1e-9);
    EXPECT_EQ(dissimilar->worst, 1U);
    EXPECT_NEAR(dissimilar->off, -0.6 / deviation, 1e-9);
    EXPECT_NEAR(dissimilarity(learnt, logs(0.3, 0, -5))->value, 0.1 / deviation, 1e-9) << "a small residual is no fault";
    // There is no value for two quantities, or with one member.
    EXPECT_FALSE(dissimilarity(learnt, {0.1, 0.1, std::nullopt}));
    ShapeClass small_class = synthetic_class();
    for (LearntRange& range : small_class.ranges) range.values[1].reset(), range.values[2].reset();
    EXPECT_FALSE(dissimilarity(small_class, logs(0, 0, 0)));
}

TEST(Dissimilarity, AMemberIsMeasuredByTheOthers) {
    ShapeClass learnt = synthetic_class();
    measure_dissimilarity(learnt);
    const LearntRange& range = learnt.ranges.back();
    EXPECT_EQ(range.quantity.name, unlike_the_members);
    // The last one by the first two: mean -0.05, deviation 0.1 / sqrt(2) times sqrt(3 / 2).
    EXPECT_NEAR(*range.values[2], 0.15 / (0.1 / std::sqrt(2.0) * std::sqrt(1.5)), 1e-9);
    // Of the first one the residual is below the others'.
    EXPECT_NEAR(*range.values[0], 2.0 / 3 * 0.15 / (0.1 / std::sqrt(2.0) * std::sqrt(1.5)), 1e-9);
    const std::size_t range_count = learnt.ranges.size();
    measure_dissimilarity(learnt);
    EXPECT_EQ(learnt.ranges.size(), range_count) << "the range is replaced, not added again";
    EXPECT_FALSE(dissimilarity(learnt, logs(9, 9, 9)) == std::nullopt) << "it does not count for itself";
    EXPECT_EQ(dissimilarity(learnt,
                            [] {
                                auto values = logs(9, 9, 9);
                                values.emplace_back(3);
                                return values;
                            }())
                  ->count,
              3U);
}

TEST(Dissimilarity, DependentQuantitiesCountOnce) {
    // Three classes whose members' three quantities are one and the same thing.
    std::vector<ShapeClass> classes(3, synthetic_class());
    for (ShapeClass& shape_class : classes)
        shape_class.ranges.back().quantity = ClassQuantity(), shape_class.ranges.back().quantity.name = "geodesic most";
    const Dependence dependence = dependence_of(classes);
    EXPECT_EQ(dependence.freedom, 6);
    ASSERT_EQ(dependence.products.rows(), 3);
    EXPECT_NEAR(dependence.products(0, 1), 3 * 0.02, 1e-12);
    ShapeClass& learnt = classes.front();
    const double independent = dissimilarity(learnt, logs(0.3, 0.3, 0.3))->value,
                 against = dissimilarity(learnt, logs(0.3, 0, -0.3))->value;
    learnt.dependence = dependence;
    // Six degrees of freedom against three quantities: correlations of 2/3; along (1, 1, 1) the eigenvalue is 1 + 2 * 2/3.
    EXPECT_NEAR(dissimilarity(learnt, logs(0.3, 0.3, 0.3))->value, independent / std::sqrt(7.0 / 3), 1e-9);
    // Deviations against the members' correlation increase the dissimilarity: the eigenvalue is 1 - 2/3.
    EXPECT_NEAR(dissimilarity(learnt, logs(0.3, 0, -0.3))->value, against * std::sqrt(3.0), 1e-9);
    // A left-out member does not contribute to the correlations.
    classes.resize(1);
    learnt.dependence = dependence_of(classes);
    learnt.dependence->products *= 0;
    EXPECT_NEAR(dissimilarity(learnt, logs(0.3, 0.3, 0.3))->value, independent, 1e-9);
}

TEST(Dissimilarity, SharesNearOneAreNotExtreme) {
    ShapeClass learnt = synthetic_class();
    learnt.ranges.back().quantity.name = "unexplained";
    learnt.ranges.back().values = {0.2, 0.5, 0.8};
    // Logits, clamped to a per cent from the ends: all values lie within a few deviations.
    EXPECT_LT(std::abs(dissimilarity(learnt, {0.1, 0.1, 1.0})->off), 4);
    learnt.ranges.back().values = {0.0, 0.0, 0.01};
    EXPECT_TRUE(std::isfinite(dissimilarity(learnt, {0.1, 0.1, 1.0})->value));
}

TEST(Dissimilarity, OutOfClassObjectsDetermineWhatIsRecognised) {
    LearntRange range;
    range.high = 3;
    const std::vector<double> members{0.1, -0.2, 0.3, 0.0};
    const auto set = [&](double accept) {
        set_recognised(range, moments_of(members), moments_of(out_of_class_logs(range)), accept, 0.15);
    };
    set(0.05);
    EXPECT_NEAR(*range.recognised, std::exp(predict(moments_of(members), true, 0.15).high), 1e-9);
    std::vector<double> out_of_class{1.5, 1.0, 2.0, 1.2, 1.8};
    for (const double log : out_of_class) range.out_of_class.emplace_back(std::exp(log));
    set(0.05);
    for (double& log : out_of_class) log = -log;
    EXPECT_NEAR(*range.recognised, std::exp(-predict(moments_of(out_of_class), true, 0.05).high), 1e-9)
        << "what one in twenty is below";
    EXPECT_NEAR(*range.high, 3, 1e-12) << "out-of-class objects are farther off on average";
    const double one_class = *range.recognised;
    range.high = 6;
    set(0.05);
    EXPECT_NEAR(*range.high, std::exp(1.5), 1e-9) << "an object as dissimilar as the average out-of-class object is not a member";
    set(0.01);
    EXPECT_LT(*range.recognised, one_class) << "classes that are queried together share the rate";
    range.high = 0.1;
    set(0.05);
    EXPECT_EQ(*range.recognised, 0.1) << "what is refused is not recognised";
}

using test::ask_class;
using test::class_of;
using test::member_of;
using test::Tower;
using test::tower;

std::vector<WholeObject> usual_towers(const Tower& template_tower) {
    std::vector<WholeObject> members;
    for (const auto& [name, top, width] :
         {std::tuple{"a", 0.9, 1.0}, {"b", 1.0, 1.05}, {"c", 1.1, 0.95}, {"d", 0.95, 1.0}, {"e", 1.05, 1.02}})
        members.push_back(member_of(template_tower, name, 1, top, width));
    return members;
}

TEST(Classify, ObjectsOffTheTemplateAreNotMembers) {
    const Tower template_tower = tower();
    const ShapeClass learnt = class_of(template_tower, usual_towers(template_tower));
    LearntMember object = learn_member(template_tower.known(), member_of(template_tower, "x", 1, 1, 1));
    object.fit.residuals.emplace();
    EXPECT_EQ(compare_with(learnt, object).verdict, Membership::member);
    object.fit.residuals->unmatched = 0.2;
    object.fit.residuals->unexplained = 0.3;
    DeviatingRegion region;
    region.share = 0.3;
    region.part = "2 (top)";
    object.fit.foreign.push_back(region);
    const ClassAnswer class_answer = compare_with(learnt, object);
    EXPECT_EQ(class_answer.verdict, Membership::undecided);
    EXPECT_NE(class_answer.undecided.find("does not lie on it"), std::string::npos) << class_answer.undecided;
    LearntMember elsewhere = object;
    elsewhere.fit.residuals->unmatched = elsewhere.fit.residuals->unexplained = 0.6;
    const ClassAnswer none = compare_with(learnt, elsewhere);
    EXPECT_EQ(none.verdict, Membership::other) << "more than half of both is off";
    ASSERT_FALSE(none.reasons().empty());
    EXPECT_NE(none.reasons().front().find("does not lie on it"), std::string::npos) << none.reasons().front();
    const auto lines = fit_explanation(object.fit);
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_NE(lines[0].find("explains 70 %"), std::string::npos) << lines[0];
    EXPECT_NE(lines[1].find("30 % of its surface"), std::string::npos) << lines[1];
    EXPECT_NE(lines[1].find("2 (top)"), std::string::npos) << lines[1];
    // If the members' own fits are equally far off, it lies on the object; not with the strict option.
    std::vector<LearntMember> members;
    for (const WholeObject& member : usual_towers(template_tower)) {
        members.push_back(learn_member(template_tower.known(), member));
        members.back().fit.residuals.emplace();
        members.back().fit.residuals->unexplained = members.back().fit.residuals->unmatched =
            0.2 + 0.02 * static_cast<double>(members.size());
    }
    const ShapeClass bent = learn_class(template_tower.known(), members);
    ASSERT_TRUE(bent.most_off);
    EXPECT_GT(*bent.most_off, 0.25);
    EXPECT_LE(*bent.most_off, 0.5) << "more than half of both is no member, whatever members do";
    EXPECT_TRUE(compare_with(bent, object).fit_problem.empty());
    ClassifyOptions strict;
    strict.strict = true;
    EXPECT_FALSE(compare_with(bent, object, strict).fit_problem.empty());
}

TEST(Classify, OutOfClassObjectsMakeTheAnswerCautious) {
    const Tower template_tower = tower();
    std::vector<LearntMember> members, near, far;
    for (const WholeObject& member : usual_towers(template_tower))
        members.push_back(learn_member(template_tower.known(), member));
    for (const double top : {1.25, 1.3, 1.35, 1.4})
        near.push_back(learn_member(template_tower.known(), member_of(template_tower, "n", 1, top, 1)));
    for (const double top : {4.0, 4.5, 5.0, 5.5})
        far.push_back(learn_member(template_tower.known(), member_of(template_tower, "f", 1, top, 1)));
    const std::string key = std::string("geometry ") + unlike_the_members;
    const ShapeClass alone = learn_class(template_tower.known(), members),
                     careful = learn_class(template_tower.known(), members, {}, near),
                     sure = learn_class(template_tower.known(), members, {}, far);
    EXPECT_EQ(careful.out_of_class.size(), 4U);
    EXPECT_EQ(alone.find(key)->values, careful.find(key)->values) << "strangers say nothing of what members are";
    EXPECT_LT(*careful.find(key)->recognised, *sure.find(key)->recognised);
    const ClassAnswer class_answer = ask_class(careful, template_tower.known(), member_of(template_tower, "x", 1, 1.2, 1));
    if (class_answer.verdict == Membership::undecided)
        EXPECT_NE(class_answer.undecided.find("4 out-of-class objects"), std::string::npos) << class_answer.undecided;
    else EXPECT_EQ(class_answer.verdict, Membership::other);
}

}  // namespace
}  // namespace ostraka

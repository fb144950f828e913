#include "shape_classes/towers.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/with_points.h"
#include "ostraka/measure/measure.h"
#include "ostraka/shape_classes/class_file.h"
#include "ostraka/shape_classes/propagate.h"
#include "ostraka/shape_classes/thresholds.h"
#include "ostraka/stats/random.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

using test::ask_class;
using test::class_of;
using test::member_of;
using test::Tower;
using test::tower;

Motion far_away() {
    Motion motion;
    motion.rotation = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    motion.translation = Eigen::Vector3d(1000, -2000, 500);
    return motion;
}

/// Two planted modes without rotation, translation or change of size: rows that are orthogonal to the rigid motions to first
/// order.
struct Planted {
    Landmarks mean = Landmarks::Zero(60, 3), first = Landmarks::Zero(60, 3), second = Landmarks::Zero(60, 3);
    Planted() {
        Random random(3);
        for (Eigen::Index i = 0; i < 30; ++i)
            for (int k = 0; k < 3; ++k) mean(i, k) = random.uniform(0.2, 1);
        // Points in mirrored pairs: odd fields have no moment.
        for (Eigen::Index i = 0; i < 30; ++i) mean.row(30 + i) = -mean.row(i);
        for (Eigen::Index i = 0; i < 30; ++i) {
            const double along = random.normal(), across = random.normal();
            first.row(i) << along, 0, 0;
            first.row(30 + i) << along, 0, 0;
            second.row(i) << 0, across, 0;
            second.row(30 + i) << 0, across, 0;
        }
        first.rowwise() -= first.colwise().mean().eval();
        second.rowwise() -= second.colwise().mean().eval();
        first /= first.norm();
        second -= (first.array() * second.array()).sum() * first;
        second /= second.norm();
    }
};

TEST(ShapeModes, PlantedModesAreRecovered) {
    const Planted planted;
    std::vector<Landmarks> members;
    // Coefficients that are uncorrelated: a cross.
    for (const auto& [a, b] : {std::pair{0.3, 0.0}, {-0.3, 0.0}, {0.0, 0.1}, {0.0, -0.1}}) {
        const Motion motion = far_away();
        Landmarks shape = planted.mean + a * planted.first + b * planted.second;
        shape = (shape * motion.rotation.transpose()).rowwise() + motion.translation.transpose();
        members.push_back(shape);
    }
    ModeOptions options;
    options.sizes = true;
    const ShapeModes modes = learn_modes(members, planted.mean, options);
    ASSERT_GE(modes.variances.size(), 2U);
    EXPECT_NEAR(modes.variances[0], 2 * 0.3 * 0.3 / 3, 1e-3);
    EXPECT_NEAR(modes.variances[1], 2 * 0.1 * 0.1 / 3, 1e-3);
    EXPECT_NEAR((modes.mean - planted.mean).norm(), 0, 0.02) << "the mean stands where the frame is";
    const auto projection = [&](Eigen::Index k, const Landmarks& field) {
        double sum = 0;
        for (Eigen::Index i = 0; i < field.rows(); ++i) sum += modes.modes.row(k).segment<3>(3 * i).dot(field.row(i));
        return std::abs(sum);
    };
    EXPECT_GT(projection(0, planted.first), 0.99);
    EXPECT_GT(projection(1, planted.second), 0.99);
    EXPECT_LT((modes.modes * modes.modes.transpose() - Eigen::MatrixXd::Identity(modes.modes.rows(), modes.modes.rows())).norm(),
              1e-9);
    // A shape of the class is given by its coefficients; one off the class is not.
    const ShapeCoordinates inside = coordinates_in(modes, members[0]);
    EXPECT_LT(inside.outside, 1e-6);
    EXPECT_NEAR((landmarks_of(points_of(shape_of(modes, inside.coefficients))) - inside.map.apply(members[0])).norm(), 0, 1e-6);
    Landmarks displaced = members[0];
    displaced(0, 2) += 0.5;
    EXPECT_GT(coordinates_in(modes, displaced).outside, 0.01);
}

TEST(ShapeModes, OneAndEqualMembersHaveNoModes) {
    const Planted planted;
    const ShapeModes single_member = learn_modes({planted.mean}, planted.mean);
    EXPECT_TRUE(single_member.variances.empty());
    EXPECT_TRUE(single_member.left_out_distances.empty());
    const ShapeModes same = learn_modes({planted.mean, 1e6 * planted.mean, planted.mean}, planted.mean);
    EXPECT_TRUE(same.variances.empty()) << "sizes do not count";
    EXPECT_NEAR(same.left_out_distances[1], 0, 1e-7);
    EXPECT_THROW(static_cast<void>(learn_modes({}, planted.mean)), Error);
}

TEST(ShapeModes, ALeftOutMemberIsMeasuredByTheOthers) {
    const Planted planted;
    const std::vector<Landmarks> members{planted.mean + 0.3 * planted.first, planted.mean - 0.3 * planted.first,
                                         planted.mean + 0.1 * planted.first, planted.mean + 0.2 * planted.second};
    ModeOptions options;
    options.sizes = true;
    const ShapeModes modes = learn_modes(members, planted.mean, options);
    // Only the last one has the second field, which is outside the span of the others.
    EXPECT_GT(modes.left_out_outside[3] * modes.mean_size, 0.19);
    EXPECT_LT(modes.left_out_outside[0] * modes.mean_size, 0.05);
}

/// Members whose top is 0.9 to 1.1 of the base.
std::vector<WholeObject> usual(const Tower& template_tower) {
    std::vector<WholeObject> members;
    for (const auto& [name, top, width] :
         {std::tuple{"a", 0.9, 1.0}, {"b", 1.0, 1.05}, {"c", 1.1, 0.95}, {"d", 0.95, 1.0}, {"e", 1.05, 1.02}})
        members.push_back(member_of(template_tower, name, 1, top, width, far_away()));
    return members;
}

std::vector<WholeObject> one_alone(const Tower& template_tower) {
    std::vector<WholeObject> members;
    members.push_back(member_of(template_tower, "a", 1, 0.9, 1));
    return members;
}

TEST(ShapeClass, LearnsTheRangesOfItsMembers) {
    const Tower template_tower = tower();
    const ShapeClass learnt = class_of(template_tower, usual(template_tower));
    const LearntRange* ratio = learnt.find("proportion 7 ");
    ASSERT_NE(ratio, nullptr);
    EXPECT_EQ(ratio->count, 5U);
    EXPECT_NEAR(ratio->min, 0.9, 1e-9);
    EXPECT_NEAR(ratio->max, 1.1, 1e-9);
    EXPECT_NEAR(ratio->median, 1, 1e-9);
    // It is the prediction interval of the logarithms, at its share of the permitted rejection rate.
    std::vector<double> logs;
    for (const double x : {0.9, 1.0, 1.1, 0.95, 1.05}) logs.push_back(std::log(x));
    const PredictionInterval expected = predict(moments_of(logs), false, ratio->reject, learnt.resolution);
    EXPECT_NEAR(*ratio->high, std::exp(expected.high), 1e-5);
    EXPECT_NEAR(*ratio->low, std::exp(expected.low), 1e-5);
    double rate = 0;
    for (const LearntRange& range : learnt.ranges)
        if (range.quantity.kind != QuantityKind::attribute) rate += range.reject;
    EXPECT_NEAR(rate, 0.05, 1e-12) << "all together refuse what was told";
    const LearntRange* height = learnt.find("attribute 2 height");
    ASSERT_NE(height, nullptr);
    EXPECT_NEAR(height->mean, 1, 1e-9) << "heights stay the members' own, wherever they lie";
    EXPECT_EQ(height->quantity.unit, "mm");
    EXPECT_EQ(learnt.modes.distances[learnt.modes.archetype],
              *std::min_element(learnt.modes.distances.begin(), learnt.modes.distances.end()));
}

TEST(Classify, NamesThePlantedProportion) {
    const Tower template_tower = tower();
    const ShapeClass learnt = class_of(template_tower, usual(template_tower));
    const ClassAnswer good = ask_class(learnt, template_tower.known(), member_of(template_tower, "good", 1, 1.02, 1.01));
    EXPECT_EQ(good.verdict, Membership::member) << (good.rejecting_checks.empty() ? "" : good.reasons().front());
    const ClassAnswer bad = ask_class(learnt, template_tower.known(), member_of(template_tower, "bad", 1, 1.6, 1, far_away()));
    ASSERT_EQ(bad.verdict, Membership::other);
    const QuantityCheck& first = bad.checks[bad.rejecting_checks.front()];
    EXPECT_EQ(first.quantity.kind, QuantityKind::proportion);
    EXPECT_EQ(first.quantity.id, 7);
    EXPECT_NEAR(*first.quantity.value, 1.6, 1e-9);
    EXPECT_NEAR(first.distance_from_range, 1.6 - *first.high, 1e-9);
    EXPECT_NE(bad.reasons().front().find("proportion 7"), std::string::npos);
    const Classification decided = decide("bad", {bad});
    EXPECT_EQ(decided.verdict, Membership::other);
    EXPECT_EQ(decided.best, -1);
    EXPECT_EQ(decide("good", {good}).best, 0);
}

TEST(Classify, ReportsWhenItCannotDecide) {
    const Tower template_tower = tower();
    const ShapeClass one_member_class = class_of(template_tower, one_alone(template_tower));
    ASSERT_FALSE(one_member_class.notes.empty());
    const ClassAnswer class_answer = ask_class(one_member_class, template_tower.known(), member_of(template_tower, "x", 1, 1, 1));
    EXPECT_EQ(class_answer.verdict, Membership::undecided);
    const Classification decided = decide("x", {class_answer});
    EXPECT_EQ(decided.text.find("cannot decide, because"), 0U) << decided.text;
    // Of two members, and of members of one shape.
    std::vector<WholeObject> equal;
    equal.push_back(member_of(template_tower, "a", 1, 0.9, 1));
    equal.push_back(member_of(template_tower, "b", 1, 0.9, 1, far_away()));
    const ShapeClass two = class_of(template_tower, equal);
    EXPECT_EQ(ask_class(two, template_tower.known(), member_of(template_tower, "x", 1, 0.9, 1)).verdict, Membership::undecided);
    equal.push_back(member_of(template_tower, "c", 1, 0.9, 1));
    const ShapeClass same = class_of(template_tower, equal);
    EXPECT_NE(same.notes.back().find("the same shape"), std::string::npos) << same.notes.back();
    EXPECT_EQ(ask_class(same, template_tower.known(), member_of(template_tower, "x", 1, 0.9, 1)).verdict, Membership::member);
    EXPECT_EQ(ask_class(same, template_tower.known(), member_of(template_tower, "x", 1, 1.8, 1)).verdict, Membership::other);
    // Two identical classes cannot be distinguished.
    const ShapeClass learnt = class_of(template_tower, usual(template_tower));
    const ClassAnswer yes = ask_class(learnt, template_tower.known(), member_of(template_tower, "x", 1, 1, 1));
    const Classification classification = decide("x", {yes, yes});
    EXPECT_EQ(classification.verdict, Membership::undecided) << classification.text;
    EXPECT_THROW(static_cast<void>(decide("x", {})), Error);
    EXPECT_THROW(static_cast<void>(class_of(template_tower, {})), Error);
}

/// The nearest member to the mean of all was fitted badly.
TEST(ShapeClass, BadFitsAreReportedAndCannotBeTheArchetype) {
    const Tower template_tower = tower();
    std::vector<LearntMember> members;
    for (const WholeObject& member : usual(template_tower)) members.push_back(learn_member(template_tower.known(), member));
    const ShapeClass original_class = learn_class(template_tower.known(), members);
    const std::size_t nearest = original_class.modes.archetype;
    LearntMember& bad = members[nearest];
    bad.fit.residuals.emplace();
    bad.fit.residuals->unmatched = 0.4;
    const ShapeClass noted = learn_class(template_tower.known(), members);
    EXPECT_EQ(noted.members.size(), members.size());
    EXPECT_NE(noted.modes.archetype, nearest);
    const auto has_note = [&](const ShapeClass& learnt, const std::string& words) {
        return std::any_of(learnt.notes.begin(), learnt.notes.end(), [&](const std::string& note) {
            return note.starts_with(bad.name + " ") && note.find(words) != std::string::npos;
        });
    };
    EXPECT_TRUE(has_note(noted, "cannot be the archetype"));
    bad.fit.residuals->unexplained = 1;
    const ShapeClass without = learn_class(template_tower.known(), members);
    EXPECT_EQ(without.members.size(), members.size() - 1);
    EXPECT_TRUE(has_note(without, "is left out"));
    // A member without volume: missing quantities are reported.
    bad.fit.residuals.reset();
    for (ClassQuantity& quantity : bad.quantities)
        if (quantity.name == "compactness") quantity.value.reset();
    const ShapeClass flat = learn_class(template_tower.known(), members);
    EXPECT_NE(flat.modes.archetype, nearest);
    EXPECT_TRUE(has_note(flat, "no volume"));
}

TEST(ShapeClass, NonNegativeQuantitiesAreNotAcceptedBelowZero) {
    const Tower template_tower = tower();
    std::vector<LearntMember> members;
    for (const WholeObject& member : usual(template_tower)) members.push_back(learn_member(template_tower.known(), member));
    double value = 0;  // one of them zero: no logarithm
    for (LearntMember& member : members)
        for (ClassQuantity& quantity : member.quantities)
            if (quantity.kind == QuantityKind::proportion) quantity.value = value, value += 0.1;
    const ShapeClass learnt = learn_class(template_tower.known(), members);
    const LearntRange* range = learnt.find("proportion 7 ");
    ASSERT_NE(range, nullptr);
    ASSERT_TRUE(range->low.has_value());
    EXPECT_EQ(*range->low, 0);
}

TEST(Classify, ErrorsOfTheFitDoNotRejectAnObject) {
    const Tower template_tower = tower();
    const ShapeClass learnt = class_of(template_tower, usual(template_tower));
    LearntMember object = learn_member(template_tower.known(), member_of(template_tower, "x", 1, 1, 1));
    ASSERT_EQ(compare_with(learnt, object).verdict, Membership::member);
    // Vertices that slid along the surface: all other quantities are unchanged.
    Random random(7);
    for (Point& p : object.fit.points) p = Point(p.x() + random.uniform(-0.2, 0.2), p.y() + random.uniform(-0.2, 0.2), p.z());
    EXPECT_EQ(compare_with(learnt, object).verdict, Membership::other) << "in correspondence the vertices are what is compared";
    object.fit.residuals.emplace();
    const ClassAnswer class_answer = compare_with(learnt, object);
    EXPECT_EQ(class_answer.verdict, Membership::undecided);
    EXPECT_NE(class_answer.undecided.find("this object was fitted"), std::string::npos) << class_answer.undecided;
}

TEST(Classify, WithoutConstraintsGeometryDecidesWithANote) {
    Tower template_tower = tower();
    template_tower.graph.relationships.clear();
    const ShapeClass learnt = class_of(template_tower, usual(template_tower));
    EXPECT_NE(std::find_if(learnt.notes.begin(), learnt.notes.end(),
                           [](const std::string& note) { return note.find("no constraint") != std::string::npos; }),
              learnt.notes.end());
    const ClassAnswer bad = ask_class(learnt, template_tower.known(), member_of(template_tower, "bad", 1, 4, 1));
    ASSERT_EQ(bad.verdict, Membership::other);
    for (const std::size_t i : bad.rejecting_checks)
        EXPECT_TRUE(bad.checks[i].quantity.kind == QuantityKind::geometry || bad.checks[i].quantity.kind == QuantityKind::part);
}

TEST(Classify, SizesCountIfRequested) {
    const Tower template_tower = tower();
    Motion large;
    large.scale = 3;
    const WholeObject big = member_of(template_tower, "big", 1, 1, 1, large);
    EXPECT_EQ(ask_class(class_of(template_tower, usual(template_tower)), template_tower.known(), big).verdict,
              Membership::member);
    LearnOptions options;
    options.modes.sizes = true;
    EXPECT_EQ(ask_class(class_of(template_tower, usual(template_tower), options), template_tower.known(), big).verdict,
              Membership::other);
}

TEST(MemberFit, FitsATowerWithOtherTrianglesAndTransfersAnnotations) {
    const Tower template_tower = tower();
    Motion shifted;
    shifted.translation = Eigen::Vector3d(10, -20, 5);
    WholeObject object = member_of(template_tower, "object", 0.5, 0.6, 0.95, shifted);
    // Other vertices: the box cut finer.
    TriangleSoup refined = to_soup(member_of(template_tower, "same", 0.5, 0.6, 0.95, shifted).mesh);
    const std::size_t coarse_triangles = refined.triangles.size();
    for (std::size_t t = 0; t < coarse_triangles; ++t) {
        const auto c = refined.triangles[t];
        std::array<double, 3> middle{};
        for (const Index v : c)
            for (std::size_t k = 0; k < 3; ++k) middle[k] += refined.points[v][k] / 3;
        const auto m = static_cast<Index>(refined.points.size());
        refined.points.push_back(middle);
        refined.triangles[t] = {c[0], c[1], m};
        refined.triangles.push_back({c[1], c[2], m});
        refined.triangles.push_back({c[2], c[0], m});
    }
    object.mesh = build_mesh(refined);
    EXPECT_FALSE(in_correspondence(template_tower.mesh, object.mesh));
    EXPECT_THROW(static_cast<void>(member_in_correspondence(template_tower.mesh, object)), Error);
    const MemberFit fit = fit_member(template_tower, object);
    ASSERT_TRUE(fit.problem.empty()) << fit.problem;
    ASSERT_TRUE(fit.residuals.has_value());
    EXPECT_LT(fit.residuals->distance, 0.01);
    EXPECT_LT(fit.residuals->unexplained, 0.2);
    const Propagated carried = propagate(template_tower.known(), object);
    ASSERT_TRUE(carried.on_member.has_value());
    double area = 0;
    for (const Annotation& annotation : carried.on_member->annotations) {
        ASSERT_EQ(annotation.type, AnnotationType::region) << annotation.tag;
        for (const Index f : annotation.faces) area += face_area(object.mesh, Face(f));
    }
    EXPECT_NEAR(area / surface_area(object.mesh), 1, 0.15) << "the two halves cover it";
}

TEST(MemberFit, AHollowMemberIsMeasuredAsASolidOne) {
    // An inner surface of half the size, oriented inwards: a fifth of the surface.
    const Tower template_tower = tower();
    const WholeObject solid = member_of(template_tower, "solid", 0.5, 0.6, 0.95);
    WholeObject hollow = solid;
    TriangleSoup soup = to_soup(solid.mesh);
    const std::size_t points = soup.points.size(), faces = soup.triangles.size();
    std::array<double, 3> middle{};
    for (const auto& p : soup.points)
        for (std::size_t k = 0; k < 3; ++k) middle[k] += p[k] / static_cast<double>(points);
    for (std::size_t i = 0; i < points; ++i) {
        std::array<double, 3> p = soup.points[i];
        for (std::size_t k = 0; k < 3; ++k) p[k] = middle[k] + 0.5 * (p[k] - middle[k]);
        soup.points.push_back(p);
    }
    for (std::size_t t = 0; t < faces; ++t) {
        const auto [a, b, c] = soup.triangles[t];
        const auto n = static_cast<Index>(points);
        soup.triangles.push_back({n + a, n + c, n + b});
    }
    hollow.mesh = build_mesh(soup);
    LearnOptions options;
    options.correspondence = CorrespondenceChoice::fitted;
    const LearntMember solid_member = learn_member(template_tower.known(), solid, options),
                       hollow_member = learn_member(template_tower.known(), hollow, options);
    EXPECT_EQ(solid_member.fit.cavity, 0);
    EXPECT_EQ(solid_member.fit.outer, nullptr);
    EXPECT_NEAR(hollow_member.fit.cavity, 0.2, 0.01);
    ASSERT_TRUE(hollow_member.fit.residuals.has_value());
    EXPECT_LT(hollow_member.fit.residuals->unexplained, 0.02);
    const auto value = [](const LearntMember& member, const std::string& name) {
        for (const ClassQuantity& quantity : member.quantities)
            if (quantity.name == name) return quantity.value.value_or(-1);
        return -2.0;
    };
    for (const char* name : {"compactness", "share of the hull", "thickness mean"}) {
        EXPECT_GT(value(solid_member, name), 0) << name;
        EXPECT_NEAR(value(hollow_member, name), value(solid_member, name), 1e-3) << name;
    }
    EXPECT_NE(fit_explanation(hollow_member.fit)[1].find("it is hollow: 20"), std::string::npos);
}

TEST(MemberFit, DistortionMatchesTheMap) {
    const Tower template_tower = tower();
    const WholeObject wide = member_of(template_tower, "wide", 1, 1, 2);
    std::vector<Point> points(wide.mesh.points().begin(), wide.mesh.points().end());
    FitResiduals residuals;
    measure_distortion(template_tower.mesh, points, 2, residuals);
    EXPECT_NEAR(residuals.stretch, 0, 1e-9) << "twice as large is the template's scale";
    EXPECT_NEAR(residuals.bend, 0, 1e-6);
    measure_distortion(template_tower.mesh, points, 1, residuals);
    EXPECT_NEAR(residuals.stretch, std::log(2.0), 1e-9);
}

TEST(ClassSample, SatisfiesTheConstraintsAndTheRanges) {
    const Tower template_tower = tower();
    const ShapeClass learnt = class_of(template_tower, usual(template_tower));
    SampleOptions options;
    options.count = 5;
    const Sampling sampling = sample_class(learnt, template_tower.known(), options);
    ASSERT_EQ(sampling.samples.size(), 5U) << (sampling.examples.empty() ? "" : sampling.examples.front());
    const LearntRange* ratio = learnt.find("proportion 7 ");
    for (const ClassSample& sample : sampling.samples) {
        const Mesh mesh = with_points(template_tower.mesh, sample.points);
        const double top = evaluate(mesh, template_tower.annotations.annotations[1],
                                    *template_tower.annotations.annotations[1].attributes[0].measure());
        const double base = evaluate(mesh, template_tower.annotations.annotations[0],
                                     *template_tower.annotations.annotations[0].attributes[0].measure());
        EXPECT_GE(top / base, *ratio->low);
        EXPECT_LE(top / base, *ratio->high);
        WholeObject object{{mesh, {}}, "sample"};
        EXPECT_EQ(compare_with(learnt, learn_member(template_tower.known(), object)).rejecting_checks.empty(), true);
    }
    EXPECT_GT(sampling.diversity, 0);
    // Repeated, the result is the same to the bit; another seed gives others.
    const Sampling second_sampling = sample_class(learnt, template_tower.known(), options);
    EXPECT_EQ(second_sampling.samples[3].points, sampling.samples[3].points);
    options.seed = 2;
    EXPECT_NE(sample_class(learnt, template_tower.known(), options).samples[0].points, sampling.samples[0].points);
}

TEST(ClassSample, RestoresAStatedProportionOrRejects) {
    // The template allows 1.02 at most, its members have up to 1.1: draws beyond are brought back.
    const Tower template_tower = tower(1.02);
    const ShapeClass learnt = class_of(template_tower, usual(template_tower));
    SampleOptions options;
    options.count = 4;
    options.seed = 5;
    const Sampling sampling = sample_class(learnt, template_tower.known(), options);
    for (const ClassSample& sample : sampling.samples) {
        const Mesh mesh = with_points(template_tower.mesh, in_template_frame(template_tower.mesh, sample.points, false));
        const double top = evaluate(mesh, template_tower.annotations.annotations[1],
                                    *template_tower.annotations.annotations[1].attributes[0].measure());
        const double base = evaluate(mesh, template_tower.annotations.annotations[0],
                                     *template_tower.annotations.annotations[0].attributes[0].measure());
        EXPECT_LE(top / base, 1.02 * 1.001 + 1e-3);
    }
    EXPECT_EQ(sampling.tried, sampling.samples.size() + sampling.by_constraints + sampling.by_ranges + sampling.by_intersections);
}

TEST(ClassSample, DiversityIsTheMeanPairwiseDistance) {
    const Tower template_tower = tower();
    const ShapeClass learnt = class_of(template_tower, usual(template_tower));
    const ShapeModes& modes = learnt.modes;
    // Along one mode by +-a and 0: pairwise distances 2a, a and a, for any position and size.
    const double a = 1e-4 * modes.mean_size;
    std::vector<Landmarks> shapes;
    for (const double b : {a, -a, 0.0}) {
        const Landmarks shape = shape_of(modes, {b});
        const Motion motion = far_away();
        shapes.push_back(shapes.size() == 1
                             ? Landmarks((3 * shape * motion.rotation.transpose()).rowwise() + motion.translation.transpose())
                             : shape);
    }
    EXPECT_NEAR(mean_distance(modes, shapes) / (4.0 / 3 * 1e-4), 1, 1e-3);
    EXPECT_NEAR(mean_distance(modes, {shapes[0], shapes[0]}), 0, 1e-12) << "equal ones have none";
    EXPECT_EQ(mean_distance(modes, {shapes[0]}), 0);
    // Without spread all draws are the mean; with more they differ more.
    SampleOptions options;
    options.count = 4;
    options.attempts = 50;
    options.spread = 0;
    EXPECT_NEAR(sample_class(learnt, template_tower.known(), options).diversity, 0, 1e-9);
    options.spread = 0.3;
    const double small_diversity = sample_class(learnt, template_tower.known(), options).diversity;
    options.spread = 1;
    const Sampling wide = sample_class(learnt, template_tower.known(), options);
    EXPECT_GT(small_diversity, 0);
    EXPECT_GT(wide.diversity, small_diversity);
    std::vector<Landmarks> drawn;
    for (const ClassSample& sample : wide.samples) drawn.push_back(landmarks_of(sample.points));
    EXPECT_EQ(wide.diversity, mean_distance(modes, drawn)) << "it is that of what is written";
}

TEST(ClassSample, EditsAndBadInput) {
    const Tower template_tower = tower();
    const ShapeClass learnt = class_of(template_tower, usual(template_tower));
    SampleOptions options;
    options.count = 2;
    options.by = SampleOptions::Way::edits;
    options.edit = 0.02;
    const Sampling sampling = sample_class(learnt, template_tower.known(), options);
    EXPECT_GT(sampling.tried, 0U);
    for (const ClassSample& sample : sampling.samples) EXPECT_FALSE(sample.edits.empty());
    options.by = SampleOptions::Way::modes;
    EXPECT_THROW(
        static_cast<void>(sample_class(class_of(template_tower, one_alone(template_tower)), template_tower.known(), options)),
        Error);
}

TEST(ClassFile, ComesBackAsWritten) {
    const test::Scratch scratch;
    const Tower template_tower = tower();
    ShapeClass learnt = class_of(template_tower, usual(template_tower));
    learnt.template_file = "tower.template.json";
    write_class(scratch.path(), learnt, Provenance{"test", {}, {}});
    const ShapeClass read = read_class(scratch / "tower.class.json");
    EXPECT_EQ(read.modes.modes, learnt.modes.modes);
    EXPECT_EQ(read.modes.mean, learnt.modes.mean);
    EXPECT_EQ(read.modes.coefficients, learnt.modes.coefficients);
    ASSERT_EQ(read.ranges.size(), learnt.ranges.size());
    for (std::size_t i = 0; i < read.ranges.size(); ++i) {
        EXPECT_EQ(read.ranges[i].quantity.key(), learnt.ranges[i].quantity.key());
        EXPECT_EQ(read.ranges[i].high, learnt.ranges[i].high);
        EXPECT_EQ(read.ranges[i].values, learnt.ranges[i].values);
    }
    const WholeObject object = member_of(template_tower, "bad", 1, 1.6, 1);
    EXPECT_EQ(ask_class(read, template_tower.known(), object).reasons(),
              ask_class(learnt, template_tower.known(), object).reasons());
    // A modified class file is refused.
    const auto refused = [&](const ShapeClass& changed) {
        write_class(scratch.path(), changed, Provenance{"test", {}, {}});
        EXPECT_THROW(static_cast<void>(read_class(scratch / "tower.class.json")), Error);
    };
    ShapeClass changed = learnt;
    changed.modes.mean *= 1e300;
    refused(changed);
    changed = learnt;
    changed.modes.modes.row(0) *= 2;
    refused(changed);
    changed = learnt;
    changed.modes.coefficients(0, 0) = 1e300;
    refused(changed);
    changed = learnt;
    changed.modes.variances[0] *= 3;
    refused(changed);
    write_class(scratch.path(), learnt, Provenance{"test", {}, {}});
    std::string text = read_file(scratch / "tower.class.json");
    const std::string archetype = "\"archetype\": \"" + learnt.members[learnt.modes.archetype].name + "\"";
    const std::size_t at = text.find(archetype);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, archetype.size(), "\"archetype\": \"nobody\"");
    write_file(scratch / "tower.class.json", text);
    EXPECT_THROW(static_cast<void>(read_class(scratch / "tower.class.json")), Error);
    write_class(scratch.path(), learnt, Provenance{"test", {}, {}});
    EXPECT_EQ(read_class(scratch / "tower.class.json").modes.archetype, learnt.modes.archetype);
    std::filesystem::remove(scratch / "tower.modes.npy");
    EXPECT_THROW(static_cast<void>(read_class(scratch / "tower.class.json")), Error);
    learnt.name = "../up";
    EXPECT_THROW(write_class(scratch.path(), learnt, Provenance{"test", {}, {}}), Error);
}

}  // namespace
}  // namespace ostraka

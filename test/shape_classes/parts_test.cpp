#include "shape_classes/parts.h"

#include "shape_classes/towers.h"

#include "ostraka/stats/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

using test::ask_class;
using test::class_of;
using test::member_of;
using test::Tower;
using test::tower;

std::vector<Point> points_in(const Mesh& mesh) { return {mesh.points().begin(), mesh.points().end()}; }

double value_of(const std::vector<ClassQuantity>& quantities, int id, const std::string& name) {
    for (const ClassQuantity& quantity : quantities)
        if (quantity.id == id && quantity.name == name) return quantity.value.value_or(-1);
    ADD_FAILURE() << name << " of " << id << " is not there";
    return -1;
}

TEST(Parts, OfATowerMatchTwoOpenBoxes) {
    // Each half is a box 1 x 1 x 1/2 without one of its square faces: area 1 + 4/2 of 6 in all.
    const Tower template_tower = tower();
    const auto quantities = part_quantities(template_tower.known(), points_in(template_tower.mesh));
    const double side = std::sqrt(6.0);
    EXPECT_NEAR(value_of(quantities, 1, "share of the surface"), 0.5, 1e-12);
    // Along x: the square and the two sides across y have 1/12 each, the two sides across x lie at +- 1/2.
    const double variance = ((1 + 1) * (1.0 / 12) + 1 * 0.25) / 3;
    EXPECT_NEAR(value_of(quantities, 1, "length"), std::sqrt(12 * variance) / side, 1e-12);
    EXPECT_NEAR(value_of(quantities, 1, "width"), value_of(quantities, 1, "length"), 1e-12);
    // Centroid of a half along z: (1 * 0 + 2 * 1/4) / 3 = 1/6 from its outer end, so 1/3 from the middle.
    EXPECT_NEAR(value_of(quantities, 2, "distance from the middle"), 1.0 / 3 / side, 1e-12);
    EXPECT_NEAR(value_of(quantities, 1, "distance to 2 (top)"), 2.0 / 3 / side, 1e-12);
}

TEST(Parts, AreInvariantUnderPositionAndSize) {
    const Tower template_tower = tower();
    Motion motion;
    motion.rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
    for (const double scale : {1e-6, 1.0, 1e6}) {
        motion.scale = scale;
        motion.translation = scale * Eigen::Vector3d(1000, 2000, -500);
        const auto original =
                       part_quantities(template_tower.known(), points_in(member_of(template_tower, "a", 1, 0.8, 1.1).mesh)),
                   moved = part_quantities(template_tower.known(),
                                           points_in(member_of(template_tower, "a", 1, 0.8, 1.1, motion).mesh));
        ASSERT_EQ(original.size(), moved.size());
        for (std::size_t i = 0; i < original.size(); ++i)
            EXPECT_NEAR(*original[i].value, *moved[i].value, 1e-8) << original[i].text();
    }
}

TEST(Parts, RegionsOfTheMemberReplaceTheirCounterparts) {
    const Tower template_tower = tower();
    WholeObject member = member_of(template_tower, "a", 1, 1, 1);
    EXPECT_FALSE(own_disagreement(template_tower.known(), points_in(template_tower.mesh), member).has_value()) << "it has none";
    // Its own parts meet one cell higher, with other names and ids.
    Annotation low, high;
    low.id = 40;
    high.id = 41;
    for (const Face face : member.mesh.faces())
        (centroid(member.mesh, face).z() < 4.0 / 3 ? low : high).faces.push_back(face.idx());
    member.annotations.annotations = {low, high};
    const auto own_quantities = part_quantities(template_tower.known(), points_in(template_tower.mesh), &member);
    double area = 0;
    for (const Index f : high.faces) area += face_area(member.mesh, Face(f));
    EXPECT_NEAR(value_of(own_quantities, 2, "share of the surface"), area / surface_area(member.mesh), 1e-12);
    const auto disagreement = own_disagreement(template_tower.known(), points_in(member.mesh), member);
    ASSERT_TRUE(disagreement.has_value());
    EXPECT_GT(*disagreement, 0.1);
    EXPECT_LT(*disagreement, 0.8);
    // The template's own parts agree in full, and cells at random by no more than chance.
    member.annotations.annotations = template_tower.annotations.annotations;
    EXPECT_NEAR(own_disagreement(template_tower.known(), points_in(member.mesh), member).value_or(9), 0, 1e-12);
    Random random(5);
    low.faces.clear();
    high.faces.clear();
    for (const Face face : member.mesh.faces()) (random.uniform() < 0.5 ? low : high).faces.push_back(face.idx());
    member.annotations.annotations = {low, high};
    EXPECT_NEAR(own_disagreement(template_tower.known(), points_in(member.mesh), member).value_or(9), 1, 0.1);
}

TEST(Parts, NumberedPartsAreMatchedByPosition) {
    Tower template_tower = tower();
    template_tower.graph.relationships.clear();
    Tower other = tower();
    // Corners, so that the orientation is known.
    for (const auto& [tag, x, y, z] : {std::tuple{"a", 0., 0., 0.}, {"b", 1., 0., 0.}, {"c", 0., 1., 0.}, {"d", 0., 0., 1.}})
        for (const Vertex v : template_tower.mesh.vertices())
            if (CGAL::squared_distance(template_tower.mesh.point(v), Point(x, y, z)) < 1e-12) {
                Annotation corner;
                corner.id = 10 + static_cast<int>(template_tower.annotations.annotations.size());
                corner.tag = tag;
                corner.type = AnnotationType::point;
                corner.points = {v.idx()};
                template_tower.annotations.annotations.push_back(corner);
                other.annotations.annotations.push_back(corner);
            }
    // One numbers from below, the other from above.
    template_tower.annotations.annotations[0].tag = "part 0";
    template_tower.annotations.annotations[1].tag = "part 1";
    WholeObject object = member_of(other, "object", 1, 0.5, 1);
    object.annotations = other.annotations;
    object.annotations.annotations[0].tag = "part 1";
    object.annotations.annotations[1].tag = "part 0";
    const MemberFit fit = fit_member(template_tower, object);
    ASSERT_TRUE(fit.problem.empty()) << fit.problem;
    EXPECT_TRUE(std::any_of(fit.notes.begin(), fit.notes.end(),
                            [](const std::string& note) { return note.find("'part' are numbered") != std::string::npos; }));
    EXPECT_EQ(fit.placed_by, "landmarks");
    EXPECT_LT(fit.residuals->off(), 0.1);
    // The same as with distinguishing tags; exchanged tags are trusted.
    const auto with_tags = [&](const std::string& low, const std::string& high) {
        template_tower.annotations.annotations[0].tag = "base";
        template_tower.annotations.annotations[1].tag = "top";
        object.annotations.annotations[0].tag = low;
        object.annotations.annotations[1].tag = high;
        return fit_member(template_tower, object);
    };
    const MemberFit words = with_tags("base", "top");
    EXPECT_TRUE(words.notes.empty());
    EXPECT_EQ(fit.points, words.points);
    EXPECT_NE(fit.points, with_tags("top", "base").points);
}

TEST(Parts, ThePartWithTheLargestDeviationIsNamed) {
    const std::vector<std::optional<double>> values{1.0, 4.0, std::nullopt, 0.5, 3.0}, expected{1.0, 2.0, 1.0, 1.0, std::nullopt};
    const PartsDeviation deviation = parts_deviation(values, expected);
    EXPECT_EQ(deviation.count, 3U);
    EXPECT_EQ(deviation.worst, 1U) << "of two that are equally far off the first";
    EXPECT_NEAR(deviation.off, std::log(2.0) * std::sqrt(2.0 / 3), 1e-12);
    EXPECT_EQ(parts_deviation({}, {}).count, 0U);

    Tower template_tower = tower();
    template_tower.graph.relationships.clear();  // no constraints: the parts decide
    std::vector<WholeObject> members;
    for (const auto& [name, top] : {std::pair{"a", 0.98}, {"b", 1.0}, {"c", 1.02}, {"d", 1.01}, {"e", 0.99}})
        members.push_back(member_of(template_tower, name, 1, top, 1));
    const ShapeClass learnt = class_of(template_tower, members);
    const ClassAnswer bad = ask_class(learnt, template_tower.known(), member_of(template_tower, "bad", 1, 2.5, 1));
    ASSERT_EQ(bad.verdict, Membership::other);
    const QuantityCheck& first = bad.checks[bad.rejecting_checks.front()];
    EXPECT_EQ(first.quantity.kind, QuantityKind::part);
    EXPECT_NE(first.worst.find("of part "), std::string::npos) << first.worst;
    EXPECT_NE(bad.reasons().front().find("times the members' mean"), std::string::npos) << bad.reasons().front();
}

}  // namespace
}  // namespace ostraka

// Constraints judged on an object as it is: every type against quantities computed from positions.
#include "constraint_bench.h"
#include "ostraka/geom/with_points.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/semantic/measure_constraints.h"
#include "scratch.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

std::vector<Case> axes_and_places() {
    const double length = 0.01 * bench().diagonal();
    const auto angle_to = [](int id, const Vector3d& way) {
        return [=](const Places& p) { return degrees(bench().axis(p, id), way); };
    };
    const auto apart = [](auto height) { return [=](const Places& p) { return std::abs(height(p, a) - height(p, b)); }; };
    const auto mean_height = [](const Places& p, int id) { return bench().middle(p, id).z(); };
    const auto base_height = [](const Places& p, int id) { return bench().end(p, id, false).z(); };
    const auto between = [](int first_part, int other, double right) {
        return [=](const Places& p) { return std::abs(right - degrees(bench().axis(p, first_part), bench().axis(p, other))); };
    };
    // The ring between the halves of the first cylinder.
    const auto tilt = [](const Places& p) {
        return degrees(
            (bench().point(p, ring, 0) - bench().point(p, ring, 2)).cross(bench().point(p, ring, 1) - bench().point(p, ring, 3)),
            z);
    };
    const auto off_axis = [](const Places& p) {
        const Vector3d way = bench().axis(p, a), from = bench().end(p, a, false);
        const Vector3d other = bench().axis(p, above), end_point = bench().end(p, above, false);
        return std::max(way.cross(bench().middle(p, above) - from).norm(), other.cross(bench().middle(p, a) - end_point).norm());
    };
    return {
        {"parallel axes", {b, a}, "{}", rotated(b, y), {0, 3, 30}, between(b, a, 0), 5},
        {"perpendicular axes", {lying, a}, "{}", rotated(lying, y), {0, 3, 30}, between(lying, a, 90), 5},
        {"co-axiality", {above, a}, "{}", moved(above, x), {0, 0.1, 2}, off_axis, length, false, false},
        {"structural continuity", {above, a}, "{}", rotated(above, y), {0, 3, 30}, between(above, a, 0), 5, false, false},
        {"keep direction", {b}, R"({"angle": 0})", rotated(b, y), {0, 3, 30}, angle_to(b, z), 5},
        {"keep direction", {b}, "{}", rotated(b, y), {0, 3, 30}, angle_to(b, z), 5, true},
        {"keep position",
         {b},
         R"({"point": [10, 0, 3]})",
         moved(b, x),
         {0, 0.1, 2},
         [](const Places& p) { return (bench().middle(p, b) - Vector3d(10, 0, 3)).norm(); },
         length},
        {"keep position",
         {b},
         "{}",
         moved(b, x),
         {0, 0.1, 2},
         [](const Places& p) { return (bench().middle(p, b) - Vector3d(10, 0, 3)).norm(); },
         length,
         true},
        {"same level", {a, b}, "{}", moved(b, z), {0, 0.1, 2}, apart(mean_height), length},
        {"same level",
         {a, b},
         R"({"reference": "base", "shapes": "free"})",
         stretched(b, z),
         {0, 0.03, 0.5},
         apart(base_height),
         length},
        {"same level", {a, b}, R"({"reference": "vertex"})", moved(b, z), {0, 0.1, 2}, apart(mean_height), length},
        {"same level", {a, b}, R"({"heights": "rest"})", moved(b, z), {0, 0.1, 2}, apart(mean_height), length, true},
        {"mirror symmetry",
         {a, b},
         R"({"point": [5, 0, 0], "direction": [1, 0, 0]})",
         moved(b, x),
         {0, 0.1, 3},
         [](const Places& p) { return std::abs(bench().middle(p, a).x() + bench().middle(p, b).x() - 10); },
         length,
         false,
         false},
        {"mirror symmetry",
         {a, b},
         "{}",
         stretched(b, all),
         {0, 0.02, 0.8},
         [](const Places& p) { return std::abs(bench().length(p, a) - bench().length(p, b)) / 2; },
         length,
         false,
         false},
        {"adjacency",
         {a, neighbour},
         "{}",
         moved(neighbour, y),
         {0, 0.1, 2},
         [](const Places& p) {
             double gap = 1e300;
             for (const Index v : bench().vertices(a))
                 for (const Index w : bench().vertices(neighbour)) gap = std::min(gap, (p[v] - p[w]).norm());
             return gap;
         },
         length},
        {"horizontal support", {a_lower, a_upper}, "{}", rotated(a, y), {0, 10, 50}, tilt, 20},
        {"side contact",
         {a_lower, a_upper},
         "{}",
         rotated(a, y, 90),
         {0, 10, 50},
         [=](const Places& p) { return 90 - tilt(p); },
         20},
        {"co-planarity",
         {sheet},
         "{}",
         each(sheet, [](const Vector3d& d, double wrong) -> Vector3d { return d + wrong * (d.x() * d.x() - 0.5) * z; }),
         {0, 0.1, 1.2},
         [](const Places& p) {
             double sum = 0;
             const auto list = bench().vertices(sheet);
             const double level = bench().middle(p, sheet).z();
             for (const Index v : list) sum += std::pow(p[v].z() - level, 2);
             return std::sqrt(sum / static_cast<double>(list.size()));
         },
         length},
        {"co-linearity",
         {a_line},
         "{}",
         each(a_line, [](const Vector3d& d, double wrong) -> Vector3d { return d + wrong * (d.z() * d.z() / 9 - 0.4) * x; }),
         {0, 0.2, 3},
         [](const Places& p) {
             double sum = 0;
             const auto list = bench().vertices(a_line);
             const double across = bench().middle(p, a_line).x();
             for (const Index v : list) sum += std::pow(p[v].x() - across, 2);
             return std::sqrt(sum / static_cast<double>(list.size()));
         },
         length},
    };
}

std::vector<Case> measures_and_shapes() {
    const auto height = [](const Places& p) { return bench().height(p, b); };
    const auto off_mean = [](const Places& p) {
        const double first_height = bench().height(p, a), second_height = bench().height(p, b);
        return 100 * (std::max(first_height, second_height) / ((first_height + second_height) / 2) - 1);
    };
    const auto out_of = [](double value, double low, double high) {
        return value < low ? 100 * (low - value) / low : value > high ? 100 * (value - high) / high : 0;
    };
    return {
        {"keep measure",
         {b},
         R"({"measure": "height", "minValue": 5.5, "maxValue": 6.5})",
         stretched(b, z),
         {0, 0.05, 0.7},
         [=](const Places& p) { return out_of(height(p), 5.5, 6.5); },
         0.1},
        {"keep measure",
         {b},
         R"({"measure": "height"})",
         stretched(b, z),
         {0, 0.0005, 0.7},
         [=](const Places& p) { return out_of(height(p), 6, 6); },
         0.1,
         true},
        {"proportion",
         {b, a},
         R"({"measure1": "height", "measure2": "height", "minValue": 0.9, "maxValue": 1.1})",
         stretched(b, z),
         {0, 0.05, 0.7},
         [=](const Places& p) { return out_of(height(p) / bench().height(p, a), 0.9, 1.1); },
         0.1},
        {"proportion",
         {b, a},
         R"({"measure1": "height", "measure2": "height"})",
         stretched(b, z),
         {0, 0.0005, 0.7},
         [=](const Places& p) { return out_of(height(p) / bench().height(p, a), 1, 1); },
         0.1,
         true},
        {"same measure", {a, b}, R"({"measure": "height"})", stretched(b, z), {0, 0.1, 0.7}, off_mean, 10},
        {"equal attributes", {a, b}, R"({"measure": "height"})", stretched(b, z), {0, 0.1, 0.7}, off_mean, 10},
        {"same length", {a_line, b_line}, "{}", stretched(b, z), {0, 0.1, 0.7}, off_mean, 10},
        {"part similarity",
         {a, b},
         "{}",
         stretched(b, all),
         {0, 0.02, 0.5},
         [](const Places& p) {
             return 100 * (1 - std::pow(std::min(bench().length(p, a) / bench().length(p, b),
                                                 bench().length(p, b) / bench().length(p, a)),
                                        2));
         },
         10},
        {"keep shape", {b}, "{}", stretched(b, z), {0, 0.01, 0.5}, [](const Places& p) { return changed(p, b); }, 2, true, false},
        {"keep shape",
         {b},
         R"({"mode": "similar"})",
         stretched(b, z),
         {0, 0.01, 0.5},
         [](const Places& p) { return changed(p, b); },
         2,
         true,
         false},
        {"rigid", {b}, "{}", stretched(b, z), {0, 0.005, 0.5}, [](const Places& p) { return changed(p, b); }, 2, true, false},
        {"similarity",
         {b},
         "{}",
         stretched(b, z),
         {0, 0.005, 0.5},
         [](const Places& p) { return changed(p, b); },
         2,
         true,
         false},
        {"non-uniform scaling",
         {b},
         R"({"direction": [0, 0, 1]})",
         stretched(b, x),
         {0, 0.01, 0.9},
         [](const Places& p) { return changed(p, b); },
         2,
         true,
         false},
        {"closeness",
         {ring},
         "{}",
         moved(ring, x),
         {0, 0.01, 1},
         [=](const Places& p) { return (bench().middle(p, ring) - Vector3d(0, 0, 3)).norm(); },
         0.05,
         true,
         false},
    };
}

std::vector<Case> kinds_of_the_solver() {
    // Deviation of a few points, in per cent of their size; 2 % and more is far beyond the tolerance of 1 % of a residual.
    const Shape out = pulled(ring, 0, x), up = pulled(ring, 0, z);
    const auto lifted = [](const Places& p) {
        return 100 *
               std::abs(
                   (bench().point(p, ring, 0) + bench().point(p, ring, 2) - bench().point(p, ring, 1) - bench().point(p, ring, 3))
                       .z()) /
               2;
    };
    const auto sides = [](const Places& p) { return sides_differ(p, ring); };
    const auto diagonals = [](const Places& p) {
        return std::abs(90 - degrees(bench().point(p, cross, 1) - bench().point(p, cross, 0),
                                     bench().point(p, cross, 3) - bench().point(p, cross, 2)));
    };
    const auto parallel = [](const Places& p) {
        return degrees(bench().point(p, ring, 1) - bench().point(p, ring, 0),
                       bench().point(p, ring, 3) - bench().point(p, ring, 2));
    };
    const auto angle = [](const Places& p) {
        const Vector3d u = bench().point(p, corner, 1) - bench().point(p, corner, 0),
                       v = bench().point(p, corner, 2) - bench().point(p, corner, 0);
        return std::abs(90 - std::atan2(u.cross(v).norm(), u.dot(v)) * 180 / std::numbers::pi);
    };
    const auto edge = [](const Places& p) { return 100 * std::abs(bench().length(p, a) / 6 - 1); };
    const auto bulge = [](const Places& p) {
        const double level = bench().middle(p, sheet).z();
        double off = 0;
        for (const Index v : bench().vertices(sheet)) off = std::max(off, std::abs(p[v].z() - level));
        return 100 * off;
    };
    const auto one_up = [](Places& p, double wrong) { p[bench().first.at(sheet) + 4 * 9 + 4].z() += wrong; };
    const Shape lean = rotated(ring, y);
    const auto leaning = [](const Places& p) {
        return 100 * std::abs((bench().point(p, ring, 0) - bench().point(p, ring, 2)).z()) / 2;
    };
    const auto corner_off = [](const Places& p) {
        return 100 * std::abs((bench().point(p, solid, 3) - Vector3d(1, 0, 6)).norm());
    };
    const Shape long_a = stretched(a, z);
    return {
        {"plane", {ring}, "{}", up, {0, 0.01, 1}, lifted, 2, false, false},
        {"line",
         {a_line},
         "{}",
         each(a_line, [](const Vector3d& d, double w) -> Vector3d { return d + w * std::abs(d.z()) * x; }),
         {0, 0.005, 0.9},
         [](const Places& p) {
             return 100 * std::abs((p[bench().first.at(a)] - p[bench().first.at(a) + 6 * Bench::around]).x()) / 6;
         },
         2,
         false,
         false},
        {"circle", {ring}, "{}", up, {0, 0.01, 1}, lifted, 2, false, false},
        {"sphere",
         {two_rings},
         "{}",
         pulled(two_rings, 0, x),
         {0, 0.02, 3},
         [](const Places& p) { return 100 * std::abs(bench().point(p, two_rings, 0).x() - 1) / 6; },
         2,
         false,
         false},
        {"orientation", {ring}, R"({"direction": [0, 0, 1]})", lean, {0, 0.5, 40}, leaning, 2, false, false},
        {"fitted-plane orientation", {ring}, R"({"direction": [0, 0, 1]})", lean, {0, 0.5, 40}, leaning, 2, false, false},
        {"equilateral", {ring}, "{}", out, {0, 0.01, 1}, sides, 2, false, false},
        {"rectangle", {ring}, "{}", out, {0, 0.01, 1}, sides, 2, false, false},
        {"parallelogram", {ring}, "{}", out, {0, 0.01, 1}, sides, 2, false, false},
        {"angle", {corner}, R"({"minValue": 90, "maxValue": 90})", pulled(corner, 0, x), {0, 0.01, 2}, angle, 2, false, false},
        {"parallel", {ring}, "{}", out, {0, 0.01, 2}, parallel, 2, false, false},
        {"perpendicular", {cross}, "{}", pulled(cross, 0, y), {0, 0.01, 2}, diagonals, 2, false, false},
        {"equal lengths", {ring}, "{}", out, {0, 0.01, 2}, sides, 2, false, false},
        {"polyline length",
         {a_line},
         R"({"minValue": 6, "maxValue": 6, "absolute": true})",
         long_a,
         {0, 0.005, 0.9},
         edge,
         2,
         false,
         false},
        {"polyline length", {a_line}, "{}", long_a, {0, 0.005, 0.9}, edge, 2, true, false},
        {"edge strain",
         {a_line},
         R"({"minValue": 0.5, "maxValue": 0.5, "absolute": true})",
         long_a,
         {0, 0.005, 0.9},
         edge,
         2,
         false,
         false},
        {"edge strain", {a_line}, "{}", long_a, {0, 0.005, 0.9}, edge, 2, true, false},
        {"triangle strain", {a_sides}, "{}", long_a, {0, 0.005, 0.9}, edge, 2, true, false},
        {"tetrahedron strain", {solid}, "{}", pulled(solid, 3, z), {0, 0.01, 3}, corner_off, 2, true, false},
        {"volume",
         {solid},
         R"({"minValue": 0.99, "maxValue": 1.01, "absolute": true})",
         pulled(solid, 3, z),
         {0, 0.01, 3},
         corner_off,
         2,
         false,
         false},
        {"volume", {solid}, "{}", pulled(solid, 3, z), {0, 0.01, 3}, corner_off, 2, true, false},
        {"area",
         {a_sides},
         R"({"minValue": 0.0652, "maxValue": 0.0653, "absolute": true})",
         long_a,
         {0, 0.005, 0.9},
         edge,
         2,
         false,
         false},
        {"area", {a_sides}, "{}", long_a, {0, 0.005, 0.9}, edge, 2, true, false},
        {"bending", {sheet}, "{}", one_up, {0, 0.002, 1}, bulge, 2, true, false},
        {"laplacian", {sheet}, "{}", one_up, {0, 0.01, 1}, bulge, 2, false, false},
        {"laplacian displacement", {sheet}, "{}", one_up, {0, 0.01, 1}, bulge, 2, true, false},
        {"cotangent laplacian", {sheet}, "{}", one_up, {0, 0.01, 1}, bulge, 2, false, false},
        {"cotangent laplacian displacement", {sheet}, "{}", one_up, {0, 0.01, 1}, bulge, 2, true, false},
    };
}

std::vector<Case> cases() {
    std::vector<Case> list = axes_and_places();
    for (auto part : {measures_and_shapes(), kinds_of_the_solver()}) list.insert(list.end(), part.begin(), part.end());
    return list;
}

RelationGraph graph_of(const Case& test_case) {
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, test_case.type, test_case.members, test_case.parameters));
    return graph;
}

/// A shape of the bench as read from a file.
Mesh from_file(const Scratch& scratch, const std::vector<Point>& points) {
    write_mesh(scratch / "shape.ply", with_points(bench().mesh, points));
    return read_mesh(scratch / "shape.ply").mesh;
}
Places places_of(const Mesh& mesh) {
    Places places;
    for (const Vertex v : mesh.vertices()) places.push_back(eigen(mesh.point(v)));
    return places;
}
std::vector<Point> wrong_by(const Case& test_case, double wrong) {
    Places places = bench().at_rest();
    test_case.shape(places, wrong);
    return points_of(places);
}

}  // namespace

TEST(ConstraintCheck, EveryTypeIsJudgedByPositions) {
    const Scratch scratch;
    for (const Case& test_case : cases()) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Mesh object = from_file(scratch, wrong_by(test_case, test_case.wrong.at(i)));
            const double value = test_case.value(places_of(object));
            EXPECT_EQ(value <= test_case.tolerance, i < 2) << test_case.type << ", " << test_case.wrong.at(i) << ": " << value;
            const RelationGraph graph = graph_of(test_case);
            const std::string name =
                std::string(test_case.type) + " " + test_case.parameters + ", wrong by " + std::to_string(test_case.wrong.at(i));
            const ConstraintReport alone = judge_constraints({object, bench().annotations}, graph).at(0);
            if (test_case.rest) {
                EXPECT_EQ(alone.verdict, Verdict::unknown) << name;
                EXPECT_NE(alone.text.find("--rest"), std::string::npos) << name << ": " << alone.text;
            }
            // With the rest shape the verdict is that of `deform`.
            const ConstraintReport judged =
                test_case.rest ? judge_constraints({object, bench().annotations}, graph, &bench().mesh).at(0) : alone;
            ASSERT_FALSE(judged.deviations.empty()) << name << ": " << judged.text;
            EXPECT_EQ(judged.verdict, value <= test_case.tolerance ? Verdict::holds : Verdict::fails)
                << name << ": " << *judged.deviations[0].value << " " << judged.text << "; " << value;
            if (test_case.exact) {
                EXPECT_NEAR(*judged.deviations[0].value, value, 0.02 * test_case.tolerance + 0.02 * value) << name;
            }
        }
    }
}

TEST(ConstraintCheck, EveryTypeIsInTheTable) {
    std::set<std::string> judged{"containment", "equal selections"};
    for (const Case& test_case : cases()) judged.insert(test_case.type);
    for (const RelationType& type : relation_types()) EXPECT_TRUE(judged.count(type.name) > 0) << type.name;
}

TEST(ConstraintCheck, SelectionsAreJudgedByTheirFaces) {
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "containment", {a, a_lower}, "{}"));
    graph.relationships.push_back(constraint(1, "containment", {a_lower, a}, "{}"));
    graph.relationships.push_back(constraint(2, "equal selections", {a_lower, a_upper}, "{}"));
    const auto judged = judge_constraints(bench(), graph);
    EXPECT_EQ(judged.at(0).verdict, Verdict::holds);
    EXPECT_EQ(judged.at(1).verdict, Verdict::fails);
    EXPECT_EQ(judged.at(2).verdict, Verdict::fails);
}

TEST(ConstraintCheck, TheSolvedQuantityIsTheMeasuredOne) {
    // From a very wrong shape: the verdict on the result is that of its file, and the same as the check's against the rest.
    const Scratch scratch;
    DeformOptions options;
    options.conflicts = 0;
    for (const Case& test_case : cases()) {
        RelationGraph graph = graph_of(test_case);
        graph.relationships[0].weight = 1000;
        const std::vector<Point> start = wrong_by(test_case, test_case.wrong[2]);
        const std::vector<bool> fixed(start.size(), false);
        DeformResult result = restore_constraints(bench(), graph, start, fixed, options);
        const Mesh object = from_file(scratch, result.points);
        const double value = test_case.value(places_of(object)), before = test_case.value(places_of(from_file(scratch, start)));
        const std::string name = std::string(test_case.type) + " " + test_case.parameters;
        const ConstraintReport &solved = result.constraints.at(0),
                               judged = judge_constraints({object, bench().annotations}, graph, &bench().mesh).at(0);
        EXPECT_EQ(solved.verdict, judged.verdict) << name;
        std::cout << name << ": " << before << " -> " << value << " (at most " << test_case.tolerance << "), "
                  << to_string(solved.verdict) << "\n";
        if (test_case.exact) {
            EXPECT_EQ(solved.verdict, value <= test_case.tolerance ? Verdict::holds : Verdict::fails)
                << name << ": " << value << " against " << *solved.deviations.at(0).value;
        }
    }
}

TEST(ConstraintCheck, AShapeAtRestHasTheVerticesOfTheMesh) {
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "keep shape", {a}, "{}"));
    const Mesh other = make_mesh(synthetic_object("teapot"), {.vertices = 2000}).mesh;
    EXPECT_THROW(judge_constraints(bench(), graph, &other), Error);
}

TEST(ConstraintCheck, UnreadableConstraintsAreReportedAndOthersJudged) {
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "keep measure", {a}, R"({"measure": "girth"})"));
    graph.relationships.push_back(constraint(1, "same level", {a, b}, "{}"));
    const auto judged = judge_constraints(bench(), graph);
    EXPECT_EQ(judged.at(0).verdict, Verdict::unknown);
    EXPECT_NE(judged.at(0).text.find("measure"), std::string::npos) << judged.at(0).text;
    EXPECT_EQ(judged.at(1).verdict, Verdict::holds);
}

TEST(ConstraintCheck, ContradictoryDirectionsAreNamedAndThePartIsIntact) {
    RelationGraph graph;
    graph.relationships.push_back(constraint(3, "keep direction", {b}, R"({"angle": 0, "direction": [0, 0, 1], "hard": true})"));
    graph.relationships.push_back(
        constraint(4, "keep direction", {b}, R"({"angle": 0, "direction": [0.5, 0, 0.866], "hard": true})"));
    DeformOptions options;
    options.followed = 0;
    const DeformResult result = deform({bench()}, graph, edit(""), "e", options);
    EXPECT_FALSE(result.acceptable);
    EXPECT_EQ(result.constraints.at(0).verdict, Verdict::holds);
    EXPECT_EQ(result.constraints.at(1).verdict, Verdict::fails);
    EXPECT_NE(result.constraints.at(1).text.find("contradicts constraint 3"), std::string::npos) << result.constraints[1].text;
    const Places places = places_of(with_points(bench().mesh, result.points));
    EXPECT_NEAR(bench().length(places, b), 6, 0.1);
    ASSERT_EQ(result.conflicts.size(), 1U);
    EXPECT_EQ(result.conflicts[0].id, 3);
    EXPECT_EQ(result.conflicts[0].freed, std::vector<int>{4});
}

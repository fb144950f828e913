// Features that keep their shape and their level, and the distortion around them.
#include "caged.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/solver/make_constraint.h"

#include <gtest/gtest.h>
#include <Eigen/SVD>

#include <filesystem>
#include <iostream>
#include <set>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// Spread of the heights of the parts' centroids.
double level_spread(const Caged& object, const std::vector<Point>& points, const std::vector<int>& ids) {
    double low = 1e300, high = -1e300;
    for (const int id : ids) {
        double sum = 0, whole = 0;
        for (const Index f : object.set.find(id)->faces) {
            const auto [a, b, c] = corners(object.synthetic.mesh, Face(f));
            const double area = (eigen(points[b]) - eigen(points[a])).cross(eigen(points[c]) - eigen(points[a])).norm();
            sum += area * (points[a].z() + points[b].z() + points[c].z()) / 3;
            whole += area;
        }
        low = std::min(low, sum / whole), high = std::max(high, sum / whole);
    }
    return high - low;
}

Points points_matrix(const std::vector<Point>& list) {
    Points points(3, static_cast<Eigen::Index>(list.size()));
    for (std::size_t i = 0; i < list.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = eigen(list[i]);
    return points;
}

/// Distortion of faces within 1.6 of a flower's radius, relative to the synthetic body stretched upwards by 1.4.
struct RingDistortion {
    double stretch = 0;   ///< mean of |s1 - 1| + |s2 - 1| over the singular values of edited -> final
    double angle = 0;     ///< mean angle between a face without a flower's vertex and the nearby body, degrees
    double distance = 0;  ///< root mean square distance of their vertices from the body
};

/// Value and gradient of the teapot's body, without flowers, stretched: it is round, so that a point between two flowers at the
/// same height is sufficient.
std::pair<double, Eigen::Vector3d> stretched_body(const Eigen::Vector3d& p) {
    const double radius = std::hypot(p.x(), p.y()), free = 72 * M_PI / 180;
    const Point unstretched(radius * std::cos(free), radius * std::sin(free), p.z() / 1.4);
    const Vector g = synthetic_object("teapot").gradient(unstretched);
    const double outwards = g.x() * std::cos(free) + g.y() * std::sin(free);
    const Eigen::Vector3d gradient(outwards * p.x() / radius, outwards * p.y() / radius, g.z() / 1.4);
    return {synthetic_object("teapot").value(unstretched), gradient};
}

RingDistortion distortion_around(const Caged& object, const std::vector<int>& flowers, const DeformResult& result) {
    RingDistortion sum;
    double area = 0, clear = 0;
    for (const int id : flowers) {
        const Annotation& flower = *object.set.find(id);
        const std::set<Index> inside(flower.faces.begin(), flower.faces.end());
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        double radius = 0;
        const auto feature = vertices_of(object.synthetic.mesh, flower);
        const std::set<Index> touched(feature.begin(), feature.end());
        for (const Index v : feature)
            middle += eigen(object.synthetic.mesh.point(Vertex(v))) / static_cast<double>(feature.size());
        for (const Index v : feature) radius = std::max(radius, (eigen(object.synthetic.mesh.point(Vertex(v))) - middle).norm());
        for (const Face f : object.synthetic.mesh.faces()) {
            if (inside.count(f.idx()) > 0 || (eigen(centroid(object.synthetic.mesh, f)) - middle).norm() > 1.6 * radius) continue;
            const auto [a, b, c] = corners(object.synthetic.mesh, f);
            const auto frame = [&](const std::vector<Point>& p) {
                const Eigen::Vector3d u = eigen(p[b] - p[a]), v = eigen(p[c] - p[a]), x = u.normalized();
                Eigen::Matrix2d m;
                m << u.norm(), x.dot(v), 0, (v - x * x.dot(v)).norm();
                return m;
            };
            const Eigen::Matrix2d map = frame(result.points) * frame(result.edited).inverse();
            const Eigen::Vector2d s = Eigen::JacobiSVD<Eigen::Matrix2d>(map).singularValues();
            const double weight = face_area(object.synthetic.mesh, f);
            sum.stretch += weight * (std::abs(s[0] - 1) + std::abs(s[1] - 1));
            const Eigen::Vector3d p = eigen(result.points[a]), q = eigen(result.points[b]), r = eigen(result.points[c]);
            const Eigen::Vector3d n = (q - p).cross(r - p).normalized();
            const Eigen::Vector3d m = stretched_body((p + q + r) / 3).second;
            area += weight;
            if (touched.count(a) + touched.count(b) + touched.count(c) > 0) continue;
            clear += weight;
            sum.angle += weight * std::atan2(n.cross(m).norm(), n.dot(m)) * 180 / M_PI;
            for (const auto& corner : {p, q, r}) {
                const auto [value, gradient] = stretched_body(corner);
                sum.distance += weight / 3 * std::pow(value / gradient.norm(), 2);
            }
        }
    }
    return {sum.stretch / area, sum.angle / clear, std::sqrt(sum.distance / clear)};
}

}  // namespace

TEST(Deform, FlowersOnOneLevelKeepTheirShape) {
    // One side of the teapot is lifted by a rotation about y: flowers leave their level and are sheared.
    const Caged& object = teapot();
    const std::vector<int> flowers{7, 8, 9, 10, 11};
    const std::string steps = R"({"select": {"all": true}, "stretch": {"direction": [0, 0, 1], "factor": 1.4}},
                                 {"select": {"annotation": "spout", "threshold": 0.15}, "translate": [0, 0, 12]})";
    const double diagonal = box_diagonal(object.synthetic.mesh);
    for (const bool hard : {false, true}) {
        RelationGraph graph;
        graph.relationships.push_back(
            constraint(0, "same level", flowers, hard ? R"({"hard": true, "heights": "equal"})" : R"({"heights": "equal"})", 50));
        const DeformResult result = deform(object.handles(), graph, edit(steps), "e");
        ASSERT_EQ(result.constraints.size(), 1U);
        EXPECT_TRUE(result.constraints[0].used);
        EXPECT_EQ(result.constraints[0].low_level, 6U);
        std::cout << (hard ? "hard" : "soft") << ": level spread " << level_spread(object, result.edited, flowers) << " -> "
                  << level_spread(object, result.points, flowers) << " of " << diagonal << ", " << result.summary.iterations
                  << " iterations\n";
        EXPECT_LT(level_spread(object, result.points, flowers), (hard ? 1e-3 : 1e-2) * diagonal);
        // Each flower is a rigid copy of its rest shape.
        for (const int id : flowers) {
            const auto vertices = vertices_of(object.synthetic.mesh, *object.set.find(id));
            const Points rest = [&] {
                Points p(3, static_cast<Eigen::Index>(object.synthetic.mesh.number_of_vertices()));
                for (const Vertex v : object.synthetic.mesh.vertices()) p.col(v.idx()) = eigen(object.synthetic.mesh.point(v));
                return p;
            }();
            Points now = rest;
            for (const Vertex v : object.synthetic.mesh.vertices()) now.col(v.idx()) = eigen(result.points[v]);
            const auto rigid = make_constraint(kinds::Rigid{}, {vertices.begin(), vertices.end()}, 1, rest);
            const double off = std::sqrt(rigid->squared_distance(now) / static_cast<double>(vertices.size()));
            EXPECT_LT(off, (hard ? 1e-3 : 5e-3) * diagonal) << id;
        }
    }
}

TEST(Deform, ThroughTheCageConstraintsAreMetAsFarAsPossible) {
    const Caged& object = teapot();
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "same level", {7, 8, 9, 10, 11}, R"({"heights": "equal"})", 10));
    DeformOptions options;
    options.space = DeformOptions::Space::cage;
    const DeformResult result =
        deform(object.handles(), graph,
               edit(R"({"select": {"annotation": "spout", "threshold": 0.15}, "translate": [0, 0, 12]})"), "e", options);
    EXPECT_TRUE(result.solved);
    EXPECT_EQ(result.cage.size(), object.cage.number_of_vertices());
    // The mesh follows the cage through the weights.
    const auto again = deformed(object.coordinates, object.cage, result.cage);
    for (std::size_t i = 0; i < again.size(); ++i)
        ASSERT_LT(std::sqrt(CGAL::squared_distance(again[i], result.points[i])), 1e-9 * box_diagonal(object.synthetic.mesh));
    // The solve minimises the cost of shapes and levels together. Hard constraints have a thousandfold weight, so that the levels
    // improve.
    EXPECT_LT(result.constraints[0].cost, result.constraints[0].cost_before);
    graph.relationships[0] =
        constraint(0, "same level", {7, 8, 9, 10, 11}, R"({"heights": "equal", "shapes": "free", "hard": true})", 10);
    const DeformResult hard =
        deform(object.handles(), graph,
               edit(R"({"select": {"annotation": "spout", "threshold": 0.15}, "translate": [0, 0, 12]})"), "e", options);
    EXPECT_LE(level_spread(object, hard.points, {7, 8, 9, 10, 11}), level_spread(object, hard.edited, {7, 8, 9, 10, 11}) + 1e-9);
}

TEST(Deform, SurroundingsAreDistortedLessThanInTheThesis) {
    // The teapot stretched by 1.4 with rigid flowers on one level, to the rest shape's displacements as in the thesis, to those
    // of the edited shape, and with the flowers put back on the stretched body.
    const Caged object("teapot", 20000, 200);
    const std::string steps =
        R"({"select": {"all": true}, "stretch": {"direction": [0, 0, 1], "factor": 1.4, "from": [0, 0, 0]}})";
    const std::vector<int> flowers{7, 8, 9, 10, 11};
    const auto distortion = [&](const std::string& parameters, const std::string& details, double spread) {
        RelationGraph graph;
        graph.relationships.push_back(constraint(0, "same level", flowers, parameters));
        DeformOptions options;
        set_option(options, "details", details);
        options.spread = spread;
        const DeformResult result = deform(object.handles(), graph, edit(steps), "e", options);
        EXPECT_EQ(result.constraints[0].verdict, Verdict::holds);
        const RingDistortion ring = distortion_around(object, flowers, result);
        std::cout << parameters << ' ' << details << ' ' << spread << ": stretch " << ring.stretch << ", angle " << ring.angle
                  << " degrees, distance " << ring.distance << '\n';
        return ring;
    };
    const std::string hard = R"({"hard": true})";
    distortion(R"({"shapes": "free"})", "edited", DeformOptions().spread);
    // With a large closeness weight the change is concentrated in the rings; with a small one it spreads.
    const RingDistortion ours = distortion(hard, "edited", DeformOptions().spread);
    const RingDistortion rest = distortion(hard, "rest", DeformOptions().spread), crowded = distortion(hard, "rest", 0.02);
    EXPECT_LT(ours.stretch, rest.stretch);
    EXPECT_LT(rest.stretch, crowded.stretch);
    const RingDistortion reattached = distortion(R"({"shapes": "seat"})", "edited", DeformOptions().spread);
    EXPECT_LT(reattached.angle, rest.angle / 2);
    EXPECT_LT(reattached.distance, rest.distance / 2);
}

TEST(Deform, ReattachedFeaturesAreRigidAndLevelThroughTheCageToo) {
    const Caged& object = teapot();
    const std::vector<int> flowers{7, 8, 9, 10, 11};
    const std::string steps = R"({"select": {"all": true}, "stretch": {"direction": [0, 0, 1], "factor": 1.4}},
                                 {"select": {"annotation": "spout", "threshold": 0.15}, "translate": [0, 0, 12]})";
    const double diagonal = box_diagonal(object.synthetic.mesh);
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "same level", flowers, ""));
    for (const auto& [space, bend] : {std::pair{"mesh", true}, {"cage", true}, {"mesh", false}}) {
        graph.relationships[0].constraint = bend ? R"({"shapes": "seat"})" : R"({"shapes": "seat", "bend": 0})";
        DeformOptions options;
        set_option(options, "space", space);
        const DeformResult result = deform(object.handles(), graph, edit(steps), "e", options);
        EXPECT_TRUE(result.acceptable);
        EXPECT_LT(*result.constraints[0].deviations[0].value, 1e-9 * diagonal);
        const Points rest = points_matrix(points_of(object.synthetic.mesh)), now = points_matrix(result.points);
        for (const int id : flowers) {
            const auto vertices = vertices_of(object.synthetic.mesh, *object.set.find(id));
            const auto rigid = make_constraint(kinds::Rigid{}, {vertices.begin(), vertices.end()}, 1, rest);
            // It bends by no more than permitted.
            EXPECT_LT(std::sqrt(rigid->squared_distance(now) / static_cast<double>(vertices.size())),
                      (bend ? 7.6e-4 : 1e-9) * diagonal)
                << id;
        }
        // Nothing else moves farther than the flowers' size.
        EXPECT_EQ(result.points[object.synthetic.mesh.number_of_vertices() - 1],
                  result.edited[object.synthetic.mesh.number_of_vertices() - 1]);
    }
    // The whole object has no base.
    graph.relationships[0] = constraint(0, "keep shape", {0}, R"({"mode": "seat"})");
    EXPECT_NE(error_of(object.handles(), steps, graph).find("sits on nothing"), std::string::npos);
    // A single feature keeps its position.
    graph.relationships[0] = constraint(0, "keep shape", {7}, R"({"mode": "seat", "bend": 0})");
    const DeformResult alone = deform(object.handles(), graph, edit(steps), "e");
    EXPECT_LT(*alone.constraints[0].deviations[0].value, 1e-9 * diagonal);
    // Touching features cannot be moved separately.
    graph.relationships[0] = constraint(0, "same level", flowers, R"({"shapes": "seat"})");
    graph.relationships[0].annotations = {1, 5};
    EXPECT_NE(error_of(object.handles(), steps, graph).find("touches another feature"), std::string::npos)
        << error_of(object.handles(), steps, graph);
}

TEST(Deform, AScannedBustKeepsItsFeatures) {
    const Path file = Path(OSTRAKA_SHARED_DATA) / "heritage-scans" / "Laurana50k.ply";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "there is no " << file;
    const Mesh mesh = read_mesh(file).mesh;
    // Two patches with a size of the diagonal / 15 represent details on it.
    AnnotationSet set;
    const double diagonal = box_diagonal(mesh);
    Eigen::AlignedBox3d box;
    for (const Vertex v : mesh.vertices()) box.extend(eigen(mesh.point(v)));
    for (int k = 0; k < 2; ++k) {
        const Eigen::Vector3d goal = box.min() + (box.max() - box.min()).cwiseProduct(Eigen::Vector3d(k, 1, 0.45 + 0.1 * k));
        Index seed = 0;
        for (const Vertex v : mesh.vertices())
            if ((eigen(mesh.point(v)) - goal).norm() < (eigen(mesh.point(Vertex(seed))) - goal).norm()) seed = v.idx();
        Annotation patch;
        patch.id = k + 1;
        patch.tag = "patch " + std::to_string(k + 1);
        for (const Face f : mesh.faces())
            if ((eigen(centroid(mesh, f)) - eigen(mesh.point(Vertex(seed)))).norm() < diagonal / 15)
                patch.faces.push_back(f.idx());
        set.annotations.push_back(patch);
    }
    const std::string stretch = R"({"select": {"all": true}, "stretch": {"direction": [0, 0, 1], "factor": 1.3}},
        {"select": {"annotation": 1}, "translate": [0, 0, 15]})";
    for (const std::string parameters : {R"({"shapes": "seat", "direction": [0, 0, 1]})", R"({"direction": [0, 0, 1]})"}) {
        RelationGraph graph;
        graph.relationships.push_back(constraint(0, "same level", {1, 2}, parameters, 1e4));
        DeformOptions options;
        options.handles = 0.01;
        const DeformResult result = deform({{mesh, set}}, graph, edit(stretch), "e", options);
        EXPECT_EQ(result.constraints[0].verdict, Verdict::holds) << result.constraints[0].text;
        EXPECT_GT(result.constraints[0].before_values[0], 0.01 * diagonal);
        const Points rest = points_matrix(points_of(mesh)), now = points_matrix(result.points);
        ASSERT_TRUE(now.allFinite());
        for (const Annotation& patch : set.annotations) {
            const auto vertices = vertices_of(mesh, patch);
            const auto rigid = make_constraint(kinds::Rigid{}, {vertices.begin(), vertices.end()}, 1, rest);
            EXPECT_LT(std::sqrt(rigid->squared_distance(now) / static_cast<double>(vertices.size())), 1e-3 * diagonal);
        }
    }
}

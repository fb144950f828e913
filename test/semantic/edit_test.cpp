// Edits with and without cages.
#include "caged.h"
#include "meshes.h"
#include "ostraka/coords/nested.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/semantic/part_cages.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

TEST(Edit, AnEditOfTheWholeCageMovesTheMeshEqually) {
    const Caged& object = teapot();
    const double diagonal = box_diagonal(object.synthetic.mesh);
    const auto expect = [&](const std::string& operation, auto&& move) {
        const DeformResult result = deform(object.handles(), {}, edit(R"({"select": {"all": true}, )" + operation + "}"), "e");
        for (const Vertex v : object.synthetic.mesh.vertices())
            ASSERT_LT((eigen(result.points[v]) - move(eigen(object.synthetic.mesh.point(v)))).norm(), 1e-9 * diagonal)
                << operation;
    };
    using V = Eigen::Vector3d;
    expect(R"("translate": [1, 2, 3])", [](const V& p) -> V { return p + V(1, 2, 3); });
    expect(R"("scale": {"factor": 2, "centre": [0, 0, 0]})", [](const V& p) -> V { return 2 * p; });
    expect(R"("rotate": {"axis": [0, 0, 2], "angle": 90, "centre": [0, 0, 0]})", [](const V& p) -> V {
        return {-p.y(), p.x(), p.z()};
    });
    expect(R"("stretch": {"direction": [0, 0, 1], "factor": 1.4, "from": [0, 0, 0]})", [](const V& p) -> V {
        return {p.x(), p.y(), 1.4 * p.z()};
    });
}

TEST(Edit, SelectsByInfluence) {
    const Caged& object = teapot();
    const WeightMatrix& w = object.coordinates.vertex;
    const double rows = influence_threshold(w, "auto-mesh"), columns = influence_threshold(w, "auto-cage");
    EXPECT_EQ(rows, w.rowwise().maxCoeff().minCoeff());
    EXPECT_EQ(columns, w.colwise().maxCoeff().minCoeff());
    for (Index v = 0; v < 50; ++v) EXPECT_FALSE(influential(object.coordinates, {v}, rows).empty());
    std::vector<Index> everything(object.synthetic.mesh.number_of_vertices());
    for (Index v = 0; v < everything.size(); ++v) everything[v] = v;
    EXPECT_EQ(influential(object.coordinates, everything, columns).size(), object.cage.number_of_vertices());
    // A part's own handles move it more than other handles.
    const auto states = follow_edit(edit(R"({"select": {"annotation": "spout", "threshold": 0.2}, "translate": [0, 0, 5]})"),
                                    object.handles(), "e");
    EXPECT_EQ(states.front().selected,
              influential(object.coordinates, vertices_of(object.synthetic.mesh, *object.set.find(5)), 0.2));
    EXPECT_NE(error_of(object.handles(), R"({"select": {"annotation": "spout", "threshold": 2}, "translate": [0, 0, 5]})")
                  .find("the largest is"),
              std::string::npos);
}

TEST(Edit, StepsFollowEachOther) {
    const Caged& object = teapot();
    const auto states = follow_edit(edit(R"({"select": {"vertices": [3, 4]}, "translate": [1, 0, 0]},
        {"select": {"box": {"min": [-1000, -1000, -1000], "max": [1000, 1000, 1000]}}, "translate": [0, 1, 0]},
        {"select": {"vertices": [3]}, "moveTo": [[7, 8, 9]]})"),
                                    object.bare(), "e");
    ASSERT_EQ(states.size(), 3U);
    const Point p = object.synthetic.mesh.point(Vertex(4));
    EXPECT_EQ(states[0].handles[4], Point(p.x() + 1, p.y(), p.z()));
    EXPECT_EQ(states[1].handles[4], Point(p.x() + 1, p.y() + 1, p.z()));
    EXPECT_EQ(states[2].handles[3], Point(7, 8, 9));
    EXPECT_EQ(std::count(states[0].touched.begin(), states[0].touched.end(), true), 2);
}

TEST(Edit, InvalidEditsAreRefused) {
    const Caged& object = teapot();
    const auto refused = [&](const std::string& step, const std::string& words) {
        const std::string text = error_of(object.handles(), step);
        EXPECT_NE(text.find(words), std::string::npos) << step << ": " << text;
        EXPECT_TRUE(text.empty() || text.find("/steps/0") != std::string::npos || text.find("e.edit.json") != std::string::npos)
            << text;
    };
    refused(R"({"select": {"annotation": "nose"}, "translate": [0, 0, 1]})", "no annotation tagged 'nose'");
    refused(R"({"select": {"annotation": 99}, "translate": [0, 0, 1]})", "no annotation 99");
    refused(R"({"select": {"cageVertices": [150]}, "translate": [0, 0, 1]})", "is not one of the 150");
    refused(R"({"select": {"box": {"min": [1, 0, 0], "max": [0, 1, 1]}}, "translate": [0, 0, 1]})", "min > max");
    refused(R"({"select": {"box": {"min": [1e5, 0, 0], "max": [2e5, 1, 1]}}, "translate": [0, 0, 1]})", "selects nothing");
    refused(R"({"select": {"all": true}})", "no operation");
    refused(R"({"select": {"all": true}, "translate": [0, 0, 1], "scale": {"factor": 2}})", "more than one operation");
    refused(R"({"select": {"all": true}, "rotate": {"axis": [0, 0, 0], "angle": 3}})", "axis is zero");
    refused(R"({"select": {"all": true}, "stretch": {"direction": [0, 0, 1], "factor": -1}})", "factor");
    refused(R"({"select": {"cageVertices": [1, 2]}, "moveTo": [[0, 0, 0]]})", "1 positions for 2");
    refused(R"({"select": {"all": true, "cageVertices": [1]}, "translate": [0, 0, 1]})", "2 ways");
    EXPECT_NE(error_of(object.bare(), R"({"select": {"cageVertices": [1]}, "translate": [0, 0, 1]})").find("without a cage"),
              std::string::npos);
}

namespace {

/// The teapot in a cage, with a nested cage around the spout.
struct Nested {
    const Caged& whole = teapot();
    std::size_t spout = 0;
    Mesh cage;
    Coordinates coordinates;
    std::vector<CageLevel> levels;
    Nested() {
        while (whole.set.annotations[spout].tag != "spout") ++spout;
        CageOptions options;
        options.vertices = 40;
        const auto parts = make_part_cages({whole.synthetic.mesh, whole.set}, {spout}, options, {}, "graph");
        EXPECT_TRUE(parts[0].check.valid());
        cage = together({&whole.cage, &parts[0].made.cage});
        coordinates = compute_coordinates("mean-value", cage, whole.synthetic.mesh);
        levels = cage_levels(cage);
    }
    [[nodiscard]] HandleSpace handles() const { return {{whole.synthetic.mesh, whole.set}, &cage, &coordinates}; }
    [[nodiscard]] std::vector<EditState> follow(const std::string& steps) const {
        return follow_edit(edit(steps), handles(), "e");
    }
};

const Nested& nested() {
    static const Nested object;
    return object;
}

}  // namespace

TEST(NestedEdit, APartIsMovedByItsOwnCage) {
    const Nested& n = nested();
    ASSERT_EQ(n.levels.size(), 2U);
    const auto states = n.follow(R"({"select": {"annotation": "spout"}, "translate": [1, 2, 3]})");
    const std::size_t first = n.levels[1].cage.vertices.front();
    for (const Index v : states[0].selected) EXPECT_GE(v, first);
    EXPECT_FALSE(states[0].selected.empty());
    const auto outer = n.follow(R"({"select": {"annotation": "spout", "level": 0}, "translate": [1, 2, 3]})");
    for (const Index v : outer[0].selected) EXPECT_LT(v, first);
    // As with the outer cage alone.
    const HandleSpace alone = n.whole.handles();
    EXPECT_EQ(outer[0].selected,
              follow_edit(edit(R"({"select": {"annotation": "spout"}, "translate": [1, 2, 3]})"), alone, "e")[0].selected);
}

TEST(NestedEdit, InnerCagesFollowOuterCages) {
    const Nested& n = nested();
    // The whole outer cage: the inner cage follows, and so does the whole object.
    const auto states = n.follow(R"({"select": {"all": true, "level": 0}, "translate": [5, 0, 0]},
        {"select": {"all": true, "level": 1}, "translate": [0, 7, 0]})");
    const std::vector<Point> first = deformed(n.coordinates, n.cage, states[0].handles);
    for (const Vertex v : n.whole.synthetic.mesh.vertices())
        ASSERT_LT(std::sqrt(CGAL::squared_distance(first[v], n.whole.synthetic.mesh.point(v) + Vector(5, 0, 0))), 1e-9);
    for (const Vertex v : n.cage.vertices())
        ASSERT_LT(std::sqrt(CGAL::squared_distance(states[0].handles[v], n.cage.point(v) + Vector(5, 0, 0))), 1e-9);
    // Both levels in one edit; handles that follow do not count as selected.
    const Index inner = n.levels[1].cage.vertices.front();
    EXPECT_FALSE(states[0].touched[inner]);
    EXPECT_TRUE(states[1].touched[inner]);
    EXPECT_LT(std::sqrt(CGAL::squared_distance(states[1].handles[inner], n.cage.point(Vertex(inner)) + Vector(5, 7, 0))), 1e-9);
    // A step on all handles moves each once.
    const auto all = n.follow(R"({"select": {"all": true}, "translate": [5, 0, 0]})");
    EXPECT_LT(std::sqrt(CGAL::squared_distance(all[0].handles[inner], n.cage.point(Vertex(inner)) + Vector(5, 0, 0))), 1e-12);
}

TEST(NestedEdit, MissingLevelsAreRefused) {
    EXPECT_NE(error_of(nested().handles(), R"({"select": {"annotation": "spout", "level": 2}, "translate": [1, 2, 3]})")
                  .find("the cage has 2 levels"),
              std::string::npos);
    EXPECT_NE(error_of(teapot().bare(), R"({"select": {"annotation": "spout", "level": 0}, "translate": [1, 2, 3]})")
                  .find("level without a cage"),
              std::string::npos);
}

TEST(PartCages, MirroredPartsHaveMirroredControlPoints) {
    // The statuette's arms, or any two regions of one tag on both sides of the plane x = 0 of a symmetric mesh.
    const Mesh mesh = build_mesh(test::octahedron_sphere(5));
    AnnotationSet set;
    for (const double side : {-1.0, 1.0}) {
        Annotation cap;
        cap.id = static_cast<int>(set.annotations.size()) + 1;
        cap.tag = "ear";
        for (const Face f : mesh.faces())
            if (side * centroid(mesh, f).x() > 0.7) cap.faces.push_back(f);
        set.annotations.push_back(std::move(cap));
    }
    Relationship mirror;
    mirror.id = 1;
    mirror.type = "mirror symmetry";
    mirror.annotations = {2, 1};
    mirror.parameters.plane = PointAndDirection{{0, 0, 0}, {1, 0, 0}};
    RelationGraph graph;
    graph.relationships.push_back(mirror);
    CageOptions options;
    options.vertices = 30;
    const auto cages = make_part_cages({mesh, set}, {0, 1}, options, graph, "graph");
    ASSERT_EQ(cages.size(), 2U);
    const Mesh &a = cages[0].made.cage, &b = cages[1].made.cage;
    ASSERT_EQ(a.number_of_vertices(), b.number_of_vertices());
    for (const Vertex v : a.vertices()) {
        EXPECT_NEAR(a.point(v).x(), -b.point(v).x(), 1e-12);
        EXPECT_NEAR(a.point(v).y(), b.point(v).y(), 1e-12);
        EXPECT_NEAR(a.point(v).z(), b.point(v).z(), 1e-12);
    }
    EXPECT_TRUE(cages[0].check.valid());
    EXPECT_TRUE(cages[1].check.valid());
    // Without a given plane it is estimated.
    graph.relationships[0].parameters.plane.reset();
    const auto plane = symmetry_plane({mesh, set}, graph, {1, 2}, "graph");
    ASSERT_TRUE(plane);
    EXPECT_NEAR(std::abs(plane->normal.x()), 1, 1e-6);
    EXPECT_FALSE(symmetry_plane({mesh, set}, graph, {1}, "graph"));
}

TEST(NestedEdit, ConstraintsInCageSpaceAreMetByThePartsOwnCage) {
    // The spout is rotated and must keep its direction: with a single cage this moves the body as well, with the spout's own cage
    // hardly.
    const Nested& n = nested();
    RelationGraph graph;
    int spout = 0;
    for (const Annotation& annotation : n.whole.set.annotations)
        if (annotation.tag == "spout") spout = annotation.id;
    graph.relationships.push_back(constraint(1, "keep direction", {spout}, "{}"));
    DeformOptions options;
    options.space = DeformOptions::Space::cage;
    const std::string turn = R"({"select": {"annotation": "spout"}, "rotate": {"axis": [0, 1, 0], "angle": 20}})";
    const auto moved_elsewhere = [&](const HandleSpace& space) {
        const DeformResult result = deform(space, graph, edit(turn), "e", options);
        EXPECT_TRUE(result.solved);
        std::vector<bool> of_spout(space.mesh.number_of_vertices(), false);
        for (const Index v : vertices_of(space.mesh, *space.annotations.find(spout))) of_spout[v] = true;
        double sum = 0;
        for (const Vertex v : space.mesh.vertices())
            if (!of_spout[v]) sum += std::sqrt(CGAL::squared_distance(result.points[v], space.mesh.point(v)));
        return sum;
    };
    EXPECT_LT(moved_elsewhere(n.handles()), 0.1 * moved_elsewhere(n.whole.handles()));
}

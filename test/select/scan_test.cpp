// Every selection tool on a real scan, against independent computations.
#include "ostraka/geom/geodesic.h"
#include "ostraka/select/selections.h"
#include "select/follow.h"
#include "select/real_mesh.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

using namespace ostraka;
using namespace ostraka::test;

namespace {

std::set<Index> as_set(const std::vector<Index>& list) { return {list.begin(), list.end()}; }

std::string list(const Point& p) {
    std::ostringstream text;
    text.precision(17);
    text << "[" << p.x() << ", " << p.y() << ", " << p.z() << "]";
    return text.str();
}

}  // namespace

TEST(Scan, PointsAndSets) {
    OSTRAKA_SCAN(mesh, "lion-head.off");
    const CGAL::Bbox_3 box = bounding_box(mesh);
    const Point middle((box.xmin() + box.xmax()) / 2, (box.ymin() + box.ymax()) / 2, (box.zmin() + box.zmax()) / 2);
    const double radius = 0.2 * box_diagonal(mesh);
    const Point centre = mesh.point(Vertex(4000));
    const std::string a = R"({"halfspace": {"point": )" + list(middle) + R"(, "normal": [1, 0.2, 0]}})",
                      b = R"({"sphere": {"centre": )" + list(centre) + R"(, "radius": )" + std::to_string(radius) + "}}",
                      c = R"({"box": {"min": )" + list(Point(box.xmin(), box.ymin(), box.zmin())) + R"(, "max": )" +
                          list(middle) + "}}";
    std::vector<Index> half, ball, corner;
    for (const Face f : mesh.faces()) {
        const Point p = centroid(mesh, f);
        if ((p.x() - middle.x()) + 0.2 * (p.y() - middle.y()) >= 0) half.push_back(f);
        if (std::sqrt(CGAL::squared_distance(p, centre)) <= std::stod(std::to_string(radius))) ball.push_back(f);
        if (p.x() <= middle.x() && p.y() <= middle.y() && p.z() <= middle.z()) corner.push_back(f);
    }
    EXPECT_EQ(faces_of(a, mesh), half);
    EXPECT_EQ(faces_of(b, mesh), ball);
    EXPECT_EQ(faces_of(c, mesh), corner);
    for (const auto& [name, operation] :
         std::map<std::string, std::function<bool(bool, bool)>>{{"union", [](bool x, bool y) { return x || y; }},
                                                                {"intersection", [](bool x, bool y) { return x && y; }},
                                                                {"difference", [](bool x, bool y) { return x && !y; }}}) {
        const std::set<Index> left = as_set(half), right = as_set(ball),
                              result = as_set(faces_of("{\"" + name + "\": [" + a + ", " + b + "]}", mesh));
        for (const Face f : mesh.faces()) ASSERT_EQ(result.contains(f), operation(left.contains(f), right.contains(f))) << name;
    }
    EXPECT_EQ(faces_of(R"({"invert": )" + a + "}", mesh).size() + half.size(), mesh.number_of_faces());
    EXPECT_EQ(faces_of(R"({"faces": [16000, 3, 700]})", mesh), (std::vector<Index>{3, 700, 16000}));
    EXPECT_EQ(faces_of(R"({"component": {"seed": 9}})", mesh).size(), mesh.number_of_faces()) << "the scan is one piece";

    const Point query(box.xmin(), box.ymax(), box.zmax());
    const Index nearest = select("point", R"({"nearest": )" + list(query) + "}", mesh).points.at(0);
    for (const Vertex v : mesh.vertices())
        EXPECT_GE(CGAL::squared_distance(mesh.point(v), query), CGAL::squared_distance(mesh.point(Vertex(nearest)), query));
    const auto inside = as_set(select("point", b, mesh).points);
    for (const Vertex v : mesh.vertices())
        EXPECT_EQ(inside.contains(v),
                  std::sqrt(CGAL::squared_distance(mesh.point(v), centre)) <= std::stod(std::to_string(radius)));
}

TEST(Scan, PathsAreEdgesAndNearlyShortest) {
    OSTRAKA_SCAN(mesh, "lion-head.off");
    for (const auto& [from, to] : {std::pair<Index, Index>{10, 5000}, {4000, 7000}, {100, 8000}}) {
        const auto path = path_through(mesh, {from, to}, false, PathMetric::euclidean, "path");
        ASSERT_EQ(path.front(), from);
        ASSERT_EQ(path.back(), to);
        double length = 0;
        for (std::size_t i = 0; i + 1 < path.size(); ++i) {
            ASSERT_NE(find_halfedge(mesh, Vertex(path[i]), Vertex(path[i + 1])), Mesh::null_halfedge());
            length += std::sqrt(CGAL::squared_distance(mesh.point(Vertex(path[i])), mesh.point(Vertex(path[i + 1]))));
        }
        const double exact = geodesic_distances(mesh, {from})[to];
        EXPECT_GE(length, exact * (1 - 1e-9));
        EXPECT_LE(length, exact * 1.3);
    }
}

TEST(Scan, ARectangleIsTheSumOfItsHalves) {
    OSTRAKA_SCAN(mesh, "lion-head.off");
    const std::string head = R"("up": [0, 1, 0], "cameras": {"c": {"view": "345,0"}}, )";
    for (const std::string visible : {"true", "false"}) {
        const auto part = [&](const std::string& from, const std::string& to) {
            return faces_of(
                R"({"rectangle": {"camera": "c", "from": )" + from + R"(, "to": )" + to + R"(, "visible": )" + visible + "}}",
                mesh, head);
        };
        const auto whole = part("[400, 200]", "[800, 600]");
        auto halves = part("[400, 200]", "[611.3, 600]");
        const auto other = part("[611.3, 600]", "[800, 200]");
        EXPECT_EQ(halves.size() + other.size(), whole.size());
        halves.insert(halves.end(), other.begin(), other.end());
        EXPECT_EQ(as_set(halves), as_set(whole));
        EXPECT_EQ(
            faces_of(R"({"polygon": {"camera": "c", "points": [[400, 200], [800, 200], [800, 600], [400, 600]], "visible": )" +
                         visible + "}}",
                     mesh, head),
            whole);
        EXPECT_GT(whole.size(), 1000U);
    }
}

TEST(Scan, GrowingByADistanceIsABrushAlongTheEdge) {
    OSTRAKA_SCAN(mesh, "lion-head.off");
    const double d = 0.03 * box_diagonal(mesh);
    const std::string ball = R"({"frame": "box", "sphere": {"centre": [0.5, 0.5, 0.9], "radius": 0.2}})";
    const auto before = as_set(faces_of(ball, mesh));
    const auto grown = as_set(faces_of(R"({"grow": {"of": )" + ball + R"(, "distance": )" + std::to_string(d) + "}}", mesh));
    std::set<Index> edge;
    for (const Edge e : mesh.edges()) {
        const Face f = mesh.face(mesh.halfedge(e, 0)), g = mesh.face(mesh.halfedge(e, 1));
        if (f == Mesh::null_face() || g == Mesh::null_face() || before.contains(f) == before.contains(g)) continue;
        edge.insert(mesh.vertex(e, 0));
        edge.insert(mesh.vertex(e, 1));
    }
    const auto distance = geodesic_distances(mesh, {edge.begin(), edge.end()});
    for (const Face f : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, f);
        const double mean = (distance[a] + distance[b] + distance[c]) / 3;
        if (std::abs(mean - d) > 1e-5 * d) {
            EXPECT_EQ(grown.contains(f), before.contains(f) || mean <= d) << "face " << f;
        }
    }
    EXPECT_GT(grown.size(), before.size());
}

// Equation 5.1 against its full matrix and its purpose.
#include "ostraka/reconstruction/vertex_assignment.h"

#include "meshes.h"

#include "ostraka/annotation/outline.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace ostraka {
namespace {

/// A plate of columns x rows squares with slightly uneven vertices, so that no two distances are equal.
Mesh plate(Index columns, Index rows, double shift) {
    Mesh mesh = build_mesh(test::grid(columns, rows, false, false, [&](double u, double v) {
        return std::array<double, 3>{u * columns + shift + 0.1 * std::sin(5 * u + 3 * v),
                                     v * rows + 0.1 * std::cos(7 * u - 2 * v + shift), 0.05 * std::sin(9 * u * v + shift)};
    }));
    return mesh;
}

Annotation region(const Mesh& mesh, double x0, double x1, double y0, double y1) {
    Annotation annotation;
    annotation.type = AnnotationType::region;
    for (const Face face : mesh.faces()) {
        const Point c = centroid(mesh, face);
        if (c.x() > x0 && c.x() < x1 && c.y() > y0 && c.y() < y1) annotation.faces.push_back(face);
    }
    return annotation;
}

/// The full cost matrix of two regions, each with one closed outline.
struct Full {
    std::vector<Index> ours, theirs;
    std::vector<std::vector<double>> cost;
};

double arc_length(const Mesh& mesh, const Outline& loop, Index from, Index to) {
    std::size_t i = static_cast<std::size_t>(std::find(loop.begin(), loop.end(), from) - loop.begin());
    double sum = 0;
    for (; loop[i] != to; i = (i + 1) % loop.size())
        sum += std::sqrt(CGAL::squared_distance(mesh.point(Vertex(loop[i])), mesh.point(Vertex(loop[(i + 1) % loop.size()]))));
    return sum;
}

Full full_costs(const Mesh& a, const Annotation& part, const Mesh& b, const Annotation& other,
                const std::vector<std::pair<Index, Index>>& landmarks, const VertexAssignmentOptions& options) {
    Full full{touched_vertices(a, part), touched_vertices(b, other), {}};
    const Outline ours = extract_outlines(a, part.faces).at(0), theirs = extract_outlines(b, other.faces).at(0);
    const auto on = [](const Outline& loop, Index v) { return std::find(loop.begin(), loop.end(), v) != loop.end(); };
    std::vector<std::vector<std::array<double, 3>>> raw(full.ours.size());
    std::array<double, 3> minimum, maximum;
    minimum.fill(std::numeric_limits<double>::infinity());
    maximum.fill(-1);
    for (std::size_t i = 0; i < full.ours.size(); ++i)
        for (const Index w : full.theirs) {
            const Index v = full.ours[i];
            const bool x = on(ours, v), y = on(theirs, w);
            double outline = 0;
            if (x && y)
                for (const auto& [l, m] : landmarks) outline += std::abs(arc_length(a, ours, v, l) - arc_length(b, theirs, w, m));
            raw[i].push_back(
                {x == y ? 0.0 : 1.0, std::sqrt(CGAL::squared_distance(a.point(Vertex(v)), b.point(Vertex(w)))), outline});
            for (std::size_t k = 0; k < 3; ++k) {
                minimum[k] = std::min(minimum[k], raw[i].back()[k]);
                maximum[k] = std::max(maximum[k], raw[i].back()[k]);
            }
        }
    const std::array<double, 3> weight{options.boundary, options.distance, options.outline};
    for (const auto& row : raw) {
        full.cost.emplace_back();
        for (const auto& costs : row) {
            double sum = 0;
            for (std::size_t k = 0; k < 3; ++k)
                sum += maximum[k] > minimum[k] ? weight[k] * (costs[k] - minimum[k]) / (maximum[k] - minimum[k]) : 0;
            full.cost.back().push_back(sum);
        }
    }
    return full;
}

TEST(VertexAssignment, IsTheMinimumOfTheFullMatrix) {
    const Mesh a = plate(14, 12, 0), b = plate(17, 11, 0.3);
    const Annotation ours = region(a, 2, 9, 2, 8), theirs = region(b, 4, 12, 3, 9);
    const Outline outline_a = extract_outlines(a, ours.faces).at(0), outline_b = extract_outlines(b, theirs.faces).at(0);
    const std::vector<std::pair<Index, Index>> landmarks{{outline_a[0], outline_b[2]}, {outline_a[9], outline_b[13]}};
    for (const auto& weights : {std::array<double, 3>{1, 1, 1}, {0.2, 1, 3}, {0, 1, 0}, {0.05, 0.5, 0}}) {
        VertexAssignmentOptions options;
        options.boundary = weights[0];
        options.distance = weights[1];
        options.outline = weights[2];
        const Full full = full_costs(a, ours, b, theirs, landmarks, options);
        const VertexAssignment assignment = assign_vertices(a, ours, b, theirs, landmarks, options);
        ASSERT_EQ(assignment.vertices, full.ours);
        double total = 0;
        for (std::size_t i = 0; i < full.ours.size(); ++i) {
            const auto minimum = std::min_element(full.cost[i].begin(), full.cost[i].end());
            EXPECT_NEAR(assignment.cost[i], *minimum, 1e-12);
            EXPECT_EQ(assignment.counterpart[i], full.theirs[static_cast<std::size_t>(minimum - full.cost[i].begin())]);
            total += *minimum;
        }
        EXPECT_NEAR(assignment.total, total, 1e-9);
    }
}

TEST(VertexAssignment, OneToOneIsTheMinimumOverAllPermutations) {
    const Mesh a = plate(6, 6, 0), b = plate(7, 6, 0.2);
    const Annotation ours = region(a, 1.9, 4.1, 1.9, 3.1), theirs = region(b, 1.9, 4.2, 1.9, 4.1);
    VertexAssignmentOptions options;
    options.counterpart = VertexAssignmentOptions::Counterpart::one_to_one;
    options.candidates = 1000;
    options.unassigned = 10;
    const Full full = full_costs(a, ours, b, theirs, {}, options);
    const std::size_t n = full.ours.size(), m = full.theirs.size();
    ASSERT_LE(n, 8U);
    ASSERT_LE(n, m);
    ASSERT_LE(m, 10U);
    std::vector<std::size_t> order(m);
    std::iota(order.begin(), order.end(), 0);
    double best = std::numeric_limits<double>::infinity();
    do {
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) sum += full.cost[i][order[i]];
        best = std::min(best, sum);
        std::reverse(order.begin() + static_cast<std::ptrdiff_t>(n), order.end());
    } while (std::next_permutation(order.begin(), order.end()));
    const VertexAssignment assignment = assign_vertices(a, ours, b, theirs, {}, options);
    EXPECT_NEAR(assignment.total, best, 1e-6);
    const std::set<Index> used(assignment.counterpart.begin(), assignment.counterpart.end());
    EXPECT_EQ(used.size(), n);
    EXPECT_FALSE(used.contains(no_index));
}

TEST(VertexAssignment, NoVertexIsUsedTwiceAndTheRestStaysUnassigned) {
    const Mesh a = plate(20, 20, 0), b = plate(9, 9, 0.1);
    const Annotation ours = region(a, 1, 8, 1, 8), theirs = region(b, 2, 6, 2, 6);
    VertexAssignmentOptions options;
    options.counterpart = VertexAssignmentOptions::Counterpart::one_to_one;
    const VertexAssignment assignment = assign_vertices(a, ours, b, theirs, {}, options);
    std::multiset<Index> used(assignment.counterpart.begin(), assignment.counterpart.end());
    EXPECT_GT(used.count(no_index), 0U);
    for (const Index v : used)
        if (v != no_index) {
            EXPECT_EQ(used.count(v), 1U);
        }
    for (std::size_t i = 0; i < assignment.cost.size(); ++i)
        EXPECT_EQ(std::isinf(assignment.cost[i]), assignment.counterpart[i] == no_index);
}

/// Figure 5.15: two eyes of other shape, one above the other; by distance alone the upper arch of the lower goes to the lower
/// arch of the upper.
TEST(VertexAssignment, LandmarksOnTheOutlineKeepArchesApart) {
    const auto eye = [](double height, double rise) {
        return build_mesh(test::grid(24, 6, false, false, [&](double u, double v) {
            const double x = 2 * u - 1, arch = 1 - x * x;
            return std::array<double, 3>{x, height + rise * arch * (2 * v - 1) * 0.999 + 1e-3 * (2 * v - 1), 0};
        }));
    };
    // Embedded in frames, so that outlines are not borders of the mesh: rows 1 to 4 of 6.
    const Mesh lower = eye(0, 0.6), upper = eye(0.5, 0.3);
    const auto middle = [](const Mesh& mesh) {
        Annotation annotation;
        annotation.type = AnnotationType::region;
        for (const Face face : mesh.faces())
            if (const Index row = static_cast<Index>(face) / 48, column = static_cast<Index>(face) % 48 / 2;
                row >= 1 && row <= 4 && column >= 1 && column <= 22)
                annotation.faces.push_back(face);
        return annotation;
    };
    const Annotation ours = middle(lower), theirs = middle(upper);
    const auto vertex = [](Index column, Index row) { return row * 25 + column; };
    const std::vector<std::pair<Index, Index>> apices{{vertex(1, 3), vertex(1, 3)}, {vertex(23, 3), vertex(23, 3)}};
    VertexAssignmentOptions options;
    const auto wrong = [&](const VertexAssignment& assignment) {
        int count = 0;
        for (std::size_t i = 0; i < assignment.vertices.size(); ++i) {
            const Index row = assignment.vertices[i] / 25, column = assignment.vertices[i] % 25;
            if (row != 5 || column < 4 || column > 20) continue;  // the upper arch
            count += assignment.counterpart[i] / 25 != 5 ? 1 : 0;
        }
        return count;
    };
    options.outline = 0;
    EXPECT_GT(wrong(assign_vertices(lower, ours, upper, theirs, apices, options)), 5);
    options.outline = 3;
    EXPECT_EQ(wrong(assign_vertices(lower, ours, upper, theirs, apices, options)), 0);
}

TEST(VertexAssignment, RejectsDistantAndOppositeVerticesAndHandlesPointsAndLines) {
    const Mesh a = plate(12, 12, 0), b = plate(12, 12, 0);
    const Annotation ours = region(a, 2, 9, 2, 9), theirs = region(b, 2, 9, 2, 9);
    VertexAssignmentOptions options;
    const VertexAssignment same = assign_vertices(a, ours, b, theirs, {}, options);
    EXPECT_EQ(same.counterpart, same.vertices);
    EXPECT_EQ(same.total, 0);
    TriangleSoup flipped = to_soup(b);
    for (auto& t : flipped.triangles) std::swap(t[1], t[2]);
    options.angle = 60;
    for (const Index v : assign_vertices(a, ours, build_mesh(flipped), theirs, {}, options).counterpart) EXPECT_EQ(v, no_index);
    Mesh far_away = b;
    for (const Vertex v : far_away.vertices()) far_away.point(v) = far_away.point(v) + Vector(0, 0, 5);
    options.search_radius = 4;
    for (const Index v : assign_vertices(a, ours, far_away, theirs, {}, options).counterpart) EXPECT_EQ(v, no_index);
    Annotation point, line;
    point.type = AnnotationType::point;
    point.points = {40};
    line.type = AnnotationType::line;
    line.polylines = {{14, 15, 16, 17}};
    EXPECT_EQ(assign_vertices(a, point, b, point).counterpart, std::vector<Index>{40});
    EXPECT_EQ(assign_vertices(a, line, b, line, {{14, 14}}).counterpart, (std::vector<Index>{14, 15, 16, 17}));
    EXPECT_THROW(assign_vertices(a, Annotation(), b, theirs), Error);
    EXPECT_THROW(assign_vertices(a, ours, b, theirs, {{100000, 0}}), Error);
}

TEST(VertexAssignment, TheSameForAnyNumberOfThreads) {
    const Mesh a = plate(40, 40, 0), b = plate(35, 35, 0.4);
    const Annotation ours = region(a, 2, 30, 2, 30), theirs = region(b, 4, 33, 4, 33);
    const int before = threads();
    for (const std::string mode : {"best", "one-to-one"}) {
        VertexAssignmentOptions options;
        set_option(options, "counterpart", mode);
        set_threads(1);
        const VertexAssignment single_threaded = assign_vertices(a, ours, b, theirs, {}, options);
        set_threads(4);
        const VertexAssignment many = assign_vertices(a, ours, b, theirs, {}, options);
        set_threads(before);
        EXPECT_EQ(single_threaded.counterpart, many.counterpart);
        EXPECT_EQ(single_threaded.cost, many.cost);
    }
}

}  // namespace
}  // namespace ostraka

// Every answer of the tree against brute force.
#include "ostraka/geom/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace ostraka;

namespace {

double squared(const Point& p, const Point& q) {
    const double x = p.x() - q.x(), y = p.y() - q.y(), z = p.z() - q.z();
    return x * x + y * y + z * z;
}

/// Nearest first; in case of a tie, the lower index.
std::vector<std::pair<double, Index>> ranked(const std::vector<Point>& points, const Point& place) {
    std::vector<std::pair<double, Index>> list;
    for (Index i = 0; i < points.size(); ++i) list.emplace_back(squared(points[i], place), i);
    std::sort(list.begin(), list.end());
    return list;
}

void compare(const std::vector<Point>& points, const std::vector<Point>& places) {
    const PointTree tree(points);
    ASSERT_EQ(tree.size(), points.size());
    for (const Point& place : places) {
        const auto all = ranked(points, place);
        const PointTree::Near nearest = tree.nearest(place);
        EXPECT_EQ(std::pair(nearest.squared, nearest.index), all.front());
        EXPECT_EQ(tree.farthest_squared(place), all.back().first);
        for (const std::size_t count : {std::size_t{1}, std::size_t{7}, points.size(), points.size() + 5}) {
            const auto near = tree.neighbours(place, count);
            ASSERT_EQ(near.size(), std::min(count, points.size()));
            for (std::size_t k = 0; k < near.size(); ++k) EXPECT_EQ(std::pair(near[k].squared, near[k].index), all[k]) << k;
        }
        const double search_radius = std::sqrt(all[all.size() / 3].first);
        std::vector<Index> expected, neighbours{5, 5, 5};
        for (Index i = 0; i < points.size(); ++i)
            if (squared(points[i], place) <= search_radius * search_radius) expected.push_back(i);
        tree.within(place, search_radius, neighbours);
        EXPECT_EQ(neighbours, expected);
        if (all.front().first == 0) continue;
        EXPECT_EQ(tree.nearest(place, 0.999 * std::sqrt(all.front().first)).index, no_index);
    }
}

std::vector<Point> cloud(std::size_t count, unsigned seed, const Point& middle, std::array<double, 3> size) {
    std::mt19937 random(seed);
    const auto at = [&](double where, double extent) {
        return where + extent * (static_cast<double>(random()) / 4294967296.0 - 0.5);
    };
    std::vector<Point> points;
    for (std::size_t i = 0; i < count; ++i)
        points.emplace_back(at(middle.x(), size[0]), at(middle.y(), size[1]), at(middle.z(), size[2]));
    return points;
}

}  // namespace

TEST(PointTree, RandomPointsFromNearAndFar) {
    for (const std::size_t count : {1UL, 2UL, 12UL, 13UL, 14UL, 100UL, 1000UL}) {
        const auto points = cloud(count, 1, Point(0, 0, 0), {1, 2, 3});
        compare(points, cloud(20, 2, Point(0, 0, 0), {2, 3, 4}));
        compare(points, cloud(20, 3, Point(50, -20, 10), {30, 30, 30}));
    }
}

TEST(PointTree, NoPoints) {
    const PointTree tree;
    EXPECT_EQ(tree.size(), 0U);
    const Point place(1, 2, 3);
    EXPECT_EQ(tree.nearest(place).index, no_index);
    EXPECT_TRUE(std::isinf(tree.nearest(place).squared));
    EXPECT_TRUE(tree.neighbours(place, 3).empty());
    EXPECT_EQ(tree.farthest_squared(place), 0);
    std::vector<Index> neighbours{1};
    tree.within(place, 1e300, neighbours);
    EXPECT_TRUE(neighbours.empty());
}

TEST(PointTree, ZeroNeighboursAreRequested) { EXPECT_TRUE(PointTree({Point(0, 0, 0)}).neighbours(Point(0, 0, 0), 0).empty()); }

TEST(PointTree, TheSearchRadiusIsInclusive) {
    const PointTree tree({Point(0, 0, 0), Point(0, 0, 0), Point(3, 0, 0)});
    std::vector<Index> neighbours;
    tree.within(Point(0, 0, 0), 0, neighbours);
    EXPECT_EQ(neighbours, (std::vector<Index>{0, 1}));
    tree.within(Point(0, 0, 0), 3, neighbours);
    EXPECT_EQ(neighbours, (std::vector<Index>{0, 1, 2}));
    EXPECT_EQ(tree.nearest(Point(5, 0, 0), 2).index, 2U);
    EXPECT_EQ(tree.nearest(Point(5, 0, 0), 1.9).index, no_index);
}

TEST(PointTree, CoincidentPointsAreOrderedByIndex) {
    std::vector<Point> points(500, Point(1, 1, 1));
    points[77] = Point(2, 2, 2);
    compare(points, {Point(1, 1, 1), Point(0, 0, 0), Point(2, 2, 2), Point(1.5, 1.5, 1.5)});
}

TEST(PointTree, AGridHasManyEquallyNear) {
    std::vector<Point> points;
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j)
            for (int k = 0; k < 9; ++k) points.emplace_back(i, j, k);
    std::shuffle(points.begin(), points.end(), std::mt19937(4));
    compare(points, {Point(4, 4, 4), Point(4.5, 4.5, 4.5), Point(4.5, 4, 4), Point(-3, 4, 4), Point(100, 100, 100)});
}

TEST(PointTree, PointsInAPlaneAndOnALine) {
    const auto places = cloud(20, 5, Point(0, 0, 0), {2, 2, 2});
    compare(cloud(400, 6, Point(0, 0, 0), {1, 1, 0}), places);
    compare(cloud(400, 7, Point(0, 0, 0), {0, 1, 0}), places);
}

TEST(PointTree, FarFromTheOriginAndOfAnySize) {
    for (const double size : {1e-3, 1.0, 1e6}) {
        const Point middle(1e8, -1e8, 3e7);
        compare(cloud(400, 8, middle, {size, size, size}), cloud(20, 9, middle, {2 * size, 2 * size, 2 * size}));
    }
    compare(cloud(400, 10, Point(0, 0, 0), {1e-100, 1e-100, 1e-100}), {Point(0, 0, 0), Point(1e-100, 0, 0)});
    compare(cloud(400, 11, Point(0, 0, 0), {1e100, 1e100, 1e100}), {Point(0, 0, 0), Point(1e100, 0, 0)});
}

TEST(PointTree, IsMoved) {
    PointTree tree({Point(0, 0, 0)});
    PointTree other({Point(5, 0, 0), Point(6, 0, 0)});
    tree = std::move(other);
    EXPECT_EQ(tree.size(), 2U);
    EXPECT_EQ(tree.nearest(Point(9, 0, 0)).index, 1U);
}

TEST(PointTree, ManyCoincidentPointsAreNotSearchedRepeatedly) {
    const std::vector<Point> heap(200'000, Point(1, 2, 3));
    const PointTree tree(heap);
    for (int i = 0; i < 20'000; ++i) {  // each in the time of a search, independent of the number of coincident points
        EXPECT_EQ(tree.nearest(Point(1, 2, 3)).index, 0U);
        const auto two = tree.neighbours(Point(1, 2, 3), 2);
        EXPECT_EQ(std::pair(two[0].index, two[1].index), std::pair(Index{0}, Index{1}));
    }
}

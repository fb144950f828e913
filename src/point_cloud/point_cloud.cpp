#include "ostraka/point_cloud/point_cloud.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/point_tree.h"

#include <CGAL/jet_estimate_normals.h>
#include <CGAL/mst_orient_normals.h>
#include <CGAL/property_map.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>

namespace ostraka {

namespace {

using NumberedPoint = std::tuple<Point, Vector, std::size_t>;

/// Keeps the first of points that coincide, up to rounding of coordinates between -1 and 1: no surface can be fitted to them.
/// Returns for each point the first one at its place.
std::vector<std::size_t> keep_distinct(std::vector<NumberedPoint>& cloud) {
    constexpr double steps = 1125899906842624.0;  // 2^50
    std::vector<std::array<std::int64_t, 3>> key(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i)
        for (int k = 0; k < 3; ++k) key[i][static_cast<std::size_t>(k)] = std::llround(std::get<0>(cloud[i])[k] * steps);
    std::vector<std::size_t> order(cloud.size()), first(cloud.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return key[a] != key[b] ? key[a] < key[b] : a < b; });
    for (std::size_t j = 0; j < order.size(); ++j)
        first[order[j]] = j > 0 && key[order[j]] == key[order[j - 1]] ? first[order[j - 1]] : order[j];
    std::erase_if(cloud, [&](const NumberedPoint& point) { return first[std::get<2>(point)] != std::get<2>(point); });
    return first;
}

}  // namespace

double point_spacing(const std::vector<Point>& points) {
    constexpr std::size_t neighbour_rank = 6;
    if (points.size() <= neighbour_rank) fail_input("points", "there are only " + std::to_string(points.size()), "give more");
    const PointTree tree(points);
    std::vector<double> distance(points.size());
    parallel_for(points.size(),
                 [&](std::size_t i) { distance[i] = std::sqrt(tree.neighbours(points[i], neighbour_rank + 1).back().squared); });
    double sum = 0;
    for (const double d : distance) sum += d;
    return sum / static_cast<double>(points.size());
}

std::vector<Vector> estimate_normals(const std::vector<Point>& points, const CloudOptions& options) {
    check_options(options, "points");
    const auto neighbour_count = static_cast<unsigned>(options.neighbours);
    if (points.size() <= neighbour_count)
        fail_input("points", fmt::format("there are {}, too few for normals from {} neighbours", points.size(), neighbour_count),
                   "give more, or fewer neighbours");
    // Normalised to centre 0 and size 1, as the coordinates are squared and multiplied below.
    CGAL::Bbox_3 box;
    for (const Point& p : points) box += p.bbox();
    const Point middle((box.xmin() + box.xmax()) / 2, (box.ymin() + box.ymax()) / 2, (box.zmin() + box.zmax()) / 2);
    const double size = std::max({box.x_span(), box.y_span(), box.z_span()});
    if (!(size > 0)) fail_input("points", "all coincide", "export them again");
    std::vector<NumberedPoint> cloud;
    cloud.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        cloud.emplace_back(CGAL::ORIGIN + (points[i] - middle) / size, CGAL::NULL_VECTOR, i);
    const std::vector<std::size_t> first = keep_distinct(cloud);
    if (cloud.size() <= neighbour_count)
        fail_input("points", fmt::format("only {} of {} differ by more than rounding", cloud.size(), points.size()),
                   "remove points that are far away from the others, or export them again");
    const auto property_maps = CGAL::parameters::point_map(CGAL::Nth_of_tuple_property_map<0, NumberedPoint>())
                                   .normal_map(CGAL::Nth_of_tuple_property_map<1, NumberedPoint>());
    CGAL::jet_estimate_normals<CGAL::Sequential_tag>(cloud, neighbour_count, property_maps);
    // Moves the points that it can orient to the front.
    CGAL::mst_orient_normals(cloud, neighbour_count, property_maps);
    std::vector<Vector> normals(points.size());
    double flux = 0;
    for (const auto& [position, normal, number] : cloud) normals[number] = normal;
    for (std::size_t i = 0; i < points.size(); ++i) normals[i] = normals[first[i]];
    for (std::size_t i = 0; i < points.size(); ++i) flux += normals[i] * (points[i] - middle) / size;
    if (flux < 0)
        for (Vector& n : normals) n = -n;
    return normals;
}

void CloudOptions::declare_options(OptionList& list) {
    list("cloud-neighbours", neighbours, "for point clouds: number of neighbours from which a normal is estimated",
         Range{6, 1000});
    list("cloud-edge", longest, "for point clouds: maximum edge length, in multiples of the point spacing; 0: no limit",
         Range{0, 1e6});
    list("cloud-holes", close_holes, "for point clouds: maximum width of a hole that is filled", Range{0, 1},
         "share of the diagonal");
}

}  // namespace ostraka

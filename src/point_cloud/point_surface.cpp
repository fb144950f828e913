// Surface reconstruction from points.
#include "point_cloud/surface_parts.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/io/repair.h"
#include "ostraka/point_cloud/point_cloud.h"

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <fmt/core.h>

#include <algorithm>
#include <tuple>
#include <unordered_map>

namespace ostraka {

namespace {

/// The library orders border edges of the front whose priorities are equal by their addresses. This class numbers them in the
/// order of their first use on this thread, during the lifetime of the object, so that the surface depends on the points alone.
class EdgeNumbers {
public:
    EdgeNumbers() : before_(current()) { current() = this; }
    ~EdgeNumbers() { current() = before_; }
    EdgeNumbers(const EdgeNumbers&) = delete;
    EdgeNumbers& operator=(const EdgeNumbers&) = delete;

    static std::size_t number(const void* edge) {
        return current()->numbers_.try_emplace(edge, current()->numbers_.size()).first->second;
    }

private:
    static EdgeNumbers*& current() {
        thread_local EdgeNumbers* numbers = nullptr;
        return numbers;
    }
    EdgeNumbers* before_;
    std::unordered_map<const void*, std::size_t> numbers_;
};

/// The library's vertex, with numbered border edges.
template <class Base>
class FrontVertex : public Base {
public:
    template <class Triangulation>
    struct Rebind_TDS {
        using Other = FrontVertex<typename Base::template Rebind_TDS<Triangulation>::Other>;
    };
    using Base::Base;

    struct Radius_ptr_type {
        typename Base::criteria first;
        typename Base::IO_edge_type* second;
        std::size_t number;

        Radius_ptr_type(typename Base::criteria priority, typename Base::IO_edge_type* edge)
            : first(priority), second(edge), number(EdgeNumbers::number(edge)) {}
        bool operator<(const Radius_ptr_type& other) const {
            return std::tie(first, number) < std::tie(other.first, other.number);
        }
    };
};

/// Gives edges far longer than the point spacing the worst priority, so that the front never crosses them.
struct EdgeLimit {
    double longest;
    template <class Reconstruction, class Cell>
    double operator()(const Reconstruction& reconstruction, Cell& cell, const int& index) const {
        if (longest > 0) {
            const auto& triangulation = reconstruction.triangulation_3();
            for (int i = 1; i <= 3; ++i) {
                const auto &p = triangulation.point(cell, (index + i) % 4),
                           &q = triangulation.point(cell, (index + i % 3 + 1) % 4);
                if (CGAL::squared_distance(p, q) > longest * longest) return std::numeric_limits<double>::infinity();
            }
        }
        return reconstruction.smallest_radius_delaunay_sphere(cell, index);
    }
};

/// Triples of point indices: the triangles of the surface through the points. Results depend on the points alone.
std::vector<std::array<std::size_t, 3>> surface_triangles(const std::vector<Point>& points, double longest_edge) {
    using Vertex = FrontVertex<clouds::Stamped<CGAL::Advancing_front_surface_reconstruction_vertex_base_3<Kernel>>>;
    using Cell = clouds::Stamped<CGAL::Advancing_front_surface_reconstruction_cell_base_3<Kernel>>;
    using Triangulation = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;
    std::vector<std::pair<Point, std::size_t>> numbered;
    for (const Point& p : points) numbered.emplace_back(p, numbered.size());
    Triangulation triangulation(numbered.begin(), numbered.end());
    const EdgeNumbers numbers;
    CGAL::Advancing_front_surface_reconstruction<Triangulation, EdgeLimit> front(triangulation, EdgeLimit{longest_edge});
    front.run();
    std::vector<std::array<std::size_t, 3>> triangles;
    CGAL::write_triple_indices(std::back_inserter(triangles), front);
    return triangles;
}

bool on_a_line(const std::vector<Point>& points) {
    const auto farthest = std::max_element(points.begin(), points.end(), [&](const Point& p, const Point& q) {
        return CGAL::squared_distance(points.front(), p) < CGAL::squared_distance(points.front(), q);
    });
    constexpr double tolerance = 1e-20;  // squared, for points of size 1
    const Vector along = *farthest - points.front();
    return std::all_of(points.begin(), points.end(), [&](const Point& p) {
        return CGAL::cross_product(p - points.front(), along).squared_length() <= tolerance;
    });
}

}  // namespace

CloudSurface reconstruct_surface(const PointCloud& cloud, const CloudOptions& options) {
    check_options(options, "points");
    const std::vector<Vector> estimated =
        cloud.normals.size() == cloud.points.size() ? std::vector<Vector>() : estimate_normals(cloud.points, options);
    const std::vector<Vector>& normals = estimated.empty() ? cloud.normals : estimated;
    const std::vector<Point> points = clouds::Normalised(cloud.points).points();
    std::vector<std::array<std::size_t, 3>> facets;
    if (!on_a_line(points)) facets = surface_triangles(points, options.longest * point_spacing(points));
    if (facets.empty()) fail_input("points", "do not define a surface", "check whether they are collinear or coincide");
    CloudSurface result;
    std::vector<Index> number(cloud.points.size(), no_index);
    for (const auto& facet : facets)
        for (const std::size_t i : facet) number[i] = 0;
    TriangleSoup soup;
    for (std::size_t i = 0; i < number.size(); ++i) {
        if (number[i] == no_index) continue;
        number[i] = static_cast<Index>(soup.points.size());
        result.sources.push_back(static_cast<Index>(i));
        soup.points.push_back({cloud.points[i].x(), cloud.points[i].y(), cloud.points[i].z()});
    }
    double agreement = 0;
    for (const auto& facet : facets) {
        soup.triangles.push_back({number[facet[0]], number[facet[1]], number[facet[2]]});
        const Vector area =
            CGAL::cross_product(cloud.points[facet[1]] - cloud.points[facet[0]], cloud.points[facet[2]] - cloud.points[facet[0]]);
        agreement += area * (normals[facet[0]] + normals[facet[1]] + normals[facet[2]]);
    }
    if (agreement < 0)
        for (auto& triangle : soup.triangles) std::swap(triangle[1], triangle[2]);
    if (const std::size_t unused_count = cloud.points.size() - soup.points.size(); unused_count > 0)
        result.notes.push_back(std::to_string(unused_count) + " points are not on any face");
    RepairOptions repair_options;
    repair_options.fill_holes_size = options.close_holes;
    RepairResult repaired = repair(soup, {}, repair_options);
    result.mesh = std::move(repaired.mesh);
    std::vector<Index> sources;
    for (const Index source : repaired.vertex_source) sources.push_back(source == no_index ? no_index : result.sources[source]);
    result.sources = std::move(sources);
    clouds::count_borders(repaired.after, result);
    if (result.border_loops > 0)
        result.notes.push_back(
            fmt::format("the surface has {} where there are no points", counted(result.border_loops, "border")));
    return result;
}

}  // namespace ostraka

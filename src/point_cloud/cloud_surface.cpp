// Trimming of surfaces, outliers of clouds, attributes carried to a surface.
#include "point_cloud/surface_parts.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/point_tree.h"
#include "ostraka/io/repair.h"
#include "ostraka/point_cloud/cloud_surface.h"

#include <fmt/core.h>

#include <cmath>

namespace ostraka {

double trim_surface(CloudSurface& surface, const std::vector<Point>& points, double distance) {
    const PointTree tree(points);
    const Mesh& mesh = surface.mesh;
    std::vector<char> is_near(mesh.number_of_vertices(), 0), keep(mesh.number_of_faces(), 0);
    const auto near = [&](const Point& place) { return tree.nearest(place, distance).index != no_index; };
    parallel_for(is_near.size(), [&](std::size_t v) { is_near[v] = near(mesh.point(Vertex(static_cast<Index>(v)))) ? 1 : 0; });
    parallel_for(keep.size(), [&](std::size_t f) {
        const auto corner = corners(mesh, Face(static_cast<Index>(f)));
        bool all = near(centroid(mesh, Face(static_cast<Index>(f))));
        for (std::size_t k = 0; k < 3 && all; ++k)
            all = is_near[corner[k]] != 0 && near(CGAL::midpoint(mesh.point(corner[k]), mesh.point(corner[(k + 1) % 3])));
        keep[f] = all ? 1 : 0;
    });
    TriangleSoup soup = to_soup(mesh);
    double area = 0;
    std::size_t kept = 0;
    for (std::size_t f = 0; f < keep.size(); ++f) {
        if (keep[f] != 0) soup.triangles[kept++] = soup.triangles[f];
        else area += face_area(mesh, Face(static_cast<Index>(f)));
    }
    if (kept == keep.size()) return 0;
    if (kept == 0) fail_input("points", fmt::format("no triangle lies within {} of them", distance), "trim by a larger distance");
    soup.triangles.resize(kept);
    RepairOptions options;
    options.fill_holes = 0;
    RepairResult repaired = repair(soup, {}, options);
    std::vector<Index> sources;
    sources.reserve(repaired.vertex_source.size());
    for (const Index source : repaired.vertex_source) sources.push_back(source == no_index ? no_index : surface.sources[source]);
    surface.mesh = std::move(repaired.mesh);
    surface.sources = std::move(sources);
    clouds::count_borders(repaired.after, surface);
    return area;
}

std::size_t remove_outliers(PointCloud& cloud, double factor, int neighbours) {
    const auto count = static_cast<std::size_t>(neighbours);
    if (cloud.points.size() <= count)
        fail_input("points", fmt::format("there are {}, too few to find outliers", cloud.points.size()), "keep all points");
    const PointTree tree(cloud.points);
    std::vector<double> means(cloud.points.size());
    parallel_for(means.size(), [&](std::size_t i) {
        double sum = 0;
        for (const PointTree::Near& near : tree.neighbours(cloud.points[i], count + 1)) sum += std::sqrt(near.squared);
        means[i] = sum / static_cast<double>(count);
    });
    std::vector<double> sorted = means;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double limit = factor * *middle;
    std::size_t kept = 0;
    for (const double mean : means) kept += mean <= limit ? 1 : 0;
    if (2 * kept < means.size()) fail_input("points", "more than half of them would be outliers", "allow a larger distance");
    const auto keep = [&](auto& list) {
        if (list.empty()) return;
        std::size_t next = 0;
        for (std::size_t i = 0; i < means.size(); ++i)
            if (means[i] <= limit) list[next++] = list[i];
        list.resize(next);
    };
    keep(cloud.points);
    keep(cloud.normals);
    keep(cloud.colours);
    keep(cloud.intensities);
    return means.size() - kept;
}

namespace {

/// The points of a cloud that have a value, for means at other places.
class ValuedPoints {
public:
    template <class HasValue>
    ValuedPoints(const PointCloud& cloud, int neighbours, const HasValue& has_value)
        : neighbours_(static_cast<std::size_t>(neighbours)) {
        std::vector<Point> points;
        for (std::size_t i = 0; i < cloud.points.size(); ++i) {
            if (!has_value(i)) continue;
            points.push_back(cloud.points[i]);
            numbers_.push_back(static_cast<Index>(i));
        }
        tree_ = PointTree(points);
    }

    /// Calls add(point, weight) for the nearest points, with weights of sum 1; equal points share the weight.
    template <class Add>
    void weigh(const Point& place, const Add& add) const {
        const std::vector<PointTree::Near> nearest = tree_.neighbours(place, neighbours_);
        const bool at_point = !nearest.empty() && nearest.front().squared == 0;
        double sum = 0;
        const auto weight = [&](const PointTree::Near& near) {
            if (at_point) return near.squared == 0 ? 1.0 : 0.0;
            return std::sqrt(nearest.front().squared / near.squared);
        };
        for (const PointTree::Near& near : nearest) sum += weight(near);
        for (const PointTree::Near& near : nearest) add(numbers_[near.index], weight(near) / sum);
    }

private:
    std::size_t neighbours_;
    std::vector<Index> numbers_;
    PointTree tree_;
};

}  // namespace

MeshExtras carried_to_vertices(const PointCloud& cloud, const Mesh& mesh, int neighbours) {
    MeshExtras extras;
    const auto place = [&](std::size_t v) -> const Point& { return mesh.point(Vertex(static_cast<Index>(v))); };
    if (!cloud.colours.empty()) {
        const ValuedPoints coloured(cloud, neighbours, [&](std::size_t i) { return cloud.colours[i][3] != 0; });
        extras.vertex_colours.resize(mesh.number_of_vertices());
        parallel_for(extras.vertex_colours.size(), [&](std::size_t v) {
            std::array<double, 3> mean{};
            coloured.weigh(place(v), [&](Index point, double weight) {
                for (std::size_t k = 0; k < 3; ++k) mean[k] += weight * cloud.colours[point][k];
            });
            Colour& colour = extras.vertex_colours[v];
            for (std::size_t k = 0; k < 3; ++k) colour[k] = static_cast<std::uint8_t>(std::lround(mean[k]));
            colour[3] = 255;
        });
    }
    if (!cloud.intensities.empty()) {
        const ValuedPoints measured(cloud, neighbours, [&](std::size_t i) { return !std::isnan(cloud.intensities[i]); });
        std::vector<double> values(mesh.number_of_vertices());
        parallel_for(values.size(), [&](std::size_t v) {
            measured.weigh(place(v), [&](Index point, double weight) { values[v] += weight * cloud.intensities[point]; });
        });
        extras.vertex_values.push_back({"intensity", std::move(values)});
    }
    return extras;
}

}  // namespace ostraka

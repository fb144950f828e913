#include "texture/face_clusters.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/progress.h"
#include "ostraka/mesh/limits.h"
#include "ostraka/mesh/disjoint_sets.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace ostraka::texture {

namespace {

/// Share of its area that a cluster is taken to deviate from a plane anyway: clusters of flat surfaces grow evenly.
constexpr double even_growth = 1e-3;

/// A cone that contains directions; negative half_angle: no direction.
struct NormalCone {
    Vector axis = CGAL::NULL_VECTOR;
    double half_angle = -1;
};

/// The smallest cone around two cones, if its half angle is below pi / 2; else a cone with a larger half angle.
NormalCone joined_cone(const NormalCone& a, const NormalCone& b) {
    if (a.half_angle < 0) return b;
    if (b.half_angle < 0) return a;
    const double sine = std::sqrt(CGAL::cross_product(a.axis, b.axis).squared_length());
    const double between = std::atan2(sine, a.axis * b.axis);
    if (between + b.half_angle <= a.half_angle) return a;
    if (between + a.half_angle <= b.half_angle) return b;
    NormalCone result;
    result.half_angle = (a.half_angle + b.half_angle + between) / 2;
    const double turn = result.half_angle - a.half_angle;
    if (!(sine > 0)) return {a.axis, result.half_angle};
    result.axis = unit_vector(a.axis * (std::sin(between - turn) / sine) + b.axis * (std::sin(turn) / sine));
    return result;
}

struct Cluster {
    Vector area_vector = CGAL::NULL_VECTOR;
    double area = 0;
    NormalCone cone;
    unsigned stamp = 0;                                  ///< changes with each merge
    std::vector<std::pair<Index, double>> neighbours{};  ///< adjacent cluster (or a cluster merged into it), common length
};

struct Merge {
    double cost;
    Index first, second;
    unsigned first_stamp, second_stamp;
    bool operator<(const Merge& other) const {  // the cheapest merge is on top of the queue
        return std::tie(cost, first, second) > std::tie(other.cost, other.first, other.second);
    }
};

class Clustering {
public:
    Clustering(const Mesh& mesh, const ClusterLimits& limits)
        : limits_(limits), clusters_(mesh.number_of_faces()), sets_(mesh.number_of_faces()) {
        for (const Face face : mesh.faces()) {
            Cluster& cluster = clusters_[face];
            cluster.area_vector = area_vector(mesh, face);
            cluster.area = std::sqrt(cluster.area_vector.squared_length());
            const Vector normal = unit_vector(cluster.area_vector);
            if (normal != CGAL::NULL_VECTOR && smallest_height(mesh, face) > limits.negligible_width) cluster.cone = {normal, 0};
            for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(face))) {
                const Halfedge other = mesh.opposite(h);
                if (mesh.is_border(other)) continue;
                const double length =
                    std::sqrt(CGAL::squared_distance(mesh.point(mesh.source(h)), mesh.point(mesh.target(h))));
                cluster.neighbours.emplace_back(mesh.face(other), length);
            }
        }
        for (Index i = 0; i < clusters_.size(); ++i) tidy(i);
    }

    /// Merges clusters within the cone, in the order of costs; with `small` only where one of the two is small.
    void merge(double cone, bool small) {
        std::priority_queue<Merge> queue;
        const auto consider = [&](Index a, Index b, double length) {
            const Cluster &first = clusters_[a], &second = clusters_[b];
            if (small && std::min(first.area, second.area) > limits_.small_area) return;
            if (joined_cone(first.cone, second.cone).half_angle > cone) return;
            queue.push({cost(first, second, length), a, b, first.stamp, second.stamp});
        };
        for (Index i = 0; i < clusters_.size(); ++i) {
            if (sets_.find(i) != i) continue;
            tidy(i);
            for (const auto& [neighbour, length] : clusters_[i].neighbours)
                if (i < neighbour) consider(i, neighbour, length);
        }
        CancelCheck check;
        while (!queue.empty()) {
            check();
            const Merge next = queue.top();
            queue.pop();
            if (clusters_[next.first].stamp != next.first_stamp || clusters_[next.second].stamp != next.second_stamp) continue;
            const Index joined = join(next.first, next.second);
            for (const auto& [neighbour, length] : clusters_[joined].neighbours)
                consider(std::min(joined, neighbour), std::max(joined, neighbour), length);
        }
    }

    std::vector<std::vector<Index>> faces() {
        std::vector<std::vector<Index>> lists;
        std::vector<Index> list_of(clusters_.size(), no_index);
        for (Index i = 0; i < clusters_.size(); ++i) {
            Index& list = list_of[sets_.find(i)];
            if (list == no_index) {
                list = static_cast<Index>(lists.size());
                lists.emplace_back();
            }
            lists[list].push_back(i);
        }
        return lists;
    }

private:
    /// Twice the growth of the area that the normals' deviation from their mean costs (metric L2,1 of Cohen-Steiner, Alliez and
    /// Desbrun 2004), per length of the border that the merge removes.
    static double cost(const Cluster& a, const Cluster& b, double length) {
        const double whole = std::sqrt((a.area_vector + b.area_vector).squared_length());
        const double parts = std::sqrt(a.area_vector.squared_length()) + std::sqrt(b.area_vector.squared_length());
        const double area = a.area + b.area;
        const double smoothed = area > 0 ? even_growth * a.area * (b.area / area) : 0;
        const double growth = 2 * std::max(parts - whole, 0.0) + smoothed;
        return length > 0 ? growth / length : std::numeric_limits<double>::max();
    }

    /// Names each neighbour once, by its present index.
    void tidy(Index i) {
        auto& neighbours = clusters_[i].neighbours;
        for (auto& [neighbour, length] : neighbours) neighbour = sets_.find(neighbour);
        std::sort(neighbours.begin(), neighbours.end());
        std::size_t kept = 0;
        for (const auto& [neighbour, length] : neighbours) {
            if (neighbour == i) continue;
            if (kept > 0 && neighbours[kept - 1].first == neighbour) neighbours[kept - 1].second += length;
            else neighbours[kept++] = {neighbour, length};
        }
        neighbours.resize(kept);
    }

    Index join(Index a, Index b) {
        const Index kept = std::min(a, b), gone = std::max(a, b);
        sets_.unite(a, b);
        Cluster &cluster = clusters_[kept], &other = clusters_[gone];
        cluster.area_vector = cluster.area_vector + other.area_vector;
        cluster.area += other.area;
        cluster.cone = joined_cone(cluster.cone, other.cone);
        ++cluster.stamp, ++other.stamp;
        if (cluster.neighbours.size() < other.neighbours.size()) cluster.neighbours.swap(other.neighbours);
        cluster.neighbours.insert(cluster.neighbours.end(), other.neighbours.begin(), other.neighbours.end());
        other.neighbours = {};
        tidy(kept);
        return kept;
    }

    ClusterLimits limits_;
    std::vector<Cluster> clusters_;
    DisjointSets sets_;
};

}  // namespace

double smallest_height(const Mesh& mesh, Face face) {
    const auto [a, b, c] = corners(mesh, face);
    const Point &p = mesh.point(a), &q = mesh.point(b), &r = mesh.point(c);
    const double longest =
        std::sqrt(std::max({CGAL::squared_distance(p, q), CGAL::squared_distance(q, r), CGAL::squared_distance(r, p)}));
    return longest > 0 ? 2 * face_area(mesh, face) / longest : 0;
}

std::vector<std::vector<Index>> face_clusters(const Mesh& mesh, const ClusterLimits& limits) {
    Clustering clustering(mesh, limits);
    clustering.merge(limits.cone * degree, false);
    clustering.merge(limits.relaxed_cone * degree, true);
    return clustering.faces();
}

}  // namespace ostraka::texture

// Mean curvature skeleton of a part with filled holes.
#include "axis/axis_methods.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/run_interruptibly.h"
#include "ostraka/geom/submesh.h"
#include "ostraka/mesh/flood.h"

// The library orders the edges of its working mesh by their addresses, so that the result depends on its allocator. This one
// returns ascending addresses, independent of earlier allocations.
#include "axis/ascending_allocator.h"
#pragma push_macro("CGAL_ALLOCATOR")
#undef CGAL_ALLOCATOR
#define CGAL_ALLOCATOR(T) ostraka::detail::AscendingAllocator<T>
#include <CGAL/Polyhedron_3.h>
#pragma pop_macro("CGAL_ALLOCATOR")

#include <CGAL/Mean_curvature_flow_skeletonization.h>
#include <CGAL/Random.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <fmt/core.h>
#include <Eigen/Eigenvalues>

#include <queue>
#include <set>

namespace ostraka {

using namespace detail;

namespace {

/// The component of `faces`, connected over edges, of the largest area, and what is left out.
struct LargestPiece {
    std::vector<Index> faces;
    std::size_t others = 0;   ///< number of other components
    double others_share = 0;  ///< their share of the area
};
LargestPiece largest_piece(const Mesh& mesh, const std::vector<Index>& faces) {
    std::vector<bool> visited(mesh.number_of_faces(), true);
    for (const Index f : faces) visited[f] = false;
    LargestPiece best;
    double best_area = -1, whole = 0;
    std::size_t pieces = 0;
    for (const Index seed : faces) {
        if (visited[seed]) continue;
        const std::vector<Face> piece = flood_faces(mesh, Face(seed), visited);
        double area = 0;
        for (const Face f : piece) area += face_area(mesh, f);
        whole += area;
        ++pieces;
        if (area > best_area) best_area = area, best.faces.assign(piece.begin(), piece.end());
    }
    std::sort(best.faces.begin(), best.faces.end());
    best.others = pieces > 0 ? pieces - 1 : 0;
    best.others_share = whole > 0 ? 1 - best_area / whole : 0;
    return best;
}

/// Cuts edges longer than `longest` in the middle, the longest first: the flow contracts the corners of coarse meshes, such as a
/// box of 12 triangles, to a point. Stops at 100 000 faces.
void cut_long_edges(Mesh& mesh, double longest) {
    for (bool changed = true; changed && mesh.number_of_faces() < 100000;) {
        std::vector<std::pair<double, Index>> edges;
        for (const Edge e : mesh.edges()) {
            const Halfedge h = mesh.halfedge(e);
            const double squared = CGAL::squared_distance(mesh.point(mesh.source(h)), mesh.point(mesh.target(h)));
            if (squared > longest * longest) edges.emplace_back(-squared, e.idx());
        }
        std::sort(edges.begin(), edges.end());
        changed = !edges.empty();
        std::vector<bool> cut(mesh.num_faces(), false);  // each face is cut once per round, new faces not at all
        const auto used = [&](Face f) { return f.idx() >= cut.size() || cut[f.idx()]; };
        for (const auto& [squared, index] : edges) {
            const Halfedge h = mesh.halfedge(Edge(index)), o = mesh.opposite(h);
            if (mesh.is_border(h) || mesh.is_border(o) || used(mesh.face(h)) || used(mesh.face(o))) continue;
            cut[mesh.face(h)] = cut[mesh.face(o)] = true;
            const Point middle = CGAL::midpoint(mesh.point(mesh.source(h)), mesh.point(mesh.target(h)));
            // `before` ends at the new vertex; h continues from there.
            const Halfedge before = CGAL::Euler::split_edge(h, mesh);
            mesh.point(mesh.target(before)) = middle;
            CGAL::Euler::split_face(before, mesh.next(h), mesh);
            const Halfedge back = mesh.opposite(h);  // ends at the new vertex
            CGAL::Euler::split_face(back, mesh.next(mesh.next(back)), mesh);
        }
    }
}

/// The component as a separate mesh, moved to `centre` and scaled to diagonal 1, with its holes filled.
Mesh capped(const Mesh& mesh, const std::vector<Index>& faces, const Vector3d& centre, double scale) {
    std::map<Index, Index> number;
    TriangleSoup soup;
    for (const Index f : faces) {
        std::array<Index, 3> triangle{};
        std::size_t k = 0;
        for (const Vertex v : corners(mesh, Face(f))) {
            const auto [entry, added] = number.emplace(v.idx(), static_cast<Index>(soup.points.size()));
            if (added) {
                const Vector3d p = (eigen(mesh.point(v)) - centre) / scale;
                soup.points.push_back({p.x(), p.y(), p.z()});
            }
            triangle.at(k++) = entry->second;
        }
        soup.triangles.push_back(triangle);
    }
    Mesh part;
    if (try_build_mesh(soup, part).any())
        fail_input("part", "touches itself at a vertex",
                   "remove the faces that are connected only by a vertex, or use --method slices");
    for (const Halfedge hole : holes_of(part))
        if (close_hole(part, hole) == 0)
            fail_input("part", "has an opening that cannot be capped", "close it, or use --method slices");
    cut_long_edges(part, 0.05);
    return part;
}

/// Runs Eigen's products on the current thread only, during the lifetime of this object.
class OneThread {
public:
    OneThread() : before_(omp_get_max_threads()) { omp_set_num_threads(1); }
    ~OneThread() { omp_set_num_threads(before_); }
    OneThread(const OneThread&) = delete;
    OneThread& operator=(const OneThread&) = delete;

private:
    int before_;
};

struct Graph {
    std::vector<Vector3d> points;
    std::vector<std::vector<std::pair<std::size_t, double>>> links;
    double length = 0;
};

/// Distances from `start` and the predecessors on the shortest paths.
std::pair<std::vector<double>, std::vector<std::size_t>> shortest_paths(const Graph& graph, std::size_t start) {
    std::vector<double> distance(graph.points.size(), std::numeric_limits<double>::infinity());
    std::vector<std::size_t> predecessor(graph.points.size(), start);
    std::priority_queue<std::pair<double, std::size_t>, std::vector<std::pair<double, std::size_t>>, std::greater<>> queue;
    queue.emplace(distance[start] = 0, start);
    while (!queue.empty()) {
        const auto [path_length, v] = queue.top();
        queue.pop();
        if (path_length > distance[v]) continue;
        for (const auto& [next, length] : graph.links[v])
            if (path_length + length < distance[next]) {
                distance[next] = path_length + length;
                predecessor[next] = v;
                queue.emplace(distance[next], next);
            }
    }
    return {distance, predecessor};
}

std::size_t farthest(const std::vector<double>& distance) {
    return static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) - distance.begin());
}

std::vector<std::size_t> longest_path(const Graph& graph) {
    std::size_t leaf = graph.points.size();
    for (std::size_t v = 0; v < graph.points.size() && leaf == graph.points.size(); ++v)
        if (graph.links[v].size() == 1) leaf = v;
    std::vector<std::size_t> path;
    if (leaf == graph.points.size()) {
        // No leaf: follows a loop, as long as it does not branch.
        std::size_t last = 0, v = 0;
        do {
            path.push_back(v);
            if (graph.links[v].size() != 2) return {};
            const std::size_t next =
                graph.links[v][0].first == last && v != last ? graph.links[v][1].first : graph.links[v][0].first;
            last = v;
            v = next;
        } while (v != 0 && path.size() <= graph.points.size());
        path.push_back(0);
        return path;
    }
    const std::size_t one_end = farthest(shortest_paths(graph, leaf).first);
    const auto [distance, predecessor] = shortest_paths(graph, one_end);
    for (std::size_t v = farthest(distance);; v = predecessor[v]) {
        path.push_back(v);
        if (v == one_end) return path;
    }
}

/// The skeleton of a closed mesh.
Graph skeleton_of(const Mesh& part) {
    // For the same order of summation, whatever the number of threads and the earlier calls.
    const OneThread one_thread;
    CGAL::get_default_random() = CGAL::Random(0);
    const AscendingMemory memory(part.number_of_faces() * 2048 + (std::size_t{1} << 20U));
    using Skeletonization = CGAL::Mean_curvature_flow_skeletonization<Mesh>;
    static_assert(std::is_same_v<Skeletonization::mTriangleMesh::Allocator, AscendingAllocator<int>>);
    Skeletonization::Skeleton skeleton;
    Skeletonization flow(part);
    flow.contract_until_convergence();
    flow.convert_to_skeleton(skeleton);

    Graph graph;
    for (const auto v : CGAL::make_range(vertices(skeleton))) graph.points.push_back(eigen(skeleton[v].point));
    graph.links.resize(graph.points.size());
    for (const auto e : CGAL::make_range(edges(skeleton))) {
        const std::size_t a = source(e, skeleton), b = target(e, skeleton);
        const double length = (graph.points[a] - graph.points[b]).norm();
        graph.links[a].emplace_back(b, length);
        graph.links[b].emplace_back(a, length);
        graph.length += length;
    }
    return graph;
}

/// Whether all corners of the faces lie in one plane.
bool is_flat(const Mesh& mesh, const std::vector<Index>& faces, double scale) {
    constexpr double flatness = 1e-9;
    const Vector3d origin = eigen(mesh.point(corners(mesh, Face(faces.front()))[0]));
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const Index f : faces)
        for (const Vertex v : corners(mesh, Face(f))) {
            const Vector3d x = (eigen(mesh.point(v)) - origin) / scale;
            sum += x * x.transpose();
        }
    const Eigen::Vector3d squares = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum).eigenvalues();
    return squares[0] <= flatness * flatness * squares[2];
}

}  // namespace

Axis skeleton_axis(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options) {
    const AreaMoments moments = part_moments(mesh, faces, options);
    const LargestPiece largest = largest_piece(mesh, faces);
    const std::vector<Index>& piece = largest.faces;
    if (piece.size() > 200000)
        fail_input("part", fmt::format("has {} faces, too many for a skeleton", piece.size()), "simplify the mesh first");
    const Vector3d centre = eigen(moments.centroid);
    const double scale = part_diagonal(mesh, piece);
    if (is_flat(mesh, piece, scale)) {
        Axis flat;
        flat.reason = "it is flat: nothing is inside";
        return flat;
    }
    // The library's flow does not check for cancellation.
    using Job = std::pair<Mesh, Graph>;
    const Graph graph = run_interruptibly_on(Job(capped(mesh, piece, centre, scale), {}), [](Job& job) {
                            job.second = skeleton_of(job.first);
                        }).second;
    Axis axis;
    if (largest.others > 0)
        axis.notes.push_back(
            fmt::format("the skeleton is that of the largest of {} bodies: {:.3g} % of the area {} left out; name "
                        "a part to get the axis of another body",
                        largest.others + 1, 100 * largest.others_share, largest.others == 1 ? "is" : "are"));
    const std::vector<std::size_t> path = graph.points.empty() ? std::vector<std::size_t>() : longest_path(graph);
    double length = 0;
    for (std::size_t i = 1; i < path.size(); ++i) length += (graph.points[path[i]] - graph.points[path[i - 1]]).norm();
    std::size_t branches = 0;
    for (const auto& links : graph.links) branches += links.size() > 2;
    if (length < 0.25) {
        axis.reason =
            graph.length < 0.25 ? "it contracts to a point: it is not longer than wide" : "its skeleton has no longest path";
        return axis;
    }
    std::vector<Vector3d> middles;
    std::vector<double> weights;
    std::vector<Point> line;
    std::set<std::pair<std::size_t, std::size_t>> used;
    for (std::size_t i = 0; i < path.size(); ++i) {
        line.push_back(point_of(centre + scale * graph.points[path[i]]));
        if (i == 0) continue;
        middles.push_back((graph.points[path[i]] + graph.points[path[i - 1]]) / 2);
        weights.push_back((graph.points[path[i]] - graph.points[path[i - 1]]).norm() + 1e-12);
        used.insert(std::minmax(path[i], path[i - 1]));
    }
    const LineFit fit = fit_line(middles, weights);
    set_line(axis, centre + scale * fit.point, fit.direction, centre);
    axis.lines.push_back(std::move(line));
    for (std::size_t a = 0; a < graph.points.size(); ++a)
        for (const auto& link : graph.links[a])
            if (a < link.first && used.count({a, link.first}) == 0)
                axis.lines.push_back(
                    {point_of(centre + scale * graph.points[a]), point_of(centre + scale * graph.points[link.first])});
    axis.quality = graph.length > 0 ? length / graph.length : 0;
    axis.found = true;
    axis.figures = {
        {"length", length * scale, "length"}, {"branches", double(branches), ""}, {"rms distance", fit.rms * scale, "length"}};
    return axis;
}

}  // namespace ostraka

// Queries on a target of a million vertices, from every vertex of the source.
#include "benchmarks.h"
#include "ostraka/execution/parallel.h"

#include <map>
#include <string>

namespace ostraka::bench {

namespace {

constexpr std::size_t target_vertices = 1'000'000;

enum class Query {
    near_line,     ///< along the normal, two target edges in both directions: the first query of a transfer
    far_line,      ///< along the normal, 2 % of the diagonal in both directions: the query if nothing is near
    closest_point  ///< a single closest point
};

struct QuerySet {
    std::vector<Point> points;
    std::vector<Vector> normals;
    double near = 0, far = 0;
};

const QuerySet& query_set() {
    static const QuerySet queries = [] {
        QuerySet result;
        const Mesh& mesh = source().mesh;
        for (const Vertex v : mesh.vertices()) {
            result.points.push_back(mesh.point(v));
            result.normals.push_back(vertex_normal(mesh, v));
        }
        result.near = 2 * mean_edge_length(target(target_vertices));
        result.far = 0.02 * box_diagonal(mesh);
        return result;
    }();
    return queries;
}

Index answer_query(const SurfaceSearch& search, const QuerySet& query_points, Query query, std::size_t i) {
    if (query == Query::closest_point) return search.closest(query_points.points[i]).face;
    const auto hits = search.line_hits(query_points.points[i], query_points.normals[i],
                                       query == Query::near_line ? query_points.near : query_points.far);
    return hits.empty() ? no_index : hits.front().face;
}

void run_queries(benchmark::State& state, Query query, int thread_count) {
    const QuerySet& query_points = query_set();
    const SurfaceSearch& search = target_search(target_vertices);
    std::vector<Index> faces(query_points.points.size());
    set_threads(thread_count);
    for ([[maybe_unused]] const auto lap : state)
        parallel_for(faces.size(), 64, [&](std::size_t i) { faces[i] = answer_query(search, query_points, query, i); });
    set_threads(0);
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * faces.size()));

    std::size_t answered = 0;
    for (const Index face : faces) answered += face != no_index;
    state.counters["answered"] = static_cast<double>(answered) / static_cast<double>(faces.size());
    if (query != Query::near_line && answered < 0.99 * static_cast<double>(faces.size()))
        state.SkipWithError("more than 1 % of the queries found nothing");
    static std::map<Query, std::vector<Index>> reference;
    if (reference.try_emplace(query, faces).first->second != faces)
        state.SkipWithError("the answers depend on the number of threads");
}

}  // namespace

void register_query_benchmarks() {
    const std::pair<const char*, Query> queries[] = {
        {"near_line", Query::near_line}, {"far_line", Query::far_line}, {"closest_point", Query::closest_point}};
    for (const auto& [name, query] : queries)
        for (const int thread_count : {1, 2})
            with_both_times(benchmark::RegisterBenchmark(
                (std::string("query/") + name + "/threads:" + std::to_string(thread_count)).c_str(),
                [query = query, thread_count](benchmark::State& state) { run_queries(state, query, thread_count); }));
}

}  // namespace ostraka::bench

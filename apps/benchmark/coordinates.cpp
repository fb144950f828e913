// Coordinates of 100,000 points in a cage of 200 vertices, and deformation by them.
#include "benchmarks.h"
#include "ostraka/coords/certificate.h"
#include "ostraka/execution/parallel.h"

#include <cmath>
#include <map>
#include <string>

namespace ostraka::bench {

namespace {

constexpr std::size_t point_count = 100'000;

/// A point on a torus; the cage has 20 x 10 vertices and 400 faces.
Point on_ring(double a, double b, double radius) {
    const double r = 2 + radius * std::cos(b);
    return {r * std::cos(a) * (1 + 0.2 * std::sin(3 * a)), r * std::sin(a), radius * std::sin(b) + 0.3 * std::sin(2 * a)};
}

const Mesh& cage() {
    static const Mesh cage_mesh = [] {
        TriangleSoup soup;
        constexpr Index columns = 20, rows = 10;
        for (Index i = 0; i < columns; ++i)
            for (Index j = 0; j < rows; ++j) {
                const Point p = on_ring(2 * M_PI * i / columns, 2 * M_PI * j / rows, 1);
                soup.points.push_back({p.x(), p.y(), p.z()});
                const auto at = [&](Index di, Index dj) { return (i + di) % columns * rows + (j + dj) % rows; };
                soup.triangles.push_back({at(0, 0), at(1, 0), at(1, 1)});
                soup.triangles.push_back({at(0, 0), at(1, 1), at(0, 1)});
            }
        return build_mesh(soup);
    }();
    return cage_mesh;
}

const std::vector<Point>& points() {
    static const std::vector<Point> inner_points = [] {
        std::vector<Point> torus_points;
        for (std::size_t i = 0; i < point_count; ++i) {
            // Evenly distributed inside the torus, by the golden ratio.
            const double fraction = static_cast<double>(i) / point_count;
            torus_points.push_back(
                on_ring(2 * M_PI * fraction, 2 * M_PI * std::fmod(0.6180339887498949 * static_cast<double>(i), 1), 0.6));
        }
        return torus_points;
    }();
    return inner_points;
}

/// Number of additions, multiplications, divisions and square roots in the loops over edges and faces (src/coords).
double operations(const std::string& kind) {
    const auto edges = static_cast<double>(cage().number_of_edges()), faces = static_cast<double>(cage().number_of_faces());
    return static_cast<double>(point_count) * (kind == "green" ? edges * 70 + faces * 240 : edges * 62 + faces * 53);
}

void weights(benchmark::State& state, const std::string& kind, int thread_count) {
    set_threads(thread_count);
    Coordinates result;
    for ([[maybe_unused]] const auto lap : state) result = compute_coordinates(kind, cage(), points());
    set_threads(0);
    const auto laps = static_cast<double>(state.iterations());
    const double bytes = static_cast<double>(result.vertex.size() + result.normal.size()) * 8;
    state.counters["Gop/s"] = benchmark::Counter(1e-9 * operations(kind) * laps, benchmark::Counter::kIsRate);
    state.counters["written_GB/s"] = benchmark::Counter(1e-9 * bytes * laps, benchmark::Counter::kIsRate);
    const CoordinateCertificate certificate = certify(result, cage(), points());
    if (!(certificate.partition < 1e-12 && certificate.linear < 1e-11)) state.SkipWithError("the weights do not hold");
    static std::map<std::string, WeightMatrix> reference;
    if (reference.try_emplace(kind, result.vertex).first->second != result.vertex)
        state.SkipWithError("the weights depend on the number of threads");
}

void deform(benchmark::State& state, const std::string& kind, int thread_count) {
    const Coordinates c = compute_coordinates(kind, cage(), points());
    std::vector<Point> moved = points_of(cage());
    for (Point& p : moved) p = Point(p.x(), p.y() + 0.1 * p.x() * p.x(), 1.2 * p.z());
    set_threads(thread_count);
    std::vector<Point> result;
    for ([[maybe_unused]] const auto lap : state) result = deformed(c, cage(), moved);
    set_threads(0);
    state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * (c.vertex.size() + c.normal.size()) * 8);
    if (result.size() != point_count) state.SkipWithError("points are missing");
}

}  // namespace

void register_coordinate_benchmarks() {
    for (const char* kind : {"mean-value", "green"})
        for (const int thread_count : {1, 2}) {
            const std::string ending = std::string(kind) + "/threads:" + std::to_string(thread_count);
            with_both_times(benchmark::RegisterBenchmark(
                ("coordinates/weights/" + ending).c_str(),
                [kind, thread_count](benchmark::State& state) { weights(state, kind, thread_count); }));
            with_both_times(benchmark::RegisterBenchmark(
                ("coordinates/deform/" + ending).c_str(),
                [kind, thread_count](benchmark::State& state) { deform(state, kind, thread_count); }));
        }
}

}  // namespace ostraka::bench

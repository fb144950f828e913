#include "experiments.h"

#include "ostraka/core/file.h"
#include "ostraka/core/parallel.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/remesh/refine.h"
#include "ostraka/remesh/remesh.h"
#include "ostraka/remesh/simplify.h"
#include "ostraka/synthetic/make_mesh.h"
#include "ostraka/transfer/transfer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <map>
#include <queue>
#include <sstream>

namespace ostraka::experiments {

std::vector<Index> disc(const Mesh& mesh, Vertex seed, double share) {
    std::vector<double> distance(mesh.number_of_vertices(), std::numeric_limits<double>::infinity());
    std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>, std::greater<>> queue;
    distance[seed] = 0;
    queue.emplace(0.0, seed);
    while (!queue.empty()) {
        const auto [d, v] = queue.top();
        queue.pop();
        if (d > distance[v]) continue;
        for (const Halfedge h : CGAL::halfedges_around_source(Vertex(v), mesh)) {
            const Vertex w = mesh.target(h);
            const double next = d + std::sqrt(CGAL::squared_distance(mesh.point(Vertex(v)), mesh.point(w)));
            if (next >= distance[w]) continue;
            distance[w] = next;
            queue.emplace(next, w);
        }
    }
    std::vector<std::pair<double, Index>> order;
    for (const Face f : mesh.faces()) {
        double sum = 0;
        for (const Vertex v : corners(mesh, f)) sum += distance[v];
        order.emplace_back(sum, f);
    }
    std::sort(order.begin(), order.end());
    std::vector<Index> faces;
    const double wanted = share * surface_area(mesh);
    double area = 0;
    for (const auto& [d, f] : order) {
        if (area >= wanted) break;
        area += face_area(mesh, Face(f));
        faces.push_back(f);
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

namespace {

constexpr double shares[] = {0.005, 0.025, 0.1, 0.3};
constexpr int seeds_per_size = 3;

std::string name_of(std::size_t vertices) {
    if (vertices % 1000000 == 0) return std::to_string(vertices / 1000000) + "M";
    if (vertices % 1000 == 0) return std::to_string(vertices / 1000) + "K";
    return std::to_string(vertices);
}

Mesh simplified(const Mesh& mesh, std::size_t vertices) {
    Mesh copy = mesh;
    if (copy.number_of_vertices() <= vertices) return copy;
    SimplifyOptions options;
    options.vertices = vertices;
    simplify(copy, options);
    return copy;
}

struct Ladder {
    std::string object;
    std::string kind;  ///< "decimated", "subdivided", "independent"
    std::map<std::string, Mesh> rungs;
};

class Table {
public:
    explicit Table(const TableOptions& options) : options_(options) {}

    void run() {
        for (const std::string& name : options_.made) {
            if (name == "none") continue;
            const SyntheticObject& object = synthetic_object(name);
            const auto make = [&](std::size_t n, std::uint64_t seed) {
                MakeOptions making;
                making.vertices = n;
                making.seed = seed;
                return make_mesh(object, making).mesh;
            };
            const Mesh full = make(options_.full, 1);
            std::map<std::string, Mesh> independent;
            if (!options_.no_independent) {
                independent.emplace("full", full);
                for (const std::size_t n : options_.rungs) independent.emplace(name_of(n), make(n, 1 + n));
            }
            all_kinds(name, full, std::move(independent), &object);
            print();
        }
        for (const std::string& file : options_.scans) {
            Mesh full = read_mesh(file).mesh;
            RefineOptions refining;
            refining.scheme = RefineOptions::Scheme::loop;
            refining.levels = 1;
            while (full.number_of_vertices() < options_.full) refine(full, refining);
            full = simplified(full, options_.full);
            std::map<std::string, Mesh> independent;
            if (!options_.no_independent) {
                independent.emplace("full", full);
                for (const std::size_t n : options_.rungs) {
                    RemeshOptions remeshing;
                    remeshing.vertices = n;
                    independent.emplace(name_of(n), remesh(full, remeshing).mesh);
                }
            }
            all_kinds(Path(file).stem().string(), full, std::move(independent), nullptr);
            print();
        }
        std::cout << tables();
    }

private:
    void all_kinds(const std::string& name, const Mesh& full, std::map<std::string, Mesh> independent,
                   const SyntheticObject* truth) {
        std::vector<std::size_t> down = options_.rungs;
        std::sort(down.rbegin(), down.rend());
        Ladder decimated{name, "decimated", {}};
        const Mesh* last = &decimated.rungs.emplace("full", full).first->second;
        for (const std::size_t n : down) last = &decimated.rungs.emplace(name_of(n), simplified(*last, n)).first->second;
        std::cerr << name << ": decimated\n";
        measure(decimated, truth);
        if (options_.truth_only) {
            if (!independent.empty() && truth != nullptr) measure({name, "independent", std::move(independent)}, truth);
            return;
        }
        // The subdivision chain starts at the annotated rung.
        Ladder subdivided{name, "subdivided", {}};
        const std::string home = name_of(options_.rungs.front());
        last = &subdivided.rungs.emplace(home, decimated.rungs.at(home)).first->second;
        std::vector<std::size_t> up = options_.rungs;
        std::sort(up.begin(), up.end());
        for (const std::size_t n : up) {
            if (n <= options_.rungs.front()) continue;
            Mesh finer = *last;
            RefineOptions refining;
            refining.vertices = n;
            refine(finer, refining);
            last = &subdivided.rungs.emplace(name_of(n), std::move(finer)).first->second;
        }
        decimated.rungs.clear();
        std::cerr << name << ": subdivided\n";
        measure(subdivided, nullptr);
        subdivided.rungs.clear();
        if (!independent.empty()) {
            std::cerr << name << ": independent\n";
            measure({name, "independent", std::move(independent)}, truth);
        }
    }

    static AnnotationSet discs(const Mesh& mesh) {
        AnnotationSet set;
        int id = 0;
        for (const double share : shares)
            for (int k = 0; k < seeds_per_size; ++k) {
                Annotation region;
                region.id = id++;
                // Seeds evenly distributed over the index range, the same for every size.
                const auto seed = static_cast<Index>((2 * k + 1) * mesh.number_of_vertices() / (2 * seeds_per_size));
                region.faces = disc(mesh, Vertex(seed), share);
                set.annotations.push_back(std::move(region));
            }
        return set;
    }

    /// True membership in each part on a mesh of a synthetic object: each face is sampled by 16 smaller triangles whose
    /// centroids, projected to the true surface, determine the part.
    struct Truth {
        const Mesh* mesh;
        std::vector<std::map<int, double>> shares;
        std::map<int, double> areas;
        double whole = 0;
    };
    static Truth truth_of(const Mesh& mesh, const SyntheticObject& object) {
        Truth truth{&mesh, std::vector<std::map<int, double>>(mesh.number_of_faces()), {}, surface_area(mesh)};
        parallel_for(mesh.number_of_faces(), [&](std::size_t i) {
            const auto [a, b, c] = corners(mesh, Face(static_cast<Index>(i)));
            constexpr int k = 4;
            for (int u = 0; u < k; ++u)
                for (int v = 0; u + v < k; ++v)
                    for (int half = 0; half < (u + v + 1 < k ? 2 : 1); ++half) {
                        const double s = (u + (half == 0 ? 1.0 : 2.0) / 3) / k, t = (v + (half == 0 ? 1.0 : 2.0) / 3) / k;
                        const Point p = mesh.point(a) + s * (mesh.point(b) - mesh.point(a)) + t * (mesh.point(c) - mesh.point(a));
                        truth.shares[i][object.part(object.project(p))] += 1.0 / (k * k);
                    }
        });
        for (const Face f : mesh.faces())
            for (const auto& [part, share] : truth.shares[f]) truth.areas[part] += share * face_area(mesh, f);
        return truth;
    }

    /// Transfers parts defined by labels at face centroids, and compares the result with the true parts.
    void measure_truth(const Ladder& ladder, const SyntheticObject& object) {
        const std::string home = name_of(options_.rungs.front());
        const Mesh& source = ladder.rungs.at(home);
        const SurfaceSearch source_search(source);
        AnnotationSet set;
        for (std::size_t label = 0; label < object.parts.size(); ++label) {
            Annotation region;
            region.id = static_cast<int>(label);
            region.tag = object.parts[label];
            for (const Face f : source.faces())
                if (object.part(object.project(centroid(source, f))) == region.id) region.faces.push_back(f);
            if (!region.faces.empty()) set.annotations.push_back(std::move(region));
        }
        const auto judge = [&](const Truth& truth, const AnnotationSet& result, const std::string& pair,
                               const std::string& rounding) {
            for (const Annotation& region : result.annotations) {
                if (region.faces.empty()) continue;
                double area = 0, common = 0;
                for (const Index f : region.faces) {
                    const double face = face_area(*truth.mesh, Face(f));
                    area += face;
                    if (const auto found = truth.shares[f].find(region.id); found != truth.shares[f].end())
                        common += found->second * face;
                }
                const double true_area = truth.areas.at(region.id), share = true_area / truth.whole;
                const double overlap = common / (area + true_area - common);
                const char* bin = share >= 0.1     ? "10 % and more"
                                  : share >= 0.025 ? "2.5 to 10 %"
                                  : share >= 0.005 ? "0.5 to 2.5 %"
                                                   : "below 0.5 %";
                truth_[{ladder.kind, pair, bin, rounding}].push_back(overlap);
                truth_csv_ << ladder.object << ',' << ladder.kind << ',' << pair << ',' << rounding << ',' << region.tag << ','
                           << share << ',' << overlap << '\n';
            }
        };
        const Truth home_truth = truth_of(source, object);
        judge(home_truth, set, home + " as annotated", "-");
        for (const auto& [name, target] : ladder.rungs) {
            if (name == home || target.number_of_vertices() > 300000) continue;
            const Truth truth = truth_of(target, object);
            const SurfaceSearch search(target);
            for (const std::string rounding : {"path", "area", "balanced"}) {
                TransferOptions options;
                set_option(options, "rounding", rounding);
                options.overlap = false;
                const TransferResult there = transfer(source, set, search, options);
                judge(truth, there.annotations, home + " -> " + name, rounding);
                judge(home_truth, transfer(target, there.annotations, source_search, options).annotations,
                      home + " -> " + name + " -> " + home, rounding);
            }
        }
    }

    void measure(const Ladder& ladder, const SyntheticObject* truth) {
        if (truth != nullptr) measure_truth(ladder, *truth);
        if (options_.truth_only) return;
        const std::string home = name_of(options_.rungs.front());
        const Mesh& source = ladder.rungs.at(home);
        const AnnotationSet set = discs(source);
        const SurfaceSearch source_search(source);
        const double source_edge = mean_edge_length(source);
        for (const auto& [name, target] : ladder.rungs) {
            if (name == home) continue;
            const SurfaceSearch search(target);
            const double edge = std::max(source_edge, mean_edge_length(target));
            for (const std::string metric :
                 {"segment", "euclidean", "combined", "segment balanced", "euclidean balanced", "combined balanced", "refine"}) {
                // The metrics are similar because of rounding; on the largest targets only one is measured.
                if (target.number_of_vertices() > 300000 && (metric == "segment balanced" || metric == "euclidean balanced"))
                    continue;
                if (!options_.metric.empty() && metric.find(options_.metric) == std::string::npos) continue;
                TransferOptions options;
                options.refine = metric == "refine";
                options.rounding = metric.find("balanced") != std::string::npos ? TransferOptions::Rounding::balanced
                                                                                : TransferOptions::Rounding::path;
                if (!options.refine) options.metric = path_metric(metric.substr(0, metric.find(' ')));
                const auto start = std::chrono::steady_clock::now();
                const TransferResult there = transfer(source, set, search, options);
                double seconds = there.times.correspondence + there.times.paths + there.times.regions;
                add(ladder, home + " -> " + name, metric, there.scores, seconds, edge);
                TransferOptions returning = options;
                returning.refine = false;
                returning.overlap = false;
                const Mesh& on = there.refined ? there.refined->mesh : target;
                TransferResult back = transfer(on, there.annotations, source_search, returning);
                seconds = back.times.correspondence + back.times.paths + back.times.regions;
                // The round trip is compared with the original region, face by face.
                for (TransferScore& score : back.scores) {
                    const auto& origin = set.annotations.at(static_cast<std::size_t>(score.id));
                    score.source_area = there.scores.at(static_cast<std::size_t>(score.id)).source_area;
                    score.source_length = there.scores.at(static_cast<std::size_t>(score.id)).source_length;
                    if (const Annotation* home_again = back.annotations.find(score.id)) {
                        std::vector<Index> common;
                        std::set_intersection(origin.faces.begin(), origin.faces.end(), home_again->faces.begin(),
                                              home_again->faces.end(), std::back_inserter(common));
                        double area = 0;
                        for (const Index f : common) area += face_area(source, Face(f));
                        score.overlap = area / (score.source_area + score.target_area - area);
                        score.wrong_side = score.source_area + score.target_area - 2 * area;
                    }
                }
                add(ladder, home + " -> " + name + " -> " + home, metric, back.scores, seconds, edge);
                std::cerr << "  " << home << " <-> " << name << " " << metric << " "
                          << std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() << " s\n";
            }
        }
    }

    struct Sum {
        double seconds = 0, area = 0, perimeter = 0, perimeter_by_area = 0, area_by_perimeter = 0, circularity = 0, mean = 0,
               overlap = 0, wrong = 0;
        double worst_overlap = 1, worst_wrong = 0;
        int count = 0, lost = 0, voted = 0;
    };
    using Key = std::tuple<std::string, std::string, double, std::string>;  // kind, pair, share, metric

    void add(const Ladder& ladder, const std::string& pair, const std::string& metric, const std::vector<TransferScore>& scores,
             double seconds, double edge) {
        for (const TransferScore& score : scores) {
            const double share = shares[score.id / seeds_per_size];
            Sum& sum = sums_[{ladder.kind, pair, share, metric}];
            const Distortions d = distortions(score);
            if (score.outcome != TransferOutcome::kept || !score.overlap) {
                ++sum.lost;
                continue;
            }
            const double wrong = *score.wrong_side / (edge * score.source_length);
            sum.seconds += seconds / static_cast<double>(scores.size());
            sum.area += d.area;
            sum.perimeter += d.perimeter;
            sum.perimeter_by_area += d.perimeter_by_area;
            sum.area_by_perimeter += d.area_by_perimeter;
            sum.circularity += d.circularity;
            sum.mean += d.mean;
            sum.overlap += *score.overlap;
            sum.wrong += wrong;
            sum.worst_overlap = std::min(sum.worst_overlap, *score.overlap);
            sum.worst_wrong = std::max(sum.worst_wrong, wrong);
            sum.voted += score.voted ? 1 : 0;
            ++sum.count;
            csv_ << ladder.object << ',' << ladder.kind << ',' << pair << ',' << metric << ',' << share << ',' << seconds << ','
                 << d.area << ',' << d.perimeter << ',' << d.perimeter_by_area << ',' << d.area_by_perimeter << ','
                 << d.circularity << ',' << *score.overlap << ',' << wrong << ',' << score.hausdorff.value_or(-1) << '\n';
        }
    }

    /// The tables so far, also written to files, so that an interrupted run keeps them.
    std::string tables() const {
        std::ostringstream out;
        out << "Mean distortions in percent over objects and places; time in seconds for all regions of an object; "
               "wrong side in units of (larger mean edge) x (outline length).\n\n"
               "| resolutions | S -> T | share % | metric | time | A | P | P/A | A/P | C | average | overlap (worst) | wrong "
               "side (worst) | n (lost, voted) |\n"
               "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
        for (const auto& [key, sum] : sums_) {
            const auto& [kind, pair, share, metric] = key;
            const int n = std::max(1, sum.count);
            const auto mean = [n](double x) {
                char text[32];
                std::snprintf(text, sizeof text, "%.4f", 100 * x / n);
                return std::string(text);
            };
            char tail[160];
            std::snprintf(tail, sizeof tail, "%.5f (%.5f) | %.3f (%.3f) | %d (%d, %d) |", sum.overlap / n, sum.worst_overlap,
                          sum.wrong / n, sum.worst_wrong, sum.count, sum.lost, sum.voted);
            char time[32];
            std::snprintf(time, sizeof time, "%.3f", sum.seconds / n * (sizeof shares / sizeof *shares) * seeds_per_size);
            out << "| " << kind << " | " << pair << " | " << 100 * share << " | " << metric << " | " << time << " | "
                << mean(sum.area) << " | " << mean(sum.perimeter) << " | " << mean(sum.perimeter_by_area) << " | "
                << mean(sum.area_by_perimeter) << " | " << mean(sum.circularity) << " | " << mean(sum.mean) << " | " << tail
                << "\n";
        }
        if (!truth_.empty()) {
            out << "\nOverlap (intersection over union) with the analytic parts of the made objects.\n\n"
                   "| resolutions | S -> T | part's share of the area | rounding | parts | mean overlap | worst "
                   "|\n|---|---|---|---|---|---|---|\n";
            for (const auto& [key, list] : truth_) {
                double sum = 0;
                for (const double x : list) sum += x;
                char line[200];
                std::snprintf(line, sizeof line, "| %zu | %.5f | %.5f |", list.size(), sum / static_cast<double>(list.size()),
                              *std::min_element(list.begin(), list.end()));
                out << "| " << std::get<0>(key) << " | " << std::get<1>(key) << " | " << std::get<2>(key) << " | "
                    << std::get<3>(key) << " " << line << "\n";
            }
        }
        return out.str();
    }

    void print() const {
        if (options_.csv.empty()) return;
        write_file(options_.csv + ".md", tables());
        if (!truth_.empty())
            write_file(options_.csv + ".truth.csv", "object,resolutions,pair,rounding,part,share,overlap\n" + truth_csv_.str());
        write_file(options_.csv,
                   "object,resolutions,pair,metric,share,seconds,A,P,P/A,A/P,C,overlap,wrong_side,hausdorff\n" + csv_.str());
    }

    const TableOptions& options_;
    std::map<Key, Sum> sums_;
    std::map<std::tuple<std::string, std::string, std::string, std::string>, std::vector<double>>
        truth_;  ///< kind, pair, size, rounding
    std::ostringstream truth_csv_;
    std::ostringstream csv_;
};

}  // namespace

void transfer_table(const TableOptions& options) { Table(options).run(); }

}  // namespace ostraka::experiments

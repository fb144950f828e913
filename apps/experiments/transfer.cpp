// Table 2.1 of the thesis: regions transferred between resolutions and back, by metric, size and pair of resolutions; human part
// labels (layout of the Princeton segmentation benchmark), transferred to a remeshed version and back.
#include "harness.h"
#include "scenes.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/mesh/flood.h"
#include "ostraka/remesh/refine.h"
#include "ostraka/synthetic/synthetic_object.h"
#include "ostraka/transfer/transfer.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

namespace ostraka::experiments {

namespace {

constexpr std::array shares{0.005, 0.025, 0.1, 0.3};
constexpr int seeds_per_size = 3;

struct TableOptions {
    std::vector<std::string> made{"teapot", "statuette", "hand"}, scans;
    std::uint64_t full = 2000000;
    std::vector<int> rungs{50000, 5000, 100000, 1000000};
    std::string metric, csv;
    bool no_independent = false, truth_only = false;
    void declare_options(OptionList& list) {
        list("made", made, "names of synthetic objects, or none");
        list("scan", scans, "mesh files of scans; they are subdivided smoothly to the full resolution");
        list("full", full, "number of vertices of the full resolution");
        list("rungs", rungs, "other numbers of vertices; the first is the one annotated", Range{100, 1e8});
        list("metric", metric, "only metrics whose names contain this");
        list("csv", csv, "file for the raw rows");
        list("truth-only", truth_only, "only the overlap with the parts of synthetic objects");
        list("no-independent", no_independent, "without independently meshed resolutions");
    }
};

struct Ladder {
    std::string object;
    std::string kind;  ///< "decimated", "subdivided", "independent"
    std::map<std::string, Mesh> rungs;
};

class TransferTable {
public:
    explicit TransferTable(const TableOptions& options) : options_(options) {}

    void run() {
        for (const std::string& name : options_.made)
            if (name != "none") {
                const auto mesh_of = [&](std::uint64_t n) { return made_mesh(name, n, n == options_.full ? 1 : 1 + n); };
                all_kinds(name, mesh_of(options_.full), mesh_of, &synthetic_object(name));
            }
        for (const std::string& file : options_.scans) {
            const Mesh full = simplified(refined(read_mesh(file).mesh, options_.full), options_.full);
            all_kinds(
                Path(file).stem().string(), full, [&](std::uint64_t n) { return remeshed(full, n); }, nullptr);
        }
        fmt::print("{}", tables());
    }

private:
    [[nodiscard]] std::string home() const { return size_name(static_cast<std::size_t>(options_.rungs.front())); }

    template <class MeshOf>
    void all_kinds(const std::string& name, const Mesh& full, const MeshOf& independent_mesh, const SyntheticObject* truth) {
        std::vector<std::uint64_t> up(options_.rungs.begin(), options_.rungs.end());
        std::sort(up.begin(), up.end());
        Ladder decimated{name, "decimated", {}}, subdivided{name, "subdivided", {}}, independent{name, "independent", {}};
        if (!options_.no_independent) {
            independent.rungs.emplace("full", full);
            for (const std::uint64_t n : up) independent.rungs.emplace(size_name(n), independent_mesh(n));
        }
        const Mesh* last = &decimated.rungs.emplace("full", full).first->second;
        for (auto n = up.rbegin(); n != up.rend(); ++n)
            last = &decimated.rungs.emplace(size_name(*n), simplified(*last, *n)).first->second;
        measure(decimated, truth);
        // The subdivision chain starts at the annotated rung.
        last = &subdivided.rungs.emplace(home(), decimated.rungs.at(home())).first->second;
        for (const std::uint64_t n : up) {
            if (n <= static_cast<std::uint64_t>(options_.rungs.front()) || options_.truth_only) continue;
            Mesh finer = *last;
            RefineOptions refining;
            refining.vertices = n;
            refine(finer, refining);
            last = &subdivided.rungs.emplace(size_name(n), std::move(finer)).first->second;
        }
        decimated.rungs.clear();
        measure(subdivided, nullptr);
        subdivided.rungs.clear();
        if (!independent.rungs.empty()) measure(independent, truth);
        write();
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
            for_each_part(k, [&, a = a, b = b, c = c](const std::array<double, 3>& at) {
                const Point p = mesh.point(a) + at[1] * (mesh.point(b) - mesh.point(a)) + at[2] * (mesh.point(c) - mesh.point(a));
                truth.shares[i][object.part(object.project(p))] += 1.0 / (k * k);
            });
        });
        for (const Face f : mesh.faces())
            for (const auto& [part, share] : truth.shares[f]) truth.areas[part] += share * face_area(mesh, f);
        return truth;
    }

    /// Transfers parts defined by labels at face centroids, and compares the result with the true parts.
    void measure_truth(const Ladder& ladder, const SyntheticObject& object) {
        const std::string home = this->home();
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
                    if (const auto share = truth.shares[f].find(region.id); share != truth.shares[f].end())
                        common += share->second * face;
                }
                const double true_area = truth.areas.at(region.id), share = true_area / truth.whole;
                const double overlap = common / (area + true_area - common);
                const char* bin = share >= 0.1     ? "10 % and more"
                                  : share >= 0.025 ? "2.5 to 10 %"
                                  : share >= 0.005 ? "0.5 to 2.5 %"
                                                   : "below 0.5 %";
                truth_[{ladder.kind, pair, bin, rounding}].push_back(overlap);
                truth_csv_(ladder.object, ladder.kind, pair, rounding, region.tag, share, overlap);
            }
        };
        const Truth home_truth = truth_of(source, object);
        judge(home_truth, set, home + " as annotated", "none");
        for (const auto& [name, target] : ladder.rungs) {
            if (name == home || target.number_of_vertices() > 300000) continue;
            const Truth truth = truth_of(target, object);
            const SurfaceSearch search(target);
            for (const std::string rounding : {"path", "area", "balanced"}) {
                TransferOptions options;
                set_option(options, "rounding", rounding);
                options.overlap = false;
                const TransferResult there = transfer({source, set}, search, options);
                judge(truth, there.annotations, home + " -> " + name, rounding);
                judge(home_truth, transfer({target, there.annotations}, source_search, options).annotations,
                      home + " -> " + name + " -> " + home, rounding);
            }
        }
    }

    void measure(const Ladder& ladder, const SyntheticObject* truth) {
        fmt::print(stderr, "{}: {}\n", ladder.object, ladder.kind);
        if (truth != nullptr) measure_truth(ladder, *truth);
        if (options_.truth_only) return;
        const std::string home = this->home();
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
                const Stopwatch watch;
                const auto seconds = [](const TransferResult& result) {
                    return result.times.correspondence + result.times.paths + result.times.regions;
                };
                const TransferResult there = transfer({source, set}, search, options);
                add(ladder, home + " -> " + name, metric, there.scores, seconds(there), edge);
                TransferOptions returning = options;
                returning.refine = false;
                returning.overlap = false;
                const Mesh& on = there.refined ? there.refined->mesh : target;
                TransferResult back = transfer({on, there.annotations}, source_search, returning);
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
                add(ladder, home + " -> " + name + " -> " + home, metric, back.scores, seconds(back), edge);
                fmt::print(stderr, "  {} <-> {} {} {:g} s\n", home, name, metric, watch.seconds().wall);
            }
        }
    }

    struct Sum {
        /// Seconds, A, P, P/A, A/P, C, their mean, overlap, wrong side.
        Eigen::Array<double, 9, 1> values = Eigen::Array<double, 9, 1>::Zero();
        double worst_overlap = 1, worst_wrong = 0;
        int count = 0, lost = 0, voted = 0;
    };
    using Key = std::tuple<std::string, std::string, double, std::string>;  // kind, pair, share, metric

    void add(const Ladder& ladder, const std::string& pair, const std::string& metric, const std::vector<TransferScore>& scores,
             double seconds, double edge) {
        for (const TransferScore& score : scores) {
            const double share = shares.at(static_cast<std::size_t>(score.id / seeds_per_size));
            Sum& sum = sums_[{ladder.kind, pair, share, metric}];
            const Distortions d = distortions(score);
            if (score.outcome != TransferOutcome::kept || !score.overlap) {
                ++sum.lost;
                continue;
            }
            const double wrong = *score.wrong_side / (edge * score.source_length);
            sum.values += Eigen::Array<double, 9, 1>{{seconds / static_cast<double>(scores.size()), d.area, d.perimeter,
                                                      d.perimeter_by_area, d.area_by_perimeter, d.circularity, d.mean,
                                                      *score.overlap, wrong}};
            sum.worst_overlap = std::min(sum.worst_overlap, *score.overlap);
            sum.worst_wrong = std::max(sum.worst_wrong, wrong);
            sum.voted += score.voted ? 1 : 0;
            ++sum.count;
            csv_(ladder.object, ladder.kind, pair, metric, share, seconds, d.area, d.perimeter, d.perimeter_by_area,
                 d.area_by_perimeter, d.circularity, *score.overlap, wrong, score.hausdorff.value_or(-1));
        }
    }

    [[nodiscard]] std::string tables() const {
        Table distortion(
            "resolutions | S -> T | share % | metric | time | A | P | P/A | A/P | C | average | overlap (worst) | wrong side "
            "(worst) | n (lost, voted)",
            false);
        for (const auto& [key, sum] : sums_) {
            const auto& [kind, pair, share, metric] = key;
            const auto mean = (sum.values / std::max(1, sum.count)).eval();
            distortion.row(
                "{} | {} | {:g} | {} | {:.3f} | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {:.5f} ({:.5f}) | {:.3f} "
                "({:.3f}) | {} ({}, {})",
                kind, pair, 100 * share, metric, mean[0] * static_cast<double>(shares.size()) * seeds_per_size, 100 * mean[1],
                100 * mean[2], 100 * mean[3], 100 * mean[4], 100 * mean[5], 100 * mean[6], mean[7], sum.worst_overlap, mean[8],
                sum.worst_wrong, sum.count, sum.lost, sum.voted);
        }
        std::string text =
            "Mean distortions in percent over objects and places; time in seconds for all regions of an object; wrong side in "
            "units of (larger mean edge) x (outline length).\n\n" +
            distortion.text();
        if (truth_.empty()) return text;
        Table overlap("resolutions | S -> T | part's share of the area | rounding | parts | mean overlap | worst", false);
        for (const auto& [key, list] : truth_)
            overlap.row("{} | {} | {} | {} | {} | {:.5f} | {:.5f}", std::get<0>(key), std::get<1>(key), std::get<2>(key),
                        std::get<3>(key), list.size(), mean_of(list), *std::min_element(list.begin(), list.end()));
        return text + "\nOverlap (intersection over union) with the analytic parts of the made objects.\n\n" + overlap.text();
    }

    /// Called after each object, so that an interrupted run keeps what it has.
    void write() const {
        if (options_.csv.empty()) return;
        write_file(options_.csv + ".md", tables());
        if (!truth_.empty()) truth_csv_.write(options_.csv + ".truth.csv");
        csv_.write(options_.csv);
    }

    const TableOptions& options_;
    std::map<Key, Sum> sums_;
    std::map<std::tuple<std::string, std::string, std::string, std::string>, std::vector<double>>
        truth_;  ///< kind, pair, size, rounding
    Rows truth_csv_{"object,resolutions,pair,rounding,part,share,overlap"};
    Rows csv_{"object,resolutions,pair,metric,share,seconds,A,P,P/A,A/P,C,overlap,wrong_side,hausdorff"};
};

const Registration registered_table(
    "table", "distortions per metric, size and pair of resolutions (thesis, Table 2.1)",
    +[](const TableOptions& options) { TransferTable(options).run(); });

struct LabelOptions {
    std::string models, labels, csv;
    std::uint64_t limit = 0;
    void declare_options(OptionList& list) {
        list("models", models, "folder with <class>/<number>.off").positional().required();
        list("labels", labels, "folder with <class>/<number>/<number>_0.seg").positional().required();
        list("csv", csv, "file for the raw rows");
        list("limit", limit, "number of models; 0: all");
    }
};

struct Painted {
    std::vector<int> labels;
    double bare = 0, twice = 0;  ///< area shares covered by no region and by several regions
};

/// One label per face; uncovered faces get the label of a neighbour, faces in several regions the first one's.
Painted paint(const Mesh& mesh, const AnnotationSet& set) {
    Painted painted;
    constexpr int none = std::numeric_limits<int>::min();
    painted.labels.assign(mesh.number_of_faces(), none);
    const double area = surface_area(mesh);
    for (const Annotation& region : set.annotations)
        for (const Index f : region.faces) {
            if (painted.labels[f] == none) painted.labels[f] = region.id;
            else painted.twice += face_area(mesh, Face(f)) / area;
        }
    std::vector<Face> covered;
    std::vector<bool> labelled(mesh.number_of_faces(), false);
    for (const Face f : mesh.faces()) {
        if (painted.labels[f] == none) painted.bare += face_area(mesh, f) / area;
        else covered.push_back(f), labelled[f] = true;
    }
    flood(std::move(covered), labelled, [&](Face f, auto&& reach) {
        for (const Face g : mesh.faces_around_face(mesh.halfedge(f))) {
            if (g == Mesh::null_face() || labelled[g]) continue;
            painted.labels[g] = painted.labels[f];
            reach(g);
        }
    });
    return painted;
}

void label_transfer(const LabelOptions& options) {
    std::vector<Path> models;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(options.models))
        if (entry.path().extension() == ".off") models.push_back(entry.path());
    std::sort(models.begin(), models.end());
    if (options.limit > 0 && models.size() > options.limit) models.resize(options.limit);
    Rows csv("model,factor,kept,bare,twice");
    std::map<double, std::vector<std::pair<double, std::string>>> kept_of;
    TransferOptions transferring;
    transferring.overlap = false;
    for (const Path& model : models) {
        const std::string number = model.stem().string(), group = model.parent_path().filename().string(),
                          name = group + "/" + number;
        const Mesh mesh = read_mesh(model).mesh;
        const SurfaceSearch home(mesh);
        const std::vector<int> labels =
            read_labels(Path(options.labels) / group / number / (number + "_0.seg"), mesh.number_of_faces());
        const AnnotationSet set = regions_from_labels(mesh, labels);
        for (const double factor : {2.0, 0.25}) {
            const Mesh other =
                remeshed(mesh, static_cast<std::uint64_t>(factor * static_cast<double>(mesh.number_of_vertices())));
            const SurfaceSearch search(other);
            const Painted there = paint(other, transfer({mesh, set}, search, transferring).annotations);
            const AnnotationSet painted = regions_from_labels(other, there.labels);
            const AnnotationSet returned = transfer({other, painted}, home, transferring).annotations;
            const Painted back = paint(mesh, returned);
            double kept = 0;
            for (const Face f : mesh.faces())
                if (back.labels[f] == labels[f]) kept += face_area(mesh, f);
            kept /= surface_area(mesh);
            kept_of[factor].emplace_back(kept, name);
            csv(name, factor, kept, there.bare, there.twice);
            fmt::print(stderr, "{} x{:g} kept {:g} bare {:g} twice {:g}\n", name, factor, kept, there.bare, there.twice);
        }
    }
    Table table("vertices | models | mean area that keeps its label % | worst % | worst model");
    for (const auto& [factor, list] : kept_of) {
        std::vector<double> all;
        for (const auto& [kept, name] : list) all.push_back(kept);
        const auto worst = *std::min_element(list.begin(), list.end());
        table.row("x {:g} | {} | {:.3f} | {:.3f} | {}", factor, list.size(), 100 * mean_of(all), 100 * worst.first, worst.second);
    }
    csv.write(options.csv);
}

const Registration registered_labels("labels", "part labels carried to a remeshed version and back", label_transfer);

}  // namespace

}  // namespace ostraka::experiments

// Transfers human part labels (layout of the Princeton segmentation benchmark) to a remeshed version and back.
#include "harness.h"
#include "scenes.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/transfer/transfer.h"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <map>

namespace ostraka::experiments {

namespace {

struct LabelOptions {
    std::string models, labels, csv;
    std::uint64_t limit = 0;
    void list_options(OptionList& list) {
        list("models", models, "folder with <class>/<number>.off").positional().required();
        list("labels", labels, "folder with <class>/<number>/<number>_0.seg").positional().required();
        list("csv", csv, "file for the raw rows");
        list("limit", limit, "number of models; 0: all");
    }
};

AnnotationSet regions_of(const std::vector<int>& labels) {
    std::map<int, Annotation> regions;
    for (Index f = 0; f < labels.size(); ++f) {
        Annotation& region = regions[labels[f]];
        region.id = labels[f];
        region.faces.push_back(f);
    }
    AnnotationSet set;
    for (auto& [label, region] : regions) set.annotations.push_back(std::move(region));
    return set;
}

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
    std::deque<Face> queue;
    for (const Face f : mesh.faces()) {
        if (painted.labels[f] == none) painted.bare += face_area(mesh, f) / area;
        else queue.push_back(f);
    }
    while (!queue.empty()) {
        const Face f = queue.front();
        queue.pop_front();
        for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(f), mesh)) {
            if (mesh.is_border(mesh.opposite(h))) continue;
            const Face g = mesh.face(mesh.opposite(h));
            if (painted.labels[g] != none) continue;
            painted.labels[g] = painted.labels[f];
            queue.push_back(g);
        }
    }
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
        const AnnotationSet set = regions_of(labels);
        for (const double factor : {2.0, 0.25}) {
            const Mesh other =
                remeshed(mesh, static_cast<std::uint64_t>(factor * static_cast<double>(mesh.number_of_vertices())));
            const SurfaceSearch search(other);
            const Painted there = paint(other, transfer({mesh, set}, search, transferring).annotations);
            const Painted back = paint(mesh, transfer({other, regions_of(there.labels)}, home, transferring).annotations);
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
        std::vector<double> shares;
        for (const auto& [kept, name] : list) shares.push_back(kept);
        const auto worst = *std::min_element(list.begin(), list.end());
        table.row("x {:g} | {} | {:.3f} | {:.3f} | {}", factor, list.size(), 100 * mean_of(shares), 100 * worst.first,
                  worst.second);
    }
    csv.write(options.csv);
}

const Registration registered("labels", "part labels carried to a remeshed version and back", label_transfer);

}  // namespace

}  // namespace ostraka::experiments

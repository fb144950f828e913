// Transfers human part labels (layout of the Princeton segmentation benchmark) to a remeshed version and back.
#include "experiments.h"

#include "ostraka/core/error.h"
#include "ostraka/core/file.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/remesh/remesh.h"
#include "ostraka/transfer/transfer.h"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <iostream>
#include <map>
#include <sstream>

namespace ostraka::experiments {

namespace {

std::vector<int> read_labels(const Path& file, std::size_t faces) {
    std::istringstream text(read_file(file));
    std::vector<int> labels;
    for (int label = 0; text >> label;) labels.push_back(label);
    if (labels.size() != faces)
        fail_input(file.string(), "has " + std::to_string(labels.size()) + " labels for " + std::to_string(faces) + " faces");
    return labels;
}

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

}  // namespace

void label_transfer(const LabelOptions& options) {
    std::vector<Path> models;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(options.models))
        if (entry.path().extension() == ".off") models.push_back(entry.path());
    std::sort(models.begin(), models.end());
    if (options.limit > 0 && models.size() > options.limit) models.resize(options.limit);
    std::ostringstream csv;
    csv << "model,factor,kept,bare,twice\n";
    std::map<double, std::vector<std::pair<double, std::string>>> kept_of;
    for (const Path& model : models) {
        const std::string number = model.stem().string(), group = model.parent_path().filename().string();
        const Mesh mesh = read_mesh(model).mesh;
        const SurfaceSearch home(mesh);
        const std::vector<int> labels =
            read_labels(Path(options.labels) / group / number / (number + "_0.seg"), mesh.number_of_faces());
        const AnnotationSet set = regions_of(labels);
        for (const double factor : {2.0, 0.25}) {
            RemeshOptions remeshing;
            remeshing.vertices = static_cast<std::uint64_t>(factor * static_cast<double>(mesh.number_of_vertices()));
            const Mesh other = remesh(mesh, remeshing).mesh;
            TransferOptions transferring;
            transferring.overlap = false;
            const SurfaceSearch search(other);
            const Painted there = paint(other, transfer(mesh, set, search, transferring).annotations);
            const Painted back = paint(mesh, transfer(other, regions_of(there.labels), home, transferring).annotations);
            double kept = 0;
            for (const Face f : mesh.faces())
                if (back.labels[f] == labels[f]) kept += face_area(mesh, f);
            kept /= surface_area(mesh);
            kept_of[factor].emplace_back(kept, group + "/" + number);
            csv << group << '/' << number << ',' << factor << ',' << kept << ',' << there.bare << ',' << there.twice << '\n';
            std::cerr << group << '/' << number << " x" << factor << " kept " << kept << " bare " << there.bare << " twice "
                      << there.twice << '\n';
        }
    }
    std::cout << "| vertices | models | mean area that keeps its label % | worst % | worst model |\n|---|---|---|---|---|\n";
    for (const auto& [factor, list] : kept_of) {
        double sum = 0;
        for (const auto& [kept, name] : list) sum += kept;
        const auto worst = *std::min_element(list.begin(), list.end());
        char line[200];
        std::snprintf(line, sizeof line, "| x %g | %zu | %.3f | %.3f | %s |\n", factor, list.size(),
                      100 * sum / static_cast<double>(list.size()), 100 * worst.first, worst.second.c_str());
        std::cout << line;
    }
    if (!options.csv.empty()) write_file(options.csv, csv.str());
}

}  // namespace ostraka::experiments

#include "class_objects.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/annotation/remap.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/stats/scores.h"

#include <algorithm>
#include <filesystem>
#include <map>

namespace ostraka::experiments {

std::vector<std::int32_t> typical_labels(const Path& folder, const Mesh& mesh) {
    std::map<std::string, Path> files;
    if (std::filesystem::is_directory(folder))
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (extension(entry.path()) == ".seg") files[entry.path().filename().string()] = entry.path();
    if (files.empty()) fail_input(folder.string(), "has no .seg", "unpack the archive of labels there");
    std::vector<std::vector<int>> lists;
    for (const auto& [name, file] : files) lists.push_back(read_labels(file, mesh.number_of_faces()));
    std::size_t best = 0;
    double maximum = -2 * static_cast<double>(lists.size());
    for (std::size_t i = 0; i < lists.size(); ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < lists.size(); ++j) sum += i == j ? 0 : adjusted_rand_index(lists[i], lists[j]);
        if (sum > maximum) maximum = sum, best = i;
    }
    return lists[best];
}

namespace {

/// One region per connected component of a label with at least 0.5 % of the surface; smaller ones are lost on a simplified
/// mesh.
AnnotationSet parts_by_label(const Mesh& mesh, const std::vector<std::int32_t>& labels) {
    constexpr double minimum = 0.005;
    AnnotationSet set;
    std::vector<bool> seen(mesh.number_of_faces());
    const double area = surface_area(mesh);
    for (const Face seed : mesh.faces()) {
        if (seen[seed]) continue;
        std::vector<Face> front{seed};
        seen[seed] = true;
        double own = 0;
        Annotation part;
        for (std::size_t i = 0; i < front.size(); ++i) {
            own += face_area(mesh, front[i]);
            part.faces.push_back(front[i].idx());
            for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(front[i]))) {
                const Halfedge o = mesh.opposite(h);
                if (mesh.is_border(o)) continue;
                const Face next = mesh.face(o);
                if (!seen[next] && labels[next] == labels[seed]) seen[next] = true, front.push_back(next);
            }
        }
        if (own < minimum * area) continue;
        std::sort(part.faces.begin(), part.faces.end());
        part.id = static_cast<int>(set.annotations.size());
        part.tag = "piece";
        set.annotations.push_back(std::move(part));
    }
    return set;
}

}  // namespace

AnnotationSet parts_on(const Mesh& mesh, const Mesh& labelled, const std::vector<std::int32_t>& labels) {
    const SurfaceSearch search(labelled);
    std::vector<std::int32_t> own;
    for (const Face face : mesh.faces()) own.push_back(labels[search.closest(centroid(mesh, face)).face]);
    return parts_by_label(mesh, own);
}

std::vector<ClassObject> read_class_objects(const std::string& folder, std::size_t maximum) {
    std::map<std::string, std::map<int, Path>> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (extension(entry.path()) == ".off")
            files[entry.path().parent_path().filename().string()][std::stoi(entry.path().stem().string())] = entry.path();
    std::vector<ClassObject> objects;
    for (const auto& [class_name, list] : files) {
        std::size_t taken = 0;
        for (const auto& [number, file] : list) {
            if (taken++ == maximum) break;
            ClassObject object;
            object.class_name = class_name;
            object.member.name = class_name + " " + std::to_string(number);
            object.member.mesh = read_mesh(file).mesh;
            objects.push_back(std::move(object));
        }
    }
    if (objects.empty()) fail_input(folder, "has no <class>/<number>.off", "unpack the archive of models there");
    return objects;
}

}  // namespace ostraka::experiments

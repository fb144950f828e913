#include "workbench/scene.h"

#include "ostraka/operations/page_results.h"
#include "ostraka/render/values.h"

namespace ostraka::workbench {

std::vector<Path> files_for(const Session& session, bool deformed) {
    std::vector<Path> files;
    const SessionState& state = session.state();
    const SessionObject* object = state.object();
    if (object == nullptr) return files;
    for (const SessionFile& file : state.files)
        if (file.object == object->name && (file.name.ends_with(".npy") || file.name.ends_with(".json")))
            files.push_back(session.path_of(file.file));
    if (deformed) {
        const Path shape = session.path_of(object->part("deformed"));
        files.push_back(shape.parent_path() / "report.json");
    }
    return files;
}

void Scene::add(const ShownShape& shape) {
    PageObject object;
    object.name = shape.name;
    object.mesh = shape.mesh;
    object.extras = shape.extras;
    object.annotations = shape.set;
    object.graph = shape.graph;
    if (shape.graph != nullptr && shape.set != nullptr) object.checks = check_relations({*shape.mesh, *shape.set}, *shape.graph);
    object.cage = shape.cage;
    object.maps = shape.maps;
    object.exact = {shape.key, !known_keys_.contains(shape.key)};
    const AnnotationSet no_annotations;
    std::optional<PageSlices> slices;
    for (const Path& file : shape.files) {
        if (!file_exists(file)) continue;
        if (extension(file) == ".npy") {
            std::vector<double> values = read_values(file);
            if (values.size() == shape.mesh->number_of_faces()) values = vertex_means(*shape.mesh, values);
            if (values.size() != shape.mesh->number_of_vertices()) continue;
            object.maps.push_back({file.stem().string(), file.stem().string(), std::move(values)});
            continue;
        }
        const Json document = read_json(file);
        if (!document.IsObject()) continue;
        const std::string format = text_in(document, "format");
        if (format == "ostraka-slices") slices = page_slices(document, file.string());
        const JsonValue* result = find_member(document, "result");
        if (format != "ostraka-report" || text_in(document, "command") != "deform" || result == nullptr) continue;
        object.constraints = page_constraints(*result, shape.set != nullptr ? *shape.set : no_annotations);
        object.conflicts = page_conflicts(*result);
    }
    if (slices) object.slices = &*slices;
    page_.add(object);
}

void Scene::add_report(const Path& file, const std::string& operation) {
    if (!file_exists(file)) return;
    const Json document = read_json(file);
    const JsonValue* result = document.IsObject() ? find_member(document, "result") : nullptr;
    if (result == nullptr || !result->IsObject()) return;
    for (PageTable& table : record_tables(*result, operation)) page_.add(std::move(table));
}

}  // namespace ostraka::workbench

#include "ostraka/workbench/workbench.h"
#include "ostraka/coords/coordinate_file.h"

#include "workbench/request.h"
#include "workbench/scene.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/stopwatch.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/json_build.h"
#include "ostraka/operations/page_results.h"
#include "ostraka/relation/topology.h"
#include "ostraka/select/recipe.h"
#include "ostraka/semantic/cage_reach.h"
#include "ostraka/vocabulary/skos.h"

#include <fmt/core.h>

#include <set>

namespace ostraka {

using workbench::fail_request;

namespace {

constexpr std::size_t kept_meshes = 12;
constexpr std::uintmax_t largest_preview = 24'000'000;  // bytes of a file of which a thumbnail is made

JsonValue error_json(const std::string& problem, const std::string& where, const std::string& remedy, JsonAllocator& a) {
    return json_object(a, "problem", problem, "where", where, "remedy", remedy);
}

template <class Numbers>
std::string_view bytes_of(const Numbers& numbers) {
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(*numbers.data())};
}

/// Appends data at the next multiple of eight bytes; returns its offset and size.
JsonValue append(std::string& bytes, std::string_view data, JsonAllocator& a) {
    bytes.resize((bytes.size() + 7) / 8 * 8, '\0');
    JsonValue range = json_value(std::array{bytes.size(), data.size()}, a);
    bytes += data;
    return range;
}

}  // namespace

/// A mesh with its associated data, as displayed.
struct Workbench::Shape {
    std::shared_ptr<const MeshFile> mesh, cage;
    std::optional<AnnotationSet> set;
    std::optional<RelationGraph> graph;
};

/// State of a drag, kept between frames.
struct Workbench::Deformation {
    std::size_t place = 0;    ///< step of the session
    std::string object_name;  ///< name of the object
    std::shared_ptr<const Shape> rest;
    const AnnotationSet* set = nullptr;
    Coordinates coordinates;
    Json edit;
    std::vector<Index> handles;
    std::array<double, 3> low{};  ///< min corner of the bounding box of the displayed shape; positions are relative to it
    std::unique_ptr<LiveDeformation> live;
    Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> weights;  ///< weights used for drawing
};

Workbench::Workbench(Path folder, Path root, double memory_limit)
    : session_(std::move(folder), std::move(root)),
      uploads_(session_.folder()),
      memory_limit_(memory_limit),
      context_(fresh_context()) {}

std::unique_ptr<Context> Workbench::fresh_context() {
    auto fresh = std::make_unique<Context>();
    fresh->keep_objects = true;
    fresh->watch.memory_limit = memory_limit_;
    fresh->watch.on_progress = [this](const std::string& phase, double share) {
        if (on_progress) on_progress(phase, share);
    };
    return fresh;
}

Workbench::~Workbench() = default;

void Workbench::prepare() {
    try {
        for (const SessionObject& object : session_.state().objects)
            for (const char* part : {"mesh", "deformed"})
                if (const std::string file = object.part(part); !file.empty()) static_cast<void>(mesh_of(file));
    } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch): the page will ask for it
    }
}

void Workbench::cancel() {
    const std::lock_guard lock(mutex_);
    context_->watch.cancel();
}

const std::map<std::string, Workbench::Answer>& Workbench::answers() {
    static const std::map<std::string, Answer> handlers{
        {"hello", &Workbench::hello},         {"scene", &Workbench::scene},
        {"select", &Workbench::select},       {"run", &Workbench::run},
        {"grab", &Workbench::grab},           {"drag", &Workbench::drag},
        {"influence", &Workbench::influence}, {"file", &Workbench::file},
        {"handles", &Workbench::handles},     {"parts", &Workbench::parts},
        {"reach", &Workbench::reach},         {"upload", &Workbench::upload},
        {"preview", &Workbench::preview},
    };
    return handlers;
}

Workbench::Reply Workbench::answer(std::string_view text) {
    Reply reply;
    Json document(rapidjson::kObjectType), result(rapidjson::kObjectType);
    auto& a = document.GetAllocator();
    double id = 0;
    const std::size_t place = session_.place(), count = session_.steps().size();
    const auto fail = [&](const std::string& problem, const std::string& where, const std::string& remedy) {
        add_members(document, a, "id", id, "ok", false, "error", error_json(problem, where, remedy, a));
    };
    // The watch of a cancelled request stays cancelled, so the next request needs a new context.
    if (context_->watch.is_cancelled()) {
        auto fresh = fresh_context();
        const std::lock_guard lock(mutex_);
        context_ = std::move(fresh);
    }
    try {
        const Json request = parse_json(text, "the message");
        if (!request.IsObject()) fail_request("the message is not an object", "load the page again");
        if (const JsonValue* number = find_member(request, "id"); number != nullptr && number->IsNumber())
            id = number->GetDouble();
        const JsonValue* word = find_member(request, "do");
        const std::string action = word != nullptr && word->IsString() ? text_of(*word) : std::string();
        const WatchScope watched(&context_->watch);
        if (const auto handler = answers().find(action); handler != answers().end()) {
            (this->*handler->second)(request, result, reply.bytes);
        } else if (action == "open") {
            const JsonValue* name = find_member(request, "name");
            session_.open(name != nullptr && name->IsString() ? text_of(*name) : std::string(), [&](const SessionObject& object) {
                add_members(result, result.GetAllocator(), "notes", shape_of(object, false)->mesh->notes);
            });
        } else if (action == "go") {
            const JsonValue* target_place = find_member(request, "place");
            if (target_place == nullptr || !target_place->IsUint()) fail_request("no place is given", "load the page again");
            session_.go_to(target_place->GetUint());
        } else if (action == "save") {
            const JsonValue* name = find_member(request, "name");
            const Path file = session_.save(name != nullptr && name->IsString() ? text_of(*name) : std::string(), *context_);
            add_members(result, result.GetAllocator(), "file", file.string());
        } else {
            session_.change(request);
        }
        add_members(document, a, "id", id, "ok", true, "result", JsonValue(result, a));
    } catch (const Error& error) {
        fail(error.problem(), error.where(), error.remedy());
    } catch (const std::bad_alloc&) {
        fail("there is not enough memory", "", "use a smaller mesh");
    } catch (const std::exception& error) {
        fail(std::string("internal error: ") + error.what(), "", "please report it with what you did");
    }
    reply.changed = place != session_.place() || count != session_.steps().size();
    if (!document["ok"].GetBool()) reply.bytes.clear();
    reply.json = to_compact_text(document);
    return reply;
}

// ---- session state ----

void Workbench::add_session(Json& result) const {
    auto& a = result.GetAllocator();
    add_members(result, a, "place", session_.place(), "state", to_json(session_.state(), a), "history",
                json_list(session_.steps(), a, [&](const SessionStep& step) {
                    return json_object(a, "name", step.name, "title", step.title, "operation", step.operation, "holds",
                                       step.holds);
                }));
}

/// Labels of the concepts of all vocabularies in the root, by language; unreadable files are skipped.
JsonValue Workbench::words(JsonAllocator& a) const {
    JsonValue languages(rapidjson::kObjectType);
    std::map<std::string, std::set<std::string>> labels;  // by language
    for (const std::string& name : files_in(session_.root())) {
        if (!name.ends_with(".vocabulary.json") && !is_skos(name)) continue;
        try {
            const Path file = session_.root() / name;
            for (const Concept& vocabulary_concept : (is_skos(name) ? read_skos(file) : read_vocabulary(file)).concepts)
                for (const auto& [language, label] : vocabulary_concept.labels) labels[language].insert(label);
        } catch (const Error&) {  // NOLINT(bugprone-empty-catch)
        }
    }
    for (const auto& [language, texts] : labels) add_members(languages, a, language, texts);
    return languages;
}

void Workbench::hello(const JsonValue& /*request*/, Json& result, std::string& /*bytes*/) {
    auto& a = result.GetAllocator();
    add_members(result, a, "version", version(), "openable", session_.openable(), "words", words(a), "operations",
                json_list(operations(), a, [&](const OperationEntry& entry) { return Call(entry).declaration(a); }));
    add_session(result);
}

/// Path of a file named by the session.
Path Workbench::located(const std::string& file) const { return (session_.folder() / file).lexically_normal(); }

std::shared_ptr<const MeshFile> Workbench::mesh_of(const std::string& file) {
    const Path path = located(file);
    std::error_code ignored;
    const auto changed = std::filesystem::last_write_time(path, ignored).time_since_epoch().count();
    const std::string key = fmt::format("{}@{}/{}", path.string(), changed, size_of_file(path));
    if (const auto cached = meshes_.find(key); cached != meshes_.end()) return cached->second;
    if (meshes_.size() >= kept_meshes) meshes_.clear();
    return meshes_[key] = std::make_shared<const MeshFile>(in_file(path.string(), [&] { return read_mesh(path); }));
}

std::shared_ptr<const Workbench::Shape> Workbench::shape_of(const SessionObject& object, bool deformed) {
    auto shape = std::make_shared<Shape>();
    const std::string before = deformed ? "deformed" : "";
    const auto part = [&](const std::string& name) {
        const std::string part_file = object.part(deformed ? "deformed " + name : name);
        return part_file.empty() && deformed && name != "cage" ? object.part(name) : part_file;
    };
    shape->mesh = mesh_of(object.part(deformed ? "deformed" : "mesh"));
    if (const std::string file = part("annotations"); !file.empty()) {
        ReadAnnotationsOptions reading;
        reading.force_mesh = deformed;
        shape->set = read_annotations(located(file), shape->mesh->mesh, reading);
    }
    if (const std::string file = object.part("graph"); !file.empty() && shape->set)
        shape->graph = read_graph(located(file), *shape->set);
    if (const std::string file = part("cage"); !file.empty()) shape->cage = mesh_of(file);
    return shape;
}

void Workbench::scene(const JsonValue& request, Json& result, std::string& bytes) {
    auto& a = result.GetAllocator();
    std::vector<std::string> known_keys;
    for (const JsonValue& key : list_in(request, "known"))
        if (key.IsString()) known_keys.push_back(text_of(key));
    const SessionState& state = session_.state();
    workbench::Scene scene(known_keys);
    JsonValue shown_objects(rapidjson::kArrayType);
    for (std::size_t i = 0; i < state.objects.size(); ++i) {
        const SessionObject& object = state.objects[i];
        for (const bool deformed : {false, true}) {
            if (deformed && object.part("deformed").empty()) continue;
            const auto shape = shape_of(object, deformed);
            const std::string file = object.part(deformed ? "deformed" : "mesh");
            workbench::ShownShape shown_shape;
            shown_shape.name = deformed ? object.name + " (deformed)" : object.name;
            shown_shape.key = fmt::format("{}@{}", file, size_of_file(session_.path_of(file)));
            if (shape->cage) shown_shape.key += "+" + object.part(deformed ? "deformed cage" : "cage");
            shown_shape.mesh = &shape->mesh->mesh;
            shown_shape.extras = &shape->mesh->extras;
            shown_shape.set = shape->set ? &*shape->set : nullptr;
            shown_shape.graph = shape->graph ? &*shape->graph : nullptr;
            shown_shape.cage = shape->cage ? &shape->cage->mesh : nullptr;
            if (i == state.active && !deformed) shown_shape.maps = value_maps(*shape->mesh);
            if (i == state.active) shown_shape.files = workbench::files_for(session_, deformed);
            scene.add(shown_shape);
            shown_objects.PushBack(json_object(a, "object", i, "deformed", deformed), a);
        }
    }
    if (session_.place() > 0)
        if (const SessionStep& step = session_.steps()[session_.place() - 1]; !step.operation.empty())
            scene.add_report(session_.folder() / "steps" / step.name / "report.json", step.operation);
    Page::Content content = scene.content("the workbench");
    add_members(result, a, "shown", std::move(shown_objects), "content", content.data);
    add_session(result);
    add_members(result, a, "openable", session_.openable());
    bytes = std::move(content.bytes);
}

void Workbench::preview(const JsonValue& request, Json& result, std::string& bytes) {
    const std::string name = text_in(request, "name");
    const std::vector<std::string> names = session_.openable();
    if (std::find(names.begin(), names.end(), name) == names.end())
        fail_request(fmt::format("'{}' is not a file that can be opened", printable(name, 100)), "open one that is in the list");
    const Path file = session_.root() / name;
    if (name.ends_with(".json") || size_of_file(file) > largest_preview) return;
    const MeshFile mesh = in_file(file.string(), [&] { return read_mesh(file); });
    workbench::ShownShape shape;
    shape.name = shape.key = "preview of " + name;
    shape.mesh = &mesh.mesh;
    shape.extras = &mesh.extras;
    workbench::Scene scene({});
    scene.add(shape);
    Page::Content content = scene.content("the workbench");
    add_members(result, result.GetAllocator(), "content", content.data);
    bytes = std::move(content.bytes);
}

// ---- selection ----

void Workbench::select(const JsonValue& request, Json& result, std::string& bytes) {
    const SessionObject* object = session_.state().object();
    if (object == nullptr) fail_request("no object is open", "open a mesh or a template");
    const JsonValue* expression = find_member(request, "expression");
    if (expression == nullptr) fail_request("nothing is selected", "load the page again");
    const auto shape = shape_of(*object, false);
    const JsonValue* requested_type = find_member(request, "type");
    const std::string annotation_type =
        requested_type != nullptr && requested_type->IsString() ? text_of(*requested_type) : "region";
    Json recipe = json_document("recipe");
    auto& r = recipe.GetAllocator();
    add_members(recipe, r, "annotations",
                json_list_of(json_object(r, "id", 0, "tag", "selection", "type", annotation_type, "outline", "edges", "select",
                                         JsonValue(*expression, r)),
                             r));
    if (shape->set && shape->set->up) add_members(recipe, r, "up", *shape->set->up);
    RecipeStart start;
    start.face_labels = shape->mesh->extras.face_labels;
    start.attributes = &shape->mesh->extras;
    if (shape->set) {  // annotations to which a selection may refer
        start.annotations.annotations = shape->set->annotations;
        start.annotations.up = shape->set->up;
        int id = 0;
        for (const Annotation& annotation : shape->set->annotations) id = std::max(id, annotation.id + 1);
        for (Annotation& annotation : start.annotations.annotations) annotation.attributes.clear();  // attributes are not used
        recipe["annotations"][0]["id"].SetInt(id);
    }
    const int selection_id = recipe["annotations"][0]["id"].GetInt();
    const AnnotationSet set = follow_recipe(recipe, shape->mesh->mesh, std::move(start), "the selection");
    const Annotation* selection = set.find(selection_id);
    auto& a = result.GetAllocator();
    const std::string type = to_string(selection->type);
    add_members(result, a, "type", type);
    if (selection->type == AnnotationType::region) {
        std::vector<std::uint32_t> faces(selection->faces.begin(), selection->faces.end());
        add_members(result, a, "count", faces.size(), "faces", append(bytes, bytes_of(faces), a));
    } else if (selection->type == AnnotationType::line) {
        add_members(result, a, "count", selection->polylines.size(), "lines", selection->polylines);
    } else {
        add_members(result, a, "count", selection->points.size(), "points", selection->points);
    }
}

// ---- operations ----

void Workbench::run(const JsonValue& request, Json& result, std::string& /*bytes*/) {
    const Stopwatch watch;
    const Report report = session_.run(request, *context_);
    auto& a = result.GetAllocator();
    add_members(result, a, "holds", report.holds(), "text", report.to_text(ReportFormat::table), "notes", report.notes(),
                "result", JsonValue(report.result(), a), "seconds", watch.seconds());
}

void Workbench::file(const JsonValue& request, Json& result, std::string& bytes) {
    const JsonValue* name = find_member(request, "file");
    const Path path = session_.path_of(name != nullptr && name->IsString() ? text_of(*name) : std::string());
    if (is_folder(path)) fail_request(path.filename().string() + " is a folder", "look into " + path.string());
    bytes = read_file(path);
    add_members(result, result.GetAllocator(), "name", path.filename().string());
}

void Workbench::upload(const JsonValue& request, Json& result, std::string& /*bytes*/) {
    std::vector<AnnouncedFile> files;
    for (const JsonValue& file : list_in(request, "files")) {
        const double size = file.IsObject() ? number_or(file, "size", -1) : -1;
        if (!(size >= 0)) fail_request("a file is sent without its size", "load the page again");
        files.push_back({text_in(file, "name"), static_cast<std::uintmax_t>(std::min(size, 1e18))});
    }
    const std::vector<std::size_t> scans = scans_among(files);
    if (scans.empty())
        fail_request("none of the files is a scan",
                     "drop meshes (OBJ with its MTL file and images, GLB, PLY, STL, OFF, 3MF) or "
                     "point clouds (E57, LAS, PTS, PTX, PCD, XYZ)");
    add_members(result, result.GetAllocator(), "batch", uploads_.announce(files), "scans", scans);
}

// ---- deformation ----

Workbench::Deformation& Workbench::deformation() {
    const SessionObject* object = session_.state().object();
    if (object == nullptr) fail_request("no object is open", "open a mesh or a template");
    if (object->part("cage").empty()) fail_request(object->name + " has no cage", "make one first");
    if (object->part("coordinates").empty()) fail_request(object->name + " is not linked with its cage", "link them first");
    if (deformation_ && deformation_->place == session_.place() && deformation_->object_name == object->name)
        return *deformation_;
    auto fresh = std::make_unique<Deformation>();
    fresh->place = session_.place();
    fresh->object_name = object->name;
    fresh->rest = shape_of(*object, false);
    // The coordinates stay the same from drag to drag.
    const std::string file = object->part("coordinates");
    static const AnnotationSet none;
    if (deformation_ && deformation_->object_name == object->name && !deformation_->coordinates.kind.empty() &&
        deformation_->rest->mesh == fresh->rest->mesh && deformation_->rest->cage == fresh->rest->cage)
        fresh->coordinates = std::move(deformation_->coordinates), fresh->weights = std::move(deformation_->weights);
    else fresh->coordinates = read_coordinates(session_.path_of(file), fresh->rest->mesh->mesh, fresh->rest->cage->mesh);
    fresh->set = fresh->rest->set ? &*fresh->rest->set : &none;
    fresh->edit = json_document("edit");
    if (const std::string edit = object->part("edit"); !edit.empty()) fresh->edit = read_json(session_.path_of(edit));
    else add_members(fresh->edit, fresh->edit.GetAllocator(), "steps", JsonValue(rapidjson::kArrayType));
    const std::string shown = object->part("deformed");
    const CGAL::Bbox_3 box = bounding_box(shown.empty() ? fresh->rest->mesh->mesh : mesh_of(shown)->mesh);
    fresh->low = {box.xmin(), box.ymin(), box.zmin()};
    deformation_ = std::move(fresh);
    return *deformation_;
}

/// Cage vertices that influence an annotation: {"annotation": ID, "threshold": NUMBER or "auto-mesh", "auto-cage"}.
void Workbench::handles(const JsonValue& request, Json& result, std::string& /*bytes*/) {
    Deformation& drag = deformation();
    const JsonValue *id = find_member(request, "annotation"), *threshold = find_member(request, "threshold");
    const Annotation* annotation = id != nullptr && id->IsInt() ? drag.set->find(id->GetInt()) : nullptr;
    if (annotation == nullptr) fail_request("there is no such annotation", "choose one of the list");
    const std::vector<Index> rows = vertices_of(drag.rest->mesh->mesh, *annotation);
    const double min_influence =
        threshold != nullptr && threshold->IsNumber()
            ? threshold->GetDouble()
            : influence_threshold(drag.coordinates.vertex,
                                  threshold != nullptr && threshold->IsString() ? text_of(*threshold) : "auto-mesh", rows);
    add_members(result, result.GetAllocator(), "handles", influential(drag.coordinates, rows, min_influence), "threshold",
                min_influence);
}

/// For each cage vertex the indices of the annotations it influences; only regions that contain no other are listed.
void Workbench::parts(const JsonValue& /*request*/, Json& result, std::string& /*bytes*/) {
    const Deformation& drag = deformation();
    std::vector<std::vector<std::size_t>> annotations_of_vertex(static_cast<std::size_t>(drag.coordinates.vertex.cols()));
    const auto& annotations = drag.set->annotations;
    const ContainmentOrder order = topology({drag.rest->mesh->mesh, *drag.set}).order;
    std::vector<bool> contains(annotations.size(), false);
    for (std::size_t i = 0; i < annotations.size(); ++i)
        if (order.parent[i] && annotations[i].type == AnnotationType::region) contains[*order.parent[i]] = true;
    for (std::size_t i = 0; i < annotations.size(); ++i) {
        if (annotations[i].type != AnnotationType::region || contains[i]) continue;
        const std::vector<Index> rows = vertices_of(drag.rest->mesh->mesh, annotations[i]);
        for (const Index h : influential(drag.coordinates, rows, influence_threshold(drag.coordinates.vertex, "auto-mesh", rows)))
            annotations_of_vertex[h].push_back(i);
    }
    add_members(result, result.GetAllocator(), "parts", annotations_of_vertex);
}

/// Influence of the handles on each vertex, from 0 to 1: {"handles": [INDEX, ...]}.
void Workbench::influence(const JsonValue& request, Json& result, std::string& bytes) {
    Deformation& drag = deformation();
    const WeightMatrix& weights = drag.coordinates.vertex;
    std::vector<float> sums(static_cast<std::size_t>(weights.rows()), 0);
    for (const JsonValue& handle : list_in(request, "handles")) {
        if (!handle.IsUint() || handle.GetUint() >= weights.cols())
            fail_request("a handle is not a vertex of the cage", "load the page again");
        for (Eigen::Index i = 0; i < weights.rows(); ++i)
            sums[static_cast<std::size_t>(i)] += static_cast<float>(weights(i, handle.GetUint()));
    }
    auto& a = result.GetAllocator();
    add_members(result, a, "values", append(bytes, bytes_of(sums), a));
}

/// Constraints that the cage cannot satisfy, before any edit: the number of constraints, and one sentence for each unsatisfied
/// one.
void Workbench::reach(const JsonValue& /*request*/, Json& result, std::string& /*bytes*/) {
    const Deformation& drag = deformation();
    if (!drag.rest->graph) fail_request(drag.object_name + " has no relationships", "state a constraint first");
    const HandleSpace space{{drag.rest->mesh->mesh, *drag.set}, &drag.rest->cage->mesh, &drag.coordinates};
    const auto reaches = cage_reach(space, *drag.rest->graph);
    std::vector<std::string> texts;
    for (const ConstraintReach& constraint : reaches)
        if (!constraint.reached) texts.push_back(describe(constraint, *drag.set));
    add_members(result, result.GetAllocator(), "constraints", reaches.size(), "texts", texts);
}

/// Starts a drag: {"handles": [INDEX, ...], "constraints": BOOLEAN}. Returns four numbers (m, w) per vertex. While all handles
/// follow one affine map x -> A x + t, vertex v moves to v + (A - I) m + w t.
void Workbench::grab(const JsonValue& request, Json& result, std::string& bytes) {
    Deformation& drag = deformation();
    const Index count = static_cast<Index>(drag.rest->cage->mesh.number_of_vertices());
    drag.handles.clear();
    for (const JsonValue& handle : list_in(request, "handles")) {
        if (!handle.IsUint() || handle.GetUint() >= count)
            fail_request("a handle is not a vertex of the cage", "load the page again");
        drag.handles.push_back(handle.GetUint());
    }
    std::sort(drag.handles.begin(), drag.handles.end());
    drag.handles.erase(std::unique(drag.handles.begin(), drag.handles.end()), drag.handles.end());
    if (drag.handles.empty()) fail_request("no control point is chosen", "choose some");
    RelationGraph graph;
    if (flag_in(request, "constraints") && drag.rest->graph)
        for (const Relationship& relationship : drag.rest->graph->relationships)
            if (relationship.is_constraint) graph.relationships.push_back(relationship);
    const HandleSpace space{{drag.rest->mesh->mesh, *drag.set}, &drag.rest->cage->mesh, &drag.coordinates};
    if (drag.weights.size() == 0) drag.weights = drag.coordinates.vertex.cast<float>();
    drag.live = std::make_unique<LiveDeformation>(space, graph, edit_from_json(drag.edit, "the drag"), drag.handles);
    const auto& cage = drag.live->cage();
    auto& a = result.GetAllocator();
    const WeightMatrix& weights = drag.coordinates.vertex;
    std::vector<float> moved(4 * static_cast<std::size_t>(weights.rows()), 0);
    for (Eigen::Index i = 0; i < weights.rows(); ++i) {
        std::array<double, 4> sum{};
        for (const Index h : drag.handles) {
            const double w = weights(i, h);
            sum[0] += w * (cage[h].x() - drag.low[0]);
            sum[1] += w * (cage[h].y() - drag.low[1]);
            sum[2] += w * (cage[h].z() - drag.low[2]);
            sum[3] += w;
        }
        for (std::size_t k = 0; k < 4; ++k) moved[4 * static_cast<std::size_t>(i) + k] = static_cast<float>(sum[k]);
    }
    add_members(result, a, "constrained", drag.live->has_constraints(), "handles", drag.handles, "edit", JsonValue(drag.edit, a),
                "weights", append(bytes, bytes_of(moved), a));
}

/// Surface that satisfies the constraints with the handles at {"places": [[x, y, z], ...]}, in their order; positions are
/// relative to the bounding box.
void Workbench::drag(const JsonValue& request, Json& result, std::string& bytes) {
    if (!deformation_ || !deformation_->live || deformation_->place != session_.place())
        fail_request("nothing has been grabbed", "choose control points and drag them");
    Deformation& drag = *deformation_;
    const Stopwatch watch;
    std::vector<Point> places;
    for (const JsonValue& position : list_in(request, "places")) {
        if (!position.IsArray() || position.Size() != 3 || !position[0].IsNumber() || !position[1].IsNumber() ||
            !position[2].IsNumber())
            fail_request("a position is not a list of three numbers", "load the page again");
        places.emplace_back(position[0].GetDouble(), position[1].GetDouble(), position[2].GetDouble());
    }
    const std::vector<Point>& cage = drag.live->follow(places);
    const double solving = watch.seconds();
    // Single precision suffices for display and halves the memory traffic.
    Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> moved(static_cast<Eigen::Index>(cage.size()), 3);
    for (std::size_t i = 0; i < cage.size(); ++i)
        for (int k = 0; k < 3; ++k)
            moved(static_cast<Eigen::Index>(i), k) = static_cast<float>(cage[i][k] - drag.low[static_cast<std::size_t>(k)]);
    Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> shape(drag.weights.rows(), 3);
    parallel_blocks(static_cast<std::size_t>(drag.weights.rows()), 512, [&](std::size_t begin, std::size_t end) {
        const auto first = static_cast<Eigen::Index>(begin), count = static_cast<Eigen::Index>(end - begin);
        shape.middleRows(first, count).noalias() = drag.weights.middleRows(first, count) * moved;
    });
    const auto bytes_in = [](const auto& matrix) {
        return std::string_view(reinterpret_cast<const char*>(matrix.data()),
                                static_cast<std::size_t>(matrix.size()) * sizeof(float));
    };
    auto& a = result.GetAllocator();
    add_members(result, a, "positions", append(bytes, bytes_in(shape), a), "cage", append(bytes, bytes_in(moved), a), "solving",
                solving, "seconds", watch.seconds());
}

}  // namespace ostraka

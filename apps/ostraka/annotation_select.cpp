// ostraka annotation select: one step of a recipe, given by flags.
#include "annotation_names.h"
#include "number_lists.h"
#include "step_flags.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/measure/examine.h"
#include "ostraka/select/recipe.h"

#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct Select {
    std::string mesh, annotations, output, record, object_class, unit;
    StepFlags step;
    ReadAnnotationsOptions options;

    int run(const Session& session) const;

private:
    [[nodiscard]] Json recipe_before(bool& fresh, bool new_file) const;
    void add_head(Json& recipe, bool new_file) const;
    void print(const Session& session, const Provenance& provenance, const Mesh& on, const AnnotationSet& set, int id) const;
};

/// What the flags say of the object, where the recipe does not. With an older file --up turns the camera only.
void Select::add_head(Json& recipe, bool new_file) const {
    auto& a = recipe.GetAllocator();
    const auto missing = [&](const char* name) { return find_member(recipe, name) == nullptr; };
    if (!object_class.empty() && missing("class")) add_member(recipe, "class", object_class, a);
    if (!unit.empty() && missing("unit")) add_member(recipe, "unit", unit, a);
    if (!new_file || step.up.empty() || !missing("up")) return;
    JsonValue list(rapidjson::kArrayType);
    for (const double x : direction_of(step.up, "--up")) list.PushBack(x, a);
    add_member(recipe, "up", std::move(list), a);
}

/// The recipe to add to; a fresh one with the head as the flags say.
Json Select::recipe_before(bool& fresh, bool new_file) const {
    fresh = record.empty() || !std::filesystem::exists(record);
    if (!fresh) {
        Json recipe = read_json(record);
        validate(recipe, "recipe", record);
        return recipe;
    }
    Json recipe(rapidjson::kObjectType);
    auto& a = recipe.GetAllocator();
    add_member(recipe, "format", "ostraka-recipe", a);
    add_member(recipe, "version", JsonValue(1), a);
    add_head(recipe, new_file);
    add_member(recipe, "annotations", JsonValue(rapidjson::kArrayType), a);
    return recipe;
}

/// True if the set is what following the recipe with these bytes gives.
bool stems_from(const AnnotationSet& set, const std::string& recipe_bytes) {
    if (!set.provenance.IsObject()) return false;
    const JsonValue *command = find_member(set.provenance, "command"), *inputs = find_member(set.provenance, "inputs");
    if (command == nullptr || !command->IsString() || std::string(command->GetString()) != "annotation apply" ||
        inputs == nullptr || !inputs->IsArray() || inputs->Size() != 2)
        return false;
    const JsonValue& recipe = (*inputs)[1];
    const JsonValue* hash = recipe.IsObject() ? find_member(recipe, "sha256") : nullptr;
    return hash != nullptr && hash->IsString() && sha256(recipe_bytes) == hash->GetString();
}

int Select::run(const Session& session) const {
    const std::string target = output.empty() ? annotations : output;
    check_outputs({mesh}, {target, record});
    if (!output.empty()) check_outputs({annotations}, {output});
    const bool exists = std::filesystem::exists(annotations);
    const MeshFile file = read_mesh(mesh);
    for (const auto& note : file.notes) session.note("note: " + note);
    RecipeStart start;
    start.face_labels = file.extras.face_labels;
    if (start.face_labels.empty() && !file.extras.vertex_labels.empty())
        start.face_labels = face_labels_from_vertices(file.mesh, file.extras.vertex_labels);
    if (!record.empty()) start.folder = Path(record).parent_path();
    if (exists) start.annotations = read_annotations(annotations, file.mesh, options);

    bool fresh = false;
    Json recipe = recipe_before(fresh, !exists);
    const bool replayable = !record.empty() && (fresh ? !exists : exists && stems_from(start.annotations, read_file(record)));
    // This step alone, with the head of the recipe, on what there is.
    Json now(rapidjson::kObjectType);
    now.CopyFrom(recipe, now.GetAllocator());
    now["annotations"].Clear();
    if (!exists) add_head(now, true);
    const auto append = [&](const JsonValue& made) {
        for (Json* to : {&recipe, &now}) {
            JsonValue copy;
            copy.CopyFrom(made, to->GetAllocator());
            (*to)["annotations"].PushBack(copy, to->GetAllocator());
        }
    };
    if (!exists && !object_class.empty() && !(step.tools.all && step.action == "make")) {
        // The whole object comes first, as a step of its own: later steps then find the same ids.
        Json whole = parse_json(R"({"id": 0, "colour": [128, 128, 128], "type": "region", "select": {"all": true}})", "root");
        add_member(whole, "tag", object_class, whole.GetAllocator());
        append(whole);
    }
    AnnotationSet before_step;  // ids and colours follow what is there when the step is taken
    before_step.annotations = start.annotations.annotations;
    if (now["annotations"].Size() > 0) before_step.annotations.emplace_back();
    const Json made = step.step(before_step);
    const int made_id = made["id"].GetInt();
    append(made);
    const AnnotationSet set = follow_recipe(now, file.mesh, std::move(start), "selection");

    Provenance provenance{replayable ? "annotation apply" : "annotation select", {}, {}};
    provenance.add_input(mesh);
    if (replayable) {
        provenance.inputs.emplace_back(Path(record).filename().string(), sha256(to_text(recipe)));
    } else {
        if (exists) provenance.add_input(annotations);
        provenance.options.emplace_back("step", to_text(made));
    }
    write_annotations(target, set, file.mesh, mesh, provenance);
    if (!record.empty()) {
        write_json(record, recipe);
        if (!replayable)
            session.note("note: " + record + " alone does not give " + target +
                         ": replay it with 'annotation apply --edit' on the annotations as they were before it was begun");
    }
    print(session, provenance, file.mesh, set, made_id);
    return done;
}

void Select::print(const Session& session, const Provenance& provenance, const Mesh& on, const AnnotationSet& set, int id) const {
    const Annotation* chosen = set.find(id);
    Json document(rapidjson::kObjectType);
    JsonValue result(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    add_member(result, "id", JsonValue(id), allocator);
    add_member(result, "action", step.action, allocator);
    if (chosen != nullptr) {
        const AnnotationSummary summary = summarise(on, *chosen);
        add_member(result, "tag", chosen->tag, allocator);
        add_member(result, "type", to_string(chosen->type), allocator);
        add_member(result, "elements", JsonValue(static_cast<std::uint64_t>(summary.elements)), allocator);
        add_member(result, "patches", JsonValue(static_cast<std::uint64_t>(summary.patches)), allocator);
        if (chosen->type == AnnotationType::region) add_member(result, "area", JsonValue(summary.area), allocator);
        if (chosen->type != AnnotationType::point) add_member(result, "length", JsonValue(summary.length), allocator);
        if (!session.json)
            std::cout << table(
                {"id", "tag", "type", "elements", "patches", in_unit("area", set), in_unit("perimeter / length", set)},
                {{std::to_string(id), chosen->tag, to_string(chosen->type), std::to_string(summary.elements),
                  std::to_string(summary.patches), chosen->type == AnnotationType::region ? number(summary.area) : "-",
                  chosen->type == AnnotationType::point ? "-" : number(summary.length)}});
    } else if (!session.json) {
        std::cout << "annotation " << id << " deleted\n";
    }
    if (session.json) session.print_report(provenance, document, result);
}

}  // namespace

void add_annotation_select(CLI::App& annotation, Session& session) {
    const auto select = std::make_shared<Select>();
    CLI::App* command = session.add(annotation, "select", "select a part by one tool and annotate it, or edit an annotation",
                                    [&session, select] { return select->run(session); });
    command->add_option("mesh", select->mesh, "mesh file")->required();
    command->add_option("annotations", select->annotations, "annotation file (.ant.json): brought up to date, or made")
        ->required();
    select->step.add_to(*command);
    command->add_option("--output", select->output, "write the annotations here and leave the file as it is");
    command->add_option("--record", select->record, "recipe to which the step is added, or which is begun");
    command->add_option("--class", select->object_class, "of a new file: what the object is (any text)");
    command->add_option("--unit", select->unit, "of a new file: unit of the coordinates (any text, such as mm)");
    add_flags(command, select->options);
}

}  // namespace ostraka::app

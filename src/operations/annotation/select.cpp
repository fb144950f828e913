// annotation select: one step of a recipe, specified by options.
#include "operations/annotation/select_step.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/measure/examine.h"
#include "ostraka/select/recipe.h"

namespace ostraka {

namespace {

struct AnnotationSelect final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("annotations", Kind::annotations, annotations, "annotation file (.ant.json) to update or create");
        p.output_option("output", Kind::annotations, output,
                        "write the annotations to this file, and leave the input file unchanged")
            .updates(annotations);
        p.input_option("record", Kind::recipe, record,
                       "recipe to which this selection is appended as a step; created if missing");
        p.output_option("recipe", Kind::recipe, recipe,
                        "write the recipe to this file, and leave the recipe of --record unchanged")
            .updates(record);
        step.declare_options(p.options);
        p.options.group("New file");
        p.options("class", object_class, "class of the object (any text), stored in a new file");
        p.options("unit", unit, "unit of the coordinates (any text, such as mm), stored in a new file");

        p.report.values(integer("id"), text("action"), text("tag"), text("type"), integer("elements"), integer("patches"),
                        number("area", "", "length^2"), number("length", "", "length"));
        p.report.table("", text_only("id"), text_only("tag"), text_only("type"), text_only("elements"), text_only("patches"),
                       text_only("area", FieldType::number, "length^2"),
                       text_only("perimeter / length", FieldType::number, "length"));
    }

    void check() const override { static_cast<void>(step.step({})); }

    void run(Context& context, Report& report) override {
        const MeshFile& file = *mesh;
        const bool makes = !annotations.exists(), begins = !record.exists();
        RecipeStart start;
        start.face_labels = file.extras.face_labels;
        if (start.face_labels.empty() && !file.extras.vertex_labels.empty())
            start.face_labels = face_labels_from_vertices(file.mesh, file.extras.vertex_labels);
        start.folder = Path(record.file()).parent_path();
        start.attributes = &file.extras;
        if (!makes) start.annotations = annotations.on(file.mesh);
        const std::string before =
            begins ? std::string() : record.load<std::string>([](const Path& path) { return read_file(path); });
        Json steps = begins ? begun(makes) : parse_json(before, record.file());
        if (!begins) validate(steps, "recipe", record.file());
        // Whether the recipe alone reproduces the annotations.
        const bool replayable = recipe && (begins ? makes : !makes && stems_from(start.annotations, steps, before, start.folder));

        // This step alone, with the head of the recipe, applied to the current annotations.
        Json now;
        now.CopyFrom(steps, now.GetAllocator());
        now["annotations"].Clear();
        if (makes) add_head(now, true);
        const auto append = [&](const JsonValue& made) {
            for (Json* to : {&steps, &now})
                (*to)["annotations"].PushBack(JsonValue(made, to->GetAllocator()), to->GetAllocator());
        };
        AnnotationSet there;  // new ids depend on the annotations present at this step
        there.annotations = start.annotations.annotations;
        if (makes && !object_class.empty() && !(step.all && step.action == "make")) {
            // The whole object is added first, as a step of its own, so that later steps find the same ids.
            Json whole = parse_json(R"({"id": 0, "type": "region", "select": {"all": true}})", "root");
            add_member(whole, "tag", object_class, whole.GetAllocator());
            append(whole);
            there.annotations.emplace_back();
        }
        if (step.action == "make") note_twins(there, report);
        const Json made = step.step(there);
        append(made);
        const Path folder = start.folder;
        AnnotationSet set;
        context.record([&] { set = follow_recipe(now, file.mesh, std::move(start), "selection"); });
        context.notes("", set.notes);
        report_result(report, {file.mesh, set}, made["id"].GetInt());

        const std::string text = to_text(steps);
        std::optional<Provenance> replay;
        if (replayable) {
            replay = {"annotation apply", {}, {context.provenance().inputs.front()}};
            for (const OperationEntry& entry : operations())
                if (entry.name == replay->command) replay->options = Call(entry).parameters().options.values();
            std::erase_if(replay->options, [](const auto& option) { return option.second.empty(); });
            replay->inputs.emplace_back(recipe.path().filename().string(), sha256(text));
            for (const Path& named : files_named_by(steps, folder)) replay->add_input(named);
        }
        output.write(std::move(set), file.mesh, mesh.file(), replay);
        if (!recipe) return;
        recipe.write(text);
        if (!replayable)
            report.note(recipe.file() + " alone does not give " + output.file() +
                        ": replay it with 'annotation apply --edit' on the annotations as they were before it was begun");
    }

    /// Notes that the set already has an annotation with this tag, as the user may have meant to extend it.
    void note_twins(const AnnotationSet& there, Report& report) const {
        std::vector<std::string> ids;
        for (const Annotation& annotation : there.annotations)
            if (annotation.tag == step.tag && annotation.id != step.id) ids.push_back(std::to_string(annotation.id));
        if (ids.empty()) return;
        report.note("a second annotation '" + printable(step.tag, 60) + "' is added beside that of id " + joined(ids) +
                    ": to make it a part of that one, give --action 'add to' --id " + ids.front());
    }

    /// Adds what the options state about the object and the recipe does not. With an existing file, --up sets the camera only.
    void add_head(Json& document, bool makes) const {
        auto& a = document.GetAllocator();
        const auto missing = [&](const char* name) { return find_member(document, name) == nullptr; };
        if (!object_class.empty() && missing("class")) add_members(document, a, "class", object_class);
        if (!unit.empty() && missing("unit")) add_members(document, a, "unit", unit);
        if (makes && !step.up.empty() && missing("up")) add_members(document, a, "up", direction_of(step.up, "--up"));
    }

    [[nodiscard]] Json begun(bool makes) const {
        Json document = json_document("recipe");
        add_head(document, makes);
        add_members(document, document.GetAllocator(), "annotations", JsonValue(rapidjson::kArrayType));
        return document;
    }

    /// Whether the set was produced by 'annotation apply' from the recipe with these bytes.
    static bool stems_from(const AnnotationSet& set, const Json& recipe, const std::string& bytes, const Path& folder) {
        if (!set.provenance.IsObject()) return false;
        const JsonValue *command = find_member(set.provenance, "command"), *inputs = find_member(set.provenance, "inputs");
        if (command == nullptr || !command->IsString() || std::string(command->GetString()) != "annotation apply" ||
            inputs == nullptr || !inputs->IsArray() || inputs->Size() != 2 + files_named_by(recipe, folder).size())
            return false;
        const JsonValue& second = (*inputs)[1];
        const JsonValue* hash = second.IsObject() ? find_member(second, "sha256") : nullptr;
        return hash != nullptr && hash->IsString() && sha256(bytes) == hash->GetString();
    }

    void report_result(Report& report, AnnotatedMeshView object, int id) const {
        report.set_unit(object.annotations.unit);
        report("id", id)("action", step.action);
        const Annotation* chosen = object.annotations.find(id);
        if (chosen == nullptr) return report.line("annotation " + std::to_string(id) + " deleted");
        const AnnotationSummary summary = summarise(object.mesh, *chosen);
        const bool region = chosen->type == AnnotationType::region, point = chosen->type == AnnotationType::point;
        const auto area = region ? std::optional(summary.area) : std::nullopt;
        const auto length = point ? std::nullopt : std::optional(summary.length);
        report("tag", chosen->tag)("type", to_string(chosen->type))("elements", summary.elements)("patches", summary.patches)(
            "area", area)("length", length);
        report.row("", {id, chosen->tag, to_string(chosen->type), summary.elements, summary.patches, area ? number(*area) : "-",
                        length ? number(*length) : "-"});
    }

    MeshInput mesh;
    AnnotationsInput annotations;
    AnnotationsOutput output;
    FileInput record;
    FileOutput recipe{".json"};
    SelectStep step;
    std::string object_class, unit;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_select() { return make<AnnotationSelect>(); }

}  // namespace ostraka

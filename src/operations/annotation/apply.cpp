// annotation apply, list, remap
#include "operations/operations.h"

#include "ostraka/annotation/colouring.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/annotation/remap.h"
#include "ostraka/measure/examine.h"
#include "ostraka/measure/measure.h"
#include "ostraka/select/recipe.h"
#include "ostraka/transfer/project_curves.h"
#include "ostraka/vocabulary/vocabulary.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

/// Whether the file is a recipe or annotations, as opposed to labels.
bool is_document(const Slot& slot) {
    const std::string ending = extension(slot.file());
    return ending == ".json" || ending == ".ant" || (slot && slot.sources.front().object.as<AnnotationSet>() != nullptr);
}

std::string attribute_text(const Attribute& attribute) {
    std::string text = attribute.name;
    if (attribute.type == AttributeType::semantic) return text + ": " + attribute.note;
    const bool measured = attribute.type == AttributeType::measure;
    const std::string& unit = measured ? attribute.measure.unit : attribute.descriptor.unit;
    if (measured && attribute.measure.value) text += " " + number(*attribute.measure.value);
    if (!measured)
        for (std::size_t i = 0; i < std::min<std::size_t>(attribute.descriptor.values.size(), 4); ++i)
            text += " " + number(attribute.descriptor.values[i]);
    if (!measured && attribute.descriptor.values.size() > 4) text += " ...";
    if (!measured && !attribute.descriptor.file.empty()) text += " in " + attribute.descriptor.file;
    if (!unit.empty()) text += " " + unit;
    return text + ((measured ? attribute.measure.stale : attribute.descriptor.stale) ? " (stale)" : "");
}

void declare_annotations(ReportLayout& layout) {
    layout.values(text("class"), text("unit"));
    layout.table("annotations", integer("id", "id"), text("tag", "tag"), text("type", "type"), integer("elements", "elements"),
                 integer("patches", "patches"), integer("outlines", "outlines"), number("area", "area", "length^2"),
                 number("perimeter", "", "length"), number("length", "", "length"),
                 people("perimeter / length", FieldType::number, "length"), texts("attributes", "attributes"), text("note"));
}

/// Reports the annotations of the set.
void report_annotations(Context& context, Report& report, const Mesh& mesh, const AnnotationSet& set) {
    context.notes("", set.notes);
    report.set_unit(set.unit);
    report("class", set.object_class)("unit", set.unit);
    report.empty_table("annotations");
    for (const Annotation& annotation : set.annotations) {
        const AnnotationSummary summary = summarise(mesh, annotation);
        Report::Row row = report.row("annotations");
        row("id", annotation.id)("tag", annotation.tag)("type", to_string(annotation.type))("elements", summary.elements)(
            "patches", summary.patches);
        if (annotation.type == AnnotationType::region)
            row("outlines", summary.outlines)("area", summary.area)("perimeter", summary.length);
        else row.shown("outlines", "-");
        if (annotation.type == AnnotationType::line) row("length", summary.length);
        if (annotation.type != AnnotationType::point) row.shown("perimeter / length", number(summary.length));
        std::vector<std::string> attributes;
        for (const Attribute& attribute : annotation.attributes) attributes.push_back(attribute_text(attribute));
        row("attributes", attributes,
            joined(attributes, "; ") + (annotation.note.empty() ? "" : fmt::format(" [{}]", annotation.note)));
        if (!annotation.note.empty()) row("note", annotation.note);
    }
}

/// Further outputs of annotations: a coloured mesh and face labels.
struct AnnotationPictures {
    MeshOutput coloured;
    FileOutput labels;

    void describe(Parameters& p) {
        p.output_option("ply", Kind::mesh, coloured,
                        "write the mesh in the colours of its annotations (PLY or another format with colours)");
        p.output_option("labels-out", Kind::labels, labels,
                        "label file to write: for each face the id of the smallest region on it, -1 for none");
    }
    void write(const Mesh& mesh, const AnnotationSet& set, Report& report) const {
        if (coloured) coloured.write(mesh, colour_by_annotation(mesh, set));
        if (!labels) return;
        const FaceLabels face_ids = face_labels(mesh, set);
        write_labels(labels.path(), face_ids.of_face);
        if (face_ids.lost > 0)
            report.note(number(100 * face_ids.lost, 3) +
                        " % of the area has another label than its face: free outlines cut faces");
    }
};

struct AnnotationApply final : Operation {
    void describe(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("recipe", Kind::recipe, recipe, "recipe (.recipe.json) or label file (one integer per face)").optional();
        p.output("output", Kind::annotations, output, "annotations to write (.ant.json)");
        p.order({"mesh", "recipe", "output"});
        p.order({"mesh", "output"});
        p.options("from-ply-labels", mesh_labels, "take the labels of the mesh file itself instead of a recipe or label file");
        p.input_option("names", Kind::text, names,
                       "JSON file with the labels' names, such as {\"0\": \"seat\", \"1\": \"back\"}; others are 'part N'");
        p.input_option("edit", Kind::annotations, edited, "annotations that the recipe's steps edit and add to");
        p.input_option("vocabulary", Kind::vocabulary, vocabulary,
                       "vocabulary (.vocabulary.json, .ttl, .rdf) that tags and attributes must be from");
        words.describe(p.options);
        pictures.describe(p);
        declare_annotations(p.report);
    }

    void check() const override {
        if (mesh_labels == static_cast<bool>(recipe))
            fail_usage(mesh_labels ? "--from-ply-labels takes a mesh and an output"
                                   : "a mesh, a recipe or label file, and an output are needed",
                       mesh_labels ? "leave out the recipe or label file" : "give them, or --from-ply-labels");
        if (edited && !is_document(recipe))
            fail_usage("--edit goes with a recipe", "give a recipe whose steps edit the annotations");
    }

    void run(Context& context, Report& report) override {
        const Vocabulary* allowed_words = vocabulary ? &vocabulary.load<Vocabulary>(read_vocabulary) : nullptr;
        const MeshFile& file = *mesh;
        const AnnotationSet set = is_document(recipe) ? follow(context, file) : from_labels(context, file);
        if (allowed_words != nullptr) require_vocabulary(set, *allowed_words, recipe ? recipe.file() : mesh.file(), words);
        output.write(set, file.mesh, mesh.file());
        pictures.write(file.mesh, set, report);
        report_annotations(context, report, file.mesh, set);
    }

    static std::vector<std::int32_t> labels_in(const MeshFile& file) {
        return file.extras.face_labels.empty() && !file.extras.vertex_labels.empty()
                   ? face_labels_from_vertices(file.mesh, file.extras.vertex_labels)
                   : file.extras.face_labels;
    }

    AnnotationSet follow(Context& context, const MeshFile& file) const {
        RecipeStart start{labels_in(file), {}, recipe.path().parent_path()};
        if (edited) start.annotations = edited.on(file.mesh);
        AnnotationSet set;
        context.record([&] { set = follow_recipe(recipe.load<Json>(read_json), file.mesh, std::move(start), recipe.file()); });
        return set;
    }

    AnnotationSet from_labels(Context& context, const MeshFile& file) const {
        std::vector<std::int32_t> labels;
        if (recipe)
            context.record([&] { labels = read_labels(recipe.path(), file.mesh.number_of_faces(), file.triangle_polygon); });
        else labels = labels_in(file);
        if (labels.empty())
            fail_input(mesh.file(), "has no labels",
                       "give a PLY file with a face or vertex property \"label\", a label file or a recipe");
        using Names = std::map<std::int32_t, std::string>;
        return regions_from_labels(file.mesh, labels, names ? names.load<Names>(read_label_names) : Names());
    }

    MeshInput mesh;
    FileInput recipe, names, vocabulary;
    AnnotationsInput edited;
    AnnotationsOutput output;
    AnnotationPictures pictures;
    CheckVocabularyOptions words;
    bool mesh_labels = false;
};

struct AnnotationList final : AnnotatedMeshOperation {
    void describe(Parameters& p) override {
        describe_inputs(p);
        declare_annotations(p.report);
    }

    void run(Context& context, Report& report) override { report_annotations(context, report, mesh->mesh, set()); }
};

struct AnnotationRemap final : Operation {
    void describe(Parameters& p) override {
        p.input("before", Kind::mesh, before, "mesh before the change");
        p.input("annotations", Kind::annotations, annotations, "its annotations (.ant.json) or label file");
        p.input("after", Kind::mesh, after, "mesh after the change");
        p.output("output", Kind::annotations, output, "annotations or labels to write");
        p.input_option("vertex-map", Kind::index_map, vertex_map, "map of the vertices (JSON)");
        p.input_option("face-map", Kind::index_map, face_map, "map of the faces (JSON); without it faces follow their corners");
        reading.describe(p.options);
        pictures.describe(p);
        declare_annotations(p.report);
        p.report.values(integer("labels", "labels written"));
    }

    void check() const override {
        if (is_document(annotations)) {
            if (!vertex_map) fail_usage("annotations follow a vertex map", "add --vertex-map FILE");
            return;
        }
        if (!face_map) fail_usage("labels follow a face map", "add --face-map FILE");
        if (pictures.coloured || pictures.labels)
            fail_usage("--ply and --labels-out go with annotations", "apply the new labels with 'annotation apply'");
    }

    void run(Context& context, Report& report) override {
        const Mesh& target = after->mesh;
        if (!is_document(annotations)) return carry_labels(context, report, target);
        const Mesh& source = before->mesh;
        AnnotationSet set;
        std::vector<Index> vertices, faces;
        const auto in_memory = annotations.annotations_on(source);
        context.record([&] {
            set = in_memory ? *in_memory : read_annotations(annotations.path(), source, reading);
            vertices = read_index_map(vertex_map.path(), "vertex", source.number_of_vertices(), target.number_of_vertices());
            if (face_map) faces = read_index_map(face_map.path(), "face", source.number_of_faces(), target.number_of_faces());
        });
        AnnotationSet remapped = remap_annotations(source, set, target, vertices, faces);
        for (auto& note : project_free_annotations(source, set, target, remapped)) remapped.notes.push_back(std::move(note));
        for (const auto& note : refresh_measures(target, remapped).notes) remapped.notes.push_back(note);
        write_annotations(output.path(), remapped, target, after.file(), context.provenance());
        pictures.write(target, remapped, report);
        report_annotations(context, report, target, remapped);
    }

    /// The old mesh may be defective: labels only need its number of faces.
    void carry_labels(Context& context, Report& report, const Mesh& target) const {
        const TriangulatedSoup source = triangulate(before.take_polygons());
        const std::size_t count = source.soup.triangles.size();
        std::vector<std::int32_t> labels;
        std::vector<Index> faces;
        context.record([&] {
            labels = read_labels(annotations.path(), count, source.triangle_polygon);
            faces = read_index_map(face_map.path(), "face", count, target.number_of_faces());
        });
        write_labels(output.path(), remap_labels(labels, faces, target.number_of_faces()));
        report("labels", target.number_of_faces());
    }

    MeshInput before, after;
    FileInput annotations, vertex_map, face_map;
    FileOutput output;
    ReadAnnotationsOptions reading;
    AnnotationPictures pictures;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_apply() { return make<AnnotationApply>(); }
std::unique_ptr<Operation> make_annotation_list() { return make<AnnotationList>(); }
std::unique_ptr<Operation> make_annotation_remap() { return make<AnnotationRemap>(); }

}  // namespace ostraka

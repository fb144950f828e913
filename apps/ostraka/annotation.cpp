// ostraka annotation apply | list | check | remap
#include "annotation_names.h"
#include "command.h"
#include "word_checks.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/colouring.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/annotation/remap.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/measure/examine.h"
#include "ostraka/measure/measure.h"
#include "ostraka/select/recipe.h"

#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

bool is_json(const std::string& file) { return extension(file) == ".json" || extension(file) == ".ant"; }

std::vector<Path> given(std::initializer_list<std::string> files) {
    std::vector<Path> list;
    for (const auto& file : files)
        if (!file.empty()) list.emplace_back(file);
    return list;
}

std::string value_text(const Attribute& attribute) {
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

/// What a set holds, as a table or a report.
void print_set(const Session& session, const Provenance& provenance, const Mesh& mesh, const AnnotationSet& set) {
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType), notes(rapidjson::kArrayType);
    std::vector<std::vector<std::string>> rows;
    for (const Annotation& annotation : set.annotations) {
        const AnnotationSummary summary = summarise(mesh, annotation);
        const bool region = annotation.type == AnnotationType::region, point = annotation.type == AnnotationType::point;
        JsonValue entry(rapidjson::kObjectType);
        add_member(entry, "id", JsonValue(annotation.id), allocator);
        add_member(entry, "tag", annotation.tag, allocator);
        add_member(entry, "type", to_string(annotation.type), allocator);
        add_member(entry, "elements", JsonValue(static_cast<std::uint64_t>(summary.elements)), allocator);
        add_member(entry, "patches", JsonValue(static_cast<std::uint64_t>(summary.patches)), allocator);
        if (region) add_member(entry, "outlines", JsonValue(static_cast<std::uint64_t>(summary.outlines)), allocator);
        if (region) add_member(entry, "area", JsonValue(summary.area), allocator);
        if (!point) add_member(entry, region ? "perimeter" : "length", JsonValue(summary.length), allocator);
        JsonValue attributes(rapidjson::kArrayType);
        std::string attribute_text;
        for (const Attribute& attribute : annotation.attributes) {
            attribute_text += (attribute_text.empty() ? "" : "; ") + value_text(attribute);
            attributes.PushBack(json_string(value_text(attribute), allocator), allocator);
        }
        add_member(entry, "attributes", std::move(attributes), allocator);
        if (!annotation.note.empty()) add_member(entry, "note", annotation.note, allocator);
        list.PushBack(entry, allocator);
        rows.push_back({std::to_string(annotation.id), annotation.tag, to_string(annotation.type),
                        std::to_string(summary.elements), std::to_string(summary.patches),
                        region ? std::to_string(summary.outlines) : "-", region ? number(summary.area) : "-",
                        point ? "-" : number(summary.length),
                        attribute_text + (annotation.note.empty() ? "" : " [" + annotation.note + "]")});
    }
    for (const auto& note : set.notes) notes.PushBack(json_string(note, allocator), allocator);
    add_member(result, "class", set.object_class, allocator);
    add_member(result, "unit", set.unit, allocator);
    add_member(result, "annotations", std::move(list), allocator);
    add_member(result, "notes", std::move(notes), allocator);
    for (const auto& note : set.notes) session.note("note: " + note);
    if (session.json) session.print_report(provenance, document, result);
    else
        std::cout << table({"id", "tag", "type", "elements", "patches", "outlines", in_unit("area", set),
                            in_unit("perimeter / length", set), "attributes"},
                           rows);
}

struct Outputs {
    std::string ply, labels;
    void add_to(CLI::App& command) {
        command.add_option("--ply", ply, "write the mesh in the colours of its annotations (PLY or another format with colours)");
        command.add_option("--labels-out", labels, "write one label a face: the id of the smallest region on it, -1 for none");
    }
    void check() const {
        if (!ply.empty()) check_mesh_extension(ply);
    }
    void write(const Session& session, const Mesh& mesh, const AnnotationSet& set, const Provenance& provenance) const {
        if (!ply.empty()) {
            WriteOptions options;
            options.comment = provenance.to_line();
            for (const auto& note : write_mesh(ply, mesh, colour_by_annotation(mesh, set), options))
                session.note("note: " + note);
        }
        if (!labels.empty()) write_labels(labels, labels_of(mesh, set));
    }
};

struct Apply {
    std::string mesh_file, source, output;
    std::string names, edit;
    bool mesh_labels = false;
    Outputs outputs;
    WordChecks words;

    int run(const Session& session) {
        if (mesh_labels != output.empty())
            fail_usage(mesh_labels ? "annotation apply --from-ply-labels takes a mesh and an output"
                                   : "annotation apply takes a mesh, a recipe or label file, and an output");
        if (mesh_labels) std::swap(source, output);
        outputs.check();
        if (!edit.empty() && (mesh_labels || !is_json(source)))
            fail_usage("--edit goes with a recipe", "give a recipe whose steps edit the annotations");
        check_outputs(given({mesh_file, source, names, edit, words.vocabulary}), given({output, outputs.ply, outputs.labels}));
        Provenance provenance{"annotation apply", {}, {}};
        for (const Path& file : given({mesh_file, source, names, edit})) provenance.add_input(file);
        if (is_json(source))
            for (const Path& file :
                 in_file(source, [&] { return files_named_by(read_json(source), Path(source).parent_path()); }))
                provenance.add_input(file);
        if (mesh_labels) provenance.options.emplace_back("from-ply-labels", "true");
        words.read(provenance);
        const MeshFile file = read_mesh(mesh_file);
        for (const auto& note : file.notes) session.note("note: " + note);
        const AnnotationSet set = make(file);
        words.require(set, source.empty() ? mesh_file : source);
        write_annotations(output, set, file.mesh, mesh_file, provenance);
        outputs.write(session, file.mesh, set, provenance);
        print_set(session, provenance, file.mesh, set);
        return done;
    }

private:
    AnnotationSet make(const MeshFile& file) const {
        std::vector<std::int32_t> labels = file.extras.face_labels;
        if (labels.empty() && !file.extras.vertex_labels.empty())
            labels = face_labels_from_vertices(file.mesh, file.extras.vertex_labels);
        if (!source.empty() && is_json(source)) {
            RecipeStart start{labels, {}, Path(source).parent_path()};
            if (!edit.empty()) start.annotations = read_annotations(edit, file.mesh);
            return follow_recipe(read_json(source), file.mesh, std::move(start), source);
        }
        if (!source.empty()) labels = read_labels(source, file.mesh.number_of_faces(), file.triangle_polygon);
        if (labels.empty())
            fail_input(mesh_file, "has no labels",
                       "give a PLY file with a face or vertex property \"label\", a label file or a recipe");
        return regions_from_labels(file.mesh, labels,
                                   names.empty() ? std::map<std::int32_t, std::string>() : read_label_names(names));
    }
};

struct Examined {
    std::string mesh, annotations;
    ReadAnnotationsOptions options;
    WordChecks words;

    int list(const Session& session) const {
        const Provenance provenance = inputs("annotation list");
        const MeshFile file = read_mesh(mesh);
        print_set(session, provenance, file.mesh, read_annotations(annotations, file.mesh, options));
        return done;
    }

    int check(const Session& session) {
        Provenance provenance = inputs("annotation check");
        words.read(provenance);
        const MeshFile file = read_mesh(mesh);
        const Json document = read_json(annotations);
        std::vector<Finding> findings;
        std::optional<AnnotationSet> set;
        try {
            set = annotations_from_json(document, file.mesh, annotations, options);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input) throw;
            findings.push_back({true, "", error.problem() + (error.remedy().empty() ? "" : " (" + error.remedy() + ")")});
        }
        if (set) {
            for (const auto& note : set->notes) findings.push_back({false, "", note});
            const std::vector<Finding> found = examine(file.mesh, *set);
            findings.insert(findings.end(), found.begin(), found.end());
            words.look(file.mesh, *set, findings);
        }
        return report_findings(session, provenance, findings);
    }

private:
    [[nodiscard]] Provenance inputs(const std::string& command) const {
        Provenance provenance{command, list_options(options), {}};
        provenance.add_input(mesh);
        provenance.add_input(annotations);
        return provenance;
    }
};

struct Remap {
    std::string before, annotations, after, output, vertex_map, face_map;
    ReadAnnotationsOptions options;
    Outputs outputs;

    int run(const Session& session) const {
        outputs.check();
        check_outputs(given({before, annotations, after, vertex_map, face_map}), given({output, outputs.ply, outputs.labels}));
        Provenance provenance{"annotation remap", list_options(options), {}};
        for (const Path& file : given({before, annotations, after, vertex_map, face_map})) provenance.add_input(file);
        const MeshFile target = read_mesh(after);
        if (!is_json(annotations)) return run_labels(session, target.mesh);
        if (vertex_map.empty()) fail_usage("annotations follow a vertex map", "add --vertex-map FILE");
        const MeshFile source = read_mesh(before);
        const AnnotationSet set = read_annotations(annotations, source.mesh, options);
        const auto vertices =
            read_index_map(vertex_map, "vertex", source.mesh.number_of_vertices(), target.mesh.number_of_vertices());
        const auto faces = face_map.empty()
                               ? std::vector<Index>()
                               : read_index_map(face_map, "face", source.mesh.number_of_faces(), target.mesh.number_of_faces());
        AnnotationSet moved = remap_annotations(source.mesh, set, target.mesh, vertices, faces);
        for (const auto& note : refresh_measures(target.mesh, moved).notes) moved.notes.push_back(note);
        write_annotations(output, moved, target.mesh, after, provenance);
        outputs.write(session, target.mesh, moved, provenance);
        print_set(session, provenance, target.mesh, moved);
        return done;
    }

private:
    /// The old mesh may be broken here: labels ask for the count of its faces only.
    int run_labels(const Session& session, const Mesh& target) const {
        if (face_map.empty()) fail_usage("labels follow a face map", "add --face-map FILE");
        if (!outputs.ply.empty() || !outputs.labels.empty())
            fail_usage("--ply and --labels-out go with annotations", "apply the new labels with 'annotation apply'");
        const TriangulatedSoup source = triangulate(read_polygons(before));
        const auto labels = read_labels(annotations, source.soup.triangles.size(), source.triangle_polygon);
        const auto faces = read_index_map(face_map, "face", source.soup.triangles.size(), target.number_of_faces());
        write_labels(output, remap_labels(labels, faces, target.number_of_faces()));
        session.note(std::to_string(target.number_of_faces()) + " labels written");
        return done;
    }
};

}  // namespace

void add_annotation(CLI::App& annotation, Session& session) {
    const auto apply = std::make_shared<Apply>();
    CLI::App* command = session.add(annotation, "apply", "annotate a mesh by a recipe or from labels",
                                    [&session, apply] { return apply->run(session); });
    command->add_option("mesh", apply->mesh_file, "mesh file")->required();
    command
        ->add_option("recipe", apply->source,
                     "recipe (.recipe.json) or label file (one integer a face); with --from-ply-labels the output")
        ->required();
    command->add_option("output", apply->output, "annotations to write (.ant.json)");
    command->add_flag("--from-ply-labels", apply->mesh_labels,
                      "take the labels of the mesh file itself instead of a recipe or label file");
    command->add_option("--names", apply->names, "JSON file with names of the labels");
    command->add_option("--edit", apply->edit, "annotations that the recipe's steps edit and add to");
    apply->words.add_to(*command, false);
    apply->outputs.add_to(*command);

    const auto examined = std::make_shared<Examined>();
    for (const bool check : {false, true}) {
        command = check ? session.add(annotation, "check", "look for defects in annotations; exit code 3 if there are",
                                      [&session, examined] { return examined->check(session); })
                        : session.add(annotation, "list", "what is annotated",
                                      [&session, examined] { return examined->list(session); });
        command->add_option("mesh", examined->mesh, "mesh file")->required();
        command->add_option("annotations", examined->annotations, "its annotations (.ant.json)")->required();
        add_flags(command, examined->options);
        if (check) examined->words.add_to(*command, true);
    }

    const auto remap = std::make_shared<Remap>();
    command = session.add(annotation, "remap", "carry annotations or labels along the maps of 'mesh repair'",
                          [&session, remap] { return remap->run(session); });
    command->add_option("before", remap->before, "mesh before the change")->required();
    command->add_option("annotations", remap->annotations, "its annotations (.ant.json) or label file")->required();
    command->add_option("after", remap->after, "mesh after the change")->required();
    command->add_option("output", remap->output, "annotations or labels to write")->required();
    command->add_option("--vertex-map", remap->vertex_map, "map of the vertices (JSON)");
    command->add_option("--face-map", remap->face_map, "map of the faces (JSON); without it faces follow their corners");
    add_flags(command, remap->options);
    remap->outputs.add_to(*command);
}

}  // namespace ostraka::app

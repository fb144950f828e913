// annotation apply
#include "operations/annotation/annotation_report.h"
#include "operations/annotation/document.h"
#include "operations/annotation/mesh_labels.h"
#include "operations/annotation/pictures.h"
#include "operations/operations.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/select/recipe.h"
#include "ostraka/vocabulary/vocabulary.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct AnnotationApply final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("recipe", Kind::recipe, recipe,
                "recipe (.recipe.json) or label file (one integer per face: text, or .npy with one per face or vertex)")
            .optional();
        p.output("output", Kind::annotations, output, "annotations to write (.ant.json)");
        p.order({"mesh", "recipe", "output"});
        p.order({"mesh", "output"});
        p.options("from-ply-labels", mesh_labels, "use the labels of the mesh file itself instead of a recipe or label file");
        p.options("from", source,
                  "source of the labels in the mesh file: label (the property of this name, or the only one whose name suggests "
                  "labels), "
                  "values:NAME (whole numbers of a property, such as a scalar field of CloudCompare), group or object (OBJ), "
                  "material, colour (of the faces, or else of the vertices)",
                  Words{label_sources(), "values:NAME", {}});
        p.input_option("names", Kind::text, names,
                       "JSON file with the names of the labels, such as {\"0\": \"seat\", \"1\": \"back\"}; other labels are "
                       "named 'part N'");
        p.input_option("edit", Kind::annotations, edited, "existing annotations, to which the steps of the recipe apply");
        p.input_option("vocabulary", Kind::vocabulary, vocabulary,
                       "vocabulary (.vocabulary.json, .ttl, .rdf) in which all tags and attributes must be defined");
        words.declare_options(p.options);
        pictures.declare(p);
        declare_annotations(p.report);
    }

    void check() const override {
        const bool own = mesh_labels || source.has_value();
        if (own == static_cast<bool>(recipe))
            fail_usage(own ? fmt::format("{} takes a mesh and an output", mesh_labels ? "--from-ply-labels" : "--from")
                           : "a mesh, a recipe or label file, and an output are needed",
                       own ? "leave out the recipe or label file" : "give them, or --from-ply-labels, or --from");
        if (mesh_labels && source && *source != "label")
            fail_usage("--from-ply-labels with --from " + *source, "give one of the two");
        if (edited && !is_document(recipe)) fail_usage("--edit needs a recipe", "give a recipe whose steps edit the annotations");
    }

    void run(Context& context, Report& report) override {
        const Vocabulary* allowed_words = vocabulary ? &vocabulary.load<Vocabulary>(read_vocabulary) : nullptr;
        const MeshFile& file = *mesh;
        const AnnotationSet set = is_document(recipe) ? follow(context, file) : from_labels(context, file);
        if (allowed_words != nullptr) require_vocabulary(set, *allowed_words, recipe ? recipe.file() : mesh.file(), words);
        output.write(set, file.mesh, mesh.file());
        pictures.write({file.mesh, set}, report);
        report_annotations(context, report, {file.mesh, set});
    }

    static std::vector<std::int32_t> labels_in(const MeshFile& file) {
        return file.extras.face_labels.empty() && !file.extras.vertex_labels.empty()
                   ? face_labels_from_vertices(file.mesh, file.extras.vertex_labels)
                   : file.extras.face_labels;
    }

    AnnotationSet follow(Context& context, const MeshFile& file) const {
        RecipeStart start{labels_in(file), {}, recipe.path().parent_path(), &file.extras};
        if (edited) start.annotations = edited.on(file.mesh);
        AnnotationSet set;
        context.record([&] { set = follow_recipe(recipe.load<Json>(read_json), file.mesh, std::move(start), recipe.file()); });
        return set;
    }

    AnnotationSet from_labels(Context& context, const MeshFile& file) const {
        MeshLabels labels;
        context.record([&] {
            labels = recipe ? labels_in_file(recipe.path(), file)
                            : labels_from(file, mesh.sources.front().object ? Path() : mesh.sources.front().file,
                                          source.value_or(""), mesh.file());
        });
        if (!labels.source.empty()) context.note("labels: " + labels.source);
        using Names = std::map<std::int32_t, std::string>;
        const Names own_names = names ? names.load<Names>(read_label_names) : Names();
        for (const auto& [label, name] : own_names) labels.names[label] = name;
        return regions_from_labels(file.mesh, labels.of_face, labels.names);
    }

    MeshInput mesh;
    FileInput recipe, names, vocabulary;
    AnnotationsInput edited;
    AnnotationsOutput output;
    AnnotationPictures pictures;
    CheckVocabularyOptions words;
    std::optional<std::string> source;
    bool mesh_labels = false;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_apply() { return make<AnnotationApply>(); }

}  // namespace ostraka

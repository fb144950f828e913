// annotation apply
#include "operations/annotation/annotation_report.h"
#include "operations/annotation/document.h"
#include "operations/annotation/pictures.h"
#include "operations/operations.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/select/recipe.h"
#include "ostraka/vocabulary/vocabulary.h"

namespace ostraka {

namespace {

struct AnnotationApply final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("recipe", Kind::recipe, recipe, "recipe (.recipe.json) or label file (one integer per face)").optional();
        p.output("output", Kind::annotations, output, "annotations to write (.ant.json)");
        p.order({"mesh", "recipe", "output"});
        p.order({"mesh", "output"});
        p.options("from-ply-labels", mesh_labels, "use the labels of the mesh file itself instead of a recipe or label file");
        p.input_option("names", Kind::text, names,
                       "JSON file with the names of the labels, such as {\"0\": \"seat\", \"1\": \"back\"}; other labels are "
                       "named 'part N'");
        p.input_option("edit", Kind::annotations, edited, "existing annotations, to which the steps of the recipe apply");
        p.input_option("vocabulary", Kind::vocabulary, vocabulary,
                       "vocabulary (.vocabulary.json, .ttl, .rdf) in which all tags and attributes must be defined");
        words.list_options(p.options);
        pictures.declare(p);
        declare_annotations(p.report);
    }

    void check() const override {
        if (mesh_labels == static_cast<bool>(recipe))
            fail_usage(mesh_labels ? "--from-ply-labels takes a mesh and an output"
                                   : "a mesh, a recipe or label file, and an output are needed",
                       mesh_labels ? "leave out the recipe or label file" : "give them, or --from-ply-labels");
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
        std::vector<std::int32_t> labels;
        if (recipe)
            context.record([&] { labels = read_labels(recipe.path(), file.mesh.number_of_faces(), file.polygon_of_triangle); });
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

}  // namespace

std::unique_ptr<Operation> make_annotation_apply() { return make<AnnotationApply>(); }

}  // namespace ostraka

// annotation remap
#include "operations/annotation/annotation_report.h"
#include "operations/annotation/document.h"
#include "operations/annotation/pictures.h"
#include "operations/operations.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/annotation/remap.h"
#include "ostraka/measure/measure.h"
#include "ostraka/transfer/project_curves.h"

namespace ostraka {

namespace {

struct AnnotationRemap final : Operation {
    void declare(Parameters& p) override {
        p.input("before", Kind::mesh, before, "mesh before the change");
        p.input("annotations", Kind::annotations, annotations,
                "annotations (.ant.json) or label file of the mesh before the change");
        p.input("after", Kind::mesh, after, "mesh after the change");
        p.output("output", Kind::annotations, output, "annotations or labels to write");
        p.input_option("vertex-map", Kind::index_map, vertex_map,
                       "index map (JSON): for each vertex before the change, its index afterwards");
        p.input_option("face-map", Kind::index_map, face_map,
                       "index map (JSON): for each face before the change, its index afterwards; without this map, faces are "
                       "mapped by their corners");
        reading.declare_options(p.options);
        pictures.declare(p);
        declare_annotations(p.report);
        p.report.values(integer("labels", "labels written"));
    }

    void check() const override {
        if (is_document(annotations)) {
            if (!vertex_map) fail_usage("annotations need a vertex map", "add --vertex-map FILE");
            return;
        }
        if (!face_map) fail_usage("labels need a face map", "add --face-map FILE");
        if (pictures.coloured || pictures.labels)
            fail_usage("--ply and --labels-out need annotations, not labels", "apply the new labels with 'annotation apply'");
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
        AnnotationSet remapped = remap_annotations({source, set}, target, vertices, faces);
        for (auto& note : project_free_annotations({source, set}, target, remapped)) remapped.notes.push_back(std::move(note));
        for (const auto& note : refresh_measures(target, remapped).notes) remapped.notes.push_back(note);
        write_annotations(output.path(), {target, remapped}, after.file(), context.provenance());
        pictures.write({target, remapped}, report);
        report_annotations(context, report, {target, remapped});
    }

    /// The old mesh may be defective: labels only need its number of faces.
    void carry_labels(Context& context, Report& report, const Mesh& target) const {
        const TriangulatedSoup source = triangulate(before.take_polygons());
        const std::size_t count = source.soup.triangles.size();
        std::vector<std::int32_t> labels;
        std::vector<Index> faces;
        context.record([&] {
            labels = read_labels(annotations.path(), count, source.polygon_of_triangle);
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

std::unique_ptr<Operation> make_annotation_remap() { return make<AnnotationRemap>(); }

}  // namespace ostraka

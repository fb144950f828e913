// annotation segment
#include "operations/operations.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/fields/thickness.h"
#include "ostraka/measure/examine.h"
#include "ostraka/select/scalars.h"

namespace ostraka {

namespace {

struct AnnotationSegment final : Operation {
    void declare(Parameters& p) override {
        p.input("mesh", Kind::mesh, mesh, "mesh file; the mesh must be closed");
        p.output("output", Kind::annotations, output, "annotations to write (.ant.json)");
        p.output_option("labels-out", Kind::labels, labels_out,
                        "label file to write: for each face, the number of its segment, one number per line");
        options.declare_options(p.options);
        thickness_options.declare_options(p.options);
        p.report.table("segments", integer("id", "id"), text("tag", "tag"), integer("faces", "faces"),
                       number("area", "area", "length^2"));
    }

    void run(Context&, Report& report) override {
        const Mesh& surface = mesh->mesh;
        std::vector<std::int32_t> labels;
        AnnotationSet set = in_file(mesh.file(), [&] {
            const std::vector<Index> segment_of_face = segment(surface, thickness(surface, thickness_options), options);
            labels.assign(segment_of_face.begin(), segment_of_face.end());
            std::map<std::int32_t, std::string> names;
            for (const std::int32_t label : labels) names.try_emplace(label, "segment " + std::to_string(label));
            return regions_from_labels(surface, labels, names);
        });
        for (const Annotation& annotation : set.annotations) {
            const AnnotationSummary summary = summarise(surface, annotation);
            report.row("segments")("id", annotation.id)("tag", annotation.tag)("faces", summary.elements)("area", summary.area);
        }
        if (labels_out) write_labels(labels_out.path(), labels);
        output.write(std::move(set), surface, mesh.file());
    }

    MeshInput mesh;
    AnnotationsOutput output;
    FileOutput labels_out{".seg"};
    SegmentOptions options;
    ThicknessOptions thickness_options;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_segment() { return make<AnnotationSegment>(); }

}  // namespace ostraka

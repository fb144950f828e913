// mesh break: a fragment with known pose and known position on the whole.
#include "operations/operations.h"

#include "ostraka/annotation/remap.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/io/carry_extras.h"
#include "ostraka/registration/pose_json.h"
#include "ostraka/synthetic/fragments.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

struct MeshBreak final : Operation {
    void declare(Parameters& p) override {
        p.input("input", Kind::mesh, input, "mesh file");
        p.output("output", Kind::mesh, output, "mesh file of the fragment to write");
        p.input_option("annotations", Kind::annotations, annotations, "annotations of the whole object (.ant.json)");
        p.output_option("annotations-out", Kind::annotations, annotations_out,
                        "annotations of the fragment to write (.ant.json)");
        p.output_option("pose-out", Kind::pose, pose_out,
                        "JSON file to write: 4 x 4 matrix that moves the fragment back to its position on the object");
        options.declare_options(p.options);
        p.options("at", at, "centre of the fragment: coordinates x,y,z, or the tag of an annotation").required();
        p.report.values(integer("vertices"), integer("faces"), any("pose"));
    }

    void check() const override {
        if (annotations_out && !annotations)
            fail_usage("--annotations-out is given without --annotations", "give the annotations of the whole object too");
    }

    void run(Context&, Report& report) override {
        const Mesh& surface = input->mesh;
        const AnnotationSet* set = annotations ? &annotations.on(surface) : nullptr;
        SyntheticFragment piece =
            in_file(input.file(), [&] { return generate_fragment(surface, centre(surface, set), options); });

        report("vertices", piece.vertices.size())("faces", piece.faces.size());
        JsonValue pose = pose_to_json(piece.pose, report.allocator());
        if (pose_out) pose_out.write(pose);
        report("pose", std::move(pose));
        report.line(fmt::format("{}: {} vertices, {} faces", output.file().empty() ? "fragment" : printable(output.file()),
                                piece.vertices.size(), piece.faces.size()));
        if (annotations_out) {
            AnnotationSet piece_annotations = annotations_of_piece({surface, *set}, piece.mesh, piece.vertices, piece.faces);
            piece_annotations.up.reset();
            annotations_out.write(std::move(piece_annotations), piece.mesh, output.file_name());
        }
        const std::vector<Index> piece_corners = corner_sources(piece.mesh, piece.vertices, piece.faces, surface);
        MeshExtras extras = carried(input->extras, {&piece.vertices, &piece.faces, &piece_corners});
        output.write(std::move(piece.mesh), std::move(extras));
    }

    [[nodiscard]] Point centre(const Mesh& mesh, const AnnotationSet* set) const {
        if (set != nullptr)
            for (const Annotation& annotation : set->annotations) {
                if (annotation.tag != at) continue;
                const auto vertices = touched_vertices(mesh, annotation);
                Eigen::Vector3d sum = Eigen::Vector3d::Zero();
                for (const Index v : vertices) sum += eigen(mesh.point(Vertex(v)));
                if (!vertices.empty()) return point_of(sum / static_cast<double>(vertices.size()));
            }
        std::vector<double> numbers;
        try {
            numbers = numbers_of<double>(at, "--at");
        } catch (const Error&) {
            numbers.clear();  // reported below, together with the alternatives
        }
        if (numbers.size() != 3)
            fail_usage(fmt::format("--at is '{}'{}", printable(at, 60), set != nullptr ? ", and no annotation has this tag" : ""),
                       set != nullptr ? "give the tag of an annotation, or three numbers like 0,0,10"
                                      : "give three numbers like 0,0,10, or --annotations that have this tag");
        if (set != nullptr && !annotations_out)
            fail_usage("--annotations are not used: --at names no annotation, and --annotations-out is missing",
                       "give --annotations-out, or leave out --annotations");
        for (const double x : numbers)
            if (!std::isfinite(x)) fail_usage("--at is not finite", "give a place on the object");
        return {numbers[0], numbers[1], numbers[2]};
    }

    MeshInput input;
    MeshOutput output;
    AnnotationsInput annotations;
    AnnotationsOutput annotations_out;
    JsonOutput pose_out;
    FragmentOptions options;
    std::string at;
};

}  // namespace

std::unique_ptr<Operation> make_mesh_break() { return make<MeshBreak>(); }

}  // namespace ostraka

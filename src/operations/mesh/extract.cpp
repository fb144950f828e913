// mesh extract: cuts annotated parts out of an object.
#include "operations/operations.h"

#include "ostraka/annotation/cut_extras.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/annotation/part.h"
#include "ostraka/io/carry_extras.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct MeshExtract final : AnnotatedMeshOperation {
    void declare(Parameters& p) override {
        declare_inputs(p);
        p.output("output", Kind::mesh, output, "mesh of the part to write");
        p.output_option("annotations-out", Kind::annotations, annotations_out, "annotations of the part to write (.ant.json)");
        vocabulary.declare(p, "used to match tags of annotations with --annotation and --without");
        p.options("annotation", names,
                  "id or tag of regions that form the part; a tag means all its regions; default: whole mesh")
            .words();
        p.options("without", without, "id or tag of regions that are removed from the part").words();
        p.options("closed", closed, "close the cuts by triangles, annotated with the tag 'cut'");
        p.options("labels", labels,
                  "label each face of the mesh file (PLY) with the id of the smallest region that contains the face");
        p.report.values(integer("vertices"), integer("faces"), number("area", "", "length^2"), integer("cuts"),
                        integer("closed"));
    }

    void check() const override {
        if (names.empty() && without.empty()) fail_usage("no part is named", "give --annotation, --without or both");
    }

    void run(Context&, Report& report) override {
        const TagMatcher words = vocabulary.words();
        std::vector<std::size_t> regions, left_out;
        const auto add_regions = [&](const std::string& name, std::vector<std::size_t>& target) {
            const auto matching = words.require(set(), name, annotations.file());
            // A tag may be shared by regions and points; points have no surface.
            for (const std::size_t i : matching)
                if (set().annotations[i].type == AnnotationType::region || matching.size() == 1) target.push_back(i);
            if (target.empty())
                fail_input(annotations.file(), fmt::format("no annotation '{}' is a region", printable(name, 60)),
                           "name a region");
        };
        for (const std::string& name : names) add_regions(name, regions);
        for (const std::string& name : without) add_regions(name, left_out);
        CutPart part = in_file(annotations.file(), [&] { return cut_out_part(object(), regions, left_out, closed); });
        const double area = surface_area(part.mesh);
        report.set_unit(part.annotations.unit);
        report("vertices", part.mesh.number_of_vertices())("faces", part.mesh.number_of_faces())("area", area)("cuts", part.cuts);
        if (closed) report("closed", part.closed);
        report.line(fmt::format("{}: {} vertices, {} faces, area {}; {}{}",
                                output.file().empty() ? "part" : printable(output.file()), part.mesh.number_of_vertices(),
                                part.mesh.number_of_faces(), number(area, 6), counted(part.cuts, "cut"),
                                closed ? fmt::format(", {} closed", part.closed) : ""));
        if (closed && part.closed < part.cuts)
            report.note(fmt::format(
                "{} cuts could not be closed by triangles between their vertices; try 'ostraka mesh repair --fill-holes'",
                part.cuts - part.closed));
        MeshExtras extras = extras_of(part);
        if (labels) extras.face_labels = face_labels(part).of_face;
        if (annotations_out) annotations_out.write(std::move(part.annotations), part.mesh, output.file_name());
        output.write(std::move(part.mesh), std::move(extras));
    }

    /// Carries the attributes of the whole to the part, interpolated where it was cut. Faces that close cuts have no label, no
    /// material and a neutral colour.
    [[nodiscard]] MeshExtras extras_of(const CutPart& part) const {
        const Mesh& whole = part.whole ? part.whole->mesh : mesh->mesh;
        const MeshExtras attributes = part.whole ? cut_extras(*part.whole, mesh->mesh, mesh->extras) : mesh->extras;
        const std::vector<Index> part_corners = corner_sources(part.mesh, part.vertices, part.faces, whole);
        MeshExtras extras = carried(attributes, {&part.vertices, &part.faces, &part_corners});
        for (std::size_t f = 0; f < part.faces.size(); ++f) {
            if (part.faces[f] != no_index) continue;
            if (!extras.face_labels.empty()) extras.face_labels[f] = no_label;
            if (!extras.face_colours.empty()) extras.face_colours[f] = Colour{190, 190, 190, 255};
        }
        return extras;
    }

    MeshOutput output;
    AnnotationsOutput annotations_out;
    VocabularyOption vocabulary;
    std::vector<std::string> names, without;
    bool closed = false, labels = false;
};

}  // namespace

std::unique_ptr<Operation> make_mesh_extract() { return make<MeshExtract>(); }

}  // namespace ostraka

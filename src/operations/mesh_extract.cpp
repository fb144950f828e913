// mesh extract: cuts annotated parts out of an object.
#include "operations.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/annotation/part.h"

#include <cmath>

namespace ostraka {

namespace {

struct MeshExtract final : AnnotatedMeshOperation {
    void describe(Parameters& p) override {
        describe_inputs(p);
        p.output("output", Kind::mesh, output, "mesh file of the part to write");
        p.output_option("annotations-out", Kind::annotations, annotations_out, "annotations of the part to write (.ant.json)");
        vocabulary.describe(p, "by which tags are compared with the names given");
        p.options("annotation", names, "regions to cut out, by id or tag (all of that tag); the whole mesh if left out").words();
        p.options("without", without, "regions to leave out, by id or tag").words();
        p.options("closed", closed, "close the cuts by triangles, annotated as 'cut'");
        p.options("labels", labels, "write the id of the smallest region of each face into the mesh (PLY)");
        p.report.values(integer("vertices"), integer("faces"), number("area"), integer("cuts"), integer("closed"));
    }

    void check() const override {
        if (names.empty() && without.empty()) fail_usage("no part is named", "give --annotation, --without or both");
    }

    void run(Context&, Report& report) override {
        const Mesh& whole = mesh->mesh;
        const TagWords words = vocabulary.words();
        std::vector<std::size_t> regions, left_out;
        const auto add = [&](const std::string& name, std::vector<std::size_t>& to) {
            const auto found = words.require(set(), name, annotations.file());
            // A tag may be shared by regions and points; points have no surface.
            for (const std::size_t i : found)
                if (set().annotations[i].type == AnnotationType::region || found.size() == 1) to.push_back(i);
            if (to.empty())
                fail_input(annotations.file(), "no annotation '" + printable(name, 60) + "' is a region", "name a region");
        };
        for (const std::string& name : names) add(name, regions);
        for (const std::string& name : without) add(name, left_out);
        CutPart part = in_file(annotations.file(), [&] { return cut_out_part(whole, set(), regions, left_out, closed); });
        const double area = surface_area(part.mesh);
        report.set_unit(part.annotations.unit);
        report("vertices", part.mesh.number_of_vertices())("faces", part.mesh.number_of_faces())("area", area)("cuts", part.cuts);
        if (closed) report("closed", part.closed);
        report.line((output.file().empty() ? "part" : printable(output.file())) + ": " +
                    std::to_string(part.mesh.number_of_vertices()) + " vertices, " + std::to_string(part.mesh.number_of_faces()) +
                    " faces, area " + number(area, 6) + "; " + counted(part.cuts, "cut") +
                    (closed ? ", " + std::to_string(part.closed) + " closed" : ""));
        if (closed && part.closed < part.cuts)
            report.note(std::to_string(part.cuts - part.closed) +
                        " cuts could not be closed by triangles between their vertices; 'ostraka mesh repair --fill-holes' may");
        MeshExtras extras = extras_of(part, report);
        if (labels) extras.face_labels = face_labels(part.mesh, part.annotations).of_face;
        if (annotations_out) annotations_out.write(std::move(part.annotations), part.mesh, output.file_name());
        output.write(std::move(part.mesh), std::move(extras));
    }

    /// Transfers colours and labels of the whole to the part. Vertex colours on the cuts are interpolated; faces that close
    /// cuts have no label and a neutral colour.
    [[nodiscard]] MeshExtras extras_of(const CutPart& part, Report& report) const {
        const MeshExtras& from = mesh->extras;
        MeshExtras extras;
        const auto of_whole = [&](Index face) {
            return face == no_index ? no_index : part.whole ? part.whole->face_origin[face] : face;
        };
        for (const Index face : part.faces) {
            const Index f = of_whole(face);
            if (!from.face_labels.empty()) extras.face_labels.push_back(f == no_index ? no_label : from.face_labels[f]);
            if (!from.face_colours.empty())
                extras.face_colours.push_back(f == no_index ? Colour{190, 190, 190, 255} : from.face_colours[f]);
        }
        if (!from.vertex_colours.empty()) {
            extras.vertex_colours.resize(part.vertices.size());
            for (std::size_t channel = 0; channel < 4; ++channel) {
                std::vector<double> values;
                for (const Colour& colour : from.vertex_colours) values.push_back(colour[channel]);
                if (part.whole) values = part.whole->vertex_values(mesh->mesh, values);
                for (std::size_t v = 0; v < part.vertices.size(); ++v)
                    extras.vertex_colours[v][channel] = static_cast<std::uint8_t>(std::lround(values[part.vertices[v]]));
            }
        }
        const auto take = [&](const auto& list, auto& to) {
            if (!list.empty() && !part.whole)
                for (const Index v : part.vertices) to.push_back(list[v]);
        };
        take(from.vertex_labels, extras.vertex_labels);
        take(from.vertex_texture, extras.vertex_texture);
        if (!from.corner_texture.empty() || (part.whole && !(from.vertex_labels.empty() && from.vertex_texture.empty())))
            report.note("texture coordinates and labels of vertices are not carried to the part");
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

// mesh make: synthetic objects with exactly known parts.
#include "operations/operations.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/synthetic/make_mesh.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct MeshMake final : Operation {
    void declare(Parameters& p) override {
        p.options("object", object_name, "name of the object to make (see --list)",
                  Words{synthetic_object_names(), {}, [](const std::string& name) { static_cast<void>(synthetic_object(name)); }})
            .positional();
        p.output("output", Kind::mesh, output, "mesh file to write; PLY keeps labels and colours of faces and vertices")
            .optional();
        p.output_option("labels", Kind::labels, labels, "text file to write: the label of each face, one per line");
        p.order({"object", "output"});
        p.options("list", list_objects, "list the objects with their parts and labels, and make no mesh").unrecorded();
        options.declare_options(p.options);

        p.report.values(text("object"), text("class"), text("unit"), integer("vertices"), integer("faces"), integer("genus"),
                        number("area", "", "length^2"), number("meanEdgeLength", "", "length"));
        p.report.table("parts", integer("label", "label"), text("name", "part"), integer("faces", "faces"), integer("vertices"),
                       number("area", "area", "length^2"), text_only("% of area", FieldType::number));
        p.report.table("objects", text("name"), text("class"), text("description"), text("unit"), integer("genus"),
                       integer("minimumVertices"), texts("parts"));
        p.report.text_table("", {"object", "genus", "min vertices", "label", "part"});
    }

    void check() const override {
        if (list_objects) return;
        if (object_name.empty()) fail_usage("no object is named", "name one of those that 'ostraka mesh make --list' shows");
        const SyntheticObject& object = synthetic_object(object_name);
        if (!output)
            fail_usage("no output file is named", fmt::format("write: ostraka mesh make {} {}.ply", object.name, object.name));
    }

    void run(Context&, Report& report) override {
        if (list_objects) {
            for (const std::string& name : object_name.empty() ? synthetic_object_names() : std::vector{object_name})
                show(report, synthetic_object(name));
            return;
        }
        const SyntheticObject& object = synthetic_object(object_name);
        const Stopwatch stopwatch;
        SyntheticMesh synthetic = make_mesh(object, options);
        report.run("seconds", stopwatch.seconds());
        report_result(report, object, synthetic);

        if (labels) write_labels(labels.path(), synthetic.face_labels);
        MeshExtras extras;
        const auto colour = [&](std::int32_t label) {
            const auto& [red, green, blue] = object.part_colours[static_cast<std::size_t>(label)];
            return Colour{red, green, blue, 255};
        };
        for (const auto label : synthetic.face_labels) extras.face_colours.push_back(colour(label));
        for (const auto label : synthetic.vertex_labels) extras.vertex_colours.push_back(colour(label));
        extras.face_labels = std::move(synthetic.face_labels);
        extras.vertex_labels = std::move(synthetic.vertex_labels);
        output.write(std::move(synthetic.mesh), std::move(extras));
    }

    static void show(Report& report, const SyntheticObject& object) {
        report.row("objects")("name", object.name)("class", object.object_class)("description", object.description)(
            "unit", object.unit)("genus", object.genus)("minimumVertices", object.minimum_vertices)("parts", object.parts);
        for (std::size_t part = 0; part < object.parts.size(); ++part) {
            Report::Row row = report.row("");
            row.shown("label", std::to_string(part)).shown("part", object.parts[part]);
            if (part == 0)
                row.shown("object", object.name)
                    .shown("genus", std::to_string(object.genus))
                    .shown("min vertices", std::to_string(object.minimum_vertices));
        }
    }

    static void report_result(Report& report, const SyntheticObject& object, const SyntheticMesh& synthetic) {
        struct Part {
            std::size_t faces = 0, vertices = 0;
            double area = 0;
        };
        std::vector<Part> parts(object.parts.size());
        for (const Face face : synthetic.mesh.faces()) {
            Part& part = parts[static_cast<std::size_t>(synthetic.face_labels[face.idx()])];
            ++part.faces;
            part.area += face_area(synthetic.mesh, face);
        }
        for (const auto label : synthetic.vertex_labels) ++parts[static_cast<std::size_t>(label)].vertices;
        double area = 0;
        for (const Part& part : parts) area += part.area;
        const double edge = mean_edge_length(synthetic.mesh);
        const std::size_t vertices = synthetic.mesh.number_of_vertices(), faces = synthetic.mesh.number_of_faces();
        report.set_unit(object.unit);
        report("object", object.name)("class", object.object_class)("unit", object.unit)("vertices", vertices)("faces", faces)(
            "genus", object.genus)("area", area)("meanEdgeLength", edge);
        report.line(fmt::format("{}: {} vertices, {} faces, genus {}, mean edge {} {}", object.object_class, vertices, faces,
                                object.genus, number(edge, 3), object.unit));
        for (std::size_t i = 0; i < parts.size(); ++i)
            report
                .row("parts")("label", i)("name", object.parts[i])("faces", parts[i].faces)("vertices", parts[i].vertices)(
                    "area", parts[i].area)
                .shown("% of area", number(100 * parts[i].area / area, 3));
    }

    std::string object_name;
    bool list_objects = false;
    MeshOutput output;
    FileOutput labels{".txt"};
    MakeOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_mesh_make() { return make<MeshMake>(); }

}  // namespace ostraka

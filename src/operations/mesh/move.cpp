// mesh move: translates, rotates, scales and mirrors an object, with all that belongs to it.
#include "operations/mesh/motion_steps.h"
#include "operations/operations.h"

#include "ostraka/coords/certificate.h"
#include "ostraka/core/angles.h"
#include "ostraka/io/moved.h"
#include "ostraka/measure/measure.h"
#include "ostraka/registration/pose_json.h"
#include "ostraka/semantic/moved_graph.h"
#include "ostraka/transfer/moved_annotations.h"

#include <fmt/core.h>

#include <cmath>

namespace ostraka {

namespace {

/// A mesh as triangles of any topology.
struct Triangles {
    TriangleSoup soup;
    MeshExtras extras;
};

struct MeshMove final : Operation {
    void declare(Parameters& p) override {
        p.input("input", Kind::mesh, input, "mesh to move, of any topology");
        p.output("output", Kind::mesh, output.with_ascii_option(), "moved mesh to write");
        p.output_option("transform", Kind::pose, transform,
                        "JSON file to write: the motion, with the rows of its 4 x 4 matrix; --matrix reads this file, and "
                        "--matrix with --inverse undoes the motion");
        steps.declare(p);
        p.input_option("annotations", Kind::annotations, annotations, "annotations of the mesh (.ant.json), moved with the mesh");
        p.output_option("annotations-out", Kind::annotations, annotations_out, "moved annotations to write (.ant.json)");
        p.input_option("graph", Kind::graph, graph, "relationships of the annotations (.graph.json), moved with the mesh");
        p.output_option("graph-out", Kind::graph, graph_out, "moved relationships to write (.graph.json)");
        p.input_option("cage", Kind::cage, cage, "cage of the mesh, moved with the mesh");
        p.output_option("cage-out", Kind::cage, cage_out, "moved cage to write");
        p.input_option("coordinates", Kind::coordinates, coordinates, "coordinates of the mesh in the cage (.npy)");
        p.output_option("coordinates-out", Kind::coordinates, coordinates_out,
                        "coordinates to write (.npy), bound to the moved mesh and cage");
        p.report.values(integer("vertices", "vertices"), integer("triangles", "triangles"), any("matrix"),
                        number("scale", "scale"), boolean("mirrored", "mirrored"), number("rotation", "rotation", "degrees"),
                        numbers("axis", "about"), numbers("translation", "translation"), text("unitBefore"),
                        text("unitAfter", "unit"));
    }

    void check() const override {
        steps.check();
        const auto pair = [](const Slot& source, const Slot& result) {
            if (static_cast<bool>(source) != static_cast<bool>(result))
                fail_usage(
                    fmt::format("--{} without --{}", source ? source.name : result.name, source ? result.name : source.name),
                    "give both, or neither");
        };
        pair(annotations, annotations_out);
        pair(graph, graph_out);
        pair(cage, cage_out);
        pair(coordinates, coordinates_out);
        if (graph && !annotations) fail_usage("--graph without --annotations", "give the annotations that the graph relates");
        if (coordinates && !cage) fail_usage("--coordinates without --cage", "give the cage as well");
    }

    void run(Context& context, Report& report) override {
        // Only annotations and coordinates need a manifold.
        const bool needs_mesh = annotations || coordinates;
        const AnnotationSet* set = annotations ? &annotations.on(input->mesh) : nullptr;
        Triangles triangles = needs_mesh ? Triangles{to_soup(input->mesh), input->extras} : triangles_of_file(context);
        const MeshMotion steps_motion = steps.motion(triangles.soup, input.file(), set);
        report.notes(steps_motion.notes);
        move(input.file(), triangles, steps_motion.motion);
        report_motion(steps_motion, triangles.soup, report);

        const Mesh moved = needs_mesh ? build_mesh(triangles.soup) : Mesh();
        if (set != nullptr) write_annotations(*set, moved, steps_motion, report);
        if (cage) write_cage(moved, steps_motion.motion);
        if (transform) transform.write(document_of_motion(steps_motion, report.allocator()));
        output.write(std::move(triangles.soup), std::move(triangles.extras));
    }

private:
    [[nodiscard]] Triangles triangles_of_file(Context& context) const {
        TriangulatedSoup triangulated = triangulate(input.take_polygons());
        context.notes("", triangulated.notes);
        return {std::move(triangulated.soup), std::move(triangulated.extras)};
    }

    static void move(const std::string& file, Triangles& triangles, const Motion& motion) {
        in_file(file, [&] { move_triangles(triangles.soup, triangles.extras, motion); });
    }

    void write_annotations(const AnnotationSet& set, const Mesh& moved, const MeshMotion& steps_motion, Report& report) const {
        AnnotationSet result = moved_annotations({input->mesh, set}, steps_motion.motion, steps_motion.unit_after);
        report.notes(refresh_measures(moved, result).notes);
        if (graph) graph_out.write(moved_graph(graph.on(set), steps_motion.motion, set.unit, steps_motion.unit_after), result);
        annotations_out.write(std::move(result), moved, output.file_name());
    }

    void write_cage(const Mesh& moved, const Motion& motion) const {
        Triangles triangles{to_soup(cage->mesh), cage->extras};
        move(cage.file(), triangles, motion);
        if (coordinates) {
            Coordinates result = coordinates.of(input->mesh, cage->mesh);
            result.normal *= motion.scale;  // weights of unit normals are lengths; weights of vertices have no unit
            const Mesh around = build_mesh(triangles.soup);
            const CoordinateCertificate certificate = certify(result, around, points_of(moved));
            coordinates_out.write(std::move(result), moved, around, certificate);
        }
        cage_out.write(std::move(triangles.soup), std::move(triangles.extras));
    }

    static JsonValue document_of_motion(const MeshMotion& steps_motion, JsonAllocator& allocator) {
        const Motion& motion = steps_motion.motion;
        JsonValue document = json_object(allocator, "format", "ostraka-motion", "version", 1, "matrix",
                                         pose_to_json(motion, allocator), "scale", motion.scale, "mirrored", motion.mirrors());
        add_nonempty_members(document, allocator, "unitBefore", steps_motion.unit_before, "unitAfter", steps_motion.unit_after);
        return document;
    }

    static void report_motion(const MeshMotion& steps_motion, const TriangleSoup& soup, Report& report) {
        const Motion& motion = steps_motion.motion;
        const auto coordinates_in = [](const Vector3d& v) { return std::vector<double>{v.x(), v.y(), v.z()}; };
        const auto shown = [](const Vector3d& v) {
            return fmt::format("{}, {}, {}", digits(v.x()), digits(v.y()), digits(v.z()));
        };
        report("vertices", soup.points.size())("triangles", soup.triangles.size())(
            "matrix", pose_to_json(motion, report.allocator()))("scale", motion.scale, digits(motion.scale))("mirrored",
                                                                                                             motion.mirrors());
        if (const Eigen::AngleAxisd rotation(motion.rotation); !motion.mirrors() && rotation.angle() > 0)
            report("rotation", rotation.angle() / degree)("axis", coordinates_in(rotation.axis()));
        report("translation", coordinates_in(motion.translation), shown(motion.translation));
        if (!steps_motion.unit_before.empty()) report("unitBefore", steps_motion.unit_before);
        if (!steps_motion.unit_after.empty()) report("unitAfter", steps_motion.unit_after);
    }

    MeshInput input, cage;
    MeshOutput output, cage_out;
    AnnotationsInput annotations;
    AnnotationsOutput annotations_out;
    GraphInput graph;
    GraphOutput graph_out;
    CoordinatesInput coordinates;
    CoordinatesOutput coordinates_out;
    JsonOutput transform;
    MotionSteps steps;
};

}  // namespace

std::unique_ptr<Operation> make_mesh_move() { return make<MeshMove>(); }

}  // namespace ostraka

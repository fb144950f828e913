// ostraka cage weights | influence
#include "annotation_names.h"
#include "command.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/coords/coordinate_file.h"
#include "ostraka/coords/influence.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/render/colour_scale.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <numeric>

namespace ostraka::app {

namespace {

Mesh read_cage(const Session& session, const std::string& file) {
    MeshFile cage = read_mesh(file);
    if (!cage.triangle_polygon.empty())
        session.note("note: the cage's polygons were cut into " + std::to_string(cage.mesh.number_of_faces()) + " triangles");
    for (const auto& note : cage.notes) session.note("note: " + note);
    return std::move(cage.mesh);
}

Mesh read_subject(const Session& session, const std::string& file) {
    MeshFile mesh = read_mesh(file);
    for (const auto& note : mesh.notes) session.note("note: " + note);
    return std::move(mesh.mesh);
}

struct Weights {
    std::string mesh, cage, output, kind = "mean-value";
    CoordinateOptions options;

    int run(const Session& session) const {
        check_options(options, "cage weights");
        const bool normals = coordinate_kind(kind).with_normals;
        if (extension(output) != ".npy") throw Error(ErrorKind::usage, output, "is no name for a NumPy array", "end it in .npy");
        std::vector<Path> outputs{output, coordinate_header_file(output)};
        if (normals) outputs.push_back(normal_weights_file(output));
        check_outputs({Path(mesh), Path(cage)}, outputs);
        Provenance provenance{"cage weights", list_options(options), {}};
        provenance.options.emplace_back("kind", kind);
        provenance.add_input(mesh);
        provenance.add_input(cage);
        const Mesh subject = read_subject(session, mesh), around = read_cage(session, cage);
        const Coordinates coordinates = in_file(cage, [&] { return compute_coordinates(kind, around, subject, options); });
        const CoordinateCertificate certificate =
            in_file(cage, [&] { return certify(coordinates, around, points_of(subject), options); });
        write_coordinates(output, coordinates, subject, around, certificate, provenance);
        if (normals)
            session.note("note: " + kind +
                         " coordinates serve deformation without constraints only: the constrained solve through the cage leaves "
                         "out their normal term");
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType);
        add_member(result, "kind", kind, allocator);
        add_member(result, "points", JsonValue(static_cast<std::uint64_t>(certificate.points)), allocator);
        add_member(result, "cageVertices", JsonValue(static_cast<std::uint64_t>(certificate.vertices)), allocator);
        add_member(result, "cageFaces", JsonValue(static_cast<std::uint64_t>(certificate.faces)), allocator);
        add_member(result, "certificate", to_json(certificate, allocator), allocator);
        add_member(result, "holds", JsonValue(certificate.holds()), allocator);
        if (session.json) session.print_report(provenance, document, result);
        else print(certificate);
        return certificate.holds() ? done : answer_is_no;
    }

private:
    static void print(const CoordinateCertificate& c) {
        const auto percent = [](double share) { return number(100 * share, 4) + " %"; };
        std::vector<std::vector<std::string>> rows{
            {"points x cage vertices", std::to_string(c.points) + " x " + std::to_string(c.vertices), ""},
            {"partition of unity", number(c.partition, 3), "largest |sum of a point's weights - 1|"},
            {"linear precision", number(c.linear, 3), "largest error of a point at rest, in diagonals of the cage"}};
        const auto on_cage = [&](const char* name, const std::optional<double>& value, const char* what) {
            rows.push_back({name, value ? number(*value, 3) : "-", value ? what : "not defined on the cage"});
        };
        on_cage("Lagrange property", c.lagrange, "largest deviation at the cage's vertices");
        on_cage("linear on edges", c.edges, "largest deviation at three points an edge");
        on_cage("linear on faces", c.on_faces, "largest deviation at three points a face");
        rows.push_back({"negative weights", percent(c.negative), "of all"});
        rows.push_back({"points with one", percent(c.negative_rows), "of all"});
        rows.push_back({"least, most", number(c.least) + ", " + number(c.most), "weight"});
        rows.push_back({"negative sum", number(c.negative_sum), "largest of a point"});
        rows.push_back({"locality", number(c.carriers_mean, 4) + " mean, " + std::to_string(c.carriers_most) + " most",
                        "weights that carry 95 % at a point"});
        std::cout << table({c.kind, "", ""}, rows) << "\nverdict       "
                  << (c.holds() ? "fit for deformation" : "not fit for deformation: partition or linear precision fails") << '\n';
    }
};

struct Influence {
    std::string mesh, cage, weights, output, annotations, annotation, by = "max";
    std::optional<Index> cage_vertex;
    std::optional<double> threshold;

    int run(const Session& session) const {
        check_mesh_extension(output);
        if (annotations.empty() != annotation.empty())
            fail_usage(annotations.empty() ? "--annotation without a file" : "--annotations without an annotation",
                       "give both --annotations FILE and --annotation ID");
        if (!annotation.empty() && cage_vertex)
            fail_usage("--cage-vertex with --annotation", "ask for the influence of the one or on the other");
        if (annotation.empty() && threshold) fail_usage("--threshold without --annotation", "it chooses cage vertices for one");
        if (threshold && !std::isfinite(*threshold)) fail_usage("--threshold is not finite", "give a number");
        std::vector<Path> inputs{mesh, cage, weights, coordinate_header_file(weights)};
        if (!annotations.empty()) inputs.emplace_back(annotations);
        check_outputs(inputs, {Path(output)});
        Provenance provenance{"cage influence", {}, {}};
        if (cage_vertex) provenance.options.emplace_back("cage-vertex", std::to_string(*cage_vertex));
        if (!annotation.empty()) {
            provenance.options.emplace_back("annotation", annotation);
            provenance.options.emplace_back("by", by);
        }
        for (const Path& file : inputs) provenance.add_input(file);
        const Mesh subject = read_subject(session, mesh), around = read_cage(session, cage);
        const Coordinates coordinates = read_coordinates(weights, subject, around);

        std::string what;
        std::vector<double> values;
        if (cage_vertex) {
            values = influence_of(coordinates, *cage_vertex);
            what = "weight of cage vertex " + std::to_string(*cage_vertex);
        } else if (!annotation.empty()) {
            const AnnotationSet set = read_annotations(annotations, subject);
            const Annotation& chosen = find_annotation(set, annotation, annotations);
            values = influence_on(coordinates, touched_vertices(subject, chosen), by);
            what = (by == "max" ? "largest weight on '" : "sum of the weights on '") + chosen.tag + "'";
        } else {
            for (const Index count : carriers(coordinates.vertex)) values.push_back(count);
            what = "cage vertices that carry 95 %";
        }
        const bool on_cage = !annotation.empty();
        write(session, on_cage ? around : subject, values, provenance);
        report(session, provenance, values, what, on_cage);
        return done;
    }

private:
    void write(const Session& session, const Mesh& coloured, const std::vector<double>& values,
               const Provenance& provenance) const {
        const ColourScale scale = scale_of({&values}, "the weights");
        MeshExtras extras;
        for (const double value : values) {
            const Rgb c = colour_of(scale, value);
            extras.vertex_colours.push_back({c.red, c.green, c.blue, 255});
        }
        WriteOptions options;
        options.comment = provenance.to_line();
        options.vertex_quality = values;
        for (const auto& note : write_mesh(output, coloured, extras, options)) session.note("note: " + note);
    }

    void report(const Session& session, const Provenance& provenance, const std::vector<double>& values, const std::string& what,
                bool on_cage) const {
        std::vector<Index> order(values.size());
        std::iota(order.begin(), order.end(), Index{0});
        std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return values[a] > values[b]; });
        const auto [low, high] = std::minmax_element(values.begin(), values.end());
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType);
        add_member(result, "what", what, allocator);
        add_member(result, "on", on_cage ? "cage" : "mesh", allocator);
        add_member(result, "min", JsonValue(*low), allocator);
        add_member(result, "max", JsonValue(*high), allocator);
        std::vector<std::vector<std::string>> rows{{"min", number(*low)}, {"max", number(*high)}};
        if (on_cage) {
            JsonValue list(rapidjson::kArrayType);
            std::string text;
            std::size_t chosen = 0;
            for (const Index v : order) {
                if (threshold ? !(values[v] > *threshold) : chosen == 10) break;
                list.PushBack(v, allocator);
                text += (chosen++ == 0 ? "" : ", ") + std::to_string(v);
            }
            add_member(result, threshold ? "above" : "strongest", std::move(list), allocator);
            rows.push_back({threshold ? "cage vertices above" : "strongest cage vertices", text.empty() ? "none" : text});
        }
        if (session.json) session.print_report(provenance, document, result);
        else std::cout << table({what, on_cage ? "on the cage" : "on the mesh"}, rows);
    }
};

}  // namespace

void add_cage(CLI::App& cage, Session& session) {
    const auto weights = std::make_shared<Weights>();
    CLI::App* command = session.add(cage, "weights", "coordinates of a mesh in a cage, with a certificate",
                                    [&session, weights] { return weights->run(session); });
    command->add_option("mesh", weights->mesh, "mesh file")->required();
    command->add_option("cage", weights->cage, "closed mesh around it (polygons are cut into triangles)")->required();
    command->add_option("output", weights->output, "weights to write (.npy; a .coordinates.json goes beside it)")->required();
    command->add_option("--kind", weights->kind, "mean-value, or green (strictly inside; without constraints only)")
        ->check(CLI::IsMember(coordinate_kinds()))
        ->capture_default_str();
    add_flags(command, weights->options);

    const auto influence = std::make_shared<Influence>();
    command = session.add(cage, "influence", "colour a mesh, or its cage, by who moves what",
                          [&session, influence] { return influence->run(session); });
    command->add_option("mesh", influence->mesh, "mesh file")->required();
    command->add_option("cage", influence->cage, "its cage")->required();
    command->add_option("weights", influence->weights, "weights of 'cage weights' (.npy)")->required();
    command
        ->add_option(
            "output", influence->output,
            "coloured mesh to write (PLY, with the numbers as the property quality): the cage for --annotation, else the "
            "mesh; without a choice coloured by the number of cage vertices that carry 95 %")
        ->required();
    command->add_option("--cage-vertex", influence->cage_vertex, "the weights of this cage vertex on the mesh");
    command->add_option("--annotations", influence->annotations, "annotations of the mesh (.ant.json)");
    command->add_option("--annotation", influence->annotation, "id or tag: the influence of each cage vertex on its vertices");
    command->add_option("--by", influence->by, "influence on an annotation: largest weight on its vertices, or their sum")
        ->check(CLI::IsMember({"max", "sum"}))
        ->capture_default_str();
    command->add_option("--threshold", influence->threshold, "list the cage vertices with an influence above this");
}

}  // namespace ostraka::app

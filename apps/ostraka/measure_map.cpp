// ostraka measure map
#include "command.h"
#include "number_lists.h"

#include "ostraka/core/mesh.h"
#include "ostraka/geom/geodesic.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/measure/descriptors.h"
#include "ostraka/render/values.h"

#include <cmath>
#include <iostream>
#include <limits>
#include <memory>

namespace ostraka::app {

namespace {

struct Map {
    std::string mesh, output, of, on = "vertex", from;
    DescriptorOptions options;

    int run(const Session& session) {
        check_outputs({Path(mesh)}, {Path(output)});
        check_options(options, "measure map");
        if ((of == "geodesic") == from.empty())
            fail_usage(from.empty() ? "a geodesic map without --from" : "--from with a map of " + of,
                       "--from names the vertices that geodesic distances are measured from");
        if (on == "face" && of != "thickness") fail_usage("a map of " + of + " on faces", "faces have a thickness only");
        Provenance provenance{"measure map", list_options(options), {}};
        for (const auto& [key, value] : {std::pair{"of", of}, {"on", on}, {"from", from}})
            provenance.options.emplace_back(key, value);
        provenance.add_input(mesh);
        const MeshFile file = read_mesh(mesh);
        for (const auto& note : file.notes) session.note("note: " + note);
        DescriptorSearch search(file.mesh, options);
        std::vector<double> values;
        if (of == "mean-curvature") values = search.curvature().mean;
        else if (of == "gaussian-curvature") values = search.curvature().gaussian;
        else if (of == "thickness")
            values = on == "face" ? search.thickness() : vertices_from_faces(file.mesh, search.thickness());
        else {
            const auto sources = numbers_of<Index>(from, "--from");
            for (const Index source : sources)
                if (source >= file.mesh.number_of_vertices())
                    fail_usage("--from names vertex " + std::to_string(source) + ", but " + mesh + " has " +
                                   std::to_string(file.mesh.number_of_vertices()) + " vertices",
                               "was it picked on another mesh?");
            values = geodesic_distances(file.mesh, sources);
        }
        std::vector<double> finite;
        for (double& value : values) {
            if (std::isinf(value)) value = std::numeric_limits<double>::quiet_NaN();
            if (std::isfinite(value)) finite.push_back(value);
        }
        if (finite.empty()) fail_input(mesh, "has no " + of + " anywhere", "is it empty, or open on the side that rays run to?");
        write_values(output, values);
        const Statistics s = statistics(finite, std::vector<double>(finite.size(), 1), of);
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType);
        add_member(result, "values", JsonValue(static_cast<std::uint64_t>(values.size())), allocator);
        add_member(result, "without", JsonValue(static_cast<std::uint64_t>(values.size() - finite.size())), allocator);
        const std::vector<std::pair<const char*, double>> figures{
            {"min", s.min},   {"5 %", s.percentile_5},   {"median", s.median},
            {"mean", s.mean}, {"95 %", s.percentile_95}, {"max", s.max}};
        std::vector<std::vector<std::string>> rows;
        for (const auto& [name, value] : figures) {
            add_member(result, name, JsonValue(value), allocator);
            rows.push_back({name, number(value)});
        }
        if (session.json) session.print_report(provenance, document, result);
        else std::cout << table({of, std::to_string(finite.size()) + " of " + std::to_string(values.size()) + " values"}, rows);
        return done;
    }
};

}  // namespace

void add_measure_map(CLI::App& measure, Session& session) {
    const auto map = std::make_shared<Map>();
    CLI::App* command = session.add(measure, "map", "write a map of curvature, thickness or distance",
                                    [&session, map] { return map->run(session); });
    command->add_option("mesh", map->mesh, "mesh file")->required();
    command->add_option("output", map->output, "one value a vertex or face (.npy, or text)")->required();
    command->add_option("--of", map->of, "what")
        ->required()
        ->check(CLI::IsMember({"mean-curvature", "gaussian-curvature", "thickness", "geodesic"}));
    command->add_option("--on", map->on, "one value a vertex or a face")
        ->check(CLI::IsMember({"vertex", "face"}))
        ->capture_default_str();
    command->add_option("--from", map->from, "vertices that geodesic distances are measured from, like 12,88");
    add_flags(command, map->options.curvature_options);
    add_flags(command, map->options.thickness_options);
}

}  // namespace ostraka::app

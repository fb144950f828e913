// ostraka annotation facets: outer, inner and fracture surface of a fragment.
#include "command.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/fitting/fragment_file.h"
#include "ostraka/io/mesh_file.h"

#include <filesystem>
#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct FindFacets {
    std::string mesh, output, unit;
    FacetOptions options;
    ReadAnnotationsOptions reading;

    int run(const Session& session) const {
        check_outputs({mesh}, {output});
        Provenance provenance{"annotation facets", list_options(options), {}};
        for (auto& option : list_options(reading)) provenance.options.push_back(std::move(option));
        provenance.add_input(mesh);
        const MeshFile file = read_mesh(mesh);
        for (const auto& note : file.notes) session.note("note: " + note);
        AnnotationSet set;
        if (std::filesystem::is_regular_file(output)) {  // not /dev/null
            set = read_annotations(output, file.mesh, reading);
            provenance.add_input(output);
            for (const auto& note : set.notes) session.note("note: " + note);
        }
        if (!unit.empty() && !set.unit.empty() && unit != set.unit)
            fail_usage(
                "--unit is '" + printable(unit, 60) + "', but the unit of " + output + " is '" + printable(set.unit, 60) + "'",
                "leave --unit away");
        if (set.unit.empty()) set.unit = unit;
        const std::string in = printable(set.unit, 60);
        const Facets facets = in_file(mesh, [&] { return find_facets(file.mesh, options); });
        for (const auto& note : facets.notes) session.note("note: " + note);
        const bool broken = facets.area(Facet::fracture) > 0;
        if (broken) {
            update_facet_annotations(set, facets);
            write_annotations(output, set, file.mesh, mesh, provenance);
        }

        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType);
        std::vector<std::vector<std::string>> rows;
        for (const FacetSegment& segment : facets.segments) {
            JsonValue entry(rapidjson::kObjectType);
            add_member(entry, "facet", to_string(segment.facet), allocator);
            add_member(entry, "faces", JsonValue(static_cast<std::uint64_t>(segment.faces.size())), allocator);
            add_member(entry, "area", JsonValue(segment.area), allocator);
            add_member(entry, "confidence", JsonValue(segment.confidence), allocator);
            list.PushBack(entry, allocator);
            rows.push_back({to_string(segment.facet), std::to_string(segment.faces.size()), number(segment.area),
                            number(segment.confidence, 2)});
        }
        add_member(result, "shell", JsonValue(facets.shell), allocator);
        if (facets.shell) add_member(result, "thickness", JsonValue(facets.thickness), allocator);
        add_member(result, "confidence", JsonValue(facets.confidence), allocator);
        add_member(result, "segments", std::move(list), allocator);
        if (session.json) {
            session.print_report(provenance, document, result);
        } else {
            std::cout << table({"facet", "faces", in.empty() ? "area" : "area, " + in + "^2", "confidence"}, rows);
            if (facets.shell) std::cout << "a wall " << number(facets.thickness, 3) << (in.empty() ? "" : " " + in) << " thick\n";
            else std::cout << "a solid: no wall with two sides\n";
        }
        if (!broken) session.note("no fracture is found, so " + printable(output) + " is not written");
        return broken ? done : answer_is_no;
    }
};

}  // namespace

void add_annotation_facets(CLI::App& annotation, Session& session) {
    const auto work = std::make_shared<FindFacets>();
    CLI::App* command =
        session.add(annotation, "facets",
                    "tell the outer, inner and fracture surface of a fragment apart; exit code 3 if there is no fracture",
                    [&session, work] { return work->run(session); });
    command->add_option("mesh", work->mesh, "mesh file of the fragment")->required();
    command
        ->add_option("output", work->output,
                     "annotations (.ant.json), brought up to date or made: regions \"outer\", \"inner\" and \"fracture\"; called "
                     "NAME.ant.json beside NAME.ply they are what 'fit' and 'pair' go by")
        ->required();
    command->add_option("--unit", work->unit, "of a new file: unit of the mesh's coordinates, e.g. mm");
    add_flags(command, work->options);
    add_flags(command, work->reading);
}

}  // namespace ostraka::app

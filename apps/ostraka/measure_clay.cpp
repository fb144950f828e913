// ostraka measure clay: how much clay an object holds, with what is not seen of its inside.
#include "command.h"
#include "number_lists.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/measure/solid.h"
#include "ostraka/slicing/clay.h"

#include <cmath>
#include <iostream>
#include <memory>
#include <numeric>

namespace ostraka::app {

namespace {

struct Clay {
    std::string mesh, annotations, up, unit;
    ClayOptions options;
    ReadAnnotationsOptions reading;

    int run(const Session& session) {
        std::array<double, 3> direction{0, 0, 1};
        if (!up.empty()) direction = direction_of(up, "--up");
        Provenance provenance{"measure clay", list_options(options), {}};
        provenance.options.emplace_back("up", up);
        provenance.options.emplace_back("unit", unit);
        provenance.add_input(mesh);
        const MeshFile file = read_mesh(mesh);
        for (const auto& note : file.notes) session.note("note: " + note);
        if (!annotations.empty()) {
            provenance.add_input(annotations);
            const AnnotationSet set = read_annotations(annotations, file.mesh, reading);
            if (unit.empty()) unit = set.unit;
            if (up.empty() && set.up) direction = *set.up;
        }
        const SliceFrame frame = slice_frame(Point(0, 0, 0), Vector(direction[0], direction[1], direction[2]));
        const ClayVolume clay = in_file(mesh, [&] { return clay_volume(file.mesh, frame, options); });
        const std::string cubed = unit.empty() ? "" : unit + "^3";
        const std::vector<std::tuple<std::string, double, std::string>> figures{
            {"most clay", clay.most, cubed},
            {"least clay", clay.least, cubed},
            {"within the outer surface", clay.envelope, cubed},
            {"wall taken for least", clay.wall, unit},
            {"wall seen, mean", clay.wall_mean, unit},
            {"wall seen, least (5 % quantile)", clay.wall_least, unit},
            {"wall seen, most (95 % quantile)", clay.wall_most, unit},
            {"slices", clay.slices, ""},
            {"slices with a cavity seen", clay.with_cavity, ""},
            {"slices without an outline", clay.without_outline, ""},
            {"slices whose contours cross", clay.crossing, ""},
            {"slices read against their orientation", clay.reversed ? clay.slices : clay.turned, ""}};
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType);
        std::vector<std::vector<std::string>> rows;
        for (const auto& [name, value, its_unit] : figures) {
            add_member(result, name, std::isnan(value) ? JsonValue(rapidjson::kNullType) : JsonValue(value), allocator);
            rows.push_back({name, std::isnan(value) ? "unknown" : number(value) + (its_unit.empty() ? "" : " " + its_unit)});
        }
        add_member(result, "unit", unit, allocator);
        const double own = own_volume(file.mesh);
        if (std::isfinite(own)) add_member(result, "volume of the mesh", JsonValue(own), allocator);
        if (session.json) session.print_report(provenance, document, result);
        else std::cout << table({"clay", ""}, rows) << '\n' << sentence(clay, own) << '\n';
        if (std::isnan(clay.least) && !std::isnan(clay.most))
            session.note("no wall is seen, so there is no least: give one with --wall");
        if (clay.without_outline > 0)
            session.note(std::to_string(clay.without_outline) +
                         " slices have no closed outline: taken as between their neighbours");
        if (clay.crossing > 0)
            session.note(std::to_string(clay.crossing) +
                         " slices have contours that cross, since parts of the mesh pass through each other: the most is a bound "
                         "that may count "
                         "them twice, the least takes them as nothing (ostraka mesh repair --wrap makes one surface of them)");
        if (clay.turned > 0)
            session.note(
                std::to_string(clay.turned) +
                " slices have contours that ran against their nesting, as a cavity does that is oriented outwards: read by "
                "their nesting");
        if (clay.reversed) session.note("the mesh is inside out: read the other way round (ostraka mesh repair mends it)");
        if (clay.slices == 0) session.note("no slice meets the mesh: it has no height along this direction; give another --up");
        else if (std::isnan(clay.most))
            session.note(
                "no slice has a closed outline, so there is no volume: is the mesh open along its "
                "height, or inside out?");
        return std::isnan(clay.most) ? answer_is_no : done;
    }

private:
    /// Of a closed mesh, however it is oriented; else NaN.
    static double own_volume(const Mesh& mesh) {
        for (const Halfedge h : mesh.halfedges())
            if (mesh.is_border(h)) return std::numeric_limits<double>::quiet_NaN();
        std::vector<Index> faces(mesh.number_of_faces());
        std::iota(faces.begin(), faces.end(), Index{0});
        return std::abs(region_solid(mesh, faces).volume);
    }

    /// "12345 mm^3 (12.3 cm^3)": large ones in larger units beside.
    [[nodiscard]] std::string volume(double value) const {
        std::string text = number(value) + (unit.empty() ? "" : " " + unit + "^3");
        const double cubic_cm = unit == "mm" ? value / 1000 : unit == "cm" ? value : 0;
        if (cubic_cm >= 1000) text += " (" + number(cubic_cm / 1000, 3) + " litres)";
        else if (unit == "mm" && cubic_cm >= 1) text += " (" + number(cubic_cm, 3) + " cm^3)";
        return text;
    }

    [[nodiscard]] std::string sentence(const ClayVolume& clay, double own) const {
        std::string text = std::isnan(clay.most)    ? "the clay is not known"
                           : std::isnan(clay.least) ? "clay: at most " + volume(clay.most)
                                                    : "clay: between " + volume(clay.least) + " and " + volume(clay.most);
        if (std::isnan(own)) return text + "; the mesh is open, so that it has no volume of its own";
        return text + "; the mesh is closed, and its own volume is " + volume(own);
    }
};

}  // namespace

void add_measure_clay(CLI::App& measure, Session& session) {
    const auto work = std::make_shared<Clay>();
    CLI::App* command =
        session.add(measure, "clay", "volume of clay, between what it is if the unseen inside is solid and if it is hollow",
                    [&session, work] { return work->run(session); });
    command->add_option("mesh", work->mesh, "mesh file, closed or open")->required();
    command->add_option("annotations", work->annotations, "its annotations (.ant.json): unit and upward direction");
    command->add_option(
        "--up", work->up,
        "x, y, z, -x, -y, -z or three numbers: direction that slices lie across; else as the annotations say, else 0,0,1");
    command->add_option("--unit", work->unit, "unit of the mesh's coordinates, e.g. mm; else as the annotations say");
    add_flags(command, work->options);
    add_flags(command, work->reading);
}

}  // namespace ostraka::app

// ostraka annotation creases: ridges and hollows of the surface as candidates for joints.
#include "command.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/measure/descriptors.h"
#include "ostraka/select/creases.h"

#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct Creases {
    std::string mesh, output, unit;
    bool regions = false;
    CreaseOptions options;

    int run(const Session& session) const {
        check_outputs({mesh}, {output});
        Provenance provenance{"annotation creases", list_options(options), {}};
        provenance.options.emplace_back("regions", regions ? "true" : "false");
        provenance.add_input(mesh);
        const MeshFile file = read_mesh(mesh);
        for (const auto& note : file.notes) session.note("note: " + note);
        const std::vector<Crease> creases = in_file(mesh, [&] { return find_creases(file.mesh, options); });
        AnnotationSet set;
        set.unit = unit;
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType);
        std::vector<std::vector<std::string>> rows;
        std::array<int, 2> count{};
        for (const Crease& crease : creases) {
            Annotation annotation = annotate(crease, ++count.at(crease.ridge ? 0 : 1), set);
            JsonValue entry(rapidjson::kObjectType);
            add_member(entry, "id", JsonValue(annotation.id), allocator);
            add_member(entry, "tag", annotation.tag, allocator);
            add_member(entry, "closed", JsonValue(crease.closed), allocator);
            for (const auto& [name, value] : figures(crease)) add_member(entry, name, JsonValue(value), allocator);
            list.PushBack(entry, allocator);
            rows.push_back({std::to_string(annotation.id), annotation.tag, crease.closed ? "yes" : "no", number(crease.length),
                            number(crease.width), number(crease.mean_curvature), number(crease.strength, 3)});
            set.annotations.push_back(std::move(annotation));
        }
        if (!creases.empty()) write_annotations(output, set, file.mesh, mesh, provenance);
        add_member(result, "creases", std::move(list), allocator);
        if (session.json) session.print_report(provenance, document, result);
        else {
            const auto in = [&](const std::string& name, const std::string& measure) {
                return unit.empty() ? name : name + ", " + measure;
            };
            std::cout << table(
                {"id", "tag", "closed", in("length", unit), in("width", unit), in("mean curvature", "1/" + unit), "strength"},
                rows);
            if (!rows.empty())
                std::cout
                    << "strength: mean response along the line, in robust deviations of the response over the surface (--weak "
                    << number(options.weak) << ", --strong " << number(options.strong) << ")\n";
        }
        if (creases.empty())
            session.note("nothing stands out at this scale, so " + printable(output) +
                         " is not written: try another --scale, or a lower --weak and --strong");
        return creases.empty() ? answer_is_no : done;
    }

private:
    /// Ridges are warm and hollows cold; those next in number are told apart by tone, six of each.
    static std::array<int, 3> shade(bool ridge, int number) {
        static constexpr std::array<std::array<int, 3>, 6> warm{
            {{213, 94, 0}, {230, 159, 0}, {153, 27, 30}, {240, 120, 110}, {120, 70, 20}, {250, 200, 90}}};
        static constexpr std::array<std::array<int, 3>, 6> cold{
            {{0, 114, 178}, {86, 180, 233}, {0, 140, 110}, {60, 50, 150}, {120, 200, 170}, {150, 130, 220}}};
        return (ridge ? warm : cold).at(static_cast<std::size_t>(number - 1) % 6);
    }

    static std::vector<std::pair<std::string, double>> figures(const Crease& crease) {
        return {{"length", crease.length},
                {"width", crease.width},
                {"mean curvature", crease.mean_curvature},
                {"strength", crease.strength}};
    }

    [[nodiscard]] Annotation annotate(const Crease& crease, int number, const AnnotationSet& set) const {
        Annotation annotation;
        annotation.id = free_id(set);
        annotation.tag = (crease.ridge ? "ridge " : "hollow ") + std::to_string(number);
        annotation.colour = shade(crease.ridge, number);
        annotation.type = regions ? AnnotationType::region : AnnotationType::line;
        if (regions) annotation.faces = crease.faces;
        else annotation.polylines = {crease.line};
        std::vector<Quantity> quantities;
        for (const auto& [name, value] : figures(crease)) {
            if (name == "length" && regions) continue;
            Quantity quantity;
            quantity.name = name;
            quantity.values = {value};
            quantity.power = name == "mean curvature" ? -1 : name == "strength" ? 0 : 1;
            quantities.push_back(quantity);
        }
        store(annotation, quantities, unit);
        return annotation;
    }
};

}  // namespace

void add_annotation_creases(CLI::App& annotation, Session& session) {
    const auto work = std::make_shared<Creases>();
    CLI::App* command =
        session.add(annotation, "creases",
                    "find ridges and hollows of the surface, such as clay leaves at joints; exit code 3 if there is none",
                    [&session, work] { return work->run(session); });
    command->add_option("mesh", work->mesh, "mesh file")->required();
    command->add_option("output", work->output, "annotations to write (.ant.json): lines along the crests")->required();
    command->add_flag("--regions", work->regions, "regions instead of lines");
    command->add_option("--unit", work->unit, "unit of the mesh's coordinates, e.g. mm");
    add_flags(command, work->options);
}

}  // namespace ostraka::app

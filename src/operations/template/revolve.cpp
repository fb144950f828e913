// template revolve: a vessel as a surface of revolution, from its sherds.
#include "operations/operations.h"

#include "ostraka/core/text.h"
#include "ostraka/reconstruction/fragment_file.h"
#include "ostraka/revolution/surface_of_revolution.h"
#include "ostraka/texture/bake.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct TemplateRevolve final : Operation {
    void declare(Parameters& p) override {
        p.input("sherds", Kind::mesh, files,
                "closed mesh of a sherd; all sherds must be in the poses that they had in the vessel")
            .many();
        p.output("output", Kind::folder, output, "folder to write: the template of the vessel").flag();
        p.options("unit", unit, "unit of the coordinates (any text, such as mm)");
        options.declare_options(p.options);
        reading.declare_options(p.options);
        p.report.schema = "vessel";
        p.report.table("sherds", text("name", "sherd"), text("use"), boolean("axis"),
                       number("lean", "tilt of its own axis, degrees"), number("aside", "aside"),
                       number("weight", "share of the axis %"), number("disagreement"), number("lowest", "from height"),
                       number("highest", "to"), number("residual", "off the template"), number("onTemplate", "on it %"),
                       text("reason", ""), text("remedy", ""));
        p.report.values(text("format"), integer("version"), numbers("through"), numbers("direction"), number("directionError"),
                        number("placeError", "", "length"), number("height", "", "length"),
                        number("largestDiameter", "", "length"), boolean("base"), boolean("rim"), integer("vertices"));
    }

    void run(Context& context, Report& report) override {
        std::vector<const Fragment*> sherds;
        std::vector<const std::vector<Colour>*> colours;
        std::vector<SherdOnProfile> unreadable;
        for (std::size_t k = 0; k < files.size(); ++k) try {
                const FragmentFile& file = files.load<FragmentFile>(
                    [&](const Path& path) { return read_fragment(path, reading); }, k, options_text(reading));
                context.notes(files.file(k), file.notes);
                sherds.push_back(&file.fragment);
                colours.push_back(&file.face_colours);
            } catch (const Error& error) {
                if (error.kind() != ErrorKind::input || files.size() == 1) throw;
                SherdOnProfile& sherd = unreadable.emplace_back();
                sherd.name = files.path(k).stem().string();
                sherd.use = SherdUse::left_out;
                sherd.reason = fmt::format("cannot be read: {}: {}", printable(files.file(k)), error.problem());
                sherd.remedy = error.remedy();
            }
        output.open();
        RevolutionTemplate vessel = template_of_revolution(sherds, options, unreadable);
        vessel.annotations.unit = unit;
        write(context, vessel, colours_of(vessel, sherds, colours, report));
        report_result(report, vessel);
    }

    /// Colours of the vessel's vertices from coloured sherds near them, grey elsewhere; empty if no sherd has colours.
    static std::vector<Colour> colours_of(const RevolutionTemplate& vessel, const std::vector<const Fragment*>& sherds,
                                          const std::vector<const std::vector<Colour>*>& colours, Report& report) {
        TriangleSoup soup;
        MeshFile coloured;
        for (std::size_t k = 0; k < sherds.size(); ++k) {
            if (colours[k]->empty()) continue;
            const TriangleSoup sherd = to_soup(sherds[k]->mesh);
            const auto offset = static_cast<Index>(soup.points.size());
            soup.points.insert(soup.points.end(), sherd.points.begin(), sherd.points.end());
            for (auto triangle : sherd.triangles) {
                for (Index& v : triangle) v += offset;
                soup.triangles.push_back(triangle);
            }
            coloured.extras.face_colours.insert(coloured.extras.face_colours.end(), colours[k]->begin(), colours[k]->end());
        }
        if (soup.triangles.empty()) return {};
        coloured.mesh = build_mesh(soup);
        BakedVertices baked = bake_vertices(vessel.mesh, coloured, BakeOptions(), "sherds");
        report.note("vessel.ply has the colours of the sherds where they lie near it, and grey elsewhere");
        return std::move(baked.colours);
    }

    void write(Context& context, const RevolutionTemplate& vessel, std::vector<Colour> colours) const {
        const Provenance provenance = context.provenance();
        TemplateFile file{vessel.annotations.object_class, unit, vessel.annotations.up, {}};
        const WriteOptions write_options{.comment = provenance.to_line()};
        // Written in memory first, because the template contains the checksums of its parts.
        const auto part = [&](const std::string& role, const std::string& name, const std::function<void(const Path&)>& writer) {
            const Path draft = context.memory(name);
            {
                OutputTransaction transaction;
                writer(draft);
                transaction.commit();
            }
            const std::string bytes = read_file(draft);
            const Path place = output.in(name);
            write_file(place, bytes);
            file.contents.push_back({role, name, place, sha256(bytes)});
        };
        part("mesh", "vessel.ply", [&](const Path& path) {
            MeshExtras extras;
            extras.vertex_colours = std::move(colours);
            write_mesh(path, vessel.mesh, extras, write_options);
        });
        part("annotations", "vessel.ant.json",
             [&](const Path& path) { write_annotations(path, vessel, "vessel.ply", provenance); });
        std::string csv = "radius,height\n";
        for (const auto& p : vessel.profile) csv += fmt::format("{},{}\n", digits(p.x(), 10), digits(p.y(), 10));
        write_file(output.in("profile.csv"), csv);
        write_json(output.in("vessel.template.json"), template_to_json(file, provenance));
    }

    static void report_result(Report& report, const RevolutionTemplate& vessel) {
        const auto triple = [](const auto& v) { return std::vector<double>{v.x(), v.y(), v.z()}; };
        double height = 0, max_radius = 0;
        for (const auto& p : vessel.profile) height = std::max(height, p.y()), max_radius = std::max(max_radius, p.x());
        report("format", "ostraka-vessel")("version", 1)("through", triple(vessel.axis.point))(
            "direction", triple(vessel.axis.direction))("directionError", vessel.direction_error)(
            "placeError", vessel.place_error)("height", height)("largestDiameter", 2 * max_radius)("base", vessel.base)(
            "rim", vessel.rim)("vertices", vessel.mesh.number_of_vertices());
        std::size_t used = 0;
        for (const SherdOnProfile& sherd : vessel.sherds) {
            const bool has_axis = sherd.axis.found, is_left_out = sherd.use == SherdUse::left_out;
            used += is_left_out ? 0 : 1;
            const auto shown = [&](double value, int places) { return is_left_out ? std::string("-") : number(value, places); };
            Report::Row row = report.row("sherds");
            row("name", sherd.name)("use", to_string(sherd.use))("axis", has_axis)(
                "lean", sherd.lean, has_axis ? number(sherd.lean, 3) : "-")("aside", sherd.aside,
                                                                            has_axis ? number(sherd.aside, 3) : "-")(
                "weight", sherd.weight, shown(100 * sherd.weight, 3))("disagreement", sherd.disagreement)(
                "lowest", sherd.lowest, shown(sherd.lowest, 4))("highest", sherd.highest, shown(sherd.highest, 4))(
                "residual", sherd.residual, shown(sherd.residual, 3))("onTemplate", sherd.on_template,
                                                                      shown(100 * sherd.on_template, 3));
            if (!sherd.reason.empty()) row("reason", sherd.reason);
            if (!sherd.remedy.empty()) row("remedy", sherd.remedy);
        }
        for (const SherdOnProfile& sherd : vessel.sherds)
            if (sherd.use != SherdUse::used)
                report.line(fmt::format("{}: {}{} {}{}", to_string(sherd.use), printable(sherd.name),
                                        sherd.use == SherdUse::left_out ? "" : ", which", sherd.reason,
                                        sherd.remedy.empty() ? "" : "; " + sherd.remedy));
        report.line(fmt::format(
            "{} of {} sherds determine the vessel; the direction of its axis is known to {} degrees, its position to {}", used,
            vessel.sherds.size(), number(vessel.direction_error, 2), number(vessel.place_error, 2)));
        report.line(fmt::format("height {}, largest diameter {}; {}, {}; {} vertices", number(height, 5),
                                number(2 * max_radius, 5), vessel.base ? "with a base" : "no base",
                                vessel.rim ? "with a rim" : "no rim", vessel.mesh.number_of_vertices()));
        report.notes(vessel.notes);
    }

    FileInput files;
    FolderOutput output;
    std::string unit;
    RevolutionOptions options;
    FragmentFileOptions reading;
};

}  // namespace

std::unique_ptr<Operation> make_template_revolve() { return make<TemplateRevolve>(); }

}  // namespace ostraka

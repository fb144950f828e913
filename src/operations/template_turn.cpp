// template turn: a vessel as a surface of revolution, from its sherds.
#include "operations.h"

#include "ostraka/core/text.h"
#include "ostraka/reconstruction/fragment_file.h"
#include "ostraka/revolution/surface_of_revolution.h"

namespace ostraka {

namespace {

struct TemplateTurn final : Operation {
    void describe(Parameters& p) override {
        p.input("sherds", Kind::mesh, files, "closed meshes of sherds, all in the pose that they had in the vessel").many();
        p.output("output", Kind::folder, output, "folder to write the template to").flag();
        p.options("unit", unit, "unit of the coordinates, any text such as mm");
        options.describe(p.options);
        reading.describe(p.options);
        p.report.schema = "turned";
        p.report.table("sherds", text("name", "sherd"), text("use"), boolean("axis"), number("lean", "own axis leans, degrees"),
                       number("aside", "aside"), number("weight", "share of the axis %"), number("disagreement"),
                       number("lowest", "from height"), number("highest", "to"), number("residual", "off the template"),
                       number("onTemplate", "on it %"), text("reason", ""), text("remedy", ""));
        p.report.values(text("format"), integer("version"), numbers("through"), numbers("direction"), number("directionError"),
                        number("placeError", "", "length"), number("height", "", "length"),
                        number("largestDiameter", "", "length"), boolean("base"), boolean("rim"), integer("vertices"));
    }

    void run(Context& context, Report& report) override {
        std::vector<const Fragment*> sherds;
        std::vector<SherdOnProfile> unreadable;
        for (std::size_t k = 0; k < files.size(); ++k) try {
                const FragmentFile& file = files.load<FragmentFile>(
                    [&](const Path& path) { return read_fragment(path, reading); }, k, options_text(reading));
                context.notes(files.file(k), file.notes);
                sherds.push_back(&file.fragment);
            } catch (const Error& error) {
                if (error.kind() != ErrorKind::input || files.size() == 1) throw;
                SherdOnProfile& one = unreadable.emplace_back();
                one.name = files.path(k).stem().string();
                one.use = SherdUse::left_out;
                one.reason = "cannot be read: " + printable(files.file(k)) + ": " + error.problem();
                one.remedy = error.remedy();
            }
        output.open();
        RevolutionTemplate turned = template_of_revolution(sherds, options, unreadable);
        turned.annotations.unit = unit;
        write(context, turned);
        report_result(report, turned);
    }

    void write(Context& context, const RevolutionTemplate& turned) const {
        const Provenance provenance = context.provenance();
        TemplateFile file{turned.annotations.object_class, unit, turned.annotations.up, {}};
        const WriteOptions how{.comment = provenance.to_line()};
        // Written in memory first, because the template contains the checksums of its parts.
        const auto part = [&](const std::string& role, const std::string& name, const std::function<void(const Path&)>& writer) {
            const Path draft = context.memory(name);
            {
                OutputTransaction own;
                writer(draft);
                own.commit();
            }
            const std::string bytes = read_file(draft);
            const Path place = output.in(name);
            write_file(place, bytes);
            file.contents.push_back({role, name, place, sha256(bytes)});
        };
        part("mesh", "turned.ply", [&](const Path& path) { write_mesh(path, turned.mesh, {}, how); });
        part("annotations", "turned.ant.json",
             [&](const Path& path) { write_annotations(path, turned.annotations, turned.mesh, "turned.ply", provenance); });
        std::string csv = "radius,height\n";
        for (const auto& p : turned.profile) csv += digits(p.x(), 10) + "," + digits(p.y(), 10) + "\n";
        write_file(output.in("profile.csv"), csv);
        write_json(output.in("turned.template.json"), template_to_json(file, provenance));
    }

    static void report_result(Report& report, const RevolutionTemplate& turned) {
        const auto triple = [](const auto& v) { return std::vector<double>{v.x(), v.y(), v.z()}; };
        double height = 0, widest = 0;
        for (const auto& p : turned.profile) height = std::max(height, p.y()), widest = std::max(widest, p.x());
        report("format", "ostraka-turned")("version", 1)("through", triple(turned.axis.point))(
            "direction", triple(turned.axis.direction))("directionError", turned.direction_error)(
            "placeError", turned.place_error)("height", height)("largestDiameter", 2 * widest)("base", turned.base)(
            "rim", turned.rim)("vertices", turned.mesh.number_of_vertices());
        std::size_t used = 0;
        for (const SherdOnProfile& one : turned.sherds) {
            const bool found = one.axis.found, out = one.use == SherdUse::left_out;
            used += out ? 0 : 1;
            const auto shown = [&](double value, int places) { return out ? std::string("-") : number(value, places); };
            Report::Row row = report.row("sherds");
            row("name", one.name)("use", to_string(one.use))("axis", found)("lean", one.lean, found ? number(one.lean, 3) : "-")(
                "aside", one.aside, found ? number(one.aside, 3) : "-")("weight", one.weight, shown(100 * one.weight, 3))(
                "disagreement", one.disagreement)("lowest", one.lowest, shown(one.lowest, 4))(
                "highest", one.highest, shown(one.highest, 4))("residual", one.residual, shown(one.residual, 3))(
                "onTemplate", one.on_template, shown(100 * one.on_template, 3));
            if (!one.reason.empty()) row("reason", one.reason);
            if (!one.remedy.empty()) row("remedy", one.remedy);
        }
        for (const SherdOnProfile& one : turned.sherds)
            if (one.use != SherdUse::used)
                report.line(to_string(one.use) + ": " + printable(one.name) + (one.use == SherdUse::left_out ? " " : ", which ") +
                            one.reason + (one.remedy.empty() ? "" : "; " + one.remedy));
        report.line(std::to_string(used) + " of " + std::to_string(turned.sherds.size()) +
                    " sherds tell of the vessel; its axis is known to " + number(turned.direction_error, 2) + " degrees and " +
                    number(turned.place_error, 2) + " aside");
        report.line("height " + number(height, 5) + ", largest diameter " + number(2 * widest, 5) + "; " +
                    (turned.base ? "with a base" : "no base") + ", " + (turned.rim ? "with a rim" : "no rim") + "; " +
                    std::to_string(turned.mesh.number_of_vertices()) + " vertices");
        report.notes(turned.notes);
    }

    FileInput files;
    FolderOutput output;
    std::string unit;
    RevolutionOptions options;
    FragmentFileOptions reading;
};

}  // namespace

std::unique_ptr<Operation> make_template_turn() { return make<TemplateTurn>(); }

}  // namespace ostraka

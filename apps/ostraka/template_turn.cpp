// ostraka template turn: a whole vessel from its sherds.
#include "command.h"
#include "commands.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/bundle/template.h"
#include "ostraka/core/csv.h"
#include "ostraka/fitting/turned.h"
#include "ostraka/io/mesh_file.h"

#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>

namespace ostraka::app {

namespace {

namespace fs = std::filesystem;

struct Turn {
    std::vector<std::string> files;
    std::string output, unit;
    TurnOptions options;

    int run(const Session& session) const {
        check_options(options, "template turn");
        Provenance provenance{"template turn", list_options(options), {}};
        std::vector<Fragment> sherds(files.size());
        std::vector<const Fragment*> pointers;
        for (std::size_t k = 0; k < files.size(); ++k) {
            provenance.add_input(files[k]);
            sherds[k].name = Path(files[k]).stem().string();
            sherds[k].mesh = read_mesh(files[k]).mesh;
            const Path annotations = Path(files[k]).parent_path() / (sherds[k].name + ".ant.json");
            if (fs::exists(annotations)) {
                const AnnotationSet set = read_annotations(annotations, sherds[k].mesh);
                provenance.add_input(annotations);
                sherds[k].facets = in_file(annotations.string(), [&] { return facets_of(sherds[k].mesh, set); });
            }
            pointers.push_back(&sherds[k]);
        }
        TurnedTemplate turned = turn_template(pointers, options);
        turned.annotations.unit = unit;
        write(turned, provenance);
        print(session, provenance, turned);
        return done;
    }

private:
    void write(const TurnedTemplate& turned, const Provenance& provenance) const {
        const Path folder = output;
        std::error_code code;
        fs::create_directories(folder, code);
        if (code) throw Error(ErrorKind::failure, output, "the folder cannot be made: " + code.message(), "name another one");
        std::vector<Path> inputs(files.begin(), files.end());
        check_outputs(
            inputs, {folder / "turned.ply", folder / "turned.ant.json", folder / "turned.template.json", folder / "profile.csv"});
        auto transaction = std::make_unique<OutputTransaction>();
        WriteOptions how;
        how.comment = provenance.to_line();
        write_mesh(folder / "turned.ply", turned.mesh, {}, how);
        write_annotations(folder / "turned.ant.json", turned.annotations, turned.mesh, "turned.ply", provenance);
        std::ostringstream csv;
        csv.precision(10);
        csv << "radius,height\n";
        for (const auto& p : turned.profile) csv << p.x() << ',' << p.y() << '\n';
        write_file(folder / "profile.csv", csv.str());
        transaction->commit();
        transaction.reset();
        TemplateFile file;
        file.object_class = turned.annotations.object_class;
        file.unit = unit;
        file.up = turned.annotations.up;
        for (const auto& [role, name] : {std::pair("mesh", "turned.ply"), std::pair("annotations", "turned.ant.json")})
            file.parts.push_back({role, name, folder / name, sha256_of_file(folder / name)});
        write_json(folder / "turned.template.json", template_to_json(file, provenance));
    }

    static void print(const Session& session, const Provenance& provenance, const TurnedTemplate& turned) {
        double height = 0, widest = 0;
        for (const auto& p : turned.profile) height = std::max(height, p.y()), widest = std::max(widest, p.x());
        if (session.json) {
            Json document(rapidjson::kObjectType);
            auto& allocator = document.GetAllocator();
            JsonValue result(rapidjson::kObjectType), rows(rapidjson::kArrayType), notes(rapidjson::kArrayType);
            const auto triple = [&](double x, double y, double z) {
                JsonValue list(rapidjson::kArrayType);
                list.PushBack(x, allocator).PushBack(y, allocator).PushBack(z, allocator);
                return list;
            };
            add_member(result, "format", "ostraka-turned", allocator);
            add_member(result, "version", JsonValue(1), allocator);
            add_member(result, "through", triple(turned.axis.point.x(), turned.axis.point.y(), turned.axis.point.z()), allocator);
            add_member(result, "direction",
                       triple(turned.axis.direction.x(), turned.axis.direction.y(), turned.axis.direction.z()), allocator);
            add_member(result, "height", JsonValue(height), allocator);
            add_member(result, "largestDiameter", JsonValue(2 * widest), allocator);
            add_member(result, "base", JsonValue(turned.base), allocator);
            add_member(result, "rim", JsonValue(turned.rim), allocator);
            add_member(result, "vertices", JsonValue(static_cast<std::uint64_t>(turned.mesh.number_of_vertices())), allocator);
            for (const SherdOnProfile& one : turned.sherds) {
                JsonValue row(rapidjson::kObjectType);
                add_member(row, "name", one.name, allocator);
                add_member(row, "axis", JsonValue(one.axis.found), allocator);
                add_member(row, "lean", JsonValue(one.lean), allocator);
                add_member(row, "aside", JsonValue(one.aside), allocator);
                add_member(row, "lowest", JsonValue(one.lowest), allocator);
                add_member(row, "highest", JsonValue(one.highest), allocator);
                add_member(row, "residual", JsonValue(one.residual), allocator);
                rows.PushBack(row, allocator);
            }
            add_member(result, "sherds", std::move(rows), allocator);
            for (const std::string& note : turned.notes) notes.PushBack(JsonValue(note, allocator), allocator);
            add_member(result, "notes", std::move(notes), allocator);
            session.print_report(provenance, document, result);
            return;
        }
        std::vector<std::vector<std::string>> rows;
        for (const SherdOnProfile& one : turned.sherds)
            rows.push_back({printable(one.name), one.axis.found ? number(one.lean, 3) : one.axis.reason,
                            one.axis.found ? number(one.aside, 3) : "-", number(one.lowest, 4), number(one.highest, 4),
                            number(one.residual, 3)});
        std::cout << table({"sherd", "own axis leans, degrees", "aside", "from height", "to", "off the template"}, rows);
        std::cout << "height " << number(height, 5) << ", largest diameter " << number(2 * widest, 5) << "; "
                  << (turned.base ? "with a base" : "no base") << ", " << (turned.rim ? "with a rim" : "no rim") << "; "
                  << turned.mesh.number_of_vertices() << " vertices\n";
        for (const std::string& note : turned.notes) session.note("note: " + note);
    }
};

}  // namespace

void add_template_turn(CLI::App& bundle, Session& session) {
    const auto work = std::make_shared<Turn>();
    CLI::App* command = session.add(bundle, "turn", "a whole vessel from its sherds: turned about their axis, with its profile",
                                    [&session, work] { return work->run(session); });
    command->add_option("sherds", work->files, "closed meshes of sherds, all where they lay in the vessel")->required();
    command->add_option("--output", work->output, "folder to write the template to")->required();
    command->add_option("--unit", work->unit, "unit of the coordinates, any text such as mm");
    add_flags(command, work->options);
}

}  // namespace ostraka::app

// ostraka template pack | check | show
#include "command.h"
#include "number_lists.h"

#include "ostraka/bundle/template.h"

#include <iostream>
#include <map>
#include <memory>

namespace ostraka::app {

namespace {

/// What a template holds and what is wrong with it, as tables or a report.
int print(const Session& session, const Provenance& provenance, const Template& bundle, bool contents) {
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    JsonValue result(rapidjson::kObjectType), parts(rapidjson::kArrayType);
    std::vector<std::vector<std::string>> part_rows, rows;
    for (const TemplateEntry& entry : bundle.entries) {
        JsonValue object(rapidjson::kObjectType);
        add_member(object, "role", entry.role, allocator);
        add_member(object, "file", entry.name, allocator);
        add_member(object, "bytes", JsonValue(entry.bytes), allocator);
        add_member(object, "text", entry.text, allocator);
        parts.PushBack(object, allocator);
        part_rows.push_back({entry.role, entry.name, std::to_string(entry.bytes), entry.text});
    }
    add_member(result, "class", bundle.file.object_class, allocator);
    add_member(result, "unit", bundle.file.unit, allocator);
    add_member(result, "parts", std::move(parts), allocator);
    const std::size_t defects = add_findings(result, bundle.findings, "part", rows, allocator);
    if (session.json) {
        session.print_report(provenance, document, result);
    } else {
        if (contents) {
            if (!bundle.file.object_class.empty() || !bundle.file.unit.empty())
                std::cout << printable(bundle.file.object_class)
                          << (bundle.file.unit.empty() ? "" : ", in " + printable(bundle.file.unit)) << '\n';
            std::cout << table({"part", "file", "bytes", "what"}, part_rows) << '\n';
        }
        print_findings("part", rows, defects);
    }
    return defects == 0 ? done : answer_is_no;
}

struct Examine {
    std::string file;
    TemplateOptions options;

    int run(const Session& session, bool contents) const {
        Provenance provenance{contents ? "template show" : "template check", list_options(options), {}};
        provenance.add_input(file);
        return print(session, provenance, load_template(read_template(file, options), options), contents);
    }
};

struct Pack {
    std::string output, object_class, unit;
    std::string up;
    std::map<std::string, std::vector<std::string>> given;
    bool copy = false;
    TemplateOptions options;

    int run(const Session& session) {
        const Path folder = Path(output).has_parent_path() ? Path(output).parent_path() : Path(".");
        Provenance provenance{"template pack", {}, {}};
        TemplateFile file;
        file.object_class = object_class;
        file.unit = unit;
        if (!up.empty()) file.up = direction_of(up, "--up");
        std::vector<Path> inputs, outputs{output};
        for (const std::string& role : template_roles())
            for (const std::string& name : given[role]) {
                inputs.emplace_back(name);
                provenance.add_input(name);
                const Path place = copy ? folder / Path(name).filename() : Path(name);
                std::error_code code;
                const bool in_place = std::filesystem::equivalent(place, name, code);
                if (copy && !in_place) outputs.push_back(place);
                file.parts.push_back({role, name_in(folder, place), name, sha256_of_file(name)});
            }
        check_outputs(inputs, outputs);
        if (!object_class.empty()) provenance.options.emplace_back("class", object_class);
        if (!unit.empty()) provenance.options.emplace_back("unit", unit);
        // The file as it will be read: names that lead out of the folder are refused here.
        (void)template_from_json(template_to_json(file, provenance), folder, output, options);
        Template bundle = load_template(file, options);
        // What is not said of the object is as the annotations say.
        if (bundle.annotations) {
            if (file.object_class.empty()) file.object_class = bundle.annotations->object_class;
            if (file.unit.empty()) file.unit = bundle.annotations->unit;
            if (!file.up) file.up = bundle.annotations->up;
            bundle.file = file;
        }
        if (bundle.sound()) {
            const Json document = template_to_json(file, provenance);
            if (copy)
                for (const TemplatePart& part : file.parts) {
                    const Path place = folder / part.name;
                    std::error_code code;
                    if (!std::filesystem::equivalent(place, part.file, code)) write_file(place, read_file(part.file));
                }
            write_json(output, document);
        } else {
            session.note("nothing is written: mend the defects first");
        }
        return print(session, provenance, bundle, true);
    }

private:
    static std::string name_in(const Path& folder, const Path& place) {
        std::error_code code;
        const Path home = std::filesystem::weakly_canonical(std::filesystem::absolute(folder), code);
        const Path file = std::filesystem::weakly_canonical(std::filesystem::absolute(place), code);
        const Path relative = file.lexically_relative(home);
        return (relative.empty() ? file : relative).generic_string();
    }
};

}  // namespace

void add_template(CLI::App& bundle, Session& session) {
    const auto pack = std::make_shared<Pack>();
    CLI::App* command = session.add(
        bundle, "pack",
        "one file that names the parts of a template, checked as a whole; exit code 3, and nothing written, if they do not fit",
        [&session, pack] { return pack->run(session); });
    command->add_option("output", pack->output, "template to write (.template.json)")->required();
    const auto part = [&](const std::string& role, const std::string& help, bool many) {
        auto* option = command->add_option("--" + role, pack->given[role], help);
        if (many) option->expected(1, -1);
        else option->expected(1);
        return option;
    };
    part("mesh", "mesh", false)->required();
    part("annotations", "its annotations (.ant.json)", false);
    part("graph", "relationships among them (.graph.json)", false);
    part("cage", "closed meshes around it, coarse to fine", true);
    part("coordinates", "coordinates of the mesh in the cages (.npy)", true);
    part("vocabulary", "the words used (.vocabulary.json, .ttl, .rdf)", false);
    part("rules", "rules of the class (.rules.json)", false);
    part("ranges", "ranges of the class's measures (JSON)", false);
    part("landmarks", "landmarks (.ant.json)", false);
    command->add_option("--class", pack->object_class, "class of the object; else as the annotations say");
    command->add_option("--unit", pack->unit, "unit of the coordinates, any text such as mm; else as the annotations say");
    command->add_option("--up", pack->up, "x, y, z, -x, -y, -z or three numbers: upward direction; else as the annotations say");
    command->add_flag("--copy", pack->copy, "copy the parts into the template's folder");
    add_flags(command, pack->options);

    const auto examine = std::make_shared<Examine>();
    for (const bool contents : {false, true}) {
        command = session.add(bundle, contents ? "show" : "check",
                              contents ? "what a template holds, and what is wrong with it"
                                       : "look at a template as a whole; exit code 3 if something is wrong",
                              [&session, examine, contents] { return examine->run(session, contents); });
        command->add_option("template", examine->file, "template (.template.json)")->required();
        add_flags(command, examine->options);
    }
}

}  // namespace ostraka::app

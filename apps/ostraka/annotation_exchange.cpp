// ostraka annotation export | import
#include "command.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/exchange/exchange.h"
#include "ostraka/io/mesh_file.h"

#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

std::vector<Path> given(std::initializer_list<std::string> files) {
    std::vector<Path> list;
    for (const auto& file : files)
        if (!file.empty()) list.emplace_back(file);
    return list;
}

JsonValue text_list(const std::vector<std::string>& texts, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (const auto& text : texts) list.PushBack(json_string(text, allocator), allocator);
    return list;
}

struct Export {
    std::string mesh, annotations, output, format;
    ReadAnnotationsOptions reading;
    ExportOptions options;

    int run(const Session& session) const {
        const std::string chosen = format.empty() ? guess_exchange_format(output) : format;
        check_outputs(given({mesh, annotations}), given({output}));
        Provenance provenance{"annotation export", list_options(options), {}};
        provenance.options.emplace_back("format", chosen);
        provenance.add_input(mesh);
        provenance.add_input(annotations);
        const MeshFile file = read_mesh(mesh);
        const AnnotationSet set = read_annotations(annotations, file.mesh, reading);
        const ExportedAnnotations exported = export_annotations(file.mesh, set, chosen, mesh, provenance, options);
        write_file(output, exported.bytes);
        for (const auto& note : set.notes) session.note("note: " + note);
        for (const auto& note : exported.notes) session.note("note: " + note);
        if (!session.json) {
            const std::size_t all = set.annotations.size(), written = exported.annotations;
            std::cout << written << (written == all ? "" : " of " + std::to_string(all))
                      << (all == 1 ? " annotation" : " annotations") << " as " << chosen << ", " << exported.bytes.size()
                      << " bytes\n";
            return done;
        }
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType);
        add_member(result, "format", chosen, allocator);
        add_member(result, "annotations", JsonValue(static_cast<std::uint64_t>(exported.annotations)), allocator);
        add_member(result, "bytes", JsonValue(static_cast<std::uint64_t>(exported.bytes.size())), allocator);
        add_member(result, "sha256", sha256(exported.bytes), allocator);
        add_member(result, "notes", text_list(exported.notes, allocator), allocator);
        session.print_report(provenance, document, result);
        return done;
    }
};

struct Import {
    std::string mesh, input, output, format, onto;
    ReadAnnotationsOptions reading;
    ImportOptions options;

    int run(const Session& session) const {
        check_outputs(given({mesh, input, onto}), given({output}));
        const std::string bytes = read_file(input);
        const std::string chosen = format.empty() ? guess_exchange_format(input, bytes) : format;
        Provenance provenance{"annotation import", list_options(options), {}};
        provenance.options.emplace_back("format", chosen);
        for (const Path& file : given({mesh, input, onto})) provenance.add_input(file);
        const MeshFile file = read_mesh(mesh);
        AnnotationSet base;
        if (!onto.empty()) base = read_annotations(onto, file.mesh, reading);
        const PlacedAnnotations placed = [&] {
            try {
                return import_annotations(file.mesh, bytes, chosen, input, onto.empty() ? nullptr : &base, options);
            } catch (const Error& error) {
                // What is wrong with the mesh is said of its file.
                if (error.kind() != ErrorKind::input || error.where() != "mesh") throw;
                fail_input(mesh, error.problem(), error.remedy());
            }
        }();
        write_annotations(output, placed.set, file.mesh, mesh, provenance);
        print(session, provenance, chosen, placed);
        return done;
    }

private:
    static void print(const Session& session, const Provenance& provenance, const std::string& chosen,
                      const PlacedAnnotations& placed) {
        for (const auto& note : placed.set.notes) session.note("note: " + note);
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType);
        std::vector<std::vector<std::string>> rows;
        for (const PlacedAnnotation& placement : placed.placements) {
            JsonValue entry(rapidjson::kObjectType);
            add_member(entry, "id", JsonValue(placement.id), allocator);
            add_member(entry, "tag", placement.tag, allocator);
            add_member(entry, "by", placement.how, allocator);
            add_member(entry, "points", JsonValue(static_cast<std::uint64_t>(placement.points)), allocator);
            add_member(entry, "toSurface", JsonValue(placement.to_surface), allocator);
            add_member(entry, "toVertex", JsonValue(placement.to_vertex), allocator);
            list.PushBack(entry, allocator);
            rows.push_back({std::to_string(placement.id), placement.tag, placement.how, std::to_string(placement.points),
                            number(placement.to_surface, 3), number(placement.to_vertex, 3)});
        }
        add_member(result, "format", chosen, allocator);
        add_member(result, "annotations", JsonValue(static_cast<std::uint64_t>(placed.set.annotations.size())), allocator);
        add_member(result, "placed", std::move(list), allocator);
        add_member(result, "notes", text_list(placed.set.notes, allocator), allocator);
        if (session.json) session.print_report(provenance, document, result);
        else if (!rows.empty()) std::cout << table({"id", "tag", "by", "points", "to surface", "to vertex"}, rows);
    }
};

std::string format_help() {
    std::string list;
    for (const auto& name : exchange_formats()) list += (list.empty() ? "" : ", ") + name;
    return "format of the file, if its ending does not tell: " + list;
}

}  // namespace

void add_annotation_exchange(CLI::App& annotation, Session& session) {
    const auto out = std::make_shared<Export>();
    CLI::App* command = session.add(annotation, "export", "write annotations in the formats of other tools",
                                    [&session, out] { return out->run(session); });
    command->add_option("mesh", out->mesh, "mesh file")->required();
    command->add_option("annotations", out->annotations, "its annotations (.ant.json)")->required();
    command->add_option("output", out->output, "file to write")->required();
    command->add_option("--format", out->format, format_help())->check(CLI::IsMember(exchange_formats()));
    add_flags(command, out->reading);
    add_flags(command, out->options);

    const auto in = std::make_shared<Import>();
    command = session.add(annotation, "import", "read annotations from the formats of other tools",
                          [&session, in] { return in->run(session); });
    command->add_option("mesh", in->mesh, "mesh file")->required();
    command->add_option("input", in->input, "file to read")->required();
    command->add_option("output", in->output, "annotations to write (.ant.json)")->required();
    command->add_option("--format", in->format, format_help())->check(CLI::IsMember(exchange_formats()));
    command->add_option("--onto", in->onto, "annotations to which the file's are added, or that its table of attributes is of");
    add_flags(command, in->reading);
    add_flags(command, in->options);
}

}  // namespace ostraka::app

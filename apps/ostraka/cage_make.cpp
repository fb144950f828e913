// ostraka cage make, check, edit: cages around meshes.
#include "number_lists.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/cage/cage.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/relation/geometric.h"
#include "ostraka/semantic/cage_density.h"
#include "ostraka/semantic/edit.h"

#include <iostream>
#include <memory>
#include <set>

namespace ostraka::app {

namespace {

struct Make {
    std::string mesh, output, levels, mirror, annotations;
    std::vector<std::string> details;
    CageOptions options;

    int run(const Session& session) {
        check_options(options, "cage make");
        std::vector<std::uint64_t> sizes;
        if (!levels.empty()) sizes = numbers_of<std::uint64_t>(levels, "--levels");
        for (const std::uint64_t size : sizes)
            if (size < 4 || size > 1000000) fail_usage("--levels is " + levels, "give numbers of vertices from 4 to a million");
        if (sizes.empty()) sizes.push_back(options.vertices);
        std::sort(sizes.rbegin(), sizes.rend());
        if (std::adjacent_find(sizes.begin(), sizes.end()) != sizes.end())
            fail_usage("--levels has a number twice", "give each once");
        std::vector<Path> files;
        for (const std::uint64_t size : sizes) files.push_back(levels.empty() ? Path(output) : level_file(size));
        std::vector<Path> inputs{mesh};
        if (!annotations.empty()) inputs.emplace_back(annotations);
        check_outputs(inputs, files);
        if (annotations.empty() && !details.empty()) fail_usage("--detail without --annotations", "add --annotations");
        Provenance provenance{"cage make", list_options(options), {}};
        for (const auto& [key, value] : {std::pair{"levels", levels}, {"mirror", mirror}})
            if (!value.empty()) provenance.options.emplace_back(key, value);
        for (const auto& detail : details) provenance.options.emplace_back("detail", detail);
        for (const Path& input : inputs) provenance.add_input(input);

        const MeshFile file = read_mesh(mesh);
        AnnotationSet set;
        if (!annotations.empty()) set = read_annotations(annotations, file.mesh);
        CageDensity density;
        if (!annotations.empty()) density = annotation_density(file.mesh, set, factors(set));
        const auto plane = mirror_plane(session, file.mesh, set);
        const auto results = in_file(mesh, [&] { return make_nested_cages(file.mesh, sizes, options, density, plane); });
        bool reached = true;
        std::size_t left_out = 0;
        std::set<long> genera;
        std::vector<std::vector<std::string>> rows;
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType);
        const Mesh* inner = &file.mesh;
        for (std::size_t i = 0; i < results.size(); ++i) {
            const CageResult& made = results[i];
            const CageCheck check = check_cage(made.cage, *inner);
            write_mesh(files[i], made.cage);
            reached = reached && made.reached;
            left_out += check.outside.size();
            genera.insert(check.genus);
            note_missing(session, files[i], made, sizes[i]);
            rows.push_back({files[i].filename().string(), std::to_string(made.cage.number_of_vertices()),
                            std::to_string(made.cage.number_of_faces()), std::to_string(check.genus), number(check.clearance),
                            number(made.alpha)});
            JsonValue entry(rapidjson::kObjectType);
            add_member(entry, "file", files[i].string(), allocator);
            add_member(entry, "vertices", JsonValue(static_cast<std::uint64_t>(made.cage.number_of_vertices())), allocator);
            add_member(entry, "faces", JsonValue(static_cast<std::uint64_t>(made.cage.number_of_faces())), allocator);
            add_member(entry, "reached", JsonValue(made.reached), allocator);
            add_member(entry, "genus", JsonValue(static_cast<std::int64_t>(check.genus)), allocator);
            add_member(entry, "clearance", JsonValue(check.clearance), allocator);
            add_member(entry, "alpha", JsonValue(made.alpha), allocator);
            list.PushBack(entry, allocator);
            inner = &made.cage;
        }
        add_member(result, "cages", std::move(list), allocator);
        if (session.json) session.print_report(provenance, document, result);
        else std::cout << table({"cage", "vertices", "faces", "genus", "clearance", "alpha"}, rows);
        if (!reached) session.note("fewer vertices could not be had without leaving a part of the mesh outside");
        if (genera.size() > 1)
            session.note("note: the levels differ in genus: the wrap of a coarser one closes holes that a finer one follows");
        if (left_out > 0)
            session.note(
                (left_out == 1 ? "1 vertex that no face has is" : std::to_string(left_out) + " vertices that no face has are") +
                std::string(" not inside the cage, which is made around faces: remove with 'mesh repair'"));
        return reached && left_out == 0 ? done : answer_is_no;
    }

private:
    /// Why a cage has fewer vertices than wanted, if it has.
    void note_missing(const Session& session, const Path& file, const CageResult& made, std::uint64_t wanted) const {
        const std::size_t count = made.cage.number_of_vertices();
        if (count >= wanted) return;
        session.note("note: " + file.filename().string() + " has " + std::to_string(count) + " vertices instead of " +
                     std::to_string(wanted) +
                     (made.wrap_vertices < wanted ? ": its wrap has no more, a smaller --alpha gives more"
                                                  : ": a mirrored cage has as many on both sides of the plane"));
    }

    [[nodiscard]] Path level_file(std::uint64_t size) const {
        const Path path(output);
        return path.parent_path() / (path.stem().string() + "-" + std::to_string(size) + path.extension().string());
    }

    [[nodiscard]] std::vector<std::pair<int, double>> factors(const AnnotationSet& set) const {
        if (details.empty()) return {};
        std::vector<std::pair<int, double>> list;
        for (const std::string& detail : details) {
            const std::size_t at = detail.rfind('=');
            if (at == std::string::npos)
                fail_usage("--detail is '" + printable(detail, 60) + "'", "give annotation=factor, like spout=4");
            const auto factor = numbers_of<double>(detail.substr(at + 1), "--detail");
            if (factor.size() != 1 || !(factor[0] >= 0.1 && factor[0] <= 100))
                fail_usage("--detail is '" + printable(detail, 60) + "'", "give a factor from 0.1 to 100");
            for (const int id : named(set, detail.substr(0, at))) list.emplace_back(id, factor[0]);
        }
        return list;
    }

    static std::vector<int> named(const AnnotationSet& set, const std::string& name) {
        std::vector<int> ids;
        for (const Annotation& annotation : set.annotations)
            if (annotation.tag == name || std::to_string(annotation.id) == name) ids.push_back(annotation.id);
        if (ids.empty()) fail_usage("--detail names '" + printable(name, 60) + "', which is no annotation", "use an id or a tag");
        return ids;
    }

    [[nodiscard]] std::optional<MirrorPlane> mirror_plane(const Session& session, const Mesh& object, AnnotationSet& set) const {
        if (mirror.empty()) return {};
        if (mirror != "auto") {
            const auto n = numbers_of<double>(mirror, "--mirror");
            if (n.size() != 6)
                fail_usage("--mirror is '" + printable(mirror, 60) + "'", "give auto, or six numbers: a point and a normal");
            return MirrorPlane{Point(n[0], n[1], n[2]), Vector(n[3], n[4], n[5])};
        }
        Relationship stated;
        stated.type = "mirror symmetry";
        stated.annotations = {ensure_root(set, object).id};
        const RelationCheck check = RelationMeter(object, set).measure(stated);
        if (check.verdict != Verdict::holds || !check.parameters.plane)
            throw Error(ErrorKind::failure, mesh, "is not mirror-symmetric: " + check.text,
                        "give the plane, or leave --mirror out");
        const auto& [p, n] = *check.parameters.plane;
        session.note("mirror plane through " + number(p[0]) + "," + number(p[1]) + "," + number(p[2]) + " with normal " +
                     number(n[0]) + "," + number(n[1]) + "," + number(n[2]));
        return MirrorPlane{Point(p[0], p[1], p[2]), Vector(n[0], n[1], n[2])};
    }
};

/// Moves the vertices of a cage by an edit that knows no mesh.
struct Move {
    std::string cage, edit, output;

    int run(const Session& session) const {
        check_outputs({cage, edit}, {output});
        Provenance provenance{"cage edit", {}, {}};
        provenance.add_input(cage);
        provenance.add_input(edit);
        MeshFile around = read_mesh(cage);
        const Json steps = read_json(edit);
        refuse_annotations(steps);
        const AnnotationSet none;
        Coordinates own{"own", WeightMatrix::Identity(around.mesh.number_of_vertices(), around.mesh.number_of_vertices()), {}};
        const Mesh rest = around.mesh;
        const auto states = follow_edit(steps, {rest, none, &rest, &own}, edit);
        std::size_t touched = 0;
        if (!states.empty()) {
            for (const Vertex v : around.mesh.vertices()) around.mesh.point(v) = states.back().handles[v];
            touched = static_cast<std::size_t>(std::count(states.back().touched.begin(), states.back().touched.end(), true));
        }
        write_mesh(output, around.mesh, around.extras);
        const CageCheck check = check_cage(around.mesh, Mesh());
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType);
        add_member(result, "steps", JsonValue(static_cast<std::uint64_t>(states.size())), allocator);
        add_member(result, "moved", JsonValue(static_cast<std::uint64_t>(touched)), allocator);
        add_member(result, "intersects", JsonValue(!check.intersections.empty()), allocator);
        if (session.json) session.print_report(provenance, document, result);
        else
            std::cout << states.size() << (states.size() == 1 ? " step, " : " steps, ") << touched << " of "
                      << around.mesh.number_of_vertices() << " vertices moved\n";
        if (!check.intersections.empty())
            session.note("note: the moved cage intersects itself, which deforms a mesh all the same, but may fold it");
        return done;
    }

private:
    /// A step may select by annotation, but not here.
    void refuse_annotations(const Json& document) const {
        const JsonValue* steps = document.IsObject() ? find_member(document, "steps") : nullptr;
        if (steps == nullptr || !steps->IsArray()) return;
        for (rapidjson::SizeType i = 0; i < steps->Size(); ++i) {
            const JsonValue* select = (*steps)[i].IsObject() ? find_member((*steps)[i], "select") : nullptr;
            if (select != nullptr && select->IsObject() && find_member(*select, "annotation") != nullptr)
                fail_input(edit + ", /steps/" + std::to_string(i), "selects by annotation, and 'cage edit' knows no annotations",
                           "select cageVertices, box or all, or use 'ostraka deform'");
        }
    }
};

struct Check {
    std::string mesh, cage;

    int run(const Session& session) const {
        Provenance provenance{"cage check", {}, {}};
        provenance.add_input(mesh);
        provenance.add_input(cage);
        const MeshFile object = read_mesh(mesh), around = read_mesh(cage);
        return report_findings(session, provenance, findings(check_cage(around.mesh, object.mesh), ""));
    }
};

}  // namespace

void add_cage_make(CLI::App& cage, Session& session) {
    const auto make = std::make_shared<Make>();
    CLI::App* command =
        session.add(cage, "make", "a closed coarse mesh strictly around a mesh", [&session, make] { return make->run(session); });
    command->add_option("mesh", make->mesh, "mesh file; it may be open")->required();
    command->add_option("output", make->output, "cage to write (.ply, .obj, .off, .stl)")->required();
    add_flags(command, make->options);
    command->add_option("--levels", make->levels,
                        "numbers of vertices with commas: nested cages, each around the finer one, written as output-NUMBER");
    command->add_option("--mirror", make->mirror,
                        "a mirror-symmetric cage: auto, or a point and a normal as six numbers with commas");
    command->add_option("--annotations", make->annotations,
                        "annotations of the mesh (.ant.json): four times the vertices where points, lines and outlines are");
    command->add_option("--detail", make->details,
                        "annotation=factor: so many times the vertices there, instead; may be given several times");

    const auto move = std::make_shared<Move>();
    command =
        session.add(cage, "edit", "move the vertices of a cage by an edit file", [&session, move] { return move->run(session); });
    command->add_option("cage", move->cage, "cage file")->required();
    command->add_option("edit", move->edit, "what is done to its vertices (.edit.json): select cageVertices, box or all")
        ->required();
    command->add_option("output", move->output, "cage to write")->required();

    const auto check = std::make_shared<Check>();
    command = session.add(cage, "check", "is a mesh a sound cage of another? (exit code 3: no)",
                          [&session, check] { return check->run(session); });
    command->add_option("mesh", check->mesh, "mesh file")->required();
    command->add_option("cage", check->cage, "cage file")->required();
}

}  // namespace ostraka::app

// deform: an edit of a shape that preserves its annotations and relations.
#include "operations/constraint_report.h"

#include "ostraka/geom/with_points.h"
#include "ostraka/measure/measure.h"
#include "ostraka/semantic/edit_words.h"

namespace ostraka {

namespace {

struct Deform final : Operation {
    void declare(Parameters& p) override {
        p.input("template", Kind::template_package, package, "template (.template.json), instead of mesh and annotations")
            .optional();
        p.input("mesh", Kind::mesh, mesh, "mesh file").optional();
        p.input("annotations", Kind::annotations, annotations, "annotations of the mesh (.ant.json)").optional();
        p.input("edit", Kind::edit, edit, "edit (.edit.json); alternatively, specify the edit by --stretch, --raise and --rotate")
            .optional();
        p.output("output", Kind::mesh, output, "deformed mesh to write, whether or not the result is acceptable");
        p.order({"mesh", "annotations", "edit", "output"});
        p.order({"mesh", "annotations", "output"});
        p.order({"mesh", "edit", "output"});
        p.order({"mesh", "output"});
        p.order({"template", "edit", "output"});
        p.order({"template", "output"});
        p.input_option("graph", Kind::graph, graph,
                       "relationships (.graph.json) with the constraints; replaces the template's graph");
        p.input_option("cage", Kind::cage, cage, "cage whose vertices are the handles of the edit; by default mesh vertices");
        p.input_option("weights", Kind::coordinates, weights, "weights written by 'cage weights' (.npy)");
        p.input_option("deformed-cage", Kind::cage, deformed_cage,
                       "deformed cage, with the same number and order of vertices: the first step of the edit moves the cage "
                       "vertices to these positions");
        p.output_option("annotations-out", Kind::annotations, annotations_out,
                        "annotations to write for the deformed mesh, with recomputed measures");
        p.output_option("cage-out", Kind::cage, cage_out, "cage after the deformation, to write");
        p.options("states", states, "also write the shape after each step of the edit, before solving, as output-step1, ...");
        words.declare_options(p.options);
        options.declare_options(p.options);
        tolerances.declare_options(p.options);
        p.report.values(
            boolean("acceptable"), texts("objections"),
            number("followed.share", "", "how closely the result follows the edit, as a fraction of the edit's displacement"),
            integer("followed.vertices"), number("followed.mean", "", "length"), number("followed.largest", "", "length"),
            integer("selfIntersections"), integer("selfIntersectionsBefore"), integer("selfIntersectionsNew"), integer("folds"),
            integer("kinks"), integer("iterations"), integer("rounds"), text("stopped"), integer("passes"), text("space"),
            numbers("seated"));
        p.report.table("constraints", integer("id", "id"), text("type", "constraint"), texts("parts", "parts"),
                       number("weight", "weight"), boolean("hard"), boolean("used"), text("before"), text("verdict", "verdict"),
                       text("text"), any("deviations", "how well"), number("residual.mean"), number("residual.median"),
                       number("residual.min"), number("residual.max"), number("residual.greatest distance"),
                       integer("residual.constraints"), number("cost.before"), number("cost.after", "cost"));
        p.report.table("conflicts", integer("id"), numbers("freed"), any("deviations"));
        p.report.table("moved", integer("id", "id"), text("tag", "moved, although the edit does not select it"),
                       number("share", "mean, % of the diagonal"), number("largest", "at most, % of the diagonal"));
        p.report.table("distorted", integer("id", "id"), text("tag", "distorted, although its shape should not change"),
                       number("distance", "root mean square"), number("largest", "at most"),
                       number("thin", "share of its area that is half as thick, %"));
    }

    void check() const override {
        if (package ? mesh || annotations : !mesh)
            fail_usage("the object to deform is not given", "give a mesh and its annotations, or a template");
        const bool named = words.is_edit() || !words.keep.empty() || !words.level.empty();
        if (!edit && !named && !graph && !package && !deformed_cage)
            fail_usage("no edit is given", "give an edit (.edit.json), or options: --stretch back=1.2 --level legs");
        if (!package && !annotations && (named || graph || annotations_out))
            fail_usage("parts are named, but there are no annotations", "give the mesh's annotations (.ant.json)");
        if (static_cast<bool>(cage) != static_cast<bool>(weights))
            fail_usage("--cage and --weights need each other", "give both: see 'cage weights'");
        if (cage_out && !package && !cage) fail_without_cage();
    }

    void run(Context& context, Report& report) override {
        const std::string where = edit ? edit.file() : "the command line";
        const Edit given = edit ? edit_from_json(*edit, where) : Edit();
        const auto step = [](std::size_t i) { return "-step" + std::to_string(i + 1); };
        const Stopwatch stopwatch;
        static const AnnotationSet no_annotations;
        Subject subject = package       ? of_template(context)
                          : annotations ? Subject{&*mesh, &annotations.on(mesh->mesh)}
                                        : Subject{&*mesh, &no_annotations};
        if (!words.keep.empty()) {
            own_set = *subject.set;
            add_missing_measures(words, subject.object->mesh, own_set);
            subject.set = &own_set;
        }
        if (cage) {
            subject.around = &*cage;
            subject.coordinates = &weights.of(subject.object->mesh, cage->mesh);
        }
        const Edit all = all_steps(subject, given);
        if (states) {
            std::vector<Path> files;
            for (std::size_t i = 0; i < all.steps.size(); ++i) files.emplace_back(output.part_file(step(i)));
            context.check_outputs(files);
        }
        if (graph) subject.relations = &graph.on(*subject.set);
        if (cage_out && subject.coordinates == nullptr) fail_without_cage();
        const HandleSpace space{
            {subject.object->mesh, *subject.set}, subject.around ? &subject.around->mesh : nullptr, subject.coordinates};
        RelationGraph relations;
        if (subject.relations != nullptr) relations.relationships = subject.relations->relationships;
        add_constraints(words, *subject.set, relations);
        const DeformResult result = deform(space, relations, all, where, options, tolerances,
                                           graph               ? graph.file()
                                           : subject.relations ? "the template's graph"
                                                               : "the command line");
        report.run("seconds", stopwatch.seconds());

        const Mesh shaped = with_points(space.mesh, result.points);
        if (cage_out) cage_out.write(with_points(*space.cage, result.cage), subject.around->extras);
        if (annotations_out) {
            AnnotationSet set = space.annotations;
            move_extents(space, shaped, set);
            report.notes(refresh_measures(shaped, set).notes);
            annotations_out.write(std::move(set), shaped, output.file());
        }
        if (!subject.object->extras.tetrahedra.empty() && subject.coordinates == nullptr)
            report.note("vertices inside the tetrahedral mesh are not moved: deform through a cage, which moves them too");
        output.write(shaped, subject.object->extras);
        if (states) {
            const auto followed = follow_edit(all, space, where);
            for (std::size_t i = 0; i < followed.size(); ++i) {
                const Mesh state = with_points(space.mesh, shape_of_edit(space, followed[i], options));
                output.write_part(step(i), state, subject.object->extras);
            }
        }
        const std::string handles = std::to_string((space.cage != nullptr ? *space.cage : space.mesh).number_of_vertices()) +
                                    (space.cage != nullptr ? " cage vertices" : " vertices");
        for (std::size_t i = 0; i < result.selected.size(); ++i)
            report.note("step " + std::to_string(i + 1) + " moves " + std::to_string(result.selected[i]) + " of " + handles);
        report_result(report, result, *subject.set);
        if (options.space == DeformOptions::Space::automatic && result.solved) report_choice(report, result);
        if (!result.acceptable) report.answer_no();
    }

    /// The object to deform, from separate files or from a template.
    struct Subject {
        const MeshFile* object = nullptr;
        const AnnotationSet* set = nullptr;
        const RelationGraph* relations = nullptr;
        const MeshFile* around = nullptr;
        const Coordinates* coordinates = nullptr;
    };

    [[noreturn]] static void fail_without_cage() {
        fail_usage("--cage-out without a cage", "add --cage and --weights, or a cage and its coordinates to the template");
    }

    /// All steps: to the deformed cage, then those of the edit, then those given in words.
    [[nodiscard]] Edit all_steps(const Subject& subject, const Edit& given) const {
        Edit all;
        if (deformed_cage) all.steps.push_back(step_to_cage(subject));
        const Edit message_about = parse_edit(words, *subject.set);
        for (const Edit* part : {&given, &message_about})
            all.steps.insert(all.steps.end(), part->steps.begin(), part->steps.end());
        return all;
    }

    /// A step that moves the cage vertices whose positions differ in the deformed cage.
    [[nodiscard]] EditStep step_to_cage(const Subject& subject) const {
        if (subject.around == nullptr)
            fail_usage("--deformed-cage without a cage",
                       "add --cage and --weights, or a cage and its coordinates to the template");
        const Mesh &from = subject.around->mesh, &to = deformed_cage->mesh;
        if (from.number_of_vertices() != to.number_of_vertices())
            fail_input(deformed_cage.file(),
                       "has " + std::to_string(to.number_of_vertices()) + " vertices, the cage " +
                           std::to_string(from.number_of_vertices()),
                       "give the cage itself in another shape");
        const double moved = 1e-9 * box_diagonal(from);
        EditStep::CageVertices vertices;
        EditStep::MoveTo move;
        for (const Vertex v : from.vertices()) {
            const Point& p = to.point(v);
            if (CGAL::squared_distance(from.point(v), p) <= moved * moved) continue;
            vertices.indices.push_back(v);
            move.places.emplace_back(p.x(), p.y(), p.z());
        }
        if (vertices.indices.empty()) fail_input(deformed_cage.file(), "has the shape of the cage", "move some of its vertices");
        EditStep step;
        step.select = std::move(vertices);
        step.operation = std::move(move);
        return step;
    }

    Subject of_template(Context& context) {
        const Template& loaded = *package;
        for (const Finding& finding : loaded.findings)
            if (finding.defect)
                fail_input(package.file() + ", " + finding.where, finding.text, "'template check' lists all defects");
        if (!loaded.mesh) fail_input(package.file(), "has no mesh", "pack one");
        if (!loaded.annotations)
            fail_input(package.file(), "has no annotations", "pack them, or give a mesh and its annotations");
        Subject subject{&*loaded.mesh, &*loaded.annotations};
        if (loaded.graph) subject.relations = &*loaded.graph;
        // The first cage that has coordinates.
        std::string why_not;
        for (std::size_t i = 0; i < loaded.cages.size() && !cage; ++i)
            for (const PackagedFile* part : loaded.file.of("coordinates")) {
                if (subject.coordinates != nullptr || !loaded.cages[i]) continue;
                try {
                    context.record([&] { own_weights = read_coordinates(part->file, loaded.mesh->mesh, *loaded.cages[i]); });
                    own_cage.mesh = *loaded.cages[i];
                    subject.around = &own_cage;
                    subject.coordinates = &own_weights;
                } catch (const Error& error) {
                    if (error.kind() == ErrorKind::cancelled) throw;
                    why_not = error.what();  // perhaps coordinates of another cage
                }
            }
        if (!cage && subject.coordinates == nullptr && !why_not.empty())
            fail_input(package.file(), "has a cage and coordinates that do not match: " + why_not,
                       "compute the coordinates again with 'cage weights', or give --cage and --weights");
        return subject;
    }

    static JsonValue deviation_json(const Deviation& d, std::optional<double> before, JsonAllocator& allocator) {
        JsonValue deviation = json_object(allocator, "quantity", d.quantity);
        if (before) add_members(deviation, allocator, "before", *before);
        add_members(deviation, allocator, "value", *d.value, "tolerance", *d.tolerance, "unit", d.unit);
        return deviation;
    }

    static void report_result(Report& report, const DeformResult& result, const AnnotationSet& set) {
        const std::string& unit = set.unit;
        report("acceptable", result.acceptable)("iterations", result.summary.iterations)("rounds", result.rounds);
        const std::string stopped = result.passes > 0 ? std::string(ostraka::describe(result.summary.stop)) : "nothing to solve";
        report("stopped", stopped)("passes", result.passes);
        report("space", result.space == DeformOptions::Space::cage ? "cage" : "mesh")("seated", result.seated);
        report.empty_table("constraints", false);
        for (const ConstraintReport& constraint : result.constraints) report_result(report, constraint, set);
        if (result.passes > 0)
            report.line(
                (result.rounds > 0
                     ? counted(static_cast<std::size_t>(result.rounds), "round") + " for the hard constraints, the last with "
                     : "") +
                std::to_string(result.summary.iterations) + (result.summary.iterations == 1 ? " iteration: " : " iterations: ") +
                stopped + (result.passes > 1 ? "; " + std::to_string(result.passes) + " passes" : ""));
        report.empty_table("conflicts");
        for (const ConstraintConflict& conflict : result.conflicts) report_result(report, result, conflict);
        if (result.untried > 0)
            report.line(std::to_string(result.untried) +
                        " further constraints were not tested for conflicts: raise --conflicts to test them");
        report_edit(report, result, unit.empty() ? unit : " " + unit);
        report.line(!result.acceptable           ? "not acceptable: " + joined(result.objections, "; ")
                    : result.constraints.empty() ? "acceptable; no constraints"
                                                 : "acceptable: every constraint holds");
        report("objections", result.objections);
    }

    static void report_choice(Report& report, const DeformResult& result) {
        std::vector<std::string> seated;
        for (const ConstraintReport& constraint : result.constraints)
            if (std::find(result.seated.begin(), result.seated.end(), constraint.id) != result.seated.end())
                seated.push_back(std::to_string(constraint.id) + " (" + constraint.type + ")");
        report.note("solved over the " + std::string(result.space == DeformOptions::Space::cage ? "cage" : "mesh") +
                    (seated.empty() ? "" : "; the parts of " + joined(seated) + " are seated"));
    }

    static void report_edit(Report& report, const DeformResult& result, const std::string& unit) {
        const EditFollowed& followed = result.followed;
        report("followed.share", followed.share)("followed.vertices", followed.vertices)("followed.mean", followed.mean)(
            "followed.largest", followed.largest);
        const SurfaceChange& surface = result.surface;
        report("selfIntersections", surface.crossings)("selfIntersectionsBefore", surface.crossings_before)(
            "selfIntersectionsNew", surface.crossings_new)("folds", surface.folds)("kinks", surface.kinks);
        report.empty_table("moved", false);
        for (const EditFollowed::Moved& part : followed.others)
            report.row("moved")("id", part.annotation)("tag", part.tag)("share", 100 * part.share)("largest", 100 * part.largest);
        report.empty_table("distorted", false);
        for (const DistortedPart& part : result.distorted)
            report.row("distorted")("id", part.annotation)("tag", part.tag)("distance", part.distance)("largest", part.largest)(
                "thin", 100 * part.thin);
        if (followed.vertices > 0)
            report.line("the result follows the edit by " + number(100 * followed.share, 3) + " %: the " +
                        std::to_string(followed.vertices) + " vertices that the edit moves deviate by " +
                        number(followed.mean, 3) + unit + " from their edited positions in the mean, " +
                        number(followed.largest, 3) + unit + " at most");
    }

    static void report_result(Report& report, const ConstraintReport& constraint, const AnnotationSet& set) {
        JsonValue deviations(rapidjson::kArrayType);
        for (std::size_t i = 0; i < constraint.deviations.size(); ++i)
            deviations.PushBack(
                deviation_json(constraint.deviations[i], i < constraint.before_values.size() ? constraint.before_values[i] : 0,
                               report.allocator()),
                report.allocator());
        std::vector<std::string> words = deviation_texts(constraint);
        if (!constraint.text.empty()) words.push_back(constraint.text);
        Report::Row row = report.row("constraints");
        std::vector<std::string> parts;
        for (const int id : constraint.annotations) parts.push_back(set.find(id)->tag);
        row("id", constraint.id)("type", constraint.type)("parts", parts);
        row("weight", constraint.weight, number(constraint.weight) + (constraint.hard ? ", hard" : ""));
        row("hard", constraint.hard)("used", constraint.used)("before", to_string(constraint.before));
        row("verdict", to_string(constraint.verdict), constraint.used ? to_string(constraint.verdict) : "left out");
        row("text", constraint.text)("deviations", std::move(deviations)).shown("deviations", joined(words, "; "));
        row("residual.mean", constraint.mean)("residual.median", constraint.median)("residual.min", constraint.minimum)(
            "residual.max", constraint.maximum)("residual.greatest distance", constraint.distance)("residual.constraints",
                                                                                                   constraint.low_level);
        if (constraint.used && !constraint.hard)
            row("cost.before", constraint.cost_before)("cost.after", constraint.cost, number(constraint.cost, 3));
    }

    /// Reports a conflict: the constraints that exclude each other.
    static void report_result(Report& report, const DeformResult& result, const ConstraintConflict& conflict) {
        const auto name = [&](int id) {
            for (const ConstraintReport& one : result.constraints)
                if (one.id == id) return std::to_string(id) + " (" + one.type + ")";
            return std::to_string(id);
        };
        JsonValue deviations(rapidjson::kArrayType);
        std::vector<std::string> others, gives;
        for (const int id : conflict.freed) others.push_back(name(id));
        for (const Deviation& d : conflict.deviations) {
            deviations.PushBack(deviation_json(d, {}, report.allocator()), report.allocator());
            if (*d.value > *d.tolerance)
                gives.push_back(d.quantity + " " + number(*d.value, 4) + " instead of at most " + number(*d.tolerance, 4) +
                                (d.unit.empty() ? "" : " " + d.unit));
        }
        const std::string id = std::to_string(conflict.id);
        report.row("conflicts")("id", conflict.id)("freed", conflict.freed)("deviations", std::move(deviations));
        report.line(
            printable(name(conflict.id) + " fights with " + joined(others) + ": if " + id + " is left out, " +
                      (conflict.freed.size() == 1 ? "the other constraint holds" : "the other constraints hold") +
                      (gives.empty() ? ", and so does " + id : "; " + id + " would have to give: " + joined(gives, "; "))));
    }

    TemplateInput package;
    MeshInput mesh, cage, deformed_cage;
    AnnotationsInput annotations;
    JsonInput edit;
    GraphInput graph;
    CoordinatesInput weights;
    MeshOutput output, cage_out;
    AnnotationsOutput annotations_out;
    bool states = false;
    EditWords words;
    DeformOptions options;
    RelationOptions tolerances = deform_tolerances();
    AnnotationSet own_set;  ///< the annotations with measures that the words preserve
    MeshFile own_cage;      ///< cage of the template, with its coordinates
    Coordinates own_weights;
};

}  // namespace

std::unique_ptr<Operation> make_deform() { return make<Deform>(); }

}  // namespace ostraka

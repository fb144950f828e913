// ostraka measure take | describe | refresh
#include "annotation_names.h"
#include "command.h"
#include "number_lists.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/ids.h"
#include "ostraka/core/limits.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/measure/descriptors.h"
#include "ostraka/measure/measure.h"
#include "ostraka/render/values.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

/// What an option was given several times, as one text.
std::string joined(const std::vector<std::string>& texts) {
    std::string result;
    for (const auto& text : texts) result += (result.empty() ? "" : "; ") + text;
    return result;
}

std::array<double, 3> vector_of(const std::string& text, const std::string& option) {
    const auto numbers = numbers_of<double>(text, option);
    if (numbers.size() != 3) fail_usage(option + " is '" + printable(text, 60) + "'", "give three numbers, like 0,0,1");
    for (const double x : numbers)
        if (!std::isfinite(x)) fail_usage(option + " is '" + printable(text, 60) + "'", "give finite numbers");
    return {numbers[0], numbers[1], numbers[2]};
}

/// A mesh, and its annotations or, without a file of them, one annotation that is the whole object.
struct Subject {
    std::string mesh_file, annotations_file, output, unit;
    std::vector<std::string> chosen;
    ReadAnnotationsOptions reading;

    void add_to(CLI::App& command, bool several) {
        command.add_option("mesh", mesh_file, "mesh file")->required();
        command.add_option("--annotations", annotations_file, "its annotations (.ant.json); without, the whole object is meant");
        if (several)
            command.add_option("--annotation", chosen, "id or tag of an annotation; once for each, all if left out")
                ->allow_extra_args(false);
        command.add_option("--unit", unit, "unit of the coordinates, where the annotations do not say (any text, such as mm)");
        command.add_option("--output", output, "annotations to write, with the values as attributes (.ant.json)");
        add_flags(&command, reading);
    }

    /// To be called before any work; `others` are further inputs and outputs.
    void check(std::vector<Path> inputs, std::vector<Path> outputs) const {
        inputs.emplace_back(mesh_file);
        if (!annotations_file.empty()) inputs.emplace_back(annotations_file);
        if (!output.empty()) outputs.emplace_back(output);
        check_outputs(inputs, outputs);
    }

    [[nodiscard]] Provenance provenance(const std::string& command) const {
        Provenance result{command, list_options(reading), {}};
        result.add_input(mesh_file);
        if (!annotations_file.empty()) result.add_input(annotations_file);
        if (!chosen.empty()) result.options.emplace_back("annotation", joined(chosen));
        if (!unit.empty()) result.options.emplace_back("unit", unit);
        return result;
    }

    AnnotationSet read(const Session& session, const MeshFile& file) const {
        for (const auto& note : file.notes) session.note("note: " + note);
        AnnotationSet set;
        if (!annotations_file.empty()) set = read_annotations(annotations_file, file.mesh, reading);
        for (const auto& note : set.notes) session.note("note: " + note);
        if (!unit.empty() && !set.unit.empty() && set.unit != unit)
            session.note("note: the annotations are in " + set.unit + ", not in " + unit + "; theirs counts");
        if (set.unit.empty()) set.unit = unit;
        if (annotations_file.empty()) ensure_root(set, file.mesh);
        return set;
    }

    /// By id, or by tag if exactly one annotation has it.
    [[nodiscard]] Annotation& one(AnnotationSet& set, const std::string& name) const {
        const std::string& where = annotations_file.empty() ? mesh_file : annotations_file;
        return *set.find(find_annotation(set, name, where).id);
    }

    std::vector<Annotation*> selected(AnnotationSet& set) const {
        std::vector<Annotation*> list;
        for (const auto& name : chosen) {
            Annotation* annotation = &one(set, name);
            if (std::find(list.begin(), list.end(), annotation) == list.end()) list.push_back(annotation);
        }
        if (chosen.empty())
            for (Annotation& annotation : set.annotations) list.push_back(&annotation);
        return list;
    }

    void write(const AnnotationSet& set, const Mesh& mesh, const Provenance& provenance) const {
        if (!output.empty()) write_annotations(output, set, mesh, mesh_file, provenance);
    }
};

Index nearest_vertex(const Mesh& mesh, const std::array<double, 3>& place) {
    const Point p(place[0], place[1], place[2]);
    Index best = no_index;
    double least = std::numeric_limits<double>::infinity();
    for (const Vertex v : mesh.vertices()) {
        const double squared = CGAL::squared_distance(mesh.point(v), p);
        if (!mesh.is_isolated(v) && squared < least) least = squared, best = v;
    }
    if (best == no_index) fail_input("mesh", "has no faces", "there is nothing to measure");
    return best;
}

struct Take {
    Subject subject;
    std::string tool, points, direction, name, annotation, geodesic = "edges";
    std::vector<std::string> places, repeats;

    int run(const Session& session) {
        subject.check({}, {});
        Measure measure;
        measure.tool = tool;
        measure.exact = geodesic == "exact";
        if (measure.exact && tool != "tape") fail_usage("--geodesic exact with a " + tool, "it belongs to a tape");
        if (tool == "bounding" && direction.empty())
            fail_usage("a bounding measure without a direction", "add --direction x,y,z");
        if (tool != "bounding" && !direction.empty())
            fail_usage("--direction with a " + tool, "it belongs to a bounding measure");
        if (!direction.empty()) {
            measure.direction = vector_of(direction, "--direction");
            const auto& [x, y, z] = *measure.direction;
            if (x == 0 && y == 0 && z == 0) fail_usage("--direction is " + direction, "give a vector that is not zero");
        }
        if (!points.empty() && !places.empty()) fail_usage("--points and --at", "give the pins in one way");
        if (!points.empty()) measure.points = numbers_of<Index>(points, "--points");
        for (const auto& text : repeats) measure.repeats.push_back(numbers_of<Index>(text, "--repeat"));
        std::vector<std::array<double, 3>> coordinates;
        for (const auto& text : places) {
            const auto& [x, y, z] = coordinates.emplace_back(vector_of(text, "--at"));
            if (!is_place(x, y, z))
                fail_usage("--at is '" + printable(text, 60) + "', beyond what can be computed with (coordinates up to 1e60)",
                           "give a place on the surface, in the unit of the mesh");
        }
        const std::size_t pins = measure.points.size() + coordinates.size();
        if (tool == "bounding" ? pins == 1 : pins < 2)
            fail_usage(
                "a " + tool + " with " + std::to_string(pins) + (pins == 1 ? " pin" : " pins"),
                tool == "bounding" ? "give two or more, or none and the whole annotation is measured" : "give two or more");
        Provenance provenance = subject.provenance("measure take");
        for (const auto& [key, value] : {std::pair{"tool", tool},
                                         {"points", points},
                                         {"direction", direction},
                                         {"geodesic", geodesic},
                                         {"name", name},
                                         {"annotation", annotation}})
            if (!value.empty()) provenance.options.emplace_back(key, value);
        if (!places.empty()) provenance.options.emplace_back("at", joined(places));
        if (!repeats.empty()) provenance.options.emplace_back("repeat", joined(repeats));
        const MeshFile file = read_mesh(subject.mesh_file);
        AnnotationSet set = subject.read(session, file);
        Annotation& holder = annotation.empty() ? ensure_root(set, file.mesh) : subject.one(set, annotation);
        for (const auto& place : coordinates) measure.points.push_back(pin(session, file.mesh, place));
        if (measure.points.empty()) {
            const auto ends = extremes(file.mesh, holder, *measure.direction);
            measure.points.assign(ends.begin(), ends.end());
        }
        measure.unit = set.unit;
        const Evaluated taken = in_file(subject.mesh_file, [&] { return evaluate_with_uncertainty(file.mesh, holder, measure); });
        measure.value = taken.value;
        measure.uncertainty = taken.uncertainty;
        note_namesake(session, holder);
        keep(holder, measure);
        subject.write(set, file.mesh, provenance);
        report(session, provenance, holder, measure, taken);
        return done;
    }

private:
    /// The nearest vertex; a place far from the surface is a mistake, of the unit or of the position, say.
    static Index pin(const Session& session, const Mesh& mesh, const std::array<double, 3>& place) {
        const Index found = nearest_vertex(mesh, place);
        const Point here(place[0], place[1], place[2]);
        const double moved = std::sqrt(CGAL::squared_distance(here, mesh.point(Vertex(found)))), diagonal = box_diagonal(mesh);
        const std::string where = number(place[0], 6) + "," + number(place[1], 6) + "," + number(place[2], 6);
        if (moved > 0.02 * diagonal) {
            const double away = SurfaceSearch(mesh).closest(here).distance;
            if (away > 0.02 * diagonal)
                fail_input("--at " + where,
                           "the surface is " + number(away, 4) + " away, farther than 2 % of the diagonal (" +
                               number(0.02 * diagonal, 4) + ")",
                           "give a place on the surface, in the unit of the mesh, or vertices with --points");
        }
        if (moved > 0.001 * diagonal)
            session.note("the pin at " + where + " is vertex " + std::to_string(found) + ", " + number(moved, 3) + " away");
        return found;
    }

    void note_namesake(const Session& session, const Annotation& holder) const {
        const std::string& called = name.empty() ? tool : name;
        for (const Attribute& other : holder.attributes)
            if (other.name == called)
                return session.note("note: annotation " + std::to_string(holder.id) + " has an attribute '" + called + "' (id " +
                                    std::to_string(other.id) +
                                    ") already, and both are kept: give another --name, remove one with 'annotation edit "
                                    "--remove-attribute ID', or join pickings with 'measure refresh --merge-pickings'");
    }

    void keep(Annotation& holder, const Measure& measure) const {
        Attribute attribute;
        attribute.name = name.empty() ? tool : name;
        attribute.type = AttributeType::measure;
        attribute.measure = measure;
        attribute.id = next_free_id(holder.attributes);
        holder.attributes.push_back(std::move(attribute));
    }

    void report(const Session& session, const Provenance& provenance, const Annotation& holder, const Measure& measure,
                const Evaluated& taken) const {
        if (!session.json) {
            std::cout << (name.empty() ? tool : printable(name, 60)) << ' ' << number(taken.value, 9) << ' '
                      << printable(measure.unit, 20) << (measure.unit.empty() ? "" : " ") << "+- "
                      << number(taken.uncertainty, 3);
            if (taken.pickings > 1)
                std::cout << " (" << taken.pickings << " pickings, spread " << number(taken.spread, 3) << ", resolution "
                          << number(taken.resolution, 3) << ')';
            std::cout << '\n';
            return;
        }
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), pins(rapidjson::kArrayType);
        for (const Index v : measure.points) pins.PushBack(v, allocator);
        add_member(result, "name", name.empty() ? tool : name, allocator);
        add_member(result, "annotation", JsonValue(holder.id), allocator);
        add_member(result, "tool", tool, allocator);
        add_member(result, "points", std::move(pins), allocator);
        add_member(result, "value", JsonValue(taken.value), allocator);
        add_member(result, "unit", measure.unit, allocator);
        add_member(result, "uncertainty", JsonValue(taken.uncertainty), allocator);
        add_member(result, "resolution", JsonValue(taken.resolution), allocator);
        add_member(result, "spread", JsonValue(taken.spread), allocator);
        add_member(result, "pickings", JsonValue(static_cast<std::uint64_t>(taken.pickings)), allocator);
        session.print_report(provenance, document, result);
    }
};

struct Describe {
    Subject subject;
    DescriptorOptions options;
    std::vector<std::string> maps;

    int run(const Session& session) {
        std::vector<Path> map_files;
        std::vector<NamedMap> named;
        std::vector<std::string> names;
        for (const auto& text : maps) {
            const auto equals = text.find('=');
            if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
                fail_usage("--map is '" + printable(text, 60) + "'", "give NAME=FILE");
            named.push_back({text.substr(0, equals), {}, {}});
            names.push_back(named.back().name);
            map_files.emplace_back(text.substr(equals + 1));
        }
        subject.check(map_files, {});
        check_options(options, "measure describe");
        Provenance provenance = subject.provenance("measure describe");
        for (auto& option : list_options(options)) provenance.options.push_back(std::move(option));
        for (std::size_t i = 0; i < named.size(); ++i) {
            provenance.add_input(map_files[i]);
        }
        if (!maps.empty()) provenance.options.emplace_back("map", joined(names));
        const MeshFile file = read_mesh(subject.mesh_file);
        for (std::size_t i = 0; i < named.size(); ++i) {
            named[i].values = read_values(map_files[i]);
            if (named[i].values.size() != file.mesh.number_of_vertices())
                fail_input(map_files[i].string(),
                           "has " + std::to_string(named[i].values.size()) + " values for " +
                               std::to_string(file.mesh.number_of_vertices()) + " vertices",
                           "give one value for each vertex of the mesh");
        }
        AnnotationSet set = subject.read(session, file);
        DescriptorSearch search(file.mesh, options);
        std::vector<std::pair<const Annotation*, std::vector<Quantity>>> found;
        for (Annotation* annotation : subject.selected(set)) {
            auto quantities = [&] {
                try {
                    return in_file(subject.annotations_file.empty() ? subject.mesh_file : subject.annotations_file,
                                   [&] { return search.describe(*annotation, named); });
                } catch (const Error& error) {
                    // What is wrong with a map is said of its file.
                    for (std::size_t i = 0; i < named.size(); ++i)
                        if (error.where().ends_with("map '" + named[i].name + "'"))
                            throw Error(error.kind(), map_files[i].string() + ", at " + error.where(), error.problem(),
                                        error.remedy());
                    throw;
                }
            }();
            store(*annotation, quantities, set.unit);
            found.emplace_back(annotation, std::move(quantities));
        }
        subject.write(set, file.mesh, provenance);
        report(session, provenance, set.unit, found);
        return done;
    }

private:
    static void report(const Session& session, const Provenance& provenance, const std::string& unit,
                       const std::vector<std::pair<const Annotation*, std::vector<Quantity>>>& found) {
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType);
        std::vector<std::vector<std::string>> rows;
        for (const auto& [annotation, quantities] : found) {
            JsonValue entry(rapidjson::kObjectType), values(rapidjson::kArrayType);
            add_member(entry, "id", JsonValue(annotation->id), allocator);
            add_member(entry, "tag", annotation->tag, allocator);
            for (const Quantity& quantity : quantities) {
                JsonValue item(rapidjson::kObjectType), numbers(rapidjson::kArrayType);
                std::string text;
                const bool axes = quantity.name == "box axes" && quantity.values.size() == 9;  // three vectors
                for (std::size_t i = 0; i < quantity.values.size(); ++i) {
                    numbers.PushBack(quantity.values[i], allocator);
                    text += (text.empty() ? "" : " ") + std::string(axes && i % 3 == 0 ? "(" : "") +
                            number(quantity.values[i], 6) + (axes && i % 3 == 2 ? ")" : "");
                }
                add_member(item, "name", quantity.name, allocator);
                if (quantity.is_list) add_member(item, "value", std::move(numbers), allocator);
                else add_member(item, "value", JsonValue(quantity.values.front()), allocator);
                add_member(item, "unit", unit_of(quantity, unit), allocator);
                values.PushBack(item, allocator);
                rows.push_back({std::to_string(annotation->id), annotation->tag, quantity.name, text, unit_of(quantity, unit)});
            }
            add_member(entry, "quantities", std::move(values), allocator);
            list.PushBack(entry, allocator);
        }
        add_member(result, "annotations", std::move(list), allocator);
        if (session.json) session.print_report(provenance, document, result);
        else std::cout << table({"id", "tag", "quantity", "value", "unit"}, rows);
    }
};

struct Refresh {
    Subject subject;
    bool merge = false;

    int run(const Session& session) {
        if (subject.annotations_file.empty()) fail_usage("measure refresh without annotations", "add --annotations FILE");
        subject.check({}, {});
        Provenance provenance = subject.provenance("measure refresh");
        provenance.options.emplace_back("merge-pickings", merge ? "true" : "false");
        const MeshFile file = read_mesh(subject.mesh_file);
        AnnotationSet set = subject.read(session, file);
        std::size_t merged = 0;
        if (merge)
            for (Annotation& annotation : set.annotations) merged += merge_pickings(annotation);
        const RefreshResult refreshed = refresh_measures(file.mesh, set, true);
        subject.write(set, file.mesh, provenance);
        for (const auto& note : refreshed.notes) session.note("note: " + note);
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType);
        std::vector<std::vector<std::string>> rows;
        for (const Annotation& annotation : set.annotations)
            for (const Attribute& attribute : annotation.attributes) {
                const Measure& m = attribute.measure;
                if (attribute.type != AttributeType::measure || !m.value || !m.uncertainty) continue;
                JsonValue entry(rapidjson::kObjectType);
                add_member(entry, "annotation", JsonValue(annotation.id), allocator);
                add_member(entry, "name", attribute.name, allocator);
                add_member(entry, "value", JsonValue(*m.value), allocator);
                add_member(entry, "uncertainty", JsonValue(*m.uncertainty), allocator);
                add_member(entry, "pickings", JsonValue(static_cast<std::uint64_t>(m.repeats.size() + 1)), allocator);
                list.PushBack(entry, allocator);
                rows.push_back({std::to_string(annotation.id), annotation.tag, attribute.name, number(*m.value, 6),
                                number(*m.uncertainty, 3), m.unit, std::to_string(m.repeats.size() + 1)});
            }
        add_member(result, "computed", JsonValue(static_cast<std::uint64_t>(refreshed.computed)), allocator);
        add_member(result, "stale", JsonValue(static_cast<std::uint64_t>(refreshed.stale)), allocator);
        add_member(result, "merged", JsonValue(static_cast<std::uint64_t>(merged)), allocator);
        add_member(result, "measures", std::move(list), allocator);
        if (session.json) session.print_report(provenance, document, result);
        else std::cout << table({"id", "tag", "measure", "value", "uncertainty", "unit", "pickings"}, rows);
        return refreshed.stale == 0 ? done : answer_is_no;
    }
};

}  // namespace

void add_measure(CLI::App& measure, Session& session) {
    const auto take = std::make_shared<Take>();
    CLI::App* command = session.add(measure, "take", "take one measure by ruler, tape or bounding planes",
                                    [&session, take] { return take->run(session); });
    take->subject.add_to(*command, false);
    command->add_option("--tool", take->tool, "ruler (straight), tape (over the surface) or bounding (between two planes)")
        ->required()
        ->check(CLI::IsMember({"ruler", "tape", "bounding"}));
    command->add_option("--points", take->points, "pins as vertex indices, like 12,88");
    command->add_option("--at", take->places, "a pin as coordinates x,y,z: the nearest vertex; once for each pin")
        ->allow_extra_args(false);
    command->add_option("--direction", take->direction,
                        "direction x,y,z of a bounding measure; without pins the whole annotation is measured along it");
    command->add_option("--geodesic", take->geodesic, "a tape along edges, or the exact shortest curve over the faces")
        ->check(CLI::IsMember({"edges", "exact"}))
        ->capture_default_str();
    command
        ->add_option("--repeat", take->repeats,
                     "the pins picked again, as vertex indices like 12,88, as many as the measure has; once for each picking: "
                     "the value is the mean")
        ->allow_extra_args(false);
    command->add_option("--annotation", take->annotation,
                        "id or tag of the annotation that gets it; the whole object if left out");
    command->add_option("--name", take->name, "name of the attribute; the tool if left out");

    const auto describe = std::make_shared<Describe>();
    command = session.add(measure, "describe",
                          "sizes, box, centroid, volume, curvature, thickness, and statistics of maps, of annotations",
                          [&session, describe] { return describe->run(session); });
    describe->subject.add_to(*command, true);
    add_flags(command, describe->options);
    command->add_option("--map", describe->maps, "NAME=FILE: a map of one value a vertex (.npy, or text with a number a line)")
        ->allow_extra_args(false);

    const auto refresh = std::make_shared<Refresh>();
    command = session.add(measure, "refresh",
                          "compute all measures and descriptors anew, with uncertainties; exit code 3 if some cannot be",
                          [&session, refresh] { return refresh->run(session); });
    refresh->subject.add_to(*command, false);
    command->add_flag("--merge-pickings", refresh->merge, "measures of one name become pickings of one measure");
}

}  // namespace ostraka::app

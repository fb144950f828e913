// ostraka relation extract | add | remove | list | check | export
#include "annotation_names.h"
#include "command.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/mesh.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/relation/geometric.h"
#include "ostraka/relation/topology.h"
#include "ostraka/semantic/deform.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

/// What every one of these commands reads.
struct Inputs {
    std::string mesh, annotations, graph;
    ReadAnnotationsOptions options;

    void add_to(CLI::App& command) {
        command.add_option("mesh", mesh, "mesh file")->required();
        command.add_option("annotations", annotations, "its annotations (.ant.json)")->required();
    }
    [[nodiscard]] Provenance provenance(const std::string& name) const {
        Provenance result{name, list_options(options), {}};
        for (const std::string& file : {mesh, annotations, graph})
            if (!file.empty()) result.add_input(file);
        return result;
    }
    void check(const std::string& output) const {
        std::vector<Path> inputs{mesh, annotations};
        if (!graph.empty()) inputs.emplace_back(graph);
        check_outputs(inputs, {output});
    }
    [[nodiscard]] Mesh read(const Session& session, AnnotationSet& set, RelationGraph& relations) const {
        MeshFile file = read_mesh(mesh);
        for (const auto& note : file.notes) session.note("note: " + note);
        set = read_annotations(annotations, file.mesh, options);
        for (const auto& note : set.notes) session.note("note: " + note);
        if (!graph.empty()) relations = read_graph(graph, set);
        return std::move(file.mesh);
    }
};

std::string name_of(const AnnotationSet& set, int id) {
    const Annotation* annotation = set.find(id);
    return std::to_string(id) + (annotation == nullptr ? "" : " " + annotation->tag);
}

std::string members_of(const AnnotationSet& set, const Relationship& relationship) {
    std::string text;
    for (const int id : relationship.annotations)
        text += (text.empty() ? "" : relationship.directed ? " > " : ", ") + name_of(set, id);
    return text;
}

/// The type, of "equal attributes" with the attribute, of constraints with the weight.
std::string type_of(const Relationship& relationship) {
    std::string text = relationship.type;
    if (!relationship.parameters.attribute.empty()) text += ": " + relationship.parameters.attribute;
    if (relationship.is_constraint) text += " (constraint, weight " + number(relationship.weight) + ")";
    return text;
}

std::string measured(const RelationParameters& parameters) {
    std::string text;
    for (const auto& deviation : parameters.deviations) {
        text += (text.empty() ? "" : "; ") + deviation.quantity;
        if (deviation.value) text += " " + number(*deviation.value, 4);
        if (deviation.tolerance) text += " (at most " + number(*deviation.tolerance, 4) + ")";
        if (!deviation.unit.empty()) text += " " + deviation.unit;
    }
    return text;
}

void print_relationships(const Session& session, const Provenance& provenance, const AnnotationSet& set,
                         const std::vector<Relationship>& relationships, const ContainmentOrder* order) {
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    JsonValue result(rapidjson::kObjectType), tree(rapidjson::kArrayType), list(rapidjson::kArrayType);
    std::string text = "the whole shape\n";
    if (order != nullptr) {
        for (const auto& [place, depth] : containment_tree(*order)) {
            const Annotation& annotation = set.annotations[place];
            JsonValue entry(rapidjson::kObjectType);
            add_member(entry, "annotation", JsonValue(annotation.id), allocator);
            add_member(entry, "tag", annotation.tag, allocator);
            add_member(entry, "depth", JsonValue(static_cast<std::uint64_t>(depth)), allocator);
            if (const auto parent = order->parent[place])
                add_member(entry, "parent", JsonValue(set.annotations[*parent].id), allocator);
            tree.PushBack(entry, allocator);
            text += std::string(2 * depth + 2, ' ') + std::to_string(annotation.id) + " " + printable(annotation.tag) + " (" +
                    to_string(annotation.type) + ")\n";
        }
        add_member(result, "tree", std::move(tree), allocator);
    }
    std::vector<std::vector<std::string>> rows;
    for (const auto& relationship : relationships) {
        list.PushBack(relationship_to_json(relationship, allocator), allocator);
        rows.push_back({std::to_string(relationship.id), type_of(relationship), relationship.origin,
                        members_of(set, relationship), measured(relationship.parameters)});
    }
    add_member(result, "relationships", std::move(list), allocator);
    if (session.json) session.print_report(provenance, document, result);
    else std::cout << (order == nullptr ? "" : text + "\n") << table({"id", "type", "origin", "annotations", "measured"}, rows);
}

struct Extract {
    Inputs inputs;
    std::string output;
    std::vector<std::string> types;
    RelationOptions tolerances;

    int run(const Session& session) const {
        inputs.check(output);
        Provenance provenance = inputs.provenance("relation extract");
        for (const auto& option : list_options(tolerances)) provenance.options.push_back(option);
        std::vector<std::string> wanted;
        for (const auto& name : types) {
            const RelationType* type = find_relation_type(name);
            if (type == nullptr || !type->geometric)
                fail_usage("'" + name + "' is not a type that geometry tells",
                           "use one of those in doc/relations.md; the nearest is '" + nearest_relation_type(name) + "'");
            wanted.push_back(type->name);
            provenance.options.emplace_back("type", type->name);
        }
        AnnotationSet set;
        RelationGraph old, graph;
        const Mesh mesh = inputs.read(session, set, old);
        for (auto& relationship : old.relationships)
            if (relationship.origin != "extracted") graph.relationships.push_back(std::move(relationship));
        RelationGraph stated;
        stated.relationships = graph.relationships;
        const Topology found = in_file(inputs.annotations, [&] { return topology(mesh, set); });
        for (auto& relationship : relationships_of(found, set, 0))
            if (wanted.empty() || std::find(wanted.begin(), wanted.end(), relationship.type) != wanted.end())
                add(session, stated, graph, std::move(relationship));
        if (!set.up) note_missing_up(session, wanted);
        RelationMeter meter(mesh, set, tolerances);
        for (auto& relationship : meter.extract(wanted, 0)) add(session, stated, graph, std::move(relationship));
        write_graph(output, graph, set, provenance);
        print_relationships(session, provenance, set, graph.relationships, &found.order);
        return done;
    }

private:
    static void note_missing_up(const Session& session, const std::vector<std::string>& wanted) {
        std::string left_out;
        for (const char* type : {"same level", "horizontal support", "side contact"})
            if (wanted.empty() || std::find(wanted.begin(), wanted.end(), type) != wanted.end())
                left_out += (left_out.empty() ? "" : ", ") + std::string(type);
        if (!left_out.empty())
            session.note("note: not looked for, as the annotations do not say what is up: " + left_out +
                         " ('ostraka annotation edit --set-up x,y,z' says it)");
    }

    /// What is stated already is not said again.
    static void add(const Session& session, const RelationGraph& stated, RelationGraph& graph, Relationship relationship) {
        if (const Relationship* known = find_twin(stated, relationship)) {
            session.note("note: relationship " + std::to_string(known->id) + " (" + known->type + ") is stated already");
            return;
        }
        relationship.id = free_id(graph);
        graph.relationships.push_back(std::move(relationship));
    }
};

struct Add {
    Inputs inputs;
    std::string output, type, constraint, attribute;
    std::vector<std::string> members, tolerances;
    double weight = 1;
    bool directed = false, is_constraint = false, own_type = false;

    int run(const Session& session) const {
        inputs.check(output);
        if (!std::isfinite(weight)) fail_usage("--weight is not a finite number", "use 0 or more");
        if (weight < 0) fail_usage("--weight is negative", "use 0 or more");
        Provenance provenance = inputs.provenance("relation add");
        provenance.options.emplace_back("type", type);
        AnnotationSet set;
        RelationGraph graph;
        const Mesh on = inputs.read(session, set, graph);
        Relationship relationship = make(on, set);
        relationship.id = free_id(graph);
        check_relationship(relationship, set, "the relationship to add");
        if (const Relationship* twin = find_twin(graph, relationship)) {
            const std::string id = std::to_string(twin->id);
            if (twin->origin != "extracted")
                fail_input(inputs.graph, "relationship " + id + " says the same",
                           "remove it first: 'ostraka relation remove ... --id " + id + "'");
            relationship.id = twin->id;
            session.note("note: relationship " + id + " was extracted and is stated now");
            graph.relationships[static_cast<std::size_t>(twin - graph.relationships.data())] = relationship;
        } else {
            graph.relationships.push_back(relationship);
        }
        write_graph(output, graph, set, provenance);
        if (relationship.is_constraint) {
            try {
                check_constraint(on, set, relationship, output);
            } catch (const Error& error) {
                session.note(std::string("note: 'deform' will refuse this as it is: ") + error.what());
            }
        }
        print_relationships(session, provenance, set, {relationship}, nullptr);
        return done;
    }

private:
    static std::string unit_of(const std::string& quantity, const std::string& length) {
        if (quantity == "angle" || quantity == "tilt") return "degree";
        return quantity == "distance" || quantity == "height" ? length : "%";
    }

    [[nodiscard]] Relationship make(const Mesh& on, const AnnotationSet& set) const {
        Relationship relationship;
        const RelationType* known = find_relation_type(type);
        if (known == nullptr && !own_type)
            fail_usage("'" + type + "' is not a known type of relationship",
                       "did you mean '" + nearest_relation_type(type) + "'? --own-type adds a type of your own");
        relationship.type = known == nullptr ? type : known->name;
        if (relationship.type == "equal attributes" && attribute.empty())
            fail_usage("nothing says which attribute is equal", "add --attribute NAME");
        relationship.directed = directed || (known != nullptr && known->directed);
        for (const auto& name : members) relationship.annotations.push_back(find_annotation(set, name, inputs.annotations).id);
        relationship.is_constraint = is_constraint || !constraint.empty() || (known != nullptr && !known->geometric);
        relationship.weight = weight;
        relationship.constraint = constraint;
        relationship.origin = "stated";
        relationship.parameters.attribute = attribute;
        for (const auto& text : tolerances) {
            const std::size_t sign = text.find('=');
            double value = 0;
            const bool percent = text.ends_with('%');
            const char* end = text.data() + text.size() - (percent ? 1 : 0);
            const bool named = sign != std::string::npos && text.data() + sign + 1 < end;
            const auto [rest, code] = std::from_chars(named ? text.data() + sign + 1 : end, end, value);
            if (!named || rest != end || code != std::errc() || !std::isfinite(value))
                fail_usage("'" + printable(text, 60) + "' is not a tolerance",
                           "write QUANTITY=NUMBER, e.g. angle=5 or distance=1%");
            if (value < 0) fail_usage("the tolerance '" + printable(text, 60) + "' is negative", "use 0 or more");
            const std::string quantity = text.substr(0, sign);
            const auto measured = measured_quantities(relationship.type);
            if (std::find(measured.begin(), measured.end(), quantity) == measured.end()) {
                std::string list;
                for (const auto& name : measured) list += (list.empty() ? "" : ", ") + name;
                fail_usage("'" + relationship.type + "' does not measure '" + quantity + "'",
                           list.empty() ? "leave the tolerance out" : "it measures " + list);
            }
            const bool length = quantity == "distance" || quantity == "height";
            const std::string unit = unit_of(quantity, set.unit);
            if (percent && !length && unit != "%")
                fail_usage("'" + text + "' is not a tolerance", "give an angle in degrees, without '%'");
            if (percent && length) value *= box_diagonal(on) / 100;
            relationship.parameters.deviations.push_back({quantity, {}, value, unit});
        }
        return relationship;
    }
};

struct List {
    Inputs inputs;

    int run(const Session& session) const {
        const Provenance provenance = inputs.provenance("relation list");
        AnnotationSet set;
        RelationGraph graph;
        (void)inputs.read(session, set, graph);
        print_relationships(session, provenance, set, graph.relationships, nullptr);
        return done;
    }
};

struct Remove {
    Inputs inputs;
    std::string output;
    std::vector<int> ids;

    int run(const Session& session) const {
        inputs.check(output);
        Provenance provenance = inputs.provenance("relation remove");
        for (const int id : ids) provenance.options.emplace_back("id", std::to_string(id));
        AnnotationSet set;
        RelationGraph graph;
        (void)inputs.read(session, set, graph);
        std::vector<Relationship> removed;
        for (const int id : ids) {
            const auto has_id = [&](const Relationship& relationship) { return relationship.id == id; };
            const auto place = std::find_if(graph.relationships.begin(), graph.relationships.end(), has_id);
            if (place != graph.relationships.end()) {
                removed.push_back(std::move(*place));
                graph.relationships.erase(place);
            } else if (std::none_of(removed.begin(), removed.end(), has_id)) {
                fail_input(inputs.graph, "has no relationship " + std::to_string(id), "'ostraka relation list' shows them");
            }
        }
        write_graph(output, graph, set, provenance);
        print_relationships(session, provenance, set, removed, nullptr);
        return done;
    }
};

struct Check {
    Inputs inputs;
    RelationOptions tolerances;

    int run(const Session& session) const {
        Provenance provenance = inputs.provenance("relation check");
        for (const auto& option : list_options(tolerances)) provenance.options.push_back(option);
        AnnotationSet set;
        RelationGraph graph;
        const Mesh mesh = inputs.read(session, set, graph);
        const std::vector<RelationCheck> checks =
            in_file(inputs.annotations, [&] { return check_relations(mesh, set, graph, tolerances); });
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType);
        std::vector<std::vector<std::string>> rows;
        std::array<std::uint64_t, 3> counts{};
        for (std::size_t i = 0; i < checks.size(); ++i) {
            Relationship relationship = graph.relationships[i];
            relationship.parameters = checks[i].parameters;
            const std::string verdict = to_string(checks[i].verdict);
            JsonValue entry = relationship_to_json(relationship, allocator);
            add_member(entry, "verdict", verdict, allocator);
            add_member(entry, "text", checks[i].text, allocator);
            list.PushBack(entry, allocator);
            ++counts.at(static_cast<std::size_t>(checks[i].verdict));
            rows.push_back({std::to_string(relationship.id), verdict, type_of(relationship), members_of(set, relationship),
                            measured(relationship.parameters), checks[i].text});
        }
        for (const Verdict verdict : {Verdict::holds, Verdict::fails, Verdict::unknown})
            add_member(result, to_string(verdict), JsonValue(counts.at(static_cast<std::size_t>(verdict))), allocator);
        add_member(result, "relationships", std::move(list), allocator);
        if (session.json) session.print_report(provenance, document, result);
        else
            std::cout << table({"id", "verdict", "type", "annotations", "measured", "remark"}, rows) << counts[0] << " hold, "
                      << counts[1] << " fail, " << counts[2] << " unknown\n";
        return counts[1] == 0 ? done : answer_is_no;
    }
};

struct Export {
    Inputs inputs;
    std::string output;

    int run(const Session& session) const {
        inputs.check(output);
        if (extension(output) != ".dot" && extension(output) != ".gv")
            fail_usage("'" + output + "' is not a Graphviz file", "end its name in .dot or .gv");
        const Provenance provenance = inputs.provenance("relation export");
        AnnotationSet set;
        RelationGraph graph;
        (void)inputs.read(session, set, graph);
        AtomicFile file(output);
        file.write(graph_to_dot(graph, set));
        file.commit();
        session.note(std::to_string(graph.relationships.size()) + " relationships among " +
                     std::to_string(set.annotations.size()) + " annotations");
        if (!session.json) return done;
        Json document(rapidjson::kObjectType);
        JsonValue result(rapidjson::kObjectType);
        const auto add = [&](const char* name, std::size_t count) {
            add_member(result, name, JsonValue(static_cast<std::uint64_t>(count)), document.GetAllocator());
        };
        add("relationships", graph.relationships.size());
        add("annotations", set.annotations.size());
        session.print_report(provenance, document, result);
        return done;
    }
};

}  // namespace

void add_relation(CLI::App& relation, Session& session) {
    const auto extract = std::make_shared<Extract>();
    CLI::App* command = session.add(relation, "extract", "find relationships among annotations",
                                    [&session, extract] { return extract->run(session); });
    extract->inputs.add_to(*command);
    command->add_option("output", extract->output, "graph to write (.graph.json)")->required();
    command->add_option("--graph", extract->inputs.graph, "graph whose stated relationships are kept");
    command->add_option("--type", extract->types, "type to look for, once for each; all without it");
    add_flags(command, extract->tolerances);
    add_flags(command, extract->inputs.options);

    const auto add = std::make_shared<Add>();
    command = session.add(relation, "add", "state a relationship", [&session, add] { return add->run(session); });
    add->inputs.add_to(*command);
    command->add_option("output", add->output, "graph to write (.graph.json)")->required();
    command->add_option("--graph", add->inputs.graph, "graph it is added to; without it a new one begins");
    command->add_option("--type", add->type, "type, e.g. adjacency, \"mirror symmetry\", proportion")->required();
    command->add_option("--annotation", add->members, "id or tag of a member, once for each; the first is the subject")
        ->required();
    command->add_flag("--own-type", add->own_type, "the type is one of your own");
    command->add_flag("--directed", add->directed, "the first annotation is the subject");
    command->add_flag("--constraint", add->is_constraint, "the relationship is a constraint on deformations");
    command->add_option("--parameters", add->constraint, "JSON object with the parameters of the constraint");
    command->add_option("--weight", add->weight, "weight of the constraint, 0 or more");
    command->add_option(
        "--tolerance", add->tolerances,
        "QUANTITY=NUMBER that a check shall allow: angle=5 (also tilt; degrees), distance=2 (also height; unit of the mesh's "
        "coordinates), distance=1% (of the mesh's diagonal), area=10 (also shape, difference; per cent)");
    command->add_option("--attribute", add->attribute, "name of the attribute that is equal, with --type 'equal attributes'");
    add_flags(command, add->inputs.options);

    const auto remove = std::make_shared<Remove>();
    command =
        session.add(relation, "remove", "take relationships out of a graph", [&session, remove] { return remove->run(session); });
    remove->inputs.add_to(*command);
    command->add_option("graph", remove->inputs.graph, "graph (.graph.json)")->required();
    command->add_option("output", remove->output, "graph to write (.graph.json)")->required();
    command->add_option("--id", remove->ids, "id of a relationship, as 'relation list' shows it; once for each")->required();
    add_flags(command, remove->inputs.options);

    const auto list = std::make_shared<List>();
    command = session.add(relation, "list", "the relationships of a graph", [&session, list] { return list->run(session); });
    list->inputs.add_to(*command);
    command->add_option("graph", list->inputs.graph, "graph (.graph.json)")->required();
    add_flags(command, list->inputs.options);

    const auto check = std::make_shared<Check>();
    command = session.add(relation, "check", "tell which relationships hold on a mesh; exit code 3 if one fails",
                          [&session, check] { return check->run(session); });
    check->inputs.add_to(*command);
    command->add_option("graph", check->inputs.graph, "graph (.graph.json)")->required();
    add_flags(command, check->tolerances);
    add_flags(command, check->inputs.options);

    const auto exported = std::make_shared<Export>();
    command =
        session.add(relation, "export", "write a graph for Graphviz", [&session, exported] { return exported->run(session); });
    exported->inputs.add_to(*command);
    command->add_option("graph", exported->inputs.graph, "graph (.graph.json)")->required();
    command->add_option("output", exported->output, "file to write (.dot, .gv)")->required();
    add_flags(command, exported->inputs.options);
}

}  // namespace ostraka::app

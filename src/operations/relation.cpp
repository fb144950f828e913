// relation extract, add, remove, list, check, export
#include "operations/operations.h"

#include "ostraka/figures/bracket_graph.h"
#include "ostraka/relation/geometric.h"
#include "ostraka/relation/layout.h"
#include "ostraka/relation/part_of.h"
#include "ostraka/relation/rules.h"
#include "ostraka/semantic/measure_constraints.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

namespace ostraka {

namespace {

/// Inputs and reports shared by the operations.
struct RelationOperation : AnnotatedMeshOperation {
    void describe_graph(Parameters& p) { p.input("graph", Kind::graph, graph, "graph (.graph.json)"); }
    void describe_output(Parameters& p) { p.output("output", Kind::graph, output, "graph to write (.graph.json)"); }
    /// Declares the table of relationships; with `checked` also the verdict on each.
    static void describe_relationships(ReportLayout& report, bool checked = false) {
        std::vector<Field> columns{integer("id", "id")};
        if (checked) columns.push_back(text("verdict", "verdict"));
        columns.insert(columns.end(), {text("type", "type"), text("origin", checked ? "" : "origin"),
                                       numbers("annotations", "annotations"), any("parameters", "measured")});
        if (checked) columns.push_back(text("text", "remark"));
        columns.insert(columns.end(), {boolean("isDirected"), boolean("isConstraint"), number("weight"), any("constraint")});
        report.table("relationships", std::move(columns));
    }

    [[nodiscard]] RelationGraph read_relations() const {
        RelationGraph relations;
        if (graph.exists()) relations.relationships = graph.on(set()).relationships;
        return relations;
    }

    /// Adds a row with the file content of the relationship, and its text for people.
    Report::Row report_result(Report& report, const Relationship& relationship) const {
        Report::Row row = report.row("relationships");
        JsonValue entry = relationship_to_json(relationship, report.allocator());
        for (auto& member : entry.GetObject()) row(member.name.GetString(), std::move(member.value));
        row.shown("id", std::to_string(relationship.id)).shown("type", type_of(relationship));
        row.shown("annotations", members_of(relationship)).shown("parameters", measured(relationship.parameters));
        return row;
    }
    void report_result(Report& report, const std::vector<Relationship>& relationships) const {
        report.empty_table("relationships");
        for (const Relationship& relationship : relationships)
            report_result(report, relationship).shown("origin", relationship.origin);
    }

    GraphInput graph;
    GraphOutput output;

    [[nodiscard]] std::string members_of(const Relationship& relationship) const {
        std::vector<std::string> members;
        for (const int id : relationship.annotations) {
            const Annotation* annotation = set().find(id);
            members.push_back(std::to_string(id) + (annotation == nullptr ? "" : " " + annotation->tag));
        }
        return joined(members, relationship.directed ? " > " : ", ");
    }

    /// The type; with the attribute for "equal attributes", and with the weight for constraints.
    static std::string type_of(const Relationship& relationship) {
        std::string text = relationship.type;
        if (!relationship.parameters.attribute.empty()) text += ": " + relationship.parameters.attribute;
        if (relationship.is_constraint) text += " (constraint, weight " + number(relationship.weight) + ")";
        return text;
    }

    static std::string measured(const RelationParameters& parameters) {
        std::string text;
        for (const auto& deviation : parameters.deviations) {
            text += (text.empty() ? "" : "; ") + deviation.quantity;
            if (deviation.value) text += " " + number(*deviation.value, 4);
            if (deviation.tolerance) text += " (at most " + number(*deviation.tolerance, 4) + ")";
            if (!deviation.unit.empty()) text += " " + deviation.unit;
        }
        return text;
    }
};

struct RelationExtract final : RelationOperation {
    void describe(Parameters& p) override {
        describe_inputs(p);
        describe_output(p);
        p.input_option("graph", Kind::graph, graph, "graph whose stated relationships are kept");
        Words told;
        for (const RelationType& type : relation_types())
            if (type.geometric) told.names.push_back(type.name);
        told.check = [](const std::string& name) { static_cast<void>(geometric_types({name})); };
        p.options("type", types, "type of relationship to detect, once for each; all if left out", std::move(told)).words();
        p.input_option("vocabulary", Kind::vocabulary, vocabulary,
                       "vocabulary (.vocabulary.json, .ttl, .rdf) with part-whole relations: annotations contained in an "
                       "annotation of their whole are related as 'part of'");
        tolerances.describe(p.options);
        p.report.table("tree", integer("annotation"), text("tag"), integer("depth"), integer("parent"));
        describe_relationships(p.report);
    }

    void run(Context&, Report& report) override {
        types = geometric_types(types);
        const RelationGraph old = read_relations();
        ExtractedRelations found =
            in_file(annotations.file(), [&] { return extract_relations(mesh->mesh, set(), old, types, tolerances); });
        for (const int id : found.stated) {
            const auto& list = found.graph.relationships;
            const auto known = std::find_if(list.begin(), list.end(), [&](const auto& one) { return one.id == id; });
            report.note("relationship " + std::to_string(id) + " (" + known->type + ") is stated already");
        }
        for (const std::string& note : found.notes) report.note(note);
        if (vocabulary)
            for (Relationship& part :
                 part_relationships(found.order, set(), vocabulary.load<Vocabulary>(read_vocabulary), free_id(found.graph)))
                if (find_twin(found.graph, part) == nullptr) found.graph.relationships.push_back(std::move(part));
        if (!found.not_looked_for.empty())
            report.note("not looked for, as the annotations do not say what is up: " + joined(found.not_looked_for) +
                        " ('ostraka annotation edit --set-up x,y,z' says it)");
        report.empty_table("tree");
        std::string text = "the whole shape\n";
        for (const auto& [place, depth] : containment_tree(found.order)) {
            const Annotation& annotation = set().annotations[place];
            Report::Row row = report.row("tree");
            row("annotation", annotation.id)("tag", annotation.tag)("depth", depth);
            if (const auto parent = found.order.parent[place]) row("parent", set().annotations[*parent].id);
            text += std::string(2 * depth + 2, ' ') + std::to_string(annotation.id) + " " + printable(annotation.tag) + " (" +
                    to_string(annotation.type) + ")\n";
        }
        report.line(text);
        report_result(report, found.graph.relationships);
        output.write(std::move(found.graph), set());
    }

    std::vector<std::string> types;
    RelationOptions tolerances;
    FileInput vocabulary;
};

struct RelationAdd final : RelationOperation {
    void describe(Parameters& p) override {
        describe_inputs(p);
        p.input_option("graph", Kind::graph, graph, "graph to which the relationship is added; created if it does not exist");
        p.output("output", Kind::graph, output, "graph to write (.graph.json); without it the one of --graph")
            .optional()
            .updates(graph);
        Words known{{}, "a type of your own with --own-type"};
        for (const RelationType& one : relation_types()) known.names.push_back(one.name);
        p.options("type", type, "what the relationship is", std::move(known));
        p.options("annotation", members, "id or tag of a member, once for each; the first is the subject").words();
        p.options("relation", several,
                  "TYPE: A, B, ...: type and members of a relationship, once for each, instead of --type and --annotation; the "
                  "other options apply to all")
            .words();
        p.options("own-type", own_type, "the type is one of your own");
        p.options("directed", directed, "the first annotation is the subject");
        p.options("constraint", is_constraint, "the relationship is a constraint on deformations");
        p.options("parameters", parameters, "JSON object with the parameters of the constraint");
        p.options("weight", weight, "weight of the constraint", Range{0, 1e300});
        p.options("tolerance", tolerances,
                  "QUANTITY=NUMBER, the tolerance of checks: angle=5 (also tilt; degrees), distance=2 (also height; unit of the "
                  "mesh's coordinates), distance=1% (of the mesh's diagonal), area=10 (also shape, difference; per cent)")
            .words();
        p.options("attribute", attribute, "name of the attribute that is equal, with --type 'equal attributes'");
        describe_relationships(p.report);
    }

    void check() const override {
        if (!output && !graph) fail_usage("nothing says where the graph goes", "give a file to write, or --graph");
        if (graph && !graph.exists() && output.file() != graph.file())
            fail_input(graph.file(), "cannot be opened for reading", "check the name; without an output it is begun");
        if (!several.empty() && (!type.empty() || !members.empty()))
            fail_usage("--relation with --type or --annotation", "say all in one way: --relation 'TYPE: A, B', once for each");
        if (several.empty() && type.empty())
            fail_usage("nothing says what the relationship is", "add --type, or --relation 'TYPE: A, B'");
        if (several.empty() && members.empty())
            fail_usage("nothing says between which annotations", "add --annotation, once for each member");
        for (const Stated& one : stated()) {
            if (find_relation_type(one.type) == nullptr && !own_type)
                fail_usage("'" + printable(one.type, 60) + "' is not a known type of relationship",
                           "did you mean '" + nearest_relation_type(one.type) + "'? --own-type adds a type of your own");
            if (own_name(one.type) == "equal attributes" && attribute.empty())
                fail_usage("nothing says which attribute is equal", "add --attribute NAME");
            for (const std::string& text : tolerances) static_cast<void>(tolerance_of(text, own_name(one.type)));
        }
    }

    void run(Context&, Report& report) override {
        RelationGraph relations = read_relations();
        std::vector<Relationship> added;
        for (const Stated& one : stated()) added.push_back(add(one, relations, report));
        output.write(std::move(relations), set());
        for (const Relationship& relationship : added) {
            if (!relationship.is_constraint) continue;
            try {
                check_constraint(mesh->mesh, set(), relationship, output.file());
            } catch (const Error& error) {
                if (error.kind() == ErrorKind::cancelled) throw;
                report.note(std::string("'deform' will refuse this as it is: ") + error.what());
            }
        }
        report_result(report, added);
    }

    struct Stated {
        std::string type;
        std::vector<std::string> members;
    };

    /// The relationships stated on the command line: one, or several in the form "TYPE: A, B".
    [[nodiscard]] std::vector<Stated> stated() const {
        if (several.empty()) return {{type, members}};
        const auto trimmed = [](std::string_view text) {
            const std::size_t first = text.find_first_not_of(' ');
            return first == std::string_view::npos ? std::string()
                                                   : std::string(text.substr(first, text.find_last_not_of(' ') - first + 1));
        };
        std::vector<Stated> list;
        for (const std::string& text : several) {
            const std::size_t colon = text.find(':');
            Stated one{trimmed(std::string_view(text).substr(0, colon)), {}};
            for (std::size_t at = colon; at != std::string::npos;) {
                const std::size_t comma = text.find(',', at + 1);
                one.members.push_back(
                    trimmed(std::string_view(text).substr(at + 1, comma == std::string::npos ? comma : comma - at - 1)));
                at = comma;
            }
            const bool gap = std::any_of(one.members.begin(), one.members.end(), [](const auto& name) { return name.empty(); });
            if (one.type.empty() || one.members.empty() || gap)
                fail_usage("'" + printable(text, 60) + "' is not a relationship",
                           "write --relation 'TYPE: A, B', with ids or tags");
            list.push_back(std::move(one));
        }
        return list;
    }

    Relationship add(const Stated& one, RelationGraph& relations, Report& report) const {
        Relationship relationship;
        const RelationType* known = find_relation_type(one.type);
        relationship.type = own_name(one.type);
        relationship.directed = directed || (known != nullptr && known->directed);
        for (const auto& name : one.members)
            relationship.annotations.push_back(find_annotation(set(), name, annotations.file()).id);
        relationship.is_constraint = is_constraint || !parameters.empty() || (known != nullptr && !known->geometric);
        relationship.weight = weight;
        relationship.constraint = parameters;
        relationship.origin = "stated";
        relationship.parameters.attribute = attribute;
        for (const std::string& text : tolerances) {
            const Tolerance tolerance = tolerance_of(text, relationship.type);
            const double share = tolerance.of_diagonal ? box_diagonal(mesh->mesh) / 100 : 1;
            relationship.parameters.deviations.push_back({tolerance.quantity,
                                                          {},
                                                          tolerance.value * share,
                                                          tolerance.is_length  ? set().unit
                                                          : tolerance.is_angle ? "degree"
                                                                               : "%"});
        }
        relationship.id = free_id(relations);
        check_relationship(relationship, set(), "the relationship to add");
        if (const Relationship* twin = find_twin(relations, relationship)) {
            const std::string id = std::to_string(twin->id);
            if (twin->origin != "extracted")
                fail_input(graph.file(), "relationship " + id + " says the same",
                           "remove it first: 'ostraka relation remove ... --id " + id + "'");
            relationship.id = twin->id;
            report.note("relationship " + id + " was extracted and is stated now");
            relations.relationships[static_cast<std::size_t>(twin - relations.relationships.data())] = relationship;
        } else {
            relations.relationships.push_back(relationship);
        }
        return relationship;
    }

    struct Tolerance {
        std::string quantity;
        double value;
        bool of_diagonal, is_length, is_angle;
    };

    static std::string own_name(const std::string& type) {
        const RelationType* known = find_relation_type(type);
        return known == nullptr ? type : known->name;
    }

    static Tolerance tolerance_of(const std::string& text, const std::string& type) {
        const std::size_t sign = text.find('=');
        double value = 0;
        const bool percent = text.ends_with('%');
        const char* end = text.data() + text.size() - (percent ? 1 : 0);
        const bool named = sign != std::string::npos && text.data() + sign + 1 < end;
        const auto [rest, code] = std::from_chars(named ? text.data() + sign + 1 : end, end, value);
        if (!named || rest != end || code != std::errc() || !std::isfinite(value))
            fail_usage("'" + printable(text, 60) + "' is not a tolerance", "write QUANTITY=NUMBER, e.g. angle=5 or distance=1%");
        if (value < 0) fail_usage("the tolerance '" + printable(text, 60) + "' is negative", "use 0 or more");
        const std::string quantity = text.substr(0, sign);
        const auto measured = measured_quantities(type);
        if (std::find(measured.begin(), measured.end(), quantity) == measured.end())
            fail_usage("'" + type + "' does not measure '" + quantity + "'",
                       measured.empty() ? "leave the tolerance out" : "it measures " + joined(measured));
        const bool length = quantity == "distance" || quantity == "height", angle = quantity == "angle" || quantity == "tilt";
        if (percent && angle) fail_usage("'" + text + "' is not a tolerance", "give an angle in degrees, without '%'");
        return {quantity, value, percent && length, length, angle};
    }

    std::string type, parameters, attribute;
    std::vector<std::string> members, several, tolerances;
    double weight = 1;
    bool directed = false, is_constraint = false, own_type = false;
};

struct RelationRemove final : RelationOperation {
    void describe(Parameters& p) override {
        describe_inputs(p);
        describe_graph(p);
        describe_output(p);
        p.options("id", ids, "id of a relationship, as 'relation list' shows it; once for each").words().required();
        describe_relationships(p.report);
    }

    void run(Context&, Report& report) override {
        RelationGraph relations = read_relations();
        std::vector<Relationship> removed;
        for (const int id : ids) {
            const auto has_id = [&](const Relationship& relationship) { return relationship.id == id; };
            const auto place = std::find_if(relations.relationships.begin(), relations.relationships.end(), has_id);
            if (place != relations.relationships.end()) {
                removed.push_back(std::move(*place));
                relations.relationships.erase(place);
            } else if (std::none_of(removed.begin(), removed.end(), has_id)) {
                fail_input(graph.file(), "has no relationship " + std::to_string(id), "'ostraka relation list' shows them");
            }
        }
        output.write(std::move(relations), set());
        report_result(report, removed);
    }

    std::vector<int> ids;
};

struct RelationEdit final : RelationOperation {
    void describe(Parameters& p) override {
        describe_inputs(p);
        describe_graph(p);
        describe_output(p);
        p.options("id", id, "id of the relationship, as 'relation list' shows it", Range{0, 2147483647}).required();
        p.options("weight", weight, "its weight as a constraint; 0 leaves it out", Range{0, 1e300});
        p.options("range", range, "MIN,MAX: minValue and maxValue of the constraint");
        p.options("parameters", parameters, "JSON object whose members replace those of the constraint; null removes one");
        p.options("constraint", constraint, "whether the relationship is a constraint on deformations",
                  Choices{"unchanged", "yes", "no"});
        describe_relationships(p.report);
    }

    void check() const override {
        if (!weight && range.empty() && parameters.empty() && constraint == Constrains::unchanged)
            fail_usage("nothing is changed", "give --weight, --range, --parameters or --constraint");
        if (!range.empty()) {
            const std::vector<double> ends = numbers_of<double>(range, "--range");
            if (ends.size() != 2 || !(ends[0] <= ends[1]))
                fail_usage("--range is '" + printable(range, 60) + "'", "give two numbers, the smaller first: 1.5,2");
        }
        if (!parameters.empty() && !parse_json(parameters, "--parameters").IsObject())
            fail_usage("--parameters is no JSON object", "write {\"hard\": true}, for example");
    }

    void run(Context&, Report& report) override {
        RelationGraph relations = read_relations();
        const auto found = std::find_if(relations.relationships.begin(), relations.relationships.end(),
                                        [&](const Relationship& one) { return one.id == id; });
        if (found == relations.relationships.end())
            fail_input(graph.file(), "has no relationship " + std::to_string(id), "'ostraka relation list' shows them");
        Relationship changed = *found;
        if (weight) changed.weight = *weight;
        if (constraint != Constrains::unchanged) changed.is_constraint = constraint == Constrains::yes;
        if (!range.empty() || !parameters.empty()) {
            if (constraint != Constrains::no) changed.is_constraint = true;
            Json object = changed.constraint.empty() ? parse_json("{}", "the constraint")
                                                     : parse_json(changed.constraint, "the constraint");
            const auto set_member = [&](const std::string& name, JsonValue value) {
                object.RemoveMember(name.c_str());
                if (!value.IsNull()) add_member(object, name, std::move(value), object.GetAllocator());
            };
            if (!parameters.empty())
                for (const Json given = parse_json(parameters, "--parameters"); const auto& member : given.GetObject())
                    set_member(member.name.GetString(), JsonValue(member.value, object.GetAllocator()));
            if (!range.empty()) {
                const std::vector<double> ends = numbers_of<double>(range, "--range");
                set_member("minValue", JsonValue(ends[0]));
                set_member("maxValue", JsonValue(ends[1]));
            }
            changed.constraint = object.MemberCount() == 0 ? std::string() : to_compact_text(object);
        }
        // Changed by a person: further extractions must keep it.
        changed.origin = "stated";
        *found = changed;
        check_graph(relations, set(), output.file());
        if (changed.is_constraint) check_constraint(mesh->mesh, set(), changed, output.file());
        output.write(std::move(relations), set());
        report_result(report, std::vector<Relationship>{changed});
    }

    enum class Constrains { unchanged, yes, no };
    int id = -1;
    std::optional<double> weight;
    std::string range, parameters;
    Constrains constraint = Constrains::unchanged;
};

struct RelationList final : RelationOperation {
    void describe(Parameters& p) override {
        describe_inputs(p);
        describe_graph(p);
        describe_relationships(p.report);
    }
    void run(Context&, Report& report) override { report_result(report, read_relations().relationships); }
};

struct RelationCheckAll final : RelationOperation {
    void describe(Parameters& p) override {
        describe_inputs(p);
        describe_graph(p);
        p.input_option("rest", Kind::mesh, rest,
                       "the same mesh in its rest shape: constraints that preserve something are evaluated against it");
        p.input_option("rules", Kind::rules, rules, "rules of the class (.rules.json) that are checked as well");
        p.input_option("vocabulary", Kind::vocabulary, vocabulary,
                       "vocabulary (.vocabulary.json, .ttl, .rdf): rules also apply to narrower concepts");
        tolerances.describe(p.options);
        describe_relationships(p.report, true);
        for (const char* verdict : {"holds", "fails", "unknown"}) p.report.values(integer(verdict));
        p.report.table("rules", text("rule", "rule"), integer("annotation", "id"), text("part", "part"), text("text", "broken"));
        p.report.values(boolean("conforms"));
    }

    void check() const override {
        if (vocabulary && !rules) fail_usage("--vocabulary goes with --rules", "add --rules FILE");
    }

    void run(Context&, Report& report) override {
        const RelationGraph relations = read_relations();
        const std::vector<RelationCheck> checks = in_file(rest ? rest.file() : annotations.file(), [&] {
            return judge_relationships(mesh->mesh, set(), relations, rest ? &rest->mesh : nullptr, tolerances, graph.file());
        });
        std::array<std::size_t, 3> counts{};
        report.empty_table("relationships");
        for (std::size_t i = 0; i < checks.size(); ++i) {
            Relationship relationship = relations.relationships[i];
            relationship.parameters = checks[i].parameters;
            ++counts.at(static_cast<std::size_t>(checks[i].verdict));
            report_result(report, relationship)("verdict", to_string(checks[i].verdict))("text", checks[i].text);
        }
        for (const Verdict verdict : {Verdict::holds, Verdict::fails, Verdict::unknown})
            report(to_string(verdict), counts.at(static_cast<std::size_t>(verdict)));
        report.line(std::to_string(counts[0]) + " hold, " + std::to_string(counts[1]) + " fail, " + std::to_string(counts[2]) +
                    " unknown");
        const std::size_t broken = rules ? report_rules(report, relations) : 0;
        const bool conforms = counts[1] + broken == 0;
        report("conforms", conforms);
        if (!conforms) report.answer_no();
    }

    /// Reports the violated rules; returns their number.
    std::size_t report_rules(Report& report, const RelationGraph& relations) const {
        const ClassRules& kept = rules.load<ClassRules>(read_class_rules);
        const Vocabulary* words = vocabulary ? &vocabulary.load<Vocabulary>(read_vocabulary) : nullptr;
        const std::vector<RuleViolation> broken = broken_rules(mesh->mesh, set(), kept, words, &relations, rules.file());
        report.empty_table("rules");
        std::set<std::string> names;
        for (const RuleViolation& one : broken) {
            names.insert(one.rule);
            Report::Row row = report.row("rules");
            row("rule", one.rule)("text", one.text);
            if (!one.annotation) continue;
            row("annotation", *one.annotation)("part", set().find(*one.annotation)->tag);
        }
        report.line(counted(names.size(), "rule") + " of " + std::to_string(kept.rules.size()) + " for '" +
                    printable(kept.object_class, 60) + "' broken");
        return names.size();
    }

    FileInput rules, vocabulary;
    MeshInput rest;
    RelationOptions tolerances;
};

struct RelationExport final : RelationOperation {
    void describe(Parameters& p) override {
        describe_inputs(p);
        describe_graph(p);
        p.output("output", Kind::text, output, "drawing to write (.svg, .pdf, .png), or a file for Graphviz (.dot, .gv)");
        for (const char* count : {"relationships", "annotations"}) p.report.values(integer(count, count));
    }

    void check() const override {
        const std::string kind = extension(output.file());
        const std::initializer_list<const char*> known{".dot", ".gv", ".svg", ".pdf", ".png"};
        if (!output.file().empty() && std::find(known.begin(), known.end(), kind) == known.end())
            fail_usage("'" + output.file() + "' is neither a drawing nor a Graphviz file",
                       "end its name in .svg, .pdf, .png, .dot or .gv");
    }

    void run(Context&, Report& report) override {
        const RelationGraph relations = read_relations();
        const std::string kind = extension(output.file());
        if (kind == ".svg" || kind == ".pdf" || kind == ".png") write_plot(output.path(), drawn(relations));
        else output.write(graph_to_dot(relations, set()));
        report("relationships", relations.relationships.size())("annotations", set().annotations.size());
    }

    [[nodiscard]] BracketGraph drawn(const RelationGraph& relations) {
        const GraphLayout layout = layout_of(relations, set(), topology(mesh->mesh, set()).order);
        BracketGraph drawing;
        std::map<int, std::size_t> row_of;
        for (const TreeEntry& row : layout.rows) {
            const Annotation& one = set().annotations[row.annotation];
            row_of[one.id] = drawing.rows.size();
            const auto channel = [&](std::size_t k) { return static_cast<std::uint8_t>(std::clamp(one.colour[k], 0, 255)); };
            drawing.rows.push_back({one.tag.empty() ? "annotation " + std::to_string(one.id) : one.tag,
                                    static_cast<int>(row.depth),
                                    {channel(0), channel(1), channel(2)}});
        }
        for (std::size_t i = 0; i < layout.lanes.size(); ++i) {
            if (!layout.lanes[i]) continue;
            const Relationship& one = relations.relationships[i];
            BracketGraph::Bracket& bracket = drawing.brackets.emplace_back();
            bracket.type = one.type;
            bracket.lane = *layout.lanes[i];
            bracket.strong = one.is_constraint;
            bracket.directed = one.directed;
            for (const int id : one.annotations)
                if (const auto at = row_of.find(id); at != row_of.end()) bracket.rows.push_back(at->second);
        }
        return drawing;
    }

    FileOutput output{".dot"};
};

}  // namespace

std::unique_ptr<Operation> make_relation_extract() { return make<RelationExtract>(); }
std::unique_ptr<Operation> make_relation_add() { return make<RelationAdd>(); }
std::unique_ptr<Operation> make_relation_remove() { return make<RelationRemove>(); }
std::unique_ptr<Operation> make_relation_edit() { return make<RelationEdit>(); }
std::unique_ptr<Operation> make_relation_list() { return make<RelationList>(); }
std::unique_ptr<Operation> make_relation_check() { return make<RelationCheckAll>(); }
std::unique_ptr<Operation> make_relation_export() { return make<RelationExport>(); }

}  // namespace ostraka

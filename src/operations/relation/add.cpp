// relation add
#include "operations/relation/relation_operation.h"

#include "ostraka/relation/geometric.h"
#include "ostraka/semantic/deform.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace ostraka {

namespace {

struct RelationAdd final : RelationOperation {
    void declare(Parameters& p) override {
        declare_inputs(p);
        p.input_option("graph", Kind::graph, graph,
                       "graph to which the relationship is added; created if the file does not exist");
        p.output("output", Kind::graph, output, "graph to write (.graph.json); if left out, the file of --graph is updated")
            .optional()
            .updates(graph);
        Words known{{}, "or a user-defined type with --own-type"};
        for (const RelationType& one : relation_types()) known.names.push_back(one.name);
        p.options("type", type, "type of the relationship", std::move(known));
        p.options("annotation", members, "id or tag of a member of the relationship, once per member; the first is the subject")
            .words();
        p.options("relation", several,
                  "TYPE: A, B, ...: type and members of a relationship, instead of --type and --annotation; may be given more "
                  "than once; the other options apply to all relationships")
            .words();
        p.options("own-type", own_type, "the type in --type is user-defined");
        p.options("directed", directed, "the relationship is directed: the first annotation is its subject");
        p.options("constraint", is_constraint, "the relationship is a constraint on deformations");
        p.options("parameters", parameters, "JSON object with the parameters of the constraint");
        p.options("weight", weight, "weight of the constraint", Range{0, 1e300});
        p.options("tolerance", tolerances,
                  "QUANTITY=NUMBER: tolerance when the relationship is checked: angle=5 (or tilt; degrees), distance=2 (or "
                  "height; unit of the mesh), distance=1% (of the mesh's diagonal), area=10 (or shape, difference; per cent)")
            .words();
        p.options("attribute", attribute, "with --type 'equal attributes': name of the attribute whose values are equal");
        declare_relationships(p.report);
    }

    void check() const override {
        if (!output && !graph) fail_usage("no file for the graph is given", "give a file to write, or --graph");
        if (graph && !graph.exists() && output.file() != graph.file())
            fail_input(graph.file(), "cannot be opened for reading",
                       "check the name; if --output is left out, a new graph is created");
        if (!several.empty() && (!type.empty() || !members.empty()))
            fail_usage("--relation with --type or --annotation",
                       "use one form only: --relation 'TYPE: A, B', once per relationship");
        if (several.empty() && type.empty())
            fail_usage("the type of the relationship is missing", "add --type, or --relation 'TYPE: A, B'");
        if (several.empty() && members.empty())
            fail_usage("the annotations of the relationship are missing", "add --annotation, once for each member");
        for (const Stated& one : stated()) {
            if (find_relation_type(one.type) == nullptr && !own_type)
                fail_usage("'" + printable(one.type, 60) + "' is not a known type of relationship",
                           "did you mean '" + nearest_relation_type(one.type) + "'? --own-type adds a type of your own");
            if (own_name(one.type) == "equal attributes" && attribute.empty())
                fail_usage("the name of the equal attribute is missing", "add --attribute NAME");
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
                check_constraint(object(), relationship, output.file());
            } catch (const Error& error) {
                if (error.kind() == ErrorKind::cancelled) throw;
                report.note(std::string("'deform' will refuse this constraint: ") + error.what());
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
        if (const Relationship* twin = find_equivalent(relations, relationship)) {
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

}  // namespace

std::unique_ptr<Operation> make_relation_add() { return make<RelationAdd>(); }

}  // namespace ostraka

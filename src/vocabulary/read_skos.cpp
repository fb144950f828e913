// Converts SKOS to a vocabulary.
#include "vocabulary/owl.h"
#include "vocabulary/rdf.h"
#include "vocabulary/rules_json.h"
#include "vocabulary/skos_terms.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/vocabulary/skos.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

namespace ostraka {

namespace {

using Kind = RdfTerm::Kind;
using std::to_string;

/// Statements by subject, with a record of those that were used.
class Graph {
public:
    explicit Graph(std::vector<RdfStatement> statements) : statements_(std::move(statements)) {
        for (std::size_t i = 0; i < statements_.size(); ++i) by_subject_[statements_[i].subject].push_back(i);
    }
    [[nodiscard]] const std::vector<RdfStatement>& statements() const { return statements_; }
    template <class Use>
    void each(const RdfTerm& subject, Use&& use) const {
        const auto entry = by_subject_.find(subject);
        if (entry == by_subject_.end()) return;
        for (const std::size_t i : entry->second) use(statements_[i].predicate, statements_[i].object);
    }
    [[nodiscard]] std::vector<RdfTerm> values(const RdfTerm& subject, const std::string& property) const {
        std::vector<RdfTerm> objects;
        each(subject, [&](const std::string& predicate, const RdfTerm& object) {
            if (predicate == property) objects.push_back(object);
        });
        return objects;
    }

private:
    std::vector<RdfStatement> statements_;
    std::map<RdfTerm, std::vector<std::size_t>> by_subject_;
};

class SkosReader {
public:
    SkosReader(std::vector<RdfStatement> statements, std::string where, const std::string& scheme)
        : graph_(std::move(statements)), where_(std::move(where)) {
        find_scheme(scheme);
        find_concepts();
        vocabulary_.uri = scheme_ == skos::default_scheme ? "" : scheme_;
        read_scheme();
        name_concepts();
        for (const RdfTerm& term : concepts_) read_concept(term);
        join_narrower();
        for (Concept& entry : vocabulary_.concepts) {
            sort(entry.broader);
            sort(entry.part_of);
            sort(entry.others);
            for (auto& [language, labels] : entry.alternatives) sort(labels);
        }
        sort(vocabulary_.others);
        for (const auto& [property, count] : dropped_counts_)
            vocabulary_.notes.push_back(fmt::format("{}{} not kept: <{}> of an unnamed node", count,
                                                    count == 1 ? " statement" : " statements", property));
        if (external_concepts_ > 0)
            vocabulary_.notes.push_back(to_string(external_concepts_) +
                                        " broader concepts are unknown or belong to other schemes; they are kept unchanged");
        note_unread();
        check_vocabulary(vocabulary_, where_);
    }
    Vocabulary result() { return std::move(vocabulary_); }

private:
    template <class T>
    static void sort(std::vector<T>& values) {
        std::sort(values.begin(), values.end());
        values.erase(std::unique(values.begin(), values.end()), values.end());
    }
    [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const { fail_input(where_, problem, remedy); }
    static RdfTerm uri(const std::string& text) { return {Kind::uri, text, {}, {}}; }

    void find_scheme(const std::string& requested) {
        std::vector<std::string> declared;
        for (const RdfStatement& statement : graph_.statements())
            if (statement.predicate == skos::rdf + "type" && statement.object == uri(skos::core + "ConceptScheme") &&
                statement.subject.kind == Kind::uri)
                declared.push_back(statement.subject.value);
        sort(declared);
        scheme_ = requested;
        if (!requested.empty()) {
            if (!std::binary_search(declared.begin(), declared.end(), requested))
                fail(fmt::format("has no concept scheme <{}>", requested),
                     declared.empty() ? "it declares none" : fmt::format("it has <{}>", declared.front()));
        } else if (declared.size() > 1) {
            fail(fmt::format("has {} concept schemes: <{}>, <{}> ...", declared.size(), declared[0], declared[1]),
                 "choose one with --scheme");
        } else {
            scheme_ = declared.empty() ? skos::default_scheme : declared.front();
        }
    }

    /// Finds the concepts: resources declared as concepts, in a scheme, or with a broader or narrower concept, unless they
    /// belong only to other schemes.
    void find_concepts() {
        std::set<RdfTerm> visited, in_other_schemes;
        std::size_t unnamed = 0;
        for (const auto& [subject, predicate, object] : graph_.statements())
            if (predicate == skos::core + "inScheme" && object.kind == Kind::uri && object.value != scheme_)
                in_other_schemes.insert(subject);
        for (const auto& [subject, predicate, object] : graph_.statements())
            if (predicate == skos::core + "inScheme" && object.kind == Kind::uri && object.value == scheme_)
                in_other_schemes.erase(subject);
        const auto add = [&](const RdfTerm& term) {
            if (in_other_schemes.contains(term) || !visited.insert(term).second) return;
            if (term.kind == Kind::uri) concepts_.push_back(term);
            else if (term.kind == Kind::blank) ++unnamed;
        };
        for (const auto& [subject, predicate, object] : graph_.statements()) {
            if (predicate == skos::rdf + "type" && object == uri(skos::core + "Concept")) add(subject);
            if (predicate == skos::core + "inScheme" || predicate == skos::core + "topConceptOf") add(subject);
            if (predicate == skos::core + "hasTopConcept") add(object);
            if (predicate == skos::core + "broader" || predicate == skos::core + "narrower") add(subject);
        }
        if (unnamed > 0) vocabulary_.notes.push_back(to_string(unnamed) + " concepts without a URI not kept");
        if (!in_other_schemes.empty())
            vocabulary_.notes.push_back(counted(in_other_schemes.size(), "concept") +
                                        " of other schemes not kept (see --scheme)");
        if (concepts_.empty())
            fail("contains no SKOS concept", "give a SKOS vocabulary (skos:Concept), or an ontology (owl:Class)");
        std::map<RdfTerm, std::size_t> positions;
        for (const RdfTerm& term : concepts_)
            if (const auto position = position_of(term)) positions[term] = *position;
        if (positions.size() == concepts_.size())
            std::stable_sort(concepts_.begin(), concepts_.end(),
                             [&](const RdfTerm& a, const RdfTerm& b) { return positions.at(a) < positions.at(b); });
    }

    /// Assigns ids: the id stated in the file; otherwise the URI without the vocabulary's namespace, or else its last part. A
    /// candidate that is empty or not unique is replaced by the whole URI.
    void name_concepts() {
        const std::string prefix = skos::namespace_of(vocabulary_.uri), slash = vocabulary_.uri + "/";
        std::map<std::string, std::size_t> names;
        std::vector<std::string> local_names(concepts_.size());
        for (std::size_t i = 0; i < concepts_.size(); ++i) {
            const std::string& text = concepts_[i].value;
            const bool is_local = text.starts_with(prefix) && text.size() > prefix.size();
            local_names[i] =
                skos::percent_decoded(is_local ? text.substr(prefix.size()) : text.substr(text.find_last_of("/#") + 1));
            if (const auto declared_id = graph_.values(concepts_[i], skos::ostraka_ns + "id");
                declared_id.size() == 1 && declared_id.front().kind == Kind::text)
                local_names[i] = declared_id.front().value;
            ++names[local_names[i]];
        }
        for (std::size_t i = 0; i < concepts_.size(); ++i) {
            const std::string& text = concepts_[i].value;
            const std::string id = local_names[i].empty() || names[local_names[i]] > 1 ? text : local_names[i];
            ids_[text] = id;
            Concept entry;
            entry.id = id;
            if (prefix + percent_encoded(id) != text) entry.uri = text;
            vocabulary_.concepts.push_back(std::move(entry));
            index_[text] = i;
        }
    }

    [[nodiscard]] std::optional<std::size_t> position_of(const RdfTerm& subject) const {
        const auto values = graph_.values(subject, skos::ostraka_ns + "position");
        std::size_t number = 0;
        if (values.size() != 1) return std::nullopt;
        const std::string& text = values.front().value;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        return error == std::errc() && end == text.data() + text.size() ? std::optional<std::size_t>(number) : std::nullopt;
    }

    /// Stores the first text of each language; returns false if the language already has one.
    static bool put(Labels& labels, const RdfTerm& text) { return labels.emplace(text.language, text.value).second; }

    void keep(std::vector<ForeignStatement>& statements, const std::string& property, const RdfTerm& value) {
        if (value.kind == Kind::blank) ++dropped_counts_[property];
        else statements.push_back({property, value.value, value.kind == Kind::uri, value.language, value.datatype});
    }

    void read_scheme() {
        const RdfTerm scheme = uri(scheme_);
        std::string title_property;
        for (const std::string& property : {skos::dcterms + "title", std::string("http://purl.org/dc/elements/1.1/title"),
                                            skos::core + "prefLabel", skos::rdfs + "label"})
            if (title_property.empty() && !graph_.values(scheme, property).empty()) title_property = property;
        graph_.each(scheme, [&](const std::string& property, const RdfTerm& value) {
            if (property == skos::rdf + "type" && value == uri(skos::core + "ConceptScheme")) return;
            if (property == skos::core + "hasTopConcept" || property == skos::ostraka_ns + "attribute") return;
            if (property == skos::ostraka_ns + "rules") return read_rules(value);
            if (property == title_property && value.kind == Kind::text && value.datatype.empty() && put(vocabulary_.title, value))
                return;
            keep(vocabulary_.others, property, value);
        });
        vocabulary_.attributes = attributes_of(scheme);
    }

    void read_rules(const RdfTerm& value) {
        const std::string where = where_ + ", ostraka:rules";
        const Json parsed_rules = parse_json(value.value, where);
        for (auto& rule : rules_from_json(parsed_rules, where)) vocabulary_.rules.push_back(std::move(rule));
    }

    void read_concept(const RdfTerm& term) {
        Concept& entry = vocabulary_.concepts[index_.at(term.value)];
        graph_.each(term, [&](const std::string& property, const RdfTerm& value) {
            const bool text = value.kind == Kind::text && (value.datatype.empty() || value.datatype == skos::xsd + "string");
            if (property == skos::rdf + "type" && value == uri(skos::core + "Concept")) return;
            if ((property == skos::core + "inScheme" || property == skos::core + "topConceptOf") && value == uri(scheme_)) return;
            if (property == skos::ostraka_ns + "position" || property == skos::ostraka_ns + "attribute" ||
                property == skos::ostraka_ns + "id")
                return;
            if (property == skos::core + "prefLabel" && text) {
                if (!put(entry.labels, value)) entry.alternatives[value.language].push_back(value.value);
                return;
            }
            if (property == skos::core + "altLabel" && text) {
                entry.alternatives[value.language].push_back(value.value);
                return;
            }
            if (property == skos::core + "definition" && text && put(entry.definition, value)) return;
            if (property == skos::core + "broader" && value.kind == Kind::uri) {
                if (const auto match = ids_.find(value.value); match != ids_.end()) {
                    entry.broader.push_back(match->second);
                    return;
                }
                ++external_concepts_;
            }
            if (property == skos::core + "narrower" && value.kind == Kind::uri && ids_.contains(value.value)) return;
            if (property == skos::thesaurus + "broaderPartitive" && value.kind == Kind::uri)
                if (const auto match = ids_.find(value.value); match != ids_.end()) {
                    entry.part_of.push_back(match->second);
                    return;
                }
            if (property == skos::thesaurus + "narrowerPartitive" && value.kind == Kind::uri && ids_.contains(value.value))
                return;
            keep(entry.others, property, value);
        });
        entry.attributes = attributes_of(term);
    }

    void join_narrower() {
        for (const RdfTerm& term : concepts_)
            for (const RdfTerm& other : graph_.values(term, skos::core + "narrower"))
                if (const auto match = index_.find(other.value); match != index_.end() && other.kind == Kind::uri)
                    vocabulary_.concepts[match->second].broader.push_back(ids_.at(term.value));
        for (const RdfTerm& term : concepts_)
            for (const RdfTerm& other : graph_.values(term, skos::thesaurus + "narrowerPartitive"))
                if (const auto match = index_.find(other.value); match != index_.end() && other.kind == Kind::uri)
                    vocabulary_.concepts[match->second].part_of.push_back(ids_.at(term.value));
    }

    /// Name for messages: the first label, or the URI.
    [[nodiscard]] std::string description_of(const RdfTerm& subject) const {
        for (const std::string& property : {skos::core + "prefLabel", skos::rdfs + "label", skos::dcterms + "title"})
            for (const RdfTerm& value : graph_.values(subject, property))
                if (value.kind == Kind::text) return fmt::format("'{}'", value.value);
        return subject.kind == Kind::uri ? fmt::format("<{}>", subject.value) : "an unnamed collection";
    }

    /// Number of concepts and collections listed by a collection.
    [[nodiscard]] std::size_t members_of(const RdfTerm& collection) const {
        std::size_t count = graph_.values(collection, skos::core + "member").size();
        for (RdfTerm cell : graph_.values(collection, skos::core + "memberList"))
            for (std::set<RdfTerm> visited; visited.insert(cell).second;) {  // stops at cyclic lists
                count += graph_.values(cell, skos::rdf + "first").size();
                const auto tail = graph_.values(cell, skos::rdf + "rest");
                if (tail.empty()) break;
                cell = tail.front();
            }
        return count;
    }

    /// Notes resources of the file that are not concepts of this scheme: collections by name, others with a URI by type.
    void note_unread() {
        std::vector<std::string> collections;
        std::size_t members = 0, labels = 0, others = 0;
        std::set<RdfTerm> visited{uri(scheme_)};
        for (const RdfStatement& statement : graph_.statements()) {
            const RdfTerm& subject = statement.subject;
            if (index_.contains(subject.value) || !visited.insert(subject).second) continue;
            const auto types = graph_.values(subject, skos::rdf + "type");
            const auto is_a = [&](const std::string& type) {
                return std::find(types.begin(), types.end(), uri(type)) != types.end();
            };
            if (is_a(skos::core + "Collection") || is_a(skos::core + "OrderedCollection")) {
                collections.push_back(description_of(subject));
                members += members_of(subject);
            } else if (is_a(skos::xl + "Label")) {
                ++labels;
            } else if (subject.kind == Kind::uri && !is_a(skos::core + "Concept") && !is_a(skos::core + "ConceptScheme")) {
                ++others;
            }
        }
        if (!collections.empty()) {
            const std::size_t count = collections.size();
            if (count > 5) collections.resize(5);
            vocabulary_.notes.push_back(fmt::format("{} with {} not kept: {}{}", counted(count, "collection"),
                                                    counted(members, "member"), joined(collections), count > 5 ? " ..." : ""));
        }
        if (labels > 0)
            vocabulary_.notes.push_back(counted(labels, "label") + " of SKOS-XL not used (give skos:prefLabel as well)");
        if (others > 0)
            vocabulary_.notes.push_back(
                fmt::format("statements about resources other than concepts are not kept: {}", counted(others, "resource")));
    }

    /// The nodes sorted by their positions, if they have any.
    [[nodiscard]] std::vector<RdfTerm> ordered(const RdfTerm& owner, const std::string& property) const {
        std::vector<RdfTerm> nodes = graph_.values(owner, property);
        std::map<RdfTerm, std::size_t> positions;
        for (const RdfTerm& node : nodes) positions.emplace(node, position_of(node).value_or(nodes.size()));
        std::stable_sort(nodes.begin(), nodes.end(),
                         [&](const RdfTerm& a, const RdfTerm& b) { return positions.at(a) < positions.at(b); });
        return nodes;
    }

    [[nodiscard]] std::string name_of(const RdfTerm& node, const std::string& noun) const {
        const auto names = graph_.values(node, skos::ostraka_ns + "name");
        if (names.size() != 1 || names.front().kind != Kind::text || names.front().value.empty())
            fail(fmt::format("an {} without a name", noun), "give each one ostraka:name");
        return names.front().value;
    }

    [[nodiscard]] std::optional<double> optional_number(const RdfTerm& node, const std::string& name,
                                                        const std::string& attribute) const {
        const auto values = graph_.values(node, skos::ostraka_ns + name);
        if (values.empty()) return std::nullopt;
        double number = 0;
        const std::string& text = values.front().value;
        const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
        const auto [end, error] = std::from_chars(begin, text.data() + text.size(), number);
        if (values.size() > 1 || error != std::errc() || end != text.data() + text.size() || !std::isfinite(number))
            fail(fmt::format("the {} of the attribute '{}' is not a number: '{}'", name, attribute, text), "give one number");
        return number;
    }

    Labels labels_of(const RdfTerm& node, const std::string& property) const {
        Labels labels;
        for (const RdfTerm& value : graph_.values(node, property))
            if (value.kind == Kind::text) put(labels, value);
        return labels;
    }

    [[nodiscard]] std::vector<AllowedAttribute> attributes_of(const RdfTerm& owner) const {
        std::vector<AllowedAttribute> result;
        for (const RdfTerm& node : ordered(owner, skos::ostraka_ns + "attribute")) {
            AllowedAttribute attribute;
            attribute.name = name_of(node, "attribute");
            attribute.labels = labels_of(node, skos::core + "prefLabel");
            attribute.definition = labels_of(node, skos::core + "definition");
            attribute.min = optional_number(node, "minimum", attribute.name);
            attribute.max = optional_number(node, "maximum", attribute.name);
            if (const auto units = graph_.values(node, skos::ostraka_ns + "unit"); !units.empty())
                attribute.unit = units.front().value;
            for (const RdfTerm& term : ordered(node, skos::ostraka_ns + "value"))
                attribute.values.push_back({name_of(term, "attribute's value"), labels_of(term, skos::core + "prefLabel")});
            result.push_back(std::move(attribute));
        }
        return result;
    }

    Graph graph_;
    std::string where_, scheme_;
    std::vector<RdfTerm> concepts_;
    std::map<std::string, std::string> ids_;    ///< URI -> id
    std::map<std::string, std::size_t> index_;  ///< URI -> index of the concept
    std::map<std::string, std::size_t> dropped_counts_;
    std::size_t external_concepts_ = 0;
    Vocabulary vocabulary_;
};

}  // namespace

bool is_skos(const Path& file) {
    const std::string ending = extension(file);
    return skos::is_rdf_xml(file) || ending == ".ttl" || ending == ".turtle" || ending == ".nt";
}

Vocabulary vocabulary_from_skos(const std::string& text, bool rdf_xml, const std::string& where, const std::string& scheme) {
    std::vector<std::string> notes;
    std::vector<RdfStatement> statements =
        skos_of_owl(parse_rdf(text, rdf_xml ? RdfSyntax::rdf_xml : RdfSyntax::turtle, skos::default_scheme, where), notes);
    Vocabulary vocabulary = SkosReader(std::move(statements), where, scheme).result();
    vocabulary.notes.insert(vocabulary.notes.begin(), notes.begin(), notes.end());
    return vocabulary;
}

Vocabulary read_skos(const Path& file, const std::string& scheme) {
    return vocabulary_from_skos(read_file(file), skos::is_rdf_xml(file), file.string(), scheme);
}

}  // namespace ostraka

#include "vocabulary/owl.h"

#include "vocabulary/skos_terms.h"

#include "ostraka/core/message_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace ostraka {

namespace {

const std::string owl = "http://www.w3.org/2002/07/owl#";
const std::string obo = "http://purl.obolibrary.org/obo/";
const std::string obo_in_owl = "http://www.geneontology.org/formats/oboInOwl#";

RdfTerm owl_uri(const std::string& text) { return {RdfTerm::Kind::uri, text, {}, {}}; }

/// Only the letters, in lower case: "is part_of" and "isPartOf" are equal.
std::string letters_of(const std::string& text) {
    std::string letters;
    for (const char c : text) {
        if (c >= 'A' && c <= 'Z') letters += static_cast<char>(c + 32);
        else if (c != ' ' && c != '_' && c != '-') letters += c;
    }
    return letters;
}

enum class Partitive { part_of, has_part };

std::optional<Partitive> partitive_by_name(const std::string& name) {
    const std::string letters = letters_of(name);
    if (letters.ends_with("partof") || letters == "componentof") return Partitive::part_of;
    if ((letters.starts_with("has") && letters.ends_with("part")) || letters == "hascomponent") return Partitive::has_part;
    return std::nullopt;
}

class OwlReader {
public:
    explicit OwlReader(const std::vector<RdfStatement>& statements) : statements_(statements) {
        for (const RdfStatement& statement : statements) by_subject_[statement.subject].push_back(&statement);
        find_properties();
        for (const RdfStatement& statement : statements) {
            if (statement.predicate != skos::rdf + "type" || statement.subject.kind != RdfTerm::Kind::uri) continue;
            if (statement.object == owl_uri(owl + "Class") && statement.subject.value != owl + "Thing" &&
                statement.subject.value != owl + "Nothing")
                (is_deprecated(statement.subject) ? deprecated_ : classes_).insert(statement.subject);
            if (statement.object == owl_uri(owl + "Ontology")) ontologies_.insert(statement.subject);
        }
    }
    [[nodiscard]] bool has_classes() const { return !classes_.empty(); }

    std::vector<RdfStatement> translated(std::vector<std::string>& notes) {
        for (const RdfTerm& ontology : ontologies_) add(ontology, skos::rdf + "type", owl_uri(skos::core + "ConceptScheme"));
        for (const RdfTerm& owl_class : classes_) add(owl_class, skos::rdf + "type", owl_uri(skos::core + "Concept"));
        for (const RdfStatement& statement : statements_) {
            if (classes_.contains(statement.subject)) translate(statement);
            else if (ontologies_.contains(statement.subject) && statement.predicate == skos::rdfs + "label")
                add(statement.subject, skos::dcterms + "title", statement.object);
            else if (ontologies_.contains(statement.subject) && statement.predicate != skos::rdf + "type")
                translated_.push_back(statement);
        }
        if (!deprecated_.empty())
            notes.push_back(fmt::format("statements about {} are not kept", counted(deprecated_.size(), "deprecated concept")));
        if (untranslated_ > 0)
            notes.push_back(counted(untranslated_, "statement") +
                            " about classes not kept: restrictions on properties other than part-of, unions and similar");
        return std::move(translated_);
    }

private:
    [[nodiscard]] std::vector<RdfTerm> values(const RdfTerm& subject, const std::string& property) const {
        std::vector<RdfTerm> objects;
        if (const auto entry = by_subject_.find(subject); entry != by_subject_.end())
            for (const RdfStatement* statement : entry->second)
                if (statement->predicate == property) objects.push_back(statement->object);
        return objects;
    }
    [[nodiscard]] bool is_deprecated(const RdfTerm& subject) const {
        const auto marks = values(subject, owl + "deprecated");
        return std::any_of(marks.begin(), marks.end(),
                           [](const RdfTerm& mark) { return mark.value == "true" || mark.value == "1"; });
    }

    /// Finds part-of properties by their names and labels, then their subproperties and inverses.
    void find_properties() {
        std::vector<RdfTerm> properties;
        const auto add_property = [&](const RdfTerm& property, Partitive kind) {
            if (partitive_.emplace(property, kind).second) properties.push_back(property);
        };
        std::map<RdfTerm, std::vector<RdfTerm>> subproperties, inverse;
        for (const auto& [subject, predicate, object] : statements_) {
            if (predicate == owl + "onProperty") {
                const std::string& uri = object.value;
                if (uri == obo + "BFO_0000050") add_property(object, Partitive::part_of);
                else if (uri == obo + "BFO_0000051") add_property(object, Partitive::has_part);
                else if (const auto kind = partitive_by_name(uri.substr(uri.find_last_of("/#") + 1))) add_property(object, *kind);
                else
                    for (const RdfTerm& label : values(object, skos::rdfs + "label"))
                        if (const auto by_label = partitive_by_name(label.value)) add_property(object, *by_label);
            }
            if (predicate == skos::rdfs + "subPropertyOf") {
                subproperties[object].push_back(subject);
                if (const auto kind = partitive_by_name(object.value.substr(object.value.find_last_of("/#") + 1)))
                    add_property(object, *kind);
            }
            if (predicate == owl + "inverseOf") inverse[subject].push_back(object), inverse[object].push_back(subject);
        }
        for (std::size_t i = 0; i < properties.size(); ++i) {
            const RdfTerm property = properties[i];
            const Partitive kind = partitive_.at(property);
            for (const RdfTerm& related : subproperties[property]) add_property(related, kind);
            for (const RdfTerm& related : inverse[property])
                add_property(related, kind == Partitive::part_of ? Partitive::has_part : Partitive::part_of);
        }
    }

    void add(const RdfTerm& subject, const std::string& predicate, const RdfTerm& object) {
        translated_.push_back({subject, predicate, object});
    }

    void translate(const RdfStatement& statement) {
        const std::string& property = statement.predicate;
        if (property == skos::rdf + "type") return;
        if (property == skos::rdfs + "label") return add(statement.subject, skos::core + "prefLabel", statement.object);
        if (property == obo_in_owl + "hasExactSynonym" || property == obo_in_owl + "hasRelatedSynonym")
            return add(statement.subject, skos::core + "altLabel", statement.object);
        if (property == obo + "IAO_0000115" ||
            (property == skos::rdfs + "comment" && values(statement.subject, obo + "IAO_0000115").empty()))
            return add(statement.subject, skos::core + "definition", statement.object);
        if (property == skos::rdfs + "subClassOf" || property == owl + "equivalentClass") {
            if (!translate_superclass(statement.subject, statement.object, property == owl + "equivalentClass")) ++untranslated_;
            return;
        }
        if (statement.object.kind == RdfTerm::Kind::blank) ++untranslated_;
        else translated_.push_back(statement);
    }

    /// Handles a superclass or a whole of a class; returns false if the object is neither.
    bool translate_superclass(const RdfTerm& subject, const RdfTerm& object, bool equivalent) {
        if (object.kind == RdfTerm::Kind::uri) {
            if (object.value == owl + "Thing" || deprecated_.contains(object)) return true;
            // Equivalent classes are not broader than each other.
            add(subject, skos::core + (equivalent ? "exactMatch" : "broader"), object);
            return true;
        }
        if (const auto lists = values(object, owl + "intersectionOf"); lists.size() == 1) {
            bool complete = true;
            RdfTerm cell = lists.front();
            for (std::set<RdfTerm> visited; visited.insert(cell).second;) {  // stops at cyclic lists
                for (const RdfTerm& member : values(cell, skos::rdf + "first"))
                    complete = (member.kind == RdfTerm::Kind::uri ? translate_superclass(subject, member, false)
                                                                  : partitive(subject, member)) &&
                               complete;
                const auto tail = values(cell, skos::rdf + "rest");
                if (tail.empty()) break;
                cell = tail.front();
            }
            return complete;
        }
        return partitive(subject, object);
    }

    /// Handles a restriction that states a whole of the class.
    bool partitive(const RdfTerm& subject, const RdfTerm& object) {
        const auto property = values(object, owl + "onProperty"), filler = values(object, owl + "someValuesFrom");
        if (property.size() != 1 || filler.size() != 1 || filler.front().kind != RdfTerm::Kind::uri) return false;
        const auto kind = partitive_.find(property.front());
        if (kind == partitive_.end() || !classes_.contains(filler.front()) || filler.front() == subject) return false;
        const bool part = kind->second == Partitive::part_of;
        add(part ? subject : filler.front(), skos::thesaurus + "broaderPartitive", part ? filler.front() : subject);
        return true;
    }

    const std::vector<RdfStatement>& statements_;
    std::map<RdfTerm, std::vector<const RdfStatement*>> by_subject_;
    std::map<RdfTerm, Partitive> partitive_;
    std::set<RdfTerm> classes_, deprecated_, ontologies_;
    std::vector<RdfStatement> translated_;
    std::size_t untranslated_ = 0;
};

}  // namespace

std::vector<RdfStatement> skos_of_owl(std::vector<RdfStatement> statements, std::vector<std::string>& notes) {
    for (const RdfStatement& statement : statements)
        if (statement.predicate.starts_with(skos::core) &&
            (statement.predicate == skos::core + "inScheme" || statement.predicate == skos::core + "broader"))
            return statements;
        else if (statement.predicate == skos::rdf + "type" && statement.object == owl_uri(skos::core + "Concept"))
            return statements;
    OwlReader reader(statements);
    return reader.has_classes() ? reader.translated(notes) : std::move(statements);
}

}  // namespace ostraka

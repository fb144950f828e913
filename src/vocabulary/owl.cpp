#include "owl.h"

#include "skos_terms.h"

#include "ostraka/core/words.h"

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
        for (const RdfStatement& one : statements) by_subject_[one.subject].push_back(&one);
        find_properties();
        for (const RdfStatement& one : statements) {
            if (one.predicate != skos::rdf + "type" || one.subject.kind != RdfTerm::Kind::uri) continue;
            if (one.object == owl_uri(owl + "Class") && one.subject.value != owl + "Thing" &&
                one.subject.value != owl + "Nothing")
                (is_deprecated(one.subject) ? deprecated_ : classes_).insert(one.subject);
            if (one.object == owl_uri(owl + "Ontology")) ontologies_.insert(one.subject);
        }
    }
    [[nodiscard]] bool has_classes() const { return !classes_.empty(); }

    std::vector<RdfStatement> translated(std::vector<std::string>& notes) {
        for (const RdfTerm& one : ontologies_) add(one, skos::rdf + "type", owl_uri(skos::core + "ConceptScheme"));
        for (const RdfTerm& one : classes_) add(one, skos::rdf + "type", owl_uri(skos::core + "Concept"));
        for (const RdfStatement& one : statements_) {
            if (classes_.contains(one.subject)) translate(one);
            else if (ontologies_.contains(one.subject) && one.predicate == skos::rdfs + "label")
                add(one.subject, skos::dcterms + "title", one.object);
            else if (ontologies_.contains(one.subject) && one.predicate != skos::rdf + "type") made_.push_back(one);
        }
        if (!deprecated_.empty())
            notes.push_back("what is said of " + counted(deprecated_.size(), "deprecated concept") + " is not kept");
        if (others_ > 0)
            notes.push_back(counted(others_, "statement") +
                            " of classes not kept: restrictions on other properties than part-of, unions and the like");
        return std::move(made_);
    }

private:
    [[nodiscard]] std::vector<RdfTerm> values(const RdfTerm& subject, const std::string& property) const {
        std::vector<RdfTerm> list;
        if (const auto found = by_subject_.find(subject); found != by_subject_.end())
            for (const RdfStatement* one : found->second)
                if (one->predicate == property) list.push_back(one->object);
        return list;
    }
    [[nodiscard]] bool is_deprecated(const RdfTerm& subject) const {
        const auto marks = values(subject, owl + "deprecated");
        return std::any_of(marks.begin(), marks.end(),
                           [](const RdfTerm& mark) { return mark.value == "true" || mark.value == "1"; });
    }

    /// Finds part-of properties by their names and labels, then their subproperties and inverses.
    void find_properties() {
        std::vector<RdfTerm> found;
        const auto take = [&](const RdfTerm& property, Partitive kind) {
            if (partitive_.emplace(property, kind).second) found.push_back(property);
        };
        std::map<RdfTerm, std::vector<RdfTerm>> below, inverse;
        for (const auto& [subject, predicate, object] : statements_) {
            if (predicate == owl + "onProperty") {
                const std::string& uri = object.value;
                if (uri == obo + "BFO_0000050") take(object, Partitive::part_of);
                else if (uri == obo + "BFO_0000051") take(object, Partitive::has_part);
                else if (const auto kind = partitive_by_name(uri.substr(uri.find_last_of("/#") + 1))) take(object, *kind);
                else
                    for (const RdfTerm& label : values(object, skos::rdfs + "label"))
                        if (const auto by_label = partitive_by_name(label.value)) take(object, *by_label);
            }
            if (predicate == skos::rdfs + "subPropertyOf") {
                below[object].push_back(subject);
                if (const auto kind = partitive_by_name(object.value.substr(object.value.find_last_of("/#") + 1)))
                    take(object, *kind);
            }
            if (predicate == owl + "inverseOf") inverse[subject].push_back(object), inverse[object].push_back(subject);
        }
        for (std::size_t i = 0; i < found.size(); ++i) {
            const RdfTerm property = found[i];
            const Partitive kind = partitive_.at(property);
            for (const RdfTerm& one : below[property]) take(one, kind);
            for (const RdfTerm& one : inverse[property])
                take(one, kind == Partitive::part_of ? Partitive::has_part : Partitive::part_of);
        }
    }

    void add(const RdfTerm& subject, const std::string& predicate, const RdfTerm& object) {
        made_.push_back({subject, predicate, object});
    }

    void translate(const RdfStatement& one) {
        const std::string& property = one.predicate;
        if (property == skos::rdf + "type") return;
        if (property == skos::rdfs + "label") return add(one.subject, skos::core + "prefLabel", one.object);
        if (property == obo_in_owl + "hasExactSynonym" || property == obo_in_owl + "hasRelatedSynonym")
            return add(one.subject, skos::core + "altLabel", one.object);
        if (property == obo + "IAO_0000115" ||
            (property == skos::rdfs + "comment" && values(one.subject, obo + "IAO_0000115").empty()))
            return add(one.subject, skos::core + "definition", one.object);
        if (property == skos::rdfs + "subClassOf" || property == owl + "equivalentClass") {
            if (!above(one.subject, one.object, property == owl + "equivalentClass")) ++others_;
            return;
        }
        if (one.object.kind == RdfTerm::Kind::blank) ++others_;
        else made_.push_back(one);
    }

    /// Handles a superclass or a whole of a class; returns false if the object is neither.
    bool above(const RdfTerm& subject, const RdfTerm& object, bool equivalent) {
        if (object.kind == RdfTerm::Kind::uri) {
            if (object.value == owl + "Thing" || deprecated_.contains(object)) return true;
            // Equivalent classes are not broader than each other.
            add(subject, skos::core + (equivalent ? "exactMatch" : "broader"), object);
            return true;
        }
        if (const auto lists = values(object, owl + "intersectionOf"); lists.size() == 1) {
            bool all = true;
            RdfTerm cell = lists.front();
            for (std::set<RdfTerm> seen; seen.insert(cell).second;) {  // stops at cyclic lists
                for (const RdfTerm& member : values(cell, skos::rdf + "first"))
                    all = (member.kind == RdfTerm::Kind::uri ? above(subject, member, false) : partitive(subject, member)) && all;
                const auto rest = values(cell, skos::rdf + "rest");
                if (rest.empty()) break;
                cell = rest.front();
            }
            return all;
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
    std::vector<RdfStatement> made_;
    std::size_t others_ = 0;
};

}  // namespace

std::vector<RdfStatement> skos_of_owl(std::vector<RdfStatement> statements, std::vector<std::string>& notes) {
    for (const RdfStatement& one : statements)
        if (one.predicate.starts_with(skos::core) &&
            (one.predicate == skos::core + "inScheme" || one.predicate == skos::core + "broader"))
            return statements;
        else if (one.predicate == skos::rdf + "type" && one.object == owl_uri(skos::core + "Concept")) return statements;
    OwlReader reader(statements);
    return reader.has_classes() ? reader.translated(notes) : std::move(statements);
}

}  // namespace ostraka

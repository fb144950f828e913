// Converts a vocabulary to SKOS.
#include "vocabulary/rdf.h"
#include "vocabulary/skos_terms.h"

#include "ostraka/vocabulary/skos.h"

#include <charconv>

namespace ostraka {

namespace {

using Kind = RdfTerm::Kind;

std::string shortest(double value) {
    char buffer[64];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific).ptr;
    return {buffer, end};
}

class SkosWriter {
public:
    std::vector<RdfStatement> statements;

    explicit SkosWriter(const Vocabulary& vocabulary)
        : scheme_(uri(vocabulary.uri.empty() ? skos::default_scheme : vocabulary.uri)) {
        add(scheme_, skos::rdf + "type", uri(skos::core + "ConceptScheme"));
        labels(scheme_, skos::dcterms + "title", vocabulary.title);
        attributes(scheme_, vocabulary.attributes);
        foreign(scheme_, vocabulary.others);
        if (!vocabulary.rules.empty())
            add(scheme_, skos::ostraka_ns + "rules",
                {Kind::text, to_text(vocabulary_to_json(vocabulary)["rules"]), {}, skos::rdf + "JSON"});
        std::map<std::string, RdfTerm> terms;
        for (const Concept& entry : vocabulary.concepts)
            terms[entry.id] = uri(entry.uri.empty() ? skos::namespace_of(vocabulary.uri) + percent_encoded(entry.id) : entry.uri);
        for (std::size_t i = 0; i < vocabulary.concepts.size(); ++i) {
            const Concept& entry = vocabulary.concepts[i];
            const RdfTerm& term = terms.at(entry.id);
            add(term, skos::rdf + "type", uri(skos::core + "Concept"));
            add(term, skos::core + "inScheme", scheme_);
            add(term, skos::ostraka_ns + "id", {Kind::text, entry.id, {}, {}});
            labels(term, skos::core + "prefLabel", entry.labels);
            for (const auto& [language, alternatives] : entry.alternatives)
                for (const auto& label : alternatives) add(term, skos::core + "altLabel", {Kind::text, label, language, {}});
            labels(term, skos::core + "definition", entry.definition);
            for (const auto& id : entry.broader) add(term, skos::core + "broader", terms.at(id));
            for (const auto& id : entry.part_of) add(term, skos::thesaurus + "broaderPartitive", terms.at(id));
            if (entry.broader.empty()) add(term, skos::core + "topConceptOf", scheme_);
            position(term, i);
            attributes(term, entry.attributes);
            foreign(term, entry.others);
        }
    }

private:
    static RdfTerm uri(std::string text) { return {Kind::uri, std::move(text), {}, {}}; }
    RdfTerm blank() { return {Kind::blank, "b" + std::to_string(++blanks_), {}, {}}; }

    void add(const RdfTerm& subject, const std::string& property, RdfTerm value) {
        statements.push_back({subject, property, std::move(value)});
    }
    void labels(const RdfTerm& subject, const std::string& property, const Labels& label_map) {
        for (const auto& [language, text] : label_map) add(subject, property, {Kind::text, text, language, {}});
    }
    void position(const RdfTerm& subject, std::size_t i) {
        add(subject, skos::ostraka_ns + "position", {Kind::text, std::to_string(i), {}, skos::xsd + "integer"});
    }
    void foreign(const RdfTerm& subject, const std::vector<ForeignStatement>& foreign_statements) {
        for (const ForeignStatement& statement : foreign_statements)
            add(subject, statement.property,
                {statement.is_uri ? Kind::uri : Kind::text, statement.value, statement.is_uri ? "" : statement.language,
                 statement.is_uri ? "" : statement.datatype});
    }
    void number(const RdfTerm& subject, const char* name, const std::optional<double>& value) {
        if (value) add(subject, skos::ostraka_ns + name, {Kind::text, shortest(*value), {}, skos::xsd + "double"});
    }
    void attributes(const RdfTerm& owner, const std::vector<AllowedAttribute>& entries) {
        for (std::size_t i = 0; i < entries.size(); ++i) {
            const AllowedAttribute& attribute = entries[i];
            const RdfTerm node = blank();
            add(owner, skos::ostraka_ns + "attribute", node);
            add(node, skos::ostraka_ns + "name", {Kind::text, attribute.name, {}, {}});
            labels(node, skos::core + "prefLabel", attribute.labels);
            labels(node, skos::core + "definition", attribute.definition);
            number(node, "minimum", attribute.min);
            number(node, "maximum", attribute.max);
            if (!attribute.unit.empty()) add(node, skos::ostraka_ns + "unit", {Kind::text, attribute.unit, {}, {}});
            position(node, i);
            for (std::size_t k = 0; k < attribute.values.size(); ++k) {
                const RdfTerm term = blank();
                add(node, skos::ostraka_ns + "value", term);
                add(term, skos::ostraka_ns + "name", {Kind::text, attribute.values[k].name, {}, {}});
                labels(term, skos::core + "prefLabel", attribute.values[k].labels);
                position(term, k);
            }
        }
    }

    RdfTerm scheme_;
    std::size_t blanks_ = 0;
};

}  // namespace

std::string vocabulary_to_skos(const Vocabulary& vocabulary, bool rdf_xml, const std::string& where) {
    check_vocabulary(vocabulary, where);
    return serialise_rdf(SkosWriter(vocabulary).statements, rdf_xml ? RdfSyntax::rdf_xml : RdfSyntax::turtle,
                         {{"skos", skos::core}, {"dcterms", skos::dcterms}, {"xsd", skos::xsd}, {"ostraka", skos::ostraka_ns}},
                         where);
}

void write_skos(const Path& file, const Vocabulary& vocabulary) {
    write_file(file, vocabulary_to_skos(vocabulary, skos::is_rdf_xml(file), file.string()));
}

}  // namespace ostraka

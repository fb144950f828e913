// ostraka vocabulary check | show | convert
#include "command.h"

#include "ostraka/vocabulary/skos.h"

#include <algorithm>
#include <functional>
#include <iostream>
#include <memory>
#include <set>

namespace ostraka::app {

namespace {

struct Check {
    std::string file, scheme;

    int run(const Session& session) const {
        Provenance provenance{"vocabulary check", {}, {}};
        provenance.add_input(file);
        // A file that is no JSON or no RDF at all is a failure, not an answer.
        const bool skos = is_skos(file);
        const Json source = skos ? Json() : read_json(file);
        std::vector<Finding> findings;
        try {
            const Vocabulary vocabulary = skos ? read_skos(file, scheme) : vocabulary_from_json(source, file);
            for (const auto& note : vocabulary.notes) findings.push_back({false, "", note});
            for (auto& finding : examine(vocabulary)) findings.push_back(std::move(finding));
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input || error.problem().starts_with("not valid")) throw;
            findings.push_back({true, "", error.problem() + (error.remedy().empty() ? "" : " (" + error.remedy() + ")")});
        }
        return report_findings(session, provenance, findings);
    }
};

std::string text_of(const AllowedAttribute& attribute) {
    std::string text = attribute.name;
    for (std::size_t i = 0; i < attribute.values.size(); ++i) text += (i == 0 ? ": " : " | ") + attribute.values[i].name;
    if (attribute.quantitative()) {
        text += ": ";
        if (attribute.min && attribute.max) text += number(*attribute.min) + " to " + number(*attribute.max);
        else if (attribute.min) text += number(*attribute.min) + " or more";
        else if (attribute.max) text += number(*attribute.max) + " or less";
        else text += "a number";
        if (!attribute.unit.empty()) text += (attribute.min || attribute.max ? " " : " in ") + attribute.unit;
    }
    return text;
}

struct Show {
    std::string file, language = "en", under;

    int run(const Session& session) const {
        Provenance provenance{"vocabulary show", {{"language", language}, {"under", under}}, {}};
        provenance.add_input(file);
        const Vocabulary vocabulary = read_vocabulary(file);
        const VocabularySearch search(vocabulary);
        std::vector<std::vector<std::size_t>> narrower(vocabulary.concepts.size());
        std::vector<std::size_t> roots;
        for (std::size_t i = 0; i < vocabulary.concepts.size(); ++i) {
            for (const auto& id : vocabulary.concepts[i].broader) narrower[*search.find(id)].push_back(i);
            if (vocabulary.concepts[i].broader.empty()) roots.push_back(i);
        }
        if (!under.empty()) {
            const auto found = search.concepts_of(under);
            if (found.size() != 1) {
                std::string known;
                for (const auto& name : search.suggestions(under)) known += (known.empty() ? "close to it: " : ", ") + name;
                fail_input(file, "'" + under + "' names " + (found.empty() ? "no concept" : "several concepts"),
                           found.empty() ? known : "use an id");
            }
            roots = found;
        }
        check_language(session, vocabulary);
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType);
        std::vector<std::vector<std::string>> rows;
        // Depth first with a stack of its own; a concept under several others stands below each, its narrower ones only once.
        std::vector<std::pair<std::size_t, std::size_t>> stack;
        for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.emplace_back(*root, 0);
        std::vector<bool> seen(vocabulary.concepts.size(), false);
        while (!stack.empty()) {
            const auto [i, depth] = stack.back();
            stack.pop_back();
            const Concept& entry = vocabulary.concepts[i];
            std::string attributes, others;
            JsonValue attribute_list(rapidjson::kArrayType);
            for (const AllowedAttribute& attribute : entry.attributes) {
                attributes += (attributes.empty() ? "" : "; ") + text_of(attribute);
                attribute_list.PushBack(json_string(text_of(attribute), allocator), allocator);
            }
            const std::string label = search.label(i, language);
            for (const auto& [tongue, text] : entry.labels)
                if (text != label) others += (others.empty() ? "" : ", ") + text + (tongue.empty() ? "" : " (" + tongue + ")");
            const bool again = seen[i];
            seen[i] = true;
            JsonValue object(rapidjson::kObjectType);
            add_member(object, "id", entry.id, allocator);
            add_member(object, "depth", JsonValue(static_cast<std::uint64_t>(depth)), allocator);
            add_member(object, "label", label, allocator);
            add_member(object, "attributes", std::move(attribute_list), allocator);
            list.PushBack(object, allocator);
            rows.push_back({std::string(2 * std::min<std::size_t>(depth, 30), ' ') + label + (again ? " (see above)" : ""),
                            entry.id, others, attributes});
            if (!again)
                for (auto next = narrower[i].rbegin(); next != narrower[i].rend(); ++next) stack.emplace_back(*next, depth + 1);
        }
        add_member(result, "concepts", std::move(list), allocator);
        if (session.json) {
            session.print_report(provenance, document, result);
            return done;
        }
        std::cout << table({"concept", "id", "other languages", "attributes"}, rows);
        if (!vocabulary.attributes.empty()) {
            std::cout << "every concept:";
            for (std::size_t i = 0; i < vocabulary.attributes.size(); ++i)
                std::cout << (i == 0 ? " " : "; ") << printable(text_of(vocabulary.attributes[i]));
            std::cout << '\n';
        }
        // Of those about the concepts shown, and of all.
        const auto about = std::count_if(vocabulary.rules.begin(), vocabulary.rules.end(), [&](const InferenceRule& rule) {
            return rule.concept_id.empty() || seen[*search.find(rule.concept_id)];
        });
        if (!vocabulary.rules.empty())
            std::cout << about << (under.empty() ? "" : " of " + std::to_string(vocabulary.rules.size()))
                      << (vocabulary.rules.size() == 1 ? " rule" : " rules") << (under.empty() ? "" : " may apply to them")
                      << '\n';
        return done;
    }

private:
    /// Says so where no concept has a label in the language asked for.
    void check_language(const Session& session, const Vocabulary& vocabulary) const {
        std::set<std::string> known;
        for (const Concept& entry : vocabulary.concepts)
            for (const auto& [tongue, text] : entry.labels) known.insert(tongue);
        known.erase("");
        if (known.empty() || known.contains(language)) return;
        std::string list;
        for (const auto& tongue : known) list += (list.empty() ? "" : ", ") + tongue;
        session.note("note: no label is in the language '" + language + "'; there are " + list);
    }
};

struct Convert {
    std::string input, output, scheme;

    int run(const Session& session) const {
        for (const std::string& file : {input, output})
            if (!is_skos(file) && extension(file) != ".json")
                fail_usage("the ending of " + file + " says no format of vocabularies",
                           "use .vocabulary.json, .ttl (Turtle) or .rdf (RDF/XML)");
        if (!scheme.empty() && !is_skos(input)) fail_usage("--scheme goes with SKOS files", "leave it away");
        check_outputs({input}, {output});
        Provenance provenance{"vocabulary convert", {}, {}};
        if (!scheme.empty()) provenance.options.emplace_back("scheme", scheme);
        provenance.add_input(input);
        const Vocabulary vocabulary = is_skos(input) ? read_skos(input, scheme) : read_vocabulary(input);
        try {
            write_vocabulary(output, vocabulary);
        } catch (const Error& error) {
            // What cannot be written stands in the input.
            if (error.kind() != ErrorKind::input) throw;
            const bool named = error.where().starts_with(output);
            fail_input(named ? input + error.where().substr(output.size()) : error.where(), error.problem(), error.remedy());
        }
        for (const auto& note : vocabulary.notes) session.note("note: " + note);
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), notes(rapidjson::kArrayType);
        for (const auto& note : vocabulary.notes) notes.PushBack(json_string(note, allocator), allocator);
        add_member(result, "concepts", JsonValue(static_cast<std::uint64_t>(vocabulary.concepts.size())), allocator);
        add_member(result, "rules", JsonValue(static_cast<std::uint64_t>(vocabulary.rules.size())), allocator);
        add_member(result, "notes", std::move(notes), allocator);
        if (session.json) session.print_report(provenance, document, result);
        else std::cout << vocabulary.concepts.size() << " concepts, " << vocabulary.rules.size() << " rules\n";
        return done;
    }
};

}  // namespace

void add_vocabulary(CLI::App& vocabulary, Session& session) {
    const auto check = std::make_shared<Check>();
    CLI::App* command = session.add(vocabulary, "check", "look for defects in a vocabulary; exit code 3 if there are",
                                    [&session, check] { return check->run(session); });
    command->add_option("vocabulary", check->file, "vocabulary (.vocabulary.json, .ttl, .rdf)")->required();

    command->add_option("--scheme", check->scheme, "URI of the concept scheme, where a SKOS file has several");

    const auto show = std::make_shared<Show>();
    command = session.add(vocabulary, "show", "concepts as a tree, with the attributes each may carry",
                          [&session, show] { return show->run(session); });
    command->add_option("vocabulary", show->file, "vocabulary (.vocabulary.json, .ttl, .rdf)")->required();
    command->add_option("--language", show->language, "language of the labels")->capture_default_str();
    command->add_option("--under", show->under, "only this concept (id or label) and narrower ones");

    const auto convert = std::make_shared<Convert>();
    command = session.add(vocabulary, "convert", "vocabularies between our format and SKOS",
                          [&session, convert] { return convert->run(session); });
    command->add_option("input", convert->input, "vocabulary (.vocabulary.json, .ttl, .rdf)")->required();
    command->add_option("output", convert->output, "vocabulary to write (.vocabulary.json, .ttl, .rdf)")->required();
    command->add_option("--scheme", convert->scheme, "URI of the concept scheme, where a SKOS file has several");
}

}  // namespace ostraka::app

// vocabulary check, show, convert
#include "operations.h"

#include "ostraka/vocabulary/skos.h"

#include <algorithm>
#include <set>

namespace ostraka {

namespace {

constexpr const char* vocabulary_file = "vocabulary (.vocabulary.json, .ttl, .rdf)";
constexpr const char* scheme_help = "URI of the concept scheme, where a SKOS file has several";

struct VocabularyCheck final : Operation {
    void describe(Parameters& p) override {
        p.input("vocabulary", Kind::vocabulary, file, vocabulary_file);
        p.options("scheme", scheme, scheme_help);
        p.report.checks = true;
    }

    void run(Context& context, Report& report) override {
        const Path path = file.path();
        // A file that is neither JSON nor RDF is a failure, not a "no".
        const bool skos = is_skos(path);
        const Json* document = skos ? nullptr : &file.load<Json>(read_json);
        std::vector<Finding> findings;
        try {
            Vocabulary vocabulary;
            if (skos) context.record([&] { vocabulary = read_skos(path, scheme); });
            else vocabulary = vocabulary_from_json(*document, file.file());
            for (const auto& note : vocabulary.notes) findings.push_back({false, "", note});
            for (auto& finding : examine(vocabulary)) findings.push_back(std::move(finding));
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input || error.problem().starts_with("not valid")) throw;
            findings.push_back({true, "", error.problem() + (error.remedy().empty() ? "" : " (" + error.remedy() + ")")});
        }
        report.findings(findings);
    }

    FileInput file;
    std::string scheme;
};

struct VocabularyShow final : Operation {
    void describe(Parameters& p) override {
        p.input("vocabulary", Kind::vocabulary, file, vocabulary_file);
        p.options("language", language, "language of the labels");
        p.options("under", under, "only this concept (id or label) and narrower ones");
        p.report.table("concepts", text("label", "concept"), text("id", "id"), integer("depth"), people("other languages"),
                       texts("attributes", "attributes"));
    }

    void run(Context&, Report& report) override {
        const auto& vocabulary = file.load<Vocabulary>(read_vocabulary);
        report.notes(vocabulary.notes);
        const VocabularySearch search(vocabulary);
        std::vector<std::vector<std::size_t>> narrower(vocabulary.concepts.size());
        std::vector<std::size_t> roots;
        for (std::size_t i = 0; i < vocabulary.concepts.size(); ++i) {
            for (const auto& id : vocabulary.concepts[i].broader) narrower[*search.find(id)].push_back(i);
            if (vocabulary.concepts[i].broader.empty()) roots.push_back(i);
        }
        if (!under.empty()) roots = {named_concept(search)};
        look_at_languages(vocabulary, report);
        report.empty_table("concepts");
        // Depth-first with an explicit stack. A concept with several broader concepts is listed below each; its narrower ones
        // only once.
        std::vector<std::pair<std::size_t, std::size_t>> stack;
        for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.emplace_back(*root, 0);
        std::vector<bool> seen(vocabulary.concepts.size(), false);
        while (!stack.empty()) {
            const auto [i, depth] = stack.back();
            stack.pop_back();
            const bool again = seen[i];
            seen[i] = true;
            report_result(report, search, i, depth, again);
            if (!again)
                for (auto next = narrower[i].rbegin(); next != narrower[i].rend(); ++next) stack.emplace_back(*next, depth + 1);
        }
        if (const std::string common = joined(texts_of(vocabulary.attributes), "; "); !common.empty())
            report.line("every concept: " + printable(common));
        // Rules about the concepts shown, and rules about all concepts.
        const auto about = std::count_if(vocabulary.rules.begin(), vocabulary.rules.end(), [&](const InferenceRule& rule) {
            return rule.concept_id.empty() || seen[*search.find(rule.concept_id)];
        });
        if (const std::size_t all = vocabulary.rules.size(); all > 0)
            report.line(std::to_string(about) + (under.empty() ? "" : " of " + std::to_string(all)) +
                        (all == 1 ? " rule" : " rules") + (under.empty() ? "" : " may apply to them"));
    }

    [[nodiscard]] std::size_t named_concept(const VocabularySearch& search) const {
        const auto found = search.concepts_of(under);
        if (found.size() == 1) return found.front();
        const auto near = search.suggestions(under);
        fail_input(file.file(), "'" + under + "' names " + (found.empty() ? "no concept" : "several concepts"),
                   !found.empty() ? "use an id"
                   : near.empty() ? ""
                                  : "close to it: " + joined(near));
    }

    void report_result(Report& report, const VocabularySearch& search, std::size_t i, std::size_t depth, bool again) const {
        const Concept& entry = search.vocabulary().concepts[i];
        const std::string label = search.label(i, language);
        std::string others;
        for (const auto& [tongue, text] : entry.labels)
            if (text != label) others += (others.empty() ? "" : ", ") + text + (tongue.empty() ? "" : " (" + tongue + ")");
        const auto attributes = texts_of(entry.attributes);
        Report::Row row = report.row("concepts");
        row("label", label, std::string(2 * std::min<std::size_t>(depth, 30), ' ') + label + (again ? " (see above)" : ""))(
            "id", entry.id)("depth", depth)("attributes", attributes, joined(attributes, "; "));
        row.shown("other languages", others);
    }

    /// Adds a note if no concept has a label in the requested language.
    void look_at_languages(const Vocabulary& vocabulary, Report& report) const {
        std::set<std::string> known;
        for (const Concept& entry : vocabulary.concepts)
            for (const auto& [tongue, text] : entry.labels) known.insert(tongue);
        known.erase("");
        if (known.empty() || known.contains(language)) return;
        report.note("no label is in the language '" + language + "'; there are " + joined(known));
    }

    static std::vector<std::string> texts_of(const std::vector<AllowedAttribute>& attributes) {
        std::vector<std::string> texts;
        for (const AllowedAttribute& attribute : attributes) {
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
            texts.push_back(std::move(text));
        }
        return texts;
    }

    FileInput file;
    std::string language = "en", under;
};

struct VocabularyConvert final : Operation {
    void describe(Parameters& p) override {
        p.input("input", Kind::vocabulary, input, vocabulary_file);
        p.output("output", Kind::vocabulary, output, "vocabulary to write (.vocabulary.json, .ttl, .rdf)");
        p.options("scheme", scheme, scheme_help);
        p.report.values(integer("concepts"), integer("rules"));
    }

    void check() const override {
        for (const std::string& file : {input.file(), output.file()})
            if (!file.empty() && !is_skos(file) && extension(file) != ".json")
                fail_usage("the ending of " + file + " says no format of vocabularies",
                           "use .vocabulary.json, .ttl (Turtle) or .rdf (RDF/XML)");
        if (!scheme.empty() && !is_skos(input.file())) fail_usage("--scheme goes with SKOS files", "leave it away");
    }

    void run(Context& context, Report& report) override {
        Vocabulary vocabulary;
        context.record([&] {
            const Path path = input.path();
            vocabulary = is_skos(path) ? read_skos(path, scheme) : read_vocabulary(path);
        });
        const std::string written = output.path().string();
        try {
            write_vocabulary(written, vocabulary);
        } catch (const Error& error) {
            // A part that cannot be written is a problem of the input.
            if (error.kind() != ErrorKind::input) throw;
            const bool named = error.where().starts_with(written);
            fail_input(named ? input.file() + error.where().substr(written.size()) : error.where(), error.problem(),
                       error.remedy());
        }
        report.notes(vocabulary.notes);
        report("concepts", vocabulary.concepts.size())("rules", vocabulary.rules.size());
        report.line(std::to_string(vocabulary.concepts.size()) + " concepts, " + std::to_string(vocabulary.rules.size()) +
                    " rules");
    }

    FileInput input;
    FileOutput output{".vocabulary.json"};
    std::string scheme;
};

}  // namespace

std::unique_ptr<Operation> make_vocabulary_check() { return make<VocabularyCheck>(); }
std::unique_ptr<Operation> make_vocabulary_show() { return make<VocabularyShow>(); }
std::unique_ptr<Operation> make_vocabulary_convert() { return make<VocabularyConvert>(); }

}  // namespace ostraka

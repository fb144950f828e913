// vocabulary show
#include "operations/operations.h"
#include "operations/vocabulary/help_texts.h"

#include "ostraka/vocabulary/vocabulary.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

namespace ostraka {

namespace {

struct VocabularyShow final : Operation {
    void declare(Parameters& p) override {
        p.input("vocabulary", Kind::vocabulary, file, vocabulary_file);
        p.options("language", language, "language of the labels that are shown");
        p.options("under", under, "id or label of a concept: show only this concept and its narrower concepts");
        p.report.table("concepts", text("label", "concept"), text("id", "id"), integer("depth"), text_only("other languages"),
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
        note_missing_language(vocabulary, report);
        report.empty_table("concepts");
        // Depth-first with an explicit stack. A concept with several broader concepts is listed below each; its narrower ones
        // only once.
        std::vector<std::pair<std::size_t, std::size_t>> stack;
        for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.emplace_back(*root, 0);
        std::vector<bool> listed(vocabulary.concepts.size(), false);
        while (!stack.empty()) {
            const auto [i, depth] = stack.back();
            stack.pop_back();
            const bool is_repeated = listed[i];
            listed[i] = true;
            report_result(report, search, i, depth, is_repeated);
            if (!is_repeated)
                for (auto next = narrower[i].rbegin(); next != narrower[i].rend(); ++next) stack.emplace_back(*next, depth + 1);
        }
        if (const std::string common = joined(texts_of(vocabulary.attributes), "; "); !common.empty())
            report.line("every concept: " + printable(common));
        // Rules about the concepts shown, and rules about all concepts.
        const auto applicable = std::count_if(vocabulary.rules.begin(), vocabulary.rules.end(), [&](const InferenceRule& rule) {
            return rule.concept_id.empty() || listed[*search.find(rule.concept_id)];
        });
        if (const std::size_t rule_count = vocabulary.rules.size(); rule_count > 0)
            report.line(fmt::format("{}{} {}{}", applicable, under.empty() ? "" : fmt::format(" of {}", rule_count),
                                    rule_count == 1 ? "rule" : "rules", under.empty() ? "" : " may apply to them"));
    }

    [[nodiscard]] std::size_t named_concept(const VocabularySearch& search) const {
        const auto matching = search.concepts_of(under);
        if (matching.size() == 1) return matching.front();
        const auto suggestions = search.suggestions(under);
        fail_input(file.file(), fmt::format("'{}' names {}", under, matching.empty() ? "no concept" : "several concepts"),
                   !matching.empty()     ? "use an id"
                   : suggestions.empty() ? ""
                                         : "similar names: " + joined(suggestions));
    }

    void report_result(Report& report, const VocabularySearch& search, std::size_t i, std::size_t depth, bool is_repeated) const {
        const Concept& entry = search.vocabulary().concepts[i];
        const std::string label = search.label(i, language);
        std::string others;
        for (const auto& [code, text] : entry.labels)
            if (text != label)
                others += fmt::format("{}{}{}", others.empty() ? "" : ", ", text, code.empty() ? "" : fmt::format(" ({})", code));
        const auto attributes = texts_of(entry.attributes);
        Report::Row row = report.row("concepts");
        row("label", label, std::string(2 * std::min<std::size_t>(depth, 30), ' ') + label + (is_repeated ? " (see above)" : ""))(
            "id", entry.id)("depth", depth)("attributes", attributes, joined(attributes, "; "));
        row.shown("other languages", others);
    }

    /// Adds a note if no concept has a label in the requested language.
    void note_missing_language(const Vocabulary& vocabulary, Report& report) const {
        std::set<std::string> languages;
        for (const Concept& entry : vocabulary.concepts)
            for (const auto& [code, text] : entry.labels) languages.insert(code);
        languages.erase("");
        if (languages.empty() || languages.contains(language)) return;
        report.note(fmt::format("no label is in the language '{}'; there are {}", language, joined(languages)));
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

}  // namespace

std::unique_ptr<Operation> make_vocabulary_show() { return make<VocabularyShow>(); }

}  // namespace ostraka

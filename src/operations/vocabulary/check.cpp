// vocabulary check
#include "operations/operations.h"
#include "operations/vocabulary/help_texts.h"

#include "ostraka/vocabulary/skos.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct VocabularyCheck final : Operation {
    void declare(Parameters& p) override {
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
            findings.push_back(
                {true, "", error.remedy().empty() ? error.problem() : fmt::format("{} ({})", error.problem(), error.remedy())});
        }
        report.findings(findings);
    }

    FileInput file;
    std::string scheme;
};

}  // namespace

std::unique_ptr<Operation> make_vocabulary_check() { return make<VocabularyCheck>(); }

}  // namespace ostraka

// vocabulary convert
#include "operations/operations.h"
#include "operations/vocabulary/help_texts.h"

#include "ostraka/vocabulary/skos.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

struct VocabularyConvert final : Operation {
    void declare(Parameters& p) override {
        p.input("input", Kind::vocabulary, input, vocabulary_file);
        p.output("output", Kind::vocabulary, output, "vocabulary to write (.vocabulary.json, .ttl, .rdf)");
        p.options("scheme", scheme, scheme_help);
        p.report.values(integer("concepts"), integer("rules"));
    }

    void check() const override {
        for (const std::string& file : {input.file(), output.file()})
            if (!file.empty() && !is_skos(file) && extension(file) != ".json")
                fail_usage(fmt::format("the extension of {} is not that of a format of vocabularies", file),
                           "use .vocabulary.json, .ttl (Turtle) or .rdf (RDF/XML)");
        if (!scheme.empty() && !is_skos(input.file())) fail_usage("--scheme applies to SKOS files only", "leave it out");
    }

    void run(Context& context, Report& report) override {
        Vocabulary vocabulary;
        context.record([&] {
            const Path path = input.path();
            vocabulary = is_skos(path) ? read_skos(path, scheme) : read_vocabulary(path);
        });
        const std::string output_path = output.path().string();
        try {
            write_vocabulary(output_path, vocabulary);
        } catch (const Error& error) {
            // A part that cannot be written is a problem of the input.
            if (error.kind() != ErrorKind::input) throw;
            const bool names_output = error.where().starts_with(output_path);
            fail_input(names_output ? input.file() + error.where().substr(output_path.size()) : error.where(), error.problem(),
                       error.remedy());
        }
        report.notes(vocabulary.notes);
        report("concepts", vocabulary.concepts.size())("rules", vocabulary.rules.size());
        report.line(fmt::format("{} concepts, {} rules", vocabulary.concepts.size(), vocabulary.rules.size()));
    }

    FileInput input;
    FileOutput output{".vocabulary.json"};
    std::string scheme;
};

}  // namespace

std::unique_ptr<Operation> make_vocabulary_convert() { return make<VocabularyConvert>(); }

}  // namespace ostraka

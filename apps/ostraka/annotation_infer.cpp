// ostraka annotation infer
#include "command.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/vocabulary/infer.h"

#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

struct Infer {
    std::string mesh, annotations, vocabulary, output;
    ReadAnnotationsOptions options;

    int run(const Session& session) const {
        check_outputs({mesh, annotations, vocabulary}, {output});
        Provenance provenance{"annotation infer", list_options(options), {}};
        for (const std::string& file : {mesh, annotations, vocabulary}) provenance.add_input(file);
        const Vocabulary words = read_vocabulary(vocabulary);
        const MeshFile file = read_mesh(mesh);
        const AnnotationSet set = read_annotations(annotations, file.mesh, options);
        for (const auto& note : set.notes) session.note("note: " + note);
        const InferenceResult result = infer(set, words);
        write_annotations(output, result.annotations, file.mesh, mesh, provenance);

        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue report(rapidjson::kObjectType), list(rapidjson::kArrayType);
        std::vector<std::vector<std::string>> rows;
        for (const Inference& inference : result.inferred) {
            const std::string& tag = result.annotations.find(inference.annotation)->tag;
            JsonValue entry(rapidjson::kObjectType);
            add_member(entry, "annotation", JsonValue(inference.annotation), allocator);
            add_member(entry, "tag", tag, allocator);
            add_member(entry, "attribute", inference.attribute, allocator);
            add_member(entry, "value", inference.value, allocator);
            add_member(entry, "rule", inference.rule, allocator);
            add_member(entry, "why", inference.why, allocator);
            list.PushBack(entry, allocator);
            rows.push_back({std::to_string(inference.annotation), tag, inference.attribute, inference.value, inference.why});
        }
        const auto texts = [&](const std::vector<std::string>& lines) {
            JsonValue array(rapidjson::kArrayType);
            for (const auto& line : lines) array.PushBack(json_string(line, allocator), allocator);
            return array;
        };
        add_member(report, "inferred", std::move(list), allocator);
        add_member(report, "contradictions", texts(result.contradictions), allocator);
        add_member(report, "missing", texts(result.missing), allocator);
        for (const auto& line : result.missing) session.note("note: " + line);
        if (session.json) {
            session.print_report(provenance, document, report);
        } else {
            if (!rows.empty()) std::cout << table({"id", "tag", "attribute", "value", "why"}, rows);
            for (const auto& line : result.contradictions) std::cout << "contradiction: " << printable(line) << '\n';
            std::cout << rows.size() << (rows.size() == 1 ? " word" : " words") << " inferred\n";
        }
        return result.contradictions.empty() ? done : answer_is_no;
    }
};

}  // namespace

void add_annotation_infer(CLI::App& annotation, Session& session) {
    const auto infer = std::make_shared<Infer>();
    CLI::App* command = session.add(annotation, "infer",
                                    "words from numbers, by the rules of a vocabulary; exit code 3 if they contradict each other",
                                    [&session, infer] { return infer->run(session); });
    command->add_option("mesh", infer->mesh, "mesh file")->required();
    command->add_option("annotations", infer->annotations, "its annotations (.ant.json)")->required();
    command->add_option("vocabulary", infer->vocabulary, "vocabulary with rules (.vocabulary.json, .ttl, .rdf)")->required();
    command->add_option("output", infer->output, "annotations to write")->required();
    add_flags(command, infer->options);
}

}  // namespace ostraka::app

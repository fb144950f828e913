// What the files of operations share; arguments that are texts: lists of numbers, directions, names of annotations.
#pragma once

#include "ostraka/operations/table.h"

#include "ostraka/core/json_build.h"
#include "ostraka/core/stopwatch.h"
#include "ostraka/core/words.h"
#include "ostraka/vocabulary/tag_words.h"

namespace ostraka {

using namespace fields;

/// An operation on a mesh and its annotations.
struct AnnotatedMeshOperation : Operation {
    void describe_inputs(Parameters& p) {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("annotations", Kind::annotations, annotations, "its annotations (.ant.json)");
    }
    [[nodiscard]] const AnnotationSet& set() const { return annotations.on(mesh->mesh); }

    MeshInput mesh;
    AnnotationsInput annotations;
};

/// {"format": "ostraka-KIND", "version": 1, members of `result`, "provenance"}.
inline Json document_of(std::string_view kind, const JsonValue& result, const Provenance& provenance) {
    Json document = json_document(kind);
    auto& allocator = document.GetAllocator();
    for (const auto& member : result.GetObject()) add_members(document, allocator, member.name.GetString(), member.value);
    add_members(document, allocator, "provenance", provenance.to_json(allocator));
    return document;
}

/// The numbers of "12,88"; Error (usage) names the option.
template <class Number>
std::vector<Number> numbers_of(const std::string& text, const std::string& option);
extern template std::vector<double> numbers_of<double>(const std::string&, const std::string&);
extern template std::vector<std::uint32_t> numbers_of<std::uint32_t>(const std::string&, const std::string&);

/// The direction "0,0,1", or the axis "z" or "-z"; Error (usage) names the option.
std::array<double, 3> direction_of(const std::string& text, const std::string& option);

/// What `direction_of` takes, as the rule of an option; `more`: words that it takes beside, which the operation knows.
Words direction_words(const std::string& option, std::vector<std::string> more = {});

/// --up: a direction as `direction_of` takes it, checked before any work.
class DirectionOption {
public:
    void describe(Parameters& p, const std::string& help);
    explicit operator bool() const { return !text_.empty(); }
    /// Empty where none was given.
    [[nodiscard]] std::optional<std::array<double, 3>> value() const;

private:
    std::string text_;
};

/// --vocabulary: by which tags are compared.
class VocabularyOption {
public:
    void describe(Parameters& p, const std::string& help) {
        p.input_option("vocabulary", Kind::vocabulary, file_, "vocabulary (.vocabulary.json, .ttl, .rdf) " + help);
    }
    explicit operator bool() const { return static_cast<bool>(file_); }
    [[nodiscard]] TagWords words() const { return file_ ? TagWords(&file_.load<Vocabulary>(read_vocabulary)) : TagWords(); }
    /// Empty where none is given.
    [[nodiscard]] std::string checksum() const { return file_ ? sha256_of_file(file_.path()) : std::string(); }

private:
    FileInput file_;
};
inline constexpr const char* as_template_words =
    "by which tags of objects are those of the template: of one concept in any language, or narrower";

/// The annotation of this id, or of this tag if exactly one has it. Throws Error (input) that names the file.
const Annotation& find_annotation(const AnnotationSet& set, const std::string& name, const std::string& file);

/// How the table (table.cpp) makes an operation; defined in the file of its name.
template <class Work>
std::unique_ptr<Operation> make() {
    return std::make_unique<Work>();
}

}  // namespace ostraka

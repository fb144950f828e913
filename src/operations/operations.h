// Helpers shared by the sources of operations: common inputs and options, and text arguments such as lists of numbers,
// directions, annotation names.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/operations/table.h"

#include "ostraka/core/message_text.h"
#include "ostraka/core/stopwatch.h"
#include "ostraka/files/json_build.h"
#include "ostraka/framework/inputs.h"
#include "ostraka/framework/outputs.h"
#include "ostraka/vocabulary/tag_matcher.h"

namespace ostraka {

using namespace fields;

/// An operation on a mesh and its annotations.
struct AnnotatedMeshOperation : Operation {
    void declare_inputs(Parameters& p) {
        p.input("mesh", Kind::mesh, mesh, "mesh file");
        p.input("annotations", Kind::annotations, annotations, "annotations of the mesh (.ant.json)");
    }
    /// The annotations, checked against the mesh.
    [[nodiscard]] const AnnotationSet& set() const { return annotations.on(mesh->mesh); }
    [[nodiscard]] AnnotatedMeshView object() const { return {mesh->mesh, set()}; }

    MeshInput mesh;
    AnnotationsInput annotations;
};

/// JSON document of an output file: {"format": "ostraka-KIND", "version": 1, the members of `result`, "provenance"}.
inline Json document_of(std::string_view kind, const JsonValue& result, const Provenance& provenance) {
    Json document = json_document(kind);
    auto& allocator = document.GetAllocator();
    for (const auto& member : result.GetObject()) add_members(document, allocator, member.name.GetString(), member.value);
    add_members(document, allocator, "provenance", provenance.to_json(allocator));
    return document;
}

/// Parses a list of numbers such as "12,88"; Error (usage) names the option.
template <class Number>
std::vector<Number> numbers_of(const std::string& text, const std::string& option);
extern template std::vector<double> numbers_of<double>(const std::string&, const std::string&);
extern template std::vector<std::uint32_t> numbers_of<std::uint32_t>(const std::string&, const std::string&);

/// Parses a direction such as "0,0,1", or an axis such as "z" or "-z"; Error (usage) names the option.
std::array<double, 3> direction_of(const std::string& text, const std::string& option);

/// Option rule for texts that `direction_of` accepts; `more`: additional words that the operation accepts.
Words direction_words(const std::string& option, std::vector<std::string> more = {});

/// The option --up: a direction in the form that `direction_of` accepts, checked before any work starts.
class DirectionOption {
public:
    void declare(Parameters& p, const std::string& help);  ///< declares the option --up
    explicit operator bool() const { return !text_.empty(); }
    /// Direction given by the user; empty if none was given.
    [[nodiscard]] std::optional<std::array<double, 3>> value() const;

private:
    std::string text_;
};

/// The option --vocabulary: the vocabulary by whose concepts tags are compared.
class VocabularyOption {
public:
    /// Declares the option --vocabulary.
    void declare(Parameters& p, const std::string& help) {
        p.input_option("vocabulary", Kind::vocabulary, file_, "vocabulary (.vocabulary.json, .ttl, .rdf) " + help);
    }
    explicit operator bool() const { return static_cast<bool>(file_); }
    /// Matcher of tags by the vocabulary, or by spelling without a vocabulary.
    [[nodiscard]] TagMatcher words() const { return file_ ? TagMatcher(&file_.load<Vocabulary>(read_vocabulary)) : TagMatcher(); }
    /// SHA-256 of the vocabulary file; empty if none was given.
    [[nodiscard]] std::string checksum() const { return file_ ? sha256_of_file(file_.path()) : std::string(); }

private:
    FileInput file_;
};
inline constexpr const char* as_template_words =
    "used to match tags of an object with tags of the template: the same concept in any language, or a narrower concept";

/// The annotation with this id, or with this tag if only one annotation has it. Throws Error (input) that names the file.
const Annotation& find_annotation(const AnnotationSet& set, const std::string& name, const std::string& file);

/// Creates an operation, for the table of operations (table.cpp); each operation is defined in the source file of its name.
template <class Work>
std::unique_ptr<Operation> make() {
    return std::make_unique<Work>();
}

}  // namespace ostraka

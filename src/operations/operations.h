// What the files of operations share.
#pragma once

#include "ostraka/operations/table.h"

#include "arguments.h"

#include "ostraka/core/json_build.h"
#include "ostraka/core/stopwatch.h"
#include "ostraka/core/words.h"

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

/// How the table (table.cpp) makes an operation; defined in the file of its name.
template <class Work>
std::unique_ptr<Operation> make() {
    return std::make_unique<Work>();
}

}  // namespace ostraka

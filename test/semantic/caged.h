// A synthetic object in a cage, with short definitions of constraints on its parts.
#pragma once

#include "annotation/example_meshes.h"
#include "ostraka/cage/cage.h"
#include "ostraka/core/error.h"
#include "ostraka/select/recipe.h"
#include "ostraka/semantic/deform.h"
#include "ostraka/synthetic/make_mesh.h"

namespace ostraka::test {

using namespace ostraka::example;

inline Edit edit(const std::string& steps, const std::string& name = "e") {
    return edit_from_json(parse_json(R"({"format": "ostraka-edit", "version": 1, "steps": [)" + steps + "]}", name), name);
}

/// A synthetic object with the annotations of its recipe, a cage and mean value coordinates.
struct Caged {
    SyntheticMesh synthetic;
    AnnotationSet set;
    Mesh cage;
    Coordinates coordinates;
    Caged(const std::string& name, std::uint64_t vertices, std::uint64_t cage_vertices)
        : synthetic(make_mesh(synthetic_object(name), {.vertices = vertices})),
          set(apply_recipe(Path(OSTRAKA_SOURCE_DIR) / "data" / (name + ".recipe.json"), synthetic.mesh, synthetic.face_labels)),
          cage(make_cage(synthetic.mesh, {.vertices = cage_vertices}).cage),
          coordinates(compute_coordinates("mean-value", cage, synthetic.mesh)) {}
    [[nodiscard]] HandleSpace handles() const { return {{synthetic.mesh, set}, &cage, &coordinates}; }
    [[nodiscard]] HandleSpace bare() const { return {{synthetic.mesh, set}}; }
};

inline const Caged& teapot() {
    static const Caged object("teapot", 5000, 150);
    return object;
}

inline Relationship constraint(int id, const std::string& type, std::vector<int> members, const std::string& parameters,
                               double weight = 1) {
    Relationship r;
    r.id = id;
    r.type = type;
    r.annotations = std::move(members);
    r.is_constraint = true;
    r.weight = weight;
    r.constraint = parameters;
    return r;
}

inline std::string error_of(const HandleSpace& space, const std::string& steps, const RelationGraph& graph = {}) {
    try {
        deform(space, graph, edit(steps, "e.edit.json"), "e.edit.json");
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

}  // namespace ostraka::test

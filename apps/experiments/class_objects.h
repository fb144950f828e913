// Objects of known classes, read or made, that classes are learnt from and asked about.
#pragma once

#include "ostraka/shape_classes/member_fit.h"
#include "ostraka/shape_classes/whole_shape.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ostraka::experiments {

struct ClassObject {
    std::string class_name;
    WholeObject member;
    WholeShape whole;
    Mesh original;
    std::vector<std::int32_t> labels;
    bool learnt = true, asked = true;  ///< a class may be learnt from it; classes are asked about it
};

/// <class>/<number>.off, by class and number, so many of each at most.
std::vector<ClassObject> read_class_objects(const std::string& folder, std::size_t maximum);
/// Of the segmentations that people made of a model the one that agrees best with the others': greatest mean adjusted Rand index.
std::vector<std::int32_t> typical_labels(const Path& folder, const Mesh& mesh);
/// The labelled mesh's regions on another mesh of the same object.
AnnotationSet parts_on(const Mesh& mesh, const Mesh& labelled, const std::vector<std::int32_t>& labels);
/// A copy of so many vertices at most.
Mesh of_vertices(const Mesh& mesh, std::uint64_t vertices);

/// Seven objects of no class: knots, a torus, a ball, a rod, a disc and a star.
std::vector<ClassObject> made_strangers();
/// Eight classes of `learnt` + `asked` objects each: what their members vary in is drawn anew for each.
std::vector<ClassObject> made_classes(std::size_t learnt, std::size_t asked, std::uint64_t seed, std::uint64_t vertices);

}  // namespace ostraka::experiments

// Objects of known classes, read from files or synthetic, for learning and classification.
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
    bool learnt = true, asked = true;  ///< used for learning; used for classification
};

/// Reads <class>/<number>.off, sorted by class and number, at most `maximum` per class.
std::vector<ClassObject> read_class_objects(const std::string& folder, std::size_t maximum);
/// The human segmentation of a model that agrees best with the others: greatest mean adjusted Rand index.
std::vector<std::int32_t> typical_labels(const Path& folder, const Mesh& mesh);
/// Transfers the regions of a labelled mesh to another mesh of the same object.
AnnotationSet parts_on(const Mesh& mesh, const Mesh& labelled, const std::vector<std::int32_t>& labels);

/// Seven out-of-class objects: knots, a torus, a ball, a rod, a disc and a star.
std::vector<ClassObject> made_strangers();
/// Eight synthetic classes of `learnt` + `asked` objects each, with random variation between members.
std::vector<ClassObject> made_classes(std::size_t learnt, std::size_t asked, std::uint64_t seed, std::uint64_t vertices);

}  // namespace ostraka::experiments

// Parts of the objects of a collection: annotated ones, or such as the toolkit proposes.
#pragma once

#include "ostraka/collection/objects.h"
#include "ostraka/core/mesh.h"
#include "ostraka/vocabulary/tag_words.h"

#include <exception>

namespace ostraka {

struct PartOptions {
    std::vector<std::string> annotations;
    std::vector<std::string> without;
    enum class Proposal { none, tube, top, segment } proposed = Proposal::none;

    void describe(OptionList& visit);
};

/// What a study looks at of each object.
struct ObjectPart {
    Mesh mesh;
    std::vector<std::int32_t> face_labels;    ///< of its faces, where the file has labels
    std::optional<std::array<double, 3>> up;  ///< as the annotations have it
    std::exception_ptr annotations_error;     ///< why annotations that no part is asked of cannot be read; null if they can
};

class ObjectParts {
public:
    /// The checksum is that of the vocabulary that `words` compares by. Throws Error (usage) where a proposal and annotations are
    /// both asked for.
    explicit ObjectParts(PartOptions options = {}, TagWords words = TagWords(), std::string words_checksum = {});

    /// The whole objects are meant.
    [[nodiscard]] bool whole() const;
    /// What kept results depend on.
    [[nodiscard]] std::vector<std::string> key() const;
    /// Reads an object and cuts the part out, along its outlines. Regions of any of `annotations` (all, where there are none) but
    /// those of `without`, which an object need not have. A proposal is cut off across `up` (else as the annotations have it,
    /// else z): "tube" is the tubular part (slicing/slice_axes.h) of 100 slices; "top" is what is above the neck: the slice in
    /// the upper half with the smallest radius against the largest below and the largest above it, at most 0.8 of both;
    /// "segment" is the largest of the segments by thickness (select/scalars.h), of a closed object. Throws
    /// Error (input), naming the file, where the object has no such part.
    [[nodiscard]] ObjectPart read(const CollectionObject& object, const std::optional<std::array<double, 3>>& up = {}) const;

private:
    PartOptions options_;
    TagWords words_;
    std::string checksum_;
};

}  // namespace ostraka

// Parts of the objects of a collection: annotated parts, or parts proposed by the toolkit.
#pragma once

#include "ostraka/collection/objects.h"
#include "ostraka/mesh/mesh.h"
#include "ostraka/vocabulary/tag_matcher.h"

#include <exception>

namespace ostraka {

/// Which part of each object is analysed.
struct PartOptions {
    /// Ids or tags of the regions that form the part; empty: the whole object.
    std::vector<std::string> annotations;
    std::vector<std::string> without;  ///< ids or tags of regions that are removed from the part
    /// Part that the toolkit detects by shape, for objects without annotations.
    enum class Proposal { none, tube, top, segment } proposed = Proposal::none;

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// The part of an object that a study examines.
struct ObjectPart {
    Mesh mesh;                                ///< the part as a mesh
    std::vector<std::int32_t> face_labels;    ///< one per face, if the file has labels
    std::optional<std::array<double, 3>> up;  ///< up direction from the annotations
    /// The error of reading the annotations, if the part does not depend on them; null if they were read.
    std::exception_ptr annotations_error;
};

/// Reads objects of a collection and cuts out the part that a study examines.
class ObjectParts {
public:
    /// `words_checksum` is the checksum of the vocabulary in `words`. Throws Error (usage) if both a proposal and annotations
    /// are requested.
    explicit ObjectParts(PartOptions options = {}, TagMatcher words = TagMatcher(), std::string words_checksum = {});

    /// True if whole objects are selected, not parts.
    [[nodiscard]] bool whole() const;
    /// The options that influence results, as texts for the key under which results are stored (ResultStore::key).
    [[nodiscard]] std::vector<std::string> key() const;
    /// Reads an object and cuts out the selected part along its outlines: the union of the regions in `annotations` (the whole
    /// mesh if the list is empty) minus the regions in `without`; regions in `without` may be absent. A detected part is cut
    /// off perpendicular to `up`; if `up` is not given, perpendicular to the up direction in the annotations, or else to z.
    /// "tube" is the tubular part (slicing/slice_axes.h) found with 100 slices. "top" is the part above the neck. The neck is
    /// the slice in the upper half with the smallest radius relative to the largest radii below and above the slice; its radius
    /// must be at most 0.8 of both. "segment" is the largest segment by thickness (select/scalars.h) of a closed object. Throws
    /// Error (input), naming the file, if the object has no such part.
    [[nodiscard]] ObjectPart read(const CollectionObject& object, const std::optional<std::array<double, 3>>& up = {}) const;

private:
    PartOptions options_;
    TagMatcher words_;
    std::string checksum_;
};

}  // namespace ostraka

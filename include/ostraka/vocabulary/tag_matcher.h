// Compares tags with words by meaning, using the concepts of a vocabulary in any language, or without a vocabulary by spelling.
#pragma once

#include "ostraka/vocabulary/vocabulary.h"

#include <memory>

namespace ostraka {

/// Compares tags of annotations with words. With a vocabulary, which must outlive the matcher, a tag means a word if the concept
/// of the tag is the concept of the word or a narrower one; a tag that is not in the vocabulary is compared by spelling.
/// Comparison by spelling ignores case, blanks and a number at the end of the tag ("flower 3" means "flower"). Calls are
/// thread-safe.
class TagMatcher {
public:
    explicit TagMatcher(const Vocabulary* vocabulary = nullptr);  ///< null: tags are compared by spelling

    /// True if the tag means the word.
    [[nodiscard]] bool means(const std::string& tag, const std::string& word) const;
    /// A text that is equal for tags with the same meaning: the same concept, or the same spelling. Numbers are distinguished:
    /// "flower 3" and "flower 4" differ.
    [[nodiscard]] std::string key(const std::string& tag) const;
    /// Indices of the annotations to which a name refers. If the name is the id of an annotation, this annotation; otherwise the
    /// annotations whose tag means the name (without a vocabulary, the annotations whose tag equals the name exactly, if there
    /// are any). Empty if there are none.
    [[nodiscard]] std::vector<std::size_t> find(const AnnotationSet& set, const std::string& name) const;
    /// Indices of the annotations to which a name refers, as `find`; throws Error (input), naming `where` and the nearest tag, if
    /// there are none.
    [[nodiscard]] std::vector<std::size_t> require(const AnnotationSet& set, const std::string& name,
                                                   const std::string& where) const;
    /// Renames tags of `set` to the equivalent tags of `reference`. If there is no equivalent tag, a tag is replaced by a
    /// broader tag of the reference, provided that only one tag of the reference is broader ("grip" becomes "handle" if the
    /// reference has only handles). Other tags are unchanged.
    void rename_like(AnnotationSet& set, const AnnotationSet& reference) const;

private:
    std::shared_ptr<const VocabularySearch> search_;
};

/// Throws Error (input) with the message that the annotations of `where` have none with this name, and suggests the nearest
/// tag.
[[noreturn]] void fail_unknown_annotation(const AnnotationSet& set, const std::string& name, const std::string& where);

}  // namespace ostraka

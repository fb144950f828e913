// Which tags a word means: by a vocabulary its concept and narrower ones, whatever the language; without one its letters.
#pragma once

#include "ostraka/vocabulary/vocabulary.h"

#include <memory>

namespace ostraka {

/// Compares tags. With a vocabulary, which must outlive it, a tag means a word if its concept is the word's or narrower; a tag
/// that the vocabulary does not have is compared by its letters. Letters: case and blanks do not count, nor does a number at the
/// end of the tag ("flower 3" is a flower). Safe for several threads at once.
class TagWords {
public:
    explicit TagWords(const Vocabulary* vocabulary = nullptr);

    /// Does the tag mean the word?
    [[nodiscard]] bool means(const std::string& tag, const std::string& word) const;
    /// One text for all tags that mean the same: one concept, or the same letters. Numbers tell "flower 3" and "flower 4" apart.
    [[nodiscard]] std::string key(const std::string& tag) const;
    /// The annotations (places in the set) that the name means: of that id, if it is a number that one has; else those whose tag
    /// means it, without a vocabulary those tagged to the letter alone where there are any. Empty if there are none.
    [[nodiscard]] std::vector<std::size_t> find(const AnnotationSet& set, const std::string& name) const;
    /// The same; throws Error (input), naming `where` and the nearest tag, if there are none.
    [[nodiscard]] std::vector<std::size_t> require(const AnnotationSet& set, const std::string& name,
                                                   const std::string& where) const;
    /// Tags of `set` become those of `reference` that are the same, or where there is none and only one that they mean, that one
    /// ("grip" becomes "handle" where the reference has handles alone). Others stay.
    void rename_like(AnnotationSet& set, const AnnotationSet& reference) const;

private:
    std::shared_ptr<const VocabularySearch> search_;
};

/// Throws Error (input): `where` has no annotation of this name; the nearest tag is proposed.
[[noreturn]] void fail_unknown_annotation(const AnnotationSet& set, const std::string& name, const std::string& where);

}  // namespace ostraka

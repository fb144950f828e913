#include "ostraka/vocabulary/tag_matcher.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/nearest_name.h"
#include "ostraka/core/text.h"
#include "ostraka/vocabulary/text_match.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

namespace ostraka {

TagMatcher::TagMatcher(const Vocabulary* vocabulary) {
    if (vocabulary != nullptr) search_ = std::make_shared<const VocabularySearch>(*vocabulary);
}

bool TagMatcher::means(const std::string& tag, const std::string& word) const {
    if (search_) {
        const auto tagged = search_->concept_of(tag), named = search_->concept_of(word);
        if (tagged && named) return search_->is_a(*tagged, *named);
    }
    const std::string text = folded(tag), folded_word = folded(word);
    return text == folded_word || without_number(text) == folded_word;
}

std::string TagMatcher::key(const std::string& tag) const {
    const std::string text = folded(tag);
    if (!search_) return text;
    const auto concept_index = search_->concept_of(tag);
    // Ids may contain any text; a control character distinguishes them from plain tags.
    return concept_index ? "\x01" + search_->vocabulary().concepts[*concept_index].id + text.substr(without_number(text).size())
                         : text;
}

std::vector<std::size_t> TagMatcher::find(const AnnotationSet& set, const std::string& name) const {
    const auto indices_where = [&](const auto& predicate) {
        std::vector<std::size_t> indices;
        for (std::size_t i = 0; i < set.annotations.size(); ++i)
            if (predicate(set.annotations[i])) indices.push_back(i);
        return indices;
    };
    int id = 0;
    const auto [end, code] = std::from_chars(name.data(), name.data() + name.size(), id);
    if (code == std::errc() && end == name.data() + name.size())
        if (auto indices = indices_where([&](const Annotation& annotation) { return annotation.id == id; }); !indices.empty())
            return indices;
    if (auto indices = indices_where([&](const Annotation& annotation) { return annotation.tag == name; });
        !indices.empty() && !search_)
        return indices;
    return indices_where([&](const Annotation& annotation) { return annotation.tag == name || means(annotation.tag, name); });
}

void TagMatcher::rename_like(AnnotationSet& set, const AnnotationSet& reference) const {
    std::set<std::string> tags;
    std::map<std::string, std::vector<std::string>> by_key;
    for (const Annotation& annotation : reference.annotations)
        if (tags.insert(annotation.tag).second) by_key[key(annotation.tag)].push_back(annotation.tag);
    for (Annotation& annotation : set.annotations) {
        if (tags.contains(annotation.tag)) continue;
        std::vector<std::string> candidates;
        if (const auto entry = by_key.find(key(annotation.tag)); entry != by_key.end()) candidates = entry->second;
        if (candidates.empty())
            std::copy_if(tags.begin(), tags.end(), std::back_inserter(candidates),
                         [&](const std::string& tag) { return means(annotation.tag, tag); });
        if (candidates.size() == 1) annotation.tag = candidates.front();
    }
}

std::vector<std::size_t> TagMatcher::require(const AnnotationSet& set, const std::string& name, const std::string& where) const {
    std::vector<std::size_t> indices = find(set, name);
    if (!indices.empty()) return indices;
    fail_unknown_annotation(set, name, where);
}

void fail_unknown_annotation(const AnnotationSet& set, const std::string& name, const std::string& where) {
    std::vector<std::string> tags;
    for (const Annotation& annotation : set.annotations) tags.push_back(annotation.tag);
    const std::string suggestion = name.size() > 100 ? std::string() : nearest_name(name, tags);
    fail_input(where, fmt::format("has no annotation '{}'", printable(name, 60)),
               (suggestion.empty() ? "" : fmt::format("did you mean '{}'? ", printable(suggestion, 60))) +
                   "give an id or a tag; 'ostraka annotation list' shows them");
}

}  // namespace ostraka

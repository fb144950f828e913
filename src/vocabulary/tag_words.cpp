#include "ostraka/vocabulary/tag_words.h"

#include "ostraka/core/error.h"
#include "ostraka/core/nearest_name.h"
#include "ostraka/core/text.h"
#include "ostraka/core/words.h"
#include "ostraka/vocabulary/text_match.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

namespace ostraka {

TagWords::TagWords(const Vocabulary* vocabulary) {
    if (vocabulary != nullptr) search_ = std::make_shared<const VocabularySearch>(*vocabulary);
}

bool TagWords::means(const std::string& tag, const std::string& word) const {
    if (search_) {
        const auto tagged = search_->concept_of(tag), wanted = search_->concept_of(word);
        if (tagged && wanted) return search_->is_a(*tagged, *wanted);
    }
    const std::string text = folded(tag), other = folded(word);
    return text == other || without_number(text) == other;
}

std::string TagWords::key(const std::string& tag) const {
    const std::string text = folded(tag);
    if (!search_) return text;
    const auto meant = search_->concept_of(tag);
    // Ids may contain any text; a control character distinguishes them from plain tags.
    return meant ? "\x01" + search_->vocabulary().concepts[*meant].id + text.substr(without_number(text).size()) : text;
}

std::vector<std::size_t> TagWords::find(const AnnotationSet& set, const std::string& name) const {
    const auto all = [&](const auto& holds) {
        std::vector<std::size_t> found;
        for (std::size_t i = 0; i < set.annotations.size(); ++i)
            if (holds(set.annotations[i])) found.push_back(i);
        return found;
    };
    int id = 0;
    const auto [end, code] = std::from_chars(name.data(), name.data() + name.size(), id);
    if (code == std::errc() && end == name.data() + name.size())
        if (auto found = all([&](const Annotation& one) { return one.id == id; }); !found.empty()) return found;
    if (auto found = all([&](const Annotation& one) { return one.tag == name; }); !found.empty() && !search_) return found;
    return all([&](const Annotation& one) { return one.tag == name || means(one.tag, name); });
}

void TagWords::rename_like(AnnotationSet& set, const AnnotationSet& reference) const {
    std::set<std::string> tags;
    std::map<std::string, std::vector<std::string>> by_key;
    for (const Annotation& one : reference.annotations)
        if (tags.insert(one.tag).second) by_key[key(one.tag)].push_back(one.tag);
    for (Annotation& one : set.annotations) {
        if (tags.contains(one.tag)) continue;
        std::vector<std::string> meant;
        if (const auto same = by_key.find(key(one.tag)); same != by_key.end()) meant = same->second;
        if (meant.empty())
            std::copy_if(tags.begin(), tags.end(), std::back_inserter(meant),
                         [&](const std::string& tag) { return means(one.tag, tag); });
        if (meant.size() == 1) one.tag = meant.front();
    }
}

std::vector<std::size_t> TagWords::require(const AnnotationSet& set, const std::string& name, const std::string& where) const {
    std::vector<std::size_t> found = find(set, name);
    if (!found.empty()) return found;
    fail_unknown_annotation(set, name, where);
}

void fail_unknown_annotation(const AnnotationSet& set, const std::string& name, const std::string& where) {
    std::vector<std::string> tags;
    for (const Annotation& annotation : set.annotations) tags.push_back(annotation.tag);
    const std::string near = name.size() > 100 ? std::string() : nearest_name(name, tags);
    fail_input(where, "has no annotation '" + printable(name, 60) + "'",
               (near.empty() ? "" : "did you mean '" + printable(near, 60) + "'? ") +
                   "give the id or the tag of one; 'ostraka annotation list' shows them");
}

}  // namespace ostraka

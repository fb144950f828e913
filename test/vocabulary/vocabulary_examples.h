// A small vocabulary and annotations for its tests.
#pragma once

#include "annotation/example_meshes.h"
#include "ostraka/vocabulary/vocabulary.h"

namespace ostraka::example {

inline const char* const bust_vocabulary = R"({"format": "ostraka-vocabulary", "version": 1, "uri": "https://example.org/bust",
 "title": {"en": "Busts", "it": "Busti"},
 "attributes": [{"name": "material", "values": ["clay", {"name": "marble", "label": {"it": "marmo", "de": "Marmor"}}]}],
 "concepts": [
  {"id": "head", "label": {"en": "head", "it": "testa"}, "definition": {"en": "With \"face\" & <hair>."},
   "attributes": [{"name": "height", "min": 10, "max": 400, "unit": "mm"}, {"name": "remark"}]},
  {"id": "eye", "label": {"en": "eye", "it": "occhio", "de": "Auge"}, "broader": "head",
   "attributes": [{"name": "height", "min": 1, "max": 20.5, "unit": "mm"}]},
  {"id": "left eye", "label": {"en": "left eye"}, "broader": ["eye"]},
  {"id": "beard", "label": {"en": "beard", "it": "barba"}, "alternatives": {"en": ["whiskers", "goatee"]}, "broader": "head",
   "attributes": [{"name": "beard style", "label": {"it": "tipo di barba"}, "values": ["curly", "wavy", "straight"]},
                  {"name": "bumpiness", "min": 0, "unit": "1/mm"}, {"name": "width", "min": 0, "unit": "mm"}]},
  {"id": "nose", "label": "nose", "broader": "head"}, {"id": "rock", "label": {"en": "nose of rock", "de": "Nase"}},
  {"id": "n2", "label": {"de": "Nase"}, "broader": ["head", "rock"],
   "other": [{"property": "http://www.w3.org/2004/02/skos/core#related", "uri": "https://example.org/bust#nose"},
             {"property": "http://www.w3.org/2004/02/skos/core#note", "value": "a note", "language": "en"},
             {"property": "http://purl.org/dc/terms/created", "value": "2020-01-31", "datatype": "http://www.w3.org/2001/XMLSchema#date"}]}],
 "rules": [
  {"id": "smooth", "note": "hardly any relief", "concept": "beard", "if": [{"attribute": "bumpiness", "below": 0.1, "unit": "1/mm"}],
   "then": {"attribute": "beard style", "value": "straight"}},
  {"id": "rough", "concept": "beard", "if": [{"attribute": "bumpiness", "min": 0.1, "max": 0.5}, {"ratio": ["width", {"attribute": "height", "concept": "eye"}], "above": 2}],
   "then": {"attribute": "beard style", "value": "curly"}},
  {"id": "red", "if": [{"attribute": "remark", "is": ["red", "reddish"]}], "then": {"attribute": "material", "value": "clay"}}]})";

inline Vocabulary busts() { return vocabulary_from_json(parse_json(bust_vocabulary, "v"), "v"); }

inline Attribute word(const std::string& name, const std::string& value) {
    Attribute attribute;
    attribute.name = name;
    attribute.value = Note{value, {}};
    return attribute;
}

inline Attribute quantity(const std::string& name, double value, const std::string& unit) {
    Attribute attribute;
    attribute.name = name;
    attribute.value = Descriptor();
    attribute.descriptor()->values = {value};
    attribute.descriptor()->unit = unit;
    return attribute;
}

inline Annotation point(int id, const std::string& tag, std::vector<Attribute> attributes = {}) {
    Annotation annotation;
    annotation.id = id;
    annotation.tag = tag;
    annotation.type = AnnotationType::point;
    annotation.points = {static_cast<Index>(id)};
    annotation.attributes = std::move(attributes);
    for (std::size_t i = 0; i < annotation.attributes.size(); ++i) annotation.attributes[i].id = static_cast<int>(i);
    return annotation;
}

inline AnnotationSet set_of(std::vector<Annotation> annotations) {
    AnnotationSet set;
    set.annotations = std::move(annotations);
    set.unit = "mm";
    return set;
}

}  // namespace ostraka::example

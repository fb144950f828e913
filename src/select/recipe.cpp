#include "ostraka/select/recipe.h"

#include "expression.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/core/error.h"
#include "ostraka/measure/measure.h"

#include <set>

namespace ostraka {

namespace {

using std::to_string;

std::array<double, 3> vector_of(const JsonValue& list) { return {list[0].GetDouble(), list[1].GetDouble(), list[2].GetDouble()}; }

/// Members of a recipe must all be understood: a misspelt one would silently change the outcome.
class Cook {
public:
    Cook(const Mesh& mesh, const std::vector<std::int32_t>& face_labels, std::string where)
        : mesh_(mesh), where_(std::move(where)), evaluator_(mesh, face_labels, set_, where_) {}

    AnnotationSet follow(const JsonValue& recipe) {
        if (const JsonValue* name = find_member(recipe, "class")) set_.object_class = name->GetString();
        if (const JsonValue* unit = find_member(recipe, "unit")) set_.unit = unit->GetString();
        if (const JsonValue* up = find_member(recipe, "up")) set_.up = vector_of(*up);
        const Frame frame = ExpressionEvaluator::frame_of(recipe, Frame{});
        const JsonValue& steps = recipe["annotations"];
        for (rapidjson::SizeType i = 0; i < steps.Size(); ++i)
            set_.annotations.push_back(step(steps[i], frame, "/annotations/" + to_string(i)));
        if (!set_.object_class.empty()) ensure_root(set_, mesh_);
        check_annotations(set_, mesh_, where_);
        const RefreshResult measured = refresh_measures(mesh_, set_);
        if (!measured.notes.empty()) fail_input(where_, "a measure cannot be taken: " + measured.notes.front(), "mend its pins");
        return std::move(set_);
    }

private:
    [[noreturn]] void fail(const std::string& at, const std::string& what, const std::string& remedy) const {
        fail_input(where_, "at " + at + ": " + what, remedy);
    }

    Annotation step(const JsonValue& step, Frame around, const std::string& at) {
        const Frame frame = ExpressionEvaluator::frame_of(step, around);
        Annotation annotation;
        annotation.id = step["id"].GetInt();
        annotation.tag = std::string(step["tag"].GetString(), step["tag"].GetStringLength());
        annotation.colour = distinct_colour(set_.annotations.size());
        if (const JsonValue* colour = find_member(step, "colour"))
            for (rapidjson::SizeType k = 0; k < 3; ++k) annotation.colour[k] = (*colour)[k].GetInt();
        const JsonValue& select = step["select"];
        const std::string type = step["type"].GetString(), here = at + "/select";
        if (type == "region") {
            annotation.faces = flagged(evaluator_.faces(select, frame, here));
            annotation.all = kind_of(select).first == "all";
            if (annotation.faces.empty())
                fail(here, "selects no face", "the volume or the set misses the surface: look at the numbers and the frame");
        } else if (type == "line") {
            annotation.type = AnnotationType::line;
            annotation.polylines = evaluator_.polylines(select, frame, here);
        } else {
            annotation.type = AnnotationType::point;
            annotation.points = evaluator_.vertices(select, frame, here);
            if (annotation.points.empty())
                fail(here, "selects no vertex", "the volume or the set misses the vertices: look at the numbers and the frame");
        }
        if (const JsonValue* attributes = find_member(step, "attributes"))
            add_attributes(annotation, *attributes, frame, at + "/attributes");
        return annotation;
    }

    /// Attributes stand as in annotation files, except that pins may be given by coordinates, and those of a bounding measure may
    /// be left out.
    void add_attributes(Annotation& annotation, const JsonValue& source, Frame frame, const std::string& at) {
        Json list;
        list.CopyFrom(source, list.GetAllocator());
        for (rapidjson::SizeType i = 0; i < list.Size(); ++i) {
            const auto measure = list[i].FindMember("measure");
            if (measure == list[i].MemberEnd()) continue;
            const std::string here = at + '/' + to_string(i) + "/measure";
            JsonValue pins(rapidjson::kArrayType);
            if (const JsonValue* points = find_member(measure->value, "points")) {
                for (rapidjson::SizeType k = 0; k < points->Size(); ++k)
                    pins.PushBack(evaluator_.vertex((*points)[k], frame, here + "/points/" + to_string(k)), list.GetAllocator());
            } else {
                const JsonValue* direction = find_member(measure->value, "direction");
                if (direction == nullptr)
                    fail(here, "a measure with neither points nor a direction",
                         "give its pins, or the direction of a bounding measure");
                for (const Index pin : extremes(mesh_, annotation, vector_of(*direction)))
                    pins.PushBack(pin, list.GetAllocator());
            }
            measure->value.RemoveMember("points");
            measure->value.AddMember("points", pins, list.GetAllocator());
        }
        annotation.attributes = attributes_from_json(list, where_, at);
        for (Attribute& attribute : annotation.attributes) {
            if (attribute.type == AttributeType::measure && attribute.measure.unit.empty()) attribute.measure.unit = set_.unit;
            Descriptor& descriptor = attribute.descriptor;
            if (attribute.type != AttributeType::descriptor || !descriptor.values.empty() || !descriptor.file.empty() ||
                descriptor.is_list)
                continue;
            if (!evaluate(mesh_, annotation, attribute.name))
                fail(at,
                     "the descriptor '" + attribute.name + "' of a " + to_string(annotation.type) +
                         " has no value and cannot be computed",
                     "known ones are area, perimeter, circularity, length, volume; give others a value");
            descriptor.values.push_back(0);  // computed with the measures
            if (descriptor.unit.empty()) descriptor.unit = descriptor_unit(attribute.name, set_.unit);
        }
    }

    const Mesh& mesh_;
    std::string where_;
    AnnotationSet set_;
    ExpressionEvaluator evaluator_;
};

}  // namespace

AnnotationSet apply_recipe(const JsonValue& recipe, const Mesh& mesh, const std::vector<std::int32_t>& face_labels,
                           const std::string& where) {
    if (const JsonValue* format = find_member(recipe, "format");
        format != nullptr && format->IsString() && std::string(format->GetString()) != "ostraka-recipe")
        fail_input(where, std::string("at /format: the format is '") + format->GetString() + "'",
                   "give a recipe ('ostraka-recipe')");
    validate(recipe, "recipe", where);
    return Cook(mesh, face_labels, where).follow(recipe);
}

AnnotationSet apply_recipe(const Path& file, const Mesh& mesh, const std::vector<std::int32_t>& face_labels) {
    return apply_recipe(read_json(file), mesh, face_labels, file.string());
}

}  // namespace ostraka

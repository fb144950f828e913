#include "ostraka/select/recipe.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/colouring.h"
#include "ostraka/core/error.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/measure/measure.h"
#include "select/recipe_step.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace ostraka {

namespace {

/// Executes a recipe. Unknown members are rejected: a misspelt one would silently change the result.
class RecipeRunner {
public:
    RecipeRunner(const Mesh& mesh, RecipeStart start, std::string where)
        : mesh_(mesh),
          where_(std::move(where)),
          face_labels_(std::move(start.face_labels)),
          set_(std::move(start.annotations)),
          folder_(std::move(start.folder)),
          attributes_(start.attributes),
          evaluator_({mesh, set_}, face_labels_, where_) {
        for (const Annotation& one : set_.annotations) before_.insert(one.id);
    }

    AnnotationSet follow(const JsonValue& recipe) {
        if (const JsonValue* name = find_member(recipe, "class")) set_.object_class = name->GetString();
        if (const JsonValue* unit = find_member(recipe, "unit")) set_.unit = unit->GetString();
        if (const JsonValue* up = find_member(recipe, "up")) set_.up = triple_of(*up);
        const PlaceFrame frame = ExpressionEvaluator::frame_of(recipe, PlaceFrame{});
        surroundings_ = {find_member(recipe, "cameras"), frame, set_.up.value_or(std::array<double, 3>{0, 0, 1}), folder_,
                         attributes_};
        evaluator_.set_surroundings(surroundings_);
        const JsonValue& steps = recipe["annotations"];
        for (rapidjson::SizeType i = 0; i < steps.Size(); ++i) {
            const RecipeStep step = recipe_step_from_json(steps[i], frame, where_, "/annotations/" + std::to_string(i));
            touched_.insert(step.id);
            if (step.action == StepAction::make) make(step);
            else edit(step);
        }
        if (!set_.object_class.empty()) ensure_root(set_, mesh_);
        check_annotations({mesh_, set_}, where_);
        measure();
        return std::move(set_);
    }

private:
    [[noreturn]] void fail(const std::string& at, const std::string& what, const std::string& remedy) const {
        fail_input(where_, "at " + at + ": " + what, remedy);
    }

    /// Measures the annotations that steps made or changed; the others keep their values.
    void measure() {
        std::map<int, std::vector<Attribute>> others;
        for (Annotation& one : set_.annotations)
            if (before_.contains(one.id) && !touched_.contains(one.id)) others[one.id].swap(one.attributes);
        const RefreshResult measured = refresh_measures(mesh_, set_);
        if (!measured.notes.empty())
            fail_input(where_, "a measure cannot be taken: " + measured.notes.front(), "correct its pins");
        for (Annotation& one : set_.annotations)
            if (const auto kept = others.find(one.id); kept != others.end()) one.attributes.swap(kept->second);
    }

    /// A region from a selection on the mesh cut along the selection's borders. With `given` the selection is added to that
    /// region, taken away from it, or replaces it, according to the action.
    Annotation selected_free(const RecipeStep& step, const Annotation* given) {
        const std::string here = step.at + "/select";
        const auto [cut, named] = evaluator_.cut_selection(*step.select, step.frame, here);
        if (std::none_of(named.begin(), named.end(), [](bool b) { return b; }))
            fail(here, "selects no face", "the volume or the set misses the surface: look at the numbers and the frame");
        Annotation annotation;
        annotation.faces = flagged(named);
        if (given != nullptr && step.action != StepAction::replace) {
            std::vector<bool> flags = face_flags(cut.mesh, cut.annotations.find(given->id)->faces);
            for (const Index face : annotation.faces) flags[face] = step.action == StepAction::add_to;
            annotation.faces = flagged(flags);
        }
        annotation.all = annotation.faces.size() == cut.mesh.number_of_faces();
        if (annotation.all) {
            annotation.faces.resize(mesh_.number_of_faces());
            std::iota(annotation.faces.begin(), annotation.faces.end(), Index{0});
        } else if (!annotation.faces.empty()) {
            uncut_annotation(mesh_, cut, annotation);
        }
        return annotation;
    }

    /// As selected_free for lines, along geodesics; points cannot be free.
    Annotation drawn_free(AnnotationType type, const RecipeStep& step) {
        const std::string here = step.at + "/select";
        if (type == AnnotationType::point)
            fail(here, "selects vertices: there are no free points of a selection", "leave out \"outline\"");
        Annotation annotation;
        annotation.type = type;
        annotation.curves = evaluator_.curves(*step.select, step.frame, here);
        compute_elements(mesh_, annotation);
        return annotation;
    }

    /// A region with a free outline, combined with `given` if any. Returns nothing if the outline need not be free, or if no
    /// free one can be made; the reason is then stored for note_edges, and the region has to run along the edges of the mesh.
    std::optional<Annotation> region_where_drawn(const RecipeStep& step, StepOutline outline, const Annotation* given) {
        if (outline == StepOutline::edges) return std::nullopt;
        const bool drawn = outline == StepOutline::drawn;
        if (drawn && !evaluator_.ends_at_levels(*step.select, step.frame, step.at + "/select")) return std::nullopt;
        evaluator_.keep_face_sets(drawn);
        try {
            return selected_free(step, given);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled || error.kind() == ErrorKind::usage) throw;
            not_free_ = error.problem();
            return std::nullopt;
        }
    }

    /// Adds a note that the annotation was to have a free outline but has none.
    void note_edges(const Annotation& annotation) {
        if (not_free_.empty()) return;
        set_.notes.push_back(name_of(annotation) +
                             ": its outline runs along the edges of the mesh, since no free one could be made (" + not_free_ +
                             ")");
        not_free_.clear();
    }

    /// The faces, polylines or points that a step selects, as an annotation of this type.
    Annotation selected(AnnotationType type, const RecipeStep& step, StepOutline outline) {
        if (type == AnnotationType::region) {
            if (auto region = region_where_drawn(step, outline, nullptr)) return std::move(*region);
        } else if (outline == StepOutline::free) {
            return drawn_free(type, step);
        }
        const std::string here = step.at + "/select";
        const JsonValue& select = *step.select;
        Annotation annotation;
        annotation.type = type;
        if (type == AnnotationType::region) {
            annotation.faces = flagged(evaluator_.faces(select, step.frame, here));
            annotation.all = kind_of(select).first == "all";
            if (annotation.faces.empty())
                fail(here, "selects no face", "the volume or the set misses the surface: look at the numbers and the frame");
        } else if (type == AnnotationType::line) {
            annotation.polylines = evaluator_.polylines(select, step.frame, here);
        } else {
            annotation.points = evaluator_.vertices(select, step.frame, here);
            if (annotation.points.empty())
                fail(here, "selects no vertex", "the volume or the set misses the vertices: look at the numbers and the frame");
        }
        return annotation;
    }

    static void set_looks(Annotation& annotation, const RecipeStep& step) {
        if (step.tag) annotation.tag = *step.tag;
        if (step.colour) annotation.colour = *step.colour;
    }

    void make(const RecipeStep& step) {
        if (set_.find(step.id) != nullptr)
            fail(step.at + "/id", fmt::format("the id {} is taken", step.id),
                 fmt::format("give each annotation its own (free is {}), or an action such as 'add to' that edits the older one",
                             free_id(set_)));
        Annotation annotation = selected(*step.type, step, step.outline);
        annotation.id = step.id;
        annotation.colour = unused_colour({mesh_, set_}, annotation);
        set_looks(annotation, step);
        note_edges(annotation);
        if (step.attributes != nullptr) add_attributes(annotation, step);
        set_.annotations.push_back(std::move(annotation));
    }

    /// Checks that the members of a step suit its action.
    void check_edit(const RecipeStep& step, const Annotation& edited) const {
        const std::string action = to_string(step.action);
        if (step.selects() && step.select == nullptr)
            fail(step.at, fmt::format("the action '{}' without \"select\"", action), "say what to " + action);
        if (!step.selects() && step.select != nullptr)
            fail(step.at + "/select", fmt::format("the action '{}' selects nothing", action), "leave it out");
        if (step.type && *step.type != edited.type)
            fail(step.at + "/type", fmt::format("annotation {} is a {}", step.id, to_string(edited.type)),
                 "an edit keeps the type");
        const std::pair<const char*, bool> looks[]{
            {"tag", step.tag.has_value()}, {"colour", step.colour.has_value()}, {"attributes", step.attributes != nullptr}};
        for (const auto& [name, given] : looks)
            if (step.action == StepAction::erase && given)
                fail(step.at + '/' + name, "the action 'delete' keeps nothing", "leave it out");
        if (step.action == StepAction::retag && !step.tag && !step.colour && step.attributes == nullptr)
            fail(step.at, "the action 'retag' changes nothing", "give a tag, a colour or attributes");
    }

    void edit(const RecipeStep& step) {
        const int id = step.id;
        Annotation* found = set_.find(id);
        if (found == nullptr)
            fail(step.at + "/id", fmt::format("no annotation has the id {}", id), "edit one that is there at this step");
        check_edit(step, *found);
        if (step.action == StepAction::erase) {
            std::erase_if(set_.annotations, [&](const Annotation& a) { return a.id == id; });
            return;
        }
        Annotation annotation = *found;
        if (step.selects()) {
            change_elements(annotation, step);
            if (annotation.faces.empty() && annotation.polylines.empty() && annotation.points.empty() && !is_free(annotation))
                fail(step.at + "/select", fmt::format("leaves nothing of annotation {}", id),
                     "select less, or use the action 'delete'");
            for (Attribute& attribute : annotation.attributes)
                if (attribute.type == AttributeType::measure && attribute.measure.tool == "bounding" &&
                    attribute.measure.direction) {
                    const auto pins = extremes(mesh_, annotation, *attribute.measure.direction);
                    attribute.measure.points.assign(pins.begin(), pins.end());
                    attribute.measure.locations.clear();
                }
        }
        set_looks(annotation, step);
        if (step.attributes != nullptr) {
            for (const auto& attribute : step.attributes->GetArray())
                std::erase_if(annotation.attributes, [&](const Attribute& a) { return a.id == attribute["id"].GetInt(); });
            Annotation fresh = annotation;
            fresh.attributes.clear();
            add_attributes(fresh, step);
            for (Attribute& attribute : fresh.attributes) annotation.attributes.push_back(std::move(attribute));
        }
        *set_.find(id) = std::move(annotation);
    }

    /// Adds what an edit selects, takes it away, or replaces the annotation by it. An edited outline keeps its type, free or
    /// along the edges; a replaced outline has the type of a new one.
    void change_elements(Annotation& annotation, const RecipeStep& step) {
        const Annotation before = annotation;
        const bool was_free = is_free(before);
        StepOutline outline = step.outline;
        if (outline == StepOutline::drawn && step.action != StepAction::replace && !before.all)
            outline = was_free ? StepOutline::free : StepOutline::edges;
        if (annotation.type == AnnotationType::region) {
            if (auto region = region_where_drawn(step, outline, &before)) {
                annotation.faces = std::move(region->faces);
                annotation.curves = std::move(region->curves);
                annotation.all = region->all;
                return;
            }
            const Annotation part = selected(annotation.type, step, StepOutline::edges);
            note_edges(annotation);
            annotation.curves.clear();
            change(annotation, step.action, part);
            return;
        }
        const bool free = outline == StepOutline::free || (was_free && outline == StepOutline::drawn);
        const Annotation part = selected(annotation.type, step, free ? StepOutline::free : StepOutline::edges);
        // If one of the lines is free the result is free; other lines become curves along the edges.
        if (free || was_free) change_curves(annotation, step, part);
        else change(annotation, step.action, part);
    }

    void change_curves(Annotation& annotation, const RecipeStep& step, const Annotation& part) const {
        if (step.action == StepAction::replace) {
            annotation.polylines = part.polylines;
            annotation.points = part.points;
            annotation.curves = part.curves;
            return;
        }
        if (step.action != StepAction::add_to)
            fail(step.at + "/select", fmt::format("takes a part from a {} that is free", to_string(annotation.type)),
                 "use the action 'replace'");
        const auto as_curves = [](const Annotation& one) {
            if (is_free(one)) return one.curves;
            std::vector<std::vector<SurfacePoint>> curves;
            for (const auto& line : one.polylines) curves.push_back(vertex_curve(line));
            for (const Index v : one.points) curves.push_back(vertex_curve({v}));
            return curves;
        };
        auto curves = as_curves(annotation);
        for (auto& curve : as_curves(part)) curves.push_back(std::move(curve));
        annotation.curves = std::move(curves);
        compute_elements(mesh_, annotation);
    }

    void change(Annotation& annotation, StepAction action, const Annotation& part) const {
        const bool add = action == StepAction::add_to;
        if (action == StepAction::replace) {
            annotation.faces = part.faces;
            annotation.polylines = part.polylines;
            annotation.points = part.points;
            annotation.all = part.all;
        } else if (annotation.type == AnnotationType::region) {
            std::vector<bool> flags = face_flags(mesh_, annotation.faces);
            for (const Index face : part.faces) flags[face] = add;
            annotation.faces = flagged(flags);
            annotation.all = annotation.all && annotation.faces.size() == mesh_.number_of_faces();
        } else if (annotation.type == AnnotationType::point) {
            const std::set<Index> before(annotation.points.begin(), annotation.points.end()),
                named(part.points.begin(), part.points.end());
            if (!add) std::erase_if(annotation.points, [&](Index v) { return named.contains(v); });
            for (const Index v : part.points)
                if (add && !before.contains(v)) annotation.points.push_back(v);
        } else if (add) {
            annotation.polylines.insert(annotation.polylines.end(), part.polylines.begin(), part.polylines.end());
        } else {
            annotation.polylines = without_edges(annotation.polylines, part.polylines);
        }
    }

    /// The parts of polylines that remain without the edges of others.
    static std::vector<std::vector<Index>> without_edges(const std::vector<std::vector<Index>>& lines,
                                                         const std::vector<std::vector<Index>>& others) {
        std::set<std::pair<Index, Index>> gone;
        for (const auto& line : others)
            for (std::size_t i = 0; i + 1 < line.size(); ++i) gone.insert(std::minmax(line[i], line[i + 1]));
        std::vector<std::vector<Index>> left;
        for (const auto& line : lines) {
            const std::size_t before = left.size();
            std::vector<Index> piece;
            for (std::size_t i = 0; i + 1 < line.size(); ++i) {
                if (gone.contains(std::minmax(line[i], line[i + 1]))) {
                    if (piece.size() > 1) left.push_back(piece);
                    piece.clear();
                    continue;
                }
                if (piece.empty()) piece.push_back(line[i]);
                piece.push_back(line[i + 1]);
            }
            if (piece.size() > 1) left.push_back(piece);
            // A closed line that was cut elsewhere continues across its first vertex.
            if (left.size() > before + 1 && line.front() == line.back() && left[before].front() == line.front() &&
                left.back().back() == line.back()) {
                left.back().insert(left.back().end(), left[before].begin() + 1, left[before].end());
                left.erase(left.begin() + static_cast<std::ptrdiff_t>(before));
            }
        }
        return left;
    }

    /// Attributes are written as in annotation files, except that pins may be given by coordinates, and that a bounding measure
    /// may omit its pins.
    void add_attributes(Annotation& annotation, const RecipeStep& step) {
        const std::string at = step.at + "/attributes";
        Json list;
        list.CopyFrom(*step.attributes, list.GetAllocator());
        for (rapidjson::SizeType i = 0; i < list.Size(); ++i) {
            const auto measure = list[i].FindMember("measure");
            if (measure == list[i].MemberEnd()) continue;
            const std::string here = at + '/' + std::to_string(i) + "/measure";
            JsonValue pins(rapidjson::kArrayType);
            if (const JsonValue* points = find_member(measure->value, "points")) {
                for (rapidjson::SizeType k = 0; k < points->Size(); ++k)
                    pins.PushBack(evaluator_.vertex((*points)[k], step.frame, here + "/points/" + std::to_string(k)),
                                  list.GetAllocator());
            } else {
                const JsonValue* direction = find_member(measure->value, "direction");
                if (direction == nullptr)
                    fail(here, "a measure with neither points nor a direction",
                         "give its pins, or the direction of a bounding measure");
                for (const Index pin : extremes(mesh_, annotation, triple_of(*direction)))
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
            descriptor.values.push_back(0);  // placeholder; computed with the measures
            if (descriptor.unit.empty()) descriptor.unit = descriptor_unit(attribute.name, set_.unit);
        }
    }

    const Mesh& mesh_;
    std::string where_;
    std::vector<std::int32_t> face_labels_;
    AnnotationSet set_;
    Path folder_;
    const MeshExtras* attributes_;
    std::set<int> before_, touched_;  ///< ids of annotations that existed before, and of those that steps edit
    std::string not_free_;            ///< why the last outline could not be free
    Surroundings surroundings_;
    ExpressionEvaluator evaluator_;
};

void collect_maps(const JsonValue& value, const Path& folder, std::vector<Path>& files) {
    if (value.IsArray())
        for (const auto& item : value.GetArray()) collect_maps(item, folder, files);
    if (!value.IsObject()) return;
    for (const auto& member : value.GetObject()) {
        if (std::string(member.name.GetString()) == "threshold" && member.value.IsObject())
            if (const JsonValue* map = find_member(member.value, "map"); map != nullptr && map->IsString()) {
                const Path file = file_inside(text_of(*map), folder, "", "threshold/map", "the recipe's folder",
                                              "move the map beside the recipe");
                if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
            }
        collect_maps(member.value, folder, files);
    }
}

}  // namespace

std::vector<Path> files_named_by(const JsonValue& recipe, const Path& folder) {
    std::vector<Path> files;
    collect_maps(recipe, folder, files);
    return files;
}

AnnotationSet follow_recipe(const JsonValue& recipe, const Mesh& mesh, RecipeStart start, const std::string& where) {
    check_format(recipe, "ostraka-recipe", where, "give a recipe ('ostraka-recipe')");
    validate(recipe, "recipe", where);
    return RecipeRunner(mesh, std::move(start), where).follow(recipe);
}

AnnotationSet apply_recipe(const JsonValue& recipe, const Mesh& mesh, const std::vector<std::int32_t>& face_labels,
                           const std::string& where) {
    return follow_recipe(recipe, mesh, RecipeStart{face_labels, {}, {}, nullptr}, where);
}

AnnotationSet apply_recipe(const Path& file, const Mesh& mesh, const std::vector<std::int32_t>& face_labels) {
    return follow_recipe(read_json(file), mesh, RecipeStart{face_labels, {}, file.parent_path(), nullptr}, file.string());
}

}  // namespace ostraka

#include "ostraka/select/recipe.h"

#include "expression.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/colouring.h"
#include "ostraka/core/error.h"
#include "ostraka/core/safe_path.h"
#include "ostraka/measure/measure.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace ostraka {

namespace {

using std::to_string;

AnnotationType type_of(const std::string& name) {
    return name == "point" ? AnnotationType::point : name == "line" ? AnnotationType::line : AnnotationType::region;
}

/// Type of a region's outline.
enum class Outline {
    drawn,  ///< free if part of the border is a level of a field; sets of faces end along the edges of the mesh
    edges,
    free,  ///< always free: sets of faces end at isolines
};

/// Executes a recipe. Unknown members are rejected: a misspelt one would silently change the result.
class RecipeRunner {
public:
    RecipeRunner(const Mesh& mesh, RecipeStart start, std::string where)
        : mesh_(mesh),
          where_(std::move(where)),
          face_labels_(std::move(start.face_labels)),
          set_(std::move(start.annotations)),
          folder_(std::move(start.folder)),
          evaluator_(mesh, face_labels_, set_, where_) {
        for (const Annotation& one : set_.annotations) before_.insert(one.id);
    }

    AnnotationSet follow(const JsonValue& recipe) {
        if (const JsonValue* name = find_member(recipe, "class")) set_.object_class = name->GetString();
        if (const JsonValue* unit = find_member(recipe, "unit")) set_.unit = unit->GetString();
        if (const JsonValue* up = find_member(recipe, "up")) set_.up = triple_of(*up);
        const PlaceFrame frame = ExpressionEvaluator::frame_of(recipe, PlaceFrame{});
        surroundings_ = {find_member(recipe, "cameras"), frame, set_.up.value_or(std::array<double, 3>{0, 0, 1}), folder_};
        evaluator_.look_from(surroundings_);
        const JsonValue& steps = recipe["annotations"];
        for (rapidjson::SizeType i = 0; i < steps.Size(); ++i) step(steps[i], frame, "/annotations/" + to_string(i));
        if (!set_.object_class.empty()) ensure_root(set_, mesh_);
        check_annotations(set_, mesh_, where_);
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

    void step(const JsonValue& step, PlaceFrame around, const std::string& at) {
        touched_.insert(step["id"].GetInt());
        const PlaceFrame frame = ExpressionEvaluator::frame_of(step, around);
        const std::string action = text_in(step, "action");
        if (action.empty() || action == "make") make(step, frame, at);
        else edit(action, step, frame, at);
    }

    /// A region from a selection on the mesh cut along the selection's borders. With `given` the selection is added to that
    /// region, taken away from it, or replaces it, according to the action.
    Annotation selected_free(const JsonValue& select, PlaceFrame frame, const std::string& here, const std::string& action,
                             const Annotation* given) {
        const auto [cut, named] = evaluator_.cut_selection(select, frame, here);
        if (std::none_of(named.begin(), named.end(), [](bool b) { return b; }))
            fail(here, "selects no face", "the volume or the set misses the surface: look at the numbers and the frame");
        Annotation annotation;
        annotation.faces = flagged(named);
        if (given != nullptr && action != "replace") {
            std::vector<bool> flags = face_flags(cut.mesh, cut.annotations.find(given->id)->faces);
            for (const Index face : annotation.faces) flags[face] = action == "add to";
            annotation.faces = flagged(flags);
        }
        annotation.all = annotation.faces.size() == cut.mesh.number_of_faces();
        if (annotation.all) {
            annotation.faces.resize(mesh_.number_of_faces());
            std::iota(annotation.faces.begin(), annotation.faces.end(), Index{0});
        } else if (!annotation.faces.empty()) {
            bring_back(mesh_, cut, annotation);
        }
        return annotation;
    }

    /// As selected_free for lines, along geodesics; points cannot be free.
    Annotation drawn_free(AnnotationType type, const JsonValue& select, PlaceFrame frame, const std::string& here) {
        if (type == AnnotationType::point)
            fail(here, "selects vertices: there are no free points of a selection", "leave out \"outline\"");
        Annotation annotation;
        annotation.type = type;
        annotation.curves = evaluator_.curves(select, frame, here);
        settle_elements(mesh_, annotation);
        return annotation;
    }

    /// The outline that a step specifies; default `drawn`.
    static Outline outline_of(const JsonValue& step) {
        const std::string asked = text_in(step, "outline");
        return asked == "free" ? Outline::free : asked == "edges" ? Outline::edges : Outline::drawn;
    }

    /// A region with a free outline, combined with `given` if any. Returns nothing if the outline need not be free, or if no
    /// free one can be made; the reason is then stored for note_edges, and the region has to run along the edges of the mesh.
    std::optional<Annotation> region_where_drawn(const JsonValue& select, PlaceFrame frame, const std::string& here,
                                                 Outline outline, const std::string& action, const Annotation* given) {
        if (outline == Outline::edges) return std::nullopt;
        if (outline == Outline::drawn && !evaluator_.ends_at_levels(select, frame, here)) return std::nullopt;
        evaluator_.keep_face_sets(outline == Outline::drawn);
        try {
            return selected_free(select, frame, here, action, given);
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
    Annotation selected(AnnotationType type, const JsonValue& select, PlaceFrame frame, const std::string& here,
                        Outline outline) {
        if (type == AnnotationType::region) {
            if (auto region = region_where_drawn(select, frame, here, outline, "make", nullptr)) return std::move(*region);
        } else if (outline == Outline::free) {
            return drawn_free(type, select, frame, here);
        }
        Annotation annotation;
        annotation.type = type;
        if (type == AnnotationType::region) {
            annotation.faces = flagged(evaluator_.faces(select, frame, here));
            annotation.all = kind_of(select).first == "all";
            if (annotation.faces.empty())
                fail(here, "selects no face", "the volume or the set misses the surface: look at the numbers and the frame");
        } else if (type == AnnotationType::line) {
            annotation.polylines = evaluator_.polylines(select, frame, here);
        } else {
            annotation.points = evaluator_.vertices(select, frame, here);
            if (annotation.points.empty())
                fail(here, "selects no vertex", "the volume or the set misses the vertices: look at the numbers and the frame");
        }
        return annotation;
    }

    void set_looks(Annotation& annotation, const JsonValue& step) const {
        if (const JsonValue* tag = find_member(step, "tag")) annotation.tag = text_of(*tag);
        if (const JsonValue* colour = find_member(step, "colour"))
            for (rapidjson::SizeType k = 0; k < 3; ++k) annotation.colour[k] = (*colour)[k].GetInt();
    }

    void make(const JsonValue& step, PlaceFrame frame, const std::string& at) {
        for (const char* name : {"tag", "type", "select"})
            if (find_member(step, name) == nullptr)
                fail(at, std::string("a new annotation without \"") + name + "\"",
                     "add it, or name the action that edits an older one");
        const int id = step["id"].GetInt();
        if (set_.find(id) != nullptr)
            fail(at + "/id", "the id " + to_string(id) + " is taken",
                 "give each annotation its own (free is " + to_string(free_id(set_)) +
                     "), or an action such as 'add to' that edits the older one");
        Annotation annotation =
            selected(type_of(step["type"].GetString()), step["select"], frame, at + "/select", outline_of(step));
        annotation.id = id;
        annotation.colour = fresh_colour(mesh_, set_, annotation);
        set_looks(annotation, step);
        note_edges(annotation);
        if (const JsonValue* attributes = find_member(step, "attributes"))
            add_attributes(annotation, *attributes, frame, at + "/attributes");
        set_.annotations.push_back(std::move(annotation));
    }

    void edit(const std::string& action, const JsonValue& step, PlaceFrame frame, const std::string& at) {
        const int id = step["id"].GetInt();
        Annotation* found = set_.find(id);
        if (found == nullptr)
            fail(at + "/id", "no annotation has the id " + to_string(id), "edit one that is there at this step");
        const JsonValue* select = find_member(step, "select");
        const bool changes = action != "delete" && action != "retag";
        if (changes && select == nullptr) fail(at, "the action '" + action + "' without \"select\"", "say what to " + action);
        if (!changes && select != nullptr) fail(at + "/select", "the action '" + action + "' selects nothing", "leave it out");
        if (const JsonValue* type = find_member(step, "type"); type != nullptr && type_of(type->GetString()) != found->type)
            fail(at + "/type", "annotation " + to_string(id) + " is a " + to_string(found->type), "an edit keeps the type");
        if (action == "delete") {
            for (const char* name : {"tag", "colour", "attributes"})
                if (find_member(step, name) != nullptr)
                    fail(at + '/' + name, "the action 'delete' keeps nothing", "leave it out");
            std::erase_if(set_.annotations, [&](const Annotation& a) { return a.id == id; });
            return;
        }
        if (action == "retag" && find_member(step, "tag") == nullptr && find_member(step, "colour") == nullptr &&
            find_member(step, "attributes") == nullptr)
            fail(at, "the action 'retag' changes nothing", "give a tag, a colour or attributes");
        Annotation annotation = *found;
        if (changes) {
            const std::string here = at + "/select";
            change_elements(annotation, action, *select, frame, here, outline_of(step));
            if (annotation.faces.empty() && annotation.polylines.empty() && annotation.points.empty() && !is_free(annotation))
                fail(here, "leaves nothing of annotation " + to_string(id), "select less, or use the action 'delete'");
            for (Attribute& attribute : annotation.attributes)
                if (attribute.type == AttributeType::measure && attribute.measure.tool == "bounding" &&
                    attribute.measure.direction) {
                    const auto pins = extremes(mesh_, annotation, *attribute.measure.direction);
                    attribute.measure.points.assign(pins.begin(), pins.end());
                    attribute.measure.locations.clear();
                }
        }
        set_looks(annotation, step);
        if (const JsonValue* attributes = find_member(step, "attributes")) {
            for (const auto& attribute : attributes->GetArray())
                std::erase_if(annotation.attributes, [&](const Attribute& a) { return a.id == attribute["id"].GetInt(); });
            Annotation fresh = annotation;
            fresh.attributes.clear();
            add_attributes(fresh, *attributes, frame, at + "/attributes");
            for (Attribute& attribute : fresh.attributes) annotation.attributes.push_back(std::move(attribute));
        }
        *set_.find(id) = std::move(annotation);
    }

    /// Adds what an edit selects, takes it away, or replaces the annotation by it. An edited outline keeps its type, free or
    /// along the edges; a replaced outline has the type of a new one.
    void change_elements(Annotation& annotation, const std::string& action, const JsonValue& select, PlaceFrame frame,
                         const std::string& here, Outline outline) {
        const Annotation before = annotation;
        const bool was_free = is_free(before);
        if (outline == Outline::drawn && action != "replace" && !before.all) outline = was_free ? Outline::free : Outline::edges;
        if (annotation.type == AnnotationType::region) {
            auto region = region_where_drawn(select, frame, here, outline, action, &before);
            if (region) {
                annotation.faces = std::move(region->faces);
                annotation.curves = std::move(region->curves);
                annotation.all = region->all;
                return;
            }
            const Annotation part = selected(annotation.type, select, frame, here, Outline::edges);
            note_edges(annotation);
            annotation.curves.clear();
            change(annotation, action, part);
            return;
        }
        const bool free = outline == Outline::free || (was_free && outline == Outline::drawn);
        const Annotation part = selected(annotation.type, select, frame, here, free ? Outline::free : Outline::edges);
        // If one of the lines is free the result is free; other lines become curves along the edges.
        if (free || was_free) change_curves(annotation, action, part, here);
        else change(annotation, action, part);
    }

    void change_curves(Annotation& annotation, const std::string& action, const Annotation& part, const std::string& here) const {
        if (action == "replace") {
            annotation.polylines = part.polylines;
            annotation.points = part.points;
            annotation.curves = part.curves;
            return;
        }
        if (action != "add to")
            fail(here, "takes a part from a " + to_string(annotation.type) + " that is free", "use the action 'replace'");
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
        settle_elements(mesh_, annotation);
    }

    void change(Annotation& annotation, const std::string& action, const Annotation& part) const {
        const bool add = action == "add to";
        if (action == "replace") {
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
    void add_attributes(Annotation& annotation, const JsonValue& source, PlaceFrame frame, const std::string& at) {
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
    return follow_recipe(recipe, mesh, RecipeStart{face_labels, {}, {}}, where);
}

AnnotationSet apply_recipe(const Path& file, const Mesh& mesh, const std::vector<std::int32_t>& face_labels) {
    return follow_recipe(read_json(file), mesh, RecipeStart{face_labels, {}, file.parent_path()}, file.string());
}

}  // namespace ostraka

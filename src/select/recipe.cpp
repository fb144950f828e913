#include "ostraka/select/recipe.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/colouring.h"
#include "ostraka/core/error.h"
#include "ostraka/measure/measure.h"
#include "select/evaluator.h"
#include "select/recipe_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace ostraka {

namespace {

/// Executes a recipe.
class RecipeRunner {
public:
    RecipeRunner(const Mesh& mesh, RecipeStart start, std::string where)
        : mesh_(mesh),
          where_(std::move(where)),
          face_labels_(std::move(start.face_labels)),
          set_(std::move(start.annotations)),
          attributes_(start.attributes),
          evaluator_({mesh, set_}, face_labels_, where_) {
        for (const Annotation& one : set_.annotations) before_.insert(one.id);
    }

    AnnotationSet follow(const Recipe& recipe) {
        if (recipe.object_class) set_.object_class = *recipe.object_class;
        if (recipe.unit) set_.unit = *recipe.unit;
        if (recipe.up) set_.up = recipe.up;
        evaluator_.set_surroundings({set_.up.value_or(std::array<double, 3>{0, 0, 1}), attributes_});
        for (const RecipeStep& step : recipe.steps) {
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
        const auto [cut, named] = evaluator_.cut_selection(*step.select);
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
        annotation.curves = evaluator_.curves(*step.select);
        compute_elements(mesh_, annotation);
        return annotation;
    }

    /// A region with a free outline, combined with `given` if any. Returns nothing if the outline need not be free, or if no
    /// free one can be made; the reason is then stored for note_edges, and the region has to run along the edges of the mesh.
    std::optional<Annotation> region_where_drawn(const RecipeStep& step, StepOutline outline, const Annotation* given) {
        if (outline == StepOutline::edges) return std::nullopt;
        const bool drawn = outline == StepOutline::drawn;
        if (drawn && !evaluator_.ends_at_levels(*step.select)) return std::nullopt;
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
        const SelectionExpression& select = *step.select;
        Annotation annotation;
        annotation.type = type;
        if (type == AnnotationType::region) {
            annotation.faces = flagged(evaluator_.faces(select));
            annotation.all = std::holds_alternative<selection::WholeMesh>(select.kind);
            if (annotation.faces.empty())
                fail(here, "selects no face", "the volume or the set misses the surface: look at the numbers and the frame");
        } else if (type == AnnotationType::line) {
            annotation.polylines = evaluator_.polylines(select);
        } else {
            annotation.points = evaluator_.vertices(select);
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
        if (step.attributes) add_attributes(annotation, step);
        set_.annotations.push_back(std::move(annotation));
    }

    void edit(const RecipeStep& step) {
        const int id = step.id;
        Annotation* found = set_.find(id);
        if (found == nullptr)
            fail(step.at + "/id", fmt::format("no annotation has the id {}", id), "edit one that is there at this step");
        if (step.type && *step.type != found->type)
            fail(step.at + "/type", fmt::format("annotation {} is a {}", id, to_string(found->type)), "an edit keeps the type");
        if (step.action == StepAction::erase) {
            std::erase_if(set_.annotations, [&](const Annotation& a) { return a.id == id; });
            return;
        }
        Annotation annotation = *found;
        if (step.select) {
            change_elements(annotation, step);
            if (annotation.faces.empty() && annotation.polylines.empty() && annotation.points.empty() && !is_free(annotation))
                fail(step.at + "/select", fmt::format("leaves nothing of annotation {}", id),
                     "select less, or use the action 'delete'");
            for (Attribute& attribute : annotation.attributes)
                if (attribute.measure() != nullptr && attribute.measure()->tool == "bounding" && attribute.measure()->direction) {
                    const auto pins = extremes(mesh_, annotation, *attribute.measure()->direction);
                    attribute.measure()->points.assign(pins.begin(), pins.end());
                    attribute.measure()->locations.clear();
                }
        }
        set_looks(annotation, step);
        if (step.attributes) {
            for (const StepAttribute& given : *step.attributes)
                std::erase_if(annotation.attributes, [&](const Attribute& a) { return a.id == given.attribute.id; });
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

    /// Vertices of the pins of a measure of this annotation.
    std::vector<Index> pins_of_measure(const StepAttribute& given, const Annotation& annotation) const {
        std::vector<Index> pins;
        for (const selection::Pick& pin : given.pins) pins.push_back(evaluator_.vertex(pin));
        const Measure* measure = given.attribute.measure();
        if (!given.pins.empty() || measure == nullptr || !measure->direction) return pins;
        const auto outermost = extremes(mesh_, annotation, *measure->direction);
        return {outermost.begin(), outermost.end()};
    }

    /// Replaces the attributes of the annotation by those of the step.
    void add_attributes(Annotation& annotation, const RecipeStep& step) {
        const std::string at = step.at + "/attributes";
        std::vector<Attribute> attributes;
        for (const StepAttribute& given : *step.attributes) {
            const std::vector<Index> pins = pins_of_measure(given, annotation);
            attributes.push_back(given.attribute);
            if (Measure* measure = attributes.back().measure()) measure->points = pins;
        }
        annotation.attributes = std::move(attributes);
        for (Attribute& attribute : annotation.attributes) {
            if (attribute.measure() != nullptr && attribute.measure()->unit.empty()) attribute.measure()->unit = set_.unit;
            if (attribute.descriptor() == nullptr) continue;
            Descriptor& descriptor = *attribute.descriptor();
            if (!descriptor.values.empty() || !descriptor.file.empty() || descriptor.is_list) continue;
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
    const MeshExtras* attributes_;
    std::set<int> before_, touched_;  ///< ids of annotations that existed before, and of those that steps edit
    std::string not_free_;            ///< why the last outline could not be free
    ExpressionEvaluator evaluator_;
};

}  // namespace

AnnotationSet follow_recipe(const JsonValue& recipe, const Mesh& mesh, RecipeStart start, const std::string& where) {
    const Recipe typed = recipe_from_json(recipe, start.folder, where);
    return RecipeRunner(mesh, std::move(start), where).follow(typed);
}

AnnotationSet apply_recipe(const JsonValue& recipe, const Mesh& mesh, const std::vector<std::int32_t>& face_labels,
                           const std::string& where) {
    return follow_recipe(recipe, mesh, RecipeStart{face_labels, {}, {}, nullptr}, where);
}

AnnotationSet apply_recipe(const Path& file, const Mesh& mesh, const std::vector<std::int32_t>& face_labels) {
    return follow_recipe(read_json(file), mesh, RecipeStart{face_labels, {}, file.parent_path(), nullptr}, file.string());
}

}  // namespace ostraka

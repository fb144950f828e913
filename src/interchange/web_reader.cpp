// Conversion of W3C Web Annotation JSON-LD to annotations.
#include "ostraka/interchange/web_annotation.h"

#include "interchange/iiif_comments.h"
#include "interchange/landmark_formats.h"
#include "interchange/placing.h"
#include "interchange/text.h"
#include "interchange/web_terms.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/error.h"
#include "ostraka/files/json_build.h"
#include "ostraka/measure/measure.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

namespace ostraka {

namespace {

using namespace interchange;

/// Whether `text` is one of the strings of a JSON-LD member, which may be a single value or a list.
bool has_value(const JsonValue* value, std::string_view text) {
    if (value == nullptr) return false;
    if (value->IsString()) return text == text_of(*value);
    if (!value->IsArray()) return false;
    return std::any_of(value->Begin(), value->End(), [&](const JsonValue& entry) { return has_value(&entry, text); });
}

/// The objects of a member, which may be a single value or a list.
std::vector<const JsonValue*> listed(const JsonValue* value) {
    std::vector<const JsonValue*> objects;
    if (value == nullptr) return objects;
    if (!value->IsArray()) objects.push_back(value);
    else
        for (const auto& entry : value->GetArray()) objects.push_back(&entry);
    return objects;
}

bool is_selector(const JsonValue& value, const std::string& name) {
    const JsonValue* type = find_member(value, "type");
    return has_value(type, name) || has_value(type, web::terms + name.substr(name.find(':') + 1));
}

/// The part of a region on one connected component of its original mesh.
struct RegionPart {
    double area = 0;
    Point inside{0, 0, 0};
    std::vector<std::vector<Index>> outlines;  ///< vertices of this mesh nearest to the outlines; empty: the whole component
};

/// The faces of the region, ascending. Outlines are connected along edges and filled by winding number; `remarks` reports if
/// the area of a part changed by more than a twentieth or a part vanished.
std::vector<Index> region_of(Placer& placer, const std::vector<RegionPart>& parts, const std::string& where,
                             std::vector<std::string>& remarks) {
    const Mesh& mesh = placer.mesh();
    std::vector<bool> selected(mesh.number_of_faces(), false);
    for (const RegionPart& part : parts) {
        std::vector<bool> flags;
        if (part.outlines.empty()) {
            flags = placer.component(placer.nearest(part.inside).face);
        } else {
            std::vector<std::vector<Index>> vertex_paths;
            for (const auto& outline : part.outlines) {
                std::vector<Index> vertex_path = placer.vertex_path(outline, true, where);
                if (vertex_path.size() > 3) vertex_paths.push_back(std::move(vertex_path));
            }
            flags = placer.fill(vertex_paths, part.area);
        }
        double area = 0;
        for (std::size_t f = 0; f < flags.size(); ++f)
            if (flags[f]) {
                area += face_area(mesh, Face(static_cast<Index>(f)));
                selected[f] = true;
            }
        if (area == 0) remarks.emplace_back("a part of the region vanished on this mesh");
        else if (std::abs(area - part.area) > part.area / 20)
            remarks.push_back(fmt::format("a part's area of {} became {} on this mesh", digits(part.area), digits(area)));
    }
    return flagged(selected);
}

class WebReader {
public:
    WebReader(const Mesh& mesh, const std::string& where, const PlaceOptions& options)
        : mesh_(mesh), where_(where), options_(options), checksum_(mesh_checksum(mesh)) {
        native_.SetObject();
    }

    PlacedAnnotations read(const JsonValue& document) {
        JsonValue annotations(rapidjson::kArrayType);
        auto items = items_of(document);
        const std::vector<Json> comments = place_comments(items);
        for (const auto& [item, pointer] : items) {
            if (!has_value(find_member(*item, "type"), "Annotation")) {
                note(pointer, "is not an Annotation; left out");
                continue;
            }
            validate(*item, "web-annotation", fmt::format("{}, in {}", where_, pointer.empty() ? "the root" : pointer));
            JsonValue annotation = annotation_of(*item, pointer);
            if (annotation.IsObject()) annotations.PushBack(annotation, a());
        }
        if (annotations.Empty() && left_out_ > 0)
            fail_input(where_, "none of its annotations could be placed on this mesh",
                       "see the notes, or give the mesh it is about");
        return placed_annotations(native_, std::move(annotations), find_member(document, "about"), mesh_, where_, !by_place_,
                                  std::move(notes_), std::move(placements_));
    }

private:
    JsonAllocator& a() { return native_.GetAllocator(); }
    void note(const std::string& pointer, const std::string& text) {
        notes_.push_back(fmt::format("at {}: {}", pointer.empty() ? "the root" : pointer, text));
    }

    /// Replaces annotations with points or well-known text as targets by annotations with places on the mesh, which are returned.
    std::vector<Json> place_comments(std::vector<std::pair<const JsonValue*, std::string>>& items) {
        std::vector<SceneTarget> targets;
        bool any = false;
        for (const auto& [item, pointer] : items) {
            targets.push_back(has_value(find_member(*item, "type"), "Annotation")
                                  ? scene_target(*item, fmt::format("{}, in {}", where_, pointer))
                                  : SceneTarget());
            any = any || targets.back().kind != SceneTarget::Kind::none;
        }
        std::vector<Json> placed_items;
        if (!any) return placed_items;
        const SceneMotion motion = scene_motion(targets, placer(), options_.tolerance);
        if (!motion.text.empty()) notes_.push_back(motion.text);
        placed_items.reserve(items.size());
        for (std::size_t i = 0; i < items.size(); ++i) {
            if (targets[i].kind == SceneTarget::Kind::none) continue;
            placed_items.push_back(with_places(*items[i].first, targets[i], motion, placer()));
            items[i].first = &placed_items.back();
        }
        return placed_items;
    }

    std::vector<std::pair<const JsonValue*, std::string>> items_of(const JsonValue& document) {
        std::vector<std::pair<const JsonValue*, std::string>> items;
        const auto add_list = [&](const JsonValue& page_items, const std::string& pointer) {
            if (!page_items.IsArray())
                fail_input(where_, fmt::format("at {}: is not a list", pointer), "correct or regenerate the file");
            for (rapidjson::SizeType i = 0; i < page_items.Size(); ++i)
                items.emplace_back(&page_items[i], fmt::format("{}/{}", pointer, i));
        };
        const JsonValue* type = find_member(document, "type");
        if (document.IsArray()) {
            add_list(document, "");
        } else if (is_iiif(document)) {
            items = iiif_comments(document);
            if (items.empty())
                fail_input(where_, "the IIIF document contains no comments",
                           "give a manifest whose annotation pages are embedded, or the page itself");
        } else if (has_value(type, "AnnotationCollection")) {
            const JsonValue* page = find_member(document, "first");
            const JsonValue* page_items = page == nullptr ? nullptr : find_member(*page, "items");
            if (page_items == nullptr)
                fail_input(where_, "at /first: the collection's page is not embedded",
                           "give the page, or a collection that contains it");
            add_list(*page_items, "/first/items");
            if (find_member(*page, "next") != nullptr) note("/first/next", "further pages are not fetched");
        } else if (has_value(type, "AnnotationPage")) {
            const JsonValue* page_items = find_member(document, "items");
            if (page_items == nullptr) fail_input(where_, "at /items: the page has no items", "give a page with its annotations");
            add_list(*page_items, "/items");
            if (find_member(document, "next") != nullptr) note("/next", "further pages are not fetched");
        } else if (has_value(type, "Annotation")) {
            items.emplace_back(&document, "");
        } else {
            fail_input(where_, "contains no Annotation, AnnotationPage, AnnotationCollection or IIIF manifest",
                       "give a file of the W3C model or of IIIF Presentation");
        }
        return items;
    }

    /// The content of the annotation: our own data if available, otherwise its texts.
    Json data_of(const JsonValue& item, const std::string& pointer) {
        Json data(rapidjson::kObjectType);
        std::vector<std::string> tags, descriptions;
        if (const JsonValue* body_value = find_member(item, "bodyValue")) descriptions.push_back(text_of(*body_value));
        for (const JsonValue* body : listed(find_member(item, "body"))) {
            if (!body->IsObject()) continue;
            const std::string value = text_in(*body, "value");
            if (has_value(find_member(*body, "format"), "application/json")) {
                Json parsed = parse_json(value, fmt::format("{}, in {}/body", where_, pointer));
                if (parsed.IsObject() && find_member(parsed, "id") != nullptr && find_member(parsed, "tag") != nullptr)
                    return parsed;
            }
            const JsonValue* purpose = find_member(*body, "purpose");
            (has_value(purpose, "tagging") || has_value(purpose, "classifying") ? tags : descriptions).push_back(value);
        }
        auto& allocator = data.GetAllocator();
        if (tags.empty() && !descriptions.empty()) {
            tags.push_back(descriptions.front());
            descriptions.erase(descriptions.begin());
        }
        if (tags.empty()) note(pointer, "an annotation without a text");
        add_member(data, "tag", tags.empty() ? "" : tags.front(), allocator);
        JsonValue attributes(rapidjson::kArrayType);
        const auto add = [&](const char* name, const std::string& text) {
            JsonValue attribute = json_object(allocator, "id", attributes.Size(), "name", name, "type", "semantic", "note", text);
            attributes.PushBack(attribute, allocator);
        };
        for (std::size_t i = 1; i < tags.size(); ++i) add("tag", tags[i]);
        for (const std::string& text : descriptions) add("description", text);
        add_member(data, "attributes", std::move(attributes), allocator);
        return data;
    }

    /// Null if it cannot be placed.
    JsonValue annotation_of(const JsonValue& item, const std::string& pointer) {
        const auto targets = listed(find_member(item, "target"));
        if (targets.size() > 1) note(pointer, fmt::format("has {}; the first is used", counted(targets.size(), "target")));
        const JsonValue* by_index = nullptr;
        const JsonValue* by_place = nullptr;
        const JsonValue* source = find_member(*targets.front(), "source");
        const auto selectors = listed(find_member(*targets.front(), "selector"));
        for (const JsonValue* selector : selectors) {
            if (by_index == nullptr && is_selector(*selector, web::index_selector)) by_index = find_member(*selector, "indices");
            if (by_place == nullptr && is_selector(*selector, web::place_selector)) by_place = find_member(*selector, "places");
        }
        Json data = data_of(item, pointer);
        const std::string tag = text_in(data, "tag");
        JsonValue result(rapidjson::kObjectType);
        const int id = id_of(data, tag);
        add_members(result, a(), "id", id);
        copy_members(result, a(), data, {"tag", "colour", "note"});
        JsonValue attributes(rapidjson::kArrayType);
        if (const JsonValue* value = find_member(data, "attributes")) attributes.CopyFrom(*value, a());
        PlacedAnnotation placement{id, tag, 0, 0, 0, "indices"};

        const bool same_mesh = source != nullptr && text_in(*source, "sha256") == checksum_;
        if (by_index != nullptr && same_mesh) {
            for (const auto& member : by_index->GetObject()) add_members(result, a(), text_of(member.name), member.value);
            add_members(result, a(), "type", text_in(data, "type"));
        } else if (by_place != nullptr) {
            by_place_ = true;
            if (!place(*by_place, result, attributes, placement, pointer)) {
                ++left_out_;
                return {};
            }
        } else if (selectors.empty()) {
            add_members(result, a(), "type", "region", "all", true);
            placement.how = "whole";
        } else {
            note(pointer, by_index != nullptr ? "made for another mesh and without coordinates; left out"
                                              : "has an unknown selector; left out");
            ++left_out_;
            return {};
        }
        add_member(result, "attributes", std::move(attributes), a());
        placements_.push_back(placement);
        return result;
    }

    int id_of(const JsonValue& data, const std::string& tag) {
        const JsonValue* given_id = find_member(data, "id");
        int id = given_id != nullptr && given_id->IsInt() ? given_id->GetInt() : 0;
        if (given_id != nullptr && given_id->IsInt() && ids_.insert(id).second) return id;
        for (id = 0; !ids_.insert(id).second;) ++id;
        if (given_id != nullptr) notes_.push_back(fmt::format("'{}' received the id {}, because its own is in use", tag, id));
        return id;
    }

    Placer& placer() {
        if (!placer_) placer_ = std::make_unique<Placer>(mesh_);
        return *placer_;
    }

    /// nullopt if a point is too far away and far points may be skipped.
    std::optional<std::vector<Placed>> placed(const JsonValue& list, PlacedAnnotation& placement, const std::string& pointer) {
        std::vector<Placed> result;
        const double limit = options_.tolerance * placer().diagonal();
        for (const auto& entry : list.GetArray()) {
            const auto position = triple(&entry);
            if (!position)
                fail_input(where_, fmt::format("in {}: a position that is not finite", pointer),
                           "correct or regenerate the file");
            check_position(*position, fmt::format("{}, in {}", where_, pointer));
            const Placed p = placer().place(Point((*position)[0], (*position)[1], (*position)[2]));
            if (p.to_surface > limit) {
                const std::string problem =
                    fmt::format("a point lies {} from the surface, farther than {}", digits(p.to_surface), digits(limit));
                if (!options_.skip_far)
                    fail_input(where_, fmt::format("in {}: {}", pointer, problem),
                               "give the mesh the file is about in the same unit and position, raise --tolerance, or skip such "
                               "points with --skip-far");
                note(pointer, problem + "; skipped as requested");
                return {};
            }
            ++placement.points;
            placement.to_surface = std::max(placement.to_surface, p.to_surface);
            placement.to_vertex = std::max(placement.to_vertex, p.to_vertex);
            result.push_back(p);
        }
        return result;
    }

    static std::vector<Index> vertices(const std::vector<Placed>& places) {
        std::vector<Index> result;
        for (const Placed& p : places) result.push_back(p.vertex);
        return result;
    }

    bool place(const JsonValue& places, JsonValue& result, JsonValue& attributes, PlacedAnnotation& placement,
               const std::string& pointer) {
        placement.how = "places";
        if (const JsonValue* points = find_member(places, "points")) {
            const auto placed_points = placed(*points, placement, pointer);
            if (!placed_points) return false;
            add_members(result, a(), "type", "point", "points", vertices(*placed_points));
        } else if (const JsonValue* polylines = find_member(places, "polylines")) {
            std::vector<std::vector<Index>> placed_polylines;
            for (const auto& polyline : polylines->GetArray()) {
                const auto placed_points = placed(polyline["points"], placement, pointer);
                if (!placed_points) return false;
                std::vector<Index> vertex_path = placer().vertex_path(vertices(*placed_points), polyline["closed"].GetBool(),
                                                                      fmt::format("{}, in {}", where_, pointer));
                if (vertex_path.size() > 1) placed_polylines.push_back(std::move(vertex_path));
                else note(pointer, "a poly-line collapsed to a point on this mesh and was left out");
            }
            if (placed_polylines.empty()) return false;
            add_members(result, a(), "type", "line", "polylines", placed_polylines);
        } else if (flag_in(places, "all")) {
            add_members(result, a(), "type", "region", "all", true);
        } else if (const JsonValue* parts = find_member(places, "parts")) {
            std::vector<RegionPart> region_parts;
            for (const auto& part : parts->GetArray()) {
                RegionPart& region_part = region_parts.emplace_back();
                region_part.area = part["area"].GetDouble();
                const auto inside = triple(&part["inside"]);
                if (!inside)
                    fail_input(where_, fmt::format("in {}: a position that is not finite", pointer),
                               "correct or regenerate the file");
                check_position(*inside, fmt::format("{}, in {}", where_, pointer));
                region_part.inside = Point((*inside)[0], (*inside)[1], (*inside)[2]);
                for (const auto& outline : part["outlines"].GetArray()) {
                    const auto placed_points = placed(outline, placement, pointer);
                    if (!placed_points) return false;
                    region_part.outlines.push_back(vertices(*placed_points));
                }
            }
            std::vector<std::string> remarks;
            const std::vector<Index> faces =
                region_of(placer(), region_parts, fmt::format("{}, in {}", where_, pointer), remarks);
            for (const auto& remark : remarks) note(pointer, remark);
            if (faces.empty()) return false;
            add_members(result, a(), "type", "region", "faces", faces);
        } else {
            note(pointer, "a selector without positions; left out");
            return false;
        }
        if (const JsonValue* pins = find_member(places, "pins"))
            place_pins(*pins, find_member(places, "repeats"), attributes, pointer);
        return true;
    }

    /// Places pins at the nearest points of the surface; their measures are stale until recomputed.
    void place_pins(const JsonValue& pins, const JsonValue* repeats, JsonValue& attributes, const std::string& pointer) {
        if (!attributes.IsArray()) return;
        for (auto& attribute : attributes.GetArray()) {
            if (!attribute.IsObject() || text_in(attribute, "type") != "measure") continue;
            const JsonValue* id = find_member(attribute, "id");
            const JsonValue* pin_list = id != nullptr && id->IsInt() ? find_member(pins, std::to_string(id->GetInt())) : nullptr;
            if (pin_list == nullptr || !attribute.HasMember("measure") || !attribute["measure"].IsObject()) continue;
            PlacedAnnotation pinned;  // pins may lie inside faces, so the distance to vertices is not meaningful
            const auto placed_pins = placed(*pin_list, pinned, pointer);
            JsonValue& measure = attribute["measure"];
            if (!placed_pins) continue;
            for (const char* name : {"points", "locations", "stale", "repeats"}) measure.RemoveMember(name);
            JsonValue locations(rapidjson::kArrayType);
            bool inside = false;
            for (rapidjson::SizeType i = 0; i < pin_list->Size(); ++i) {
                const auto p = triple(&(*pin_list)[i]);
                const SurfaceHit hit = placer().nearest(Point((*p)[0], (*p)[1], (*p)[2]));
                JsonValue location = json_object(a(), "face", hit.face, "barycentric", hit.barycentric);
                locations.PushBack(location, a());
                inside = inside || (*placed_pins)[i].to_vertex > 1e-9 * placer().diagonal();
            }
            add_members(measure, a(), "points", vertices(*placed_pins));
            if (inside) add_member(measure, "locations", std::move(locations), a());
            add_members(measure, a(), "stale", true);
            if (repeats == nullptr) continue;
            std::vector<std::vector<Index>> placed_repeats;
            for (const auto& picked : list_in(*repeats, std::to_string(id->GetInt())))
                if (const auto placed_picking = placed(picked, pinned, pointer))
                    placed_repeats.push_back(vertices(*placed_picking));
            add_nonempty_members(measure, a(), "repeats", placed_repeats);
        }
    }

    const Mesh& mesh_;
    const std::string& where_;
    const PlaceOptions& options_;
    std::string checksum_;
    std::unique_ptr<Placer> placer_;
    Json native_;
    std::vector<std::string> notes_;
    std::vector<PlacedAnnotation> placements_;
    std::set<int> ids_;
    std::size_t left_out_ = 0;
    bool by_place_ = false;
};

}  // namespace

PlacedAnnotations read_web_annotations(const std::string& bytes, const Mesh& mesh, const std::string& where,
                                       const PlaceOptions& options) {
    check_options(options, "web annotations");
    const Json document = parse_json(bytes, where);
    return WebReader(mesh, where, options).read(document);
}

}  // namespace ostraka

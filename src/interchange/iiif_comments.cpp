#include "interchange/iiif_comments.h"

#include "interchange/text.h"
#include "interchange/web_terms.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/files/json_build.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

namespace ostraka::interchange {

namespace {

using Eigen::Vector3d;
using Chain = std::vector<Vector3d>;

bool is_one_of(const JsonValue* type, std::initializer_list<const char*> names) {
    if (type == nullptr) return false;
    if (type->IsArray())
        return std::any_of(type->Begin(), type->End(), [&](const JsonValue& entry) { return is_one_of(&entry, names); });
    return type->IsString() && std::any_of(names.begin(), names.end(), [&](const char* name) { return text_of(*type) == name; });
}

void collect(const JsonValue& value, const std::string& pointer, std::vector<std::pair<const JsonValue*, std::string>>& found) {
    if (value.IsArray()) {
        for (rapidjson::SizeType i = 0; i < value.Size(); ++i) collect(value[i], fmt::format("{}/{}", pointer, i), found);
        return;
    }
    if (!value.IsObject()) return;
    if (is_one_of(find_member(value, "type"), {"Annotation"})) {
        // Content painted into a scene, such as the model, cameras and lights, says nothing about the object.
        if (!is_one_of(find_member(value, "motivation"), {"painting", "activating", "supplementing"}))
            found.emplace_back(&value, pointer);
        return;
    }
    for (const char* name : {"items", "annotations", "first"})
        if (const JsonValue* member = find_member(value, name)) collect(*member, pointer + "/" + name, found);
}

/// Visits the objects of a member, which may be one or a list.
template <class Visit>
void each(const JsonValue* value, const Visit& visit) {
    if (value == nullptr) return;
    if (value->IsArray()) {
        for (const auto& entry : value->GetArray()) each(&entry, visit);
    } else if (value->IsObject()) visit(*value);
}

const JsonValue* spatial_selector(const JsonValue& target) {
    const JsonValue* found = nullptr;
    each(find_member(target, "selector"), [&](const JsonValue& selector) {
        if (found != nullptr) return;
        if (is_one_of(find_member(selector, "type"), {"PointSelector", "WktSelector", "WKTSelector"})) found = &selector;
        else
            each(find_member(selector, "refinedBy"), [&](const JsonValue& refined) {
                if (found == nullptr && is_one_of(find_member(refined, "type"), {"PointSelector", "WktSelector", "WKTSelector"}))
                    found = &refined;
            });
    });
    if (found != nullptr) return found;
    each(find_member(target, "source"), [&](const JsonValue& source) {
        if (found == nullptr) found = spatial_selector(source);
    });
    return found;
}

/// Reader of well-known text: groups of numbers in parentheses.
class WktReader {
public:
    WktReader(std::string_view text, const std::string& where) : text_(text), where_(where) {}

    SceneTarget read() {
        std::string name;
        for (; at_ < text_.size() && text_[at_] != '('; ++at_)
            if (std::isalpha(static_cast<unsigned char>(text_[at_])) != 0)
                name += static_cast<char>(std::toupper(static_cast<unsigned char>(text_[at_])));
        SceneTarget target;
        for (const char* suffix : {"ZM", "Z", "M"})
            if (name.ends_with(suffix)) {
                measured_ = std::string_view(suffix) == "M";
                name = name.substr(0, name.size() - std::string_view(suffix).size());
                break;
            }
        if (name == "POINT" || name == "MULTIPOINT") target.kind = SceneTarget::Kind::points;
        else if (name == "LINESTRING" || name == "MULTILINESTRING" || name == "LINEARRING")
            target.kind = SceneTarget::Kind::lines;
        else if (name == "POLYGON" || name == "MULTIPOLYGON" || name == "TRIANGLE" || name == "POLYHEDRALSURFACE" ||
                 name == "TIN")
            target.kind = SceneTarget::Kind::areas;
        else fail(fmt::format("'{}' is no known geometry of well-known text", printable(name, 30)));
        group(target, 0, false);
        while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
        if (at_ < text_.size()) fail("the well-known text goes on after its geometry");
        if (target.chains.empty()) fail("the well-known text has no points");
        return target;
    }

private:
    [[noreturn]] void fail(const std::string& problem) const {
        fail_input(where_, problem, "write for example POINT Z (1 2 3) or POLYGON Z ((0 0 0, 1 0 0, 1 1 0, 0 0 0))");
    }
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

    /// "(" numbers and groups ")"; the numbers directly in a group are one chain. `later`: not the first group in its group.
    void group(SceneTarget& target, int depth, bool later) {
        if (depth > 8) fail("the well-known text is nested too deep");
        ++at_;  // (
        std::size_t groups = 0;
        Chain chain;
        std::vector<double> tuple;
        const auto close_tuple = [&] {
            if (tuple.empty()) return;
            const std::size_t size = tuple.size() % 3 == 0 ? 3 : tuple.size();  // a missing comma between points
            if (size != 2 && size != 3 && size != 4)
                fail(fmt::format("a point of the well-known text has {} numbers", tuple.size()));
            for (std::size_t i = 0; i < tuple.size(); i += size)
                chain.emplace_back(tuple[i], tuple[i + 1], size == 2 || (measured_ && size == 3) ? 0 : tuple[i + 2]);
            tuple.clear();
        };
        for (;;) {
            if (at_ >= text_.size()) fail("the well-known text ends within its parentheses");
            const char c = text_[at_];
            if (is_blank(c)) ++at_;
            else if (c == ',') close_tuple(), ++at_;
            else if (c == '(') group(target, depth + 1, groups++ > 0);
            else if (c == ')') break;
            else tuple.push_back(number());
        }
        ++at_;
        close_tuple();
        if (chain.empty()) return;
        target.chains.push_back(std::move(chain));
        target.hole.push_back(later && target.kind == SceneTarget::Kind::areas && !target.hole.empty());
    }

    double number() {
        double value = 0;
        if (text_[at_] == '+') ++at_;
        const auto [end, code] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (code != std::errc() || !std::isfinite(value)) fail("the well-known text has a word in place of a number");
        at_ = static_cast<std::size_t>(end - text_.data());
        return value;
    }

    std::string_view text_;
    const std::string& where_;
    std::size_t at_ = 0;
    bool measured_ = false;  ///< true: the third number is a measure, not a coordinate
};

double distance_of(const std::vector<Vector3d>& points, const SceneMotion& motion, const Placer& placer, double limit) {
    double largest = 0;
    for (const Vector3d& p : points) {
        const Vector3d q = motion(p);
        if (!q.allFinite() || q.cwiseAbs().maxCoeff() > 1e100) return std::numeric_limits<double>::infinity();
        largest = std::max(largest, placer.nearest(Point(q.x(), q.y(), q.z())).distance);
        if (largest > limit) break;
    }
    return largest;
}

/// An area on the mesh with its outlines, in the coordinates of the mesh: the outer one has the area at its left seen from
/// outside, holes have it at their left too.
struct Area {
    double size = 0;
    Point inside{0, 0, 0};
    std::vector<Chain> outlines;
};

std::vector<Area> areas_of(const SceneTarget& target, const SceneMotion& motion, const Placer& placer) {
    std::vector<Area> areas;
    for (std::size_t k = 0; k < target.chains.size(); ++k) {
        Chain chain;
        for (const Vector3d& p : target.chains[k]) chain.push_back(motion(p));
        while (chain.size() > 1 && chain.front() == chain.back()) chain.pop_back();
        Vector3d centre = Vector3d::Zero(), area = Vector3d::Zero();
        for (const Vector3d& p : chain) centre += p / double(chain.size());
        for (std::size_t i = 0; i < chain.size(); ++i)
            area += (chain[i] - centre).cross(chain[(i + 1) % chain.size()] - centre) / 2;
        const SurfaceHit hit = placer.nearest(Point(centre.x(), centre.y(), centre.z()));
        const Vector normal = area_vector(placer.mesh(), Face(hit.face));
        const bool clockwise = area.dot(Vector3d(normal.x(), normal.y(), normal.z())) < 0, hole = target.hole[k];
        if (clockwise != hole) std::reverse(chain.begin(), chain.end());
        if (!hole) {
            areas.emplace_back();
            areas.back().inside = hit.point;
        }
        areas.back().size += hole ? -area.norm() : area.norm();
        areas.back().outlines.push_back(std::move(chain));
    }
    return areas;
}

JsonValue places_of(const SceneTarget& target, const SceneMotion& motion, const Placer& placer, JsonAllocator& a) {
    const auto place = [&](const Vector3d& p) {
        const Vector3d q = motion(p);
        return json_value(std::array{q.x(), q.y(), q.z()}, a);
    };
    JsonValue places(rapidjson::kObjectType);
    if (target.kind == SceneTarget::Kind::points) {
        JsonValue points(rapidjson::kArrayType);
        for (const Chain& chain : target.chains)
            for (const Vector3d& p : chain) points.PushBack(place(p), a);
        add_members(places, a, "points", std::move(points));
        return places;
    }
    JsonValue list(rapidjson::kArrayType);
    if (target.kind == SceneTarget::Kind::areas) {
        add_members(places, a, "parts", json_list(areas_of(target, motion, placer), a, [&](const Area& area) {
                        JsonValue outlines = json_list(area.outlines, a, [&](const Chain& outline) {
                            return json_list(outline, a, [&](const Vector3d& p) {
                                return json_value(std::array{p.x(), p.y(), p.z()}, a);
                            });
                        });
                        return json_object(a, "area", area.size, "inside",
                                           std::array{area.inside.x(), area.inside.y(), area.inside.z()}, "outlines",
                                           std::move(outlines));
                    }));
        return places;
    }
    for (Chain chain : target.chains) {
        const bool closed = chain.size() > 3 && chain.front() == chain.back();
        if (closed) chain.pop_back();
        list.PushBack(json_object(a, "closed", closed, "points", json_list(chain, a, place)), a);
    }
    add_members(places, a, "polylines", std::move(list));
    return places;
}

/// The first text of a label: a text, or texts by language.
std::string label_of(const JsonValue& annotation) {
    const JsonValue* label = find_member(annotation, "label");
    if (label == nullptr) return {};
    if (label->IsString()) return text_of(*label);
    if (!label->IsObject()) return {};
    for (const auto& language : label->GetObject()) {
        if (language.value.IsString()) return text_of(language.value);
        if (language.value.IsArray() && !language.value.Empty() && language.value[0].IsString())
            return text_of(language.value[0]);
    }
    return {};
}

}  // namespace

bool is_iiif(const JsonValue& document) {
    return is_one_of(find_member(document, "type"), {"Manifest", "Scene", "Canvas", "Collection", "Range", "Timeline"});
}

std::vector<std::pair<const JsonValue*, std::string>> iiif_comments(const JsonValue& document) {
    std::vector<std::pair<const JsonValue*, std::string>> found;
    collect(document, "", found);
    return found;
}

SceneTarget scene_target(const JsonValue& annotation, const std::string& where) {
    const JsonValue* selector = nullptr;
    each(find_member(annotation, "target"), [&](const JsonValue& target) {
        if (selector == nullptr) selector = spatial_selector(target);
    });
    if (selector == nullptr) return {};
    if (!is_one_of(find_member(*selector, "type"), {"PointSelector"})) {
        for (const char* name : {"value", "wktLiteral"})
            if (const JsonValue* text = find_member(*selector, name); text != nullptr && text->IsString())
                return WktReader(std::string_view(text->GetString(), text->GetStringLength()), where).read();
        fail_input(where, "a WktSelector has no text", "give it a member value, such as POINT Z (1 2 3)");
    }
    Vector3d point = Vector3d::Zero();
    bool any = false;
    for (int k = 0; k < 3; ++k) {
        const JsonValue* x = find_member(*selector, std::string_view("xyz").substr(static_cast<std::size_t>(k), 1));
        if (x == nullptr) continue;
        if (!x->IsNumber() || !std::isfinite(x->GetDouble()))
            fail_input(where, "a coordinate of a PointSelector is not a number", "give x, y and z as numbers");
        point[k] = x->GetDouble();
        any = true;
    }
    if (!any) return {};  // an instant in time only
    return {SceneTarget::Kind::points, {{point}}, {false}};
}

SceneMotion scene_motion(const std::vector<SceneTarget>& targets, const Placer& placer, double tolerance) {
    std::vector<Vector3d> points;
    for (const SceneTarget& target : targets)
        for (const Chain& chain : target.chains) points.insert(points.end(), chain.begin(), chain.end());
    constexpr std::size_t max_points = 200;
    if (points.size() > max_points) {
        std::vector<Vector3d> some;
        for (std::size_t i = 0; i < max_points; ++i) some.push_back(points[i * points.size() / max_points]);
        points = std::move(some);
    }
    const double limit = tolerance * placer.diagonal();
    if (points.empty()) return {};
    // Points in metres lie near the origin of a mesh in millimetres, and may thus be near its surface by chance: another motion
    // is taken if it fits ten times as well.
    const double own = distance_of(points, {}, placer, limit);
    if (own <= 1e-6 * placer.diagonal()) return {};
    SceneMotion best;
    double smallest = own <= limit ? own / 10 : limit;
    static constexpr std::pair<const char*, double> units[]{{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1}, {"in", 0.0254}, {"ft", 0.3048}};
    for (const auto& [unit, metres] : units)
        for (int axis = 0; axis < 6; ++axis) {
            const Vector3d up = (axis < 3 ? 1.0 : -1.0) * Vector3d::Unit(axis % 3);
            SceneMotion motion;
            motion.rotation = rotation_between(up, Vector3d::UnitY()).conjugate();
            motion.scale = metres;
            const double distance = distance_of(points, motion, placer, smallest);
            if (distance >= smallest) continue;
            smallest = distance;
            motion.text =
                fmt::format("the comments are in metres with y up, as viewers show a mesh in {} whose upward direction is {}{}",
                            unit, axis < 3 ? "" : "-", "xyz"[axis % 3]);
            best = motion;
        }
    return best;
}

Json with_places(const JsonValue& annotation, const SceneTarget& target, const SceneMotion& motion, const Placer& placer) {
    Json result(rapidjson::kObjectType);
    auto& a = result.GetAllocator();
    copy_members(result, a, annotation, {"id", "type", "bodyValue"});
    JsonValue bodies(rapidjson::kArrayType);
    const std::string label = label_of(annotation);
    if (!label.empty()) bodies.PushBack(json_object(a, "type", "TextualBody", "purpose", "tagging", "value", label), a);
    each(find_member(annotation, "body"), [&](const JsonValue& body) {
        const JsonValue* value = find_member(body, "value");
        if (value == nullptr || !value->IsString()) return;
        JsonValue copy(rapidjson::kObjectType);
        copy_members(copy, a, body, {"type", "value", "format", "purpose", "language"});
        bodies.PushBack(copy, a);
    });
    add_members(result, a, "body", std::move(bodies));
    JsonValue selector = json_object(a, "type", web::place_selector, "places", places_of(target, motion, placer, a));
    add_members(result, a, "target",
                json_object(a, "type", "SpecificResource", "selector", json_list_of(std::move(selector), a)));
    return result;
}

}  // namespace ostraka::interchange

#include "ostraka/shape_classes/class_file.h"

#include "ostraka/core/error.h"
#include "ostraka/files/json_build.h"
#include "ostraka/files/npy.h"
#include "ostraka/files/safe_path.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace ostraka {

namespace {

void add_quantity(JsonValue& object, const ClassQuantity& quantity, JsonAllocator& allocator) {
    add_members(object, allocator, "kind", to_string(quantity.kind));
    if (quantity.id >= 0) add_members(object, allocator, "id", quantity.id);
    add_members(object, allocator, "name", quantity.name);
    if (!quantity.subject.empty()) add_members(object, allocator, "of", quantity.subject);
    if (!quantity.unit.empty()) add_members(object, allocator, "unit", quantity.unit);
    add_members(object, allocator, "oneSided", quantity.one_sided);
}

struct Field {
    const char* name;
    double LearntRange::*value;
};
constexpr Field fields[] = {{"min", &LearntRange::min},
                            {"max", &LearntRange::max},
                            {"mean", &LearntRange::mean},
                            {"percentile5", &LearntRange::percentile_5},
                            {"percentile25", &LearntRange::percentile_25},
                            {"median", &LearntRange::median},
                            {"percentile75", &LearntRange::percentile_75},
                            {"percentile95", &LearntRange::percentile_95}};

JsonValue range_to_json(const LearntRange& range, JsonAllocator& allocator) {
    JsonValue object(rapidjson::kObjectType);
    add_quantity(object, range.quantity, allocator);
    add_members(object, allocator, "count", range.count);
    if (range.count > 0)
        for (const Field& field : fields) add_members(object, allocator, field.name, range.*field.value);
    add_members(object, allocator, "logarithm", range.logarithm, "falseReject", range.reject);
    if (range.deviation) add_members(object, allocator, "deviation", *range.deviation);
    if (range.low) add_members(object, allocator, "low", *range.low);
    if (range.high) add_members(object, allocator, "high", *range.high);
    if (range.recognised) add_members(object, allocator, "recognised", *range.recognised);
    add_members(object, allocator, "values", range.values);
    if (!range.out_of_class.empty()) add_members(object, allocator, "outOfClass", range.out_of_class);
    return object;
}

std::vector<std::string> texts_in(const JsonValue& object, const char* name) {
    std::vector<std::string> texts;
    for (const auto& item : list_in(object, name)) texts.push_back(text_of(item));
    return texts;
}

std::vector<std::optional<double>> values_in(const JsonValue& object, const char* name) {
    std::vector<std::optional<double>> values;
    for (const auto& value : list_in(object, name))
        values.push_back(value.IsNumber() ? std::optional<double>(value.GetDouble()) : std::nullopt);
    return values;
}

LearntRange range_from(const JsonValue& object, std::size_t members, std::size_t out_of_class, const std::string& where) {
    LearntRange range;
    range.quantity.kind = quantity_kind(object["kind"].GetString());
    if (const JsonValue* id = find_member(object, "id")) range.quantity.id = id->GetInt();
    range.quantity.name = object["name"].GetString();
    if (range.quantity.name == "slack") range.quantity.name = "min-tolerance";  // classes learnt before version 0.2
    range.quantity.subject = text_in(object, "of");
    range.quantity.unit = text_in(object, "unit");
    range.quantity.one_sided = object["oneSided"].GetBool();
    range.count = object["count"].GetUint64();
    range.logarithm = object["logarithm"].GetBool();
    range.reject = object["falseReject"].GetDouble();
    for (const Field& field : fields) range.*field.value = number_in(object, field.name).value_or(0);
    range.deviation = number_in(object, "deviation");
    range.low = number_in(object, "low");
    range.high = number_in(object, "high");
    if (range.low && range.high && *range.low > *range.high)
        fail_input(where,
                   fmt::format("of {} accepts at least {} and at most {}", range.quantity.text(), std::to_string(*range.low),
                               std::to_string(*range.high)),
                   "correct the range, or learn the class again");
    range.recognised = number_in(object, "recognised");
    const auto check = [&](const std::vector<std::optional<double>>& values, std::size_t count, const char* objects) {
        if (values.size() != count)
            fail_input(where, fmt::format("has {} values of {} for {} {}", values.size(), range.quantity.text(), count, objects),
                       "learn the class again");
    };
    range.values = values_in(object, "values");
    check(range.values, members, "members");
    range.out_of_class = values_in(object, "outOfClass");
    if (!range.out_of_class.empty()) check(range.out_of_class, out_of_class, "outOfClass");
    return range;
}

Path file_of_class(const Path& file, const std::string& name, const std::string& where) {
    if (name.empty() || Path(name).filename() != Path(name) || name == "..")
        fail_input(where, fmt::format("names '{}', which is not in the same folder", name), "learn the class again");
    return file_inside(name, file.parent_path(), file.string(), "a name of another file", "the folder of the class",
                       "learn the class again");
}

/// Checks properties that learning guarantees and other files lack: a mean of the members' size, unit modes, and coefficients
/// with the variances of the modes.
void check_shape(const ShapeModes& modes, const std::string& where) {
    const auto refuse = [&](const std::string& problem) { fail_input(where, problem, "learn the class again"); };
    const double size = centroid_size(modes.mean);
    if (!std::isfinite(size) || !(size > 0.05 * modes.mean_size) || !(size < 1.1 * modes.mean_size))
        refuse("has a mean shape whose size differs from that of its members");
    double sum = 0;
    for (std::size_t k = 0; k < modes.variances.size(); ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        if (!(std::abs(modes.modes.row(row).norm() - 1) < 1e-6)) refuse("has modes whose length is not one");
        const double squares = modes.coefficients.col(row).squaredNorm(),
                     expected = static_cast<double>(modes.coefficients.rows() - 1) * modes.variances[k];
        if (!(modes.variances[k] > 0) || !(std::abs(squares - expected) <= 1e-6 * expected))
            refuse(fmt::format("has coefficients of mode {} whose variance differs from that of the mode", k + 1));
        sum += modes.variances[k];
    }
    if (!(sum <= (1 + 1e-6) * modes.total)) refuse("has modes whose variances exceed the total variance");
}

}  // namespace

void check_class_name(const std::string& name) {
    if (name.empty() || Path(name).filename() != Path(name) || name == "." || name == "..")
        fail_usage(fmt::format("the name '{}' of the class is not a valid file name", name), "give a plain word as --name");
}

void write_class(const Path& folder, const ShapeClass& learnt, const Provenance& provenance) {
    check_class_name(learnt.name);
    const ShapeModes& modes = learnt.modes;
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    add_members(document, allocator, "format", "ostraka-class", "version", 1, "name", learnt.name, "template",
                learnt.template_file, "topology", learnt.topology, "sizes", learnt.sizes);
    JsonValue members(rapidjson::kArrayType);
    for (std::size_t i = 0; i < learnt.members.size(); ++i) {
        const ClassMember& member = learnt.members[i];
        JsonValue object = json_object(allocator, "name", member.name, "placedBy", member.placed_by, "scale", member.scale,
                                       "centroidSize", modes.centroid_sizes[i], "fromMean", modes.distances[i]);
        add_members(object, allocator, "coefficients", modes.coefficients.row(static_cast<Eigen::Index>(i)));
        if (!member.notes.empty()) add_members(object, allocator, "notes", member.notes);
        members.PushBack(object, allocator);
    }
    add_members(document, allocator, "unsure", learnt.unsure, "accept", learnt.accept);
    if (learnt.most_off) add_members(document, allocator, "mostOff", *learnt.most_off);
    if (!learnt.out_of_class.empty()) add_members(document, allocator, "outOfClass", learnt.out_of_class);
    add_members(document, allocator, "falseReject", learnt.reject, "resolution", learnt.resolution, "members", std::move(members),
                "archetype", learnt.members[modes.archetype].name, "diversity", learnt.diversity);

    JsonValue shape(rapidjson::kObjectType);
    std::vector<double> values;
    for (Eigen::Index i = 0; i < modes.mean.rows(); ++i)
        for (int k = 0; k < 3; ++k) values.push_back(modes.mean(i, k));
    const std::string mean = learnt.name + ".mean.npy", rows = learnt.name + ".modes.npy";
    write_npy(folder / mean, std::span<const double>(values), {static_cast<std::size_t>(modes.mean.rows()), 3});
    add_member(shape, "mean", mean, allocator);
    if (modes.modes.rows() > 0) {
        values.clear();
        for (Eigen::Index k = 0; k < modes.modes.rows(); ++k)
            for (Eigen::Index i = 0; i < modes.modes.cols(); ++i) values.push_back(modes.modes(k, i));
        write_npy(folder / rows, std::span<const double>(values),
                  {static_cast<std::size_t>(modes.modes.rows()), static_cast<std::size_t>(modes.modes.cols())});
        add_member(shape, "modes", rows, allocator);
    }
    add_members(shape, allocator, "variances", modes.variances, "totalVariance", modes.total, "meanSize", modes.mean_size);
    const auto of_range = [&](const LearntRange& range) { return range_to_json(range, allocator); };
    add_members(document, allocator, "shape", std::move(shape), "ranges", json_list(learnt.ranges, allocator, of_range),
                "fragments", json_list(learnt.fragments, allocator, of_range), "notes", learnt.notes, "provenance",
                provenance.to_json(allocator));
    write_json(folder / (learnt.name + ".class.json"), document);
}

ShapeClass read_class(const Path& file) {
    const Json document = read_json(file);
    const std::string where = file.string();
    validate(document, "class", where);
    ShapeClass learnt;
    learnt.name = document["name"].GetString();
    learnt.template_file = file_of_class(file, document["template"].GetString(), where).string();
    learnt.topology = document["topology"].GetString();
    learnt.sizes = document["sizes"].GetBool();
    learnt.reject = document["falseReject"].GetDouble();
    learnt.resolution = document["resolution"].GetDouble();
    learnt.unsure = number_in(document, "unsure").value_or(learnt.unsure);
    learnt.accept = number_in(document, "accept").value_or(learnt.accept);
    learnt.most_off = number_in(document, "mostOff");
    learnt.out_of_class = texts_in(document, "outOfClass");
    learnt.notes = texts_in(document, "notes");
    learnt.diversity = document["diversity"].GetDouble();
    ShapeModes& modes = learnt.modes;
    modes.sizes = learnt.sizes;
    const JsonValue& shape = document["shape"];
    modes.mean_size = shape["meanSize"].GetDouble();
    modes.total = shape["totalVariance"].GetDouble();
    for (const auto& value : shape["variances"].GetArray()) modes.variances.push_back(value.GetDouble());
    const auto array = [&](const char* name, std::size_t rows, std::size_t columns) {
        const Path place = file_of_class(file, shape[name].GetString(), where);
        NpyArray<double> values = read_npy(place);
        if (values.columns() != columns || (rows > 0 && values.rows() != rows))
            fail_input(place.string(),
                       fmt::format("has {} rows and {} columns, which does not match {}", values.rows(), values.columns(), where),
                       "learn the class again");
        if (std::any_of(values.values.begin(), values.values.end(), [](double x) { return !std::isfinite(x); }))
            fail_input(place.string(), "contains numbers that are not finite", "learn the class again");
        return values;
    };
    const NpyArray<double> mean = array("mean", 0, 3);
    modes.mean = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>(
        mean.values.data(), static_cast<Eigen::Index>(mean.rows()), 3);
    const std::size_t count = modes.variances.size();
    modes.modes.resize(static_cast<Eigen::Index>(count), 3 * modes.mean.rows());
    if (count > 0) {
        if (!shape.HasMember("modes")) fail_input(where, "has variances of modes but no modes", "learn the class again");
        const NpyArray<double> rows = array("modes", count, 3 * mean.rows());
        modes.modes = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
            rows.values.data(), modes.modes.rows(), modes.modes.cols());
    }
    const JsonValue& members = document["members"];
    modes.coefficients.resize(members.Size(), static_cast<Eigen::Index>(count));
    for (rapidjson::SizeType i = 0; i < members.Size(); ++i) {
        const JsonValue& member = members[i];
        learnt.members.push_back(
            {member["name"].GetString(), member["placedBy"].GetString(), member["scale"].GetDouble(), texts_in(member, "notes")});
        modes.centroid_sizes.push_back(member["centroidSize"].GetDouble());
        modes.distances.push_back(member["fromMean"].GetDouble());
        if (member["coefficients"].Size() != count)
            fail_input(
                where,
                fmt::format("the number of coefficients of '{}' differs from the number of modes", learnt.members.back().name),
                "learn the class again");
        for (rapidjson::SizeType k = 0; k < count; ++k)
            modes.coefficients(i, static_cast<Eigen::Index>(k)) = member["coefficients"][k].GetDouble();
        if (learnt.members.back().name == document["archetype"].GetString()) modes.archetype = i;
    }
    check_shape(modes, where);
    const std::string archetype = document["archetype"].GetString();
    if (learnt.members[modes.archetype].name != archetype)
        fail_input(where, fmt::format("has the archetype '{}', which is not one of its members", archetype),
                   "learn the class again");
    std::set<std::tuple<int, int, std::string, std::string>> quantities_found;
    for (const auto& value : document["ranges"].GetArray()) {
        LearntRange range = range_from(value, learnt.members.size(), learnt.out_of_class.size(), where);
        const ClassQuantity& quantity = range.quantity;
        if (!quantities_found.emplace(static_cast<int>(quantity.kind), quantity.id, quantity.name, quantity.subject).second)
            fail_input(where, "has two ranges of " + quantity.text(), "keep one of them, or learn the class anew");
        learnt.ranges.push_back(std::move(range));
    }
    for (const auto& range : document["fragments"].GetArray())
        learnt.fragments.push_back(range_from(range, learnt.members.size(), learnt.out_of_class.size(), where));
    return learnt;
}

JsonValue classification_to_json(const Classification& classification, JsonAllocator& allocator) {
    const auto of_check = [&](const QuantityCheck& check) {
        JsonValue item(rapidjson::kObjectType);
        add_quantity(item, check.quantity, allocator);
        if (check.quantity.value) add_members(item, allocator, "value", *check.quantity.value);
        if (check.low) add_members(item, allocator, "low", *check.low);
        if (check.high) add_members(item, allocator, "high", *check.high);
        if (check.recognised) add_members(item, allocator, "recognised", *check.recognised);
        add_members(item, allocator, "decides", check.decides, "off", check.distance_from_range, "excess", check.excess);
        if (!check.worst.empty()) add_members(item, allocator, "worst", check.worst);
        return item;
    };
    const auto place = [](const Point& p) { return std::array<double, 3>{p.x(), p.y(), p.z()}; };
    const auto of_region = [&](const DeviatingRegion& region) {
        JsonValue item = json_object(allocator, "share", region.share, "middle", place(region.middle), "at", place(region.at),
                                     "farthest", region.farthest);
        if (!region.part.empty()) add_members(item, allocator, "part", region.part);
        return item;
    };
    const auto explained = [&](const ClassAnswer& class_answer) {
        const FitResiduals& residuals = *class_answer.fit.residuals;
        return json_object(allocator, "object", 1 - residuals.unexplained, "template", 1 - residuals.unmatched, "within",
                           class_answer.fit.contact_distance, "liesOn", class_answer.fit_problem.empty(), "mostOff",
                           class_answer.misfit_limit, "foreign", json_list(class_answer.fit.foreign, allocator, of_region),
                           "missing", json_list(class_answer.fit.missing, allocator, of_region));
    };
    const auto of_class = [&](const ClassAnswer& class_answer) {
        JsonValue object = json_object(allocator, "class", class_answer.name, "verdict", to_string(class_answer.verdict));
        if (!class_answer.undecided.empty()) add_members(object, allocator, "undecided", class_answer.undecided);
        if (class_answer.fit.problem.empty())
            add_members(object, allocator, "score", class_answer.score, "placedBy", class_answer.fit.placed_by, "scale",
                        class_answer.fit.scale, "coefficients", class_answer.coordinates.coefficients, "mahalanobis",
                        class_answer.coordinates.mahalanobis);
        add_nonempty_members(object, allocator, "odd", class_answer.unusual_findings, "notes", class_answer.fit.notes);
        if (class_answer.fit.problem.empty() && class_answer.fit.residuals)
            add_members(object, allocator, "explained", explained(class_answer));
        add_members(object, allocator, "against", class_answer.reasons(), "checks",
                    json_list(class_answer.checks, allocator, of_check));
        return object;
    };
    JsonValue report = json_object(allocator, "object", classification.object, "verdict", to_string(classification.verdict),
                                   "text", classification.text);
    if (!classification.problem.empty()) add_members(report, allocator, "problem", classification.problem);
    const auto name = [&](int k) { return classification.answers[static_cast<std::size_t>(k)].name; };
    if (classification.best >= 0) add_members(report, allocator, "class", name(classification.best));
    if (classification.nearest >= 0) add_members(report, allocator, "nearest", name(classification.nearest));
    add_members(report, allocator, "answers", json_list(classification.answers, allocator, of_class));
    return report;
}

}  // namespace ostraka

#include "ostraka/collection/moulds.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/submesh.h"
#include "ostraka/stats/summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

Mesh read_head(const CollectionObject& object, const std::vector<int>& leave_out, const ObjectParts& parts) {
    const std::string where = object.mesh.empty() ? object.name : object.mesh.filename().string();
    if (object.mesh.empty())
        fail_input(where, "the object has no mesh", "give a mesh, since heads are compared by their surfaces");
    const ObjectPart part = parts.read(object);
    std::vector<bool> keep(part.mesh.number_of_faces(), true);
    if (!leave_out.empty()) {
        const auto& labels = part.face_labels;
        if (labels.size() != keep.size())
            fail_input(where, "the faces have no labels, so that no parts can be left out", "write labels into the PLY file");
        for (std::size_t f = 0; f < keep.size(); ++f)
            keep[f] = std::find(leave_out.begin(), leave_out.end(), labels[f]) == leave_out.end();
    }
    Mesh mesh = keep_faces(part.mesh, keep, true).mesh;
    if (mesh.number_of_faces() == 0) fail_input(where, "no face remains", "leave out fewer parts");
    return mesh;
}

JsonValue to_json(const FeatureSet& set, JsonAllocator& allocator) {
    JsonValue object(rapidjson::kObjectType), list(rapidjson::kArrayType);
    for (std::size_t i = 0; i < set.features.size(); ++i) {
        const Feature& feature = set.features[i];
        const auto column = static_cast<Eigen::Index>(i);
        JsonValue row(rapidjson::kArrayType);
        row.PushBack(JsonValue(feature.vertex), allocator).PushBack(JsonValue(feature.scale), allocator);
        for (const auto* v : {&feature.point, &feature.normal, &feature.direction})
            for (int k = 0; k < 3; ++k) row.PushBack(JsonValue((*v)[k]), allocator);
        for (int k = 0; k < FeatureSet::length; ++k)
            row.PushBack(JsonValue(static_cast<double>(set.descriptors(k, column))), allocator);
        list.PushBack(std::move(row), allocator);
    }
    add_member(object, "size", JsonValue(set.size), allocator);
    add_member(object, "features", std::move(list), allocator);
    return object;
}

FeatureSet from_json(const JsonValue& value) {
    FeatureSet set;
    set.size = value["size"].GetDouble();
    const JsonValue& feature_rows = value["features"];
    set.features.resize(feature_rows.Size());
    set.descriptors.resize(FeatureSet::length, static_cast<Eigen::Index>(feature_rows.Size()));
    for (rapidjson::SizeType i = 0; i < feature_rows.Size(); ++i) {
        Feature& feature = set.features[i];
        rapidjson::SizeType at = 0;
        const auto next = [&] { return feature_rows[i][at++].GetDouble(); };
        feature.vertex = static_cast<Index>(next());
        feature.scale = next();
        for (auto* v : {&feature.point, &feature.normal, &feature.direction})
            for (int k = 0; k < 3; ++k) (*v)[k] = next();
        for (int k = 0; k < FeatureSet::length; ++k) set.descriptors(k, i) = static_cast<float>(next());
    }
    return set;
}

/// The median of the sizes, rounded to the nearest power of 1.1.
double common_size(const std::vector<double>& sizes) {
    if (sizes.empty()) return 0;
    return std::pow(1.1, std::round(std::log(upper_median(sizes)) / std::log(1.1)));
}

/// A head that differs from the others by about an order of magnitude is most likely in another unit.
std::string remedy_by_size(const Mesh& mesh, double common, const std::string& otherwise) {
    const double ratio = common > 0 ? std::sqrt(surface_area(mesh)) / common : 1;
    if (!(ratio > 0) || (ratio > 0.2 && ratio < 5)) return otherwise;
    return fmt::format("its size is {} that of the others: is it in another unit?",
                       ratio < 1 ? "1/" + digits(1 / ratio, 2) : digits(ratio, 2) + " times");
}

bool is_elsewhere(const std::vector<ObjectResult>& results) {
    return std::any_of(results.begin(), results.end(), [](const ObjectResult& result) { return result.elsewhere; });
}

}  // namespace

PreparedCollection prepare_collection(const Collection& collection, const CompareOptions& options,
                                      const std::vector<int>& leave_out, const ResultStore& store, const ObjectParts& parts) {
    check_options(options, "moulds");
    std::string left_out = "without";
    for (const int label : leave_out) left_out += " " + std::to_string(label);
    for (const std::string& key_part : parts.key()) left_out += ", " + key_part;
    PreparedCollection prepared;
    prepared.options = options;
    double& size = prepared.options.features.size;
    if (!(size > 0)) {
        const auto areas =
            for_each_object(collection, store.part("sizes"), {"mould size", left_out}, [&](const CollectionObject& object) {
                Json result;
                result.SetDouble(std::sqrt(surface_area(read_head(object, leave_out, parts))));
                return result;
            });
        if (is_elsewhere(areas)) {
            prepared.waits_for = "sizes";
            return prepared;
        }
        std::vector<double> sizes;
        for (const auto& area : areas)
            if (area.problem.empty() && area.result.GetDouble() > 0) sizes.push_back(area.result.GetDouble());
        size = common_size(sizes);
    }
    std::vector<std::string> key_parts{"mould features", left_out};
    for (const auto& [name, value] : declare_options(prepared.options.features)) key_parts.push_back(name + "=" + value);
    prepared.results = for_each_object(collection, store, key_parts, [&](const CollectionObject& object) {
        const Mesh mesh = read_head(object, leave_out, parts);
        try {
            const PreparedHead head = prepare_head(mesh, prepared.options);
            Json result;
            static_cast<JsonValue&>(result) = to_json(head.features, result.GetAllocator());
            return result;
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input) throw;
            fail_input(object.mesh.filename().string(), error.problem(), remedy_by_size(mesh, size, error.remedy()));
        }
    });
    if (is_elsewhere(prepared.results)) {
        prepared.waits_for = "features";
        return prepared;
    }
    for (std::size_t i = 0; i < prepared.results.size(); ++i)
        if (prepared.results[i].problem.empty()) prepared.objects.push_back(i);
    std::vector<std::optional<PreparedHead>> heads(prepared.objects.size());
    parallel_for(heads.size(), 1, [&](std::size_t k) {
        const std::size_t i = prepared.objects[k];
        heads[k].emplace(PreparedHead{from_json(prepared.results[i].result),
                                      AlignSurface(read_head(collection.objects[i], leave_out, parts), options.align.samples)});
    });
    for (std::size_t k = 0; k < heads.size(); ++k) {
        const std::size_t i = prepared.objects[k];
        prepared.heads.push_back(std::move(*heads[k]));
        prepared.names.push_back(collection.objects[i].name);
        prepared.checksums.push_back(collection.objects[i].checksum + " " + left_out);
        prepared.results[i].result.SetNull();
    }
    return prepared;
}

}  // namespace ostraka

// test/solver/golden_projections.json: each example's B, rows and projection, so that another implementation can be checked kind
// by kind. With OSTRAKA_WRITE_GOLDEN=FILE in the environment, the test writes such a file instead.
#include "examples.h"
#include "ostraka/core/json.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace ostraka {
namespace {

JsonValue columns(const Points& points, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        JsonValue column(rapidjson::kArrayType);
        for (int k = 0; k < 3; ++k) column.PushBack(points(k, i), allocator);
        list.PushBack(column, allocator);
    }
    return list;
}

template <class Number>
JsonValue numbers(const std::vector<Number>& values, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (const Number value : values) list.PushBack(value, allocator);
    return list;
}

JsonValue parameters_of(const Example& e, JsonAllocator& allocator) {
    const ConstraintParameters& p = e.parameters;
    JsonValue object(rapidjson::kObjectType);
    if (p.min) add_member(object, "min", JsonValue(*p.min), allocator);
    if (p.max) add_member(object, "max", JsonValue(*p.max), allocator);
    if (p.absolute) add_member(object, "absolute", JsonValue(true), allocator);
    if (p.target) add_member(object, "target", columns(*p.target, allocator), allocator);
    const std::pair<const char*, const std::optional<Eigen::Vector3d>*> vectors[] = {{"direction", &p.direction},
                                                                                     {"point", &p.point},
                                                                                     {"rest_direction", &p.rest_direction},
                                                                                     {"rest_point", &p.rest_point},
                                                                                     {"second_direction", &p.second_direction}};
    for (const auto& [name, vector] : vectors)
        if (*vector) {
            JsonValue list(rapidjson::kArrayType);
            for (int k = 0; k < 3; ++k) list.PushBack((**vector)[k], allocator);
            add_member(object, name, std::move(list), allocator);
        }
    if (!p.coefficients.empty()) add_member(object, "coefficients", numbers(p.coefficients, allocator), allocator);
    if (p.split != 0) add_member(object, "split", JsonValue(p.split), allocator);
    if (!p.pins.empty()) add_member(object, "pins", numbers(p.pins, allocator), allocator);
    if (!p.anchors.empty()) add_member(object, "anchors", numbers(p.anchors, allocator), allocator);
    if (!p.stations.empty()) add_member(object, "stations", numbers(p.stations, allocator), allocator);
    if (p.closest_point) add_member(object, "surface", "sphere of radius 0.7 about (0.1, 0.2, 0.3)", allocator);
    return object;
}

Points columns_of(const JsonValue& list) {
    Points points(3, static_cast<Eigen::Index>(list.Size()));
    for (rapidjson::SizeType i = 0; i < list.Size(); ++i)
        for (rapidjson::SizeType k = 0; k < 3; ++k)
            points(static_cast<int>(k), static_cast<Eigen::Index>(i)) = list[i][k].GetDouble();
    return points;
}

Json golden() {
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    add_member(document, "about", "Projections of each kind of constraint; doc/solver.md tells the convention.", allocator);
    JsonValue list(rapidjson::kArrayType);
    for (const Example& e : examples()) {
        const auto c = make(e);
        Points rows, projected(3, c->map().rows);
        c->rows_of(e.points, rows);
        c->project(rows, projected);
        JsonValue object(rapidjson::kObjectType);
        add_member(object, "name", e.name, allocator);
        add_member(object, "kind", e.kind, allocator);
        add_member(object, "ids", numbers(e.ids, allocator), allocator);
        add_member(object, "parameters", parameters_of(e, allocator), allocator);
        add_member(object, "rest", columns(e.rest, allocator), allocator);
        add_member(object, "points", columns(e.points, allocator), allocator);
        add_member(object, "direct", JsonValue(static_cast<int>(c->map().direct)), allocator);
        add_member(object, "centred", JsonValue(c->map().centred), allocator);
        add_member(object, "observed", JsonValue(static_cast<int>(c->map().observed)), allocator);
        JsonValue entries(rapidjson::kArrayType);
        for (const auto& entry : c->map().entries) {
            JsonValue triple(rapidjson::kArrayType);
            triple.PushBack(entry.row, allocator).PushBack(entry.position, allocator).PushBack(entry.value, allocator);
            entries.PushBack(triple, allocator);
        }
        add_member(object, "entries", std::move(entries), allocator);
        add_member(object, "rows", columns(rows, allocator), allocator);
        add_member(object, "projection", columns(projected, allocator), allocator);
        add_member(object, "residual", JsonValue(c->residual(e.points)), allocator);
        list.PushBack(object, allocator);
    }
    add_member(document, "projections", std::move(list), allocator);
    return document;
}

TEST(Golden, ProjectionsAreThoseOfTheFile) {
    const Json now = golden();
    if (const char* file = std::getenv("OSTRAKA_WRITE_GOLDEN")) {
        write_json(file, now);
        GTEST_SKIP() << "written to " << file;
    }
    const Json then = read_json(std::string(OSTRAKA_SOURCE_DIR) + "/test/solver/golden_projections.json");
    const JsonValue &a = then["projections"], &b = now["projections"];
    ASSERT_EQ(a.Size(), b.Size());
    for (rapidjson::SizeType i = 0; i < a.Size(); ++i) {
        const std::string name = a[i]["name"].GetString();
        EXPECT_EQ(name, b[i]["name"].GetString());
        for (const char* member : {"kind", "ids", "direct", "centred", "observed"}) EXPECT_EQ(a[i][member], b[i][member]) << name;
        for (const char* member : {"rest", "points", "rows", "projection"}) {
            const Points p = columns_of(a[i][member]), q = columns_of(b[i][member]);
            ASSERT_EQ(p.cols(), q.cols()) << name << ' ' << member;
            EXPECT_LT((p - q).cwiseAbs().maxCoeff(), 1e-9) << name << ' ' << member;
        }
        ASSERT_EQ(a[i]["entries"].Size(), b[i]["entries"].Size()) << name;
        const Points p = columns_of(a[i]["entries"]), q = columns_of(b[i]["entries"]);
        if (p.cols() > 0) {
            EXPECT_LT((p - q).cwiseAbs().maxCoeff(), 1e-9) << name;
        }
        EXPECT_NEAR(a[i]["residual"].GetDouble(), b[i]["residual"].GetDouble(), 1e-9) << name;
    }
}

}  // namespace
}  // namespace ostraka

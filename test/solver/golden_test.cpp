// test/solver/golden_projections.json: each example's B, rows and projection, so that another implementation can be checked kind
// by kind. With OSTRAKA_WRITE_GOLDEN=FILE in the environment, the test writes such a file instead.
#include "examples.h"
#include "ostraka/files/json.h"

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

template <class Numbers>
JsonValue numbers(const Numbers& values, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (const auto value : values) list.PushBack(value, allocator);
    return list;
}

/// Writes the parameters of a kind that are given.
struct ParameterWriter {
    JsonValue& object;
    JsonAllocator& allocator;
    void add(const char* name, JsonValue value) { add_member(object, name, std::move(value), allocator); }
    void place(const char* name, const Points& points) { add(name, columns(points, allocator)); }
    void place(const char* name, const Eigen::Vector3d& vector) { add(name, numbers(vector, allocator)); }
    void direction(const char* name, const Points& points) { place(name, points); }
    void direction(const char* name, const Eigen::Vector3d& vector) { place(name, vector); }
    template <class Matrix>
    void place(const char* name, const std::optional<Matrix>& given) {
        if (given) place(name, *given);
    }
    template <class Matrix>
    void direction(const char* name, const std::optional<Matrix>& given) {
        if (given) place(name, *given);
    }
    void value(const char* name, double number) {
        if (std::isfinite(number)) add(name, JsonValue(number));
    }
    void value(const char* name, int number) {
        if (number != 0) add(name, JsonValue(number));
    }
    void value(const char* name, bool flag) {
        if (flag) add(name, JsonValue(true));
    }
    template <class Numbers>
    void value(const char* name, const Numbers& values) {
        if (!values.empty()) add(name, numbers(values, allocator));
    }
    template <class Function>
    void surface(const char* name, const Function&) {
        add(name, JsonValue("sphere of radius 0.7 about (0.1, 0.2, 0.3)"));
    }
};

JsonValue parameters_of(ConstraintKind kind, JsonAllocator& allocator) {
    JsonValue object(rapidjson::kObjectType);
    ParameterWriter writer{object, allocator};
    std::visit(VisitParameters<ParameterWriter>{writer}, kind);
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
        add_member(object, "kind", std::string(name_of(e.kind)), allocator);
        add_member(object, "ids", numbers(e.ids, allocator), allocator);
        add_member(object, "parameters", parameters_of(e.kind, allocator), allocator);
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

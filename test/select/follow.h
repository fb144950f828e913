// Recipes of one step, for the tests of selections.
#pragma once

#include "ostraka/annotation/outline.h"
#include "ostraka/core/error.h"
#include "ostraka/select/recipe.h"

#include <gtest/gtest.h>

namespace ostraka::test {

inline AnnotationSet follow(const std::string& steps, const Mesh& mesh, const std::string& head = "", RecipeStart start = {}) {
    const std::string text = R"({"format": "ostraka-recipe", "version": 1, )" + head + R"("annotations": [)" + steps + "]}";
    return follow_recipe(parse_json(text, "r.json"), mesh, std::move(start), "r.json");
}

inline Annotation select(const std::string& type, const std::string& expression, const Mesh& mesh, const std::string& head = "") {
    return follow(R"({"id": 0, "tag": "t", "type": ")" + type + R"(", "select": )" + expression + "}", mesh, head)
        .annotations.at(0);
}

/// The selected faces.
inline std::vector<Index> faces_of(const std::string& expression, const Mesh& mesh, const std::string& head = "") {
    return follow(R"({"id": 0, "tag": "t", "type": "region", "outline": "edges", "select": )" + expression + "}", mesh, head)
        .annotations.at(0)
        .faces;
}

inline double area_of(const std::string& expression, const Mesh& mesh) {
    return measure_region(mesh, faces_of(expression, mesh)).area;
}

/// Expects that the steps are rejected with an error that names the file, the place and the problem, and has a remedy.
inline void expect_refused(const std::string& steps, const Mesh& mesh, const std::string& pointer, const std::string& expected,
                           RecipeStart start = {}) {
    try {
        (void)follow(steps, mesh, "", std::move(start));
        FAIL() << steps;
    } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("r.json"), std::string::npos) << message;
        EXPECT_NE(message.find(pointer), std::string::npos) << message << "\n  for " << steps;
        EXPECT_NE(message.find(expected), std::string::npos) << message << "\n  for " << steps;
        EXPECT_FALSE(error.remedy().empty()) << message;
    }
}

inline void expect_error(const std::string& expression, const Mesh& mesh, const std::string& pointer, const std::string& expected,
                         const std::string& type = "region") {
    expect_refused(R"({"id": 0, "tag": "t", "type": ")" + type + R"(", "select": )" + expression + "}", mesh,
                   "/annotations/0/select" + pointer, expected);
}

}  // namespace ostraka::test

// Reads selection expressions of recipes.
#pragma once

#include "ostraka/files/json.h"
#include "select/expression.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace ostraka {

/// A JSON value in a recipe.
struct RecipeValue {
    const JsonValue& json;
    PlaceFrame frame;  ///< coordinate system around the value
    std::string at;    ///< JSON pointer

    /// The member of this name, which must exist.
    [[nodiscard]] RecipeValue operator[](const char* name) const { return {json[name], frame, at + '/' + name}; }
    /// The item of an array.
    [[nodiscard]] RecipeValue operator[](rapidjson::SizeType i) const { return {json[i], frame, at + '/' + std::to_string(i)}; }
};

/// The coordinate system that a JSON object states, or else `around`.
PlaceFrame frame_of(const JsonValue& object, PlaceFrame around);

/// Reads the selection expressions of one recipe, which must be valid by recipe.schema.json. Throws Error (input), with the file
/// and the JSON pointer, for what the schema does not exclude: two kinds in one expression, members that contradict each other,
/// unknown cameras, files outside the recipe's folder.
class ExpressionReader {
public:
    /// `where`: the recipe file in errors; `folder`: folder to which file names are relative; `cameras`: named cameras of the
    /// recipe, null: none, must outlive the reader; `frame`: coordinate system of the recipe.
    ExpressionReader(std::string where, Path folder, const JsonValue* cameras, PlaceFrame frame)
        : where_(std::move(where)), folder_(std::move(folder)), named_cameras_(cameras), frame_(frame) {}

    [[nodiscard]] SelectionExpression expression(const RecipeValue& value);
    /// An expression within an expression.
    [[nodiscard]] std::unique_ptr<const SelectionExpression> part(const RecipeValue& value);
    [[nodiscard]] selection::Pick pick(const RecipeValue& value);
    [[nodiscard]] std::vector<selection::Pick> picks(const RecipeValue& list);
    /// The camera of a picture or pick, given by name or inline in its member "camera". Named cameras are read when first used.
    [[nodiscard]] std::shared_ptr<const selection::Camera> camera(const RecipeValue& owner);
    /// The file of this name in the folder of the recipe.
    [[nodiscard]] Path file(const RecipeValue& name) const;
    /// Throws Error (input) for the place `at`.
    [[noreturn]] void fail(const std::string& at, const std::string& problem, const std::string& remedy) const;

private:
    std::string where_;
    Path folder_;
    const JsonValue* named_cameras_;
    PlaceFrame frame_;
    std::map<std::string, std::shared_ptr<const selection::Camera>> cameras_;  ///< named cameras that were read
};

}  // namespace ostraka

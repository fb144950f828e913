// Damaged files end in success or a clear error.
#include "mutate.h"

#include "annotation/example_meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/annotation/remap.h"
#include "ostraka/core/error.h"
#include "ostraka/select/recipe.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <fstream>

using namespace ostraka;
using namespace ostraka::example;
using ostraka::test::mutate;
using ostraka::test::Scratch;

namespace {

/// Reads 200 damaged copies; every error must have a message. Returns the number of readable copies.
template <class Read>
std::size_t survive(const std::string& text, Read&& read) {
    std::size_t successes = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        try {
            read(mutate(text, seed));
            ++successes;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
            EXPECT_FALSE(error.problem().empty());
        }
    }
    return successes;
}

/// A new file each time, not flushed to the disk.
Path fresh(const Scratch& scratch, const std::string& text) {
    static int count = 0;
    const Path file = scratch / std::to_string(count++);
    std::ofstream(file, std::ios::binary) << text;
    return file;
}

const char* const recipe =
    R"({"format": "ostraka-recipe", "version": 1, "class": "ball", "unit": "mm", "frame": "box", "annotations": [
  {"id": 1, "tag": "cap", "type": "region", "select": {"difference": [{"halfspace": {"point": [0, 0, 0.8], "normal": [0, 0, 1]}},
     {"union": [{"sphere": {"centre": [0.5, 0.5, 1], "radius": 0.1}}, {"faces": [3, 4]}]}]},
   "attributes": [{"id": 0, "name": "height", "type": "measure", "measure": {"tool": "bounding", "direction": [0, 1, 0]}},
                  {"id": 1, "name": "area", "type": "descriptor"}]},
  {"id": 2, "tag": "ring", "type": "line", "select": {"path": {"points": [[0, 0.5, 0.5], 2, [1, 0.5, 0.5]], "closed": true, "metric": "combined"}}},
  {"id": 4, "tag": "half", "type": "region",
   "select": {"lasso": {"points": [[1, 0.5, 0.5], [0.5, 1, 0.5], [0, 0.5, 0.5], [0.5, 0, 0.5]], "seed": [0.5, 0.5, 1]}}},
  {"id": 3, "tag": "pole", "type": "point", "select": {"nearest": [0.5, 0.5, 1]}}]})";

}  // namespace

TEST(Mutation, Recipes) {
    const Mesh mesh = spheres(2);
    ASSERT_NO_THROW(apply_recipe(parse_json(recipe, "r"), mesh, {}, "r"));
    EXPECT_LT(survive(recipe, [&](const std::string& text) { apply_recipe(parse_json(text, "r"), mesh, {}, "r"); }), 200U);
}

TEST(Mutation, AnnotationFiles) {
    const Mesh mesh = spheres(2);
    AnnotationSet set = apply_recipe(parse_json(recipe, "r"), mesh, {}, "r");
    Annotation& cap = *std::find_if(set.annotations.begin(), set.annotations.end(), [](const auto& a) { return a.id == 1; });
    Measure& measure = *cap.attributes.at(0).measure();
    measure.repeats = {measure.points, {3, 4}};
    measure.uncertainty = 0.125;
    cap.attributes.push_back({7, "size", Note{"small", "rule 'small': height 0.2 < 0.5"}});
    const std::string whole = to_text(annotations_to_json({mesh, set}, "m.ply", {}));
    // Without the mesh's counts and checksum, so that damage reaches the selections.
    const std::size_t begin = whole.find("  \"mesh\": {"), end = whole.find("},\n", begin) + 3;
    const std::string bare = whole.substr(0, begin) + whole.substr(end);
    for (const std::string& text : {whole, bare})
        EXPECT_LT(survive(text,
                          [&](const std::string& damaged) {
                              const AnnotationSet read =
                                  annotations_from_json(parse_json(damaged, "a"), mesh, "a", {.force_mesh = true});
                              annotations_to_json({mesh, read}, "m.ply", {});
                          }),
                  200U);
}

TEST(Mutation, PrototypeFiles) {
    const Mesh mesh = grid(3);
    const std::string text = R"({"annotations": [
      {"id": "4", "tag": "a", "color": [1, 2, 3], "type": "Area", "boundaries": [[0, 1, 5, 4, 0]], "attributes": [
        {"id": 0, "name": "h", "type": "Geometric", "value": 1.0, "points": [0, 5], "tool": "height", "direction": [0, 1, 0]},
        {"id": 3, "name": "s", "type": "Semantic", "value": "text"}]},
      {"id": 5, "tag": "l", "color": [1, 2, 3], "type": "Line", "polylines": [[0, 1]], "attributes": []}]})";
    EXPECT_LT(survive(text, [&](const std::string& damaged) { annotations_from_json(parse_json(damaged, "a"), mesh, "a"); }),
              200U);
}

TEST(Mutation, LabelsNamesAndMaps) {
    const Scratch scratch;
    std::string labels, list;
    for (int i = 0; i < 32; ++i) labels += std::to_string(i / 3) + "\n", list += (i ? ", " : "") + std::to_string(i % 9 - 1);
    EXPECT_LT(survive(labels, [&](const std::string& text) { read_labels(fresh(scratch, text), 32); }), 200U);
    EXPECT_LT(survive(R"({"1": "head", "2": "arm", "30": "leg"})",
                      [&](const std::string& text) { read_label_names(fresh(scratch, text)); }),
              200U);
    const std::string map =
        R"({"format": "ostraka-map", "version": 1, "kind": "face", "from": 32, "to": 20, "map": [)" + list + "]}";
    EXPECT_LT(survive(map, [&](const std::string& text) { read_index_map(fresh(scratch, text), "face", 32, 20); }), 200U);
}

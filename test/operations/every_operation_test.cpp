// Properties of the whole table: every operation has a valid declaration, its report satisfies its schema, and objects in memory
// give the same bytes as files.
#include "calls.h"
#include "ostraka/files/json.h"
#include "ostraka/framework/inputs.h"
#include "ostraka/framework/outputs.h"
#include "ostraka/operations/pages.h"
#include "ostraka/vocabulary/vocabulary.h"
#include "scratch.h"

#include <rapidjson/schema.h>
#include <rapidjson/stringbuffer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <regex>
#include <set>
#include <sstream>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// Empty if the value satisfies the schema, else the location of the violation.
std::string against(const JsonValue& value, const JsonValue& schema) {
    const rapidjson::GenericSchemaDocument<JsonValue> document(schema);
    rapidjson::GenericSchemaValidator<rapidjson::GenericSchemaDocument<JsonValue>> validator(document);
    if (value.Accept(validator)) return {};
    rapidjson::StringBuffer where;
    validator.GetInvalidDocumentPointer().StringifyUriFragment(where);
    return std::string(where.GetString()) + ": " + validator.GetInvalidSchemaKeyword();
}

/// One run: an operation with its settings. Names of files are within a folder; those in `folders` are folders.
struct Step {
    const char* operation;
    const char* settings;
    bool in_memory = true;  ///< false: its inputs are folders or several files, which stay on disk
};

const std::vector<Step>& steps() {
    static const std::vector<Step> list{
        {"mesh make", R"({"object": "teapot", "output": "pot.ply", "vertices": 2500, "labels": "pot.labels.txt"})"},
        {"mesh make", R"({"object": "teapot", "output": "fine.ply", "vertices": 5000})"},
        {"mesh info", R"({"input": "pot.ply"})"},
        {"mesh convert", R"({"input": "pot.ply", "output": "pot.obj", "map": "polygons.json"})"},
        {"mesh repair", R"({"input": "pot.ply", "output": "sound.ply", "vertex-map": "v.json", "face-map": "f.json"})"},
        {"annotation apply",
         R"({"mesh": "pot.ply", "recipe": "teapot.recipe.json", "output": "pot.ant.json", "ply": "seen.ply"})"},
        {"annotation list", R"({"mesh": "pot.ply", "annotations": "pot.ant.json"})"},
        {"annotation check", R"({"mesh": "pot.ply", "annotations": "pot.ant.json"})"},
        {"annotation remap",
         R"({"before": "pot.ply", "annotations": "pot.ant.json", "after": "sound.ply", "output": "remapped.ant.json",
             "vertex-map": "v.json", "face-map": "f.json"})"},
        {"mesh simplify",
         R"({"input": "pot.ply", "output": "coarse.ply", "vertices": 1200, "annotations": "pot.ant.json",
             "annotations-out": "coarse.ant.json", "vertex-map": "cv.json"})"},
        {"mesh refine",
         R"({"input": "coarse.ply", "output": "cut.ply", "vertices": 2000, "annotations": "coarse.ant.json",
             "annotations-out": "cut.ant.json"})"},
        {"mesh remesh", R"({"input": "coarse.ply", "output": "new.ply", "vertices": 1000})"},
        {"mesh bake", R"({"target": "new.ply", "source": "seen.ply", "output": "baked.ply", "to": "vertices"})"},
        {"mesh surface", R"({"cloud": "points.xyz", "output": "points.ply", "trim": 3, "outliers": 6})"},
        {"import", R"({"scan": "pot.ply", "object": "imported/", "unit": "mm"})"},
        {"mesh register", R"({"source": "pot.ply", "target": "fine.ply", "output": "registered.ply", "matrix": "matrix.json"})"},
        {"mesh move",
         R"({"input": "pot.ply", "output": "placed.ply", "rotate": "z,30", "translate": [1, 2, 3], "transform": "placed.json",
             "annotations": "pot.ant.json", "annotations-out": "placed.ant.json"})"},
        {"annotation transfer",
         R"({"source": "pot.ply", "annotations": "pot.ant.json", "target": "fine.ply", "output": "fine.ant.json",
             "back": "back.ant.json", "refine": true, "refined-mesh": "refined.ply", "map": "origin.json"})"},
        {"annotation survival", R"({"mesh": "coarse.ply", "annotations": "coarse.ant.json", "ratio": 0.5})"},
        {"annotation select",
         R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "picked.ant.json", "nearest": [0, 0, 1],
                                 "tag": "top"})"},
        {"annotation creases", R"({"mesh": "fine.ply", "output": "creases.ant.json", "unit": "mm", "scale": 0.03})"},
        {"annotation segment", R"({"mesh": "pot.ply", "output": "segments.ant.json"})"},
        {"annotation smooth", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "smooth.ant.json"})"},
        {"annotation transfer",
         R"({"source": "pot.ply", "annotations": "smooth.ant.json", "target": "fine.ply", "output": "free.ant.json",
             "back": "free-back.ant.json"})"},
        {"annotation edit",
         R"({"mesh": "pot.ply", "annotations": "picked.ant.json", "output": "edited.ant.json", "annotation": "top", "note": "knob"})"},
        {"annotation find", R"({"query": "spout and not crown", "objects": ["pot.ply"]})", false},
        {"annotation diff", R"({"mesh": "pot.ply", "before": "picked.ant.json", "after": "edited.ant.json"})"},
        {"annotation merge",
         R"({"mesh": "pot.ply", "base": "picked.ant.json", "ours": "picked.ant.json", "theirs": "edited.ant.json",
             "output": "merged.ant.json"})"},
        {"annotation export", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "attributes.csv"})"},
        {"annotation import",
         R"({"mesh": "pot.ply", "input": "attributes.csv", "onto": "pot.ant.json", "output": "in.ant.json"})"},
        {"measure take",
         R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "measured.ant.json", "tool": "bounding",
             "direction": "0,0,1", "name": "height"})"},
        {"measure describe", R"({"mesh": "pot.ply", "annotations": "measured.ant.json", "output": "described.ant.json"})"},
        {"measure refresh", R"({"mesh": "pot.ply", "annotations": "described.ant.json", "output": "refreshed.ant.json"})"},
        {"measure map", R"({"mesh": "pot.ply", "output": "curvature.npy", "of": "mean-curvature"})"},
        {"measure clay", R"({"mesh": "pot.ply"})"},
        {"measure distance",
         R"({"mesh": "pot.ply", "reference": "fine.ply", "output": "distance.npy", "back": "back.npy", "level": "level.npy",
             "annotations": "pot.ant.json", "tolerance": [0.1, 0.5], "samples": 2000, "picture": "distance.svg", "size": "400x200"})"},
        {"measure capacity", R"({"vessel": "pot.ply", "annotations": "pot.ant.json", "fill": [0.5]})"},
        {"relation extract", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "pot.graph.json"})"},
        {"relation add",
         R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "output": "level.graph.json", "type": "same level",
             "annotation": ["flower 1", "flower 2"], "constraint": true})"},
        {"relation list", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "graph": "pot.graph.json"})"},
        {"relation check", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "graph": "pot.graph.json"})"},
        {"relation export",
         R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "graph": "pot.graph.json", "output": "pot.dot"})"},
        {"relation edit",
         R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "graph": "level.graph.json", "output": "heavier.graph.json", "id": 0,
             "weight": 3})"},
        {"relation remove",
         R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "graph": "level.graph.json", "output": "none.graph.json", "id": [0]})"},
        {"vocabulary check", R"({"vocabulary": "terracotta.vocabulary.json"})"},
        {"vocabulary show", R"({"vocabulary": "terracotta.vocabulary.json"})"},
        {"vocabulary convert", R"({"input": "terracotta.vocabulary.json", "output": "terracotta.ttl"})"},
        {"annotation infer",
         R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "vocabulary": "terracotta.vocabulary.json",
             "output": "inferred.ant.json"})"},
        {"cage make", R"({"mesh": "pot.ply", "output": "cage.ply", "vertices": 100})"},
        {"cage check", R"({"mesh": "pot.ply", "cage": "cage.ply"})"},
        {"cage weights", R"({"mesh": "pot.ply", "cage": "cage.ply", "output": "weights.npy"})"},
        {"cage influence",
         R"({"mesh": "pot.ply", "cage": "cage.ply", "weights": "weights.npy", "output": "influence.ply", "cage-vertex": 3})"},
        {"cage edit", R"({"cage": "cage.ply", "edit": "raise.edit.json", "output": "raised.ply"})"},
        {"deform",
         R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "edit": "teapot-stretch.edit.json", "output": "stretched.ply",
             "cage": "cage.ply", "weights": "weights.npy", "annotations-out": "stretched.ant.json", "cage-out": "stretched-cage.ply"})"},
        {"axis", R"({"mesh": "pot.ply", "output": "axis.json"})"},
        {"slice", R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "count": 12, "output": "slices/"})"},
        {"study segments", R"({"mesh": "pot.ply", "output": "slices.ant.json", "curve": "curve.svg"})"},
        {"render", R"({"meshes": ["pot.ply"], "annotations": ["pot.ant.json"], "picture": "pot.png", "size": "300x200"})"},
        {"catalogue", R"({"collection": "pot.ply", "output": "pot.pdf", "table": "pot.csv", "unit": "mm", "pixels": 200})",
         false},
        {"publish",
         R"({"mesh": "pot.ply", "annotations": "pot.ant.json", "folder": "published/", "address": "https://pots.example/1"})"},
        {"report", R"({"results": ["pot.ply", "pot.ant.json", "pot.graph.json"], "page": "pot.html"})"},
        {"template pack",
         R"({"output": "pot.template.json", "mesh": "pot.ply", "annotations": "pot.ant.json", "graph": "pot.graph.json"})",
         false},
        {"template check", R"({"template": "pot.template.json"})", false},
        {"template show", R"({"template": "pot.template.json"})", false},
        {"study make technique", R"({"folder": "statuettes/", "objects": 4, "level": 1, "seed": 3, "vertices": 4000})"},
        {"study make proportions", R"({"folder": "proportioned/", "objects": 4, "vertices": 4000})"},
        {"study make moulds", R"({"folder": "heads/", "objects": 4, "moulds": 2, "vertices": 2000})"},
        {"study technique", R"({"collection": "statuettes/", "output": "technique/"})", false},
        {"study moulds", R"({"collection": "heads/", "output": "moulds/"})", false},
        {"study proportions", R"({"collection": "proportioned/", "output": "proportions/",
                                 "measures": "proportioned/statuettes.measures.json"})",
         false},
        {"mesh extract",
         R"({"mesh": "statuette.ply", "annotations": "statuette.ant.json", "output": "head.ply", "annotations-out": "head.ant.json",
             "annotation": ["head"], "closed": true})"},
        {"mesh break",
         R"({"input": "statuette.ply", "annotations": "statuette.ant.json", "output": "piece.ply", "annotations-out": "piece.ant.json",
             "at": "head", "share": 0.5, "seed": 2, "pose-out": "pose.json"})"},
        {"annotation facets", R"({"mesh": "piece.ply", "annotations": "piece.ant.json", "output": "facets.ant.json"})"},
        {"template pack",
         R"({"output": "statuette.template.json", "mesh": "statuette.ply", "annotations": "statuette.ant.json"})", false},
        {"fit", R"({"template": "statuette.template.json", "fragments": ["piece.ply"], "output": "fit/"})", false},
        {"template learn",
         R"({"template": "statuette.template.json", "members": ["statuettes/statuette-1.ply", "statuettes/statuette-2.ply",
             "statuettes/statuette-3.ply"], "output": "class/", "name": "statuette"})",
         false},
        {"template classify",
         R"({"files": ["statuettes/statuette-4.ply", "class/statuette.class.json"], "report": "answer.json"})", false},
        {"template sample", R"({"class": "class/statuette.class.json", "output": "samples/", "count": 1})", false},
        {"template propagate",
         R"({"template": "statuette.template.json", "members": ["statuettes/statuette-4.ply"], "output": "propagated/"})", false},
        {"operations", R"({"name": "mesh"})"},
    };
    return list;
}

/// A folder with the initial inputs of the steps.
void furnish(const Scratch& scratch) {
    const Path data = Path(OSTRAKA_SOURCE_DIR) / "data";
    for (const char* name :
         {"teapot.recipe.json", "teapot-stretch.edit.json", "terracotta.vocabulary.json", "statuette.ply", "statuette.ant.json"})
        write_file(scratch / name, read_file(data / name));
    std::ostringstream points;  // a coloured ball
    for (int i = 0; i < 600; ++i) {
        const double z = 1 - (2 * i + 1) / 600.0, radius = std::sqrt(1 - z * z), angle = 2.399963 * i;
        points << radius * std::cos(angle) << ' ' << radius * std::sin(angle) << ' ' << z << " 200 " << i % 256 << " 0\n";
    }
    write_file(scratch / "points.xyz", points.str());
    write_file(scratch / "raise.edit.json",
               R"({"format": "ostraka-edit", "version": 1, "steps": [{"select": {"all": true}, "translate": [0, 0, 1]}]})");
}

/// Every file below a folder, with its bytes; without the records of earlier runs.
std::map<std::string, std::string> files_below(const Path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && entry.path().filename().string()[0] != '.')
            files[entry.path().lexically_relative(folder).generic_string()] = read_file(entry.path());
    return files;
}

class EveryOperation : public ::testing::Test {
protected:
    /// Runs a step on files of the folder; checks the report against its schema.
    static Json on_files(const Step& step, const Path& folder) {
        Call call = call_in(folder, step.operation, step.settings);
        Context context;
        const Report report = call.run(context);
        Json schemas;
        EXPECT_EQ(against(report.result(), report.layout().to_schema(schemas.GetAllocator())), "") << step.operation;
        return report.to_json();
    }
};

}  // namespace

TEST_F(EveryOperation, IsDeclaredOnceAndValidly) {
    std::set<std::string> names;
    const std::regex word("[a-z0-9]+(-[a-z0-9]+)*");
    for (const OperationEntry& entry : operations()) {
        EXPECT_TRUE(names.insert(entry.name).second) << entry.name << " stands in the table twice";
        EXPECT_GT(std::string(entry.help).size(), 10U) << entry.name;
        const Call call(entry);                                                  // throws where a name is declared twice
        std::set<std::string> keys{"json", "show", "quiet", "threads", "help"};  // of every command
        const auto look = [&](const std::string& name, const std::string& help) {
            EXPECT_TRUE(std::regex_match(name, word)) << entry.name << ": " << name;
            EXPECT_TRUE(keys.insert(name).second) << entry.name << ": " << name << " is declared twice";
            EXPECT_GT(help.size(), 3U) << entry.name << ": " << name;
        };
        for (const Slot* slot : call.parameters().slots()) look(slot->name, slot->help);
        for (const Option& option : call.parameters().options) {
            look(option.name, option.help);
            if (option.needed) continue;
            EXPECT_NO_THROW(option.check()) << entry.name << ": the default of " << option.name << " is not allowed";
        }
        for (const auto& order : call.parameters().orders)
            for (const std::string& name : order) EXPECT_TRUE(keys.count(name) == 1) << entry.name << ": " << name;
        Json document;
        const rapidjson::GenericSchemaDocument<JsonValue> settings(call.schema(document.GetAllocator()));
        const rapidjson::GenericSchemaDocument<JsonValue> result(call.parameters().report.to_schema(document.GetAllocator()));
    }
}

TEST_F(EveryOperation, TakesWhatItsHelpNames) {
    for (const OperationEntry& entry : operations()) {
        const Call declared(entry);
        for (const Option& option : declared.parameters().options) {
            SCOPED_TRACE(std::string(entry.name) + " --" + option.name);
            EXPECT_EQ(option.help.find("x, y, z"), std::string::npos) << "directions are named by the rule, not by the help";
            EXPECT_EQ(std::holds_alternative<Words>(option.rule) && option.names().empty(), false);
            const auto take = [&](const std::vector<std::string>& words) {
                Call call(entry);
                EXPECT_NO_THROW(call.option(option.name).set(words)) << joined(words);
                EXPECT_EQ(call.option(option.name).texts(), words);
            };
            for (const std::string& name : option.names()) take({name});
            if (!option.needed && !option.empty() && !option.texts().front().empty()) take(option.texts());
        }
    }
}

TEST_F(EveryOperation, RunsHereOrHasItsOwnTest) {
    // Operations with inputs that take long to make are run by the tests of their modules.
    std::set<std::string> run{"study landmarks", "study shape",     "template revolve", "pair", "assemble", "run",
                              "replay",          "conformance run", "conformance self"};
    for (const Step& step : steps()) run.insert(step.operation);
    for (const OperationEntry& entry : operations()) EXPECT_TRUE(run.count(entry.name) == 1) << entry.name;
}

TEST_F(EveryOperation, GivesTheSameBytesFromObjectsInMemory) {
    const Scratch on_disk, other;
    furnish(on_disk);
    furnish(other);
    std::map<std::string, Object> objects;
    for (const Step& step : steps()) {
        SCOPED_TRACE(step.operation);
        Json expected;
        try {
            expected = on_files(step, on_disk.path());
        } catch (const std::exception& error) {
            ADD_FAILURE() << step.operation << " on files: " << error.what();
            continue;
        }
        if (!step.in_memory) continue;
        try {
            const Json settings = parse_json(step.settings, step.operation);
            Call call(find_operation(step.operation));
            Json rest(rapidjson::kObjectType);
            std::vector<std::pair<std::string, std::string>> outputs;  // slot, file
            for (const auto& member : settings.GetObject()) {
                const std::string name = member.name.GetString();
                const Slot* slot = call.parameters().slot(name);
                if (slot == nullptr) {
                    add_member(rest, name, JsonValue(member.value, rest.GetAllocator()), rest.GetAllocator());
                    continue;
                }
                std::vector<std::string> files;
                if (member.value.IsArray())
                    for (const auto& item : member.value.GetArray()) files.emplace_back(item.GetString());
                else files.emplace_back(member.value.GetString());
                for (const std::string& file : files) {
                    if (slot->role == Role::output) {
                        call.want(name, file);
                        outputs.emplace_back(name, file);
                    } else {
                        // Inputs that no step made are passed as bytes.
                        if (!objects.contains(file)) objects[file] = Object::of(read_file(other / file), file);
                        call.set_object(name, objects.at(file));
                    }
                }
            }
            call.set(rest);
            Context context;
            const std::size_t before = files_below(other.path()).size();
            const Report report = call.run(context);
            EXPECT_EQ(files_below(other.path()).size(), before) << "a file was touched";
            EXPECT_EQ(to_text(report.to_json()["provenance"]), to_text(expected["provenance"]));
            for (const auto& [slot, file] : outputs) {
                if (!std::filesystem::exists(on_disk / file)) continue;  // not written if the answer is no
                Object object = call.object(slot);
                object.name = file;
                if (const auto folder = object.as<Path>()) {
                    for (const std::string& name : files_in(*folder)) {
                        if (name[0] == '.') continue;
                        EXPECT_EQ(read_file(*folder / name) == read_file(on_disk / (file + name)), true) << file << name;
                    }
                    continue;
                }
                const Path written = other / ("written-" + file);
                if (object.write) object.write(written);
                else if (const auto bytes = object.as<std::string>()) write_file(written, *bytes);
                else FAIL() << file << " cannot be written";
                if (read_file(written) != read_file(on_disk / file)) {
                    ADD_FAILURE() << file << " differs";
                    if (const char* keep = std::getenv("OSTRAKA_KEEP")) {
                        std::filesystem::copy(written, Path(keep) / ("memory-" + file));
                        std::filesystem::copy(on_disk / file, Path(keep) / ("file-" + file));
                    }
                }
                std::filesystem::remove(written);
                objects[file] = object;
            }
        } catch (const std::exception& error) {
            ADD_FAILURE() << step.operation << " in memory: " << error.what();
        }
    }
}

TEST(Pages, AreThoseOfTheTable) {
    const Path folder = Path(OSTRAKA_SOURCE_DIR) / "doc/commands";
    std::set<std::string> expected;
    for (const std::string& word : command_page_names()) {
        expected.insert(word + ".md");
        ASSERT_TRUE(file_exists(folder / (word + ".md"))) << word << ": run 'ostraka operations --pages doc/commands'";
        EXPECT_EQ(read_file(folder / (word + ".md")), command_page(word)) << "run 'ostraka operations --pages doc/commands'";
    }
    for (const std::string& file : files_in(folder)) EXPECT_TRUE(expected.contains(file)) << file << " is no page of the table";
}

TEST(Completion, KnowsNamesFlagsChoicesTagsAndFiles) {
    const auto has = [](const std::vector<std::string>& words, const std::string& wanted) {
        const auto list = completions(words);
        return std::find(list.begin(), list.end(), wanted) != list.end();
    };
    EXPECT_TRUE(has({"ann"}, "annotation"));
    EXPECT_TRUE(has({"annotation", "tr"}, "transfer"));
    EXPECT_FALSE(has({"annotation", "tr"}, "select"));
    EXPECT_TRUE(has({"annotation", "transfer", "--sp"}, "--spikes"));
    EXPECT_TRUE(has({"annotation", "transfer", "--no"}, "--no-overlap"));
    EXPECT_TRUE(has({"annotation", "transfer", "--spikes", "p"}, "prune"));
    const std::string data = (Path(OSTRAKA_SOURCE_DIR) / "data").string() + "/";
    EXPECT_TRUE(has({"axis", data + "teapot.ply", data + "teapot.ant.json", "--annotation", "sp"}, "spout"));
    EXPECT_TRUE(has({"axis", data + "tea"}, data + "teapot.ply"));
    EXPECT_FALSE(has({"axis", data + "tea"}, data + "teapot.ant.json"));
    EXPECT_TRUE(completions({}).empty());
    for (const Shell shell : {Shell::bash, Shell::zsh, Shell::fish})
        EXPECT_NE(completion_script(shell).find("--complete"), std::string::npos);
}

TEST(Calls, RefuseInvalidArguments) {
    const auto message = [](const auto& work) {
        try {
            work();
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("nothing was refused");
    };
    const auto with = [&](const char* operation, const char* settings) {
        return message([&] {
            Call call(find_operation(operation));
            call.set(parse_json(settings, "settings"));
            Context context;
            static_cast<void>(call.run(context));
        });
    };
    EXPECT_NE(message([] { static_cast<void>(find_operation("annotation transfr")); }).find("'annotation transfer'"),
              std::string::npos);
    EXPECT_NE(with("annotation transfer", R"({"spiked": "prune"})").find("'spikes'"), std::string::npos);
    EXPECT_NE(with("annotation transfer", R"({"spikes": 3})").find("one of: prune"), std::string::npos);
    EXPECT_NE(with("annotation transfer", R"({"refine": "yes"})").find("true or false"), std::string::npos);
    EXPECT_NE(with("annotation transfer", R"({"max-angle": 1000})").find("0 to 180"), std::string::npos);
    EXPECT_NE(with("annotation transfer", R"({"max-angle": "wide"})").find("max-angle"), std::string::npos);
    EXPECT_NE(with("annotation transfer", R"({"source": 3})").find("source"), std::string::npos);
    EXPECT_NE(with("mesh info", "{}").find("input is missing"), std::string::npos);
    EXPECT_NE(with("mesh info", R"({"input": "/nowhere.ply"})").find("cannot be opened"), std::string::npos);
    EXPECT_NE(with("mesh info", R"([])").find("not an object"), std::string::npos);
    EXPECT_NE(message([] {
                  Call call(find_operation("mesh info"));
                  call.set_object("input", Object::of(std::string("no mesh"), "x.ply"));
                  Context context;
                  static_cast<void>(call.run(context));
              }).find("x.ply"),
              std::string::npos);
}

TEST(Calls, AreCancelledDuringTheRunAndLeaveNoFiles) {
    const Scratch scratch;
    Context context;
    Call make(find_operation("mesh make"));
    make.set("object", "teapot");
    make.set("vertices", 3000.0);
    make.want("output", "pot.ply");
    static_cast<void>(make.run(context));

    Context second;
    int reported = 0;
    second.watch.on_progress = [&](const std::string& phase, double share) {
        EXPECT_FALSE(phase.empty());
        EXPECT_GE(share, 0);
        EXPECT_LE(share, 1);
        if (++reported == 1) second.watch.cancel();
    };
    Call refine(find_operation("mesh refine"));
    refine.set_object("input", make.object("output"));
    refine.set_file("output", scratch / "fine.ply");
    refine.set("vertices", 2e6);
    try {
        static_cast<void>(refine.run(second));
        FAIL() << "it was not cancelled";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::cancelled) << error.what();
    }
    EXPECT_EQ(count_files(scratch.path()), 0U);
}

TEST(Calls, ReadEachFileOnceInAChain) {
    const Scratch scratch;
    const Path mesh = scratch / "pot.ply";
    write_file(mesh, read_file(Path(OSTRAKA_SOURCE_DIR) / "data/teapot.ply"));
    Context context;
    context.keep_objects = true;
    const auto clay = [&] {
        Call call(find_operation("measure clay"));
        call.set_file("mesh", mesh);
        return to_text(call.run(context).result());
    };
    const std::string first = clay();
    {
        ReadRecord record;
        EXPECT_EQ(clay(), first);
        EXPECT_TRUE(record.files.empty()) << "the file was read again";
    }
    write_file(mesh, read_file(Path(OSTRAKA_SOURCE_DIR) / "data/vase.ply"));
    EXPECT_NE(clay(), first) << "a changed file was not read again";
}

namespace {

/// Writes a file of this name into a folder.
class Fill final : public Operation {
public:
    void declare(Parameters& p) override {
        p.input_option("input", Kind::text, input_, "a file that is read");
        p.output("output", Kind::folder, output_, "folder to write to").flag();
        p.options("name", name_, "of the file");
    }
    void run(Context&, Report&) override {
        output_.open();
        if (input_) static_cast<void>(read_file(input_.path()));
        write_file(output_.in(name_), "made");
    }

private:
    FileInput input_;
    FolderOutput output_;
    std::string name_;
};

/// Annotations, and then a template, which have an option in common.
class TakesBoth final : public Operation {
public:
    void declare(Parameters& p) override {
        p.input_option("annotations", Kind::annotations, annotations_, "annotations");
        p.input("template", Kind::template_package, template_, "template");
        p.report.values(fields::boolean("forced"));
    }
    void run(Context&, Report& report) override {
        static_cast<void>(*template_);
        report("forced", template_.options.force_mesh);
    }

private:
    AnnotationsInput annotations_;
    TemplateInput template_;
};

template <class Work>
OperationEntry entry_of(const char* name) {
    return {name, "an operation of this test", [] { return std::unique_ptr<Operation>(std::make_unique<Work>()); }};
}

}  // namespace

TEST(Calls, NeverRemoveAnInputThatAnEarlierRunWrote) {
    const Scratch scratch;
    const OperationEntry entry = entry_of<Fill>("test fill");
    const auto fill = [&](const std::string& name, const Path& input) {
        Call call(entry);
        call.set("name", name);
        call.set_file("output", scratch.path());
        if (!input.empty()) call.set_file("input", input);
        Context context;
        static_cast<void>(call.run(context));
    };
    fill("a.txt", {});
    fill("b.txt", scratch / "a.txt");
    EXPECT_TRUE(std::filesystem::exists(scratch / "a.txt"));
    fill("c.txt", {});
    EXPECT_FALSE(std::filesystem::exists(scratch / "b.txt"));
}

TEST(Calls, ShareOptionsOfInputsInEitherOrder) {
    const OperationEntry entry = entry_of<TakesBoth>("test both");
    for (const bool forced : {false, true}) {
        Call call(entry);
        Object object = Object::of(Template(), "t.template.json");
        object.sha256 = "known";
        call.set_object("template", object);
        call.set("force-mesh", forced);
        Context context;
        EXPECT_EQ(call.run(context).result()["forced"].GetBool(), forced);
    }
}

TEST(Calls, AskForTheChecksumOfObjects) {
    const auto show = [](const std::string& sha256) {
        Call call(find_operation("vocabulary show"));
        Object words = Object::of(Vocabulary(), "words.vocabulary.json");
        words.sha256 = sha256;
        call.set_object("vocabulary", words);
        Context context;
        return call.run(context);
    };
    EXPECT_THROW(static_cast<void>(show("")), Error);
    const auto inputs = show("of these words").provenance().inputs;
    ASSERT_EQ(inputs.size(), 1U);
    EXPECT_EQ(inputs[0].second, "of these words");
}

TEST(Calls, WriteNoPartOfACancelledCollection) {
    const Scratch scratch;
    Context context;
    context.watch.on_progress = [&](const std::string&, double share) {
        if (share > 0) context.watch.cancel();
    };
    Call call(find_operation("study make technique"));
    call.set_file("folder", scratch / "statuettes");
    call.set("objects", 60.0);
    call.set("vertices", 4000.0);
    EXPECT_THROW(static_cast<void>(call.run(context)), Error);
    if (std::filesystem::exists(scratch / "statuettes")) {
        EXPECT_EQ(count_files(scratch / "statuettes"), 0U);
    }
}

TEST(Reports, KnowTheirColumns) {
    ReportLayout layout;
    layout.values(fields::number("size", "size"));
    layout.table("rows", fields::integer("id", "id"), fields::number("area"), fields::text_only("remarks"),
                 fields::text_only("area"));
    layout.text_table("seen", {"what", "count"});
    Report report({"test", {}, {}}, layout);
    report("size", 1.5)("size", std::optional<double>());
    report.row("rows")("id", 7)("area", std::numeric_limits<double>::infinity()).shown("remarks", "odd").shown("area", "none");
    report.row("seen", {"holes", 3});
    EXPECT_EQ(to_text(report.result()), to_text(parse_json(R"({"size": 1.5, "rows": [{"id": 7}]})", "expected")));
    EXPECT_EQ(report.to_text(ReportFormat::table),
              "size  1.5\nid  remarks  area\n 7  odd      none\nseen\nwhat   count\nholes      3\n");
    EXPECT_THROW(report("length", 1), std::logic_error);
    EXPECT_THROW(report.row("rows")("length", 1), std::logic_error);
    EXPECT_THROW(report.row("rows").shown("length", "-"), std::logic_error);
    EXPECT_THROW(report.row("seen", {"holes"}), std::logic_error);
}

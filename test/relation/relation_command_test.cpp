// The built command, as people run it.
#include "ostraka/files/json.h"
#include "ostraka/io/mesh_file.h"
#include "scratch.h"

#include <gtest/gtest.h>

using namespace ostraka;
using ostraka::test::count_files;
using ostraka::test::run_command;
using ostraka::test::Scratch;

namespace {

const std::string data = OSTRAKA_SOURCE_DIR "/data/";
const std::string pot = data + "teapot.ply " + data + "teapot.ant.json ";

Json report_of(const std::string& text) {
    Json report = parse_json(text, "report");
    validate(report, "report", "report");
    return report;
}

}  // namespace

TEST(RelationCommand, ExtractAddCheckExport) {
    const Scratch scratch;
    const auto at = [&](const char* name) { return (scratch / name).string(); };
    const auto extracted = run_command("relation extract " + pot + at("a.graph.json"));
    ASSERT_EQ(extracted.code, 0) << extracted.err;
    EXPECT_NE(extracted.out.find("  0 teapot (region)\n    1 body (region)"), std::string::npos) << extracted.out;
    EXPECT_EQ(extracted.out.find(scratch.path().string()), std::string::npos);
    const std::string first = read_file(scratch / "a.graph.json");
    ASSERT_EQ(run_command("relation extract --threads 1 " + pot + at("a.graph.json")).code, 0);
    EXPECT_EQ(read_file(scratch / "a.graph.json"), first);

    // A constraint, a user-defined type, and a relationship that does not hold.
    const std::string add = "relation add " + pot;
    ASSERT_EQ(run_command(add + at("b.graph.json") + " --graph " + at("a.graph.json") +
                          " --type Proportion --annotation spout --annotation 6 --weight 4 --directed --parameters "
                          "'{\"measure1\": 0, \"minValue\": 0.5}'")
                  .code,
              0);
    ASSERT_EQ(run_command(add + at("c.graph.json") + " --graph " + at("b.graph.json") +
                          " --type 'glazed before' --own-type --directed --annotation body --annotation lid --annotation knob")
                  .code,
              0);
    const auto checked = run_command("relation check " + pot + at("c.graph.json"));
    EXPECT_EQ(checked.code, 0) << checked.out;
    EXPECT_NE(checked.out.find(" 0 fail, 2 unknown"), std::string::npos) << checked.out;
    ASSERT_EQ(run_command(add + at("d.graph.json") + " --graph " + at("c.graph.json") +
                          " --type containment --annotation knob --annotation body")
                  .code,
              0);
    const auto failed = run_command("relation check --json " + pot + at("d.graph.json"));
    EXPECT_EQ(failed.code, 3);
    const Json report = report_of(failed.out);
    EXPECT_EQ(report["result"]["fails"].GetInt(), 1);
    const auto& last = report["result"]["relationships"][report["result"]["relationships"].Size() - 1];
    EXPECT_STREQ(last["verdict"].GetString(), "fails");
    EXPECT_EQ(last["parameters"]["deviations"][0]["value"].GetDouble(), 100) << "no face of the body lies in the knob";

    // User-specified relationships survive another extraction; extracted ones are not duplicated.
    const auto again = run_command("relation extract --json " + pot + at("e.graph.json") + " --graph " + at("c.graph.json"));
    ASSERT_EQ(again.code, 0) << again.err;
    const Json before = parse_json(first, "a"), after = read_json(scratch / "e.graph.json");
    EXPECT_EQ(after["relationships"].Size(), before["relationships"].Size() + 2);
    EXPECT_GT(report_of(again.out)["result"]["tree"].Size(), 10U);

    ASSERT_EQ(run_command("relation export " + pot + at("c.graph.json") + " " + at("c.dot")).code, 0);
    EXPECT_NE(read_file(scratch / "c.dot").find("label=\"glazed before\""), std::string::npos);
}

TEST(RelationCommand, AddsSeveralRelationshipsToTheGraphInPlace) {
    const Scratch scratch;
    const std::string graph = (scratch / "g.graph.json").string();
    const auto added =
        run_command("relation add " + pot + "--graph " + graph +
                    " --relation 'same level: flower 1, 8 ,flower 3' --relation 'co-axiality: lid, body' --constraint");
    ASSERT_EQ(added.code, 0) << added.err;
    Json graph_file = read_json(graph);
    ASSERT_EQ(graph_file["relationships"].Size(), 2U);
    EXPECT_EQ(to_text(graph_file["relationships"][0]["annotations"]), "[7, 8, 9]\n");
    EXPECT_STREQ(graph_file["relationships"][1]["type"].GetString(), "co-axiality");
    EXPECT_TRUE(graph_file["relationships"][1]["isConstraint"].GetBool());
    ASSERT_EQ(run_command("relation add " + pot + "--graph " + graph + " --relation 'adjacency: lid, body'").code, 0);
    EXPECT_EQ(read_json(graph)["relationships"].Size(), 3U);
    const std::string before = read_file(graph);
    const auto refused = [&](const std::string& options, int code, const std::string& text) {
        const auto result = run_command("relation add " + pot + options);
        EXPECT_EQ(result.code, code) << options;
        EXPECT_NE(result.err.find(text), std::string::npos) << result.err;
        EXPECT_EQ(read_file(graph), before);
    };
    refused("--graph " + graph + " --relation 'adjacency lid, body'", 2, "is not a relationship");
    refused("--graph " + graph + " --relation 'adjacency: lid,, body'", 2, "is not a relationship");
    refused("--graph " + graph + " --relation 'adjacensy: lid, body'", 2, "did you mean 'adjacency'?");
    refused("--graph " + graph + " --relation 'adjacency: lid, body' --type adjacency", 2, "one form only");
    refused("--graph " + graph, 2, "type of the relationship");
    refused("--relation 'adjacency: lid, body'", 2, "no file for the graph");
    refused(graph + ".new --graph " + graph + ".absent --relation 'adjacency: lid, body'", 1, "cannot be opened");
}

TEST(RelationCommand, BadInput) {
    const Scratch scratch;
    const std::string out = (scratch / "o.graph.json").string(), add = "relation add " + pot + out;
    const auto expect = [&](const std::string& line, int code, const std::string& words) {
        const auto result = run_command(line);
        EXPECT_EQ(result.code, code) << line << "\n" << result.err;
        EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
        EXPECT_EQ(count_files(scratch.path()), 0U) << "nothing is left behind";
    };
    expect(add + " --type adjacency --annotation body --annotation 77", 1, "has no annotation '77'");
    expect(add + " --type adjacency --annotation body --annotation wing", 1, "has no annotation 'wing'");
    expect(add + " --type adjacency --annotation body", 1, "relates 1 annotation");
    expect(add + " --type adjacensy --annotation body --annotation lid", 2, "did you mean 'adjacency'?");
    expect(add + " --type 'same level' --annotation body --annotation lid --tolerance height=-1", 2, "negative");
    expect(add + " --type 'same level' --annotation body --annotation lid --tolerance height", 2, "not a tolerance");
    expect(add + " --type 'same level' --annotation body --annotation lid --tolerance height=%", 2, "not a tolerance");
    expect(add + " --type co-axiality --annotation body --annotation lid --tolerance angle=3%", 2, "in degrees");
    expect(add + " --type 'equal attributes' --annotation body --annotation lid", 2, "--attribute NAME");
    expect(add + " --type line --annotation body --parameters '[1]'", 1, "not a JSON object");
    expect(add + " --type line --annotation body --weight -3", 2, "weight");
    for (const char* weight : {"nan", "inf", "1e999"}) {
        expect(add + " --type adjacency --annotation body --annotation lid --weight " + weight, 2, "weight");
        expect(add + " --type co-axiality --annotation body --annotation lid --tolerance angle=" + weight, 2, "not a tolerance");
        EXPECT_LT(run_command(add + " --type line --annotation body --weight " + weight).err.size(), 200U);
    }
    expect("relation extract " + pot + "nowhere/o.graph.json", 1, "nowhere");
    expect("relation check " + pot + out, 1, "o.graph.json");
    expect("relation extract " + data + "vase.ply " + data + "teapot.ant.json " + out, 1, "teapot.ant.json");
}

TEST(RelationCommand, IdsContinueAfterTheLargestId) {
    const Scratch scratch;
    const std::string graph = scratch
                                  .file("g.graph.json", R"({"relationships": [{"id": 2147483647, "type": "adjacency",
        "isDirected": false, "annotations": [1, 2], "isConstraint": false, "origin": "stated"}]})")
                                  .string(),
                      out = (scratch / "o.graph.json").string();
    const auto added =
        run_command("relation add " + pot + out + " --graph " + graph + " --type co-axiality --annotation 1 --annotation 2");
    ASSERT_EQ(added.code, 0) << added.err;
    EXPECT_EQ(read_json(out)["relationships"][1]["id"].GetInt(), 0);
    EXPECT_EQ(run_command("relation list " + pot + out).code, 0);
}

TEST(RelationCommand, ExportReports) {
    const Scratch scratch;
    const std::string graph = scratch
                                  .file("g.graph.json", R"({"relationships": [{"id": 1, "type": "adjacency", "isDirected": false,
        "annotations": [1, 2], "isConstraint": false}]})")
                                  .string();
    const auto result = run_command("relation export " + pot + graph + " " + (scratch / "g.dot").string() + " --json");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    validate(report, "report", "report");
    EXPECT_EQ(report["result"]["relationships"].GetInt(), 1);
}

TEST(RelationCommand, ExtractedRelationshipsCanBeSpecifiedListedAndRemoved) {
    const Scratch scratch;
    const auto at = [&](const char* name) { return (scratch / name).string(); };
    (void)scratch.file("old.graph.json", R"({"relationships": [
        {"id": 4, "type": "adjacency", "isDirected": false, "annotations": [1, 2], "isConstraint": false, "origin": "extracted"},
        {"id": 7, "type": "equal attributes", "isDirected": false, "annotations": [1, 2], "isConstraint": false,
         "origin": "extracted", "parameters": {"attribute": "area"}},
        {"id": 9, "type": "proportion", "isDirected": false, "annotations": [1, 2], "isConstraint": true, "weight": 3,
         "constraint": {}, "origin": "stated"}]})");
    const auto listed = run_command("relation list " + pot + at("old.graph.json"));
    ASSERT_EQ(listed.code, 0) << listed.err;
    EXPECT_NE(listed.out.find("equal attributes: area"), std::string::npos) << listed.out;
    EXPECT_NE(listed.out.find("proportion (constraint, weight 3)"), std::string::npos) << listed.out;
    EXPECT_NE(run_command("relation check " + pot + at("old.graph.json")).out.find("equal attributes: area"), std::string::npos);

    // The members of an undirected relationship may be given in any order.
    const std::string state =
        "relation add " + pot + at("new.graph.json") + " --graph " + at("old.graph.json") +
        " --type 'equal attributes' --attribute area --annotation 2 --annotation 1 --tolerance difference=40";
    const auto stated = run_command(state);
    ASSERT_EQ(stated.code, 0) << stated.err;
    EXPECT_NE(stated.err.find("relationship 7 was extracted and is stated now"), std::string::npos) << stated.err;
    EXPECT_EQ(std::count(stated.out.begin(), stated.out.end(), '\n'), 2) << "what was added and no more: " << stated.out;
    const Json graph = read_json(scratch / "new.graph.json");
    ASSERT_EQ(graph["relationships"].Size(), 3U);
    const JsonValue& changed = graph["relationships"][1];
    EXPECT_EQ(changed["id"].GetInt(), 7);
    EXPECT_STREQ(changed["origin"].GetString(), "stated");
    EXPECT_EQ(changed["parameters"]["deviations"][0]["tolerance"].GetDouble(), 40);
    EXPECT_STREQ(changed["parameters"]["deviations"][0]["unit"].GetString(), "%");
    const auto twice = run_command("relation add " + pot + at("third.graph.json") + " --graph " + at("new.graph.json") +
                                   " --type 'equal attributes' --attribute area --annotation 1 --annotation 2");
    EXPECT_EQ(twice.code, 1);
    EXPECT_NE(twice.err.find("new.graph.json: relationship 7 says the same"), std::string::npos) << twice.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "third.graph.json"));

    const std::string remove = "relation remove " + pot + at("new.graph.json") + " " + at("left.graph.json");
    const auto unknown = run_command(remove + " --id 4 --id 5");
    EXPECT_EQ(unknown.code, 1);
    EXPECT_NE(unknown.err.find("new.graph.json: has no relationship 5"), std::string::npos) << unknown.err;
    EXPECT_EQ(run_command(remove).code, 2) << "nothing is named";
    const auto removed = run_command(remove + " --id 4 --id 9 --json");
    ASSERT_EQ(removed.code, 0) << removed.err;
    EXPECT_EQ(report_of(removed.out)["result"]["relationships"].Size(), 2U);
    const Json left = read_json(scratch / "left.graph.json");
    ASSERT_EQ(left["relationships"].Size(), 1U);
    EXPECT_EQ(left["relationships"][0]["id"].GetInt(), 7);
}

TEST(RelationCommand, TolerancesAreInTheUnitOfTheMeshOrInPerCentOfItsDiagonal) {
    const Scratch scratch;
    const auto tolerance = [&](const std::string& text) {
        const auto added = run_command("relation add --json " + pot + (scratch / "g.graph.json").string() +
                                       " --type 'same level' --annotation body --annotation lid --tolerance height=" + text);
        EXPECT_EQ(added.code, 0) << added.err;
        const Json report = report_of(added.out);
        const JsonValue& deviation = report["result"]["relationships"][0]["parameters"]["deviations"][0];
        EXPECT_STREQ(deviation["unit"].GetString(), "mm");
        return deviation["tolerance"].GetDouble();
    };
    EXPECT_EQ(tolerance("2"), 2);
    const double diagonal = box_diagonal(read_mesh(Path(data) / "teapot.ply").mesh);
    EXPECT_NEAR(tolerance("1%"), diagonal / 100, 1e-12 * diagonal);
}

TEST(RelationCommand, RepeatedOptionsGiveAReadableFile) {
    const Scratch scratch;
    const std::string graph = (scratch / "g.graph.json").string();
    ASSERT_EQ(run_command("relation extract " + pot + graph + " --type adjacency --type containment").code, 0);
    EXPECT_STREQ(read_json(graph)["provenance"]["options"]["type"].GetString(), "adjacency; containment");
    EXPECT_EQ(run_command("relation check " + pot + graph).code, 0);
}

TEST(RelationCommand, WithoutUpSkippedTypesAreReported) {
    const Scratch scratch;
    const auto at = [&](const char* name) { return (scratch / name).string(); };
    ASSERT_EQ(run_command("annotation edit " + pot + at("flat.ant.json") + " --set-up ''").code, 0);
    const std::string flat = data + "teapot.ply " + at("flat.ant.json") + " ";
    const std::string extract = "relation extract " + flat + at("g.graph.json");
    const auto all = run_command(extract);
    ASSERT_EQ(all.code, 0) << all.err;
    EXPECT_NE(all.err.find("same level, horizontal support, side contact"), std::string::npos) << all.err;
    EXPECT_EQ(run_command(extract + " --type 'part similarity'").err, "") << "it needs no upward direction";
    ASSERT_EQ(run_command("annotation edit " + flat + at("up.ant.json") + " --set-up 0,0,2").code, 0);
    const auto up = run_command("relation extract " + data + "teapot.ply " + at("up.ant.json") + " " + at("u.graph.json") +
                                " --type 'horizontal support'");
    ASSERT_EQ(up.code, 0) << up.err;
    EXPECT_EQ(up.err, "");
    EXPECT_GT(read_json(scratch / "u.graph.json")["relationships"].Size(), 0U);
}

TEST(RelationCommand, ChecksConstraintsOnTheObjectAsItIs) {
    const Scratch scratch;
    const auto at = [&](const char* name) { return (scratch / name).string(); };
    const std::string chair = data + "chair.ply " + data + "chair.ant.json ", graph = at("b.graph.json");
    const std::string add = "relation add " + chair;
    ASSERT_EQ(run_command(add + at("a.graph.json") +
                          " --type proportion --annotation 'front left leg' --annotation 'front right leg' --parameters "
                          "'{\"measure1\": \"height\", \"measure2\": \"height\", \"minValue\": 0.9, \"maxValue\": 1.1}'")
                  .code,
              0);
    ASSERT_EQ(
        run_command(add + graph + " --graph " + at("a.graph.json") + " --type 'keep shape' --annotation seat --constraint").code,
        0);
    const auto check = [&](const std::string& mesh, const std::string& more) {
        auto result = run_command("relation check --json " + mesh + " " + data + "chair.ant.json " + graph + " " + more);
        return std::pair{result.code, report_of(result.out)};
    };
    const auto verdict = [](const Json& report, rapidjson::SizeType i) {
        return std::string(report["result"]["relationships"][i]["verdict"].GetString());
    };
    const auto [right, report] = check(data + "chair.ply", "");
    EXPECT_EQ(right, 0);
    EXPECT_EQ(verdict(report, 0), "holds");
    EXPECT_EQ(verdict(report, 1), "unknown");
    EXPECT_NE(std::string(report["result"]["relationships"][1]["text"].GetString()).find("--rest"), std::string::npos);
    EXPECT_TRUE(report["result"]["conforms"].GetBool());

    // A leg that is half as long again, and its seat bent with it.
    ASSERT_EQ(run_command("deform " + chair + at("long.ply") + " --stretch 'front left leg=1.5'").code & ~3, 0);
    const auto [wrong, deformed_report] = check(at("long.ply"), "--force-mesh --rest " + data + "chair.ply");
    EXPECT_EQ(wrong, 3);
    EXPECT_EQ(verdict(deformed_report, 0), "fails");
    const auto& deviation = deformed_report["result"]["relationships"][0]["parameters"]["deviations"][0];
    EXPECT_GT(deviation["value"].GetDouble(), 10);
    EXPECT_STREQ(deviation["unit"].GetString(), "%");
    EXPECT_NE(verdict(deformed_report, 1), "unknown");
    EXPECT_FALSE(deformed_report["result"]["conforms"].GetBool());
    EXPECT_EQ(run_command("relation check " + chair + graph + " --rest " + data + "teapot.ply").code, 1);

    // The rules of a class in the same report.
    const Path rules = scratch.file("chair.rules.json", R"({"format": "ostraka-rules", "version": 1, "class": "chair", "rules": [
        {"id": "one seat", "count": {"of": "seat", "min": 1, "max": 1}},
        {"id": "five legs", "count": {"of": "front left leg", "min": 5}}]})");
    const auto [broken, ruled] = check(data + "chair.ply", "--rules " + rules.string());
    EXPECT_EQ(broken, 3);
    ASSERT_EQ(ruled["result"]["rules"].Size(), 1U);
    EXPECT_STREQ(ruled["result"]["rules"][0]["rule"].GetString(), "five legs");
    EXPECT_EQ(run_command("relation check " + chair + graph + " --vocabulary v.ttl").code, 2);
}

TEST(RelationCommand, TheOrderOfPartsIsKeptEverywhere) {
    const Scratch scratch;
    const auto at = [&](const char* name) { return (scratch / name).string(); };
    const std::vector<int> wanted{6, 5}, turned{5, 6};  // handle before spout, against the order of the annotations
    const auto expect_kept = [&](const char* name, std::size_t count = 1) {
        const Json graph = read_json(scratch / name);
        std::size_t constraint_count = 0;
        for (const auto& relationship : graph["relationships"].GetArray()) {
            if (!relationship["isConstraint"].GetBool()) continue;
            std::vector<int> members;
            for (const auto& id : relationship["annotations"].GetArray()) members.push_back(id.GetInt());
            EXPECT_EQ(members, constraint_count == 0 ? wanted : turned) << name;
            ++constraint_count;
        }
        EXPECT_EQ(constraint_count, count) << name;
    };
    const std::string state =
        " --constraint --parameters '{\"minValue\": 0.5, \"maxValue\": 2, \"measure1\": \"length\", "
        "\"measure2\": \"length\"}'";
    // Specified by separate options and by one.
    ASSERT_EQ(run_command("relation add " + pot + at("a.graph.json") +
                          " --type proportion --annotation handle --annotation spout" + state)
                  .code,
              0);
    expect_kept("a.graph.json");
    ASSERT_EQ(run_command("relation add " + pot + at("b.graph.json") + " --relation 'proportion: handle, spout'" + state).code,
              0);
    expect_kept("b.graph.json");
    // The reversed order is another constraint, which is neither refused nor replaces the first.
    const auto other = run_command("relation add " + pot + at("c.graph.json") + " --graph " + at("b.graph.json") +
                                   " --relation 'proportion: 5, 6'" + state);
    ASSERT_EQ(other.code, 0) << other.err;
    expect_kept("c.graph.json", 2);
    EXPECT_EQ(run_command("relation add " + pot + at("d.graph.json") + " --graph " + at("c.graph.json") +
                          " --relation 'proportion: 6, 5'" + state)
                  .code,
              1);
    // Next to extracted ones, after another was removed, in a template, and in a check.
    ASSERT_EQ(run_command("relation extract " + pot + at("e.graph.json") + " --graph " + at("c.graph.json")).code, 0);
    expect_kept("e.graph.json", 2);
    const Json extracted = read_json(scratch / "e.graph.json");
    std::string first;
    for (const auto& relationship : extracted["relationships"].GetArray())
        if (!relationship["isConstraint"].GetBool()) first = std::to_string(relationship["id"].GetInt());
    ASSERT_EQ(run_command("relation remove " + pot + at("e.graph.json") + " " + at("f.graph.json") + " --id " + first).code, 0);
    expect_kept("f.graph.json", 2);
    ASSERT_EQ(run_command("template pack " + at("t.template.json") + " --mesh " + data + "teapot.ply --annotations " + data +
                          "teapot.ant.json --graph " + at("f.graph.json") + " --copy")
                  .code,
              0);
    expect_kept("f.graph.json", 2);
    const auto checked = run_command("relation check --json " + pot + at("f.graph.json"));
    const Json report = report_of(checked.out);
    std::vector<std::vector<int>> orders;
    for (const auto& relationship : report["result"]["relationships"].GetArray()) {
        if (!relationship["isConstraint"].GetBool()) continue;
        orders.emplace_back();
        for (const auto& id : relationship["annotations"].GetArray()) orders.back().push_back(id.GetInt());
    }
    EXPECT_EQ(orders, (std::vector<std::vector<int>>{wanted, turned}));
}

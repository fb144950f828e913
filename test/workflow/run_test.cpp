// Runs of studies: completed work is not repeated after any interruption and for any number of threads.
#include "ostraka/core/text.h"
#include "ostraka/workflow/crate.h"
#include "studies.h"
#include "workflow/file_pattern.h"

#include <atomic>
#include <map>
#include <thread>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// Every file of a run with its bytes, without dates and times.
std::map<std::string, std::string> files_of(const Path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string name = entry.path().lexically_relative(folder).generic_string();
        if (!entry.is_regular_file() || name.ends_with("record.json") || name.ends_with("ro-crate-metadata.json") ||
            name[0] == '.')
            continue;
        if (name.ends_with("report.json")) {
            Json report = read_json(entry.path());
            report.RemoveMember("run");
            files[name] = to_text(report);
        } else {
            files[name] = read_file(entry.path());
        }
    }
    return files;
}

}  // namespace

TEST(StudyText, SplitsReferences) {
    const StudyText text = study_text("pot-${vertices}-${case.name}.ply", "");
    ASSERT_EQ(text.parts.size(), 5U);
    EXPECT_EQ(text.references()[1].name, "case");
    EXPECT_EQ(text.references()[1].member, "name");
    EXPECT_EQ(text.single(), nullptr);
    ASSERT_NE(study_text("${a.out.csv}", "").single(), nullptr);
    EXPECT_EQ(study_text("${a.out.csv}", "").single()->member, "out.csv");
    EXPECT_TRUE(study_text("", "").parts.empty());
    EXPECT_THROW(study_text("${}", ""), Error);
    EXPECT_THROW(study_text("${a.}", ""), Error);
}

TEST(MatchingFiles, FollowPatternsInEachPart) {
    const Scratch scratch;
    for (const char* folder : {"a", "b", "c"}) std::filesystem::create_directory(scratch / folder);
    for (const char* file : {"a/one.ply", "a/two.ply", "b/one.ply", "b/one.obj", "c/.one.ply"}) write_file(scratch / file, "");
    EXPECT_EQ(matching_files(scratch / "*/one.ply").size(), 2U);
    EXPECT_EQ(matching_files(scratch / "?/*.ply").size(), 3U);
    EXPECT_EQ(matching_files(scratch / "a/t*o.ply").size(), 1U);
    EXPECT_EQ(matching_files(scratch / "a/one.ply").size(), 1U);
    EXPECT_TRUE(matching_files(scratch / "d/*").empty());
    // Cyclic links do not duplicate files.
    for (int i = 0; i < 12; ++i) std::filesystem::create_directory_symlink(".", scratch / ("link" + std::to_string(i)));
    EXPECT_EQ(matching_files(scratch / "*/*/*/*/*/*/*.ply").size(), 3U);
    EXPECT_TRUE(matching_files(scratch / "*/*.ply", [](const Path&) { return false; }).empty());
}

TEST(StudyPlan, HasAnInstanceForEachValueThatAStepVariesWith) {
    const Scratch scratch;
    furnish_teapot(scratch);
    const StudyPlan plan = plan_of(scratch.file("t.study.json", study_text_of(teapot_study)));
    EXPECT_EQ(plan.instances.size(), 1U + 1 + 2 + 2 + 2);
    EXPECT_EQ(plan.instances_of(plan.study.step("look")).size(), 2U);
    EXPECT_EQ(plan.instances[plan.instances_of(plan.study.step("transfer"))[1]].label, "vertices=4000");
    const StudyPlan quick = plan_of(scratch / "t.study.json", {.quick = true});
    EXPECT_EQ(quick.instances.size(), 5U);
    const StudyPlan set = plan_of(scratch / "t.study.json", {.set = {"vertices=2000,2500,3000"}});
    EXPECT_EQ(set.instances.size(), 11U);
}

TEST(StudyPlan, GathersAllInstances) {
    const Scratch scratch;
    const StudyPlan plan = plan_of(scratch.file("g.study.json", study_text_of(R"(
        "parameters": {"seed": {"from": 1, "to": 3}, "size": [2000, 2500]},
        "steps": {"one": {"operation": "mesh make", "with": {"object": "vase", "vertices": "${size}", "seed": "${seed}"}},
                  "picture": {"operation": "render", "with": {"meshes": {"all": "one.output"}, "size": "${size}x400"}, "keep": ["picture"]}})")));
    const auto pictures = plan.instances_of(plan.study.step("picture"));
    ASSERT_EQ(pictures.size(), 2U);
    EXPECT_EQ(plan.instances[pictures[0]].inputs.size(), 3U);
}

TEST(RunStudy, RunsOnlyChangedStepsAgain) {
    const Scratch scratch;
    furnish_teapot(scratch);
    const Path file = scratch.file("t.study.json", study_text_of(teapot_study)), out = scratch / "out";
    const StudyPlan plan = plan_of(file);
    EXPECT_EQ(count(run_all(plan, out), InstanceState::done), 8U);
    EXPECT_EQ(count(run_all(plan, out), InstanceState::unchanged), 8U);
    EXPECT_TRUE(file_exists(out / "steps/transfer/vertices=4000/pot-4000.ant.json"));
    EXPECT_FALSE(file_exists(out / "steps/pot/pot.ply")) << "outputs that are not requested are not written";

    // One option: only dependent steps run, and those whose outputs they need in memory.
    const auto changed = run_all(plan_of(file, {.set = {"spikes=avoid"}}), out);
    for (const std::size_t i : plan.instances_of(plan.study.step("annotated")))
        EXPECT_EQ(changed[i].state, InstanceState::unchanged);
    for (const std::size_t i : plan.instances_of(plan.study.step("transfer"))) {
        EXPECT_EQ(changed[i].state, InstanceState::done);
        EXPECT_NE(changed[i].why.find("option spikes was prune, is avoid"), std::string::npos) << changed[i].why;
    }

    // Changed and missing files are made again.
    write_file(out / "steps/annotated/annotated.ant.json", "{}");
    std::filesystem::remove(out / "steps/transfer/vertices=4000/pot-4000.ant.json");
    const auto repaired = run_all(plan_of(file, {.set = {"spikes=avoid"}}), out);
    EXPECT_NE(repaired[plan.instances_of(plan.study.step("annotated"))[0]].why.find("was changed"), std::string::npos);
    EXPECT_EQ(repaired[plan.instances_of(plan.study.step("transfer"))[0]].state, InstanceState::unchanged);
    EXPECT_EQ(repaired[plan.instances_of(plan.study.step("transfer"))[1]].state, InstanceState::done);

    // An input file.
    std::string recipe = read_file(scratch / "teapot.recipe.json");
    recipe.replace(recipe.find("flower"), 6, "blosom");
    write_file(scratch / "teapot.recipe.json", recipe);
    const auto other = run_all(plan_of(file, {.set = {"spikes=avoid"}}), out, {.dry_run = true});
    EXPECT_EQ(count(other, InstanceState::would_run), 1U + 2 + 2);
}

TEST(RunStudy, GivesTheSameBytesForAnyNumberOfThreadsAndShards) {
    const Scratch scratch;
    furnish_teapot(scratch);
    const Path file = scratch.file("t.study.json", study_text_of(teapot_study));
    const StudyPlan plan = plan_of(file);
    const int original_threads = threads();
    for (const int n : {1, 4}) {
        set_threads(n);
        run_all(plan, scratch / ("threads-" + std::to_string(n)));
    }
    set_threads(original_threads);
    for (const std::size_t shards : {2, 7}) {
        const Path out = scratch / ("shards-" + std::to_string(shards));
        for (std::size_t k = shards; k-- > 0;) run_all(plan, out, {.share = {k, shards}});
        const auto gathered = run_all(plan, out);
        EXPECT_EQ(count(gathered, InstanceState::unchanged), plan.instances.size());
    }
    const auto expected = files_of(scratch / "threads-1");
    EXPECT_GT(expected.size(), 10U);
    for (const char* other : {"threads-4", "shards-2", "shards-7"}) EXPECT_EQ(files_of(scratch / other), expected) << other;
}

TEST(RunStudy, FailureSkipsOnlyDependentSteps) {
    const Scratch scratch;
    furnish_teapot(scratch);
    write_file(scratch / "broken.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
    const Path file = scratch.file("f.study.json", study_text_of(R"("steps": {
        "bad": {"operation": "mesh simplify", "with": {"input": "broken.ply", "vertices": 10}},
        "after": {"operation": "mesh info", "with": {"input": "${bad.output}"}},
        "good": {"operation": "mesh make", "with": {"object": "vase", "vertices": 2000}, "keep": ["output"]}})"));
    const auto result = run_command("run " + file.string() + " --json --output " + (scratch / "out").string());
    EXPECT_EQ(result.code, 3) << result.err;
    const Json report = parse_json(result.out, "report");
    EXPECT_EQ(report["result"]["failed"].GetInt(), 1);
    EXPECT_EQ(report["result"]["skipped"].GetInt(), 1);
    EXPECT_EQ(report["result"]["done"].GetInt(), 1);
    EXPECT_NE(std::string(report["result"]["failures"][0]["problem"].GetString()).find("broken.ply"), std::string::npos);
    EXPECT_TRUE(file_exists(scratch / "out/steps/good/good.ply"));
    EXPECT_NE(read_file(scratch / "out/page.md").find("What failed"), std::string::npos);
}

TEST(RunStudy, KillLosesOnlyTheRunningStep) {
    const Scratch scratch;
    const Path file = scratch.file("k.study.json", study_text_of(R"("parameters": {"n": {"from": 1, "to": 12}},
        "steps": {"one": {"operation": "mesh make", "with": {"object": "teapot", "vertices": 8000, "seed": "${n}", "noise": 0.001}, "keep": ["output"]}})"));
    for (const char* signal : {"KILL", "INT"}) {
        const Path out = scratch / signal;
        run_command("run " + file.string() + " --threads 1 --quiet --output " + out.string(),
                    std::string("timeout --foreground -s ") + signal + " 1.5");
        std::size_t record_count = 0;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(out))
            record_count += entry.path().filename() == "record.json" ? 1 : 0;
        const auto resumed = run_command("run " + file.string() + " --json --output " + out.string());
        ASSERT_EQ(resumed.code, 0) << resumed.err;
        const Json report = parse_json(resumed.out, "report");
        EXPECT_EQ(report["result"]["unchanged"].GetUint64(), record_count) << signal;
        EXPECT_EQ(report["result"]["done"].GetUint64(), 12 - record_count) << signal;
    }
    EXPECT_EQ(files_of(scratch / "KILL"), files_of(scratch / "INT"));
}

namespace {

/// Two pots and a transfer between them, none of them kept, and a step that uses the result.
const char* const resumed_study = R"("steps": {
    "pot": {"operation": "mesh make", "with": {"object": "teapot", "vertices": 3000}},
    "annotated": {"operation": "annotation apply", "with": {"mesh": "${pot.output}", "recipe": "teapot.recipe.json"}},
    "fine": {"operation": "mesh make", "with": {"object": "teapot", "vertices": 4000}},
    "transfer": {"operation": "annotation transfer",
      "with": {"source": "${pot.output}", "annotations": "${annotated.output}", "target": "${fine.output}"}},
    "look": {"operation": "annotation list", "with": {"mesh": "${fine.output}", "annotations": "${transfer.output}"}},
    "later": {"operation": "annotation edit", "keep": ["output"],
      "with": {"mesh": "${fine.output}", "annotations": "${transfer.output}", "edits": "edit.json"}},
    "last": {"operation": "annotation list", "with": {"mesh": "${fine.output}", "annotations": "${later.output}"}}})";

const char* const right_edit =
    R"({"format": "ostraka-annotation-edits", "version": 1, "edits": [{"annotation": "lid", "tag": "cover"}]})";

}  // namespace

TEST(RunStudy, RunsUnkeptStepsAgainForFailedDependents) {
    const Scratch scratch;
    furnish_teapot(scratch);
    const Path file = scratch.file("r.study.json", study_text_of(resumed_study));
    write_file(scratch / "edit.json", "{");
    const auto run = [&] {
        return run_command("run " + file.string() + " --json --output " + (scratch / "out").string(), "timeout 120");
    };
    for (int attempt = 0; attempt < 3; ++attempt) {
        const auto failing = run();
        ASSERT_EQ(failing.code, 3) << failing.err;
        const Json report = parse_json(failing.out, "report");
        EXPECT_EQ(report["result"]["failed"].GetInt(), 1) << failing.out;
        EXPECT_EQ(report["result"]["skipped"].GetInt(), 1) << failing.out;
        EXPECT_FALSE(file_exists(scratch / "out/steps/later/later.ant.json"));
    }
    write_file(scratch / "edit.json", right_edit);
    const auto repaired = run();
    ASSERT_EQ(repaired.code, 0) << repaired.err << repaired.out;
    EXPECT_NE(read_file(scratch / "out/steps/later/later.ant.json").find("\"cover\""), std::string::npos);
    const Json report = parse_json(run().out, "report");
    EXPECT_EQ(report["result"]["unchanged"].GetInt(), 7);
    EXPECT_EQ(report["result"]["done"].GetInt(), 0);
}

TEST(RunStudy, GivesTheSameFilesAfterRepeatedKills) {
    const Scratch scratch;
    furnish_teapot(scratch);
    const Path file = scratch.file("r.study.json", study_text_of(resumed_study));
    write_file(scratch / "edit.json", right_edit);
    ASSERT_EQ(run_command("run " + file.string() + " --quiet --output " + (scratch / "whole").string()).code, 0);
    int code = -1, laps = 0;
    for (double seconds = 0.05; code != 0 && laps < 60; seconds *= 1.1, ++laps)
        code = run_command("run " + file.string() + " --quiet --output " + (scratch / "killed").string(),
                           "timeout --foreground -s KILL " + std::to_string(seconds))
                   .code;
    ASSERT_EQ(code, 0);
    EXPECT_GT(laps, 1);
    EXPECT_EQ(files_of(scratch / "killed"), files_of(scratch / "whole"));
}

TEST(RunStudy, WritesTablesPlotsPageAndReplayableCrate) {
    const Scratch scratch;
    const Path file =
        scratch.file("t.study.json", study_text_of(R"("title": "Vases", "parameters": {"n": [2000, 3000], "seed": [1, 2]},
        "steps": {"vase": {"operation": "mesh make", "with": {"object": "vase", "vertices": "${n}", "seed": "${seed}", "noise": 0.01}, "keep": ["output"]},
                  "info": {"operation": "mesh info", "with": {"input": "${vase.output}"}}},
        "tables": {"sizes": {"title": "Sizes", "rows": "info", "columns": [{"title": "asked", "value": "${n}"},
                     {"title": "vertices", "value": "result.vertices", "statistic": "mean"}, {"title": "runs", "value": "step", "statistic": "count"}],
                   "beside": [{"asked": 3000, "paper": 2999}]}},
        "plots": {"curve": {"table": "sizes", "x": "asked", "y": "vertices"}},
        "page": [{"title": "All", "text": "Both sizes.", "show": ["sizes", "curve", "vase.output"]}])"));
    const Path out = scratch / "out";
    const auto result = run_command("run " + file.string() + " --output " + out.string());
    ASSERT_EQ(result.code, 0) << result.err;
    const std::string table = read_file(out / "sizes.csv"), page = read_file(out / "page.md");
    EXPECT_NE(table.find("asked,vertices,runs,paper"), std::string::npos) << table;
    EXPECT_NE(table.find("2999"), std::string::npos) << table;
    EXPECT_NE(page.find("![curve](curve.svg)"), std::string::npos) << page;
    EXPECT_NE(page.find("vase.ply"), std::string::npos) << page;

    const auto replay = run_command("replay " + out.string());
    EXPECT_EQ(replay.code, 0) << replay.out << replay.err;
    std::string record = read_file(out / "steps/vase/n=2000,seed=1/record.json");
    const std::size_t at = record.find("\"sha256\": \"") + 11;
    record[at] = record[at] == '0' ? '1' : '0';
    write_file(out / "steps/vase/n=2000,seed=1/record.json", record);
    const auto differs = run_command("replay " + out.string());
    EXPECT_EQ(differs.code, 3) << differs.out;
    EXPECT_NE(differs.out.find("other bytes"), std::string::npos) << differs.out;

    if (const char* const module = std::getenv("OSTRAKA_RO_CRATE"); module != nullptr && std::filesystem::exists(module)) {
        const auto checked = std::system(
            ("node " + std::string(OSTRAKA_SOURCE_DIR) + "/test/workflow/check_crate.js " + module + " " + out.string()).c_str());
        EXPECT_EQ(checked, 0);
    } else {
        GTEST_SKIP() << "the crate was not validated: set OSTRAKA_RO_CRATE to the folder of the npm package ro-crate "
                        "(scripts/test --browser does)";
    }
}

TEST(RunStudy, ReadsAFileOnceForAllSteps) {
    const Scratch scratch;
    run_command("mesh make vase " + (scratch / "v.ply").string() + " --vertices 3000 --quiet");
    const Path file = scratch.file("c.study.json", study_text_of(R"("steps": {
        "clay": {"operation": "measure clay", "with": {"mesh": "v.ply"}},
        "map": {"operation": "measure map", "with": {"mesh": "v.ply", "of": "mean-curvature"}},
        "small": {"operation": "mesh simplify", "with": {"input": "v.ply", "vertices": 1000}},
        "smaller": {"operation": "mesh simplify", "with": {"input": "${small.output}", "vertices": 500}},
        "picture": {"operation": "render", "with": {"meshes": ["v.ply", "${smaller.output}"]}, "keep": ["picture"]}})"));
    const auto result =
        run_command("run " + file.string() + " --quiet --threads 2 --output " + (scratch / "out").string(),
                    "strace -f -e trace=read -P " + (scratch / "v.ply").string() + " -o " + (scratch / "trace").string());
    if (result.code == 127) GTEST_SKIP() << "strace is not installed: the number of reads was not counted";
    ASSERT_EQ(result.code, 0) << result.err << result.out;
    const std::string trace = read_file(scratch / "trace");
    std::size_t bytes = 0;
    for (std::size_t at = 0; at < trace.size();) {
        const std::string line(line_at(trace, at));
        const std::size_t equals = line.rfind("= ");
        if (line.find("read") != std::string::npos && equals != std::string::npos)
            bytes += std::strtoul(line.c_str() + equals + 2, nullptr, 10);
    }
    EXPECT_EQ(bytes, std::filesystem::file_size(scratch / "v.ply"));
}

TEST(RunStudy, RunsProgramsAsSteps) {
    const Scratch scratch;
    const std::string name = Path(OSTRAKA_COMMAND).filename().string();
    const Path file = scratch.file("p.study.json", study_text_of(R"("steps": {
        "pot": {"program": [")" + name + R"(", "mesh", "make", "vase", "${folder}/v.ply", "--vertices", 2000]},
        "info": {"operation": "mesh info", "with": {"input": "${pot.v.ply}"}},
        "again": {"program": [")" + name + R"(", "mesh", "convert", "${pot.v.ply}", "${folder}/v.obj"]}})"));
    const std::string words = "run " + file.string() + " --json --output " + (scratch / "out").string();
    EXPECT_EQ(run_command(words).code, 1) << "not a program of the toolkit";
    EXPECT_FALSE(is_folder(scratch / "out"));
    const auto dry_run = run_command(words + " --dry-run");
    EXPECT_EQ(dry_run.code, 3) << dry_run.out << dry_run.err;
    EXPECT_NE(dry_run.out.find("'mesh' 'make' 'vase'"), std::string::npos) << dry_run.out;
    const auto first = run_command(words + " --allow-programs");
    ASSERT_EQ(first.code, 0) << first.err << first.out;
    EXPECT_NE(first.err.find("'mesh' 'make' 'vase'"), std::string::npos) << first.err;
    EXPECT_TRUE(file_exists(scratch / "out/steps/again/v.obj"));
    const auto second = run_command(words + " --allow-programs");
    EXPECT_EQ(parse_json(second.out, "report")["result"]["unchanged"].GetInt(), 3) << second.out;
}

TEST(RunStudy, ReadsFoldersThatTheCallerNames) {
    const Scratch scratch;
    std::filesystem::create_directory(scratch / "study");
    std::filesystem::create_directory(scratch / "scans");
    ASSERT_EQ(run_command("mesh make vase " + (scratch / "scans/v.ply").string() + " --vertices 2000").code, 0);
    write_file(scratch / "study/s.study.json", study_text_of(R"("parameters": {"where": "../scans"},
        "steps": {"info": {"operation": "mesh info", "with": {"input": "${where}/v.ply"}}})"));
    const std::string words = "run " + (scratch / "study/s.study.json").string() + " --output " + (scratch / "out").string();
    const auto refused = run_command(words);
    EXPECT_EQ(refused.code, 1);
    EXPECT_NE(refused.err.find("--reads"), std::string::npos) << refused.err;
    EXPECT_EQ(run_command(words + " --reads " + (scratch / "scans").string()).code, 0);
    EXPECT_EQ(run_command(words + " --again --set where=" + (scratch / "scans").string()).code, 0)
        << "a path given by the caller";
    // Locations of inputs in the run folder itself are not trusted.
    EXPECT_EQ(run_command("replay " + (scratch / "out").string()).code, 1);
    EXPECT_EQ(run_command("replay " + (scratch / "out").string() + " --inputs " + (scratch / "study").string() + " --reads " +
                          (scratch / "scans").string())
                  .code,
              0);
    // A link in the study's folder points outside.
    std::filesystem::create_directory_symlink(scratch / "scans", scratch / "study/linked");
    EXPECT_EQ(run_command(words + " --set where=linked").code, 0) << "a path given by the caller";
    write_file(scratch / "study/l.study.json",
               study_text_of(R"("steps": {"info": {"operation": "mesh info", "with": {"input": "linked/v.ply"}}})"));
    EXPECT_EQ(run_command("run " + (scratch / "study/l.study.json").string() + " --output " + (scratch / "l").string()).code, 1);
}

TEST(RunStudy, NeverLeavesTheRunFolder) {
    const Scratch scratch, outside;
    furnish_teapot(scratch);
    const StudyPlan plan = plan_of(scratch.file("t.study.json", study_text_of(teapot_study)), {.quick = true});
    const Path out = scratch / "out", step = out / "steps/annotated";
    const auto make = [&] {
        std::filesystem::remove_all(out);
        EXPECT_EQ(count(run_all(plan, out), InstanceState::done), plan.instances.size());
        write_file(outside / "kept.txt", "kept");
    };
    const auto refused = [&](const std::string& attempt) {
        EXPECT_THROW(run_all(plan, out), Error) << attempt;
        EXPECT_EQ(read_file(outside / "kept.txt"), "kept") << attempt;
        EXPECT_EQ(files_in(outside.path()).size(), 1U) << attempt;
    };
    const auto named = [&](const std::string& name) {
        std::string record = read_file(step / "record.json");
        const std::size_t at = record.find("\"file\": \"") + 9;
        record.replace(at, record.find('"', at) - at, name);
        write_file(step / "record.json", record);
    };
    make();
    named((outside / "kept.txt").string());
    refused("an output by its absolute name");
    make();
    named("../../../../" + outside.path().filename().string() + "/kept.txt");
    refused("an output that climbs");
    for (const char* file : {"report.json", "record.json", "annotated.ant.json"}) {
        make();
        std::filesystem::remove(step / file);
        std::filesystem::create_symlink(outside / "kept.txt", step / file);
        refused(std::string(file) + " as a link");
    }
    make();
    std::filesystem::remove_all(step);
    std::filesystem::create_directory_symlink(outside.path(), step);
    refused("the folder of a step as a link");
    // Files that an operation writes next to the kept one.
    const StudyPlan weights = plan_of(scratch.file("w.study.json", study_text_of(R"("steps": {
        "ball": {"operation": "mesh make", "with": {"object": "sphere", "vertices": 300}},
        "cage": {"operation": "cage make", "with": {"mesh": "${ball.output}", "vertices": 30}},
        "w": {"operation": "cage weights", "with": {"mesh": "${ball.output}", "cage": "${cage.output}"}, "keep": {"output": "w.npy"}}})")));
    const Path other = scratch / "other";
    make_folder(other / "steps/w");
    std::filesystem::create_symlink(outside / "kept.txt", other / "steps/w/w.coordinates.json");
    const auto results = run_all(weights, other);
    EXPECT_EQ(results.back().state, InstanceState::failed);
    EXPECT_NE(results.back().problem.find("leads out"), std::string::npos) << results.back().problem;
    EXPECT_EQ(read_file(outside / "kept.txt"), "kept");
    make();
    std::filesystem::create_symlink(outside / "kept.txt", out / "page.md");
    const auto page = run_command("run " + (scratch / "t.study.json").string() + " --quick --output " + out.string());
    EXPECT_EQ(page.code, 1) << page.out;
    EXPECT_NE(page.err.find("page.md"), std::string::npos) << page.err;
    EXPECT_EQ(read_file(outside / "kept.txt"), "kept");
}

TEST(RunStudy, FailsStepsWhoseInputsChangeDuringTheRun) {
    const Scratch scratch;
    ASSERT_EQ(run_command("mesh make vase " + (scratch / "v.ply").string() + " --vertices 2000").code, 0);
    ASSERT_EQ(run_command("mesh make vase " + (scratch / "w.ply").string() + " --vertices 2500").code, 0);
    const StudyPlan plan =
        plan_of(scratch.file("c.study.json", study_text_of(R"("parameters": {"n": {"from": 300, "to": 1900, "step": 40}},
        "steps": {"coarse": {"operation": "mesh simplify", "with": {"input": "v.ply", "vertices": "${n}"}},
                  "look": {"operation": "mesh info", "with": {"input": "${coarse.output}"}}})")));
    Watch watch;
    std::atomic<bool> has_changed{false};
    watch.on_progress = [&](const std::string& phase, double) {
        if (phase.find(": 0 of") == std::string::npos && !has_changed.exchange(true))
            std::filesystem::rename(scratch / "w.ply", scratch / "v.ply");
    };
    std::vector<InstanceResult> results;
    {
        const WatchScope scope(&watch);
        results = run_all(plan, scratch / "out");
    }
    ASSERT_TRUE(has_changed) << "the run ended before the input was changed";
    EXPECT_EQ(count(results, InstanceState::done), 0U) << "it is unknown which of them read the new file";
    EXPECT_EQ(count(results, InstanceState::failed) + count(results, InstanceState::skipped), plan.instances.size());
    const auto second_results = run_all(plan, scratch / "out");
    EXPECT_EQ(count(second_results, InstanceState::done) + count(second_results, InstanceState::unchanged),
              plan.instances.size());
    // Files with only a new time stamp are unchanged.
    std::filesystem::last_write_time(scratch / "v.ply", std::filesystem::file_time_type::clock::now());
    EXPECT_EQ(count(run_all(plan, scratch / "out"), InstanceState::unchanged), plan.instances.size());
}

TEST(RunStudy, MovedRunIsUnchanged) {
    const Scratch scratch;
    std::filesystem::create_directory(scratch / "a");
    write_file(scratch / "a/teapot.recipe.json", read_file(Path(OSTRAKA_SOURCE_DIR) / "data" / "teapot.recipe.json"));
    write_file(scratch / "a/t.study.json", study_text_of(R"(
        "steps": {"pot": {"operation": "mesh make", "with": {"object": "teapot", "vertices": 3000}, "keep": {"output": "pot.ply"}},
          "annotated": {"operation": "annotation apply", "with": {"mesh": "${pot.output}", "recipe": "teapot.recipe.json"}, "keep": {"output": "pot.ant.json"}},
          "cage": {"operation": "cage make", "with": {"mesh": "${pot.output}", "vertices": 60}, "keep": ["output"]},
          "weights": {"operation": "cage weights", "with": {"mesh": "${pot.output}", "cage": "${cage.output}"}, "keep": ["output"]},
          "look": {"operation": "cage influence", "with": {"mesh": "${pot.output}", "cage": "${cage.output}", "weights": "${weights.output}", "annotations": "${annotated.output}", "annotation": "lid"}, "keep": ["output"]}})"));
    const auto plan_in = [&](const char* folder) { return plan_of(scratch / folder / "t.study.json"); };
    const StudyPlan first = plan_in("a");
    for (const char* only :
         {"pot", "annotated", "cage", "weights", "look"})  // each in its own process: inputs come from the disk
        static_cast<void>(run_all(first, scratch / "a/run", {.only = {only}}));
    std::filesystem::rename(scratch / "a", scratch / "b");
    const StudyPlan moved = plan_in("b");
    const auto results = run_all(moved, scratch / "b/run");
    EXPECT_EQ(count(results, InstanceState::unchanged), moved.instances.size());
    for (const InstanceResult& result : results) EXPECT_EQ(result.why, "");
}

TEST(RunStudy, SeveralProcessesRunIntoOneFolder) {
    const Scratch scratch;
    furnish_teapot(scratch);
    const Path file = scratch.file("t.study.json", study_text_of(teapot_study));
    const std::string words = "run " + file.string() + " --output " + (scratch / "out").string();
    std::vector<CommandResult> results(3);
    std::vector<std::thread> threads;
    for (CommandResult& result : results) threads.emplace_back([&] { result = run_command(words); });
    for (std::thread& thread : threads) thread.join();
    for (const CommandResult& result : results) EXPECT_EQ(result.code, 0) << result.err << result.out;
    ASSERT_EQ(run_command("run " + file.string() + " --output " + (scratch / "alone").string()).code, 0);
    auto together = files_of(scratch / "out"), alone = files_of(scratch / "alone");
    for (auto* files : {&together, &alone})
        std::erase_if(*files, [](const auto& name_and_content) { return name_and_content.first == "run.json"; });
    EXPECT_EQ(together, alone);
}

TEST(StudyPlan, FilesOfAPatternAreRelativeToTheStudy) {
    const Scratch scratch;
    std::filesystem::create_directories(scratch / "f/scans");
    for (const char* name : {"f/scans/a.ply", "f/scans/b.ply"})
        ASSERT_EQ(run_command("mesh make sphere " + (scratch / name).string() + " --vertices 400").code, 0);
    write_file(scratch / "f/s.study.json", study_text_of(R"("parameters": {"scan": {"files": "scans/*.ply"}},
        "steps": {"info": {"operation": "mesh info", "with": {"input": "${scan}"}}})"));
    const auto run = [&](const std::string& working_folder, const std::string& file) {
        return run_command("run " + file + " --dry-run --json", "cd " + (scratch / working_folder).string() + ";");
    };
    for (const auto& [folder, file] : {std::pair("f", "s.study.json"), std::pair(".", "f/s.study.json")}) {
        const auto result = run(folder, file);
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_EQ(parse_json(result.out, "report")["result"]["instances"].GetInt(), 2);
    }
    EXPECT_EQ(plan_of(scratch / "f/s.study.json").instances[0].inputs[0].file, scratch / "f/scans/a.ply");
}

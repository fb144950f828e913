// Wrong study files: each is refused with the file, the place in it and a remedy, before anything runs.
#include "studies.h"

using namespace ostraka;
using namespace ostraka::test;

namespace {

struct Wrong {
    const char* description;
    const char* text;     ///< members of the study; a text that begins with '!' is the whole file
    const char* place;    ///< that the message names
    const char* message;  ///< of the problem or the remedy
};

/// A valid step, for studies that are invalid elsewhere.
#define GOOD R"("a": {"operation": "mesh make", "with": {"object": "vase", "vertices": 2000}})"

const Wrong wrong_studies[]{
    {"no JSON", "!{\"format\": \"ostraka-study\",", "wrong.study.json, line 1", ""},
    {"another format", "!{\"format\": \"ostraka-edit\", \"version\": 1, \"steps\": []}", "wrong.study.json", "study file"},
    {"a version to come", "!{\"format\": \"ostraka-study\", \"version\": 2, \"steps\": {}}", "/version", "schema"},
    {"no steps", R"("title": "x")", "the root", "steps"},
    {"a list of objects", R"("objects": [{"mesh": "a.ply"}])", "wrong.study.json", "ostraka study"},
    {"empty steps", R"("steps": {})", "/steps", "at least 1 member"},
    {"an unknown member", R"("stepps": {}, "steps": {)" GOOD "}", "/stepps", "misspelt"},
    {"an unknown member of a step", R"("steps": {"a": {"operation": "mesh make", "wiht": {}}})", "/steps/a/wiht", "misspelt"},
    {"two steps of one name", R"("steps": {)" GOOD ", " GOOD "}", "\"a\"", "twice"},
    {"a step that runs a study", R"("steps": {"a": {"operation": "run", "with": {"study": "wrong.study.json"}}})",
     "/steps/a/operation", "runs other operations"},
    {"a step that starts a backend", R"("steps": {"a": {"operation": "conformance run", "with": {"command": ["sh"]}}})",
     "/steps/a/operation", "runs other operations"},
    {"another program", R"("steps": {"a": {"program": ["sh", "-c", "true"]}})", "/steps/a/program/0", "--allow-programs"},
    {"another program by a parameter", R"("parameters": {"p": "sh"}, "steps": {"a": {"program": ["${p}"]}})",
     "/steps/a/program/0", "--allow-programs"},
    {"a word that is an absolute name", R"("steps": {"a": {"program": ["ostraka_experiments", "moulds", "/elsewhere/x"]}})",
     "/steps/a/program/2", "may lead out"},
    {"a word that climbs", R"("steps": {"a": {"program": ["ostraka_experiments", "moulds", "${folder}/../../x"]}})",
     "/steps/a/program/2", "may lead out"},
    {"a word that goes on behind the folder's name",
     R"("steps": {"a": {"program": ["ostraka_experiments", "--csv=${folder}b/c.csv"]}})", "/steps/a/program/1", "may lead out"},
    {"an absolute name behind a sign", R"("steps": {"a": {"program": ["ostraka_experiments", "--same", "a=/home/x.ply"]}})",
     "/steps/a/program/2", "may lead out"},
    {"a name with a zero byte",
     R"("steps": {"a": {"operation": "mesh make", "with": {"object": "vase"}, "keep": {"output": "record.json\u0000.ply"}}})",
     "/steps/a/keep/output", "is not a file name"},
    {"parameters with too many values together",
     R"("parameters": {"a": {"from": 1, "to": 90000}, "b": {"from": 1, "to": 90000}, "c": {"from": 1, "to": 90000}}, "steps": {)" GOOD
     "}",
     "/parameters", "give fewer"},
    {"a word that climbs behind '='", R"("steps": {"a": {"program": ["ostraka_experiments", "--output=../x"]}})",
     "/steps/a/program/1", "may lead out"},
    {"a word that leaves the study", R"("steps": {"a": {"program": ["ostraka_experiments", "moulds", "${study}/../x"]}})",
     "/steps/a/program/2", "--reads"},
    {"an input elsewhere", R"("steps": {"a": {"operation": "mesh info", "with": {"input": "../other.ply"}}})",
     "/steps/a/with/input", "--reads"},
    {"an input by its absolute name", R"("steps": {"a": {"operation": "mesh info", "with": {"input": "/other.ply"}}})",
     "/steps/a/with/input", "--reads"},
    {"files elsewhere",
     R"("parameters": {"f": {"files": "../*/*.ply"}}, "steps": {"a": {"operation": "mesh info", "with": {"input": "${f}"}}})",
     "/parameters/f/files", "--reads"},
    {"a range without end",
     R"("parameters": {"s": {"from": 9223372036854775806, "to": 9223372036854775807}}, "steps": {)" GOOD "}", "/parameters/s",
     "format"},
    {"too many values", R"("parameters": {"s": {"from": 1, "to": 1000000000}}, "steps": {)" GOOD "}", "/parameters/s",
     "give fewer"},
    {"a name with a blank", R"("steps": {"a b": {"operation": "mesh make", "with": {"object": "vase"}}})", "/steps/a b",
     "letters"},
    {"a step called like a parameter", R"("parameters": {"a": 1}, "steps": {)" GOOD "}", "/steps/a", "another name"},
    {"neither operation nor program", R"("steps": {"a": {"note": "x"}})", "/steps/a", "names no operation"},
    {"operation and program", R"("steps": {"a": {"operation": "mesh make", "program": ["x"]}})", "/steps/a",
     "names an operation and a program"},
    {"an unknown operation", R"("steps": {"a": {"operation": "mesh mkae"}})", "/steps/a/operation", "did you mean 'mesh make'"},
    {"an unknown option", R"("steps": {"a": {"operation": "mesh make", "with": {"object": "vase", "verticess": 5}}})",
     "/steps/a/with/verticess", "did you mean 'vertices'"},
    {"a value of another type", R"("steps": {"a": {"operation": "mesh make", "with": {"object": "vase", "vertices": "many"}}})",
     "/steps/a", "vertices"},
    {"a value out of range", R"("steps": {"a": {"operation": "mesh make", "with": {"object": "vase", "noise": -1}}})", "/steps/a",
     "noise"},
    {"an unknown choice", R"("steps": {"a": {"operation": "mesh make", "with": {"object": "spaceship"}}})", "/steps/a", "vase"},
    {"a missing input", R"("steps": {"a": {"operation": "mesh info"}})", "/steps/a", "input is missing"},
    {"a file that is not there", R"("steps": {"a": {"operation": "mesh info", "with": {"input": "no.ply"}}})",
     "/steps/a/with/input", "relative to the study file"},
    {"a file of another kind", R"("steps": {"a": {"operation": "mesh info", "with": {"input": "wrong.study.json"}}})",
     "/steps/a/with/input", ".ply"},
    {"a reference without end", R"("steps": {"a": {"operation": "mesh info", "with": {"input": "${b.output"}}})",
     "/steps/a/with/input", "${STEP.OUTPUT}"},
    {"an unknown step", R"("steps": {)" GOOD R"(, "b": {"operation": "mesh info", "with": {"input": "${aa.output}"}}})",
     "/steps/b/with/input", "did you mean 'a'"},
    {"a step without its output", R"("steps": {)" GOOD R"(, "b": {"operation": "mesh info", "with": {"input": "${a}"}}})",
     "/steps/b/with/input", "${a.output}"},
    {"an unknown output", R"("steps": {)" GOOD R"(, "b": {"operation": "mesh info", "with": {"input": "${a.outptu}"}}})",
     "/steps/b/with/input", "did you mean 'output'"},
    {"an output of another kind",
     R"("steps": {)" GOOD
     R"(, "b": {"operation": "annotation list", "with": {"mesh": "${a.output}", "annotations": "${a.output}"}}})",
     "/steps/b/with/annotations", "takes annotations"},
    {"an output for an option", R"("steps": {)" GOOD R"(, "b": {"operation": "mesh make", "with": {"object": "${a.output}"}}})",
     "/steps/b/with/object", "option"},
    {"a circle",
     R"("steps": {"a": {"operation": "mesh simplify", "with": {"input": "${b.output}", "vertices": 9}},
                  "b": {"operation": "mesh simplify", "with": {"input": "${a.output}", "vertices": 9}}})",
     "/steps/a", "remove one reference"},
    {"its own output", R"("steps": {"a": {"operation": "mesh simplify", "with": {"input": "${a.output}", "vertices": 9}}})",
     "/steps/a/with/input", "own output"},
    {"an unknown parameter",
     R"("parameters": {"size": 5}, "steps": {"a": {"operation": "mesh make", "with": {"object": "vase", "vertices": "${sise}"}}})",
     "/steps/a/with/vertices", "did you mean 'size'"},
    {"a member that a value has not",
     R"("parameters": {"case": [{"name": "x", "n": 2000}, {"name": "y"}]}, "steps": {"a": {"operation": "mesh make", "with": {"object": "vase", "vertices": "${case.n}"}}})",
     "/steps/a/with/vertices", "to each value"},
    {"a value twice", R"("parameters": {"n": [2000, 2000]}, "steps": {)" GOOD "}", "/parameters/n", "twice"},
    {"a range that ends first", R"("parameters": {"n": {"from": 3, "to": 1}}, "steps": {)" GOOD "}", "/parameters/n",
     "ends before"},
    {"a pattern that names nothing", R"("parameters": {"scan": {"files": "*.nothing"}}, "steps": {)" GOOD "}",
     "/parameters/scan/files", "relative"},
    {"quick values of no parameter", R"("parameters": {"n": 1}, "quick": {"m": 2}, "steps": {)" GOOD "}", "/quick/m", "n"},
    {"an output among the inputs", R"("steps": {"a": {"operation": "mesh make", "with": {"object": "vase", "output": "a.ply"}}})",
     "/steps/a/with/output", "keep"},
    {"an unknown output name", R"("steps": {"a": {"operation": "mesh make", "with": {"object": "vase"}, "keep": ["outptu"]}})",
     "/steps/a/keep/0", "did you mean 'output'"},
    {"a file outside the run folder",
     R"("steps": {"a": {"operation": "mesh make", "with": {"object": "vase"}, "keep": {"output": "../a.ply"}}})",
     "/steps/a/keep/output", "without folders"},
    {"two outputs of one name",
     R"("steps": {"a": {"operation": "mesh make", "with": {"object": "vase"}, "keep": {"output": "a.ply", "labels": "a.ply"}}})",
     "/steps/a/keep", "both be 'a.ply'"},
    {"a file that cannot hold it",
     R"("steps": {"a": {"operation": "mesh make", "with": {"object": "vase"}, "keep": {"output": "a.docx"}}})", "/steps/a",
     "a.docx"},
    {"two files where one goes",
     R"("steps": {)" GOOD R"(, "b": {"operation": "mesh info", "with": {"input": ["${a.output}", "${a.output}"]}}})",
     "/steps/b/with/input", "give one"},
    {"all where one goes",
     R"("parameters": {"n": [2000, 3000]}, "steps": {"a": {"operation": "mesh make", "with": {"object": "vase", "vertices": "${n}"}},
         "b": {"operation": "mesh info", "with": {"input": {"all": "a.output"}}}})",
     "/steps/b/with/input/all", "takes one mesh"},
    {"fragments that would lose their annotations",
     R"("steps": {)" GOOD R"(, "b": {"operation": "mesh break", "with": {"input": "${a.output}", "at": "0,0,50"}},
                  "c": {"operation": "template pack", "with": {"mesh": "${a.output}"}},
                  "d": {"operation": "fit", "with": {"template": "${c.output}", "fragments": "${b.output}"}}})",
     "/steps/d/with/fragments", "NAME.ant.json"},
    {"a pair that would lose its annotations",
     R"("steps": {)" GOOD R"(, "b": {"operation": "pair", "with": {"first": "${a.output}", "second": "${a.output}"}}})",
     "/steps/b/with/first", "NAME.ant.json"},
    {"a table of an unknown step",
     R"("steps": {)" GOOD R"(}, "tables": {"t": {"rows": "b", "columns": [{"title": "x", "value": "step"}]}})", "/tables/t/rows",
     "there is no step"},
    {"a column of nothing",
     R"("steps": {)" GOOD R"(}, "tables": {"t": {"rows": "a", "columns": [{"title": "x", "value": "vertices"}]}})",
     "/tables/t/columns/0/value", "result.KEY"},
    {"a value that is not reported",
     R"("steps": {)" GOOD R"(}, "tables": {"t": {"rows": "a", "columns": [{"title": "x", "value": "result.verticess"}]}})",
     "/tables/t/columns/0/value", "reports no value"},
    {"a plot of an unknown table", R"("steps": {)" GOOD R"(}, "plots": {"p": {"table": "t", "x": "a", "y": "b"}})",
     "/plots/p/table", "no table"},
    {"a plot of an unknown column",
     R"("steps": {)" GOOD
     R"(}, "tables": {"t": {"rows": "a", "columns": [{"title": "step", "value": "step"}]}}, "plots": {"p": {"table": "t", "x": "steps", "y": "step"}})",
     "/plots/p/x", "did you mean 'step'"},
    {"a page that shows nothing", R"("steps": {)" GOOD R"(}, "page": [{"show": ["t"]}])", "/page/0/show/0", "no table"},
};

}  // namespace

TEST(WrongStudies, AreRefusedWithLocationAndRemedyBeforeAnythingRuns) {
    EXPECT_GE(std::size(wrong_studies), 40U);
    for (const Wrong& wrong : wrong_studies) {
        SCOPED_TRACE(wrong.description);
        const Scratch scratch;
        const Path file =
            scratch.file("wrong.study.json", wrong.text[0] == '!' ? std::string(wrong.text + 1) : study_text_of(wrong.text));
        try {
            plan_of(file);
            ADD_FAILURE() << "was not refused";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
            const std::string text = error.what();
            EXPECT_NE(text.find(file.string()), std::string::npos) << text;
            EXPECT_NE(text.find(wrong.place), std::string::npos) << text;
            EXPECT_NE(text.find(wrong.message), std::string::npos) << text;
            EXPECT_FALSE(error.remedy().empty() && std::string(wrong.description) != "no JSON") << text;
        }
        EXPECT_EQ(count_files(scratch.path()), 1U);
    }
}

TEST(WrongStudies, AreRefusedByTheCommand) {
    const Scratch scratch;
    const auto refuse = [&](const std::string& words, int code, const std::string& message) {
        const auto result = run_command("run " + words + " --output " + (scratch / "out").string());
        EXPECT_EQ(result.code, code) << result.err;
        EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(scratch / "out")) << words;
    };
    const std::string good =
        scratch.file("good.study.json", study_text_of(R"("parameters": {"n": 2000}, "steps": {)" GOOD "}")).string();
    refuse((scratch / "none.study.json").string(), 1, "none.study.json");
    refuse(scratch.file("bad.study.json", study_text_of(R"("steps": {"a": {"operation": "mesh mkae"}})")).string(), 1,
           "did you mean 'mesh make'");
    refuse(good + " --only b", 2, "is not a step");
    refuse(good + " --set m=1", 2, "is not a parameter");
    refuse(good + " --set n", 2, "NAME=VALUE");
    refuse(good + " --shard 3/2", 2, "K from 1 to N");
    refuse(good + " --explain b", 2, "is not a step");
    refuse(scratch.file("program.study.json", study_text_of(R"("steps": {"a": {"program": ["rm", "-rf", "x"]}})")).string(), 1,
           "starts 'rm', which is not a program of the toolkit");
    refuse((scratch / "program.study.json").string() + " --allow-programs --programs " + scratch.path().string(), 1,
           "there is no program 'rm'");
    const auto replay = run_command("replay " + scratch.path().string());
    EXPECT_EQ(replay.code, 1);
    EXPECT_NE(replay.err.find("not the folder of a run"), std::string::npos) << replay.err;
}

// Files that name other files and programs as subjects: studies, run folders, sessions, messages, kits.
#include "subjects.h"

#include "ostraka/conformance/kit.h"
#include "ostraka/core/text.h"
#include "ostraka/files/json_build.h"
#include "ostraka/operations/table.h"
#include "ostraka/workbench/workbench.h"

#include <set>

namespace ostraka::fuzz {

namespace {

constexpr const char* rich_study =
    R"({"format": "ostraka-study", "version": 1, "title": "Rich", "note": "All that a study can say",
 "parameters": {"wanted": [60, 90], "seed": {"from": 1, "to": 2}, "scan": {"files": "*.ply"}, "case": [{"name": "a", "n": 60}]},
 "quick": {"wanted": [60]},
 "steps": {
  "made": {"operation": "mesh make", "note": "one", "keep": {"output": "made-${seed}.ply"},
           "with": {"object": "sphere", "vertices": 200, "seed": "${seed}"}},
  "coarse": {"operation": "mesh simplify", "keep": ["output"], "with": {"input": "${scan}", "vertices": "${wanted}"}},
  "other": {"operation": "mesh simplify", "slow": true, "with": {"input": "${made.output}", "vertices": "${case.n}"}},
  "measured": {"operation": "mesh info", "with": {"input": "${coarse.output}"}}},
 "tables": {"areas": {"title": "Areas", "note": "of all", "rows": "measured",
   "columns": [{"title": "vertices", "value": "${wanted}"},
               {"title": "area", "value": "result.size.area", "statistic": "mean", "digits": 4}],
   "beside": [{"vertices": 60, "known": 3.1}]}},
 "plots": {"area": {"title": "Area", "table": "areas", "x": "vertices", "y": "area", "logarithmic": ["x"]}},
 "page": [{"title": "All", "text": "Areas", "show": ["areas", "area"]}]})";

/// Steps that leave the folder or start programs.
const std::vector<Plant>& hostile_steps() {
    static const std::vector<Plant> plants{
        {"/steps", R"({"program": ["sh", "-c", "echo > @CANARIES@/made"]})"},
        {"/steps", R"({"program": ["../canaries/program"]})"},
        {"/steps", R"({"program": ["@CANARIES@/program", "${folder}"]})"},
        {"/steps", R"({"program": ["program"], "reads": ["../canaries/secret.txt"]})"},
        {"/steps", R"({"program": ["ostraka_experiments", "boxes", "@CANARIES@/made"]})"},
        {"/steps", R"({"program": ["ostraka_experiments", "boxes", "${folder}/../../../../canaries/made"]})"},
        {"/steps", R"({"operation": "conformance run", "with": {"command": ["sh", "-c", "echo > @CANARIES@/made"]}})"},
        {"/steps", R"({"operation": "run", "with": {"study": "sphere.study.json", "output": "@CANARIES@/folder"}})"},
        {"/steps", R"({"operation": "replay", "with": {"crate": "sphere-run"}})"},
        {"/steps", R"({"operation": "operations", "with": {"manuals": "@CANARIES@/made"}})"},
        {"/steps", R"({"operation": "mesh info", "with": {"input": "@CANARIES@/secret.ply"}})"},
        {"/steps", R"({"operation": "mesh info", "with": {"input": "../canaries/secret.ply"}})"},
        {"/steps", R"({"operation": "mesh info", "with": {"input": "link-out/secret.ply"}})"},
        {"/steps",
         R"({"operation": "mesh make", "with": {"object": "sphere"}, "keep": {"output": "../../../../canaries/made.ply"}})"},
        {"/steps", R"({"operation": "mesh make", "with": {"object": "sphere"}, "keep": {"output": "@CANARIES@/made.ply"}})"},
        {"/steps", R"({"operation": "mesh make", "with": {"object": "sphere", "output": "@CANARIES@/made.ply"}})"},
        {"/parameters", R"({"files": "@CANARIES@/*.ply"})"},
        {"/parameters", R"({"files": "../*/*.ply"})"},
        {"/parameters", R"({"from": 9223372036854775806, "to": 9223372036854775807})"},
        {"/parameters", R"({"from": -9223372036854775807, "to": 9223372036854775807})"},
        {"/tables", R"({"rows": "../../canaries/secret", "columns": "all"})"},
        {"/page",
         R"x({"title": "[a](javascript:alert(1))", "text": "<script>alert(1)</script>", "show": ["../canaries/secret"]})x"},
        // records
        {"/outputs", R"({"file": "@CANARIES@/folder", "sha256": "0", "kept": true, "folder": true})"},
        {"/outputs", R"({"file": "../../../../canaries/folder", "sha256": "0", "kept": true, "folder": true})"},
        {"/outputs", R"({"file": "../../../../../canaries/folder", "sha256": "0", "kept": true, "folder": true})"},
        {"/outputs", R"({"file": "@CANARIES@/secret.txt", "sha256": "0", "kept": true})"},
        {"/outputs", R"({"file": ".", "sha256": "0", "kept": true, "folder": true})"},
        {"/read", R"(["@CANARIES@/secret.txt", "0"])"},
        {"/depends", R"(["one alone"])"},
        {"/depends", "5"},
        // requests
        {"/set", R"("wanted=1000000000")"},
        {"/only", R"("../..")"},
    };
    return plants;
}

/// Steps, parts and files of a session that leave the folder.
const std::vector<Plant>& hostile_session() {
    static const std::vector<Plant> plants{
        {"/steps/0/state/objects/0/parts", R"("@CANARIES@/secret.txt")"},
        {"/steps/5/state/objects/0/parts", R"("../../canaries/secret.ply")"},
        {"/steps/5/state/objects/0/parts", R"("../link-out/secret.ply")"},
        {"/steps/5/state/objects/0/parts", R"("/dev/zero")"},
        {"/steps/5/state/files", R"({"name": "x", "kind": "table", "file": "@CANARIES@/secret.txt"})"},
        {"/steps/5/state/files", R"({"name": "x", "kind": "table", "file": "../../canaries/secret.txt"})"},
        {"/steps", R"({"name": "s900", "title": "x", "operation": "run", "with": {"study": "x.study.json"}, "keep": {},
                       "state": {"objects": [], "active": 0, "files": []}})"},
        {"/steps", R"({"name": "../../canaries/folder", "title": "x", "operation": "mesh info", "with": {}, "keep": {},
                       "state": {"objects": [], "active": 0, "files": []}})"},
        {"/steps", R"({"name": "s007", "title": "x", "state": {"objects": [{"name": "x",
                       "parts": {"mesh": "@CANARIES@/secret.ply"}}], "active": 0, "files": []}})"},
    };
    return plants;
}

const std::vector<Plant>& hostile_cases() {
    static const std::vector<Plant> plants{
        {"/cases", R"({"id": "x", "operation": "mesh convert", "about": "outside", "with": {"input": "inputs/box.ply"},
                       "outputs": {"output": "@CANARIES@/made.ply"}, "code": 0,
                       "compare": [{"what": "output", "as": "exists", "reason": "it is there"}]})"},
        {"/cases", R"({"id": "y", "operation": "mesh convert", "about": "outside", "with": {"input": "inputs/box.ply"},
                       "outputs": {"output": "../../../canaries/made.ply"}, "code": 0,
                       "compare": [{"what": "output", "as": "exists", "reason": "it is there"}]})"},
        {"/cases", R"({"id": "z", "operation": "mesh info", "about": "outside", "with": {"input": "../../canaries/secret.ply"},
                       "code": 0, "compare": [{"what": "report", "as": "values", "reason": "whatever it is"}]})"},
        {"/cases", R"({"id": "w", "operation": "conformance run", "about": "a program", "code": 0,
                       "with": {"command": ["sh", "-c", "echo > @CANARIES@/made"]},
                       "compare": [{"what": "report", "as": "values", "reason": "whatever it is"}]})"},
        {"/cases", R"({"id": "v", "operation": "mesh convert", "about": "outside", "code": 0,
                       "with": {"input": "inputs/box.ply", "output": "@CANARIES@/made.ply"},
                       "compare": [{"what": "report", "as": "values", "reason": "whatever it is"}]})"},
        {"/cases", R"({"id": "u", "operation": "run", "about": "a program", "code": 0, "with": {"study": "inputs/x.study.json"},
                       "outputs": {"output": "@CANARIES@/folder/"},
                       "compare": [{"what": "report", "as": "values", "reason": "whatever it is"}]})"},
    };
    return plants;
}

// ---- studies and their runs ----

std::string run_twice(const std::string& study, const std::string& folder, Stopper& stopper) {
    const std::string with = R"({"study":")" + study + R"(","output":")" + folder + "\"}";
    const std::string first = call_operation("run", with, stopper);
    return first + call_operation("run", with, stopper);
}

std::string go_on_and_replay(const std::string& study, const std::string& folder, Stopper& stopper) {
    std::string output;
    const auto attempt = [&](const std::string& operation, const std::string& with) {
        try {
            output += call_operation(operation, with, stopper);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled) throw;
            output += error.what();
        }
    };
    attempt("replay", R"({"crate":")" + folder + "\"}");
    attempt("replay", R"({"crate":")" + folder + R"(","inputs":"."})");
    attempt("run", R"({"study":")" + study + R"(","output":")" + folder + "\"}");
    return output;
}

void add_study(const std::string& name, const Path& folder, std::vector<Subject>& subjects) {
    Subject subject;
    subject.name = "study " + name;
    subject.files = {{name + ".study.json", folder / (name + ".study.json")},
                     {"sphere.ply", folder / "sphere.ply"},
                     {"program", {}, "#!/bin/sh\necho > ../canaries/made\n"}};
    subject.targets = {{"study", name + ".study.json", true}, {"study", name + ".study.json", true}, {"study", "sphere.ply"}};
    subject.keeps_inside = true;
    subject.plants = hostile_steps();
    subject.act = [name](Stopper& stopper) { return run_twice(name + ".study.json", "run", stopper); };
    subjects.push_back(std::move(subject));
}

void add_run(const std::string& name, const Path& folder, std::vector<Subject>& subjects) {
    Subject subject;
    subject.name = "run folder " + name;
    subject.files = files_below(folder / (name + "-run"), name + "-run/");
    for (const SubjectFile& file : subject.files) subject.targets.push_back({"run folder", file.name});
    subject.files.push_back({name + ".study.json", folder / (name + ".study.json")});
    subject.files.push_back({"sphere.ply", folder / "sphere.ply"});
    subject.keeps_inside = true;
    subject.plants = hostile_steps();
    subject.act = [name](Stopper& stopper) { return go_on_and_replay(name + ".study.json", name + "-run", stopper); };
    subjects.push_back(std::move(subject));
}

// ---- sessions ----

const std::vector<std::string>& session_messages() {
    static const std::vector<std::string> messages{
        R"({"id":1,"do":"open","name":"ball.ply"})",
        R"({"id":2,"do":"run","operation":"annotation select","title":"cap","with":{"mesh":{"part":"mesh"},)"
        R"("tag":"cap","type":"region","expression":"{\"halfspace\":{\"point\":[0,0,0.5],\"normal\":[0,0,1]}}"},)"
        R"("keep":["output","recipe"]})",
        R"({"id":3,"do":"run","operation":"cage make","with":{"mesh":{"part":"mesh"},"vertices":20}})",
        R"({"id":4,"do":"run","operation":"cage weights","with":{"mesh":{"part":"mesh"},"cage":{"part":"cage"}}})",
        R"({"id":5,"do":"run","operation":"deform","as":"deformed","keep":["cage-out"],)"
        R"("with":{"mesh":{"part":"mesh"},"cage":{"part":"cage"},"weights":{"part":"coordinates"},)"
        R"("edit":{"document":{"format":"ostraka-edit","version":1,"steps":[{"select":{"cageVertices":[0,1]},)"
        R"("translate":[0.1,0,0]}]}}}})",
        R"({"id":6,"do":"run","operation":"measure describe","with":{"mesh":{"part":"mesh"},)"
        R"("annotations":{"part":"annotations"}}})"};
    return messages;
}

const std::vector<std::string>& further_messages() {
    static const std::vector<std::string> messages{
        R"({"id":10,"do":"hello"})",
        R"({"id":11,"do":"scene","known":[]})",
        R"({"id":12,"do":"select","expression":{"halfspace":{"point":[0,0,0],"normal":[0,0,1]}},"type":"region"})",
        R"({"id":13,"do":"handles","annotation":0,"threshold":0.2})",
        R"({"id":14,"do":"parts"})",
        R"({"id":15,"do":"influence","handles":[0,1]})",
        R"({"id":16,"do":"grab","handles":[0,1],"constraints":false})",
        R"({"id":17,"do":"drag","places":[[0,0,0],[1,1,1]]})",
        R"({"id":18,"do":"run","operation":"annotation list","with":{"mesh":{"part":"mesh"},)"
        R"("annotations":{"part":"annotations"}}})",
        R"({"id":19,"do":"activate","object":0})",
        R"({"id":20,"do":"go","place":3})",
        R"({"id":21,"do":"go","place":6})",
        R"({"id":22,"do":"run","operation":"mesh info","with":{"input":{"part":"mesh"}}})",
        R"({"id":24,"do":"save","name":"saved"})",
        R"({"id":23,"do":"accept"})",
        R"({"id":25,"do":"go","place":1})",
        R"({"id":26,"do":"run","operation":"mesh info","with":{"input":{"part":"mesh"}}})",
        R"({"id":27,"do":"close","object":0})"};
    return messages;
}

/// The workbench's answer, including its bytes.
std::string ask(Workbench& workbench, const std::string& message) {
    const Workbench::Reply reply = workbench.answer(message);
    return reply.json + "\n" + reply.bytes + "\n";
}

std::string talk(const std::vector<std::string>& messages, Stopper& stopper) {
    Workbench workbench("session", ".", stopper.memory);
    stopper.set([&workbench] { workbench.cancel(); });
    struct Unset {
        Stopper& stopper;
        ~Unset() { stopper.set({}); }
    } const unset{stopper};
    std::string answers;
    for (const std::string& message : messages) answers += ask(workbench, message);
    std::set<std::string> files;
    for (const SessionObject& object : workbench.session().state().objects)
        for (const auto& [part, file] : object.parts) files.insert(file);
    for (const SessionFile& file : workbench.session().state().files) files.insert(file.file);
    for (const std::string& file : files) {
        Json message(rapidjson::kObjectType);
        add_members(message, message.GetAllocator(), "id", 30, "do", "file", "file", file);
        answers += ask(workbench, to_compact_text(message));
    }
    return answers;
}

Subject session_subject(const Path& seeds) {
    Subject subject;
    subject.files = files_below(seeds / "bench");
    subject.keeps_inside = true;
    return subject;
}

// ---- kits ----

/// Runs cases in this process.
class OwnBackend final : public Backend {
public:
    explicit OwnBackend(Stopper& stopper) : stopper_(stopper) {}
    Answer run(const ConformanceCase& test_case, const JsonValue& settings, const Path& /*folder*/) override {
        Answer answer;
        try {
            const Json report = parse_json(call_operation(test_case.operation, settings, stopper_), "the report");
            answer.code = test_case.code == 3 ? 3 : 0;
            answer.result = std::make_shared<const Json>([&] {
                Json result;
                result.CopyFrom(report["result"], result.GetAllocator());
                return result;
            }());
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled) throw;
            answer.code = error.kind() == ErrorKind::usage ? 2 : 1;
            answer.message = error.what();
        }
        return answer;
    }

private:
    Stopper& stopper_;
};

std::string judge_kit(Stopper& stopper) {
    const ConformanceKit kit = read_kit("kit", find_operation);
    OwnBackend backend(stopper);
    std::string report;
    for (std::size_t i = 0; i < kit.cases.size() && i < 12; ++i) {
        const CaseResult result = run_case(kit, kit.cases[i], backend, "scratch", find_operation);
        report += kit.cases[i].id + " " + to_string(result.outcome) + "\n";
        for (const std::string& how : result.differences) report += how + "\n";
    }
    return report;
}

}  // namespace

void make_studies(const Path& project) {
    const Path inputs = project / "data" / "conformance" / "inputs";
    make_folder("studies");
    write_file("studies/sphere.ply", read_file(inputs / "sphere.ply"));
    write_file("studies/sphere.study.json", read_file(inputs / "sphere.study.json"));
    write_file("studies/rich.study.json", rich_study);
    Stopper stopper;
    const Path folder = std::filesystem::absolute("studies");
    for (const std::string name : {"sphere", "rich"})
        call_operation("run",
                       R"({"study":")" + (folder / (name + ".study.json")).string() + R"(","output":")" +
                           (folder / (name + "-run")).string() + "\"}",
                       stopper);
}

void add_studies(const Path& project, const Path& seeds, std::vector<Subject>& subjects) {
    for (const char* name : {"sphere", "rich"}) {
        add_study(name, seeds / "studies", subjects);
        add_run(name, seeds / "studies", subjects);
    }
    for (const std::string& name : files_in(project / "data")) {
        if (!name.ends_with(".study.json")) continue;
        Subject subject;
        subject.name = "dry run of " + name;
        subject.files = {{name, project / "data" / name}};
        subject.targets = {{"study", name, true}};
        subject.keeps_inside = true;
        subject.plants = hostile_steps();
        subject.act = [name](Stopper& stopper) {
            return call_operation("run", R"({"study":")" + name + R"(","dry-run":true,"output":"run"})", stopper);
        };
        subjects.push_back(std::move(subject));
    }
}

void make_session(const Path& project) {
    make_folder("bench");
    write_file("bench/ball.ply", read_file(project / "data" / "conformance" / "inputs" / "sphere.ply"));
    Workbench workbench("bench/session", "bench");
    for (const std::string& message : session_messages()) {
        const Json answer = parse_json(workbench.answer(message).json, "the workbench");
        if (!answer["ok"].GetBool()) fail_work("the session of the seeds", to_compact_text(answer["error"]), "mend its messages");
    }
}

void add_sessions(const Path& seeds, std::vector<Subject>& subjects) {
    Subject session = session_subject(seeds);
    session.name = "session";
    for (const SubjectFile& file : session.files) session.targets.push_back({"session", file.name});
    for (int i = 0; i < 12; ++i) session.targets.push_back({"session", "session/session.json"});
    session.plants = hostile_session();
    session.act = [](Stopper& stopper) { return talk(further_messages(), stopper); };
    subjects.push_back(std::move(session));

    Subject messages = session_subject(seeds);
    messages.name = "messages";
    std::string text;
    for (const auto* list : {&further_messages(), &session_messages()})
        for (const std::string& message : *list) text += message + "\n";
    messages.files.push_back({"messages.txt", {}, text});
    messages.targets = {{"messages", "messages.txt"}};
    messages.act = [](Stopper& stopper) {
        std::vector<std::string> list;
        const std::string all = read_file("messages.txt");
        for (std::size_t begin = 0; begin < all.size();) {
            const std::size_t end = std::min(all.find('\n', begin), all.size());
            list.push_back(all.substr(begin, end - begin));
            begin = end + 1;
        }
        return talk(list, stopper);
    };
    subjects.push_back(std::move(messages));
}

void make_kit(const Path& project) {
    const Path from = project / "data" / "conformance";
    const std::set<std::string> wanted{"mesh-info-tetrahedron", "mesh-convert-quads-of-obj",    "annotation-list-box",
                                       "cage-edit-translate",   "annotation-export-attributes", "mesh-convert-empty-file"};
    Json document = read_json(from / "conformance.json");
    JsonValue& cases = document["cases"];
    for (rapidjson::SizeType i = cases.Size(); i-- > 0;)
        if (!wanted.contains(text_in(cases[i], "id"))) cases.Erase(cases.Begin() + i);
    make_folder("kit/inputs");
    write_json("kit/conformance.json", document);
    for (const char* name : {"tetrahedron.ply", "box-of-quads.obj", "box.ply", "box.ant.json", "octahedron.ply", "empty.ply"})
        write_file(Path("kit/inputs") / name, read_file(from / "inputs" / name));
    for (const std::string& id : wanted)
        if (is_folder(from / "expected" / id))
            for (const SubjectFile& file : files_below(from / "expected" / id)) {
                make_folder((Path("kit/expected") / id / file.name).parent_path());
                write_file(Path("kit/expected") / id / file.name, read_file(file.from));
            }
}

void add_kits(const Path& seeds, std::vector<Subject>& subjects) {
    Subject kit;
    kit.name = "kit";
    kit.files = files_below(seeds / "kit", "kit/");
    for (const SubjectFile& file : kit.files) kit.targets.push_back({"kit", file.name});
    for (int i = 0; i < 20; ++i) kit.targets.push_back({"kit", "kit/conformance.json"});
    kit.keeps_inside = true;
    kit.plants = hostile_cases();
    kit.act = judge_kit;
    subjects.push_back(std::move(kit));
}

}  // namespace ostraka::fuzz

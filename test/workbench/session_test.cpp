// Sessions: steps are undone to the bit, repeated to the bit by the command, and unaffected by damaged messages of a page.
#include "meshes.h"
#include "mutate.h"
#include "scratch.h"

#include "ostraka/files/json_build.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/workbench/workbench.h"

#include <gtest/gtest.h>

#include <random>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// A folder with a sphere, and a workbench on it.
struct Bench {
    Scratch scratch;
    std::unique_ptr<Workbench> workbench;
    Bench() {
        write_mesh(scratch / "ball.ply", build_mesh(octahedron_sphere(3)), {}, {});
        start();
    }
    void start() {
        workbench.reset();  // one at a time
        workbench = std::make_unique<Workbench>(scratch / "session", scratch.path());
    }

    /// The answer to a message, which must succeed.
    Json ask(const std::string& message) const {
        const Workbench::Reply reply = workbench->answer(message);
        Json answer = parse_json(reply.json, "the answer");
        EXPECT_TRUE(answer["ok"].GetBool()) << message << "\n" << reply.json;
        return answer;
    }
    /// The error of a message.
    [[nodiscard]] std::string refused(const std::string& message) const {
        const Json answer = parse_json(workbench->answer(message).json, "the answer");
        EXPECT_FALSE(answer["ok"].GetBool()) << message;
        return answer["ok"].GetBool() ? "" : text_in(answer["error"], "problem");
    }
    [[nodiscard]] const SessionState& state() const { return workbench->session().state(); }
};

std::string annotate(const std::string& tag, double from) {
    const std::string low = std::to_string(from);
    return R"({"id":1,"do":"run","operation":"annotation select","title":")" + tag +
           R"(","with":{"mesh":{"part":"mesh"},"tag":")" + tag +
           R"(","type":"region","expression":"{\"halfspace\":{\"point\":[0,0,)" + low +
           R"(],\"normal\":[0,0,1]}}"ANNOTATIONS},"keep":["output"RECIPE]})";
}
std::string filled(std::string text, bool annotated, bool recipe) {
    const auto replace = [&](const std::string& mark, const std::string& by) { text.replace(text.find(mark), mark.size(), by); };
    replace("ANNOTATIONS",
            annotated ? R"(,"annotations":{"part":"annotations"})" + std::string(recipe ? R"(,"record":{"part":"recipe"})" : "")
                      : "");
    replace("RECIPE", recipe || !annotated ? R"(,"recipe")" : "");
    return text;
}

/// Checksums of all files that a state names.
std::map<std::string, std::string> checksums(const Session& session) {
    std::map<std::string, std::string> sums;
    for (const SessionObject& object : session.state().objects)
        for (const auto& [part, file] : object.parts)
            sums[object.name + "/" + part] = file + " " + sha256_of_file(session.path_of(file));
    for (const SessionFile& file : session.state().files)
        if (!is_folder(session.path_of(file.file)))
            sums[file.name] = file.file + " " + sha256_of_file(session.path_of(file.file));
    sums["active"] = std::to_string(session.state().active);
    return sums;
}

}  // namespace

TEST(WorkbenchPreview, HasTheShapeOfAFileThatCanBeOpenedAndChangesNothing) {
    const Bench bench;
    const Workbench::Reply reply = bench.workbench->answer(R"({"id":1,"do":"preview","name":"ball.ply"})");
    const Json answer = parse_json(reply.json, "the answer");
    ASSERT_TRUE(answer["ok"].GetBool()) << reply.json;
    const Json content = parse_json(text_in(answer["result"], "content"), "the content");
    ASSERT_EQ(content["objects"].Size(), 1u);
    EXPECT_EQ(content["objects"][0]["faces"].GetUint(), build_mesh(octahedron_sphere(3)).number_of_faces());
    EXPECT_FALSE(reply.bytes.empty());
    EXPECT_FALSE(reply.changed);
    EXPECT_TRUE(bench.state().objects.empty());
    for (const char* name : {"no.ply", "../ball.ply", "/etc/passwd", ""})
        EXPECT_NE(bench.refused(R"({"id":2,"do":"preview","name":")" + std::string(name) + "\"}").find("not a file"),
                  std::string::npos)
            << name;
}

TEST(Session, OpensAnnotatesAndKeepsTheSteps) {
    Bench bench;
    bench.ask(R"({"id":1,"do":"open","name":"ball.ply"})");
    bench.ask(filled(annotate("cap", 0.5), false, false));
    bench.ask(filled(annotate("half", 0.0), true, true));
    ASSERT_EQ(bench.state().objects.size(), 1U);
    const std::string annotations = bench.state().objects[0].part("annotations");
    EXPECT_EQ(annotations, "steps/s003/ball.ant.json");
    // Another process continues the session.
    bench.start();
    EXPECT_EQ(bench.workbench->session().place(), 3U);
    EXPECT_EQ(bench.state().objects[0].part("annotations"), annotations);
    const Json scene = bench.ask(R"({"id":2,"do":"scene","known":[]})");
    const Json content = parse_json(text_in(scene["result"], "content"), "the scene");
    ASSERT_EQ(content["objects"].Size(), 1U);
    EXPECT_EQ(content["objects"][0]["annotations"].Size(), 2U);
    // The annotations alone are a recipe, to the bit.
    const Path folder = bench.workbench->session().folder();
    const auto again = run_command("annotation apply " + (bench.scratch / "ball.ply").string() + " " +
                                   (folder / bench.state().objects[0].part("recipe")).string() + " " +
                                   (bench.scratch / "again.ant.json").string());
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(read_file(bench.scratch / "again.ant.json"), read_file(folder / annotations));
}

TEST(Session, IsAStudyThatMakesTheSameFiles) {
    Bench bench;
    bench.ask(R"({"id":1,"do":"open","name":"ball.ply"})");
    bench.ask(filled(annotate("cap", 0.5), false, false));
    bench.ask(R"({"id":1,"do":"run","operation":"mesh refine","with":{"input":{"part":"mesh"},"vertices":600}})");
    bench.ask(R"({"id":1,"do":"activate","object":0})");
    bench.ask(
        R"({"id":1,"do":"run","operation":"annotation transfer","with":{"source":{"part":"mesh","object":0},"annotations":{"part":"annotations","object":0},"target":{"part":"mesh","object":1}}})");
    bench.ask(R"({"id":1,"do":"run","operation":"cage make","with":{"mesh":{"part":"mesh"},"vertices":20}})");
    bench.ask(R"({"id":1,"do":"run","operation":"cage weights","with":{"mesh":{"part":"mesh"},"cage":{"part":"cage"}}})");
    bench.ask(
        R"({"id":1,"do":"run","operation":"deform","as":"deformed","keep":["cage-out"],"with":{"mesh":{"part":"mesh"},"cage":{"part":"cage"},
        "weights":{"part":"coordinates"},"edit":{"document":{"format":"ostraka-edit","version":1,"steps":[{"select":{"cageVertices":[0,1]},"translate":[0.1,0,0]}]}}}})");
    EXPECT_FALSE(bench.state().objects[0].part("deformed").empty());
    const Session& session = bench.workbench->session();
    const auto run = run_command("run " + (session.folder() / "session.study.json").string() + " --reads " +
                                 bench.scratch.path().string() + " --output " + (bench.scratch / "again").string());
    ASSERT_EQ(run.code, 0) << run.err << run.out;
    std::size_t compared = 0;
    for (const SessionStep& step : session.steps())
        for (const auto& [output, sum] : step.sha256) {
            const Path file = bench.scratch / "again/steps" / step.name / text_of(step.keep[output.c_str()]);
            EXPECT_EQ(sha256_of_file(file), sum) << file;
            ++compared;
        }
    EXPECT_EQ(compared, 8U);
}

TEST(Session, UndoRestoresEveryStateToTheBit) {
    Bench bench;
    std::mt19937_64 random(7);
    std::vector<std::map<std::string, std::string>> states{checksums(bench.workbench->session())};
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    for (int i = 0; i < 200; ++i) {
        const Session& session = bench.workbench->session();
        if (session.steps().size() > 2 && below(3) == 0) {
            bench.ask(R"({"id":1,"do":"go","place":)" + std::to_string(below(session.steps().size() + 1)) + "}");
        } else if (bench.state().objects.empty() || (bench.state().objects.size() < 3 && below(8) == 0)) {
            bench.ask(R"({"id":1,"do":"open","name":"ball.ply"})");
        } else if (below(6) == 0) {
            bench.ask(R"({"id":1,"do":"activate","object":)" + std::to_string(below(bench.state().objects.size())) + "}");
        } else if (bench.state().object()->part("annotations").empty() || below(2) == 0) {
            const SessionObject& object = *bench.state().object();
            bench.ask(filled(annotate("part " + std::to_string(i), -0.9 + 0.008 * i), !object.part("annotations").empty(),
                             !object.part("recipe").empty()));
        } else if (below(2) == 0) {
            bench.ask(
                R"({"id":1,"do":"run","operation":"relation extract","with":{"mesh":{"part":"mesh"},"annotations":{"part":"annotations"},"type":["containment"]}})");
        } else {
            bench.ask(
                R"({"id":1,"do":"run","operation":"annotation edit","with":{"mesh":{"part":"mesh"},"annotations":{"part":"annotations"},"set-class":"ball )" +
                std::to_string(i) + R"("}})");
        }
        // Earlier states are unchanged; new states replace those that were undone.
        if (session.place() == session.steps().size() && states.size() != session.steps().size() + 1) {
            states.resize(session.place());
            states.push_back(checksums(session));
        }
        if (session.place() == session.steps().size() && checksums(session) != states.back()) {
            states.resize(session.place());
            states.push_back(checksums(session));
        }
        ASSERT_EQ(checksums(session), states[session.place()]) << "after " << i;
    }
    // All of them, one after the other, also for another process.
    bench.start();
    for (std::size_t place = 0; place <= bench.workbench->session().steps().size(); ++place) {
        bench.ask(R"({"id":1,"do":"go","place":)" + std::to_string(place) + "}");
        EXPECT_EQ(checksums(bench.workbench->session()), states[place]) << place;
    }
}

TEST(Session, RefusesWithAMessageAndChangesNothing) {
    Bench bench;
    EXPECT_NE(bench.refused(R"({"id":1,"do":"open","name":"../../etc/passwd"})").find("is not a mesh"), std::string::npos);
    EXPECT_NE(bench.refused(R"({"id":1,"do":"open","name":"session/session.json"})").find("is not a mesh"), std::string::npos);
    EXPECT_NE(bench.refused(R"({"id":1,"do":"run","operation":"mesh info","with":{"input":{"part":"mesh"}}})").find("no object"),
              std::string::npos);
    bench.ask(R"({"id":1,"do":"open","name":"ball.ply"})");
    const std::size_t files = count_files(bench.scratch / "session");
    for (
        const auto& [message, words] : std::vector<std::pair<std::string, std::string>>{
            {R"({"id":1,"do":"run","operation":"mesh explode"})", "no operation"},
            {R"({"id":1,"do":"run","operation":"run","with":{}})", "cannot be run in the workbench"},
            {R"({"id":1,"do":"run","operation":"mesh info","with":{"input":"/etc/passwd"}})", "not given as a part"},
            {R"({"id":1,"do":"run","operation":"mesh info","with":{"input":{"file":"/etc/passwd"}}})",
             "is not a file of the session"},
            {R"({"id":1,"do":"run","operation":"mesh info","with":{"input":{"part":"mesh","object":9}}})", "no object"},
            {R"({"id":1,"do":"run","operation":"mesh simplify","with":{"input":{"part":"mesh"},"output":{"part":"mesh"}}})",
             "is an output"},
            {R"({"id":1,"do":"run","operation":"mesh simplify","with":{"input":{"part":"mesh"},"vertices":-4}})", "vertices"},
            {R"({"id":1,"do":"run","operation":"annotation list","with":{"mesh":{"part":"mesh"},"annotations":{"part":"annotations"}}})",
             "has no annotations"},
            {R"({"id":1,"do":"run","operation":"mesh info","with":{"input":{"part":"mesh"},"unit":"${pot.output}"}})", "${"},
            {R"({"id":1,"do":"go","place":77})", "no step 77"},
            {R"({"id":1,"do":"go","place":-1})", "no place"},
            {R"({"id":1,"do":"accept"})", "nothing is being deformed"},
            {R"({"id":1,"do":"close","object":4})", "no object 4"},
            {R"({"id":1,"do":"grab","handles":[0]})", "no cage"},
            {R"({"id":1,"do":"drag","places":[]})", "nothing has been grabbed"},
            {R"({"id":1,"do":"file","file":"../ball.ply/../../x"})", "is not a file of the session"},
            {R"({"id":1,"do":"save","name":"../up"})", "is not a valid folder name"},
            {R"({"id":1,"do":"save","name":"x"})", "has no annotations"},
            {R"({"id":1,"do":"select","expression":{"halfspace":7}})", "does not match"},
            {R"({"id":1,"do":"dance"})", "is not a change"},
            {R"({"id":1})", "is not a change"},
            {R"([1,2])", "not an object"},
            {R"({"id":1,"do":)", ""},
            {"", ""}})
        EXPECT_NE(bench.refused(message).find(words), std::string::npos) << message << ": " << bench.refused(message);
    EXPECT_EQ(bench.workbench->session().steps().size(), 1U);
    EXPECT_LE(count_files(bench.scratch / "session"), files + 1);  // "steps", empty
    EXPECT_TRUE(!is_folder(bench.scratch / "session/steps") || std::filesystem::is_empty(bench.scratch / "session/steps"));
}

TEST(Session, SurvivesDamagedMessages) {
    Bench bench;
    bench.ask(R"({"id":1,"do":"open","name":"ball.ply"})");
    bench.ask(filled(annotate("cap", 0.5), false, false));
    const std::vector<std::string> messages{
        filled(annotate("cap", 0.2), true, true),
        R"({"id":3,"do":"select","expression":{"box":{"min":[0,0,0],"max":[1,1,1]}},"type":"region"})",
        R"({"id":4,"do":"scene","known":["a","b"]})",
        R"({"id":5,"do":"go","place":1})",
        R"({"id":6,"do":"activate","object":0})",
        R"({"id":1,"do":"run","operation":"mesh simplify","with":{"input":{"part":"mesh"},"vertices":100}})"};
    for (int i = 0; i < 600; ++i) {
        const std::string damaged =
            mutate(messages[static_cast<std::size_t>(i) % messages.size()], static_cast<std::uint64_t>(i));
        const Json answer = parse_json(bench.workbench->answer(damaged).json, "the answer");
        EXPECT_TRUE(answer.HasMember("ok"));
    }
    bench.start();  // its contents are valid
}

TEST(Session, IsRefusedIfDamagedOrIfFilesAreMissing) {
    Bench bench;
    bench.ask(R"({"id":1,"do":"open","name":"ball.ply"})");
    bench.ask(filled(annotate("cap", 0.5), false, false));
    const Path file = bench.scratch / "session/session.json";
    const std::string whole = read_file(file);
    write_file(file, whole.substr(0, whole.size() / 2));
    EXPECT_THROW(bench.start(), Error);
    write_file(
        file,
        R"({"format":"ostraka-session","version":1,"place":0,"counter":0,"steps":[{"name":"../x","title":"","state":{"objects":[],"active":0,"files":[]}}]})");
    EXPECT_THROW(bench.start(), Error);
    write_file(file, whole);
    std::filesystem::remove(bench.scratch / "session/steps/s002/ball.ant.json");
    EXPECT_THROW(bench.start(), Error);
    EXPECT_THROW(Workbench(bench.scratch.path(), bench.scratch.path()), Error) << "a folder that holds other data";
}

TEST(Session, IsRefusedIfItsPathsLeaveTheFolders) {
    const Scratch outside;
    write_file(outside / "secret.txt", "secret");
    std::filesystem::create_directory(outside / "s001");
    write_file(outside / "s001/kept.txt", "kept");
    const auto refused = [&](const std::string& name, const std::function<void(const Path&, std::string&)>& change) {
        Bench bench;
        bench.ask(R"({"id":1,"do":"open","name":"ball.ply"})");
        bench.ask(filled(annotate("cap", 0.5), false, false));
        bench.workbench.reset();
        const Path folder = bench.scratch / "session";
        std::string text = read_file(folder / "session.json");
        change(folder, text);
        std::filesystem::remove(folder / "session.json");
        write_file(folder / "session.json", text);
        try {
            bench.start();
            ADD_FAILURE() << name;
        } catch (const Error& error) {
            EXPECT_FALSE(error.where().empty()) << name;
            EXPECT_FALSE(error.remedy().empty()) << name;
        }
        EXPECT_TRUE(file_exists(outside / "secret.txt")) << name;
        EXPECT_EQ(read_file(outside / "s001/kept.txt"), "kept") << name;
    };
    const auto replaced = [](std::string& text, const std::string& old, const std::string& by) {
        ASSERT_NE(text.find(old), std::string::npos) << old;
        text.replace(text.find(old), old.size(), by);
    };
    refused("a part by its absolute name", [&](const Path&, std::string& text) {
        replaced(text, "\"../ball.ply\"", '"' + (outside / "secret.txt").string() + '"');
    });
    refused("a part that climbs out", [&](const Path&, std::string& text) {
        replaced(text, "\"../ball.ply\"", "\"../../" + outside.path().filename().string() + "/secret.txt\"");
    });
    refused("steps as a link", [&](const Path& folder, std::string&) {
        std::filesystem::remove_all(folder / "steps");
        std::filesystem::create_directory_symlink(outside.path(), folder / "steps");
    });
    refused("a part over a link", [&](const Path& folder, std::string&) {
        std::filesystem::remove(folder / "steps/s002/ball.ant.json");
        std::filesystem::create_symlink(outside / "secret.txt", folder / "steps/s002/ball.ant.json");
    });
    refused("a report over a link", [&](const Path& folder, std::string&) {
        std::filesystem::remove(folder / "steps/s002/report.json");
        std::filesystem::create_symlink(outside / "secret.txt", folder / "steps/s002/report.json");
    });
    refused("a step that comes again",
            [&](const Path&, std::string& text) { replaced(text, "\"counter\": 2", "\"counter\": 1"); });
    refused("a device", [&](const Path&, std::string& text) { replaced(text, "\"../ball.ply\"", "\"/dev/zero\""); });
    refused("the study as a link", [&](const Path& folder, std::string&) {
        std::filesystem::remove(folder / "session.study.json");
        std::filesystem::create_symlink(outside / "secret.txt", folder / "session.study.json");
    });
}

TEST(Session, WritesNoDocumentOverALink) {
    const Scratch outside;
    write_file(outside / "kept.json", "kept");
    Bench bench;
    bench.ask(R"({"id":1,"do":"open","name":"ball.ply"})");
    bench.ask(filled(annotate("cap", 0.5), false, false));
    bench.ask(R"({"id":1,"do":"go","place":1})");  // the next step is the third
    const Path documents = bench.scratch / "session/documents";
    make_folder(documents);
    std::filesystem::create_symlink(outside / "kept.json", documents / "s003-recipe.json");
    EXPECT_NE(
        bench.refused(
            R"({"id":1,"do":"run","operation":"annotation apply","with":{"mesh":{"part":"mesh"},"recipe":{"document":{"format":"ostraka-recipe","version":1,"annotations":[]}}}})"),
        "");
    EXPECT_EQ(read_file(outside / "kept.json"), "kept");
    EXPECT_EQ(bench.workbench->session().place(), 1U);
}

TEST(Session, IsPrivateAndRemovesFilesOfKilledSteps) {
    Bench bench;
    bench.ask(R"({"id":1,"do":"open","name":"ball.ply"})");
    bench.ask(filled(annotate("cap", 0.5), false, false));
    const Path folder = bench.scratch / "session";
    using std::filesystem::perms;
    EXPECT_EQ(std::filesystem::status(folder).permissions(), perms::owner_all);
    EXPECT_EQ(std::filesystem::status(folder / "session.json").permissions(), perms::owner_read | perms::owner_write);
    make_folder(folder / "steps/s009");
    write_file(folder / "steps/s009/half.ply", "");
    make_folder(folder / "documents");
    write_file(folder / "documents/s009-edit.json", "{}");
    write_file(folder / "documents/notes.txt", "not a step's");
    bench.start();
    EXPECT_FALSE(is_folder(folder / "steps/s009"));
    EXPECT_FALSE(file_exists(folder / "documents/s009-edit.json"));
    EXPECT_TRUE(file_exists(folder / "documents/notes.txt"));
    EXPECT_TRUE(is_folder(folder / "steps/s002"));
}

TEST(Session, AMapIsShownWithItsOwnObject) {
    Bench bench;
    const auto maps = [&] {
        std::vector<std::size_t> counts;
        const Json scene = bench.ask(R"({"id":2,"do":"scene","known":[]})");
        const Json content = parse_json(text_in(scene["result"], "content"), "the scene");
        for (const JsonValue& object : list_in(content, "objects")) counts.push_back(object["maps"].Size());
        return counts;
    };
    bench.ask(R"({"id":1,"do":"open","name":"ball.ply"})");
    bench.ask(R"({"id":1,"do":"run","operation":"measure map","with":{"mesh":{"part":"mesh"},"of":"mean-curvature"}})");
    EXPECT_EQ(maps(), std::vector<std::size_t>{1});
    bench.ask(R"({"id":1,"do":"open","name":"ball.ply"})");  // the same number of vertices, but another object
    EXPECT_EQ(maps(), (std::vector<std::size_t>{0, 0}));
}

TEST(Session, OffersTheConceptsOfVocabularies) {
    Bench bench;
    write_file(bench.scratch / "terracotta.vocabulary.json",
               read_file(Path(OSTRAKA_SOURCE_DIR) / "data/terracotta.vocabulary.json"));
    write_file(bench.scratch / "bad.vocabulary.json", "{");
    const Json hello = bench.ask(R"({"id":1,"do":"hello"})");
    ASSERT_TRUE(hello["result"]["words"].HasMember("en"));
    EXPECT_GT(hello["result"]["words"]["en"].Size(), 3U);
}

TEST(Session, IsOpenedByOneProcessAtATime) {
    Bench bench;
    EXPECT_THROW(Workbench(bench.scratch / "session", bench.scratch.path()), Error);
    bench.start();
}

TEST(Session, DoesNotOpenUnreadableFiles) {
    Bench bench;
    bench.ask(R"({"id":1,"do":"open","name":"ball.ply"})");
    write_file(bench.scratch / "bad.ply", "ply\ngarbage");
    EXPECT_FALSE(bench.refused(R"({"id":1,"do":"open","name":"bad.ply"})").empty());
    EXPECT_EQ(bench.workbench->session().steps().size(), 1U);
    bench.ask(R"({"id":1,"do":"scene","known":[]})");
}

TEST(Session, ContinuesAfterACancellation) {
    Bench bench;
    bench.ask(R"({"id":1,"do":"open","name":"ball.ply"})");
    bench.workbench->cancel();
    bench.ask(filled(annotate("cap", 0.5), false, false));
    EXPECT_EQ(bench.workbench->session().place(), 2U);
}

TEST(Session, SavesACompleteTemplate) {
    Bench bench;
    bench.ask(R"({"id":1,"do":"open","name":"ball.ply"})");
    bench.ask(filled(annotate("cap", 0.5), false, false));
    bench.ask(R"({"id":1,"do":"run","operation":"cage make","with":{"mesh":{"part":"mesh"},"vertices":20}})");
    bench.ask(R"({"id":1,"do":"run","operation":"cage weights","with":{"mesh":{"part":"mesh"},"cage":{"part":"cage"}}})");
    const Json saved = bench.ask(R"({"id":1,"do":"save","name":"kept"})");
    const auto check = run_command("template check " + text_in(saved["result"], "file"));
    EXPECT_EQ(check.code, 0) << check.out << check.err;
    bench.ask(R"({"id":1,"do":"open","name":"kept/kept.template.json"})");
    EXPECT_FALSE(bench.state().object()->part("coordinates").empty());
    bench.ask(R"({"id":1,"do":"save","name":"kept"})");  // again
    write_file(bench.scratch / "other", "x");
    EXPECT_NE(bench.refused(R"({"id":1,"do":"save","name":"other"})").find("holds other data"), std::string::npos);
}

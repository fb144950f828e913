// Valid and invalid command lines, for any operation.
#include "ostraka/core/stopwatch.h"
#include "ostraka/execution/child_process.h"
#include "ostraka/files/json.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

namespace ostraka {
namespace {
using test::count_files;
using test::run_command;
using test::Scratch;

const std::string vase = std::string(OSTRAKA_SOURCE_DIR) + "/data/vase.ply";
const std::string annotations = std::string(OSTRAKA_SOURCE_DIR) + "/data/vase.ant.json";

void expect_refusal(const std::string& words, const std::string& message) {
    const auto result = run_command(words);
    EXPECT_EQ(result.code, 2) << words << result.err;
    EXPECT_NE(result.err.find(message), std::string::npos) << words << '\n' << result.err;
}

TEST(CommandLine, WrongFlagsAreNamedWithTheNearest) {
    const Scratch scratch;
    const std::string out = (scratch / "x.ply").string();
    expect_refusal("mesh simplify " + vase + " " + out + " --verticess 500", "did you mean 'vertices'");
    expect_refusal("mesh simplify " + vase + " " + out + " -vertices 500", "options begin with --");
    expect_refusal("annotation transfer --no-overlop a b c d", "did you mean 'no-overlap'");
    // Former names of bounds are answered with the current ones.
    expect_refusal("fit --search-least-scale 1 a b", "did you mean 'search-min-scale'");
    expect_refusal("assemble --least-join 0.5 a b", "did you mean 'min-join'");
    expect_refusal("template learn --strangers a b c", "did you mean 'out-of-class'");
    expect_refusal("template turn a b", "did you mean 'revolve'");
    expect_refusal("mesh info " + vase + " --input x", "input is given without a flag");
    expect_refusal("mesh info " + vase + " more", "one argument too many");
    expect_refusal("--quiet mesh info " + vase, "precedes the command");
    expect_refusal("mesh info " + vase + " --threads 1 --threads 2", "ostraka: mesh info: --threads");
}

TEST(CommandLine, MissingInputsAreNamedWithTheirOption) {
    expect_refusal(
        "annotation list " + vase,
        "annotations is missing (give the annotations of the mesh (.ant.json): ostraka annotation list MESH ANNOTATIONS");
    expect_refusal("mesh convert " + vase, "output is missing");
    expect_refusal("measure refresh " + vase, "--annotations is missing");
    expect_refusal("measure refresh " + vase, "(.ant.json): --annotations FILE");
    expect_refusal("measure take " + vase, "--tool is missing");
    expect_refusal("measure describe " + vase + " " + annotations, "give it as --annotations " + annotations);
    expect_refusal("measure describe " + vase + " --annotation belly", "add --annotations FILE");
    expect_refusal("render " + vase, "1 argument is given");
    const auto whole = run_command("measure describe " + vase);
    EXPECT_EQ(whole.code, 0) << whole.err;
    EXPECT_NE(whole.err.find("--annotations FILE describes its parts"), std::string::npos) << whole.err;
}

TEST(CommandLine, HelpIsAWordToo) {
    EXPECT_EQ(run_command("help").out, run_command("--help").out);
    EXPECT_NE(run_command("help").out.find("annotation"), std::string::npos);
    for (const std::string words : {"annotation", "annotation select", "study make", "mesh info"}) {
        const auto result = run_command("help " + words);
        EXPECT_EQ(result.code, 0) << words << result.err;
        EXPECT_EQ(result.out, run_command(words + " --help").out) << words;
    }
    EXPECT_EQ(run_command("annotation help").out, run_command("annotation --help").out);
    expect_refusal("help anotation", "did you mean 'annotation'");
    expect_refusal("help no", "is not a command");
}

TEST(CommandLine, AmountsAreNumbersWithADecimalPoint) {
    expect_refusal("slice " + vase + " --spacing 2cm", "write the number alone: 2 (the mesh's unit)");
    expect_refusal("slice " + vase + " --spacing 0,5", "write 0.5, with a decimal point");
    expect_refusal("annotation select " + vase + " x.ant.json --tag t --brush 3 --radius 2mm", "--unit");
}

TEST(CommandLine, NamesAreSuggestedWhateverTheirCase) {
    const auto take = [](const std::string& name) {
        const auto result = run_command("measure take " + vase + " --tool bounding --direction z --annotations " + annotations +
                                        " --annotation '" + name + "'");
        EXPECT_EQ(result.code, 1) << name;
        return result.err;
    };
    EXPECT_NE(take("rigth handel").find("did you mean 'right handle'"), std::string::npos);
    EXPECT_NE(take("BELLY").find("did you mean 'belly'"), std::string::npos);
    EXPECT_NE(take("girth").find("did you mean 'widest girth'"), std::string::npos);
    const auto edited = run_command("annotation edit " + vase + " " + annotations + " x.ant.json --annotation Shoulder --tag s");
    EXPECT_NE(edited.err.find("did you mean 'shoulder'"), std::string::npos) << edited.err;
    expect_refusal("measure take " + vase + " --tool Rular", "did you mean 'ruler'");
    expect_refusal("Annotation list", "did you mean 'annotation'");
}

TEST(CommandLine, AFlagHasItsValue) {
    const Scratch scratch;
    const std::string out = (scratch / "x.ply").string();
    expect_refusal("mesh convert " + vase + " " + out + " --map --quiet", "--map has no value");
    expect_refusal("mesh convert " + vase + " " + out + " --map", "--map has no value");
    expect_refusal("mesh info " + vase + " --skip-self-intersections=banana", "=true or =false");
    EXPECT_FALSE(std::filesystem::exists(out));
    const Path edited = scratch / "e.ant.json";
    const std::string edit = "annotation edit " + vase + " " + annotations + " ";
    ASSERT_EQ(run_command(edit + "--set-unit= " + edited.string()).code, 0);
    EXPECT_EQ(find_member(read_json(edited), "unit"), nullptr);
    expect_refusal(edit + edited.string() + " --annotation 1 --tag ''", "--tag is ''");
}

TEST(CommandLine, DirectionsAndViewsAreAcceptedAsInTheHelp) {
    const Scratch scratch;
    const auto select = [&](const std::string& flags) {
        std::filesystem::remove(scratch / "a.ant.json");
        return run_command("annotation select " + vase + " " + (scratch / "a.ant.json").string() +
                           " --tag t --rectangle 300,200,900,700 " + flags);
    };
    for (const char* up : {"x", "y", "z", "-x", "-y", "-z", "0,1,0", "-0.5,1,0"})
        EXPECT_EQ(select(std::string("--up ") + up).code, 0) << up;
    for (const char* view : {"front", "back", "left", "right", "top", "bottom", "iso", "-30,20"})
        EXPECT_EQ(select(std::string("--view ") + view).code, 0) << view;
    expect_refusal("measure clay " + vase + " --up sideways", "use x, y, z, -x, -y, -z or three numbers");
    expect_refusal("render " + vase + " " + (scratch / "p.png").string() + " --view under", "top, bottom, iso or azimuth");
}

TEST(CommandLine, NamesThatBeginWithADash) {
    const Scratch scratch;
    std::filesystem::copy_file(vase, scratch / "-dash.ply");
    const std::string in_folder = "cd " + scratch.path().string() + " && ";
    EXPECT_EQ(run_command("mesh info --quiet -- -dash.ply", in_folder).code, 0);
    const auto result = run_command("mesh info -dash.ply", in_folder);
    EXPECT_EQ(result.code, 2);
    EXPECT_NE(result.err.find("write ./-dash.ply"), std::string::npos) << result.err;
    expect_refusal("mesh convert " + vase + " memory:x.ply", "which is for programs");
}

TEST(CommandLine, LinksDoNotHideThatTwoOutputsAreOne) {
    const Scratch scratch;
    std::filesystem::create_symlink("map.ply", scratch / "link.ply");
    expect_refusal("mesh convert " + vase + " " + (scratch / "link.ply").string() + " --map " + (scratch / "map.ply").string(),
                   "two outputs have the name");
    std::filesystem::create_symlink("b.ply", scratch / "a.ply");
    std::filesystem::create_symlink("a.ply", scratch / "b.ply");
    EXPECT_EQ(run_command("mesh convert " + vase + " " + (scratch / "a.ply").string()).code, 1);
    EXPECT_TRUE(std::filesystem::is_symlink(scratch / "a.ply"));
}

TEST(CommandLine, ReplacedFilesKeepTheirRights) {
    const Scratch scratch;
    const Path out = scratch / "private.ply";
    ASSERT_EQ(run_command("mesh convert " + vase + " " + out.string()).code, 0);
    const auto rights = std::filesystem::perms::owner_read | std::filesystem::perms::owner_write;
    std::filesystem::permissions(out, rights);
    ASSERT_EQ(run_command("mesh convert " + vase + " " + out.string()).code, 0);
    EXPECT_EQ(std::filesystem::status(out).permissions(), rights);
}

TEST(CommandLine, PackingReplacesNoOtherFile) {
    const Scratch scratch;
    std::filesystem::create_directories(scratch / "from");
    std::filesystem::create_directories(scratch / "to");
    const Path mesh = scratch / "from/x.ply", other = scratch / "to/x.ply", package = scratch / "to/v.template.json";
    std::filesystem::copy_file(vase, mesh);
    write_file(other, "precious");
    const std::string pack = "template pack " + package.string() + " --copy --mesh " + mesh.string();
    expect_refusal(pack, "another file is called");
    EXPECT_EQ(read_file(other), "precious");
    std::filesystem::remove(other);
    ASSERT_EQ(run_command(pack).code, 0);
    ASSERT_EQ(run_command("mesh simplify " + vase + " " + mesh.string() + " --vertices 1000").code, 0);
    EXPECT_EQ(run_command(pack).code, 0) << "what the template holds already is its own";
}

TEST(CommandLine, CompletionKnowsTheCommonOptions) {
    EXPECT_EQ(run_command("--complete mesh info --show ''").out, "csv\njson\nmarkdown\ntable\n");
    EXPECT_EQ(run_command("--complete mesh info --threads ''").out, "");
    EXPECT_EQ(run_command("--complete mesh info - x").code, 0);
    EXPECT_EQ(run_command("--complete render a.ply --view b").out, "back\nbottom\n");
    EXPECT_EQ(run_command("--complete annotation select a.ply --type ''").out, "line\npoint\nregion\n");
    EXPECT_EQ(run_command("--complete relation extract a.ply --type adj").out, "adjacency\n");
    EXPECT_EQ(run_command("--complete slice a.ply --up -").out, "-x\n-y\n-z\n");
    EXPECT_EQ(run_command("--complete slice a.ply --ax").out, "--axes\n");
    EXPECT_EQ(run_command("--complete relation ''").out, "add\ncheck\nedit\nexport\nextract\nlist\nremove\n");
}

TEST(CommandLine, WorkBeyondTheMemoryLimitIsRefusedWithAMessage) {
    const std::string mesh = std::string(OSTRAKA_SOURCE_DIR) + "/data/statuette.ply";
    EXPECT_EQ(run_command("mesh info " + mesh + " --quiet --memory 8").code, 0);
    const auto small = run_command("mesh info " + mesh + " --memory 0.005");
    EXPECT_EQ(small.code, 1) << small.out;
    EXPECT_NE(small.err.find("GB of memory"), std::string::npos) << small.err;
    EXPECT_NE(small.err.find("--memory"), std::string::npos) << small.err;
    EXPECT_EQ(run_command("mesh info " + mesh + " --memory -1").code, 2);
    // Allocations beyond any estimate also end with a message.
    const Scratch scratch;
    const auto large = run_command("mesh make vase " + (scratch / "v.ply").string() + " --vertices 2000000 --memory 0.1");
    EXPECT_EQ(large.code, 1) << large.out;
    EXPECT_NE(large.err.find("memory"), std::string::npos) << large.err;
    EXPECT_EQ(count_files(scratch.path()), 0U);
}

TEST(CommandLine, StopsOnASignalAndLeavesNoFiles) {
    const Scratch scratch;
    const std::string mesh = (scratch / "v.ply").string();
    ASSERT_EQ(run_command("mesh make vase " + mesh + " --vertices 300000").code, 0);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        ChildProcess command({OSTRAKA_COMMAND, "mesh", "remesh", mesh, (scratch / "out.ply").string(), "--vertices", "250000"},
                             {.output = scratch / "printed", .errors = scratch / "printed"});
        const Stopwatch clock;
        ASSERT_FALSE(command.wait([&] { return clock.seconds() > 1; })) << "it was over too soon";
        command.signal(signal);
        const Stopwatch since;
        ASSERT_TRUE(command.wait([&] { return since.seconds() > 60; })) << "it did not stop";
        EXPECT_EQ(command.code(), 130) << read_file(scratch / "printed");
        EXPECT_NE(read_file(scratch / "printed").find("cancelled"), std::string::npos);
        EXPECT_EQ(count_files(scratch.path()), 2U) << "the mesh, and what was printed";
    }
}

}  // namespace
}  // namespace ostraka

// Child processes: input, output, exit code and termination.
#include "ostraka/execution/child_process.h"
#include "ostraka/core/error.h"
#include "ostraka/core/stopwatch.h"
#include "scratch.h"

#include <unistd.h>

#include <csignal>

using namespace ostraka;
using namespace ostraka::test;

namespace {

std::vector<std::string> shell(const std::string& line) { return {"sh", "-c", line}; }
const auto never = [] { return false; };

}  // namespace

TEST(ChildProcess, PrintsToFilesAndReportsHowItEnded) {
    const Scratch scratch;
    ChildProcess process(shell("pwd; echo $OMP_NUM_THREADS; echo wrong >&2; exit 3"),
                         {.folder = scratch.path(), .output = scratch / "out", .errors = scratch / "err", .threads = 7});
    EXPECT_TRUE(process.wait(never));
    EXPECT_EQ(process.code(), 3);
    EXPECT_EQ(process.ending(), "ended with code 3");
    EXPECT_EQ(read_file(scratch / "out"), std::filesystem::canonical(scratch.path()).string() + "\n7\n");
    EXPECT_EQ(read_file(scratch / "err"), "wrong\n");
    ChildProcess both(shell("echo 1; echo 2 >&2; echo 3"), {.output = scratch / "both", .errors = scratch / "both"});
    EXPECT_TRUE(both.wait(never));
    EXPECT_EQ(read_file(scratch / "both"), "1\n2\n3\n");
}

TEST(ChildProcess, EndsWithAllThatItStarted) {
    const Scratch scratch;
    const Stopwatch clock;
    {
        ChildProcess process(shell("sleep 60 & echo $! > started; wait"), {.folder = scratch.path()});
        EXPECT_FALSE(process.wait([&] { return file_exists(scratch / "started") && !read_file(scratch / "started").empty(); }));
    }
    const pid_t started = std::stoi(read_file(scratch / "started"));
    while (::kill(started, 0) == 0 && clock.seconds() < 30) {
        // A killed process without a wait still exists as a zombie: it does not count as running.
        const std::string state = read_file("/proc/" + std::to_string(started) + "/stat");
        if (state.find(") Z") != std::string::npos) break;
    }
    EXPECT_LT(clock.seconds(), 30);
    ChildProcess other(shell("kill -SEGV $$"), {});
    EXPECT_TRUE(other.wait(never));
    EXPECT_EQ(other.code(), 128 + SIGSEGV);
    EXPECT_EQ(other.ending(), "ended by signal 11");
}

TEST(ChildProcess, ReadsAndPrintsThroughPipes) {
    ChildProcess process({"cat"}, {.pipes = true});
    ASSERT_EQ(::write(process.to(), "pot\n", 4), 4);
    process.close_input();
    char text[8] = {};
    EXPECT_EQ(::read(process.from(), text, sizeof text), 4);
    EXPECT_STREQ(text, "pot\n");
    EXPECT_TRUE(process.wait(never));
    EXPECT_EQ(process.code(), 0);
}

TEST(ChildProcess, ProgramsThatCannotBeStartedAreRefused) {
    const Scratch scratch;
    const auto refuse = [](const std::vector<std::string>& words, const ChildOptions& options) {
        try {
            ChildProcess process(words, options);
            ADD_FAILURE() << words.front();
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::failure);
            EXPECT_EQ(error.where(), words.front());
            EXPECT_FALSE(error.remedy().empty());
        }
    };
    refuse({"no-such-program-anywhere"}, {});
    refuse({(scratch / "none").string()}, {.pipes = true});
    refuse({scratch.path().string()}, {});
    refuse({"true"}, {.folder = scratch / "missing"});
}

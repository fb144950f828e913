// The workbench as a command: which processes see its address, and how it ends.
#include "scratch.h"

#include "ostraka/files/file.h"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// The workbench of a scratch folder, with a desktop whose browser records its arguments.
class Command {
public:
    explicit Command(const Scratch& scratch, const std::string& arguments = {}) {
        const Path browser = scratch.file("xdg-open",
                                          "#!/bin/sh\n"
                                          "printf '%s\\n' \"$@\" >" +
                                              (scratch / "arguments").string() + "\nstat -c %a \"$1\" >" +
                                              (scratch / "mode").string() + "\ncp \"$1\" " + (scratch / "copy").string() +
                                              "\nmv " + (scratch / "copy").string() + " " + (scratch / "shown").string() + "\n");
        ::chmod(browser.c_str(), 0755);
        const std::string line = "exec env DISPLAY=:99 PATH=" + scratch.path().string() +
                                 ":$PATH " OSTRAKA_COMMAND " workbench " + scratch.path().string() + " --session " +
                                 (scratch / "session").string() + " " + arguments + " >" + (scratch / "out").string() + " 2>" +
                                 (scratch / "err").string();
        child_ = ::fork();
        if (child_ == 0) {
            ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
            ::_exit(127);
        }
    }
    ~Command() {
        if (child_ > 0) end(SIGKILL);
    }
    Command(const Command&) = delete;
    Command& operator=(const Command&) = delete;

    /// The exit code; -1 if a signal ended it.
    int end(int signal) {
        ::kill(child_, signal);
        int status = 0;
        ::waitpid(std::exchange(child_, 0), &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

private:
    pid_t child_ = 0;
};

bool appears(const Path& file) {
    for (int i = 0; i < 200; ++i) {
        if (file_exists(file) && size_of_file(file) > 0) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
}

}  // namespace

TEST(WorkbenchCommand, GivesTheBrowserNoSecretInItsArguments) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const Scratch scratch;
        const Path door = scratch / "session" / "ostraka-workbench.html";
        Command command(scratch);
        ASSERT_TRUE(appears(scratch / "shown"));
        ASSERT_TRUE(appears(scratch / "out"));
        std::string address = read_file(scratch / "out");
        address.pop_back();
        const std::string token = address.substr(address.find("token=") + 6);
        ASSERT_EQ(token.size(), 64U) << address;
        const std::string arguments = read_file(scratch / "arguments");
        EXPECT_EQ(arguments, door.string() + "\n");
        EXPECT_EQ(read_file(scratch / "mode"), "600\n");
        EXPECT_NE(read_file(scratch / "shown").find("url=" + address + "\""), std::string::npos);
        EXPECT_EQ(command.end(signal), 0);
        EXPECT_FALSE(file_exists(door)) << "after signal " << signal;
    }
}

TEST(WorkbenchCommand, LeavesNoSecretBehindAfterAKill) {
    const Scratch scratch;
    const Path door = scratch / "session" / "ostraka-workbench.html";
    {
        Command command(scratch);
        ASSERT_TRUE(appears(scratch / "shown"));
        command.end(SIGKILL);
    }
    EXPECT_TRUE(file_exists(door)) << "its token is of no use: the server is gone";
    // A link in its place is not followed.
    std::filesystem::remove(door);
    const Path victim = scratch.file("victim", "mine");
    std::filesystem::create_symlink(victim, door);
    std::filesystem::remove(scratch / "shown");
    {
        Command command(scratch);
        ASSERT_TRUE(appears(scratch / "shown"));
        EXPECT_EQ(command.end(SIGTERM), 0);
    }
    EXPECT_FALSE(file_exists(door));
    EXPECT_EQ(read_file(victim), "mine");
    std::filesystem::remove(scratch / "out");
    Command command(scratch, "--no-browser");
    ASSERT_TRUE(appears(scratch / "out"));
    EXPECT_FALSE(file_exists(door));
    EXPECT_EQ(command.end(SIGTERM), 0);
}

// Names from files never leave a folder; secrets are readable by their owner only; no temporary files remain after an abort.
#include "ostraka/files/safe_path.h"
#include "ostraka/core/error.h"
#include "ostraka/core/memory.h"
#include "ostraka/core/progress.h"
#include "ostraka/files/json.h"
#include "scratch.h"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <thread>

using namespace ostraka;
using namespace ostraka::test;

TEST(SafePath, NamesStayInTheirFolder) {
    const Scratch scratch, outside;
    std::filesystem::create_directories(scratch / "in/deep");
    write_file(scratch / "in/file.txt", "");
    write_file(scratch / "beside.txt", "");
    std::filesystem::create_symlink(scratch / "in/file.txt", scratch / "in/own-link");
    std::filesystem::create_symlink(outside.path(), scratch / "in/link");
    std::filesystem::create_symlink("circle", scratch / "in/circle");
    const auto inside = [&](const std::string& name) {
        return file_inside(name, scratch / "in", "where.json", "/at", "the folder", "mend it");
    };
    for (const char* name : {"file.txt", "./file.txt", "deep/../file.txt", "not-yet/there.txt", "own-link", ".", "deep/"})
        EXPECT_NO_THROW(inside(name)) << name;
    for (const std::string& name : {std::string("../beside.txt"), std::string("deep/../../beside.txt"), std::string("link/x"),
                                    std::string("link"), std::string("/etc/passwd"), std::string(), std::string("a\0b", 3),
                                    std::string("circle"), (scratch / "in/file.txt").string()}) {
        try {
            inside(name);
            ADD_FAILURE() << name;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input);
            EXPECT_EQ(error.where(), "where.json");
            EXPECT_NE(error.problem().find("/at"), std::string::npos) << error.what();
        }
    }
    EXPECT_TRUE(is_inside(scratch / "in", scratch / "in"));
    EXPECT_TRUE(is_inside(scratch / "in/none/at/all", scratch / "in"));
    EXPECT_FALSE(is_inside(scratch / "inn", scratch / "in")) << "a name that begins alike";
    EXPECT_FALSE(is_inside(scratch.path(), scratch / "in"));
    EXPECT_TRUE(is_inside_any(outside / "x", {scratch.path(), outside.path()}));
    EXPECT_FALSE(is_inside_any(outside / "x", {}));
}

TEST(SafePath, PlainNamesAreOneComponent) {
    for (const char* name : {"a", "a.ply", ".hidden", "a b", "-x", "é"})
        EXPECT_NO_THROW(require_plain_name(name, "f", "/a")) << name;
    for (const char* name : {"", ".", "..", "a/b", "/a", "a\\b", "a\nb", "\x1b[31m"})
        EXPECT_THROW(require_plain_name(name, "f", "/a"), Error) << name;
}

TEST(SafePath, NothingIsWrittenThroughALinkOutOfTheFolder) {
    const Scratch scratch, outside;
    std::filesystem::create_symlink(outside / "new.txt", scratch / "link");
    std::filesystem::create_symlink("/dev/null", scratch / "device");
    ASSERT_EQ(::mkfifo((scratch / "pipe").c_str(), 0600), 0);
    EXPECT_NO_THROW(require_writable_inside(scratch / "file", scratch.path()));
    for (const char* name : {"link", "device", "pipe"})
        EXPECT_THROW(require_writable_inside(scratch / name, scratch.path()), Error) << name;
}

TEST(Json, ParsesOnlyTheGivenText) {
    EXPECT_THROW(parse_json(std::string_view("{}\0{\"a\": 1}", 11), "f"), Error);
    EXPECT_THROW(parse_json(std::string_view("{\"a\": \"b\0c\"}", 12), "f"), Error);
    EXPECT_THROW(parse_json(std::string_view("[1, 2]\0", 7), "f"), Error);
    EXPECT_NO_THROW(parse_json(R"({"a": "\u0000"})", "f")) << "an escaped one is a character of a text";
}

TEST(WriteFile, SecretsAreReadableByTheOwnerOnly) {
    const Scratch scratch;
    const auto rights = [](const Path& file) {
        struct stat status {};
        EXPECT_EQ(::stat(file.c_str(), &status), 0);
        return status.st_mode & 0777U;
    };
    write_file(scratch / "secret", "x", FileAccess::owner_only);
    EXPECT_EQ(rights(scratch / "secret"), 0600U);
    write_file(scratch / "known", "x");
    std::filesystem::permissions(scratch / "known", std::filesystem::perms(0664));
    write_file(scratch / "known", "y");
    EXPECT_EQ(rights(scratch / "known"), 0664U) << "as before";
    write_file(scratch / "known", "z", FileAccess::owner_only);
    EXPECT_EQ(rights(scratch / "known"), 0600U);
}

TEST(WriteFile, NeverChangesTheUmask) {
    const Scratch scratch;
    const mode_t before = ::umask(027);
    std::atomic<bool> ends{false};
    std::atomic<std::size_t> wrong{0};
    std::thread looker([&] {
        while (!ends) {
            std::ifstream status("/proc/self/status");
            for (std::string line; std::getline(status, line);)
                if (line.starts_with("Umask:") && line.find("0027") == std::string::npos) ++wrong;
        }
    });
    std::vector<std::thread> writers;
    for (int t = 0; t < 3; ++t)
        writers.emplace_back([&, t] {
            for (int i = 0; i < 40; ++i) {
                const Path file = scratch / (std::to_string(t) + "-" + std::to_string(i));
                write_file(file, "x");
                struct stat status {};
                if (::stat(file.c_str(), &status) != 0 || (status.st_mode & 0777U) != 0640U) ++wrong;
            }
        });
    for (std::thread& writer : writers) writer.join();
    ends = true;
    looker.join();
    ::umask(before);
    EXPECT_EQ(wrong, 0U);
}

TEST(ScratchFolder, IsRemovedWithItsContents) {
    Path path;
    {
        const ScratchFolder folder("test"), other("test");
        path = folder.path();
        EXPECT_NE(path, other.path());
        EXPECT_EQ(std::filesystem::status(path).permissions(), std::filesystem::perms::owner_all);
        write_file(path / "file", "x");
    }
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(AbandonOutputs, RemovesAllTemporaryFiles) {
    const Scratch scratch;
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        const ScratchFolder folder("test");
        write_file(scratch / "where", folder.path().string());
        OutputTransaction transaction;
        make_folder(scratch / "made/deep");
        write_file(scratch / "made/deep/waits", "x");
        write_file(scratch / "waits", "x");
        AtomicFile open(scratch / "open");
        open.write("half");
        abandon_outputs();
        bool is_refused = false;
        try {
            const AtomicFile late(scratch / "late");
        } catch (const Error&) {
            is_refused = true;
        }
        std::_Exit(is_refused ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(WEXITSTATUS(status), 0);
    EXPECT_FALSE(std::filesystem::exists(read_file(scratch / "where")));
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(scratch.path()))
        names.push_back(entry.path().filename().string());
    EXPECT_EQ(names, std::vector<std::string>{"where"});
}

TEST(RequireMemory, RefusesWithAMessage) {
    Watch watch;
    watch.memory_limit = 1e12;
    const WatchScope scope(&watch);
    EXPECT_NO_THROW(require_memory(1e9, "the work", "use less"));
    try {
        require_memory(2e12, "the work", "use less");
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_NE(error.problem().find("the work needs about 2000 GB"), std::string::npos) << error.what();
        EXPECT_NE(error.problem().find("--memory"), std::string::npos) << error.what();
        EXPECT_EQ(error.remedy(), "use less");
    }
    EXPECT_GT(resident_memory(), 0);
}

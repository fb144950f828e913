#include "ostraka/files/file.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/transaction.h"

#include "scratch.h"

#include <sys/stat.h>
#include <unistd.h>

#include <csignal>

using namespace ostraka;
using ostraka::test::Scratch;

TEST(AtomicFile, AppearsWhenCompleteAndIsRemovedOtherwise) {
    const Scratch scratch;
    const Path earlier = scratch.file("a.txt", "earlier");
    {
        AtomicFile output(earlier);
        output.write("half");
    }
    EXPECT_EQ(read_file(earlier), "earlier");
    EXPECT_EQ(test::count_files(scratch.path()), 1U);
    write_file(earlier, "later");
    EXPECT_EQ(read_file(earlier), "later");
    EXPECT_EQ(test::count_files(scratch.path()), 1U);
}

TEST(AtomicFile, FollowsLinksAndWritesToDevices) {
    const Scratch scratch;
    const Path real = scratch.file("real.txt", "1");
    std::filesystem::create_symlink(real, scratch / "link.txt");
    write_file(scratch / "link.txt", "2");
    EXPECT_TRUE(std::filesystem::is_symlink(scratch / "link.txt"));
    EXPECT_EQ(read_file(real), "2");
    write_file("/dev/null", "3");
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
    std::filesystem::create_symlink("/dev/full", scratch / "full.txt");
    EXPECT_THROW(write_file(scratch / "full.txt", std::string(100000, 'x')), Error);
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST(AtomicFile, AcceptsTheLongestNameAndFollowsDanglingLinks) {
    const Scratch scratch;
    const Path longest = scratch / std::string(255, 'n');
    write_file(longest, "1");
    EXPECT_EQ(read_file(longest), "1");
    std::filesystem::create_symlink("not-yet.txt", scratch / "link.txt");
    write_file(scratch / "link.txt", "2");
    EXPECT_TRUE(std::filesystem::is_symlink(scratch / "link.txt"));
    EXPECT_EQ(read_file(scratch / "not-yet.txt"), "2");
}

TEST(OutputTransaction, ShowsAllFilesOrNone) {
    const Scratch scratch;
    const Path earlier = scratch.file("a.txt", "earlier");
    {
        const OutputTransaction outputs;
        write_file(earlier, "later");
        write_file(scratch / "b.txt", "new");
        EXPECT_THROW(write_file(scratch / "none" / "c.txt", "x"), Error);
    }
    EXPECT_EQ(read_file(earlier), "earlier");
    EXPECT_EQ(test::count_files(scratch.path()), 1U);
    {
        OutputTransaction outputs;
        write_file(earlier, "later");
        write_file(scratch / "b.txt", "new");
        EXPECT_EQ(read_file(earlier), "earlier");
        outputs.commit();
    }
    EXPECT_EQ(read_file(earlier), "later");
    EXPECT_EQ(read_file(scratch / "b.txt"), "new");
    EXPECT_EQ(test::count_files(scratch.path()), 2U);
}

TEST(OutputTransaction, OldFilesAreRestoredIfOneCannotBeReplaced) {
    const test::Scratch folder;
    const Path first = folder / "first", fresh = folder / "fresh", last = folder / "last";
    const Path memory_file = "memory:held";
    write_file(first, "old");
    write_file(memory_file, "old");
    {
        OutputTransaction outputs;
        write_file(memory_file, "new");
        write_file(first, "new");
        write_file(fresh, "new");
        write_file(last, "new");
        std::filesystem::create_directory(last);  // meanwhile
        EXPECT_THROW(outputs.commit(), Error);
    }
    EXPECT_EQ(read_file(first), "old");
    EXPECT_EQ(read_file(memory_file), "old");
    remove_memory_files(memory_file);
    EXPECT_FALSE(std::filesystem::exists(fresh));
    EXPECT_EQ(test::count_files(folder.path()), 2U) << "nothing waits beside them";
}

TEST(OutputTransaction, CreatedFoldersAreRemovedWithTheirFiles) {
    const test::Scratch folder;
    const Path outer = folder / "outer", inner = outer / "inner";
    {
        const OutputTransaction broken;
        make_folder(inner);
        write_file(inner / "x", "x");
    }
    EXPECT_FALSE(std::filesystem::exists(outer));
    OutputTransaction whole;
    make_folder(inner);
    whole.commit();
    EXPECT_TRUE(std::filesystem::exists(inner)) << "made, and meant to be empty";
}

TEST(OutputTransaction, IncludesFilesWrittenByParallelLoops) {
    const Scratch scratch;
    const auto write_all = [&] {
        parallel_for(8, 1, [&](std::size_t i) { write_file(scratch / (std::to_string(i) + ".txt"), "new"); });
    };
    {
        const OutputTransaction broken;
        write_all();
        EXPECT_FALSE(std::filesystem::exists(scratch / "0.txt"));
    }
    EXPECT_EQ(test::count_files(scratch.path()), 0U);
    OutputTransaction all;
    write_all();
    all.commit();
    EXPECT_EQ(test::count_files(scratch.path()), 8U);
}

namespace {

void write_outputs(const Path& folder, const std::vector<std::pair<std::string, std::string>>& files,
                   const std::string& owner = "test") {
    OutputTransaction all;
    replace_outputs(folder, owner);
    for (const auto& [name, bytes] : files) write_file(folder / name, bytes);
    all.commit();
}

}  // namespace

TEST(ReplaceOutputs, KeepsFilesOfTheLastRunAndOfOthers) {
    const Scratch scratch;
    (void)scratch.file("own.txt", "of the user");
    write_outputs(scratch.path(), {{"a.svg", "1"}, {"b.svg", "2"}, {"edited.csv", "3"}, {"c.csv", "4"}, {"link.svg", "5"}});
    write_outputs(scratch.path(), {{"other.csv", "6"}}, "another");
    (void)scratch.file("edited.csv", "3, and a remark");
    std::filesystem::remove(scratch / "link.svg");
    std::filesystem::create_symlink(scratch / "own.txt", scratch / "link.svg");
    write_outputs(scratch.path(), {{"a.png", "1"}, {"c.csv", "5"}});
    for (const char* gone : {"a.svg", "b.svg"}) EXPECT_FALSE(std::filesystem::exists(scratch / gone)) << gone;
    for (const char* name : {"own.txt", "edited.csv", "other.csv", "a.png", "c.csv", "link.svg"})
        EXPECT_TRUE(std::filesystem::exists(scratch / name)) << name;
    EXPECT_EQ(read_file(scratch / "c.csv"), "5");
    EXPECT_EQ(read_file(scratch / ".test.outputs"), sha256("1") + "  a.png\n" + sha256("5") + "  c.csv\n");
    // A file that was changed once belongs to the user from then on.
    write_outputs(scratch.path(), {});
    EXPECT_TRUE(std::filesystem::exists(scratch / "edited.csv"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "a.png"));
}

TEST(ReplaceOutputs, LeavesInputs) {
    const Scratch scratch;
    write_outputs(scratch.path(), {{"a.ply", "1"}, {"b.ply", "2"}});
    {
        const ProtectedInputs protection({scratch.path() / "." / "a.ply"});
        write_outputs(scratch.path(), {{"c.ply", "3"}});
    }
    EXPECT_TRUE(std::filesystem::exists(scratch / "a.ply"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "b.ply"));
    // A file that was an input once belongs to the user from then on.
    write_outputs(scratch.path(), {});
    EXPECT_TRUE(std::filesystem::exists(scratch / "a.ply"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "c.ply"));
}

TEST(ReplaceOutputs, RemovesNothingBeforeAllFilesAreWritten) {
    const Scratch scratch;
    write_outputs(scratch.path(), {{"a.svg", "1"}});
    {
        const OutputTransaction broken;
        replace_outputs(scratch.path(), "test");
        write_file(scratch / "b.svg", "2");
    }
    EXPECT_EQ(read_file(scratch / "a.svg"), "1");
    EXPECT_FALSE(std::filesystem::exists(scratch / "b.svg"));
    // The next run completes one that was killed between the two.
    (void)scratch.file("b.svg", "2");
    (void)scratch.file(".test.outputs", sha256("2") + "  b.svg\n" + sha256("1") + "  a.svg\n");
    write_outputs(scratch.path(), {{"b.svg", "2"}});
    EXPECT_FALSE(std::filesystem::exists(scratch / "a.svg"));
    EXPECT_THROW(replace_outputs(scratch.path(), "test"), std::logic_error);
}

TEST(ReplaceOutputs, AForgedListAffectsNoOtherFolder) {
    const Scratch scratch;
    std::filesystem::create_directories(scratch / "out" / "sub");
    const Path outside = scratch.file("outside.txt", "x"), within = scratch.file("out/sub/within.txt", "x");
    const std::string sum = sha256("x");
    (void)scratch.file("out/.test.outputs", sum + "  ../outside.txt\n" + sum + "  sub/within.txt\n" + sum + "  " +
                                                outside.string() + "\nnonsense\n" + sum + "  ..\n" + sum + "\n");
    write_outputs(scratch / "out", {{"a.csv", "1"}});
    EXPECT_TRUE(std::filesystem::exists(outside));
    EXPECT_TRUE(std::filesystem::exists(within));
}

TEST(RemoveStaleTemporaries, RemovesOldFilesOnly) {
    const Scratch scratch;
    const auto now = std::filesystem::file_time_type::clock::now();
    const auto file = [&](const std::string& name, int hours) {
        (void)scratch.file(name, "x");
        std::filesystem::last_write_time(scratch / name, now - std::chrono::hours(hours));
    };
    file(".ostraka-AbC123", 30);
    file(".ostraka-young1", 2);
    file(".ostraka-longer7", 30);
    file("ostraka-AbC123", 30);
    file("kept.json", 30);
    std::filesystem::create_directory(scratch / ".ostraka-folder");
    EXPECT_EQ(remove_stale_temporaries(scratch.path()), 1U);
    EXPECT_FALSE(std::filesystem::exists(scratch / ".ostraka-AbC123"));
    EXPECT_EQ(test::count_files(scratch.path()), 5U);
    EXPECT_EQ(remove_stale_temporaries(scratch / "nowhere"), 0U);
}

TEST(RemoveStaleTemporaries, RemovesFilesOfKilledProcessesImmediately) {
    const Scratch scratch;
    const auto names = [&] {
        std::vector<std::string> list;
        for (const auto& name : files_in(scratch.path()))
            if (name.starts_with(".ostraka-")) list.push_back(name);
        return list;
    };
    // A file that is being written, and one that waits for its transaction, are kept.
    {
        OutputTransaction waiting;
        write_file(scratch / "waits.txt", "x");
        AtomicFile open(scratch / "open.txt");
        open.write("x");
        EXPECT_EQ(names().size(), 2U);
        EXPECT_EQ(remove_stale_temporaries(scratch.path()), 0U);
        EXPECT_EQ(names().size(), 2U);
        open.commit();
        waiting.commit();
    }
    EXPECT_EQ(read_file(scratch / "waits.txt") + read_file(scratch / "open.txt"), "xx");
    EXPECT_TRUE(names().empty());
    // A process that is killed during the work leaves two files.
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        OutputTransaction waiting;
        write_file(scratch / "a.txt", "half");
        AtomicFile open(scratch / "b.txt");
        open.write("half");
        ::kill(::getpid(), SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(names().size(), 2U);
    // The next run that writes to the folder removes them.
    ASSERT_EQ(test::run_command("mesh make sphere " + (scratch / "s.ply").string() + " --vertices 500 --quiet").code, 0);
    EXPECT_TRUE(names().empty());
    EXPECT_EQ(remove_stale_temporaries(scratch.path()), 0U);
}

TEST(AtomicFile, ManyFilesCanBePendingAtOnce) {
    const Scratch scratch;
    {
        OutputTransaction waiting;
        for (int i = 0; i < 400; ++i) write_file(scratch / (std::to_string(i) + ".txt"), "x");
        EXPECT_EQ(remove_stale_temporaries(scratch.path()), 0U);
        EXPECT_EQ(test::count_files(scratch.path()), 400U);
        waiting.commit();
    }
    EXPECT_EQ(test::count_files(scratch.path()), 400U);
    EXPECT_EQ(read_file(scratch / "399.txt"), "x");
}

TEST(AtomicFile, RefusesFoldersAndMissingFolders) {
    const Scratch scratch;
    EXPECT_THROW(write_file(scratch.path(), "x"), Error);
    EXPECT_THROW(write_file(scratch / "none" / "a.txt", "x"), Error);
}

TEST(CheckOutputs, ResolvesLinksAndSpellings) {
    const Scratch scratch;
    const Path input = scratch.file("in.ply", "x");
    std::filesystem::create_hard_link(input, scratch / "hard.ply");
    std::filesystem::create_symlink(input, scratch / "soft.ply");
    for (const char* name : {"in.ply", "./in.ply", "hard.ply", "soft.ply"})
        EXPECT_THROW(check_outputs({input}, {scratch / name}), Error) << name;
    EXPECT_THROW(check_outputs({input}, {scratch / "a.ply", scratch / "./a.ply"}), Error);
    EXPECT_THROW(check_outputs({input}, {scratch / "none" / "a.ply"}), Error);
    EXPECT_THROW(check_outputs({input}, {scratch.path()}), Error);
    EXPECT_NO_THROW(check_outputs({input, {}}, {scratch / "a.ply", {}, {}}));
}

TEST(ReadFile, ReturnsAllBytesOrReportsTheReason) {
    const Scratch scratch;
    const std::string bytes("a\0b\n", 4);
    EXPECT_EQ(read_file(scratch.file("a", bytes)), bytes);
    EXPECT_THROW(read_file(scratch / "missing"), Error);
    EXPECT_THROW(read_file(scratch.path()), Error);
    EXPECT_THROW(read_file("/dev/zero"), Error);
}

TEST(ReadFile, InputsAreRegularFiles) {
    const Scratch scratch;
    const Path pipe = scratch / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    for (const Path& file : {pipe, Path("/dev/zero"), Path("/dev/null"), scratch.path(), scratch / "none"}) {
        EXPECT_THROW((void)read_file(file), Error) << file;
        EXPECT_THROW((void)sha256_of_file(file), Error) << file;
    }
    const Path link = scratch / "link";
    std::filesystem::create_symlink(scratch.file("a.txt", "text"), link);
    EXPECT_EQ(read_file(link), "text");
    EXPECT_EQ(sha256_of_file(link), sha256("text"));
}

TEST(Text, ControlCharactersAreC0C1AndBidirectional) {
    EXPECT_EQ(without_controls("a\x1B\x7F\xC2\x80\xC2\x9F\xE2\x80\xAA\xE2\x80\xAE\xE2\x81\xA6\xE2\x81\xA9z", "?"), "a????????z");
    const std::string plain = "na\xC3\xAFve \xC2\xA0\xE2\x80\xA9\xE2\x80\xAF\xE2\x81\xA5\xE2\x81\xAA \xF0\x9F\x8F\xBA";
    EXPECT_EQ(without_controls(plain, "?"), plain);
    const std::string broken = "\xC2 \x9B \xE2\x80";
    EXPECT_EQ(without_controls(broken, "?"), broken) << "bytes that are no characters stay";
    EXPECT_EQ(character_at("\xF0\x9F\x8F\xBA", 0).code, U'\U0001F3FA');
}

TEST(Sha256, MatchesThePublishedVectors) {
    // FIPS 180-4 examples.
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    const Scratch scratch;
    EXPECT_EQ(sha256_of_file(scratch.file("a", "abc")), sha256("abc"));
    EXPECT_THROW(sha256_of_file(scratch / "missing"), Error);
}

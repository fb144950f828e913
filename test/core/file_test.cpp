#include "ostraka/core/file.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"

#include "scratch.h"

#include <sys/stat.h>

using namespace ostraka;
using ostraka::test::Scratch;

TEST(AtomicFile, AppearsWhenCompleteAndLeavesNothingOtherwise) {
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

TEST(AtomicFile, TakesTheLongestNameAndFollowsLinksToNothing) {
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

TEST(AtomicFile, RefusesFoldersAndMissingFolders) {
    const Scratch scratch;
    EXPECT_THROW(write_file(scratch.path(), "x"), Error);
    EXPECT_THROW(write_file(scratch / "none" / "a.txt", "x"), Error);
}

TEST(CheckOutputs, SeesThroughLinksAndSpellings) {
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

TEST(ReadFile, GivesAllBytesOrSaysWhyNot) {
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

TEST(Text, ControlCharactersAreC0C1AndTurnsOfDirection) {
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

// doc/tour.md, run in order in a fresh folder: the output of each block of commands (sh) is the following block (text). There a
// line "..." stands for one or more omitted lines, and a line that ends in "..." is compared up to that point.
#include "scratch.h"

#include <algorithm>
#include <cstdlib>
#include <span>
#include <sstream>
#include <vector>

namespace ostraka::test {
namespace {

using Lines = std::vector<std::string>;

/// Without blanks at the ends of lines and without empty lines at the end.
Lines lines_of(const std::string& text) {
    Lines lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line.substr(0, line.find_last_not_of(' ') + 1));
    while (!lines.empty() && lines.back().empty()) lines.pop_back();
    return lines;
}

bool is_shortened(const std::string& line) { return line.ends_with("..."); }

bool line_is(const std::string& shown, const std::string& printed) {
    return is_shortened(shown) ? printed.starts_with(shown.substr(0, shown.size() - 3)) : printed == shown;
}

bool page_shows(std::span<const std::string> shown, std::span<const std::string> printed) {
    if (shown.empty()) return printed.empty();
    if (shown.front() == "...") {
        for (std::size_t left_out = 1; left_out <= printed.size(); ++left_out)
            if (page_shows(shown.subspan(1), printed.subspan(left_out))) return true;
        return false;
    }
    return !printed.empty() && line_is(shown.front(), printed.front()) && page_shows(shown.subspan(1), printed.subspan(1));
}

struct Step {
    std::size_t line;  ///< line of the page where its commands begin
    std::string commands, shown;
};

/// The steps of a page; the test fails if a block of commands is not followed by its output.
std::vector<Step> steps_of(const std::string& page) {
    std::vector<Step> steps;
    std::istringstream in(page);
    std::string fence, block;
    bool awaits_output = false;
    std::size_t number = 0, begin = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        if (!line.starts_with("```")) {
            if (!fence.empty()) block += line + "\n";
        } else if (fence.empty()) {
            fence = line;
            block.clear();
            begin = number + 1;
        } else {
            EXPECT_EQ(fence == "```text", awaits_output) << "line " << begin << ": commands and what they print stand in pairs";
            EXPECT_TRUE(fence == "```sh" || fence == "```text") << "line " << begin;
            if (fence == "```sh") steps.push_back({begin, block, {}});
            else if (!steps.empty()) steps.back().shown = block;
            awaits_output = fence == "```sh";
            fence.clear();
        }
    }
    EXPECT_TRUE(fence.empty() && !awaits_output) << "the last block";
    return steps;
}

TEST(Tour, ComparisonDetectsDeviations) {
    const auto shows = [](const std::string& shown, const std::string& printed) {
        return page_shows(lines_of(shown), lines_of(printed));
    };
    EXPECT_TRUE(shows("a\nb 1\n", "a\nb 1\n"));
    EXPECT_TRUE(shows("a\n...\nb 2\n", "a\nb 1\nb 2\n"));
    EXPECT_TRUE(shows("a\n...\n", "a\nb\nc\n"));
    EXPECT_TRUE(shows("a  b ...\n", "a  b  1\n"));
    EXPECT_FALSE(shows("a\nb 1\n", "a\nb 2\n"));
    EXPECT_FALSE(shows("a\n", "a\nb\n"));
    EXPECT_FALSE(shows("a\nb\n", "a\n"));
    EXPECT_FALSE(shows("a\n...\nb 3\n", "a\nb 1\nb 2\n"));
    EXPECT_FALSE(shows("a\n...\nb\n", "a\nb\n"));
    EXPECT_FALSE(shows("a  c...\n", "a  b  1\n"));
}

TEST(Tour, PrintsTheOutputOfThePage) {
    const Path source(OSTRAKA_SOURCE_DIR);
    const std::vector<Step> steps = steps_of(read_file(source / "doc" / "tour.md"));
    ASSERT_GE(steps.size(), 10U);
    const Scratch scratch;
    std::filesystem::create_directory_symlink(source / "data", scratch / "data");
    std::filesystem::create_directory(scratch / "bin");
    std::filesystem::create_symlink(OSTRAKA_COMMAND, scratch / "bin" / "ostraka");
    const std::string run = "cd " + scratch.path().string() + " && PATH=$PWD/bin:$PATH bash -eo pipefail commands >out 2>err";
    for (const Step& step : steps) {
        const Lines shown = lines_of(step.shown);
        EXPECT_FALSE(std::all_of(shown.begin(), shown.end(), [](const std::string& line) { return line == "..."; }))
            << "doc/tour.md:" << step.line << ": no line of the output is shown";
        write_file(scratch / "commands", step.commands);
        ASSERT_EQ(std::system(run.c_str()), 0) << "doc/tour.md:" << step.line << ":\n"
                                               << step.commands << read_file(scratch / "err");
        const std::string printed = read_file(scratch / "out");
        EXPECT_TRUE(page_shows(shown, lines_of(printed))) << "doc/tour.md:" << step.line << ":\n"
                                                          << step.commands << "prints\n"
                                                          << printed << "and the page says\n"
                                                          << step.shown;
    }
}

}  // namespace
}  // namespace ostraka::test

// README.md and the pages in doc/: their link targets and named files exist.
#include "scratch.h"

#include <regex>

namespace ostraka::test {
namespace {

std::vector<Path> pages() {
    const Path source(OSTRAKA_SOURCE_DIR);
    std::vector<Path> result = {source / "README.md"};
    for (const Path& folder : {source / "doc", source / "doc" / "commands"})
        for (const std::string& name : files_in(folder))
            if (name.ends_with(".md")) result.push_back(folder / name);
    return result;
}

/// Matches of the first group of the pattern in the text.
std::vector<std::string> all_matches(const std::string& text, const std::string& pattern) {
    std::vector<std::string> matches;
    const std::regex expression(pattern);
    for (std::sregex_iterator i(text.begin(), text.end(), expression), end; i != end; ++i) matches.push_back((*i)[1].str());
    return matches;
}

TEST(Pages, LinksResolve) {
    std::size_t count = 0;
    for (const Path& page : pages())
        for (const std::string& target : all_matches(read_file(page), R"(\]\(([^)#:\s]+)\))")) {
            EXPECT_TRUE(std::filesystem::exists(page.parent_path() / target)) << page.filename() << " links to " << target;
            ++count;
        }
    EXPECT_GT(count, 50U);
}

TEST(Pages, NamedFilesExist) {
    const Path source(OSTRAKA_SOURCE_DIR);
    std::size_t count = 0;
    for (const Path& page : pages()) {
        const std::string text = read_file(page);
        for (const std::string& name : all_matches(text, R"(`((?:apps|data|doc|scripts|src|test)/[A-Za-z0-9_./-]+)[` ])")) {
            EXPECT_TRUE(std::filesystem::exists(source / name)) << page.filename() << " names " << name;
            ++count;
        }
        for (const std::string& name : all_matches(text, R"([`"<](?:ostraka/)?([a-z_]+/[a-z_0-9]+\.h)[`">])")) {
            EXPECT_TRUE(std::filesystem::exists(source / "include" / "ostraka" / name)) << page.filename() << " names " << name;
            ++count;
        }
    }
    EXPECT_GT(count, 50U);
}

}  // namespace
}  // namespace ostraka::test

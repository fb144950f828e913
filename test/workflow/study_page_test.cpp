// The page of a study: markup in texts is escaped.
#include "studies.h"

using namespace ostraka;
using namespace ostraka::test;

TEST(StudyPage, EscapesMarkupInTexts) {
    const Scratch scratch;
    const std::string evil = "<img src=x onerror=alert(1)> [x](javascript:alert(2)) `c` *b*";
    const Path file = scratch.file("a.study.json", study_text_of(R"("title": ")" + evil + R"(", "note": "# )" + evil +
                                                                 R"(\n- item",
        "steps": {"vase": {"operation": "mesh make", "with": {"object": "vase", "vertices": 2500}, "keep": ["output"]},
                  "info": {"operation": "mesh info", "with": {"input": "${vase.output}"}}},
        "tables": {"sizes": {"title": ")" + evil + R"(", "note": ")" +
                                                                 evil + R"(", "rows": "info",
                     "columns": [{"title": ")" + evil + R"(", "value": "result.vertices"}, {"title": "step", "value": "step"}]}},
        "plots": {"curve": {"title": ")" + evil + R"(", "table": "sizes", "x": "step", "y": ")" +
                                                                 evil + R"("}},
        "page": [{"title": ")" + evil + R"(", "text": ")" + evil +
                                                                 R"(", "show": ["sizes", "curve", "vase.output"]}])"));
    const auto result = run_command("run " + file.string() + " --output " + (scratch / "out").string());
    ASSERT_EQ(result.code, 0) << result.err;
    const std::string page = read_file(scratch / "out/page.md");
    for (const char* markup : {"<img", "[x](", " `c`", " *b*", "\n- item", "\n# <", "\n# #"})
        EXPECT_EQ(page.find(markup), std::string::npos) << markup << " in " << page;
    const std::string escaped = "&lt;img src=x onerror=alert(1)&gt; \\[x\\](javascript:alert(2)) \\`c\\` \\*b\\*";
    for (const std::string& place :
         {"# " + escaped + "\n", "\n\\# " + escaped + "\n\\- item\n", "\n## " + escaped + "\n\n" + escaped + "\n",
          "**" + escaped + "**\n\n" + escaped + "\n\n", "| " + escaped + " |", "![" + escaped + "](curve.svg)"})
        EXPECT_NE(page.find(place), std::string::npos) << place << " not in " << page;
    EXPECT_NE(page.find("](<steps/vase/"), std::string::npos) << page;
}

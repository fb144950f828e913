#include "ostraka/figures/table.h"
#include "ostraka/figures/markdown.h"

#include "ostraka/files/csv.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace ostraka {
namespace {

TextTable table() {
    TextTable t({"name", "cv", "n"});
    t.add({"arm/height", "3.1%", "40"});
    t.add({"a|b, \"c\"", "-", "7"});
    return t;
}

TEST(TextTable, AsMarkdown) {
    EXPECT_EQ(table().markdown(), "| name | cv | n |\n|---|---:|---:|\n| arm/height | 3.1% | 40 |\n| a\\|b, \"c\" | - | 7 |\n");
}

TEST(TextTable, AsLatex) {
    EXPECT_EQ(table().latex(),
              "\\begin{tabular}{lrr}\n\\toprule\nname & cv & n \\\\\\relax\n\\midrule\narm/height & 3.1\\% & 40 \\\\\\relax\n"
              "a\\textbar{}b, \\textquotedbl{}c\\textquotedbl{} & - & 7 \\\\\\relax\n\\bottomrule\n\\end{tabular}\n");
    const std::string with_caption = table().latex("50 % of \\all", "tab:x");
    EXPECT_NE(with_caption.find("\\caption{50 \\% of \\textbackslash{}all}"), std::string::npos);
    EXPECT_NE(with_caption.find("\\label{tab:x}"), std::string::npos);
}

TEST(TextTable, AsCsvReadsBack) {
    const std::string text = table().csv();
    const auto rows = csv_rows(text, ',', "table");
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(unescape_formula(rows[2].cells[0]), "a|b, \"c\"");
    EXPECT_EQ(rows[1].cells[1], "3.1%");
}

TEST(TextTable, EscapesMarkupInText) {
    TextTable hostile({"=1+1", "<b>"});
    hostile.add({"=cmd|' /C calc'!A0", "line\nbreak | \\input{/etc/passwd} `x` _a_ <script> 50% $x$ #1 ~ ^ {} -- \x1b[31m"});
    EXPECT_EQ(hostile.csv().find("\n=cmd"), std::string::npos);
    EXPECT_EQ(unescape_formula(csv_rows(hostile.csv(), ',', "table")[0].cells[0]), "=1+1");
    EXPECT_EQ(csv_rows(hostile.csv(), ',', "table")[0].cells[0].front(), '\'') << "no formula";
    const std::string markdown = hostile.markdown(), latex = hostile.latex();
    EXPECT_EQ(markdown.find("<script"), std::string::npos);
    EXPECT_EQ(std::count(markdown.begin(), markdown.end(), '\n'), 3) << "a row is a line";
    EXPECT_EQ(latex.find("\\input"), std::string::npos);
    EXPECT_EQ(latex.find('\x1b'), std::string::npos);
    for (const std::string bare : {" 50%", " $x", " #1", " ~", " ^", " {}", "--"})
        EXPECT_EQ(latex.find(bare), std::string::npos) << bare;
}

TEST(Markdown, EscapesMarkupInText) {
    EXPECT_EQ(markdown_text("<img src=x onerror=alert(1)>"), "&lt;img src=x onerror=alert(1)&gt;");
    EXPECT_EQ(markdown_text("[x](javascript:alert(1)) ![y](z)"), "\\[x\\](javascript:alert(1)) !\\[y\\](z)");
    EXPECT_EQ(markdown_text("&lt;b&gt; `a` *b* _c_ # ~d~ | \\"),
              "&amp;lt;b&amp;gt; \\`a\\` \\*b\\* \\_c\\_ \\# \\~d\\~ \\| \\\\");
    EXPECT_EQ(markdown_text("a\nb\x1b"), "a b ");
    EXPECT_EQ(markdown_paragraphs("one\ntwo\n\nthree"), "one\ntwo\n\nthree");
    EXPECT_EQ(markdown_paragraphs("    code\n- item\n+ item\n1. item\n23) item\n===\n---\n# head\n> quote\n```"),
              "code\n\\- item\n\\+ item\n1\\. item\n23\\) item\n\\===\n\\---\n\\# head\n&gt; quote\n\\`\\`\\`");
    EXPECT_EQ(markdown_paragraphs("2.5 mm, 7\n8."), "2.5 mm, 7\n8\\.");
    EXPECT_EQ(markdown_paragraphs(""), "");
    EXPECT_EQ(markdown_file("steps/a/n=1,s=2/a b (1).ply"), "steps/a/n=1,s=2/a%20b%20%281%29.ply");
    EXPECT_EQ(markdown_file("a>b&c%d#e?f\ng\\"), "a%3Eb%26c%25d%23e%3Ff%0Ag%5C");
}

TEST(TextTable, CsvHasFullPrecisionAndEmptyMissingValues) {
    TextTable t({"name", "mean", "cv", {"interval", {"low", "high"}}});
    t.add({"a", number_cell(1.0 / 3, 4), percent_cell(0.1234567), {"1 to 2", {"1.25", "2"}}});
    t.add({"-", number_cell(std::nullopt, 4), percent_cell(std::nan("")), {"-", {"", ""}}});
    t.add({"c", fixed_cell(-2.0 / 3, 1), percent_cell(-0.5, 0), {"-", {"", ""}}});
    EXPECT_EQ(t.markdown(),
              "| name | mean | cv | interval |\n|---|---:|---:|---|\n| a | 0.3333 | 12.3% | 1 to 2 |\n| - | - | - | - |\n"
              "| c | -0.7 | -50% | - |\n");
    const auto rows = csv_rows(t.csv(), ',', "table");
    EXPECT_EQ(rows[0].cells, (std::vector<std::string>{"name", "mean", "cv", "low", "high"}));
    EXPECT_EQ(rows[1].cells, (std::vector<std::string>{"a", "0.3333333333333333", "0.1234567", "1.25", "2"}));
    EXPECT_EQ(rows[2].cells, (std::vector<std::string>{"'-", "", "", "", ""})) << "a name stays one";
    EXPECT_EQ(std::stod(rows[3].cells[1]), -2.0 / 3);
    EXPECT_EQ(rows[3].cells[2], "-0.5");
    EXPECT_THROW(t.add({"d", "1", "1", "1"}), std::logic_error);
}

TEST(TextTable, IsWrittenInThreeFormats) {
    const test::Scratch scratch;
    table().write(scratch.path(), "t", "caption");
    EXPECT_EQ(read_file(scratch / "t.md"), table().markdown());
    EXPECT_EQ(read_file(scratch / "t.csv"), table().csv());
    EXPECT_EQ(read_file(scratch / "t.tex"), table().latex("caption"));
}

TEST(TextTable, RowsHaveOneCellPerColumn) {
    TextTable t({"a", "b"});
    EXPECT_THROW(t.add({"1"}), std::logic_error);
    EXPECT_EQ(t.markdown(), "| a | b |\n|---|---|\n");
    EXPECT_EQ(t.latex(), "\\begin{tabular}{ll}\n\\toprule\na & b \\\\\\relax\n\\midrule\n\\bottomrule\n\\end{tabular}\n");
}

TEST(TextTable, ForATerminal) {
    EXPECT_EQ(table().plain(), "name          cv   n\narm/height  3.1%  40\na|b, \"c\"       -   7\n");
}

TEST(Numbers, AsText) {
    EXPECT_EQ(fixed(-0.001, 1), "0.0");
    EXPECT_EQ(fixed(-0.06, 1), "-0.1");
    EXPECT_EQ(fixed(1e300, 0).size(), 301u);
    EXPECT_EQ(significant(0.00012345, 3), "0.000123");
    EXPECT_EQ(significant(1234567.0, 3), "1.23e+06");
    EXPECT_EQ(significant(std::optional<double>{}, 3), "-");
    EXPECT_EQ(percent(0.0314), "3.1%");
    EXPECT_EQ(percent(std::nullopt), "-");
}

}  // namespace
}  // namespace ostraka

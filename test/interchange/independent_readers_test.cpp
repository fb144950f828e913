// Written files, read by independent programs.
#include "interchange/attribute_table.h"
#include "ostraka/interchange/landmarks.h"
#include "scratch.h"
#include "sets.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::example;
using ostraka::test::Scratch;

namespace {

bool runs(const std::string& command) { return std::system((command + " > /dev/null 2>&1").c_str()) == 0; }

}  // namespace

TEST(IndependentReaders, XmllintAcceptsPickedPoints) {
    if (!runs("xmllint --version")) GTEST_SKIP() << "xmllint (package libxml2-utils) is not installed";
    const Mesh mesh = spheres(3);
    std::vector<std::string> notes;
    const Scratch scratch;
    const Path file = scratch.file(
        "a.pp", landmarks_to_text(landmarks_of({mesh, wild_set(mesh)}), LandmarkFormat::pp, "m <&>.ply", {}, notes, {}));
    EXPECT_TRUE(runs("xmllint --noout --nonet " + file.string()));
    EXPECT_EQ(std::system(("test \"$(xmllint --xpath 'count(/PickedPoints/point)' " + file.string() +
                           ")\" = " + std::to_string(wild_texts().size() + 3))
                              .c_str()),
              0);
}

TEST(IndependentReaders, PythonReadsTheTable) {
    if (!runs("python3 -c 'import csv, json'")) GTEST_SKIP() << "python3 is not installed";
    const Mesh mesh = spheres(3);
    const AnnotationSet set = wild_set(mesh);
    const Scratch scratch;
    const Path table = scratch.file("a.csv", attribute_table(set));
    // One row per attribute, or per annotation without attributes, all as wide as the header, no cell that begins like a formula.
    std::size_t rows = 1;
    for (const Annotation& annotation : set.annotations) rows += std::max<std::size_t>(annotation.attributes.size(), 1);
    const Path script = scratch.file("check.py", R"(
import csv, io, sys
text = open(sys.argv[1], newline='', encoding='utf-8').read().replace('\0', '')
rows = list(csv.reader(io.StringIO(text, newline='')))
assert len(rows) == int(sys.argv[2]), len(rows)
for row in rows:
    assert len(row) == 21, row
    for cell in row:
        try:
            float(cell)
        except ValueError:
            assert cell.strip(' \t\r\n')[:1] not in tuple('=+-@') or cell == '', cell
)");
    EXPECT_TRUE(runs("python3 " + script.string() + " " + table.string() + " " + std::to_string(rows)));
}

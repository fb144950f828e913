// Information of annotations: texts, links, images, files.
#include "meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/error.h"
#include "scratch.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

AnnotationSet with(std::vector<Information> information) {
    AnnotationSet set;
    Annotation annotation;
    annotation.id = 4;
    annotation.tag = "spout";
    annotation.faces = {0, 1};
    annotation.information = std::move(information);
    set.annotations = {annotation};
    return set;
}

using Kind = Information::Kind;

}  // namespace

TEST(Information, RoundTripIsExact) {
    const Mesh mesh = build_mesh(octahedron_sphere(1));
    const AnnotationSet set = with({{Kind::text, "mended in 1931", "", ""},
                                    {Kind::image, "photos/spout.jpg", "the spout", std::string(64, 'a')},
                                    {Kind::link, "https://example.org/17", "", ""},
                                    {Kind::file, "https://example.org/x.pdf", "report", ""}});
    const Json document = annotations_to_json({mesh, set}, "pot.ply", Provenance{"test", {}, {}});
    const AnnotationSet back = annotations_from_json(document, mesh, "pot.ant.json");
    EXPECT_TRUE(back.notes.empty());
    EXPECT_EQ(back.annotations.at(0).information, set.annotations[0].information);
    EXPECT_FALSE(back.annotations[0].information[3].is_local());
    EXPECT_TRUE(back.annotations[0].information[1].is_local());
}

TEST(Information, LocalFilesAreChecked) {
    const Scratch scratch;
    write_file(scratch / "note.txt", "broken");
    const std::string sum = sha256_of_file(scratch / "note.txt");
    const Mesh mesh = build_mesh(octahedron_sphere(1));
    const auto findings_of = [&](const Information& item) { return check_files({mesh, with({item})}, scratch.path()); };
    EXPECT_TRUE(findings_of({Kind::file, "note.txt", "", sum}).empty());
    EXPECT_TRUE(findings_of({Kind::link, "nowhere", "", ""}).empty());
    EXPECT_TRUE(findings_of({Kind::image, "https://example.org/a.png", "", ""}).empty());
    ASSERT_EQ(findings_of({Kind::file, "note.txt", "", ""}).size(), 1U);
    EXPECT_FALSE(findings_of({Kind::file, "note.txt", "", ""})[0].defect);
    ASSERT_EQ(findings_of({Kind::file, "gone.txt", "", sum}).size(), 1U);
    EXPECT_TRUE(findings_of({Kind::file, "gone.txt", "", sum})[0].defect);
    write_file(scratch / "note.txt", "mended");
    ASSERT_EQ(findings_of({Kind::file, "note.txt", "", sum}).size(), 1U);
    EXPECT_TRUE(findings_of({Kind::file, "note.txt", "", sum})[0].defect);
}

TEST(Information, UnknownKindsAndChecksumsOfLinksAreRefused) {
    const Mesh mesh = build_mesh(octahedron_sphere(1));
    for (const char* entry : {R"({"kind": "song", "value": "la"})", R"({"kind": "text"})",
                              R"({"kind": "link", "value": "https://a.b", "sha256": ")"}) {
        std::string text = entry;
        if (text.back() == '"' && text.find("sha256") != std::string::npos) text += std::string(64, 'a') + "\"}";
        const std::string file =
            R"({"annotations": [{"id": 1, "tag": "a", "type": "point", "points": [0], "information": [)" + text + "]}]}";
        EXPECT_THROW((void)annotations_from_json(parse_json(file, "a"), mesh, "a"), Error) << entry;
    }
}

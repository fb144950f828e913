// Tetrahedral meshes: their surface, and their deformation with it.
#include "meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"
#include "scratch.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// A cube of six tetrahedra about its diagonal, one of them written inside out.
const char* const cube = R"(MeshVersionFormatted 2
# a cube
Dimension 3
Vertices
8
0 0 0 0
1 0 0 0
1 1 0 0
0 1 0 0
0 0 1 0
1 0 1 0
1 1 1 0
0 1 1 0
Triangles 2
1 3 2 7
1 2 6 9
Edges 1
1 2 0
Tetrahedra
6
1 2 3 7 0
1 3 4 7 0
1 4 8 7 0
1 8 5 7 0
1 5 6 7 0
1 2 6 7 0
End
)";

std::string problem_of(const Scratch& scratch, const std::string& name, const std::string& text) {
    try {
        (void)read_mesh(scratch.file(name, text));
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t position = text.find(from);
    EXPECT_NE(position, std::string::npos) << from;
    return text.replace(position, from.size(), to);
}

}  // namespace

TEST(Tetrahedra, HaveTheirSurfaceOutward) {
    const Scratch scratch;
    const MeshFile file = read_mesh(scratch.file("cube.mesh", cube));
    EXPECT_EQ(file.mesh.number_of_vertices(), 8U);
    EXPECT_EQ(file.mesh.number_of_faces(), 12U);
    EXPECT_TRUE(CGAL::is_closed(file.mesh));
    EXPECT_NEAR(volume(file.mesh), 1, 1e-14);
    EXPECT_EQ(file.extras.tetrahedra.size(), 6U);
    // Vertices keep their numbers, and listed triangles their references.
    EXPECT_EQ(file.mesh.point(Vertex(6)), Point(1, 1, 1));
    EXPECT_EQ(std::count(file.extras.face_labels.begin(), file.extras.face_labels.end(), 7), 1);
    EXPECT_EQ(std::count(file.extras.face_labels.begin(), file.extras.face_labels.end(), 9), 1);
    ASSERT_EQ(file.notes.size(), 1U);
    EXPECT_NE(file.notes[0].find("Edges"), std::string::npos);
}

TEST(Tetrahedra, AreTheSameThroughBothFormats) {
    const Scratch scratch;
    const MeshFile file = read_mesh(scratch.file("cube.mesh", cube));
    MeshFile last = file;
    for (const char* name : {"a.vtu", "b.mesh", "c.vtu"}) {
        EXPECT_TRUE(write_mesh(scratch / name, last.mesh, last.extras).empty());
        last = read_mesh(scratch / name);
        EXPECT_EQ(mesh_checksum(last.mesh), mesh_checksum(file.mesh)) << name;
        EXPECT_EQ(last.extras.tetrahedra, file.extras.tetrahedra) << name;
        EXPECT_EQ(last.extras.face_labels, file.extras.face_labels) << name;
    }
    const auto notes = write_mesh(scratch / "d.ply", file.mesh, file.extras);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes[0].find("6 tetrahedra"), std::string::npos);
}

TEST(Tetrahedra, AnnotationsOfTheirSurfaceAreTransferredBothWays) {
    const Scratch scratch;
    const MeshFile file = read_mesh(scratch.file("cube.mesh", cube));
    AnnotationSet set;
    Annotation lid;
    lid.id = 3;
    lid.tag = "lid";
    for (const Face f : file.mesh.faces())
        if (centroid(file.mesh, f).z() > 0.99) lid.faces.push_back(f.idx());
    set.annotations = {lid};
    write_annotations(scratch / "cube.ant.json", {file.mesh, set}, "cube.mesh", Provenance{"test", {}, {}});
    write_mesh(scratch / "cube.ply", file.mesh, file.extras);
    write_mesh(scratch / "cube.vtu", file.mesh, file.extras);
    for (const char* name : {"cube.mesh", "cube.ply", "cube.vtu"})
        EXPECT_EQ(read_annotations(scratch / "cube.ant.json", read_mesh(scratch / name).mesh).annotations.at(0).faces, lid.faces)
            << name;
}

TEST(Tetrahedra, SurfacesAloneAreReadAsWell) {
    const Scratch scratch;
    const MeshFile file = read_mesh(scratch.file(
        "square.mesh",
        "MeshVersionFormatted 1\nDimension\n3\nVertices 4\n0 0 0 1\n1 0 0 1\n1 1 0 1\n0 1 0 1\nQuadrilaterals 1\n1 2 3 4 5\n"));
    EXPECT_EQ(file.mesh.number_of_faces(), 2U);
    EXPECT_EQ(file.polygon_of_triangle, (std::vector<Index>{0, 0}));
    EXPECT_TRUE(file.extras.tetrahedra.empty());
}

TEST(Tetrahedra, DamagedFilesAreRefusedWithAMessage) {
    const Scratch scratch;
    const auto problem_after = [&](const std::string& from, const std::string& to) {
        return problem_of(scratch, "bad.mesh", replaced(cube, from, to));
    };
    EXPECT_NE(problem_after("1 2 6 7 0", "1 2 6 70 0").find("names vertex 69 of 8"), std::string::npos);
    EXPECT_NE(problem_after("1 2 6 7 0", "1 2 2 7 0").find("names a vertex twice"), std::string::npos);
    EXPECT_NE(problem_after("Dimension 3", "Dimension 2").find("not three-dimensional"), std::string::npos);
    EXPECT_NE(problem_after("Vertices\n8", "Vertices\n999999999").find("does not fit"), std::string::npos);
    EXPECT_NE(problem_after("Tetrahedra\n6\n", "Tetrahedra\n7\n").find("bad.mesh, line"), std::string::npos);
    EXPECT_NE(problem_after("1 1 0 0", "1 x 0 0").find("bad.mesh"), std::string::npos);
    EXPECT_NE(problem_of(scratch, "bad.vtu", "<VTKFile>").find("XML"), std::string::npos);
    EXPECT_NE(problem_of(scratch, "bad.vtu", "<VTKFile type=\"PolyData\"/>").find("unstructured"), std::string::npos);
    write_mesh(scratch / "good.vtu", build_mesh(box(1)));
    const std::string good = read_file(scratch / "good.vtu");
    EXPECT_EQ(problem_of(scratch, "bad.vtu", good), "accepted");
    EXPECT_NE(problem_of(scratch, "bad.vtu", replaced(good, "format=\"ascii\"", "format=\"binary\"")).find("ascii"),
              std::string::npos);
    EXPECT_NE(
        problem_of(scratch, "bad.vtu", replaced(good, "\"offsets\" format=\"ascii\">\n3", "\"offsets\" format=\"ascii\">\n999"))
            .find("offsets"),
        std::string::npos);
}

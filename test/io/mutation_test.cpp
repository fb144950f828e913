// Damaged files give a mesh or an error with a message; never a crash, a hang or excessive memory (run under sanitizers).
#include "io_examples.h"
#include "mutate.h"
#include "ostraka/core/error.h"
#include "scratch.h"
#include "three_mf_examples.h"

#include <gtest/gtest.h>
#include <cmath>

using namespace ostraka;
using namespace ostraka::test;

namespace {

std::string big_endian_ply() {
    std::string bytes =
        "ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty float x\nproperty short y\nproperty double z\n"
        "element edge 1\nproperty list uchar int ends\nelement face 2\nproperty list uchar ushort vertex_indices\nproperty uchar "
        "label\nend_header\n";
    for (int v = 0; v < 4; ++v)
        bytes +=
            std::string("\x3f\x80\0\0", 4) + std::string(1, '\0') + static_cast<char>(v) + std::string("\x40\0\0\0\0\0\0\0", 8);
    bytes += std::string("\2\0\0\0\0\0\0\0\1", 9);
    bytes += std::string("\3\0\0\0\1\0\2\7", 8) + std::string("\4\0\0\0\1\0\2\0\3\7", 10);
    return bytes;
}

/// One file of each kind, small enough that a mutation affects relevant bytes.
std::vector<std::pair<std::string, std::string>> base_files() {
    const Scratch scratch;
    const TriangleSoup soup = octahedron();
    std::vector<std::pair<std::string, std::string>> files;
    const auto add_file = [&](const std::string& name, Encoding encoding, const MeshExtras& extras) {
        write_triangles(scratch / name, soup, extras, {encoding, "comment"});
        files.emplace_back(name, read_file(scratch / name));
    };
    add_file("binary.ply", Encoding::binary, full_extras(soup));
    add_file("ascii.ply", Encoding::ascii, full_extras(soup));
    add_file("plain.ply", Encoding::binary, {});
    add_file("full.obj", Encoding::binary, full_extras(soup));
    add_file("full.off", Encoding::binary, full_extras(soup));
    add_file("plain.off", Encoding::binary, {});
    add_file("binary.stl", Encoding::binary, {});
    add_file("ascii.stl", Encoding::ascii, {});
    files.emplace_back("big.ply", big_endian_ply());
    files.emplace_back(
        "images.ply",
        "ply\nformat ascii 1.0\ncomment TextureFile a.png\ncomment TextureFile <this>.jpg\nelement vertex 4\nproperty float X\n"
        "property float Y\nproperty float Z\nproperty float r\nproperty float g\nproperty float b\nproperty float s\n"
        "property float t\nproperty short age\nelement face 2\nproperty list uchar int vertex_indices\n"
        "property list uchar float texcoord\nproperty int texnumber\nproperty double wear\nend_header\n"
        "0 0 0 255 0 0 0 0 1\n1 0 0 0 9 0 0 1 2\n1 1 0 0 0 7 1 1 3\nnan 9 9 9 9 9 9 9 9\n3 0 1 2 6 0 0 1 0 1 1 0 .5\n"
        "3 2 1 0 6 1 1 1 0 0 0 1 .25\n");
    files.emplace_back("model.3mf", zip_of({{"3D/3dmodel.model", coloured_model}}));
    files.emplace_back(
        "strips.ply",
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\n"
        "property list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 -1 2 3 4 0\n");
    files.emplace_back("polygons.obj",
                       "mtllib a.mtl\no thing\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv .4 .5 0\nv 0 1 0 \\\n 1\nvt 0 0\nvt 1 0.5\nvn 0 0 "
                       "1\ng a b\nusemtl red\ns 1\n"
                       "f 1/1/1 2/2/1 3/1/1 4/2/1 5/1/1\nl 1 2\np 3\nf -5 -4 -3\nf 1//1 2//1 \\\n 4//1\n");
    files.emplace_back("polygons.off",
                       "# first\nOFF 6 3 0\n0 0 0\n2 0 0\n2 2 0\n1 1 0\n0 2 0\n1 1 5 # odd\n5 0 1 2 3 4 255 0 0\n3 0 1 5 0.5 0.5 "
                       "1.0\n4 0 1 2 4\n");
    return files;
}

}  // namespace

TEST(Mutation, ReadersSurviveDamagedFiles) {
    const Scratch scratch;
    for (const auto& [name, bytes] : base_files()) {
        const Path file = scratch / name;
        {
            write_file(file, bytes);
            ASSERT_GT(triangulate(read_polygons(file)).soup.triangles.size(), 0U) << name;  // the sound file is read
        }
        std::size_t refused = 0;
        constexpr std::uint64_t copies = 400;
        for (std::uint64_t seed = 0; seed < copies; ++seed) {
            {
                std::filesystem::remove(file);  // a new file need not be flushed when it is closed, a truncated one may
                std::FILE* stream = std::fopen(file.c_str(), "wb");
                ASSERT_NE(stream, nullptr);
                const std::string damaged = mutate(bytes, seed);
                std::fwrite(damaged.data(), 1, damaged.size(), stream);
                std::fclose(stream);
            }
            SCOPED_TRACE(name + ", seed " + std::to_string(seed));
            try {
                const TriangulatedSoup result = triangulate(read_polygons(file));
                for (const auto& point : result.soup.points)
                    for (const double x : point) ASSERT_TRUE(std::isfinite(x));
                Mesh mesh;
                const ManifoldDefects defects = try_build_mesh(result.soup, mesh);
                ASSERT_EQ(defects.repeated_corners, 0U);
                ASSERT_EQ(mesh.number_of_faces(), defects.any() ? 0 : result.soup.triangles.size());
                const std::size_t vertices = result.soup.points.size(), triangles = result.soup.triangles.size();
                const auto complete = [](std::size_t size, std::size_t wanted) { return size == 0 || size == wanted; };
                ASSERT_TRUE(complete(result.polygon_of_triangle.size(), triangles));
                ASSERT_TRUE(complete(result.extras.vertex_colours.size(), vertices) &&
                            complete(result.extras.face_colours.size(), triangles));
                ASSERT_TRUE(complete(result.extras.vertex_labels.size(), vertices) &&
                            complete(result.extras.face_labels.size(), triangles));
                ASSERT_TRUE(complete(result.extras.corner_texture.size(), 3 * triangles) &&
                            complete(result.extras.face_materials.size(), triangles));
                for (const NamedValues& column : result.extras.vertex_values) ASSERT_EQ(column.values.size(), vertices);
                for (const NamedValues& column : result.extras.face_values) ASSERT_EQ(column.values.size(), triangles);
                for (const Index material : result.extras.face_materials)
                    ASSERT_TRUE(material == no_index || material < result.extras.appearance.materials.size());
            } catch (const Error& error) {
                ++refused;
                EXPECT_NE(error.where().find(name), std::string::npos) << error.what();
                EXPECT_FALSE(error.problem().empty());
            }
        }
        EXPECT_GT(refused, 0U) << name;
        EXPECT_LT(refused, copies) << name;
    }
}

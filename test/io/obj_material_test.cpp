// OBJ files with MTL files and images: what they name is found, read, and written again.
#include "io/formats.h"
#include "io_examples.h"
#include "mutate.h"
#include "ostraka/core/error.h"
#include "scratch.h"

#include <gtest/gtest.h>
#include <cmath>

using namespace ostraka;
using namespace ostraka::test;

namespace {

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
const std::string square_faces = "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";

/// A folder with an OBJ file, an MTL file and further files.
class ObjFolder {
public:
    ObjFolder(const std::string& obj, const std::string& mtl) {
        (void)scratch.file("a.obj", obj);
        (void)scratch.file("a.mtl", mtl);
    }
    /// Adds an image; folders in its name are created.
    ObjFolder& image(const std::string& name, std::uint8_t shade = 7) {
        std::filesystem::create_directories((scratch / name).parent_path());
        (void)scratch.file(name, one_pixel_png(shade));
        return *this;
    }
    [[nodiscard]] PolygonSoup read() const { return read_polygons(scratch / "a.obj"); }
    Scratch scratch;
};

bool has_note(const std::vector<std::string>& notes, const std::string& part) {
    return std::any_of(notes.begin(), notes.end(), [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

/// The image of the only material of an OBJ file whose MTL file has this statement.
SharedImage image_of(ObjFolder& folder) {
    const PolygonSoup soup = folder.read();
    const auto& [materials, images] = soup.extras.appearance;
    return materials.size() == 1 && materials[0].image != no_index ? images[materials[0].image] : nullptr;
}

SharedImage image_named(const std::string& reference, const std::string& file) {
    ObjFolder folder("mtllib a.mtl\n" + square + "usemtl m\n" + square_faces, "newmtl m\nmap_Kd " + reference + "\n");
    folder.image(file);
    return image_of(folder);
}

float light(double srgb) { return static_cast<float>(srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4)); }

}  // namespace

TEST(ObjMaterials, ColoursImagesAndOtherLines) {
    ObjFolder folder("mtllib a.mtl\n" + square + "f 1 2 3\nusemtl First  One\n" + square_faces + "usemtl unknown\nf 1//1 2 3\n",
                     "# comment\r\nnewmtl First  One \t\r\nKd 0.5 0 1\r\nd 0.25\r\nTr 0.1\r\nKa 1 1 1\r\nillum 2\r\n"
                     "map_Kd skin.png\r\nmap_Bump -bm 0.2 sub\\bump.png\r\nnewmtl two\r\nTr 1\r\n");
    folder.image("skin.png", 1).image("sub/bump.png", 2);
    const auto soup = folder.read();
    const auto& [materials, images] = soup.extras.appearance;
    ASSERT_EQ(materials.size(), 2U);
    EXPECT_EQ(materials[0].name, "First  One");
    EXPECT_EQ(materials[0].base_colour, (std::array<float, 4>{light(0.5), 0, 1, 0.25F}));
    EXPECT_EQ(materials[0].alpha, Material::Alpha::blend);
    EXPECT_EQ(materials[0].mtl_rest, (std::vector<std::string>{"Ka 1 1 1", "illum 2", "map_Bump -bm 0.2 bump.png"}));
    ASSERT_EQ(images.size(), 2U);
    EXPECT_EQ(images[materials[0].image]->bytes, one_pixel_png(1));
    EXPECT_EQ(images[1]->bytes, one_pixel_png(2));
    EXPECT_EQ(materials[1].base_colour[3], 1) << "Tr 1 is written for opaque materials";
    EXPECT_EQ(soup.extras.face_materials, (std::vector<Index>{no_index, 0, 0, no_index}));
    EXPECT_TRUE(has_note(soup.notes, "materials that no MTL file describes are not kept: unknown"));
    EXPECT_TRUE(has_note(soup.notes, "6 face corners have no texture coordinates"));
    EXPECT_EQ(soup.extras.corner_texture.size(), 12U);
    EXPECT_EQ(soup.extras.corner_texture[8], (TexturePoint{0, 1}));
}

TEST(ObjMaterials, FilesAreFoundBeside) {
    const struct {
        const char *reference, *file;
    } cases[] = {{"skin.png", "skin.png"},
                 {"SKIN.PNG", "skin.png"},
                 {"my skin.png", "my skin.png"},
                 {"my skin.png # comment", "my skin.png"},
                 {"a #1.png", "a #1.png"},
                 {"\"my skin.png\"", "my skin.png"},
                 {".\\sub\\skin.png", "sub/skin.png"},
                 {"sub\\\\deep/skin.png", "sub/deep/skin.png"},
                 {"Sub/Skin.png", "sub/sKIN.png"},
                 {"sub/skin.png", "skin.png"},
                 {"C:\\Users\\me\\skin.png", "skin.png"},
                 {"C:\\\\Users\\\\me\\\\Skin.PNG", "skin.png"},
                 {"/home/me/skin.png", "skin.png"},
                 {"../../skin.png", "skin.png"},
                 {"sub/../skin.png", "skin.png"},
                 {"my%20skin.png", "my skin.png"},
                 {"my%20skin.png", "my%20skin.png"},
                 {"-texres 512 -blendu off -s 1 1 1 -o 0 0 skin.png", "skin.png"},
                 {"-bm 1 -mm 0 1 -type sphere 1.png", "1.png"},
                 {"-odd.png", "-odd.png"}};
    for (const auto& [reference, file] : cases) {
        const SharedImage image = image_named(reference, file);
        ASSERT_NE(image, nullptr) << reference;
        EXPECT_EQ(image->name, Path(file).filename()) << reference;
    }
}

TEST(ObjMaterials, FilesOutsideTheFolderAreNotRead) {
    const Scratch outside;
    (void)outside.file("secret.png", one_pixel_png(3));
    for (const std::string& reference :
         {(outside / "secret.png").string(), "../" + outside.path().filename().string() + "/secret.png",
          "file://" + (outside / "secret.png").string()}) {
        EXPECT_EQ(image_named(reference, "other.png"), nullptr) << reference;
    }
    ObjFolder folder("mtllib a.mtl\n" + square + "usemtl m\n" + square_faces, "newmtl m\nmap_Kd link.png\n");
    std::filesystem::create_symlink(outside / "secret.png", folder.scratch / "link.png");
    EXPECT_EQ(image_of(folder), nullptr);
    EXPECT_TRUE(has_note(folder.read().notes, "the image 'link.png' that a.mtl names is not in its folder"));
}

TEST(ObjMaterials, MissingImagesAreNamedAndTheirNamesKept) {
    ObjFolder folder("mtllib a.mtl\n" + square + "usemtl m\n" + square_faces, "newmtl m\nmap_Kd -clamp on C:\\x\\skin.png\n");
    const auto soup = folder.read();
    EXPECT_TRUE(has_note(soup.notes, "the image 'C:\\x\\skin.png' that a.mtl names is not in its folder"));
    ASSERT_EQ(soup.extras.appearance.images.size(), 1U);
    EXPECT_EQ(soup.extras.appearance.images[0], nullptr);
    const auto mesh = triangulate(folder.read());
    write_triangles(folder.scratch / "b.obj", mesh.soup, mesh.extras);
    write_triangles(folder.scratch / "b.ply", mesh.soup, mesh.extras);
    folder.image("skin.png");
    for (const char* name : {"b.obj", "b.ply"}) {
        const auto later = read_polygons(folder.scratch / name);
        EXPECT_NE(later.extras.appearance.images.at(0), nullptr) << name;
    }
    folder.image("note.png");
    write_file(folder.scratch / "skin.png", "no image");
    EXPECT_TRUE(has_note(folder.read().notes, "is not kept: "));
}

TEST(ObjMaterials, SeveralLibrariesOnOneLine) {
    ObjFolder folder("mtllib red one.mtl blue one.mtl # comment\nmtllib\nmtllib missing.mtl\nmtllib sub\\green.MTL\n" + square +
                         "usemtl red\nf 1 2 3\nusemtl green # comment\nf 1 2 3\nusemtl blue\nf 1 2 3\nusemtl (null)\nf 1 2 3\n",
                     "newmtl other\n");
    (void)folder.scratch.file("red one.mtl", "newmtl red\nKd 1 0 0\n");
    (void)folder.scratch.file("blue one.mtl", "newmtl blue\nKd 0 0 1\nnewmtl red\nKd 0 0 0\n");
    std::filesystem::create_directory(folder.scratch / "sub");
    (void)folder.scratch.file("sub/green.mtl", "newmtl green\nKd 0 1 0\nmap_Kd ../skin.png\n");
    folder.image("skin.png");
    const auto soup = folder.read();
    const auto& materials = soup.extras.appearance.materials;
    ASSERT_EQ(materials.size(), 3U);
    EXPECT_EQ(materials[0].base_colour, (std::array<float, 4>{1, 0, 0, 1}));
    EXPECT_EQ(soup.extras.face_materials, (std::vector<Index>{0, 2, 1, no_index}));
    EXPECT_NE(soup.extras.appearance.images.at(materials[2].image), nullptr) << "relative to the folder of the OBJ file";
    EXPECT_TRUE(has_note(soup.notes, "is not in its folder: missing.mtl"));
    EXPECT_TRUE(has_note(soup.notes, "1 materials have the name of an earlier one"));
}

TEST(ObjMaterials, ARenamedFolderIsStillFound) {
    ObjFolder folder("mtllib former.mtl\n" + square + "usemtl m\n" + square_faces, "newmtl m\nKd 0 0 0\nmap_Kd skin.png\n");
    folder.image("skin.png");
    const auto soup = folder.read();
    ASSERT_EQ(soup.extras.appearance.materials.size(), 1U);
    EXPECT_EQ(soup.extras.appearance.materials[0].base_colour, (std::array<float, 4>{1, 1, 1, 1})) << "an image is never black";
    EXPECT_TRUE(has_note(soup.notes, "the materials are those of a.mtl"));
    EXPECT_TRUE(has_note(soup.notes, "the image is shown unchanged"));
}

TEST(ObjMaterials, OptionsOfMapsMoveTheCoordinates) {
    ObjFolder folder("mtllib a.mtl\n" + square + "usemtl m\n" + square_faces + "usemtl n\n" + square_faces,
                     "newmtl m\nmap_Kd -o 0.5 0.25 0 -s 2 4 1 -clamp on skin.png\nmap_Ks -s 2 1 1 skin.png\nmap_Ns skin.png\n"
                     "newmtl n\nmap_Kd -mm 0.1 2 skin.png\n");
    folder.image("skin.png");
    const auto soup = folder.read();
    const auto& texture = soup.extras.corner_texture;
    EXPECT_EQ(texture[0], (TexturePoint{0.5F, 0.25F}));
    EXPECT_EQ(texture[2], (TexturePoint{2.5F, 4.25F}));
    EXPECT_EQ(texture[6], (TexturePoint{0, 0}));
    EXPECT_EQ(texture[8], (TexturePoint{1, 1}));
    const auto& materials = soup.extras.appearance.materials;
    EXPECT_EQ(materials[0].wrap_u, TextureWrap::clamp);
    EXPECT_EQ(materials[1].wrap_u, TextureWrap::repeat);
    EXPECT_EQ(materials[0].mtl_rest, (std::vector<std::string>{"map_Ks -o -0.5 -0.0625 -s 1 0.25 skin.png",
                                                               "map_Ns -o -0.25 -0.0625 -s 0.5 0.25 skin.png"}))
        << "other maps stay where they are on the surface";
    EXPECT_EQ(soup.extras.appearance.images.size(), 1U);
    EXPECT_TRUE(has_note(soup.notes, "options of the image of material 'n' are not applied: -mm 0.1 2"));
}

TEST(ObjMaterials, WrittenFilesAreReadTheSame) {
    ObjFolder folder("mtllib a.mtl\n" + square +
                         "f 1/1 2/2 3/3\nusemtl one two\nf 1/2 3/3 4/4\nusemtl b#1\nf 1/1 3/4 2/2\nusemtl one two\n"
                         "f 4/1 3/1 2/1\nusemtl (null)\nf 1/1 4/4 3/3\n",
                     "newmtl one two\nKd 0.64 0.3527 0.02\nd 0.9\nNs 96.078431\nmap_Kd sub/skin.png\nmap_Ka other.png\n"
                     "newmtl b#1\nmap_Kd -clamp on skin.png\nKe 1 0 0\nnewmtl unused\nKd 0.1 0.2 0.3\n");
    folder.image("sub/skin.png", 1).image("skin.png", 2).image("other.png", 3);
    const auto mesh = triangulate(folder.read());
    std::filesystem::create_directory(folder.scratch / "out");
    const Path file = folder.scratch / "out" / "b.obj";
    EXPECT_TRUE(write_triangles(file, mesh.soup, mesh.extras).empty());
    EXPECT_EQ(files_in(folder.scratch / "out"),
              (std::vector<std::string>{"b.mtl", "b.obj", "other.png", "skin.png", "skin_2.png"}));
    EXPECT_NE(read_file(folder.scratch / "out" / "b.mtl").find("Kd 0.64 0.3527 0.02\n"), std::string::npos);
    const auto again = triangulate(read_polygons(file));
    EXPECT_TRUE(again.notes.empty());
    EXPECT_EQ(again.soup.points, mesh.soup.points);
    EXPECT_EQ(again.soup.triangles, mesh.soup.triangles);
    EXPECT_EQ(again.extras.corner_texture, mesh.extras.corner_texture);
    EXPECT_EQ(again.extras.face_materials, mesh.extras.face_materials);
    const auto &before = mesh.extras.appearance, &after = again.extras.appearance;
    ASSERT_EQ(after.materials.size(), 3U);
    for (std::size_t m = 0; m < 3; ++m) {
        EXPECT_EQ(after.materials[m].name, before.materials[m].name);
        EXPECT_EQ(after.materials[m].base_colour, before.materials[m].base_colour);
        EXPECT_EQ(after.materials[m].mtl_rest, before.materials[m].mtl_rest);
        EXPECT_EQ(after.materials[m].wrap_v, before.materials[m].wrap_v);
        const Index image = before.materials[m].image;
        ASSERT_EQ(after.materials[m].image == no_index, image == no_index);
        if (image != no_index) {
            EXPECT_EQ(after.images[after.materials[m].image]->bytes, before.images[image]->bytes);
        }
    }
    const std::string obj = read_file(file), mtl = read_file(folder.scratch / "out" / "b.mtl");
    write_triangles(file, again.soup, again.extras);
    EXPECT_EQ(read_file(file), obj);
    EXPECT_EQ(read_file(folder.scratch / "out" / "b.mtl"), mtl);
}

TEST(ObjMaterials, OtherFilesOfTheFolderAreNotReplaced) {
    const Scratch scratch;
    const TriangleSoup soup = octahedron();
    MeshExtras extras;
    extras.corner_texture = texture_without_seams(soup);
    extras.face_materials.assign(soup.triangles.size(), 0);
    extras.appearance.materials.resize(3);
    const auto add = [&](const std::string& name, std::uint8_t shade, std::size_t material) {
        extras.appearance.materials[material].image = static_cast<Index>(extras.appearance.images.size());
        extras.appearance.images.push_back(std::make_shared<const Image>(parse_image(one_pixel_png(shade), name, name)));
    };
    add("skin.png", 5, 0);
    add("folder/../a.obj", 6, 1);
    add("", 7, 2);
    (void)scratch.file("skin.png", "of another mesh");
    write_triangles(scratch / "a.obj", soup, extras);
    EXPECT_EQ(read_file(scratch / "skin.png"), "of another mesh");
    EXPECT_EQ(files_in(scratch.path()),
              (std::vector<std::string>{"a.mtl", "a.obj", "a.obj.png", "a_2.png", "a_skin.png", "skin.png"}));
    const auto again = read_polygons(scratch / "a.obj");
    ASSERT_EQ(again.extras.appearance.materials.size(), 3U);
    for (std::size_t m = 0; m < 3; ++m)
        EXPECT_EQ(again.extras.appearance.images[again.extras.appearance.materials[m].image]->bytes,
                  one_pixel_png(static_cast<std::uint8_t>(5 + m)));
    // All files appear together or not at all.
    std::filesystem::create_directory(scratch / "b.obj");
    EXPECT_THROW(write_triangles(scratch / "b.obj", soup, extras), Error);
    EXPECT_FALSE(file_exists(scratch / "b.mtl"));
    EXPECT_FALSE(file_exists(scratch / "b_skin.png"));
}

TEST(ObjMaterials, DamagedMaterialsNeverStopTheMesh) {
    const std::string mtl =
        "newmtl m\nKd 0.5 0 1\nd 0.5\nTr 0.1\nKa 1 1 1\nmap_Kd -s 2 2 -o .1 .2 -clamp on skin.png\nmap_Bump -bm 0.2 "
        "skin.png\nnewmtl n\n"
        "Kd spectral x.rfl\nmap_d -imfchan m a b.png\n";
    ObjFolder folder("mtllib a.mtl\n" + square + "usemtl m\n" + square_faces + "usemtl n\n" + square_faces, mtl);
    folder.image("skin.png");
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        std::filesystem::remove(folder.scratch / "a.mtl");
        std::FILE* stream = std::fopen((folder.scratch / "a.mtl").c_str(), "wb");
        const std::string damaged = mutate(mtl, seed);
        std::fwrite(damaged.data(), 1, damaged.size(), stream);
        std::fclose(stream);
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto mesh = triangulate(folder.read());
        EXPECT_EQ(mesh.soup.triangles.size(), 4U);
        for (const TexturePoint& point : mesh.extras.corner_texture)
            for (const float x : point) ASSERT_TRUE(std::isfinite(x));
        for (const Material& material : mesh.extras.appearance.materials) {
            for (const float x : material.base_colour) ASSERT_TRUE(x >= 0 && x <= 1);
            ASSERT_TRUE(material.image == no_index || material.image < mesh.extras.appearance.images.size());
        }
    }
}

TEST(ObjMaterials, FilesOfOtherPrograms) {
    const Path data = Path(OSTRAKA_SHARED_DATA) / "textured";
    if (!std::filesystem::is_directory(data)) GTEST_SKIP() << "no " << data;
    const struct {
        const char* file;
        std::size_t vertices, triangles, materials, images, read_images;
    } cases[] = {{"odd-obj-windows-paths/box-windows-paths.obj", 8, 12, 1, 1, 1},
                 {"odd-obj-subdirectories/box-textured.obj", 8, 12, 1, 1, 1},
                 {"odd-obj-map-options/box-texture-options.obj", 8, 12, 1, 6, 6},
                 {"odd-obj-alpha-map/box-complex-material-alpha.obj", 8, 12, 1, 7, 7},
                 {"odd-obj-mtllib-spaces/box mtllib.obj", 8, 12, 3, 0, 0},
                 {"odd-obj-missing-image/box-missing-texture.obj", 8, 12, 1, 1, 0},
                 {"odd-obj-mixed-attributes/box-mixed-attributes-2.obj", 8, 48, 1, 1, 1},
                 {"odd-obj-multiple-materials/box-multiple-materials.obj", 8, 12, 3, 0, 0},
                 {"odd-obj-shared-textures/box-shared-textures.obj", 8, 12, 1, 1, 1},
                 {"odd-obj-abs-windows-path/stanford_bunny_reduced.obj", 3511, 6945, 1, 1, 0},
                 {"odd-obj-image-with-space/fuze.obj", 502, 1000, 1, 1, 1},
                 {"odd-obj-vertex-colours-and-image/cube-colors-textured.obj", 8, 12, 6, 1, 1},
                 {"odd-obj-map-options-2/cube with white spaces.obj", 8, 12, 5, 1, 1},
                 {"odd-obj-negative-vt/spaced-mtllib.obj", 3, 1, 1, 0, 0},
                 {"odd-ply-meshlab-wedge/texturedknot.obj", 1440, 2880, 1, 1, 1},
                 {"scan-meshroom-obj/texturedMesh.obj", 26984, 53364, 1, 1, 1}};
    for (const auto& [file, vertices, triangles, materials, images, read_images] : cases) {
        SCOPED_TRACE(file);
        const auto mesh = triangulate(read_polygons(data / file));
        EXPECT_EQ(mesh.soup.points.size(), vertices);
        EXPECT_EQ(mesh.soup.triangles.size(), triangles);
        EXPECT_EQ(mesh.extras.appearance.materials.size(), materials);
        const auto& list = mesh.extras.appearance.images;
        EXPECT_EQ(list.size(), images);
        EXPECT_EQ(
            static_cast<std::size_t>(std::count_if(list.begin(), list.end(), [](const auto& image) { return image != nullptr; })),
            read_images);
    }
}

// Meshes, clouds and exchange formats as subjects.
#include "subjects.h"

#include "../io/three_mf_examples.h"
#include "../point_cloud/e57_writer.h"
#include "../point_cloud/las_writer.h"
#include "ostraka/image/image.h"

#include "ostraka/io/mesh_file.h"
#include "ostraka/point_cloud/point_cloud.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace ostraka::fuzz {

namespace {

constexpr const char* medit = R"(MeshVersionFormatted 2
Dimension 3
Vertices
5
0 0 0 0
1 0 0 0
0 1 0 0
0 0 1 0
1 1 1 0
Triangles
2
1 2 3 0
2 3 5 0
Tetrahedra
2
1 2 3 4 1
2 3 4 5 1
End
)";

constexpr const char* vtu = R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">
<UnstructuredGrid><Piece NumberOfPoints="5" NumberOfCells="2">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 0 0 1 1 1 1</DataArray></Points>
<Cells><DataArray type="Int32" Name="connectivity" format="ascii">0 1 2 3 1 2 3 4</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">4 8</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10 10</DataArray></Cells>
</Piece></UnstructuredGrid></VTKFile>
)";

std::string points_text(const Mesh& mesh, const char* before, std::size_t every) {
    std::ostringstream text;
    std::size_t i = 0;
    for (const auto vertex : mesh.vertices())
        if (i++ % every == 0) text << before << mesh.point(vertex) << '\n';
    return text.str();
}

/// Points with 30 coordinates of single precision, as binary PCD.
std::string binary_pcd(const Mesh& mesh) {
    std::string text = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 30\nHEIGHT 1\nDATA binary\n";
    for (Index i = 0; i < 30; ++i)
        for (int k = 0; k < 3; ++k) {
            const auto x = static_cast<float>(mesh.point(Vertex(i))[k]);
            text.append(reinterpret_cast<const char*>(&x), sizeof x);
        }
    return text;
}

std::string read_cloud(const Path& file) {
    const auto cloud = read_point_cloud(file);
    if (!cloud) return "a file with faces";
    const std::size_t normals = estimate_normals(cloud->points).size();
    return std::to_string(cloud->points.size()) + " points, " + std::to_string(normals) + " normals";
}

/// Reads an E57 file, whose checksums are corrected first.
std::string read_sealed_e57(const Path& file) {
    std::string bytes = read_file(file);
    bytes.resize(std::max<std::size_t>(bytes.size() / 1024, 1) * 1024);
    test::seal_e57_pages(bytes);
    write_file("out/sealed.e57", bytes);
    return read_cloud("out/sealed.e57");
}

std::string decode_image(const Path& file) {
    const Pixels pixels = decode(read_image(file), file.string());
    return std::to_string(pixels.rgba.size()) + " pixels";
}

/// Packs the model model.xml into a 3MF file, whose checksum is then right, and reads it.
std::string read_packed_model(Stopper& stopper) {
    write_file("out/model.3mf", test::zip_of({{"3D/3dmodel.model", read_file("model.xml")}}));
    return call_operation("mesh info", R"({"input":"out/model.3mf"})", stopper);
}

void add_call(std::vector<Subject>& subjects, const std::string& name, std::vector<SubjectFile> files, Target target,
              const std::string& call) {
    Subject subject;
    subject.name = name;
    subject.files = std::move(files);
    subject.files.push_back({"call.json", {}, call});
    subject.folders = {"out"};
    subject.targets = {std::move(target)};
    subject.act = call_of_file;
    subjects.push_back(std::move(subject));
}

/// A GIF of 2 x 2 pixels in two colours.
using namespace std::string_view_literals;
constexpr std::string_view gif = "GIF89a\2\0\2\0\x80\0\0\0\0\0\xff\xff\xff,\0\0\0\0\2\0\2\0\0\2\3\x44\x02\x05\0;"sv;

void make_images() {
    make_folder("images");
    Pixels pixels{48, 32, {}};
    for (std::uint32_t i = 0; i < 48 * 32; ++i)
        pixels.rgba.push_back({static_cast<std::uint8_t>(5 * i), static_cast<std::uint8_t>(i / 48 * 7),
                               static_cast<std::uint8_t>(i * i / 7), static_cast<std::uint8_t>(255 - i / 48)});
    write_file("images/image.png", encode(pixels, ImageFormat::png, {}).bytes);
    write_file("images/image.jpg", encode(pixels, ImageFormat::jpeg, {}).bytes);
    write_file("images/image.webp", encode(pixels, ImageFormat::webp, {}).bytes);
    write_file("images/lossless.webp", encode(pixels, ImageFormat::webp, {}, 100).bytes);
    write_file("images/image.gif", gif);
}

constexpr const char* mtl = R"(# two materials
newmtl clay
Ka 0.2 0.2 0.2
Kd 0.8 0.5 0.25
Ks 0 0 0
d 0.9
Tr 0.1
illum 2
map_Kd -s 2 2 1 -o 0.5 0.25 0 -clamp on image.png
map_Bump -bm 0.5 IMAGE.png
newmtl paint
Kd 1 1 1
map_Kd .\\folder\\image.png
norm image.png
)";

/// A quadrilateral and a triangle with texture coordinates and two materials.
constexpr const char* textured = R"(mtllib textured.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 2 2 1
vt 0 0
vt 1 0
vt 1 1
vt 0.25 0.75
usemtl clay
f 1/1 2/2 3/3 4/4
usemtl paint
f 3/1 4/2 5/3
)";

/// Meshes with an image inside or beside them.
void make_textured() {
    make_folder("textured");
    write_file("textured/textured.obj", textured);
    write_file("textured/textured.mtl", mtl);
    write_file("textured/image.png", read_file("images/image.png"));
    const MeshFile mesh = read_mesh("textured/textured.obj");
    for (const char* name : {"textured/out.glb", "textured/out.ply"}) write_mesh(name, mesh.mesh, mesh.extras);
    WriteOptions ascii;
    ascii.encoding = Encoding::ascii;
    write_mesh("textured/text.ply", mesh.mesh, mesh.extras, ascii);
}

void add_sealed_e57(const Path& file, std::vector<Subject>& subjects) {
    const std::string name = file.filename().string();
    Subject subject;
    subject.name = "sealed cloud " + name;
    subject.files = {{name, file}};
    subject.folders = {"out"};
    subject.targets = {{"e57", name}};
    subject.act = [name](Stopper&) { return read_sealed_e57(name); };
    subjects.push_back(std::move(subject));
}

/// What is done with a scan of a kind.
void add_scan(const Path& file, std::vector<SubjectFile> beside, std::vector<Subject>& subjects) {
    const std::string name = file.filename().string(), kind = extension(name).substr(1);
    std::vector<SubjectFile> files{{name, file}};
    files.insert(files.end(), beside.begin(), beside.end());
    add_call(subjects, "info of scan " + name, files, {kind, name}, call_text("mesh info", R"({"input":")" + name + "\"}"));
    add_call(subjects, "import of scan " + name, files, {kind, name},
             call_text("import", R"({"scan":[")" + name + R"("],"object":"out/object"})"));
}

/// Files of a folder that the environment names, such as scans of collections: other dialects than ours.
void add_samples(std::vector<Subject>& subjects) {
    const char* folder = std::getenv("OSTRAKA_FUZZ_SAMPLES");
    if (folder == nullptr) return;
    for (const std::string& name : files_in(folder)) {
        const Path file = Path(folder) / name;
        const std::string ending = extension(file);
        if (ending != ".jpg" && ending != ".jpeg" && ending != ".png" && ending != ".webp" && ending != ".gif") {
            if (ending.size() > 1) add_scan(file, {}, subjects);
            if (ending == ".e57") add_sealed_e57(file, subjects);
            continue;
        }
        Subject subject;
        subject.name = "sample " + name;
        subject.files = {{name, file}};
        subject.targets = {{"image", name}};
        subject.act = [name](Stopper&) { return decode_image(name); };
        subjects.push_back(std::move(subject));
    }
}

/// Meshes with materials: the files that they name are mutated too.
void add_materials(const Path& seeds, std::vector<Subject>& subjects) {
    const SubjectFile obj{"textured.obj", {}, textured}, materials{"textured.mtl", {}, mtl};
    const SubjectFile image{"image.png", seeds / "images" / "image.png"};
    const std::string file = R"({"input":"textured.obj")";
    for (const char* target : {"textured.mtl", "textured.obj"}) {
        const std::string kind = extension(target).substr(1);
        add_call(subjects, "info of " + kind + " with materials", {obj, materials, image}, {kind, target},
                 call_text("mesh info", file + "}"));
        for (const char* output : {"out.obj", "out.glb", "out.ply"})
            add_call(subjects, "convert " + kind + " with materials to " + output, {obj, materials, image}, {kind, target},
                     call_text("mesh convert", file + R"(,"output":"out/)" + output + "\"}"));
        add_call(subjects, "import " + kind + " with materials", {obj, materials, image}, {kind, target},
                 call_text("import", R"({"scan":["textured.obj"],"object":"out/object"})"));
    }
    Subject model;
    model.name = "model of 3MF";
    model.files = {{"model.xml", {}, test::coloured_model}};
    model.folders = {"out"};
    model.targets = {{"3mf", "model.xml"}};
    model.act = read_packed_model;
    subjects.push_back(std::move(model));
}

/// Recipes of the project, on the existing meshes.
void add_recipes(const Path& project, std::vector<Subject>& subjects) {
    for (const std::string& name : files_in(project / "data")) {
        if (!name.ends_with(".recipe.json")) continue;
        const std::string mesh = name.substr(0, name.find_first_of(".-")) + ".ply";
        if (!file_exists(project / "data" / mesh)) continue;
        add_call(subjects, "recipe " + name, {{name, project / "data" / name}, {mesh, project / "data" / mesh}}, {"recipe", name},
                 call_text("annotation apply",
                           R"({"mesh":")" + mesh + R"(","recipe":")" + name + R"(","output":"out/out.ant.json"})"));
    }
}

}  // namespace

void make_formats(const Path& project) {
    const Path inputs = project / "data" / "conformance" / "inputs";
    make_folder("meshes");
    const MeshFile sphere = read_mesh(inputs / "sphere.ply"), box = read_mesh(inputs / "box.ply");
    for (const char* ending : {".obj", ".off", ".stl", ".glb"}) {
        write_mesh(Path("meshes") / (std::string("sphere") + ending), sphere.mesh, sphere.extras);
        write_mesh(Path("meshes") / (std::string("box") + ending), box.mesh, box.extras);
    }
    WriteOptions ascii;
    ascii.encoding = Encoding::ascii;
    MeshExtras coloured = box.extras;
    coloured.vertex_colours.assign(box.mesh.number_of_vertices(), {200, 100, 50, 255});
    coloured.face_labels.assign(box.mesh.number_of_faces(), 1);
    write_mesh("meshes/box-text.ply", box.mesh, coloured, ascii);
    write_mesh("meshes/box-text.stl", box.mesh, {}, ascii);
    write_mesh("meshes/sphere.ply", sphere.mesh, sphere.extras);
    write_file("meshes/two.mesh", medit);
    write_file("meshes/tetrahedron.3mf", test::zip_of({{"3D/3dmodel.model", test::coloured_model}}));
    write_file("meshes/two.vtu", vtu);
    write_file("meshes/quads.obj", read_file(inputs / "box-of-quads.obj"));
    make_folder("clouds");
    write_file("clouds/points.xyz", points_text(sphere.mesh, "", 1));
    write_file("clouds/points.obj", points_text(sphere.mesh, "v ", 2));
    write_file("clouds/points.ply", read_file(inputs / "points-only.ply"));
    make_images();
    write_file("clouds/points.las", test::las_file(3, 0x8040));
    write_file("clouds/points-binary.pcd", binary_pcd(sphere.mesh));
    write_file("clouds/points.pts", "20\n" + points_text(sphere.mesh, "", 10));
    write_file("clouds/coloured.csv", "//X,Y,Z,R,G,B\n0.5,1,2,255,0,0\n1,2,3,0,128,255\n3,1,0.25,1,2,3\n4,4,1e1,9,9,9\n");
    make_textured();
    write_file("clouds/points.ptx",
               "200\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n" + points_text(sphere.mesh, "", 3));
    write_file("clouds/points.pcd",
               "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 30\nHEIGHT 1\nDATA ascii\n" +
                   points_text(sphere.mesh, "", 1));
    test::E57Writer e57;
    for (const char* axis : {"X", "Y", "Z"}) {
        if (e57.scans.empty()) e57.scans.emplace_back();
        auto& values = e57.scans.back().column("<cartesian" + std::string(axis) + " type=\"Float\"/>", 64);
        for (const auto vertex : sphere.mesh.vertices())
            values.push_back(std::bit_cast<std::uint64_t>(sphere.mesh.point(vertex)[axis[0] - 'X']));
    }
    write_file("clouds/points.e57", e57.file(500));
    make_folder("exchange");
    Stopper stopper;
    const auto quoted = [](const Path& file) { return "\"" + file.string() + "\""; };
    for (const char* name : {"a.csv", "a.tps", "a.pp", "a.mrk.json", "a.fcsv", "a.jsonld", "a.glb", "a.ant", "a.fct"})
        call_operation("annotation export",
                       R"({"mesh":)" + quoted(inputs / "box.ply") + R"(,"annotations":)" + quoted(inputs / "box.ant.json") +
                           R"(,"output":"exchange/)" + name + "\"}",
                       stopper);
    for (const char* name : {"a.ttl", "a.rdf"})
        call_operation("vocabulary convert",
                       R"({"input":)" + quoted(inputs / "terracotta.vocabulary.json") + R"(,"output":"exchange/)" + name + "\"}",
                       stopper);
}

void add_formats(const Path& project, const Path& seeds, std::vector<Subject>& subjects) {
    const Path inputs = project / "data" / "conformance" / "inputs";
    for (const std::string& name : files_in(seeds / "meshes")) {
        const std::string file = R"({"input":")" + name + "\"", kind = extension(name).substr(1);
        const SubjectFile seed{name, seeds / "meshes" / name};
        add_call(subjects, "info " + name, {seed}, {kind, name}, call_text("mesh info", file + "}"));
        add_call(subjects, "convert " + name, {seed}, {kind, name},
                 call_text("mesh convert", file + R"(,"output":"out/out.ply"})"));
        add_call(subjects, "repair " + name, {seed}, {kind, name},
                 call_text("mesh repair", file + R"(,"output":"out/out.ply"})"));
    }
    const auto add_reader = [&](const char* folder, const char* kind, std::string (*read)(const Path&)) {
        for (const std::string& name : files_in(seeds / folder)) {
            Subject subject;
            subject.name = std::string(kind) + " " + name;
            subject.files = {{name, seeds / folder / name}};
            subject.targets = {{kind, name}};
            subject.act = [name, read](Stopper&) { return read(name); };
            subjects.push_back(std::move(subject));
        }
    };
    for (const std::string& name : files_in(seeds / "clouds")) {
        const std::string ending = extension(name);
        const bool is_mesh_format = ending == ".obj" || ending == ".ply";
        Subject subject;
        subject.name = "cloud " + name;
        subject.files = {{name, seeds / "clouds" / name}};
        subject.targets = {{is_mesh_format ? "cloud" : ending.substr(1), name}};
        subject.act = [name](Stopper&) { return read_cloud(name); };
        subjects.push_back(std::move(subject));
        if (ending == ".e57") add_sealed_e57(seeds / "clouds" / name, subjects);
    }
    add_reader("images", "image", decode_image);
    for (const std::string& name : files_in(seeds / "exchange")) {
        const SubjectFile seed{name, seeds / "exchange" / name};
        if (name.ends_with(".ttl") || name.ends_with(".rdf"))
            add_call(subjects, "convert " + name, {seed}, {"exchange", name},
                     call_text("vocabulary convert", R"({"input":")" + name + R"(","output":"out/out.vocabulary.json"})"));
        else
            add_call(
                subjects, "import " + name, {seed, {"box.ply", inputs / "box.ply"}}, {"exchange", name},
                call_text("annotation import", R"({"mesh":"box.ply","input":")" + name + R"(","output":"out/out.ant.json"})"));
    }
    add_materials(seeds, subjects);
    const SubjectFile image{"out.png", seeds / "images" / "image.png"};
    for (const std::string& name : files_in(seeds / "textured"))
        if (name.ends_with(".glb") || name.ends_with(".ply")) add_scan(seeds / "textured" / name, {image}, subjects);
    add_samples(subjects);
    add_recipes(project, subjects);
}

}  // namespace ostraka::fuzz

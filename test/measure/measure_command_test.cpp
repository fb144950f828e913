// `ostraka measure` as users run it.
#include "meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/render/values.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {
using test::run_command;
using test::Scratch;

class MeasureCommand : public ::testing::Test {
protected:
    Scratch scratch;
    Path cube = scratch / "cube.ply", annotated = scratch / "cube.ant.json";
    Mesh mesh = build_mesh(test::box(2));

    void SetUp() override {
        write_mesh(cube, mesh);
        AnnotationSet set;
        set.unit = "mm";
        ensure_root(set, mesh);
        Annotation& side = set.annotations.emplace_back();
        side.id = 7;
        side.tag = "side";
        for (const Face f : mesh.faces())
            if (centroid(mesh, f).x() == 0) side.faces.push_back(f);
        write_annotations(annotated, {mesh, set}, cube.string(), {});
    }
    Index vertex_at(double x, double y, double z) const {
        for (const Vertex v : mesh.vertices())
            if (mesh.point(v) == Point(x, y, z)) return v;
        return no_index;
    }
    std::string pins(std::initializer_list<Index> vertices) const {
        std::string text;
        for (const Index v : vertices) text += (text.empty() ? "" : ",") + std::to_string(v);
        return text;
    }
    test::CommandResult run(const std::string& words) const { return run_command("measure " + words); }
    void refused(const std::string& words, int code, const std::string& text) const {
        const auto result = run(words);
        EXPECT_EQ(result.code, code) << words << '\n' << result.err;
        EXPECT_NE(result.err.find(text), std::string::npos) << words << '\n' << result.err;
        EXPECT_EQ(result.out, "") << words;
    }
};

TEST_F(MeasureCommand, ASecondMeasureOfTheSameNameIsReported) {
    const Path out = scratch / "out.ant.json", last = scratch / "last.ant.json";
    const std::string measure = "take " + cube.string() + " --tool ruler --name r --annotation side --points " +
                                pins({vertex_at(0, 0, 0), vertex_at(0, 1, 1)}) + " --annotations ";
    const auto first = run(measure + annotated.string() + " --output " + out.string());
    ASSERT_EQ(first.code, 0) << first.err;
    EXPECT_EQ(first.err, "");
    const auto second = run(measure + out.string() + " --output " + last.string());
    ASSERT_EQ(second.code, 0) << second.err;
    EXPECT_NE(second.err.find("annotation 7 already has an attribute 'r' (id 0)"), std::string::npos) << second.err;
    EXPECT_EQ(read_annotations(last, mesh).find(7)->attributes.size(), 2U);
}

TEST_F(MeasureCommand, DescribeShowsAxesOneByOne) {
    const auto result = run("describe " + cube.string() + " --annotations " + annotated.string() + " --annotation side");
    ASSERT_EQ(result.code, 0) << result.err;
    const std::size_t start = result.out.find("box axes"), end = result.out.find('\n', start);
    ASSERT_NE(start, std::string::npos) << result.out;
    const std::string line = result.out.substr(start, end - start);
    EXPECT_EQ(std::count(line.begin(), line.end(), '('), 3) << line;
    EXPECT_EQ(std::count(line.begin(), line.end(), ')'), 3) << line;
}

TEST_F(MeasureCommand, TakesStoresAndRefreshes) {
    const std::string o = pins({vertex_at(0, 0, 0), vertex_at(1, 1, 1)});
    auto result = run("take " + cube.string() + " --tool ruler --json --points " + o);
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_DOUBLE_EQ(parse_json(result.out, "report")["result"]["value"].GetDouble(), std::sqrt(3));
    const Path out = scratch / "out.ant.json", last = scratch / "last.ant.json";
    const std::string output_options = " --annotations " + annotated.string() + " --annotation side --output " + out.string();
    result = run("take " + cube.string() + " --tool tape --geodesic exact --name way --points " + o + " --repeat " +
                 pins({vertex_at(0, 0, 0), vertex_at(1, 1, 0.5)}) + output_options);
    ASSERT_EQ(result.code, 0) << result.err;
    AnnotationSet set = read_annotations(out, mesh);
    ASSERT_EQ(set.find(7)->attributes.size(), 1U);
    const Measure measure = *set.find(7)->attributes[0].measure();
    EXPECT_TRUE(measure.exact);
    EXPECT_EQ(measure.unit, "mm");
    EXPECT_NEAR(*measure.value, (std::sqrt(5) + std::hypot(1.5, 1)) / 2, 1e-12);
    EXPECT_GT(*measure.uncertainty, 0);
    ASSERT_EQ(measure.repeats.size(), 1U);
    // The stored data suffice to repeat the measurement: checking finds no defect, refreshing changes no digit.
    EXPECT_EQ(run_command("annotation check " + cube.string() + " " + out.string()).code, 0);
    result = run("refresh " + cube.string() + " --annotations " + out.string() + " --output " + last.string());
    EXPECT_EQ(result.code, 0) << result.err;
    set = read_annotations(last, mesh);
    EXPECT_EQ(set.find(7)->attributes[0].measure()->value, measure.value);
    EXPECT_EQ(set.find(7)->attributes[0].measure()->uncertainty, measure.uncertainty);
    // By coordinates; along a direction, the whole annotation.
    result = run("take " + cube.string() + " --tool ruler --at 0.1,0,0 --at 5,0.9,0");
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.err.find("the surface is 4 away"), std::string::npos) << result.err;
    result = run("take " + cube.string() + " --tool ruler --at 0.1,0,0 --at 1,0.9,0 --json");
    EXPECT_DOUBLE_EQ(parse_json(result.out, "report")["result"]["value"].GetDouble(), std::sqrt(2));
    result = run("take " + cube.string() + " --tool bounding --direction 0,2,0 --json");
    EXPECT_DOUBLE_EQ(parse_json(result.out, "report")["result"]["value"].GetDouble(), 1);
    result = run("take " + cube.string() + " --tool bounding --direction 1,0,0 --json --annotation 7 --annotations " +
                 annotated.string());
    EXPECT_DOUBLE_EQ(parse_json(result.out, "report")["result"]["value"].GetDouble(), 0);
}

TEST_F(MeasureCommand, DescribesAndStores) {
    const Path out = scratch / "out.ant.json", map = scratch / "x.npy";
    std::vector<double> x;
    for (const Vertex v : mesh.vertices()) x.push_back(mesh.point(v).x());
    write_values(map, x);
    const auto result = run("describe " + cube.string() + " --annotations " + annotated.string() +
                            " --map depth=" + map.string() + " --thickness --cone 5 --output " + out.string());
    ASSERT_EQ(result.code, 0) << result.err;
    const AnnotationSet set = read_annotations(out, mesh);
    const auto value = [&](int id, const std::string& name) {
        for (const Attribute& a : set.find(id)->attributes)
            if (a.name == name) return a.descriptor()->values.front();
        return std::nan("");
    };
    EXPECT_DOUBLE_EQ(value(0, "volume"), 1);
    EXPECT_DOUBLE_EQ(value(7, "area"), 1);
    EXPECT_DOUBLE_EQ(value(7, "circularity"), 16);
    EXPECT_DOUBLE_EQ(value(7, "volume bound"), 0);
    EXPECT_DOUBLE_EQ(value(0, "depth mean"), 0.5);
    EXPECT_DOUBLE_EQ(value(7, "depth 95 %"), 0);
    EXPECT_NEAR(value(7, "thickness median"), 1, 0.01);
    EXPECT_EQ(run_command("annotation check " + cube.string() + " " + out.string()).code, 0);
}

TEST_F(MeasureCommand, WritesMaps) {
    const Path map = scratch / "map.npy", text = scratch / "map.txt";
    ASSERT_EQ(run("map " + cube.string() + " " + map.string() + " --of geodesic --from " + pins({vertex_at(0, 0, 0)})).code, 0);
    const auto values = read_values(map);
    ASSERT_EQ(values.size(), mesh.number_of_vertices());
    EXPECT_NEAR(values[vertex_at(1, 1, 1)], std::sqrt(5), 1e-12);
    EXPECT_EQ(run("map " + cube.string() + " " + text.string() + " --of geodesic --from " + pins({vertex_at(0, 0, 0)})).code, 0);
    EXPECT_EQ(read_values(text), values);
    EXPECT_EQ(run("map " + cube.string() + " " + map.string() + " --of thickness --on face").code, 0);
    EXPECT_EQ(read_values(map).size(), mesh.number_of_faces());
    EXPECT_EQ(run("map " + cube.string() + " " + map.string() + " --of mean-curvature --scale 0.2").code, 0);
    const Path png = scratch / "map.png";
    EXPECT_EQ(run_command("render " + cube.string() + " --map " + map.string() + " --size 200x200 " + png.string()).code, 0);
    EXPECT_GT(std::filesystem::file_size(png), 0U);
}

TEST_F(MeasureCommand, AMapAndAnAxisAreAttributesWithTheirFiles) {
    const Path pot = scratch / "pot.ply", set_file = scratch / "pot.ant.json", map = scratch / "bumps.npy";
    TriangleSoup soup = test::octahedron_sphere(3);
    for (auto& p : soup.points) p[2] *= 3;
    write_mesh(pot, build_mesh(soup));
    const Mesh body = read_mesh(pot).mesh;
    const auto check = [&] { return run_command("annotation check " + pot.string() + " " + set_file.string()); };

    const auto mapped = run("map " + pot.string() + " " + map.string() + " --of mean-curvature --unit mm --name bumpiness" +
                            " --annotations-out " + set_file.string());
    ASSERT_EQ(mapped.code, 0) << mapped.err;
    const auto axis = run_command("axis " + pot.string() + " --output " + (scratch / "pot.axis.json").string() +
                                  " --annotations-out " + (scratch / "axis.ant.json").string());
    ASSERT_EQ(axis.code, 0) << axis.err;
    EXPECT_EQ(read_annotations(scratch / "axis.ant.json", body).annotations.at(0).attributes.at(0).descriptor()->file,
              "pot.axis.json");

    const AnnotationSet set = read_annotations(set_file, body);
    ASSERT_EQ(set.annotations.size(), 1U);
    ASSERT_EQ(set.annotations[0].attributes.size(), 1U);
    const Attribute& bumps = set.annotations[0].attributes[0];
    EXPECT_EQ(bumps.name, "bumpiness");
    EXPECT_EQ(bumps.descriptor()->file, "bumps.npy");
    EXPECT_EQ(bumps.descriptor()->unit, "1/mm");
    EXPECT_EQ(bumps.descriptor()->sha256, sha256_of_file(map));
    EXPECT_EQ(check().code, 0) << check().out;

    // Written again, the attribute is replaced.
    const Path earlier_file = scratch / "before.ant.json";
    std::filesystem::rename(set_file, earlier_file);
    const auto remapped = run("map " + pot.string() + " " + map.string() + " --of thickness --on face --name bumpiness" +
                              " --annotations " + earlier_file.string() + " --annotations-out " + set_file.string());
    ASSERT_EQ(remapped.code, 0) << remapped.err;
    const AnnotationSet updated = read_annotations(set_file, body);
    ASSERT_EQ(updated.annotations[0].attributes.size(), 1U);
    EXPECT_EQ(updated.annotations[0].attributes[0].descriptor()->unit, "mm");
    EXPECT_EQ(check().code, 0) << check().out;

    // A changed file, one of another mesh, and none at all are defects.
    write_values(map, std::vector<double>(body.number_of_faces(), 1));
    EXPECT_EQ(check().code, 3);
    EXPECT_NE(check().out.find("has changed since"), std::string::npos) << check().out;
    write_values(map, {1, 2, 3});
    AnnotationSet changed = updated;
    changed.annotations[0].attributes[0].descriptor()->sha256 = sha256_of_file(map);
    write_annotations(set_file, {body, changed}, pot.string(), {});
    EXPECT_EQ(check().code, 3);
    EXPECT_NE(check().out.find("which has 3 numbers"), std::string::npos) << check().out;
    std::filesystem::remove(map);
    EXPECT_EQ(check().code, 3);
    EXPECT_NE(check().out.find("is not there"), std::string::npos) << check().out;

    // At another resolution the map belongs to the old mesh.
    write_annotations(set_file, {body, set}, pot.string(), {});
    const Path finer = scratch / "finer.ply", carried = scratch / "finer.ant.json";
    const auto refined = run_command("mesh refine " + pot.string() + " " + finer.string() + " --vertices 500 --annotations " +
                                     set_file.string() + " --annotations-out " + carried.string());
    ASSERT_EQ(refined.code, 0) << refined.err;
    EXPECT_TRUE(read_annotations(carried, read_mesh(finer).mesh).annotations.at(0).attributes.at(0).descriptor()->stale);
}

TEST_F(MeasureCommand, RejectsMapsThatCannotBecomeAttributes) {
    make_folder(scratch / "in");
    const std::string map = "map " + cube.string() + " ";
    const std::string map_file = (scratch / "a.npy").string(), out = " --annotations-out " + (scratch / "a.ant.json").string();
    refused(map + (scratch / "a.txt").string() + " --of thickness" + out, 2, "end its name in .npy");
    refused(map + map_file + " --of thickness --annotations-out " + (scratch / "in" / "a.ant.json").string(), 2,
            "outside of the folder");
    refused(map + map_file + " --of thickness --name bumps", 2, "--annotations-out");
    refused(map + map_file + " --of thickness --annotations " + annotated.string(), 2, "none are written");
    refused(map + map_file + " --of thickness --annotation side" + out, 2, "add --annotations");
    refused(map + map_file + " --of thickness --annotation nose --annotations " + annotated.string() + out, 1, "nose");
    EXPECT_FALSE(file_exists(scratch / "a.ant.json"));
}

TEST_F(MeasureCommand, InvalidInputIsRejectedAndEarlierOutputsAreKept) {
    const Path out = scratch.file("out.ant.json", "earlier");
    const std::string c = cube.string(), o = " --output " + out.string();
    refused("take " + c + " --tool ruler --points 3" + o, 2, "1 pin");
    refused("take " + c + " --tool ruler" + o, 2, "0 pins");
    refused("take " + c + " --tool ruler --points 3,x" + o, 2, "3,x");
    refused("take " + c + " --tool ruler --points 3," + o, 2, "3,");
    refused("take " + c + " --tool ruler --points 3,9999" + o, 1, "vertex 9999");
    refused("take " + c + " --tool bounding --points 3,4" + o, 2, "direction");
    refused("take " + c + " --tool bounding --direction 0,0,0" + o, 2, "not zero");
    refused("take " + c + " --tool bounding --direction 0,0,nan" + o, 2, "finite");
    refused("take " + c + " --tool ruler --at 0,0,0 --at 1e200,0,0" + o, 2, "is too large");
    refused("take " + c + " --tool ruler --geodesic exact --points 3,4" + o, 2, "tape");
    refused("take " + c + " --tool ruler --points 3,4 --repeat 3" + o, 1, "picked again");
    refused("take " + c + " --tool laser --points 3,4" + o, 2, "laser");
    refused("take " + c + " --tool ruler --points 3,4 --annotations " + annotated.string() + " --annotation nose" + o, 1, "nose");
    refused("take " + c + " --tool ruler --points 3,4 --annotations " + (scratch / "none.ant.json").string() + o, 1,
            "none.ant.json");
    refused("refresh " + c + o, 2, "annotations");
    refused("map " + c + " " + out.string() + " --of geodesic", 2, "--from");
    refused("map " + c + " " + out.string() + " --of geodesic --from 9999", 2, "9999");
    refused("map " + c + " " + out.string() + " --of mean-curvature --on face", 2, "faces");
    const Path few = scratch.file("few.txt", "1\n2\n"), gap = scratch / "gap.txt";
    std::vector<double> values(mesh.number_of_vertices(), 1);
    values[5] = std::nan("");
    write_values(gap, values);
    refused("describe " + c + " --map m=" + few.string() + o, 1, "2 values");
    refused("describe " + c + " --map m=" + gap.string() + o, 1, "vertex 5");
    refused("describe " + c + " --map m=" + gap.string() + o, 1, "ostraka: " + gap.string() + ", at ");
    refused("describe " + c + " --map m=/dev/zero" + o, 1, "/dev/zero: is a device");
    refused("map " + c + " " + out.string() + " --of geodesic --from 9999", 2, cube.string() + " has");
    refused("describe " + c + " --map " + few.string() + o, 2, "NAME=FILE");
    // Pins on separate parts.
    const Path two = scratch / "two.ply";
    write_mesh(two, build_mesh(test::joined(test::box(1), test::moved(test::box(1), 1, {5, 0, 0}))));
    refused("take " + two.string() + " --tool tape --points 0,9" + o, 1, "no path");
    refused("take " + two.string() + " --tool tape --geodesic exact --points 0,9" + o, 1, "no path");
    EXPECT_EQ(read_file(out), "earlier");
}

}  // namespace
}  // namespace ostraka

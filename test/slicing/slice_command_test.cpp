// The built command, as people run it.
#include "meshes.h"
#include "ostraka/files/json.h"
#include "ostraka/io/mesh_file.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

using namespace ostraka;
using namespace ostraka::test;

namespace {

const std::string data = OSTRAKA_SOURCE_DIR "/data/";
const std::string vase = data + "vase.ply " + data + "vase.ant.json ";

std::size_t lines(const std::string& text) { return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')); }

void expect_fails(const std::string& line, int code, const std::string& words) {
    const auto result = run_command(line);
    EXPECT_EQ(result.code, code) << line << result.err;
    EXPECT_NE(result.err.find(words), std::string::npos) << line << result.err;
}

}  // namespace

TEST(SliceCommand, WritesEveryOutputIntoAFolder) {
    const Scratch scratch;
    const std::string folder = (scratch / "cut").string();
    const auto result = run_command("slice " + vase + "--count 12 --medial-axis 0.02,0.1 --output " + folder);
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.out.find("mean of barycentres"), std::string::npos);
    EXPECT_EQ(count_files(folder), 6U) << "five, and the list of them";
    const Json json = read_json(Path(folder) / "slices.json");
    validate(json, "slices", "slices.json");
    ASSERT_EQ(json["slices"].Size(), 12U);
    EXPECT_EQ(std::string(json["unit"].GetString()), "mm");
    for (const auto& slice : json["slices"].GetArray()) {
        EXPECT_TRUE(slice["completeness"]["complete"].GetBool());
        EXPECT_EQ(slice["medial_axis"].Size(), 2U);
        EXPECT_LE(slice["medial_axis"][1]["length"].GetDouble(), slice["medial_axis"][0]["length"].GetDouble() * (1 + 1e-12));
    }
    // A belly with a cavity: one component, one hole, round.
    const auto& belly = json["slices"][5]["descriptors"];
    EXPECT_EQ(belly["euler_number"].GetInt(), 0);
    EXPECT_GT(belly["eccentricity"].GetDouble(), 0.98);
    EXPECT_GT(belly["hole_area_ratio"].GetDouble(), 0.5);
    EXPECT_EQ(lines(read_file(Path(folder) / "slices.csv")), 13U);
    EXPECT_NE(read_file(Path(folder) / "slices.svg").find("</svg>"), std::string::npos);
    EXPECT_NE(read_file(Path(folder) / "profile.svg").find("</svg>"), std::string::npos);
    EXPECT_EQ(read_mesh(Path(folder) / "slices.ply").extras.face_colours.size(),
              read_mesh(data + "vase.ply").mesh.number_of_faces());
    // The same again, to the byte, on one thread.
    const std::string again = (scratch / "again").string();
    ASSERT_EQ(run_command("slice --threads 1 " + vase + "--count 12 --medial-axis 0.02,0.1 --output " + again).code, 0);
    for (const char* name : {"slices.json", "slices.csv", "slices.svg", "slices.ply", "profile.svg"})
        EXPECT_TRUE(read_file(Path(folder) / name) == read_file(Path(again) / name)) << name;  // EXPECT_EQ would print megabytes
}

TEST(SliceCommand, AFolderHoldsWhatTheLastRunWrote) {
    const Scratch scratch;
    const std::string folder = (scratch / "cut").string();
    ASSERT_EQ(run_command("slice " + vase + "--count 3 --output " + folder).code, 0);
    EXPECT_TRUE(std::filesystem::exists(Path(folder) / "profile.svg"));
    write_file(Path(folder) / "remarks.txt", "mine");
    ASSERT_EQ(run_command("slice " + vase + "--plane 0,0,100,0,0,1 --output " + folder).code, 0);
    EXPECT_FALSE(std::filesystem::exists(Path(folder) / "profile.svg")) << "one slice has no profile";
    EXPECT_TRUE(std::filesystem::exists(Path(folder) / "slices.svg"));
    EXPECT_TRUE(std::filesystem::exists(Path(folder) / "remarks.txt"));
}

TEST(SliceCommand, DirectionsHeightsAndReports) {
    const auto json_of = [](const std::string& words) {
        const auto result = run_command("slice --json " + words);
        EXPECT_EQ(result.code, 0) << words << result.err;
        Json report = parse_json(result.out, "report");
        validate(report, "report", "report");
        return report;
    };
    const Json spaced = json_of(vase + "--spacing 20 --range 0,0.5");
    const auto& slices = spaced["result"]["slices"];
    ASSERT_EQ(slices.Size(), 7U);
    EXPECT_EQ(slices[0]["height"].GetDouble(), 0);
    EXPECT_EQ(slices[6]["height"].GetDouble(), 120);
    const Json listed = json_of(vase + "--heights 40,20");
    EXPECT_EQ(listed["result"]["slices"][0]["height"].GetDouble(), 40);
    EXPECT_EQ(listed["result"]["slices"][1]["contours"], slices[1]["contours"]);
    for (const std::string direction : {"principal", "rotation", "0,0,-1"})
        EXPECT_EQ(json_of(vase + "--count 5 --direction " + direction)["result"]["slices"].Size(), 5U);
    const Json plane = json_of(vase + "--plane 0,0,100,0,0,1");
    EXPECT_EQ(plane["result"]["slices"].Size(), 1U);
    const Json axes = json_of(vase + "--count 9 --axes");
    EXPECT_EQ(axes["result"]["axes"].Size(), 6U);
    // Across a bent tube its slices are round, which they are not along any straight direction.
    const Scratch scratch;
    TriangleSoup soup = grid(40, 120, true, false, [](double u, double v) {
        const double a = 2 * M_PI * u, b = M_PI * v;
        return std::array<double, 3>{(5 + std::cos(a)) * std::cos(b), (5 + std::cos(a)) * std::sin(b), std::sin(a)};
    });
    const auto rim = static_cast<Index>(soup.points.size());
    soup.points.push_back({5, 0, 0}), soup.points.push_back({-5, 0, 0});
    for (Index i = 0; i < 40; ++i) {
        soup.triangles.push_back({rim, (i + 1) % 40, i});
        soup.triangles.push_back({rim + 1, 4800 + i, 4800 + (i + 1) % 40});
    }
    for (auto& t : soup.triangles) std::swap(t[1], t[2]);
    const std::string bent = (scratch / "bent.ply").string();
    write_triangles(bent, soup);
    const Json across = json_of(bent + " --direction skeleton --count 11 --output " + (scratch / "bent").string());
    EXPECT_EQ(std::string(across["result"]["planes"].GetString()), "across a curve");
    for (unsigned i = 2; i < 9; ++i) {
        const auto& d = across["result"]["slices"][i]["descriptors"];
        EXPECT_EQ(d["components"].GetInt(), 1);
        EXPECT_NEAR(d["equivalent_radius"].GetDouble(), 1, 0.02) << i;
        EXPECT_GT(d["eccentricity"].GetDouble(), 0.97) << i;
    }
    EXPECT_EQ(count_files(scratch / "bent"), 5U);  // no profile
}

TEST(SliceCommand, RangeMapsAndShortArcsAreNotVessels) {
    // The front of a vase as a scanner sees it from one side; then a wall of 4.6 degrees of the turn.
    const test::Scratch scratch;
    for (const double degrees : {150.0, 4.6}) {
        const std::string file = (scratch / ("front" + std::to_string(int(degrees)) + ".ply")).string();
        write_triangles(file, grid(80, 40, false, false, [&](double u, double v) {
                            const double a = (u - 0.5) * degrees * M_PI / 180, r = 10 + 3 * std::sin(3 * v);
                            return std::array<double, 3>{r * std::cos(a), r * std::sin(a), 20 * v};
                        }));
        const std::filesystem::path folder = scratch / ("slices" + std::to_string(int(degrees)));
        const auto run = run_command("slice " + file + " --count 5 --json --output " + folder.string());
        ASSERT_EQ(run.code, 0) << run.err;
        EXPECT_TRUE(std::filesystem::exists(folder / "slices.svg"));
        EXPECT_FALSE(std::filesystem::exists(folder / "profile.svg")) << degrees;
        const Json slices = read_json((folder / "slices.json").string());
        ASSERT_EQ(slices["slices"].Size(), 5U);
        for (const auto& slice : slices["slices"].GetArray()) {
            const auto& complete = slice["completeness"];
            EXPECT_NEAR(complete["share"].GetDouble(), degrees / 360, 1e-3 + 0.01 * degrees / 360);
            EXPECT_GE(complete["share_at_most"].GetDouble(), complete["share"].GetDouble());
        }
    }
    // A closed one is drawn.
    ASSERT_EQ(run_command("slice " + vase + "--count 5 --output " + (scratch / "whole").string()).code, 0);
    EXPECT_TRUE(std::filesystem::exists(scratch / "whole" / "profile.svg"));
}

TEST(SliceCommand, ReportsOpenScansAndParts) {
    const Scratch scratch;
    const std::string open = (scratch / "open.ply").string(), json = (scratch / "o.json").string();
    write_triangles(open, grid(60, 10, false, false, [](double u, double v) {
                        return std::array<double, 3>{std::cos(5 * u), std::sin(5 * u), v};
                    }));
    const auto result =
        run_command("slice " + open + " --count 3 --output " + json + " --output " + (scratch / "o.svg").string());
    EXPECT_EQ(result.code, 0);
    EXPECT_NE(result.err.find("no slice has a closed contour"), std::string::npos) << result.err;
    const Json document = read_json(json);
    validate(document, "slices", json);
    const auto& slice = document["slices"][0];
    EXPECT_FALSE(slice["completeness"]["complete"].GetBool());
    EXPECT_FALSE(slice["descriptors"].HasMember("area"));
    EXPECT_TRUE(slice["descriptors"].HasMember("fitted_radius"));
    EXPECT_FALSE(slice["contours"][0]["closed"].GetBool());
    // A handle alone: its slices end where the body begins.
    const auto handle =
        run_command("slice --json " + data + "teapot.ply " + data + "teapot.ant.json --annotation handle --count 8");
    ASSERT_EQ(handle.code, 0) << handle.err;
    EXPECT_EQ(parse_json(handle.out, "report")["result"]["slices"].Size(), 8U);
}

TEST(SliceCommand, InvalidInputIsReportedAndWritesNothing) {
    const Scratch scratch;
    const std::string file = (scratch / "o.json").string();
    const auto missed =
        run_command("slice " + vase + "--heights 1000 --output " + file + " --output " + (scratch / "o.svg").string());
    EXPECT_EQ(missed.code, 3);
    EXPECT_NE(missed.err.find("no plane meets the mesh: its heights go from 0 to"), std::string::npos) << missed.err;
    EXPECT_EQ(read_json(file)["slices"][0]["contours"].Size(), 0U);
    EXPECT_FALSE(std::filesystem::exists(scratch / "o.svg"));
    const auto plane = run_command("slice " + vase + "--plane 0,0,900,0,0,1");
    EXPECT_EQ(plane.code, 3);
    EXPECT_NE(plane.err.find("the plane misses the mesh"), std::string::npos);
    std::filesystem::remove(file);
    expect_fails("slice " + vase + "--count 3 --spacing 2", 2, "more than one way");
    expect_fails("slice " + vase + "--plane 0,0,1", 2, "six numbers");
    expect_fails("slice " + vase + "--plane 0,0,1,0,0,0", 2, "no direction");
    expect_fails("slice " + vase + "--range 0.4,0.2", 2, "--range");
    expect_fails("slice " + vase + "--heights 1,two", 2, "heights is '1,two'");
    expect_fails("slice " + vase + "--heights 1e999", 2, "heights is '1e999'");
    expect_fails("slice " + vase + "--direction 0,0,0", 2, "--direction");
    expect_fails("slice " + vase + "--direction sideways", 2, "--direction");
    expect_fails("slice " + vase + "--spacing 1e-9", 2, "spacing");
    expect_fails("slice " + vase + "--annotation nothing", 1, "nothing");
    expect_fails("slice " + vase + "--medial-axis 2 --output " + file, 2, "use a value from 0.001 to 1");
    expect_fails("slice " + vase + "--colour-by beauty --output " + (scratch / "o.ply").string(), 2, "beauty");
    expect_fails("slice " + vase + "--output " + (scratch / "o.txt").string(), 2, "end its name in");
    expect_fails("slice " + vase + "--profile " + (scratch / "o.gif").string(), 2, "is not a drawing");
    expect_fails("slice " + data + "vase.ply --annotation foo", 2, "no annotation file is given");
    expect_fails("slice " + data + "vase.ply --output " + data + "vase.ply", 2, "vase.ply");
    const std::string ball = (scratch / "ball.ply").string();
    ASSERT_EQ(run_command("mesh make sphere " + ball + " --vertices 500").code, 0);
    expect_fails("slice " + ball + " --direction principal", 3, "no principal axis");
    EXPECT_EQ(count_files(scratch.path()), 1U);
}

TEST(SliceCommand, ReportsInvalidNumbers) {
    const auto fails = [](const std::string& flags, const std::string& words) {
        expect_fails("slice " + vase + flags, 2, words);
    };
    fails("--plane 1e300,0,0,0,0,1", "its point is not valid");
    fails("--plane nan,0,0,0,0,1", "its point is not valid");
    fails("--plane 0,0,0,0,0,0", "its normal has no direction");
    fails("--plane 0,0,0,inf,0,0", "its normal has no direction");
    for (const char* angle : {"nan", "inf", "1e300", "3,4", "x"})
        fails(std::string("--profile-angle ") + angle, "profile-angle is ");
    for (const char* spacing : {"nan", "inf", "0", "-1", "1e300", "x"}) fails(std::string("--spacing ") + spacing, "spacing is ");
    // The number of slices, and a reasonable value.
    const auto too_many = run_command("slice " + vase + "--spacing 1e-9");
    EXPECT_EQ(too_many.code, 2);
    EXPECT_NE(too_many.err.find("2.589e+11 slices"), std::string::npos) << too_many.err;
    EXPECT_NE(too_many.err.find("use at least 0.000259"), std::string::npos) << too_many.err;
    EXPECT_EQ(too_many.err.find("0.000000"), std::string::npos) << too_many.err;
    for (const char* heights : {"nan", "1e300", "10,inf"}) {
        const auto result = run_command("slice " + vase + "--heights " + heights);
        EXPECT_EQ(result.code, 2);
        EXPECT_NE(result.err.find("--heights has "), std::string::npos) << result.err;
        EXPECT_LT(result.err.size(), 200U);  // not three hundred digits
    }
    fails("--range nan,1", "range is nan");
    fails("--count 0", "count is 0");
    fails("--drawn 0", "drawn is 0");
    fails("--medial-axis 0.1,nan,0.2", "medial-axis is nan");
    fails("--similarity nan", "similarity");
    // For a plane that misses the mesh, the message gives the mesh's position.
    const auto missed = run_command("slice " + vase + "--plane 0,0,1000,0,0,1");
    EXPECT_EQ(missed.code, 3);
    EXPECT_NE(missed.err.find("heights above it go from -1000"), std::string::npos) << missed.err;
}

TEST(SliceCommand, RejectsInvalidOutputs) {
    expect_fails("slice " + vase + "--count 3 --output ''", 2, "output is empty");
    expect_fails("slice " + vase + "--count 3 --profile ''", 2, "profile is empty");
    expect_fails("slice " + vase + "--count 3 --output /dev/full", 2, "is a file");
    const Scratch scratch;
    write_file(scratch / "taken", "text");
    expect_fails("slice " + vase + "--count 3 --output " + (scratch / "taken").string(), 2, "is a file");
    expect_fails("slice " + vase + "--count 3 --output " + (scratch / "taken" / "within").string(), 1, "cannot be created");
    std::filesystem::create_symlink("/dev/full", scratch / "full.csv");
    expect_fails("slice " + vase + "--count 3 --output " + (scratch / "full.csv").string(), 1, "cannot be written");
    EXPECT_EQ(read_file(scratch / "taken"), "text");
}

TEST(SliceCommand, SlicesOfNothingAreEmpty) {
    const Scratch scratch;
    const std::string folder = (scratch / "cut").string();
    const auto result = run_command("slice " + vase + "--heights 100,1000 --output " + folder);
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.out.find("empty"), std::string::npos);
    const Json json = read_json(Path(folder) / "slices.json");
    validate(json, "slices", "slices.json");
    EXPECT_TRUE(json["slices"][0]["completeness"]["complete"].GetBool());
    EXPECT_FALSE(json["slices"][0]["completeness"]["empty"].GetBool());
    EXPECT_FALSE(json["slices"][1]["completeness"]["complete"].GetBool());
    EXPECT_TRUE(json["slices"][1]["completeness"]["empty"].GetBool());
    EXPECT_FALSE(json["slices"][1]["completeness"].HasMember("share"));
    EXPECT_NE(read_file(Path(folder) / "slices.csv").find("\n2,mm,1000,0,0,,,,,,,"), std::string::npos);
}

TEST(SliceCommand, ReportsIntersectingAndReversedParts) {
    const Scratch scratch;
    const auto run = [&](const std::string& name, const TriangleSoup& soup) {
        const std::string mesh = (scratch / (name + ".ply")).string();
        write_triangles(mesh, soup);
        auto result = run_command("slice --count 20 " + mesh + " --output " + (scratch / name).string());
        EXPECT_EQ(result.code, 0) << result.err;
        return result;
    };
    const TriangleSoup ball = octahedron_sphere(4);
    const auto crossing = run("crossing", joined(ball, moved(ball, 1, {1.5, 0, 0})));
    EXPECT_NE(crossing.err.find("of 20 slices, at height 0.35 to 1.65, have contours that cross"), std::string::npos)
        << crossing.err;
    EXPECT_NE(crossing.err.find("mesh repair --wrap"), std::string::npos);
    const Json json = read_json(scratch / "crossing" / "slices.json");
    validate(json, "slices", "slices.json");
    const auto& middle = json["slices"][10];
    EXPECT_EQ(middle["completeness"]["crossing_contours"].GetInt(), 2);
    EXPECT_GT(middle["completeness"]["doubtful_share"].GetDouble(), 1e-3);
    EXPECT_TRUE(middle["contours"][0]["crosses"].GetBool());
    EXPECT_FALSE(middle["descriptors"].HasMember("area"));
    EXPECT_FALSE(middle["descriptors"].HasMember("components"));
    EXPECT_TRUE(middle["descriptors"].HasMember("box_length"));
    EXPECT_TRUE(json["slices"][0]["descriptors"].HasMember("area"));
    const auto cavity = run("cavity", joined(ball, moved(ball, 0.5, {0, 0, 0})));
    EXPECT_NE(cavity.err.find("orientation contradicts their nesting"), std::string::npos) << cavity.err;
    const Json nested = read_json(scratch / "cavity" / "slices.json");
    validate(nested, "slices", "slices.json");
    EXPECT_EQ(nested["slices"][10]["descriptors"]["holes"].GetInt(), 1);
    EXPECT_EQ(nested["slices"][10]["completeness"]["turned_contours"].GetInt(), 1);
    const auto clay = run_command("measure clay " + (scratch / "crossing.ply").string());
    EXPECT_EQ(clay.code, 0);
    EXPECT_NE(clay.err.find("contours that cross"), std::string::npos) << clay.err;
    const auto reversed = run_command("measure clay " + (scratch / "cavity.ply").string());
    EXPECT_NE(reversed.err.find("contradicts their nesting"), std::string::npos) << reversed.err;
}

TEST(SliceCommand, MeshesWithoutSurfaceOrSkeleton) {
    const Scratch scratch;
    const std::string line = (scratch / "line.ply").string(), flat = (scratch / "flat.ply").string(),
                      pinched = (scratch / "pinched.ply").string();
    write_triangles(line, {{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}, {{0, 1, 2}}});
    for (const char* flags : {"", " --direction skeleton", " --direction principal"})
        expect_fails("slice " + line + flags, 1, "triangles are lines or points");
    write_triangles(flat, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
    expect_fails("slice " + flat, 3, "flat across this direction");
    expect_fails("measure clay " + flat, 3, "no height along this direction");
    expect_fails("slice " + flat + " --direction skeleton", 3, "slice along another --direction");
}

TEST(SliceCommand, ProfilesRequireSurfacesOfRevolution) {
    const Scratch scratch;
    const std::string cube = (scratch / "cube.ply").string(), folder = (scratch / "cut").string();
    write_triangles(cube, box(3));
    const auto left_out = run_command("slice --count 4 " + cube + " --output " + folder);
    EXPECT_EQ(left_out.code, 0) << left_out.err;
    EXPECT_NE(left_out.err.find("not a surface of revolution"), std::string::npos) << left_out.err;
    EXPECT_FALSE(std::filesystem::exists(Path(folder) / "profile.svg"));
    const auto requested =
        run_command("slice --count 4 " + cube + " --title 'A box of mine' --profile " + (scratch / "p.svg").string());
    EXPECT_EQ(requested.code, 0);
    EXPECT_NE(requested.err.find("not a surface of revolution"), std::string::npos) << requested.err;
    EXPECT_TRUE(std::filesystem::exists(scratch / "p.svg"));
    const auto revolved = run_command("slice --count 4 " + vase + "--output " + folder);
    EXPECT_EQ(revolved.err.find("not a surface of revolution"), std::string::npos) << revolved.err;
    EXPECT_TRUE(std::filesystem::exists(Path(folder) / "profile.svg"));
}

TEST(SliceCommand, DirectionsInWords) {
    const auto expect_same_output = [](const std::string& words, const std::string& numbers) {
        const auto a = run_command("slice " + vase + "--count 3 " + words),
                   b = run_command("slice " + vase + "--count 3 " + numbers);
        EXPECT_EQ(a.code, 0) << a.err;
        EXPECT_EQ(a.out, b.out) << words;
    };
    expect_same_output("--up y", "--up 0,1,0");
    expect_same_output("--up -z", "--up 0,0,-1");
    expect_same_output("--direction -x", "--direction -1,0,0");
    expect_fails("slice " + vase + "--up w", 2, "x, y, z, -x, -y, -z");
    expect_fails("slice " + vase + "--direction diagonal", 2, "up, principal, rotation, skeleton");
    const auto rotation = run_command("slice " + data + "vase.ply --count 3 --direction rotation");
    EXPECT_NE(rotation.err.find("give --up"), std::string::npos) << rotation.err;
    EXPECT_EQ(run_command("slice " + vase + "--count 3 --direction rotation").err.find("give --up"), std::string::npos);
}

TEST(SliceCommand, ReportsOfTwoSlicesAndSkeletons) {
    const auto pair = run_command("slice " + vase + "--heights 60,120");
    EXPECT_EQ(pair.code, 0);
    EXPECT_NE(pair.out.find("two barycentres are always collinear"), std::string::npos) << pair.out;
    EXPECT_NE(pair.out.find("2 of 2 slices show the wall alone"), std::string::npos) << pair.out;
    const auto single = run_command("slice " + vase + "--heights 60");
    EXPECT_NE(single.out.find("the variation between slices needs two of them"), std::string::npos) << single.out;
    EXPECT_EQ(single.out.find("along the curve"), std::string::npos);
    const auto curve = run_command("slice " + vase + "--direction skeleton --count 4");
    EXPECT_NE(curve.out.find("along the curve"), std::string::npos) << curve.out;
    EXPECT_NE(curve.err.find("the object is hollow"), std::string::npos) << curve.err;
    const Scratch scratch;
    const std::string bar = (scratch / "bar.ply").string();
    write_triangles(bar, moved(octahedron_sphere(4), 3, {0, 0, 0}));
    const auto solid = run_command("slice " + bar + " --direction skeleton --count 4");
    EXPECT_EQ(solid.err.find("the object is hollow"), std::string::npos) << solid.err;
}

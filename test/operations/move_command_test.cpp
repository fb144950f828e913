// `ostraka mesh move` as users run it.
#include "meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/message_text.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/io/mesh_file.h"
#include "scratch.h"

#include <Eigen/Geometry>

using namespace ostraka;
using namespace ostraka::test;

namespace {

const std::string data = OSTRAKA_SOURCE_DIR "/data/";

class MoveCommand : public ::testing::Test {
protected:
    [[nodiscard]] std::string at(const std::string& name) const { return (scratch / name).string(); }
    /// Moves a file of the folder; fails unless the exit code is 0.
    CommandResult move(const std::string& from, const std::string& to, const std::string& options) const {
        const CommandResult result = run_command("mesh move " + at(from) + " " + at(to) + " " + options);
        EXPECT_EQ(result.code, 0) << options << result.err;
        return result;
    }
    void write(const std::string& name, const TriangleSoup& soup) const { write_triangles(scratch / name, soup); }
    [[nodiscard]] std::vector<std::array<double, 3>> points(const std::string& name) const {
        return read_polygons(scratch / name).points;
    }
    /// The points after `move --options`.
    std::vector<std::array<double, 3>> moved(const std::string& options) const {
        move("a.ply", "b.ply", options);
        return points("b.ply");
    }
    Scratch scratch;
};

using Places = std::vector<std::array<double, 3>>;

template <class Map>
Places mapped(const Places& points, const Map& map) {
    Places result;
    for (const auto& p : points) result.push_back(map(p));
    return result;
}

/// Exponent of the unit of length in a unit such as "mm^2" or "1/mm".
int power_of_length(const std::string& unit) {
    if (unit.empty() || unit == "rad") return 0;
    const int power = unit.ends_with("^3") ? 3 : unit.ends_with("^2") ? 2 : 1;
    return unit.starts_with("1/") ? -power : power;
}

double largest_difference(const Places& a, const Places& b) {
    double largest = a.size() == b.size() ? 0 : std::numeric_limits<double>::infinity();
    for (std::size_t v = 0; v < std::min(a.size(), b.size()); ++v)
        for (std::size_t k = 0; k < 3; ++k) largest = std::max(largest, std::abs(a[v][k] - b[v][k]));
    return largest;
}

}  // namespace

TEST_F(MoveCommand, StepsAreExactWhereTheirResultsAreNumbers) {
    write("a.ply", joined(torus(20, 10), test::moved(box(3), 2, {7, 0.5, -3})));
    const Places p = points("a.ply");
    using Place = std::array<double, 3>;
    EXPECT_EQ(moved("--translate 16,-0.5,1024"), mapped(p, [](const Place& q) {
                  return Place{q[0] + 16, q[1] - 0.5, q[2] + 1024};
              }));
    EXPECT_EQ(moved("--axes y-up"), mapped(p, [](const Place& q) { return Place{q[0], q[2], -q[1]}; }));
    EXPECT_EQ(moved("--axes z-up"), mapped(p, [](const Place& q) { return Place{q[0], -q[2], q[1]}; }));
    EXPECT_EQ(moved("--axes -z,x,y"), mapped(p, [](const Place& q) { return Place{-q[2], q[0], q[1]}; }));
    EXPECT_EQ(moved("--mirror x"), mapped(p, [](const Place& q) { return Place{-q[0], q[1], q[2]}; }));
    EXPECT_EQ(moved("--rotate z,90"), mapped(p, [](const Place& q) { return Place{-q[1], q[0], q[2]}; }));
    EXPECT_EQ(moved("--rotate z,-630"), moved("--rotate z,90"));
    EXPECT_EQ(moved("--rotate x,180"), mapped(p, [](const Place& q) { return Place{q[0], -q[1], -q[2]}; }));
    EXPECT_EQ(moved("--quaternion 0,0,0,2"), mapped(p, [](const Place& q) { return Place{-q[0], -q[1], q[2]}; }));
    EXPECT_EQ(moved("--from-unit m --to-unit mm"), mapped(p, [](const Place& q) {
                  return Place{1000 * q[0], 1000 * q[1], 1000 * q[2]};
              }));
    EXPECT_EQ(moved("--from-unit in --to-unit mm"), mapped(p, [](const Place& q) {
                  return Place{25.4 * q[0], 25.4 * q[1], 25.4 * q[2]};
              }));
    EXPECT_LT(largest_difference(moved("--rotate 1,1,1,120"), mapped(p,
                                                                     [](const Place& q) {
                                                                         return Place{q[2], q[0], q[1]};
                                                                     })),
              1e-14);
    // The order is that of the documentation: scale, then rotation, then translation.
    EXPECT_EQ(moved("--translate 1,0,0 --rotate z,90 --scale 2"), mapped(p, [](const Place& q) {
                  return Place{-2 * q[1] + 1, 2 * q[0], 2 * q[2]};
              }));
    EXPECT_EQ(moved("--scale 2 --about 4,0,0"), mapped(p, [](const Place& q) {
                  return Place{2 * q[0] - 4, 2 * q[1], 2 * q[2]};
              }));
}

TEST_F(MoveCommand, CentresInBoxCentroidAndOnTheGround) {
    write("a.ply", test::moved(box(4), 3, {512345.25, 5412345.5, 100}));
    for (const char* centre : {"box", "centroid"}) {
        const Places p = moved(std::string("--rotate z,30 --centre ") + centre);
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (const auto& q : p) sum += Eigen::Vector3d(q[0], q[1], q[2]);
        EXPECT_LT((sum / double(p.size())).norm(), 2e-9) << centre << ": to the rounding of the coordinates in the grid";
    }
    double lowest = 1, west = 0, east = 0;
    for (const auto& q : moved("--centre base"))
        lowest = std::min(lowest, q[2]), west = std::min(west, q[0]), east = std::max(east, q[0]);
    EXPECT_EQ(lowest, 0);
    EXPECT_EQ(west, -1.5);
    EXPECT_EQ(east, 1.5);
    double lowest_y = 1;
    for (const auto& q : moved("--centre base --up y")) lowest_y = std::min(lowest_y, q[1]);
    EXPECT_EQ(lowest_y, 0);
    EXPECT_EQ(largest_difference(moved("--mirror y --about box"), moved("--mirror y --about 0,5412347,0")), 0);
}

TEST_F(MoveCommand, AMirroredMeshStaysOutwardsAndUnsoundMeshesMove) {
    TriangleSoup cube = box(2);
    write("a.ply", cube);
    move("a.ply", "b.ply", "--mirror 1,1,0");
    EXPECT_EQ(run_command("mesh info " + at("b.ply")).code, 0) << "closed, oriented outwards";
    cube.triangles.push_back(cube.triangles[0]);
    cube.triangles.push_back({0, 1, 1});
    write("a.ply", cube);
    move("a.ply", "b.ply", "--axes y,x,z");
    const auto diagnosis = diagnose(triangulate(read_polygons(scratch / "b.ply")).soup);
    EXPECT_EQ(diagnosis.duplicate_triangles, 1U);
    EXPECT_GT(diagnosis.volume, 0);
}

TEST_F(MoveCommand, TheTransformUndoesTheMotion) {
    write("a.ply", torus(30, 20));
    const std::string motion =
        "--from-unit cm --to-unit m --axes z-up --scale 3 --mirror 1,2,3 --rotate 0,1,1,40 --about centroid "
        "--centre base --translate 5,6,7 --transform ";
    const CommandResult result = move("a.ply", "b.ply", motion + at("t.json") + " --json");
    const Json report = parse_json(result.out, "report"), transform = read_json(scratch / "t.json");
    validate(report, "report", "report");
    EXPECT_EQ(report["result"]["matrix"], transform["matrix"]);
    EXPECT_NEAR(transform["scale"].GetDouble(), 0.03, 1e-17);
    EXPECT_TRUE(transform["mirrored"].GetBool());
    move("b.ply", "c.ply", "--matrix " + at("t.json") + " --inverse");
    EXPECT_LT(largest_difference(points("a.ply"), points("c.ply")), 1e-12);
    move("a.ply", "d.ply", "--matrix " + at("t.json"));
    EXPECT_LT(largest_difference(points("b.ply"), points("d.ply")), 1e-14);
    // The matrix of a registration.
    ASSERT_EQ(run_command("mesh make teapot " + at("pot.ply") + " --vertices 2000").code, 0);
    move("pot.ply", "away.ply", "--rotate 1,2,3,50 --scale 0.5 --translate 1,2,3");
    ASSERT_EQ(
        run_command("mesh register " + at("away.ply") + " " + at("pot.ply") + " " + at("r.ply") + " --matrix " + at("m.json"))
            .code,
        0);
    move("away.ply", "again.ply", "--matrix " + at("m.json"));
    EXPECT_LT(largest_difference(points("r.ply"), points("again.ply")), 1e-12);
}

TEST_F(MoveCommand, MeasuresOfTheMovedObjectAgree) {
    for (const char* kind : {".ply", ".ant.json"})
        write_file(scratch / ("a" + std::string(kind)), read_file(data + "teapot" + kind));
    // Descriptors of each kind, and values to full precision.
    const std::string annotated = at("a.ply") + " --annotations ";
    ASSERT_EQ(run_command("measure describe --annotation body --annotation spout --curvature --thickness --rays 3 " + annotated +
                          at("a.ant.json") + " --output " + at("a1.ant.json"))
                  .code,
              0);
    ASSERT_EQ(run_command("measure refresh " + annotated + at("a1.ant.json") + " --output " + at("a2.ant.json")).code, 0);
    const Mesh mesh = read_mesh(scratch / "a.ply").mesh;
    const AnnotationSet before = read_annotations(scratch / "a2.ant.json", mesh);
    for (const auto& [options, factor, unit] :
         std::vector<std::tuple<std::string, double, std::string>>{{"--rotate 1,2,3,77 --centre base", 1, "mm"},
                                                                   {"--mirror x --translate 100,0,0", 1, "mm"},
                                                                   {"--axes y-up --scale 2.5", 2.5, "mm"},
                                                                   {"--to-unit m --rotate z,15", 0.001, "m"}}) {
        move("a.ply", "b.ply", options + " --annotations " + at("a2.ant.json") + " --annotations-out " + at("b.ant.json"));
        const Mesh moved_mesh = read_mesh(scratch / "b.ply").mesh;
        const AnnotationSet after = read_annotations(scratch / "b.ant.json", moved_mesh);
        EXPECT_EQ(after.unit, unit);
        ASSERT_EQ(after.annotations.size(), before.annotations.size());
        std::size_t compared = 0;
        const auto scale_of = [&](int power) { return std::pow(factor * box_diagonal(mesh), power); };
        for (std::size_t a = 0; a < before.annotations.size(); ++a) {
            EXPECT_EQ(after.annotations[a].faces, before.annotations[a].faces);
            for (std::size_t i = 0; i < before.annotations[a].attributes.size(); ++i) {
                const Attribute &old = before.annotations[a].attributes[i], &now = after.annotations[a].attributes[i];
                const Figures old_values = attribute_values(old), new_values = attribute_values(now);
                if (old_values.values.size() != 1) continue;
                const int power = power_of_length(old_values.unit);
                EXPECT_EQ(power_of_length(new_values.unit), power);
                EXPECT_TRUE(power == 0 || new_values.unit.find(unit) != std::string::npos) << new_values.unit;
                const double expected = old_values.values[0] * std::pow(factor, power);
                // Integrals of curvature and bounds of volumes are sums in which larger numbers cancel.
                const bool cancels = old.name.find("integral") != std::string::npos || old.name == "volume bound";
                EXPECT_NEAR(new_values.values[0], expected, 1e-12 * std::abs(expected) + (cancels ? 1e-9 * scale_of(power) : 0))
                    << options << old.name << before.annotations[a].tag;
                ++compared;
            }
        }
        EXPECT_GT(compared, 30U);
        EXPECT_EQ(run_command("annotation check " + at("b.ply") + " " + at("b.ant.json")).code, 0) << options;
    }
}

TEST_F(MoveCommand, RelationsCageAndCoordinatesFollow) {
    for (const char* kind : {".ply", ".ant.json"})
        write_file(scratch / ("a" + std::string(kind)), read_file(data + "teapot" + kind));
    ASSERT_EQ(run_command("relation extract " + at("a.ply") + " " + at("a.ant.json") + " " + at("a.graph.json")).code, 0);
    ASSERT_EQ(run_command("cage make " + at("a.ply") + " " + at("cage.ply") + " --vertices 60").code, 0);
    for (const char* kind : {"mean-value", "green"})
        ASSERT_NE(run_command("cage weights " + at("a.ply") + " " + at("cage.ply") + " " + at(kind) + ".npy --kind " + kind).code,
                  1);
    for (const char* kind : {"mean-value", "green"})
        for (const char* options : {"--rotate 1,0,2,33 --to-unit m --centre box ", "--mirror y --translate 1000,0,0 "}) {
            move("a.ply", "b.ply",
                 options + ("--annotations " + at("a.ant.json")) + " --annotations-out " + at("b.ant.json") + " --graph " +
                     at("a.graph.json") + " --graph-out " + at("b.graph.json") + " --cage " + at("cage.ply") + " --cage-out " +
                     at("b.cage.ply") + " --coordinates " + at(kind) + ".npy --coordinates-out " + at("b.npy"));
            const auto check = run_command("relation check " + at("b.ply") + " " + at("b.ant.json") + " " + at("b.graph.json"));
            EXPECT_EQ(check.code, 0) << check.out;
            EXPECT_EQ(run_command("cage check " + at("b.cage.ply") + " " + at("b.ply")).code,
                      run_command("cage check " + at("cage.ply") + " " + at("a.ply")).code);
            // The header of the coordinates holds their certificate.
            const Json header = read_json(scratch / "b.coordinates.json");
            EXPECT_LT(header["certificate"]["linear"].GetDouble(), 1e-9) << kind;
        }
}

TEST_F(MoveCommand, RefusesWhatDoesNotFit) {
    for (const char* kind : {".ply", ".ant.json"})
        write_file(scratch / ("a" + std::string(kind)), read_file(data + "teapot" + kind));
    write_file(scratch / "shear.txt", "1 0.1 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    const std::string annotated = " --annotations " + at("a.ant.json") + " --annotations-out " + at("b.ant.json");
    for (const auto& [options, code, words] : std::vector<std::tuple<std::string, int, std::string>>{
             {"", 2, "no motion"},
             {"--translate 1,2", 2, "--translate"},
             {"--translate 1,2,inf", 2, "finite"},
             {"--axes x,y", 2, "--axes"},
             {"--axes x,y,x", 2, "--axes"},
             {"--axes x,y,w", 2, "--axes"},
             {"--rotate z", 2, "--rotate"},
             {"--rotate 0,0,0,90", 2, "not zero"},
             {"--rotate z,90 --quaternion 1,0,0,0", 2, "one of them"},
             {"--quaternion 0,0,0,0", 2, "--quaternion"},
             {"--scale 0", 2, "scale"},
             {"--scale -1", 2, "scale"},
             {"--inverse", 2, "--matrix"},
             {"--from-unit mm", 2, "--to-unit"},
             {"--to-unit mm", 2, "--from-unit"},
             {"--to-unit ell", 2, "ell"},
             {"--about box --translate 1,2,3", 2, "--about"},
             {"--centre middle", 2, "middle"},
             {"--matrix " + at("shear.txt"), 1, "shears"},
             {"--matrix " + at("none.txt"), 1, "none.txt"},
             {"--translate 1,2,3 --annotations " + at("a.ant.json"), 2, "--annotations-out"},
             {"--translate 1,2,3 --graph " + at("a.ant.json") + " --graph-out " + at("g.graph.json"), 2, "--annotations"},
             {"--from-unit m --to-unit cm" + annotated, 1, "--from-unit is m"}}) {
        const CommandResult result = run_command("mesh move " + at("a.ply") + " " + at("b.ply") + " " + options);
        EXPECT_EQ(result.code, code) << options << result.err;
        EXPECT_NE(result.err.find(words), std::string::npos) << options << ": " << result.err;
        EXPECT_FALSE(std::filesystem::exists(scratch / "b.ply")) << options;
    }
}

TEST_F(MoveCommand, MeshInfoShowsTheDigitsOfPlaces) {
    write("a.ply", test::moved(box(2), 2.5, {512345.675, 5412345.125, 0.3}));
    const CommandResult result = run_command("mesh info " + at("a.ply"));
    EXPECT_NE(result.out.find("from (512345.675, 5412345.125, 0.3)"), std::string::npos) << result.out;
}

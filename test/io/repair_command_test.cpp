// The built commands mesh info and mesh repair, as users run them.
#include "ostraka/files/file.h"
#include "ostraka/files/json.h"
#include "ostraka/io/mesh_file.h"
#include "soups.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include <sys/wait.h>
#include <unistd.h>

using namespace ostraka;
using namespace ostraka::soups;

namespace {

struct Outcome {
    int code = -1;
    std::string out, err;
    double seconds = 0;
};

class Folder {
public:
    Folder() : path_(std::filesystem::temp_directory_path() / ("ostraka_repair_test_" + std::to_string(getpid()))) {
        std::filesystem::create_directories(path_);
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }

private:
    std::filesystem::path path_;
};

Outcome run(const Folder& folder, const std::string& arguments) {
    Outcome result;
    const auto start = std::chrono::steady_clock::now();
    const std::string out = folder.file("stdout"), err = folder.file("stderr");
    const int status = std::system(("timeout 60 " OSTRAKA_COMMAND " " + arguments + " > " + out + " 2> " + err).c_str());
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.out = read_file(out);
    result.err = read_file(err);
    return result;
}

void write_off(const std::string& file, const TriangleSoup& s) {
    std::string text = "OFF\n" + std::to_string(s.points.size()) + " " + std::to_string(s.triangles.size()) + " 0\n";
    for (const auto& p : s.points) text += std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + "\n";
    for (const auto& t : s.triangles)
        text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
    write_file(file, text);
}

}  // namespace

TEST(MeshInfoCommand, DistinguishesSoundFromDefective) {
    const Folder folder;
    write_off(folder.file("cube.off"), cube());
    const Outcome good = run(folder, "mesh info " + folder.file("cube.off") + " --json");
    EXPECT_EQ(good.code, 0) << good.err;
    EXPECT_NE(good.err.find("read"), std::string::npos);  // the shares of time
    const Json report = parse_json(good.out, "stdout");
    validate(report, "report", "stdout");
    EXPECT_TRUE(report["result"]["sound"].GetBool());
    EXPECT_DOUBLE_EQ(report["result"]["size"]["volume"].GetDouble(), 1);
    EXPECT_EQ(report["result"]["components"][0]["genus"].GetInt(), 0);
    EXPECT_TRUE(report["run"]["seconds"].HasMember("read"));
    EXPECT_FALSE(report["result"]["size"].HasMember("volume_note"));

    auto open = cube();
    open.triangles.pop_back();
    write_off(folder.file("open.off"), open);
    const Outcome bad = run(folder, "mesh info " + folder.file("open.off"));
    EXPECT_EQ(bad.code, 3);
    EXPECT_NE(bad.out.find("3 border edges"), std::string::npos) << bad.out;
    EXPECT_EQ(run(folder, "mesh info " + folder.file("open.off") + " --skip-self-intersections").code, 3);
    EXPECT_EQ(run(folder, "mesh info " + folder.file("missing.off")).code, 1);
    EXPECT_EQ(run(folder, "mesh info").code, 2);
}

TEST(MeshInfoCommand, CracksNameAMergeDistanceThatFits) {
    const Folder folder;
    // Every triangle with separate corners, each displaced by up to a thousandth of the radius.
    const TriangleSoup intact = sphere();
    TriangleSoup torn;
    std::uint32_t state = 1;
    const auto jitter = [&state] {
        state = state * 1664525U + 1013904223U;
        return 1e-3 * (static_cast<double>(state >> 8) / (1U << 23) - 1);
    };
    for (const auto& triangle : intact.triangles) {
        std::array<Index, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = static_cast<Index>(torn.points.size());
            Place place = intact.points[triangle[k]];
            for (double& x : place) x += jitter();
            torn.points.push_back(place);
        }
        torn.triangles.push_back(corners);
    }
    write_off(folder.file("torn.off"), torn);
    const Outcome info = run(folder, "mesh info --skip-self-intersections " + folder.file("torn.off"));
    EXPECT_EQ(info.code, 3);
    const std::size_t option_begin = info.err.find("--merge-distance ");
    ASSERT_NE(option_begin, std::string::npos) << info.err;
    const std::string share = info.err.substr(option_begin + 17, info.err.find(')', option_begin) - option_begin - 17);
    EXPECT_GT(std::stod(share), 1e-3 / std::sqrt(12.0));
    EXPECT_LT(std::stod(share), 0.02);
    const Outcome repaired = run(folder, "mesh repair --json " + folder.file("torn.off") + " " + folder.file("whole.ply") +
                                             " --merge-gap 0 --merge-distance " + share);
    const Json report = parse_json(repaired.out, "stdout");
    EXPECT_TRUE(report["result"]["after"]["closed"].GetBool()) << repaired.err;
    EXPECT_EQ(report["result"]["after"]["component_count"].GetInt(), 1);
    // Holes are not cracks.
    TriangleSoup open = intact;
    open.triangles.resize(open.triangles.size() - 30);
    write_off(folder.file("open.off"), open);
    EXPECT_EQ(run(folder, "mesh info " + folder.file("open.off")).err.find("--merge-distance"), std::string::npos);
}

TEST(MeshInfoCommand, ReportDoesNotDependOnThreads) {
    const Folder folder;
    write_off(folder.file("s.off"), both(sphere(40, 80), sphere(40, 80, 1, {0.4, 0.1, 0})));
    Json single_thread = parse_json(run(folder, "mesh info --json --threads 1 " + folder.file("s.off")).out, "one");
    Json four = parse_json(run(folder, "mesh info --json --threads 4 " + folder.file("s.off")).out, "four");
    single_thread.RemoveMember("run");
    four.RemoveMember("run");
    EXPECT_EQ(to_text(single_thread), to_text(four));
    EXPECT_GT(single_thread["result"]["self_intersections"].GetInt(), 0);
}

TEST(MeshRepairCommand, WritesMeshMapsAndReport) {
    const Folder folder;
    auto s = sphere();
    flip(s, 10);
    s.triangles.push_back(s.triangles[4]);
    s.points.push_back({9, 9, 9});
    write_off(folder.file("in.off"), s);
    const std::string files = folder.file("in.off") + " " + folder.file("out.ply") + " --vertex-map " + folder.file("v.json") +
                              " --face-map " + folder.file("f.json") + " --report " + folder.file("r.json");
    const Outcome done = run(folder, "mesh repair " + files);
    EXPECT_EQ(done.code, 0) << done.err << done.out;
    const Json faces = read_json(folder.file("f.json")), vertices = read_json(folder.file("v.json"));
    validate(faces, "map", "f.json");
    EXPECT_EQ(faces["from"].GetUint(), s.triangles.size());
    EXPECT_EQ(faces["to"].GetUint(), s.triangles.size() - 1);
    EXPECT_EQ(faces["map"][s.triangles.size() - 1].GetInt(), faces["map"][4].GetInt());
    EXPECT_EQ(vertices["map"][s.points.size() - 1].GetInt(), -1);
    validate(read_json(folder.file("r.json")), "report", "r.json");
    const auto mesh = read_mesh(folder.file("out.ply")).mesh;
    EXPECT_EQ(mesh.number_of_faces(), s.triangles.size() - 1);
    EXPECT_EQ(run(folder, "mesh info " + folder.file("out.ply")).code, 0);

    EXPECT_EQ(run(folder, "mesh repair " + folder.file("in.off") + " " + folder.file("in.off")).code, 2);
    EXPECT_EQ(run(folder, "mesh repair " + folder.file("in.off") + " " + folder.file("no_folder/out.ply")).code, 1);
    EXPECT_EQ(run(folder, "mesh repair " + folder.file("in.off") + " " + folder.file("out.xyz")).code, 2);
    EXPECT_EQ(run(folder, "mesh repair " + folder.file("in.off") + " " + folder.file("o.ply") + " --merge-distance 7").code, 2);
    EXPECT_FALSE(std::filesystem::exists(folder.file("o.ply")));
}

TEST(MeshRepairCommand, TheVerdictOnStlIsThatOfTheWrittenFile) {
    const Folder folder;
    for (const Place& corner : {Place{1, 1, 0}, Place{1, 1, 1}}) {  // cubes that share an edge, and a vertex
        write_off(folder.file("in.off"), welded(both(cube(), cube(corner))));
        const Outcome done = run(folder, "mesh repair " + folder.file("in.off") + " " + folder.file("out.stl"));
        EXPECT_EQ(done.code, 0) << done.err << done.out;
        EXPECT_NE(done.err.find("moved apart"), std::string::npos) << done.err;
        const Outcome again = run(folder, "mesh info --json " + folder.file("out.stl"));
        EXPECT_EQ(again.code, 0) << again.out;
    }
}

TEST(MeshRepairCommand, BeforeAndAfterIntersectionsAreShown) {
    const Folder folder;
    write_off(folder.file("in.off"), both(sphere(16, 32), sphere(16, 32, 0.8, {0.9, 0, 0})));
    const std::string files = folder.file("in.off") + " " + folder.file("out.ply") + " --remove-self-intersections";
    const Json report = parse_json(run(folder, "mesh repair --json " + files).out, "stdout");
    validate(report, "report", "stdout");
    EXPECT_EQ(report["result"]["before"]["component_count"].GetInt(), 2);
    // The union lies between the larger sphere and the sum of both; the volume is the middle.
    EXPECT_NEAR(report["result"]["before"]["size"]["volume"].GetDouble(), 4.0 / 3 * 3.14159265 * (1 + 0.512 / 2), 0.12);
    const Outcome shown = run(folder, "mesh repair " + files);
    EXPECT_NE(shown.out.find("before intersections were removed"), std::string::npos) << shown.out;
    EXPECT_NE(shown.err.find("volume changed by"), std::string::npos) << shown.err;
}

TEST(MeshRepairCommand, RefusalLeavesTheOutputAlone) {
    const Folder folder;
    write_file(folder.file("points.obj"), "v 0 0 0\nv 1 0 0\n");
    write_file(folder.file("out.ply"), "precious");
    const Outcome refused = run(folder, "mesh repair " + folder.file("points.obj") + " " + folder.file("out.ply"));
    EXPECT_EQ(refused.code, 1);
    EXPECT_NE(refused.err.find("no faces"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("points.obj"), std::string::npos) << refused.err;
    EXPECT_EQ(read_file(folder.file("out.ply")), "precious");
}

// Each broken file ends in an oriented manifold or in a refusal that names file and reason, in time.
TEST(MeshRepairCommand, EveryDefectiveFileIsRepairedOrRefused) {
    const std::filesystem::path data(OSTRAKA_SHARED_DATA);
    if (!std::filesystem::exists(data / "broken")) GTEST_SKIP() << "the broken files are not here: " << data;
    const Folder folder;
    std::vector<std::filesystem::path> files;
    for (const char* name : {"broken", "broken-synthetic"})
        for (const auto& entry : std::filesystem::directory_iterator(data / name))
            if (entry.path().filename() != "SOURCE.txt") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    EXPECT_GE(files.size(), 49u);
    for (const auto& file : files)
        for (const std::string flags : {"", "--remove-self-intersections --fill-holes-size 1"}) {
            const std::string out = folder.file("out.ply");
            std::filesystem::remove(out);
            const Outcome r = run(folder, "mesh repair --json --quiet '" + file.string() + "' " + out + " " + flags);
            std::string outcome = r.code == 1 ? r.err.substr(0, r.err.find('\n')) : "";
            EXPECT_LT(r.seconds, 20) << file;
            if (r.code == 1) {
                EXPECT_NE(r.err.find(file.filename().string()), std::string::npos) << r.err;
                EXPECT_GT(r.err.size(), file.string().size() + 20) << r.err;
                EXPECT_FALSE(std::filesystem::exists(out)) << file;
            } else {
                ASSERT_TRUE(r.code == 0 || r.code == 3) << file << " " << r.code << " " << r.err;
                const Json report = parse_json(r.out, "stdout");
                const auto& after = report["result"]["after"];
                EXPECT_EQ(report["result"]["sound"].GetBool(), r.code == 0) << file;
                EXPECT_TRUE(after["manifold"].GetBool() && after["oriented"].GetBool()) << file;
                EXPECT_NO_THROW({  // the reader accepts it as a manifold
                    const auto mesh = read_mesh(out);
                    EXPECT_EQ(mesh.mesh.number_of_faces(), after["triangles"].GetUint()) << file;
                }) << file;
                for (const auto& defect : after["defects"].GetArray())
                    outcome += std::string(outcome.empty() ? "" : "; ") + defect.GetString();
                if (outcome.empty()) outcome = "sound, " + std::to_string(after["triangles"].GetUint()) + " triangles";
            }
            std::cout << r.code << "  " << file.filename().string() << (flags.empty() ? "" : "  (all)") << "  " << outcome
                      << '\n';
        }
}

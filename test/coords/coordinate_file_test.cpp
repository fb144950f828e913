#include "ostraka/coords/coordinate_file.h"

#include "cages.h"
#include "mutate.h"
#include "ostraka/core/error.h"
#include "ostraka/files/npy.h"
#include "scratch.h"

namespace ostraka {
namespace {

struct Saved : test::Scratch {
    Mesh cage = build_mesh(test::box(1)), mesh = build_mesh(test::moved(test::octahedron_sphere(1), 0.4, {0.5, 0.5, 0.5}));
    Path file = *this / "ball.npy", header = *this / "ball.coordinates.json";
    Coordinates save(const std::string& kind) const {
        const Coordinates c = compute_coordinates(kind, cage, mesh);
        write_coordinates(file, c, mesh, cage, certify(c, cage, points_of(mesh)), Provenance{"test", {}, {}});
        return c;
    }
    std::string problem(const Mesh& given_mesh, const Mesh& given_cage) const {
        try {
            (void)read_coordinates(file, given_mesh, given_cage);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input);
            EXPECT_FALSE(error.remedy().empty()) << error.what();
            EXPECT_NE(error.where().find("ball"), std::string::npos);
            return error.problem();
        }
        return "accepted";
    }
    std::string problem() const { return problem(mesh, cage); }
};
bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(CoordinateFile, RoundTripIsExact) {
    const Saved saved;
    for (const char* kind : {"mean-value", "green"}) {
        const Coordinates c = saved.save(kind), reread = read_coordinates(saved.file, saved.mesh, saved.cage);
        EXPECT_EQ(reread.kind, kind);
        EXPECT_EQ(reread.vertex, c.vertex);
        EXPECT_EQ(reread.normal.size(), c.normal.size());
        if (c.has_normals()) {
            EXPECT_EQ(reread.normal, c.normal);
        }
        // Other programs can read it too: a plain array.
        const auto array = read_npy(saved.file);
        EXPECT_EQ(array.shape, (std::vector<std::size_t>{saved.mesh.number_of_vertices(), 8}));
        EXPECT_EQ(array.values[9], c.vertex(1, 1));
        const Json document = read_json(saved.header);
        EXPECT_LT(document["certificate"]["partition"].GetDouble(), 1e-12);
    }
    EXPECT_EQ(test::count_files(saved.path()), 3U);
}

TEST(CoordinateFile, RejectsAnotherMeshOrCage) {
    const Saved saved;
    saved.save("mean-value");
    EXPECT_EQ(saved.problem(), "accepted");
    Mesh changed = saved.mesh;
    changed.point(Vertex(5)) = Point(0.5, 0.5, 0.5);
    EXPECT_TRUE(contains(saved.problem(changed, saved.cage), "another mesh (its checksum"));
    EXPECT_TRUE(contains(saved.problem(build_mesh(test::box(3)), saved.cage), "another mesh, with 18 vertices"));
    changed = saved.cage;
    changed.point(Vertex(0)) = Point(-1, -1, -1);
    EXPECT_TRUE(contains(saved.problem(saved.mesh, changed), "another cage (its checksum"));
    EXPECT_TRUE(contains(saved.problem(saved.mesh, build_mesh(test::box(2))), "another cage, with 8 vertices"));
}

TEST(CoordinateFile, RejectsChangedArrays) {
    const Saved saved;
    const Coordinates c = saved.save("green");
    const std::string original = read_file(saved.file);
    std::vector<double> values(c.vertex.data(), c.vertex.data() + c.vertex.size());
    values[7] += 1e-15;
    write_npy(saved.file, values, {18, 8});
    EXPECT_TRUE(contains(saved.problem(), "its checksum differs"));
    values[7] = NAN;
    write_npy(saved.file, values, {18, 8});
    EXPECT_TRUE(contains(saved.problem(), "weight 7 is not finite"));
    write_npy(saved.file, values, {8, 18});
    EXPECT_TRUE(contains(saved.problem(), "8 rows and 18 columns, not 18 and 8"));
    write_npy(saved.file, std::vector<std::int64_t>(144, 1), {18, 8});
    EXPECT_TRUE(contains(saved.problem(), "float64"));
    write_file(saved.file, original);
    EXPECT_EQ(saved.problem(), "accepted");
    std::filesystem::remove(saved / "ball.normal.npy");
    EXPECT_TRUE(contains(saved.problem(), "cannot be opened"));
    std::filesystem::remove(saved.header);
    EXPECT_TRUE(contains(saved.problem(), "no header ball.coordinates.json"));
}

/// Writes an array again, and its checksum into the header.
void replace_array(const Saved& saved, const char* name, const std::vector<double>& values, std::size_t columns) {
    const std::string old = sha256(read_file(saved / name));
    write_npy(saved / name, values, {values.size() / columns, columns});
    std::string text = read_file(saved.header);
    text.replace(text.find(old), old.size(), sha256(read_file(saved / name)));
    write_file(saved.header, text);
}

TEST(CoordinateFile, RejectsRowsThatDoNotSumToOne) {
    const Saved saved;
    for (const char* kind : {"mean-value", "green"}) {
        const Coordinates c = saved.save(kind);
        const std::vector<double> original(c.vertex.data(), c.vertex.data() + c.vertex.size());
        for (const double invalid : {original[5 * 8 + 3] + 1e-4, 1e300, -1e308, 0.0}) {
            std::vector<double> values = original;
            values[5 * 8 + 3] = invalid;
            replace_array(saved, "ball.npy", values, 8);
            EXPECT_TRUE(contains(saved.problem(), "row 5 do not sum to 1")) << kind << ' ' << invalid << saved.problem();
        }
        std::vector<double> huge = original;
        for (std::size_t i = 0; i < 8; ++i) huge[i] = 1.7e308;
        replace_array(saved, "ball.npy", huge, 8);
        EXPECT_TRUE(contains(saved.problem(), "row 0 do not sum to 1")) << kind;
        replace_array(saved, "ball.npy", original, 8);
        EXPECT_EQ(saved.problem(), "accepted");
    }
}

TEST(CoordinateFile, RejectsNormalWeightsThatMoveAPointAtRest) {
    const Saved saved;
    const Coordinates c = saved.save("green");
    std::vector<double> values(c.normal.data(), c.normal.data() + c.normal.size());
    for (const double invalid : {values[4 * 12] + 1e-4, 1e300}) {
        values[4 * 12] = invalid;
        replace_array(saved, "ball.normal.npy", values, 12);
        EXPECT_TRUE(contains(saved.problem(), "row 4 do not reproduce their point")) << saved.problem();
    }
}

TEST(CoordinateFile, TheKindDeterminesWhetherThereAreNormals) {
    const Saved saved;
    saved.save("green");
    const std::string original = read_file(saved.header);
    const auto kind_is = [&](const std::string& kind) {
        std::string text = original;
        text.replace(text.find("\"green\""), 7, '"' + kind + '"');
        write_file(saved.header, text);
        return saved.problem();
    };
    EXPECT_TRUE(contains(kind_is("mean-value"), "mean-value coordinates have no normal weights"));
    EXPECT_TRUE(contains(kind_is("grean"), "kind of coordinates 'grean' is unknown"));
    EXPECT_EQ(kind_is("green"), "accepted");
    std::string text = original;
    text.replace(text.find("\"normal\""), 8, "\"namrol\"");
    write_file(saved.header, text);
    EXPECT_TRUE(contains(saved.problem(), "green coordinates need normal weights")) << saved.problem();
}

TEST(CoordinateFile, HeadersMustNotReferOutsideTheFolder) {
    const Saved saved;
    saved.save("mean-value");
    std::string text = read_file(saved.header);
    text.replace(text.find("\"ball.npy\""), 10, "\"../../x.npy\"");
    write_file(saved.header, text);
    EXPECT_TRUE(contains(saved.problem(), "'../../x.npy' instead of ball.npy"));
}

TEST(CoordinateFile, RejectsMismatchedCoordinatesOnWriting) {
    const test::Scratch scratch;
    const Mesh cage = build_mesh(test::box(1)), mesh = build_mesh(test::moved(test::octahedron_sphere(0), 0.4, {0.5, 0.5, 0.5}));
    Coordinates c = compute_coordinates("mean-value", cage, mesh);
    const CoordinateCertificate certificate = certify(c, cage, points_of(mesh));
    EXPECT_THROW(write_coordinates(scratch / "a.npy", c, cage, mesh, certificate, {}), Error);
    EXPECT_THROW(write_coordinates(scratch / "a.txt", c, mesh, cage, certificate, {}), Error);
    c.vertex(0, 0) = NAN;
    EXPECT_THROW(write_coordinates(scratch / "a.npy", c, mesh, cage, certificate, {}), Error);
    EXPECT_EQ(test::count_files(scratch.path()), 0U);
}

TEST(CoordinateFile, DamagedFilesAreRejectedOrUnchanged) {
    const Saved saved;
    const Coordinates c = saved.save("green");
    std::size_t rejected = 0;
    for (const char* name : {"ball.npy", "ball.normal.npy", "ball.coordinates.json"}) {
        const std::string original = read_file(saved / name);
        for (std::uint64_t seed = 0; seed < 300; ++seed) {
            write_file(saved / name, test::mutate(original, seed));
            try {
                const Coordinates reread = read_coordinates(saved.file, saved.mesh, saved.cage);
                // Damage to the certificate in the header is permitted; the kind is text.
                EXPECT_EQ(reread.vertex, c.vertex) << name << ' ' << seed;
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
                ++rejected;
            }
        }
        write_file(saved / name, original);
    }
    EXPECT_GT(rejected, 600U);
}

}  // namespace
}  // namespace ostraka

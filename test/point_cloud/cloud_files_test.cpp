// Readers of point clouds: small files with known contents, the clouds of the shared data, and damaged files.
#include "../../src/point_cloud/cloud_formats.h"
#include "../../src/point_cloud/e57_file.h"
#include "e57_writer.h"
#include "las_writer.h"
#include "ostraka/core/error.h"
#include "ostraka/point_cloud/point_cloud.h"
#include "ostraka/stats/random.h"
#include "scratch.h"

#include <cmath>
#include <cstring>

namespace ostraka {
namespace {

using test::las_colours;
using test::las_file;
using test::put;
using test::Scratch;

PointCloud cloud_of(const Path& file) {
    std::optional<PointCloud> cloud = read_point_cloud(file);
    EXPECT_TRUE(cloud.has_value()) << file;
    return cloud ? *cloud : PointCloud();
}

bool noted(const PointCloud& cloud, const std::string& words) {
    for (const std::string& note : cloud.notes)
        if (note.find(words) != std::string::npos) return true;
    return false;
}

std::string error_of(const Path& file) {
    try {
        (void)read_point_cloud(file);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

/// Reads every beginning of a file: it must be refused by an Error or give points, and never crash.
void read_beginnings(const std::string& bytes, const std::string& name) {
    const Path file = "memory:beginnings/" + name;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        write_file(file, std::string_view(bytes).substr(0, size));
        try {
            (void)read_point_cloud(file);
        } catch (const Error& error) {
            ASSERT_FALSE(std::string(error.what()).empty());
        }
    }
    remove_memory_files(file);
}

/// Reads files with some bytes changed: as above.
void read_changed(const std::string& bytes, const std::string& name, int rounds) {
    const Path file = "memory:changed/" + name;
    Random random(11);
    for (int round = 0; round < rounds; ++round) {
        std::string changed = bytes;
        for (std::size_t k = 0; k <= random.below(4); ++k)
            changed[random.below(changed.size())] = static_cast<char>(random.below(3) == 0 ? 255 : random.below(256));
        write_file(file, changed);
        try {
            (void)read_point_cloud(file);
        } catch (const Error& error) {
            ASSERT_FALSE(std::string(error.what()).empty());
        }
    }
    remove_memory_files(file);
}

// ---- LAS ----

TEST(CloudFiles, LasOfEveryPointFormat) {
    const Scratch scratch;
    for (unsigned format = 0; format <= 10; ++format) {
        const PointCloud cloud = cloud_of(scratch.file("a.las", las_file(format, 0x8040)));
        ASSERT_EQ(cloud.points.size(), 3U) << format;
        EXPECT_EQ(cloud.points[1], Point(1000 * 0.001 + 650000, 1001 * 0.001 + 5600000, 1002 * 0.01 - 10)) << format;
        ASSERT_EQ(cloud.intensities.size(), 3U);
        EXPECT_EQ(cloud.intensities[2], 700);
        EXPECT_EQ(cloud.colours.size(), las_colours[format] > 0 ? 3U : 0U);
        for (const Colour& colour : cloud.colours) EXPECT_EQ(colour, (Colour{0x80, 0, 0, 255}));
    }
    EXPECT_EQ(cloud_of(scratch.file("b.las", las_file(2, 200))).colours[0][0], 200) << "8 bits in 16";
    const PointCloud bare = cloud_of(scratch.file("c.las", las_file(2, 0, 0)));
    EXPECT_TRUE(bare.colours.empty());
    EXPECT_TRUE(bare.intensities.empty());
}

TEST(CloudFiles, LasIsRefusedInWords) {
    const Scratch scratch;
    const std::string good = las_file(3, 9);
    std::string laz = good, many = good, version = good, format = good, record = good, far_data = good, scale = good;
    laz[104] = static_cast<char>(3 | 0x80);
    EXPECT_NE(error_of(scratch.file("a.laz", laz)).find("laszip"), std::string::npos);
    put<std::uint32_t>(many, 107, 4000000000U);
    EXPECT_NE(error_of(scratch.file("b.las", many)).find("promises 4000000000 points, but holds only 3"), std::string::npos);
    version[25] = 5;
    EXPECT_NE(error_of(scratch.file("c.las", version)).find("LAS 1.5"), std::string::npos);
    format[104] = 11;
    EXPECT_NE(error_of(scratch.file("d.las", format)).find("point format 11"), std::string::npos);
    put<std::uint16_t>(record, 105, 33);
    EXPECT_NE(error_of(scratch.file("e.las", record)).find("records of 33 bytes"), std::string::npos);
    put<std::uint32_t>(far_data, 96, 100000);
    EXPECT_NE(error_of(scratch.file("f.las", far_data)).find("begin at byte 100000"), std::string::npos);
    put(scale, 131, std::nan(""));
    EXPECT_FALSE(error_of(scratch.file("g.las", scale)).empty());
    EXPECT_NE(error_of(scratch.file("h.las", "x y z")).find("does not begin with LASF"), std::string::npos);
    read_beginnings(good, "t.las");
    read_changed(good, "m.las", 500);
}

// ---- text ----

TEST(CloudFiles, DialectsOfText) {
    const Scratch scratch;
    struct Case {
        const char *name, *text;
        std::size_t normals, colours, intensities;
        const char* note;
    };
    const Case cases[]{
        {"a.xyz", "1 2 3\n4 5 6\n", 0, 0, 0, ""},
        {"b.xyz", "1 2 3 0 0 1\n4 5 6 0.6 0 0.8\n", 2, 0, 0, "columns 4 to 6 as normals"},
        {"c.xyz", "1 2 3 10 20 255\n4 5 6 0 0 1\n", 0, 2, 0, "columns 4 to 6 as colours"},
        {"d.xyz", "1 2 3 10 20 255 0.5\n4 5 6 0 0 1 0.7\n", 0, 2, 2, "column 7 as intensity"},
        {"e.xyz", "1 2 3 -7.5\n4 5 6 9\n", 0, 0, 2, "column 4 as intensity"},
        {"f.xyz", "1 2 3 0.5 10 20 30\n4 5 6 0.25 1 2 3\n", 0, 2, 2, "columns 5 to 7 as colours"},
        {"g.xyz", "1 2 3 10 20 30 0 0 1\n4 5 6 1 2 3 1 0 0\n", 2, 2, 0, "columns 7 to 9 as normals"},
        {"h.xyz", "1 2 3 0.1 0.2 0.3\n4 5 6 0.5 0.5 0.25\n", 0, 2, 0, "columns 4 to 6 as colours"},
        {"i.asc", "//X Y Z Rf Gf Bf Intensity\n2\n1 2 3 0.5 0.5 1 9\n4 5 6 1 0 0 8\n", 0, 2, 2, "columns 4 to 6 as colours"},
        {"j.csv", "\"X\",\"Y\",\"Z\",\"Time\",\"Intensity\"\r\n1,2,3,0,5\r\n4,5,6,0,6\r\n", 0, 0, 2, "Time"},
        {"k.txt", "# x y z nx ny nz\n1;2;3;0;0;1\n4;5;6;0;0;1\n", 2, 0, 0, "columns 4 to 6 as normals"},
        {"l.txt", "1,5;2;3\n4,5;5;6\n", 0, 0, 0, "decimal points"},
        {"m.pts", "2\n1 2 3 -2048 10 20 30\n4 5 6 2047 1 2 3\n", 0, 2, 2, "column 4 as intensity"},
        {"n.pts", "1\n1 2 3 7\n1\n4 5 6 8\n", 0, 0, 2, ""},
        {"o.xyz", "X Y X\n1 2 3\n4 5 6\n", 0, 0, 0, "does not name x, y and z"},
        {"p.xyz",
         "\xEF\xBB\xBF"
         "1\t2\t3\n\n# remark\n4\t5\t6",
         0, 0, 0, ""},
        {"q.xyz", "1 2 3\r4 5 6\r", 0, 0, 0, ""},
        {"r.xyz", "5\n1 2 3\n4 5 6\n", 0, 0, 0, "states 5 points and has 2"},
        {"s.xyz", "1 2 3\nnan nan nan\n4 5 6\n", 0, 0, 0, "1 point with coordinates"},
        {"t.xyz", "Easting Northing Height Red Green Blue\n1 2 3 65535 0 257\n4 5 6 0 0 0\n", 0, 2, 0, ""},
    };
    for (const Case& example : cases) {
        const PointCloud cloud = cloud_of(scratch.file(example.name, example.text));
        EXPECT_EQ(cloud.points.size(), 2U) << example.name;
        EXPECT_EQ(cloud.normals.size(), example.normals) << example.name;
        EXPECT_EQ(cloud.colours.size(), example.colours) << example.name;
        EXPECT_EQ(cloud.intensities.size(), example.intensities) << example.name;
        EXPECT_TRUE(*example.note == 0 || noted(cloud, example.note)) << example.name << ": " << example.note;
        EXPECT_EQ(cloud.points.back().y(), 5) << example.name;
    }
    EXPECT_EQ(cloud_of(scratch / "c.xyz").colours[0], (Colour{10, 20, 255, 255}));
    EXPECT_EQ(cloud_of(scratch / "i.asc").colours[0], (Colour{128, 128, 255, 255}));
    EXPECT_EQ(cloud_of(scratch / "t.xyz").colours[0], (Colour{255, 0, 1, 255}));
    EXPECT_EQ(cloud_of(scratch / "l.txt").points[0].x(), 1.5);
    EXPECT_EQ(cloud_of(scratch / "m.pts").intensities[0], -2048);
    EXPECT_NE(error_of(scratch.file("u.pts", "[Expe/PointSet/Binary/0.1]\n")).find("Expe"), std::string::npos);
    EXPECT_NE(error_of(scratch.file("v.xyz", std::string("1 2\0 3", 6))).find("not text"), std::string::npos);
    for (const char* wrong : {"1 2 3 4x\n", "1 2 3\n1 2\n", "a\n", "1 2 3\nhello you there\n", "1 2 3 \xFF\n"})
        EXPECT_FALSE(error_of(scratch.file("w.xyz", wrong)).empty()) << wrong;
}

TEST(CloudFiles, PtxScansArePlacedAndMerged) {
    const Scratch scratch;
    const std::string text =
        "2\n2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 2 0\n600000 800000 400 1\n"
        "1 0 0 0.5\n0 2 0 0.25\n0 0 0 0\n1 2 3 1\n"
        "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n7 8 9 0.125 10 20 30\n";
    const PointCloud cloud = cloud_of(scratch.file("a.ptx", text));
    ASSERT_EQ(cloud.points.size(), 4U);
    EXPECT_EQ(cloud.points[0], Point(600000, 800001, 400));
    EXPECT_EQ(cloud.points[2], Point(599998, 800001, 406));
    EXPECT_EQ(cloud.points[3], Point(7, 8, 9));
    EXPECT_EQ(cloud.intensities, (std::vector<double>{0.5, 0.25, 1, 0.125}));
    EXPECT_EQ(cloud.colours[3], (Colour{10, 20, 30, 255}));
    EXPECT_EQ(cloud.colours[0][3], 0) << "a scan without colours";
    EXPECT_TRUE(noted(cloud, "1 place of the file without a valid point"));
    EXPECT_TRUE(noted(cloud, "3 points have no colour"));
    EXPECT_FALSE(error_of(scratch.file("b.ptx", "2\n2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 1 0 5\n")).empty());
    EXPECT_FALSE(error_of(scratch.file("c.ptx", "4000000000\n4000000000\n")).empty());
    read_beginnings(text, "t.ptx");
    read_changed(text, "m.ptx", 500);
}

// ---- PCD ----

std::string pcd_head(const std::string& encoding, const char* type = "U") {
    return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb _ intensity\nSIZE 4 4 4 4 1 8\nTYPE F F F " + std::string(type) +
           " U F\nCOUNT 1 1 1 1 3 1\nWIDTH 2\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 4\nDATA " + encoding + "\n";
}

TEST(CloudFiles, PcdInItsThreeEncodings) {
    const Scratch scratch;
    std::string rows, columns(4 * 27, '\0'), text;
    for (std::size_t i = 0; i < 4; ++i) {
        const float x = i == 2 ? std::nanf("") : static_cast<float>(i) / 2;
        const auto rgb = static_cast<std::uint32_t>(0x0A1400 + i);
        put(rows, 27 * i, x);
        put(rows, 27 * i + 4, 1.0F);
        put(rows, 27 * i + 8, 2.0F);
        put(rows, 27 * i + 12, rgb);
        put(rows, 27 * i + 19, 0.25 * static_cast<double>(i));
        put(columns, 4 * i, x);
        put(columns, 16 + 4 * i, 1.0F);
        put(columns, 32 + 4 * i, 2.0F);
        put(columns, 48 + 4 * i, rgb);
        put(columns, 76 + 8 * i, 0.25 * static_cast<double>(i));
        text += (i == 2 ? "nan" : std::to_string(static_cast<double>(i) / 2)) + " 1 2 " + std::to_string(rgb) + " 0 0 0 " +
                std::to_string(0.25 * static_cast<double>(i)) + "\n";
    }
    std::string packed;
    for (std::size_t i = 0; i < columns.size(); i += 32) {
        const std::string run = columns.substr(i, 32);
        packed += static_cast<char>(run.size() - 1) + run;
    }
    std::string compressed = pcd_head("binary_compressed");
    const std::size_t start = compressed.size();
    put(compressed, start, static_cast<std::uint32_t>(packed.size()));
    put(compressed, start + 4, static_cast<std::uint32_t>(columns.size()));
    compressed += packed;
    for (const Path& file : {scratch.file("a.pcd", pcd_head("ascii") + text), scratch.file("b.pcd", pcd_head("binary") + rows),
                             scratch.file("c.pcd", compressed)}) {
        const PointCloud cloud = cloud_of(file);
        ASSERT_EQ(cloud.points.size(), 3U) << file;
        EXPECT_EQ(cloud.points[2], Point(1.5, 1, 2)) << file;
        EXPECT_EQ(cloud.colours[2], (Colour{10, 20, 3, 255})) << file;
        EXPECT_EQ(cloud.intensities[2], 0.75) << file;
        EXPECT_TRUE(noted(cloud, "1 point with coordinates that are not finite")) << file;
    }
    for (const std::string& file : {pcd_head("binary") + rows, compressed, pcd_head("ascii") + text}) {
        read_beginnings(file, "t.pcd");
        read_changed(file, "m.pcd", 500);
    }
    std::string bomb = compressed;
    put(bomb, start + 4, 4000000000U);
    EXPECT_NE(error_of(scratch.file("d.pcd", bomb)).find("claims to unpack to 4000000000 bytes"), std::string::npos);
}

TEST(CloudFiles, LzfRepeats) {
    std::string unpacked;
    // "abc", then 9 bytes from 3 before (length code 7 and a further byte), then 3 bytes.
    const std::string packed = std::string(
                                   "\x02"
                                   "abc",
                                   4) +
                               std::string("\xE0\x00\x02", 3) + std::string("\x20\x02", 2);
    ASSERT_TRUE(clouds::unpack_lzf(packed, 15, unpacked));
    EXPECT_EQ(unpacked, "abcabcabcabcabc");
    EXPECT_FALSE(clouds::unpack_lzf(packed, 14, unpacked));
    EXPECT_FALSE(clouds::unpack_lzf(packed, 16, unpacked));
    EXPECT_FALSE(clouds::unpack_lzf(std::string("\x00"
                                                "a"
                                                "\x20\x05",
                                                4),
                                    4, unpacked))
        << "before the beginning";
    EXPECT_FALSE(clouds::unpack_lzf(std::string("\x1F"
                                                "a",
                                                2),
                                    32, unpacked))
        << "cut off";
}

// ---- E57 ----

TEST(CloudFiles, ChecksumOfE57) {
    EXPECT_EQ(clouds::crc32c("123456789"), 0xE3069283U) << "the check value of CRC-32C";
    EXPECT_EQ(clouds::crc32c(std::string(32, '\0')), 0x8A9136AAU) << "RFC 3720, B.4";
}

TEST(CloudFiles, E57ColumnsPosesAndInvalidPoints) {
    const Scratch scratch;
    // Widths of 11, 32, 64, 2, 1 and 8 bits; the packets are cut anywhere.
    test::E57Writer writer;
    test::E57WriterScan& scan = writer.scans.emplace_back();
    scan.pose =
        "<pose type=\"Structure\"><rotation type=\"Structure\"><w type=\"Float\">0.70710678118654757</w><x type=\"Float\"/>"
        "<y type=\"Float\"/><z type=\"Float\">0.70710678118654757</z></rotation><translation type=\"Structure\">"
        "<x type=\"Float\">100</x><y type=\"Float\"/><z type=\"Float\">-1</z></translation></pose>";
    const std::size_t count = 333;
    auto& x =
        scan.column("<cartesianX type=\"ScaledInteger\" minimum=\"-1000\" maximum=\"1000\" scale=\"0.5\" offset=\"3\"/>", 11);
    auto& y = scan.column("<cartesianY type=\"Float\" precision=\"single\"/>", 32);
    auto& z = scan.column("<cartesianZ type=\"Float\"/>", 64);
    auto& invalid = scan.column("<cartesianInvalidState type=\"Integer\" minimum=\"0\" maximum=\"2\"/>", 2);
    auto& constant = scan.column("<intensity type=\"Integer\" minimum=\"7\" maximum=\"7\"/>", 0);
    auto& row = scan.column("<rowIndex type=\"Integer\" minimum=\"0\" maximum=\"1\"/>", 1);
    std::array<std::vector<std::uint64_t>*, 3> colours{};
    colours[0] = &scan.column("<colorRed type=\"Integer\" minimum=\"0\" maximum=\"255\"/>", 8);
    colours[1] = &scan.column("<colorGreen type=\"Integer\" minimum=\"0\" maximum=\"255\"/>", 8);
    colours[2] = &scan.column("<colorBlue type=\"Integer\" minimum=\"0\" maximum=\"255\"/>", 8);
    for (std::size_t i = 0; i < count; ++i) {
        x.push_back(6 * i);
        y.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(i)));
        z.push_back(std::bit_cast<std::uint64_t>(static_cast<double>(i) / 3));
        invalid.push_back(i == 5 ? 2 : 0);
        constant.push_back(0);
        row.push_back(i % 2);
        for (std::size_t k = 0; k < 3; ++k) colours[k]->push_back((i + k) % 256);
    }
    const std::string bytes = writer.file(57);
    const PointCloud cloud = cloud_of(scratch.file("a.e57", bytes));
    ASSERT_EQ(cloud.points.size(), count - 1);
    for (std::size_t k = 0; k < cloud.points.size(); ++k) {
        const std::size_t i = k < 5 ? k : k + 1;
        const double at_x = 0.5 * (6.0 * static_cast<double>(i) - 1000) + 3, at_y = static_cast<double>(i);
        EXPECT_NEAR(cloud.points[k].x(), 100 - at_y, 1e-9);
        EXPECT_NEAR(cloud.points[k].y(), at_x, 1e-9);
        EXPECT_NEAR(cloud.points[k].z(), static_cast<double>(i) / 3 - 1, 1e-12);
        EXPECT_EQ(cloud.colours[k][1], (i + 1) % 256);
        EXPECT_EQ(cloud.intensities[k], 7);
    }
    EXPECT_TRUE(noted(cloud, "rowIndex"));
    EXPECT_TRUE(noted(cloud, "1 place of the file"));
}

std::string small_e57(const char* record_count = nullptr) {
    test::E57Writer writer;
    for (int s = 0; s < 2; ++s) {
        test::E57WriterScan& scan = writer.scans.emplace_back();
        if (record_count != nullptr) scan.record_count = record_count;
        const char* names[]{"sphericalRange", "sphericalAzimuth", "sphericalElevation"};
        for (int k = 0; k < 3; ++k) {
            auto& values = scan.column("<" + std::string(names[k]) + " type=\"Float\"/>", 64);
            const double value = k == 0 ? 2 : k == 1 ? M_PI / 2 * s : M_PI / 6;
            values.assign(2, std::bit_cast<std::uint64_t>(value));
        }
    }
    return writer.file(1000);
}

TEST(CloudFiles, E57SphericalScansAreMerged) {
    const Scratch scratch;
    const PointCloud cloud = cloud_of(scratch.file("a.e57", small_e57()));
    ASSERT_EQ(cloud.points.size(), 4U);
    EXPECT_LT(CGAL::squared_distance(cloud.points[0], Point(std::sqrt(3.0), 0, 1)), 1e-28);
    EXPECT_LT(CGAL::squared_distance(cloud.points[3], Point(0, std::sqrt(3.0), 1)), 1e-28);
    EXPECT_TRUE(noted(cloud, "2 scans were merged"));
}

TEST(CloudFiles, DamagedE57IsRefused) {
    const Scratch scratch;
    const std::string good = small_e57();
    read_beginnings(good, "t.e57");
    std::string flipped = good;
    flipped[700] = static_cast<char>(flipped[700] ^ 1);
    EXPECT_NE(error_of(scratch.file("a.e57", flipped)).find("checksum"), std::string::npos);
    EXPECT_NE(error_of(scratch.file("b.e57", small_e57("1000000000000"))).find("promises 1000000000000 points"),
              std::string::npos);
    EXPECT_FALSE(error_of(scratch.file("c.e57", small_e57("-4"))).empty());
    EXPECT_FALSE(error_of(scratch.file("d.e57", small_e57("many"))).empty());
    // Changes behind the checksums: the pages are sealed again.
    Random random(3);
    for (int round = 0; round < 1500; ++round) {
        std::string changed = good;
        for (std::size_t k = 0; k <= random.below(3); ++k)
            changed[random.below(changed.size())] = static_cast<char>(random.below(256));
        test::seal_e57_pages(changed);
        const Path file = "memory:changed/m.e57";
        write_file(file, changed);
        try {
            (void)read_point_cloud(file);
        } catch (const Error& error) {
            ASSERT_FALSE(std::string(error.what()).empty());
        }
    }
}

TEST(CloudFiles, ConstantColumnsClaimNoMemory) {
    const Scratch scratch;
    test::E57Writer writer;
    test::E57WriterScan& scan = writer.scans.emplace_back();
    scan.record_count = "4000000000";
    for (const char* name : {"cartesianX", "cartesianY", "cartesianZ"})
        scan.column("<" + std::string(name) + " type=\"Integer\" minimum=\"1\" maximum=\"1\"/>", 0);
    EXPECT_NE(error_of(scratch.file("a.e57", writer.file(1000))).find("far more than a file"), std::string::npos);
}

// ---- PLY ----

TEST(CloudFiles, PlyWithColoursIntensityAndLists) {
    const Scratch scratch;
    const PointCloud cloud = cloud_of(scratch.file(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty int y\nproperty float z\nproperty list uchar "
        "int near\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nproperty float scalar_Intensity\nproperty "
        "float quality\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n"
        "650000.125 1 2 2 7 7 1 0 1 0.5 9\ninf 1 2 0 1 1 1 0.5 9\n1 2 3 0 0 1 0 nan 9\n"));
    ASSERT_EQ(cloud.points.size(), 2U);
    EXPECT_EQ(cloud.points[0], Point(650000.125, 1, 2));
    EXPECT_EQ(cloud.colours[0], (Colour{1, 0, 1, 255})) << "bytes, though none exceeds 1";
    EXPECT_EQ(cloud.intensities[0], 0.5);
    EXPECT_TRUE(std::isnan(cloud.intensities[1]));
    EXPECT_TRUE(noted(cloud, "quality"));
    EXPECT_TRUE(noted(cloud, "1 point with coordinates"));
}

// ---- shared data ----

struct SharedCloud {
    const char* file;
    std::size_t points;
    std::array<double, 6> box;       ///< minimum, maximum
    std::array<double, 3> colour{};  ///< mean; 0: not compared
    bool normals = false, intensities = false;
};

const SharedCloud shared_clouds[]{
    {"cloud-e57-mask-bali/mask-e57-no-colors-valid.e57",
     62323,
     {-0.115961, -0.132144, 0.0322379, 0.105356, 0.0928396, 0.159643},
     {},
     true},
    {"cloud-e57-several-scans/A4.e57", 4, {-44.9522, -1.3493, -0.6077, -44.3001, -0.886, 0.3694}, {0, 255, 0}, false, true},
    {"cloud-e57-several-scans/A_moved_B.e57",
     6,
     {-44.119438, 0.705303, -0.6077, -42.6395, 2.0578, 0.6667},
     {85, 255, 0},
     false,
     true},
    {"cloud-e57/bunnyInt32.e57", 30571, {-0.094689, 0.040011, -0.061873, 0.061009, 0.187321, 0.058799}},
    {"cloud-e57/ColouredCubeFloat.e57", 7680, {-0.5, -0.5, -0.5, 0.5, 0.5, 0.5}},
    {"cloud-e57/ColourRepresentation.e57", 153, {-0.5, -0.5, -0.5, 0.5, 0.5, 0.5}},
    {"cloud-las-laz/1.0_0.las", 1, {470692.44, 4602888.9, 16, 470692.44, 4602888.9, 16}},
    {"cloud-las-laz/1.2-with-color.las",
     1065,
     {635619.85, 848899.7, 406.59, 638982.55, 853535.43, 586.38},
     {121.7, 111.3, 126.5},
     false,
     true},
    {"cloud-las-laz/pdrf4-1.3.las", 1024, {-70, -22.53, -10, 103.91, 90, 12.08}, {}, false, true},
    {"cloud-las-laz/pdrf7-v4-1.4.las",
     1024,
     {-1500.01, 250, -350.04, 498.09, 1748.94, 449.38},
     {107.6, 125.1, 123.3},
     false,
     true},
    {"cloud-las-laz/points-1.4.las", 3, {0, 0, 0, 2, 1, 0.5}, {85, 85, 85}, false, true},
    {"cloud-pcd/bun0.pcd", 397, {-0.093938, 0.03742, -0.055026, 0.059562, 0.1845, 0.057803}, {}, true},
    {"cloud-pcd/car6.pcd", 10031, {-40.169, -68.56, -6.99, -33.95, -61.88, -5.43}},
    {"cloud-pcd/colored_cloud.pcd", 1000, {-0.887101, -0.650735, 0.882, 0.4888, -0.37549, 1.532}, {140.6, 139.3, 136.8}, true},
    {"cloud-pcd/milk_color.pcd", 13704, {-0.140083, -0.26378, 0.714, 0.0138067, -0.0117286, 0.891}, {91.5, 92.7, 94.8}},
    {"cloud-pcd/simple-ascii.pcd", 213, {-0.95526, -0.31546, 0, 0.99185, 0.35641, 0}, {136.9, 156.6, 176.7}},
    {"cloud-pcd/utm17_space.pcd", 10, {289814.15, 4320978.61, 170.58, 289818.5, 4320980.59, 170.76}},
    {"cloud-ply/Example.ply", 7817, {-20.0736, -3.94313, 2.73276, 2.59299, 32.762, 146.548}, {106.8, 109.3, 111.4}},
    {"cloud-ply/float_inf_point_cloud.ply", 13, {-797, 276, 1, -479, 517, 8}},
    {"cloud-ply/int_point_cloud.ply", 16, {-797, 249, 1, -409, 517, 8}},
    {"cloud-pts-ptx/1.2-with-color.ptx",
     1065,
     {635619.85, 848899.7, 406.59, 638982.55, 853535.43, 586.38},
     {121.7, 111.3, 126.5},
     false,
     true},
    {"cloud-pts-ptx/multiple-and-transform.ptx",
     8,
     {636699.38, 848991.01, 425.39, 637012.24, 849106.66, 446.39},
     {},
     false,
     true},
    {"cloud-pts-ptx/test.pts", 19, {-25.0505, -24.5336, -2.00096, 3.98097, -2.00612, -0.010086}, {23.3, 16.4, 13.4}, false, true},
    {"cloud-ripple-six-formats/ripple.las", 10201, {-5, -5, -0.66641, 5, 5, 1.1}, {29.7, 134.3, 55.4}},
    {"cloud-ripple-six-formats/ripple.pts", 10201, {-5, -5, -0.6664, 5, 5, 1.1}, {29.7, 134.3, 55.4}, false, true},
    {"cloud-ripple-six-formats/ripple.ptx", 10201, {-5, -5, -0.6664, 5, 5, 1.1}, {29.7, 134.3, 55.4}, false, true},
    {"cloud-ripple-six-formats/ripple_bin.ply", 10201, {-5, -5, -0.66641, 5, 5, 1.1}, {29.7, 134.3, 55.4}, true},
    {"cloud-xyz/Example.asc", 7817, {-20.0736, -3.94313, 2.73276, 2.59299, 32.762, 146.548}, {106.3, 108.8, 110.9}, false, true},
    {"cloud-xyz/points_agisoft.xyz",
     100,
     {665171.375, 5648340.49947, 233.514072, 665187.8709, 5648381.899, 245.90329},
     {87.0, 66.5, 57.0}},
    {"cloud-xyz/points_cloudcompare.xyz",
     101,
     {665171.375, 5648298.097, 228.049194, 665187.8709, 5648381.899, 245.90329},
     {87.2, 66.8, 57.3},
     false,
     true},
    {"cloud-xyz/text/crlf_test.txt", 10, {289814.15, 4320978.61, 170.58, 289818.5, 4320980.59, 170.76}, {}, false, true},
    {"cloud-xyz/text/quoted.txt", 9, {0, 1, 2, 29, 25, 2}},
};

TEST(CloudFiles, SharedCloudsAgreeWithAnIndependentReader) {
    const Path folder = Path(OSTRAKA_SHARED_DATA) / "textured";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "NOT CHECKED: " << folder << " is not there";
    for (const SharedCloud& expected : shared_clouds) {
        const PointCloud cloud = cloud_of(folder / expected.file);
        ASSERT_EQ(cloud.points.size(), expected.points) << expected.file;
        CGAL::Bbox_3 box;
        for (const Point& p : cloud.points) box += p.bbox();
        for (int k = 0; k < 3; ++k) {
            const double tolerance = 1e-5 * std::max(1.0, box.max(k) - box.min(k));
            EXPECT_NEAR(box.min(k), expected.box[static_cast<std::size_t>(k)], tolerance) << expected.file;
            EXPECT_NEAR(box.max(k), expected.box[static_cast<std::size_t>(k) + 3], tolerance) << expected.file;
        }
        EXPECT_EQ(!cloud.normals.empty(), expected.normals) << expected.file;
        EXPECT_EQ(!cloud.intensities.empty(), expected.intensities) << expected.file;
        std::array<double, 3> mean{};
        for (const Colour& colour : cloud.colours)
            for (std::size_t k = 0; k < 3; ++k) mean[k] += colour[k] / static_cast<double>(cloud.colours.size());
        if (expected.colour == std::array<double, 3>{}) continue;
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], expected.colour[k], 0.06) << expected.file;
    }
    for (const char* refused :
         {"cloud-e57/bad-crc.e57", "cloud-e57/ZeroPointsInvalid.e57", "cloud-e57/InvalidCVHeader.e57", "cloud-e57/empty.e57",
          "cloud-las-laz/simple.laz", "cloud-las-laz/no-points.las", "cloud-pts-ptx/not-a-pts/chameleon4k.pts"})
        EXPECT_FALSE(error_of(folder / refused).empty()) << refused;
}

}  // namespace
}  // namespace ostraka

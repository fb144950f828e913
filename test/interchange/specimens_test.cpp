// Landmark files with several specimens: each format as other programs write it, missing landmarks, damage.
#include "ostraka/interchange/specimens.h"

#include "ostraka/core/error.h"

#include <gtest/gtest.h>

using namespace ostraka;

namespace {

using Position = std::optional<std::array<double, 3>>;

Position at(double x, double y, double z = 0) { return std::array<double, 3>{x, y, z}; }

std::string message(const std::function<void()>& work) {
    try {
        work();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

std::vector<std::string> names_of(const LandmarkSpecimens& set) {
    std::vector<std::string> names;
    for (const LandmarkSpecimen& specimen : set.specimens) names.push_back(specimen.name);
    return names;
}

const std::string planar_tps =
    "LM=3\r\n1 2\r\nNA NA\r\n3.5 -1\r\nCURVES=1\r\nPOINTS=2\r\n5 5\r\n6 6\r\nIMAGE=fish.jpg\r\nID=7\r\nSCALE=0.5\r\n"
    "LM=3\n1 2\n2 3\n-999 -999\nCURVES=1\nPOINTS=2\n7 7\n8 8\nIMAGE=fish2.jpg\nID=7\n";

}  // namespace

TEST(Specimens, TpsHasSpecimensCurvesAndScales) {
    const LandmarkSpecimens set = specimens_from_text(planar_tps, "fish.tps");
    EXPECT_EQ(set.dimension, 2);
    EXPECT_EQ(names_of(set), (std::vector<std::string>{"7", "7 (2)"})) << "equal IDs are told apart";
    const LandmarkSpecimen& first = set.specimens[0];
    EXPECT_EQ(first.positions, (std::vector<Position>{at(0.5, 1), {}, at(1.75, -0.5), at(2.5, 2.5), at(3, 3)}));
    EXPECT_EQ(first.landmarks, (std::vector<std::string>{"1", "2", "3", "curve 1 point 1", "curve 1 point 2"}));
    ASSERT_EQ(first.curves.size(), 1U);
    EXPECT_EQ(first.curves[0].points, (std::vector<std::size_t>{3, 4}));
    EXPECT_EQ(first.properties.at("image"), "fish.jpg");
    EXPECT_FALSE(set.specimens[1].positions[2]) << "-999 in all coordinates";
    EXPECT_EQ(set.notes.size(), 2U) << "one has no scale, and names occur twice";
    SpecimenOptions negative;
    negative.negative_missing = true;
    EXPECT_FALSE(specimens_from_text(planar_tps, "fish.tps", negative).specimens[0].positions[2]);
    const LandmarkSpecimens spatial = specimens_from_text("LM3=1\n1 2 3\nID=a\nLM3=1\n4 5 6\n", "x.tps");
    EXPECT_EQ(spatial.dimension, 3);
    EXPECT_EQ(names_of(spatial), (std::vector<std::string>{"a", "x 2"}));
    EXPECT_NE(message([] { specimens_from_text("LM=1\n1 2\nLM3=1\n1 2 3\n", "x.tps"); }).find("two- and three-"),
              std::string::npos);
    EXPECT_NE(message([] { specimens_from_text("LM=2\n1 2\n1 2 3\n", "x.tps"); }).find("line 3"), std::string::npos);
    EXPECT_NE(message([] { specimens_from_text("LM=2\n1 2\nCURVES=1\nPOINTS=3\n1 2\n", "x.tps"); }).find("line 3"),
              std::string::npos);
    EXPECT_NE(message([] { specimens_from_text("LM=1\n1 2\nCURVES=1\nPOINTS=3\n1 2\n", "x.tps"); }).find("fewer"),
              std::string::npos);
}

TEST(Specimens, TpsRoundTrips) {
    LandmarkSpecimens set = specimens_from_text(planar_tps, "fish.tps");
    const LandmarkSpecimens again = specimens_from_text(specimens_to_tps(set), "again.tps");
    ASSERT_EQ(again.specimens.size(), 2U);
    EXPECT_EQ(again.dimension, 2);
    for (std::size_t s = 0; s < 2; ++s) {
        EXPECT_EQ(again.specimens[s].positions, set.specimens[s].positions);
        EXPECT_EQ(again.specimens[s].landmarks, set.specimens[s].landmarks);
        EXPECT_EQ(again.specimens[s].name, set.specimens[s].name);
    }
}

TEST(Specimens, NtsAndDtaFollowTheirHeader) {
    const LandmarkSpecimens nts =
        specimens_from_text("\"two fish\n1 2L 6 1 9999 DIM=2\nfirst second\n1 2 3 4 9999 9999\n5 6 7 8 9 10\n", "fish.nts");
    EXPECT_EQ(nts.dimension, 2);
    EXPECT_EQ(names_of(nts), (std::vector<std::string>{"first", "second"}));
    EXPECT_EQ(nts.specimens[0].positions, (std::vector<Position>{at(1, 2), at(3, 4), {}}));
    const LandmarkSpecimens dta =
        specimens_from_text("'landmarks\n1 2L 6 1 -1 DIM=3\nskull1\nskull2\n1 2 3\n-1 -1 -1\n\n4 5 6\n7 8 9\n", "skulls.dta");
    EXPECT_EQ(dta.dimension, 3);
    EXPECT_EQ(dta.specimens[0].positions, (std::vector<Position>{at(1, 2, 3), {}})) << "a code of the file's own";
    EXPECT_EQ(dta.specimens[1].positions[1], at(7, 8, 9));
    const LandmarkSpecimens begin = specimens_from_text("1 2B 4 0 DIM=2\na 1 2 3 4\nb 5 6 7 8\n", "x.nts"),
                            end = specimens_from_text("1 2E 4 0 DIM=2\n1 2 3 4 a\n5 6 7 8 b\n", "x.nts");
    EXPECT_EQ(names_of(begin), (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(end.specimens[1].positions, begin.specimens[1].positions);
    const LandmarkSpecimens single = specimens_from_text("1 3 3 0 DIM=3\n1 2 3\n4 5 6\n7 8 9\n", "one.nts");
    ASSERT_EQ(single.specimens.size(), 1U);
    EXPECT_EQ(single.specimens[0].name, "one");
    EXPECT_EQ(single.specimens[0].positions.size(), 3U);
    for (const char* broken : {"1 2 6 0\n1 2 3 4 5 6 7 8 9 10 11 12\n", "2 2 6 0 DIM=2\n", "1 2 5 0 DIM=2\n1 2 3 4 5 1 2 3 4 5\n",
                               "1 2 4 0 DIM=2\n1 2 3\n", "1 2 4 0 DIM=2\n1 2 3 4 5 6 7 8 9\n", "1 999999999 4 0 DIM=2\n1\n",
                               "1 2 4 0 DIM=2\n1 2 x 4 5 6 7 8\n"})
        EXPECT_NE(message([&] { specimens_from_text(broken, "x.nts"); }), "") << broken;
}

TEST(Specimens, PtsOfTwoKindsAndMorphologika) {
    const LandmarkSpecimens pts =
        specimens_from_text("Version 1.0\n3\nS000 1 2 3\nS001 9999 9999 9999\nS002 4 5 6\n", "skull.pts");
    ASSERT_EQ(pts.specimens.size(), 1U);
    EXPECT_EQ(pts.specimens[0].name, "skull");
    EXPECT_EQ(pts.specimens[0].landmarks[2], "S002");
    EXPECT_FALSE(pts.specimens[0].positions[1]);
    const LandmarkSpecimens face = specimens_from_text("version: 1\nn_points: 2\n{\n1.5 2\n3 4\n}\n", "face.pts");
    EXPECT_EQ(face.dimension, 2);
    EXPECT_EQ(face.specimens[0].positions, (std::vector<Position>{at(1.5, 2), at(3, 4)}));
    EXPECT_NE(message([] { specimens_from_text("Version 1.0\n3\nS000 1 2 3\n", "skull.pts"); }).find("states 3"),
              std::string::npos);
    EXPECT_NE(message([] { specimens_from_text("S000 1 2 3\nS1 1 2\n", "skull.pts"); }).find("line 2"), std::string::npos);
    const std::string morphologika =
        "[individuals]\n2\n[landmarks]\n2\n[dimensions]\n3\n[names]\nHomo\nPan\n[labels]\nsex site\n"
        "[labelvalues]\nf A\nm B\n[rawpoints]\n'1\n1 2 3\nNA NA NA\n\n'2\n4 5 6\n7 8 9\n";
    const LandmarkSpecimens two = specimens_from_text(morphologika, "apes.txt");
    EXPECT_EQ(names_of(two), (std::vector<std::string>{"Homo", "Pan"}));
    EXPECT_EQ(two.specimens[1].properties.at("site"), "B");
    EXPECT_FALSE(two.specimens[0].positions[1]);
    EXPECT_NE(
        message([&] { specimens_from_text(morphologika.substr(0, morphologika.size() - 7), "apes.txt"); }).find("specimen 2"),
        std::string::npos);
}

TEST(Specimens, TablesHaveOneRowPerSpecimenOrPerLandmark) {
    const LandmarkSpecimens wide =
        specimens_from_text("id,sex,X1,Y1,Z1,X2,Y2,Z2\na,f,1,2,3,4,5,6\nb,m,7,8,9,NA,NA,NA\n", "t.csv");
    EXPECT_EQ(wide.dimension, 3);
    EXPECT_EQ(names_of(wide), (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(wide.specimens[1].properties.at("sex"), "m");
    EXPECT_EQ(wide.specimens[0].positions[1], at(4, 5, 6));
    EXPECT_FALSE(wide.specimens[1].positions[1]);
    const LandmarkSpecimens of_r = specimens_from_text("\"\",\"1.X\",\"1.Y\",\"2.X\",\"2.Y\"\n\"p\",1,2,3,4\n", "t.csv");
    EXPECT_EQ(of_r.dimension, 2);
    EXPECT_EQ(of_r.specimens[0].name, "p");
    EXPECT_EQ(of_r.specimens[0].positions, (std::vector<Position>{at(1, 2), at(3, 4)}));
    const LandmarkSpecimens named = specimens_from_text("specimen;nasion x;nasion y;tip x;tip y\np;1;2;3;4\n", "t.csv");
    EXPECT_EQ(named.specimens[0].landmarks, (std::vector<std::string>{"nasion", "tip"}));
    const LandmarkSpecimens long_table =
        specimens_from_text("specimen,landmark,x,y,z\na,tip,1,2,3\nb,tip,4,5,6\na,end,7,8,9\n", "t.csv");
    EXPECT_EQ(names_of(long_table), (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(long_table.specimens[0].landmarks, (std::vector<std::string>{"tip", "end"}));
    EXPECT_EQ(specimens_from_text("name,x,y\na,1,2\nb,,\n", "t.csv").dimension, 2);
    EXPECT_FALSE(specimens_from_text("name,x,y\na,1,2\nb,,\n", "t.csv").specimens[0].positions[1]);
    EXPECT_EQ(specimens_from_text("1.5,2,3\n4,5,6\n", "t.csv").specimens[0].positions[1], at(4, 5, 6)) << "without a header";
    EXPECT_NE(message([] { specimens_from_text("name,label\na,b\n", "t.csv"); }), "");
    EXPECT_NE(message([] { specimens_from_text("id,X1,Y1,X2,Y2,Z2\na,1,2,3,4,5\n", "t.csv"); }).find("'1'"), std::string::npos);
}

TEST(Specimens, FilesOfOneSpecimenAreNamedAfterThem) {
    EXPECT_TRUE(is_specimen_file("folder/A.TPS"));
    EXPECT_TRUE(is_specimen_file("a.mrk.json"));
    EXPECT_FALSE(is_specimen_file("a.json"));
    EXPECT_FALSE(is_specimen_file("a.ply"));
    const LandmarkSpecimens fcsv = specimens_from_text("# CoordinateSystem = LPS\nid,1,2,3,0,0,0,1,1,1,0,tip,,\n", "a/b.fcsv");
    EXPECT_EQ(fcsv.specimens[0].name, "b");
    EXPECT_EQ(fcsv.specimens[0].landmarks[0], "tip");
    EXPECT_EQ(fcsv.unit, "mm");
    for (const char* file : {"a.tps", "a.nts", "a.pts", "a.csv", "a.txt", "a.mrk.json", "a.pp"})
        EXPECT_NE(message([&] { specimens_from_text("\n", file); }).find("empty"), std::string::npos) << file;
    EXPECT_NE(message([] { specimens_from_text("x", "a.stl"); }).find("not a landmark file"), std::string::npos);
}

TEST(Specimens, DamagedFilesAreRefusedOrRead) {
    const std::vector<std::pair<std::string, std::string>> files{
        {planar_tps, "x.tps"},
        {"1 2L 6 1 9999 DIM=2\nfirst second\n1 2 3 4 9999 9999\n5 6 7 8 9 10\n", "x.nts"},
        {"Version 1.0\n2\nS000 1 2 3\nS002 4 5 6\n", "x.pts"},
        {"id,sex,X1,Y1,Z1,X2,Y2,Z2\na,f,1,2,3,4,5,6\nb,m,7,8,9,NA,NA,NA\n", "x.csv"},
        {"[individuals]\n1\n[landmarks]\n2\n[dimensions]\n3\n[rawpoints]\n'1\n1 2 3\n4 5 6\n", "x.txt"}};
    for (const auto& [text, name] : files)
        for (std::size_t cut = 0; cut < text.size(); cut += 3) {
            std::string damaged = text;
            damaged[cut] = static_cast<char>(cut % 7 == 0 ? '\xff' : cut % 5 == 0 ? '9' : '=');
            for (const std::string& version : {text.substr(0, cut), damaged}) {
                try {
                    for (const LandmarkSpecimen& specimen : specimens_from_text(version, name).specimens)
                        EXPECT_EQ(specimen.landmarks.size(), specimen.positions.size());
                } catch (const Error&) {
                }
            }
        }
}

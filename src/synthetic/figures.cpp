// Synthetic figures: a hand and a statuette with a drum.
#include "synthetic/builder.h"

namespace ostraka::shapes {

ObjectPointer make_hand() {
    auto object = start_object("hand", "hand", "open left hand with wrist, palm and five fingers", 0, 1000, 5);
    const int palm = add_part(*object, "palm", {224, 180, 150}), wrist = add_part(*object, "wrist", {200, 150, 120});
    const int thumb = add_part(*object, "thumb", {200, 60, 60}), index = add_part(*object, "index finger", {220, 140, 50});
    const int middle = add_part(*object, "middle finger", {190, 180, 60}), ring = add_part(*object, "ring finger", {80, 150, 90});
    const int little = add_part(*object, "little finger", {70, 110, 180});
    // Fingers point along z, the palm faces -y. The metacarpals, blended widely, form the palm.
    add_member(*object, make_tube({{{-6, 0, 6}, 15}, {{-22, 0, 42}, 13.5}, {{-31, 1, 82}, 11.5}}), palm, 0);
    add_member(*object, make_tube({{{-2, 0, 6}, 15}, {{-7, 1, 44}, 13.5}, {{-10, 2.5, 86}, 12}}), palm, 14);
    add_member(*object, make_tube({{{2, 0, 6}, 15}, {{7, 1, 44}, 13}, {{11, 2, 82}, 11.5}}), palm, 14);
    add_member(*object, make_tube({{{6, 0, 6}, 15}, {{20, 0, 40}, 12.5}, {{30, 0.5, 74}, 10.5}}), palm, 14);
    add_member(*object, make_tube({{{-8, -4, 12}, 14}, {{-24, -9, 26}, 14}, {{-34, -11, 40}, 12}}), palm, 14);
    add_member(*object, make_tube({{{0, 0, -48}, 22}, {{0, 0, -22}, 20}, {{0, 0, -2}, 19}}), wrist, 14);
    add_member(*object,
               make_tube({{{-33, -11, 38}, 11.5}, {{-46, -14, 56}, 10.5}, {{-57, -17, 74}, 10.5}, {{-64, -21, 92}, 8.5}}), thumb,
               8);
    const auto finger = [&](int part, const Vector3d& knuckle, double spread, const std::array<double, 3>& lengths,
                            double radius) {
        // Each joint bends a little towards the palm.
        std::vector<Bead> beads{{knuckle, radius * 1.05}};
        double bend = 6;
        Vector3d position = knuckle;
        for (std::size_t joint = 0; joint < 3; ++joint, bend += 9) {
            const Vector3d direction = turned(spread, Vector3d::UnitY()) * turned(bend, Vector3d::UnitX()) * Vector3d::UnitZ();
            beads.push_back({position + 0.5 * lengths[joint] * direction, radius * (0.94 - 0.06 * static_cast<double>(joint))});
            position += lengths[joint] * direction;
            beads.push_back({position, radius * (0.99 - 0.08 * static_cast<double>(joint))});
        }
        add_member(*object, make_tube(beads), part, 5);
    };
    finger(index, {-32, 1, 88}, -12, {40, 24, 17}, 9.6);
    finger(middle, {-10.5, 2.5, 92}, -3, {45, 28, 19}, 9.9);
    finger(ring, {12, 2, 88}, 5, {41, 26, 18}, 9.4);
    finger(little, {32, 0.5, 79}, 14, {32, 20, 15}, 8.2);
    return finished(std::move(object));
}

ObjectPointer make_statuette() {
    // Genus 2: an opening between each arm and the body.
    auto object = start_object("statuette", "drum player statuette",
                               "votive figure: base, tubular body, head with a cap, two arms that hold a drum before the chest",
                               2, 1500, 5);
    const int body = add_part(*object, "body", {196, 140, 96}), base = add_part(*object, "base", {120, 90, 70});
    const int head = add_part(*object, "head", {214, 170, 130}), cap = add_part(*object, "cap", {90, 110, 150});
    const int left = add_part(*object, "left arm", {190, 70, 60}), right = add_part(*object, "right arm", {80, 140, 90});
    const int drum = add_part(*object, "drum", {220, 180, 70});
    const std::vector<Vector2d> profile{{0, 3},    {30, 3},   {38, 0},    {42, 4},   {41, 10},  {36, 16},
                                        {27, 24},  {22, 36},  {19.5, 56}, {19, 80},  {21, 105}, {25, 126},
                                        {23, 140}, {13, 149}, {10, 156},  {10, 163}, {0, 166}};
    add_divided_member(*object, make_revolved({}, profile), profile, 0, {{6, base}, {99, body}});
    // Shoulders, wider than deep.
    add_member(*object, make_ellipsoid({{0, 0, 132}, Eigen::Matrix3d::Identity()}, {18, 34, 13}), body, 12);
    add_member(*object, make_ellipsoid({{3, 0, 178}, Eigen::Matrix3d::Identity()}, {17, 15, 20}), head, 6);
    add_member(*object, make_tube({{{17, 0, 184}, 3}, {{23, 0, 177}, 4}}), head, 5);  // nose
    for (const double side : {1.0, -1.0})
        add_member(*object, make_ellipsoid({{1, side * 15.5, 177}, Eigen::Matrix3d::Identity()}, {4, 3.5, 6}), head, 3);
    const std::vector<Vector2d> hat{{0, 0}, {14, 0.5}, {18, 3}, {16.5, 8}, {12, 18}, {7, 27}, {0, 31}};
    add_member(*object, make_revolved({{0, 0, 189}, turned(-8, Vector3d::UnitY())}, hat), cap, 3);
    // The drum's axis points forward; its rear skin rests on the chest.
    add_member(*object, make_cylinder({{30, 0, 112}, turned(90, Vector3d::UnitY())}, 25, 9, 3.5), drum, 10);
    for (const double side : {1.0, -1.0}) {
        add_member(*object,
                   make_tube({{{0, side * 28, 133}, 8.5},
                              {{0, side * 43, 118}, 7.5},
                              {{8, side * 48, 100}, 7},
                              {{24, side * 40, 98}, 6.5},
                              {{36, side * 26, 105}, 7}}),
                   side > 0 ? left : right, 5);
    }
    return finished(std::move(object));
}

}  // namespace ostraka::shapes

// Synthetic animals: an elephant and a bird.
#include "synthetic/builder.h"

namespace ostraka::shapes {

namespace {

/// The name of a part on the left (1) or the right (-1) side.
std::string sided(double side, const std::string& part) { return (side > 0 ? "left " : "right ") + part; }

void add_elephant_legs(SyntheticObject& object) {
    for (const double front : {1.0, -1.0})
        for (const double side : {1.0, -1.0}) {
            const auto shade = static_cast<std::uint8_t>(110 + 25 * front + 12 * side);
            const int leg = add_part(object, (front > 0 ? "front " : "hind ") + sided(side, "leg"), {shade, 140, 90});
            const double x = front > 0 ? 58 : -58;
            add_member(object, make_tube({{{x, side * 30, 128}, 26}, {{x - 2, side * 33, 72}, 19}, {{x + 1, side * 33, 22}, 20}}),
                       leg, 12);
        }
}

}  // namespace

ObjectPointer make_elephant() {
    auto object =
        start_object("elephant", "elephant",
                     "standing elephant: body, head, trunk, two ears, two tusks, four legs, tail with a tuft", 0, 2500, 8);
    const int body = add_part(*object, "body", {150, 150, 155}), head = add_part(*object, "head", {175, 165, 160});
    const int trunk = add_part(*object, "trunk", {120, 130, 170}), tail = add_part(*object, "tail", {190, 120, 60});
    const int tuft = add_part(*object, "tuft", {90, 50, 30});
    add_member(*object, make_ellipsoid({{0, 0, 152}, Matrix3d::Identity()}, {98, 56, 58}), body, 0);
    add_member(*object, make_ellipsoid({{112, 0, 190}, turned(20, Vector3d::UnitY())}, {44, 36, 46}), head, 16);
    add_member(*object,
               make_tube({{{136, 0, 178}, 21}, {{161, 0, 140}, 16}, {{170, 0, 95}, 12.5}, {{172, 0, 52}, 10}, {{186, 0, 26}, 9}}),
               trunk, 10);
    for (const double side : {1.0, -1.0}) {
        const int ear = add_part(*object, sided(side, "ear"), side > 0 ? Colour3{200, 80, 70} : Colour3{220, 120, 90});
        add_member(*object,
                   make_ellipsoid({{88, side * 62, 186}, turned(side * -28, Vector3d::UnitZ()) * turned(8, Vector3d::UnitY())},
                                  {7.5, 38, 46}),
                   ear, 6);
    }
    for (const double side : {1.0, -1.0}) {
        const int tusk = add_part(*object, sided(side, "tusk"), side > 0 ? Colour3{235, 225, 190} : Colour3{215, 205, 170});
        add_member(*object, make_tube({{{140, side * 24, 164}, 7}, {{168, side * 32, 146}, 5.5}, {{196, side * 33, 152}, 4.5}}),
                   tusk, 4);
    }
    add_elephant_legs(*object);
    const std::vector<Bead> beads{{{-90, 0, 178}, 7}, {{-112, 0, 148}, 5}, {{-119, 0, 112}, 4.5}, {{-122, 0, 82}, 6.5}};
    add_divided_member(*object, make_tube(beads), beads, 6, {{2.3, tail}, {99, tuft}});
    return finished(std::move(object));
}

ObjectPointer make_bird() {
    auto object =
        start_object("bird", "bird", "standing bird: body, head on a neck, beak, tail, two wings, two feet", 0, 2500, 7);
    const int body = add_part(*object, "body", {196, 170, 120}), head = add_part(*object, "head", {70, 120, 90});
    const int beak = add_part(*object, "beak", {230, 150, 40}), tail = add_part(*object, "tail", {120, 90, 70});
    add_member(*object, make_ellipsoid({{0, 0, 66}, turned(-8, Vector3d::UnitY())}, {62, 38, 36}), body, 0);
    // The lower half of the neck belongs to the body.
    const std::vector<Bead> neck{{{36, 0, 78}, 20}, {{56, 0, 106}, 14}, {{62, 0, 134}, 14}};
    add_divided_member(*object, make_tube(neck), neck, 14, {{1.3, body}, {99, head}});
    add_member(*object, make_ellipsoid({{67, 0, 150}, Matrix3d::Identity()}, {22, 18, 19}), head, 8);
    add_member(*object, make_tube({{{82, 0, 148}, 9}, {{101, 0, 145}, 7}, {{122, 0, 141}, 4.5}}), beak, 4);
    add_member(*object, make_ellipsoid({{-72, 0, 78}, turned(14, Vector3d::UnitY())}, {38, 22, 7}), tail, 10);
    for (const double side : {1.0, -1.0}) {
        const int wing = add_part(*object, sided(side, "wing"), side > 0 ? Colour3{90, 110, 160} : Colour3{120, 140, 185});
        add_member(*object,
                   make_ellipsoid({{-8, side * 36, 70}, turned(-10, Vector3d::UnitY()) * turned(side * 8, Vector3d::UnitZ())},
                                  {44, 8, 23}),
                   wing, 4);
    }
    for (const double side : {1.0, -1.0}) {
        const int foot = add_part(*object, sided(side, "foot"), side > 0 ? Colour3{220, 110, 60} : Colour3{235, 140, 85});
        add_member(
            *object,
            make_tube({{{4, side * 16, 36}, 8}, {{2, side * 17, 16}, 6}, {{10, side * 18, 7}, 7}, {{26, side * 20, 6}, 6}}), foot,
            5);
    }
    return finished(std::move(object));
}

}  // namespace ostraka::shapes

// Synthetic furniture: an armchair.
#include "synthetic/builder.h"

namespace ostraka::shapes {

namespace {
/// Point at a height on the axis of a front leg, which continues as the arm support.
Vector3d along_leg(double height, double side) {
    const Vector3d top(150, side * 214, 655), foot(226, side * 190, 17);
    return foot + (height - foot[2]) / (top[2] - foot[2]) * (top - foot);
}
}  // namespace

ObjectPointer make_chair() {
    // Genus 2: an opening under each arm.
    auto object = start_object("chair", "armchair", "chair with back, two arms on supports and four legs", 2, 1500, 18);
    const int seat = add_part(*object, "seat", {190, 140, 90}), back = add_part(*object, "back", {160, 100, 60});
    add_member(*object, make_box({{0, 0, 440}, Eigen::Matrix3d::Identity()}, {240, 230, 22}, 16), seat, 0);
    // The back leans by 10 degrees, on the rear edge of the seat.
    const Eigen::Matrix3d lean = turned(-10, Vector3d::UnitY());
    add_member(*object, make_box({{-258, 0, 670}, lean}, {20, 215, 250}, 16), back, 14);
    for (const double side : {1.0, -1.0}) {
        const bool left = side > 0;
        const int arm = add_part(*object, left ? "left arm" : "right arm", left ? Colour3{80, 120, 170} : Colour3{90, 150, 190});
        const int support =
            add_part(*object, left ? "left support" : "right support", left ? Colour3{170, 70, 60} : Colour3{200, 100, 80});
        add_member(*object,
                   make_tube({{{-262, side * 205, 668}, 20},
                              {{-120, side * 210, 676}, 20},
                              {{40, side * 214, 672}, 22},
                              {{190, side * 213, 660}, 24}}),
                   arm, 14);
        add_member(
            *object,
            make_tube(
                {{along_leg(440, side), 15}, {along_leg(520, side), 17}, {along_leg(600, side), 15}, {along_leg(655, side), 15}}),
            support, 12);
    }
    const char* names[4] = {"front left leg", "front right leg", "rear left leg", "rear right leg"};
    const Colour3 colours[4] = {{90, 140, 80}, {120, 165, 95}, {70, 115, 75}, {140, 180, 120}};
    for (int i = 0; i < 4; ++i) {
        const double front = i < 2 ? 1 : -1, side = i % 2 == 0 ? 1 : -1;
        const int leg = add_part(*object, names[i], colours[i]);
        if (front > 0) {
            add_member(*object,
                       make_tube({{along_leg(430, side), 25},
                                  {along_leg(280, side), 24},
                                  {along_leg(130, side), 19},
                                  {along_leg(17, side), 17}}),
                       leg, 16);
            continue;
        }
        add_member(*object,
                   make_tube({{{front * 190, side * 180, 430}, 26},
                              {{front * 202, side * 188, 280}, 24},
                              {{front * 216, side * 198, 130}, 19},
                              {{front * 228, side * 206, 17}, 17}}),
                   leg, 16);
    }
    return finished(std::move(object));
}

}  // namespace ostraka::shapes

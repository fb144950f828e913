// Synthetic vessels: the flowered teapot and the vase.
#include "ostraka/core/angles.h"
#include "synthetic/builder.h"

#include <cmath>

namespace ostraka::shapes {

ObjectPointer make_teapot() {
    auto object = start_object("teapot", "flowered teapot",
                               "lidded teapot with spout, handle, knob and five flowers in relief at one level", 1, 1500, 2.2);
    const int body = add_part(*object, "body", {214, 205, 186}), base = add_part(*object, "base", {120, 86, 60});
    const int lid = add_part(*object, "lid", {170, 140, 100}), knob = add_part(*object, "knob", {196, 150, 40});
    const int spout = add_part(*object, "spout", {70, 120, 170}), handle = add_part(*object, "handle", {70, 140, 90});

    // Foot ring, belly, shoulder, groove under the lid, dome, neck of the knob, knob.
    const std::vector<Vector2d> profile{{0, 3},    {24, 3},    {31, 0},  {35, 3},  {35, 8},    {43, 15},     {54, 30},
                                        {59, 48},  {55, 68},   {44, 82}, {33, 88}, {30, 91},   {31.5, 95},   {27, 100},
                                        {17, 105}, {8, 108.5}, {5, 112}, {8, 117}, {8.5, 122}, {4.5, 126.5}, {0, 127.5}};
    add_divided_member(*object, make_revolved({}, profile), profile, 0, {{4, base}, {11, body}, {15.5, lid}, {99, knob}});
    const std::vector<Bead> spout_beads{
        {{44, 0, 30}, 17}, {{62, 0, 38}, 13}, {{76, 0, 56}, 9.5}, {{85, 0, 78}, 7.5}, {{97, 0, 92}, 7}};
    add_member(*object, make_tube(spout_beads), spout, 9);
    const std::vector<Bead> handle_beads{{{-47, 0, 76}, 6.5}, {{-66, 0, 85}, 5.5}, {{-87, 0, 80}, 5.5}, {{-95, 0, 60}, 5.5},
                                         {{-84, 0, 38}, 5.5}, {{-66, 0, 26}, 5.5}, {{-46, 0, 22}, 6.5}};
    add_member(*object, make_tube(handle_beads), handle, 6);
    carve(*object, make_tube({{{92, 0, 86.5}, 4.2}, {{110, 0, 103}, 4.2}}), -1, 4);

    const double radius = 58.6, level = 52;
    const Colour3 petals[5] = {{200, 40, 60}, {220, 90, 40}, {190, 50, 130}, {140, 60, 180}, {230, 160, 40}};
    for (int i = 0; i < 5; ++i) {
        const double angle = (36 + 72 * i) * pi / 180;
        const Vector3d outward(std::cos(angle), std::sin(angle), 0);
        const int flower = add_part(*object, "flower " + std::to_string(i + 1), petals[i]);
        object->reliefs.push_back({radius * outward + Vector3d(0, 0, level), outward, 9, 1.2, 0.16, 5, flower});
    }
    return finished(std::move(object));
}

ObjectPointer make_vase() {
    auto object = start_object("vase", "two-handled vase",
                               "hollow vase with foot, belly, decorated band, neck, lip and two handles", 2, 2000, 4);
    const int foot = add_part(*object, "foot", {110, 70, 50}), belly = add_part(*object, "belly", {196, 120, 70});
    const int band = add_part(*object, "band", {40, 40, 40}), shoulder = add_part(*object, "shoulder", {206, 136, 84});
    const int neck = add_part(*object, "neck", {180, 100, 60}), lip = add_part(*object, "lip", {60, 50, 45});
    const int inside = add_part(*object, "inside", {150, 110, 90});
    const std::vector<Vector2d> profile{{0, 2},    {26, 2},     {34, 0},     {37, 4},   {33, 10},    {29, 17},    {36, 32},
                                        {52, 58},  {65, 88},    {70, 118},  // foot, belly
                                        {69, 136}, {62, 156},   {46, 176},   {33, 192}, {28, 208},   {27.5, 226}, {32, 242},
                                        {42, 252}, {44, 256},   {41, 258.5},  // band, shoulder, neck, lip
                                        {34, 252}, {25.5, 240}, {21.5, 226}, {22, 208}, {26.5, 192}, {39, 172},   {54.5, 152},
                                        {61, 134}, {62, 118},   {57, 90},    {45, 62},  {28, 36},    {12, 26},    {0, 24}};
    add_divided_member(*object, make_revolved({}, profile), profile, 0,
                       {{5, foot}, {9, belly}, {10, band}, {12.5, shoulder}, {17, neck}, {20, lip}, {99, inside}});
    for (const double side : {1.0, -1.0}) {
        const int handle = add_part(*object, side > 0 ? "right handle" : "left handle",
                                    side > 0 ? Colour3{60, 110, 160} : Colour3{70, 150, 100});
        const std::vector<Bead> beads{{{side * 31, 0, 222}, 6},   {{side * 46, 0, 230}, 5.5}, {{side * 64, 0, 222}, 5.5},
                                      {{side * 72, 0, 200}, 5.5}, {{side * 70, 0, 179}, 5.5}, {{side * 63, 0, 160}, 6}};
        add_member(*object, make_tube(beads), handle, 5);
    }
    return finished(std::move(object));
}

}  // namespace ostraka::shapes

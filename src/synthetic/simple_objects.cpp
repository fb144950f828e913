// Objects with closed-form area and volume.
#include "ostraka/core/angles.h"
#include "synthetic/builder.h"

namespace ostraka::shapes {

namespace {
std::unique_ptr<SyntheticObject> start(const std::string& name, const std::string& description, int genus, double area,
                                       double volume) {
    auto object = start_object(name, name, description, genus, 200, std::numeric_limits<double>::infinity());
    object->exact_area = area;
    object->exact_volume = volume;
    return object;
}
constexpr Colour3 grey{190, 190, 185}, red{200, 60, 50}, blue{60, 100, 190}, green{70, 160, 90};
}  // namespace

ObjectPointer make_sphere() {
    const double r = 50;
    auto object = start("sphere", "radius 50; caps of 0.5, 2.5 and 10 % of the area around +z, +x and -z", 0, 4 * pi * r * r,
                        4.0 / 3 * pi * r * r * r);
    const int rest = add_part(*object, "rest", grey);
    add_member(*object, make_ellipsoid({}, {r, r, r}), rest, 0);
    // A cap of height h has the area 2 pi r h, a fraction h / 2r of the sphere's.
    const auto cap = [&](const std::string& name, const Colour3& colour, const Vector3d& axis, double share) {
        const int part = add_part(*object, name, colour);
        object->cuts.push_back(
            {rest, part, [axis, level = r - 2 * r * share](const Vector3d& p) { return level - axis.dot(p); }});
    };
    cap("small cap", red, Vector3d::UnitZ(), 0.005);
    cap("cap", blue, Vector3d::UnitX(), 0.025);
    cap("large cap", green, -Vector3d::UnitZ(), 0.1);
    return finished(std::move(object));
}

ObjectPointer make_torus_object() {
    const double ring = 50, tube = 20;
    auto object = start("torus", "ring radius 50, tube radius 20; outer half 2 pi r (pi R + 2 r), inner half 2 pi r (pi R - 2 r)",
                        1, 4 * pi * pi * ring * tube, 2 * pi * pi * ring * tube * tube);
    const int outer = add_part(*object, "outer half", grey), inner = add_part(*object, "inner half", red);
    add_member(*object, make_torus({}, ring, tube), outer, 0);
    object->cuts.push_back({outer, inner, [ring](const Vector3d& p) { return std::hypot(p.x(), p.y()) - ring; }});
    return finished(std::move(object));
}

ObjectPointer make_box_object() {
    const Vector3d half(60, 40, 25);
    const double r = 8;
    // Steiner formula: the box reduced by r, dilated by balls of radius r.
    const Vector3d a = 2 * (half - Vector3d::Constant(r));
    const double flat = 2 * (a.x() * a.y() + a.y() * a.z() + a.z() * a.x()), edges = a.sum();
    auto object =
        start("box", "120 x 80 x 50 with edges rounded by 8; the top plate is a part of its own", 0,
              flat + 2 * pi * r * edges + 4 * pi * r * r, a.prod() + flat * r + pi * r * r * edges + 4.0 / 3 * pi * r * r * r);
    const int sides = add_part(*object, "sides", grey), top = add_part(*object, "top", blue);
    add_member(*object, make_box({}, half, r), sides, 0);
    object->cuts.push_back({sides, top, [level = half.z() - r](const Vector3d& p) { return level - p.z(); }});
    return finished(std::move(object));
}

ObjectPointer make_capsule() {
    const double r = 20, length = 80;
    auto object = start("capsule", "radius 20, straight part 80 along z; the two caps are parts", 0,
                        2 * pi * r * length + 4 * pi * r * r, pi * r * r * length + 4.0 / 3 * pi * r * r * r);
    const int middle = add_part(*object, "middle", grey), upper = add_part(*object, "upper cap", red),
              lower = add_part(*object, "lower cap", blue);
    add_member(*object, make_tube({{{0, 0, -length / 2}, r}, {{0, 0, length / 2}, r}}), middle, 0);
    object->cuts.push_back({middle, upper, [=](const Vector3d& p) { return length / 2 - p.z(); }});
    object->cuts.push_back({middle, lower, [=](const Vector3d& p) { return length / 2 + p.z(); }});
    return finished(std::move(object));
}

ObjectPointer make_cylinder_object() {
    const double radius = 30, half = 50, r = 6, core = radius - r;
    // Centroid of a quarter circle: 2 r / pi from its centre (area by Pappus); of the quarter disc: 4 r / 3 pi (volume).
    const double area = 2 * (pi * core * core + 2 * pi * (core + 2 * r / pi) * (pi * r / 2)) + 2 * pi * radius * 2 * (half - r);
    const double volume = pi * radius * radius * 2 * (half - r) +
                          2 * (pi * core * core * r + 2 * pi * (core + 4 * r / (3 * pi)) * (pi * r * r / 4));
    auto object = start("cylinder", "radius 30, height 100, rims rounded by 6; side, top and bottom are parts", 0, area, volume);
    const int side = add_part(*object, "side", grey), top = add_part(*object, "top", red),
              bottom = add_part(*object, "bottom", blue);
    add_member(*object, make_cylinder({}, radius, half, r), side, 0);
    object->cuts.push_back({side, top, [=](const Vector3d& p) { return half - r - p.z(); }});
    object->cuts.push_back({side, bottom, [=](const Vector3d& p) { return half - r + p.z(); }});
    return finished(std::move(object));
}

}  // namespace ostraka::shapes

#include "ostraka/synthetic/statuettes.h"
#include "ostraka/core/angles.h"

#include "synthetic/builder.h"
#include "synthetic/statuette_build.h"
#include "synthetic/warp.h"

#include "ostraka/core/error.h"
#include "ostraka/stats/random.h"

#include <fmt/core.h>

#include <cmath>
#include <map>

namespace ostraka {

using shapes::Wave;

namespace shapes {

namespace {

/// Random phases, periods and wavelengths from one seed.
class Draws {
public:
    explicit Draws(std::uint64_t seed) : seed_(seed) {}
    double between(double low, double high) { return low + (high - low) * random_share(seed_, next_++); }
    double angle() { return between(0, 2 * pi); }

private:
    std::uint64_t seed_, next_ = 0;
};

/// Waves of random phase and equal amplitude, whose root mean square over the body is `deviation`.
std::vector<Wave> random_waves(Draws& draw, int count, double deviation, int min_around, int max_around, double shortest,
                               double longest) {
    std::vector<Wave> waves;
    for (int i = 0; i < count; ++i) {
        const int around = min_around + i % (max_around - min_around + 1);
        const double side = draw.between(-1, 1) < 0 ? -1 : 1;
        const double upward = side * 2 * pi / draw.between(shortest, longest);
        waves.push_back({deviation * std::sqrt(2.0 / count), around, upward, draw.angle()});
    }
    return waves;
}

/// Waves along the body from half a period upwards; amplitudes are proportional to the wavelength.
std::vector<Wave> sway_waves(Draws& draw, double deviation, double height) {
    std::vector<Wave> waves;
    const double norm = std::sqrt(1 + 1 / 4.0 + 1 / 9.0);
    for (int k = 1; k <= 3; ++k) waves.push_back({deviation / (k * norm), 0, pi * k / height, draw.angle()});
    return waves;
}

}  // namespace

StatuetteFrame::StatuetteFrame(const StatuetteParameters& p)
    : neck_radius(0.2 * p.head_height),
      joint_height(p.height - std::sqrt(p.head_height * p.head_height - neck_radius * neck_radius)),
      tube_radius(0.33 * p.base_diameter),
      cavity_depth(0.8 * joint_height * p.cavity_seen) {
    // Radius and height, relative to the base radius and the joint height: rim, flare, tube, shoulders, neck.
    const double radius = 0.5 * p.base_diameter / (1 + p.ovality);
    const std::vector<Vector2d> shape{{1, 0.022},   {0.975, 0.05}, {0.88, 0.10}, {0.765, 0.17}, {0.69, 0.28},
                                      {0.66, 0.41}, {0.65, 0.55},  {0.67, 0.68}, {0.73, 0.785}, {0.70, 0.875}};
    using One = Spline<1>::Vec;
    std::vector<double> heights;
    std::vector<One> radii;
    const auto add = [&](double across, double up) { heights.push_back(up), radii.push_back(One(across)); };
    for (const Vector2d& point : shape) add(point.x() * radius, point.y() * joint_height);
    add(0.5 * (radii.back()[0] + neck_radius), 0.945 * joint_height);
    add(1.04 * neck_radius, 0.985 * joint_height);
    // Enough points that splines through them and through displaced points hardly differ.
    const Spline<1> curve(heights, radii);
    for (const double z : curve.samples(3)) outline.emplace_back(curve.at(z).value[0], z);
}

StatuetteBody::StatuetteBody(const StatuetteParameters& p) : frame(p) {
    Draws draw(p.seed);
    using Scalar = Spline<1>::Vec;
    std::vector<double> heights;
    std::vector<Scalar> radii;
    for (const Vector2d& point : frame.outline) {
        heights.push_back(point.y());
        radii.push_back(Scalar(point.x()));
    }
    const double high = frame.joint_height, sway = p.sway * frame.tube_radius / std::sqrt(2.0);
    direction = draw.angle();
    std::vector<Wave> relative{{p.ovality, 2, -2 * p.ovality_drift * pi / 180 / high, -2 * direction}};
    for (const Wave& wave : random_waves(draw, 10, p.finger_marks, 3, 7, 30, 80)) relative.push_back(wave);
    // Hands rise as the wheel turns: one turn per 7 mm.
    const std::vector<Wave> grooves{{0.5 * p.grooves, 1, 2 * pi / 7, draw.angle()}};
    const std::vector<Wave> x = sway_waves(draw, sway, high), y = sway_waves(draw, sway, high);
    // Waves start above the rim of the foot and end at the neck.
    const Warp warp{.low = heights.front(),
                    .high = high,
                    .offset = Vector2d::Zero(),
                    .centre_x = x,
                    .centre_y = y,
                    .size = Spline<1>(heights, radii),
                    .relative = relative,
                    .absolute = grooves,
                    .core = 0.6 * frame.neck_radius};
    outside = std::make_shared<const Warp>(warp);
    const double offset_angle = draw.angle();
    Warp inner_warp = warp;
    inner_warp.offset = p.off_centre * p.wall * Vector2d(std::cos(offset_angle), std::sin(offset_angle));
    for (const Wave& wave : random_waves(draw, 8, p.wall_noise * p.wall, 1, 4, 40, 100)) inner_warp.absolute.push_back(wave);
    inside = std::make_shared<const Warp>(std::move(inner_warp));
    cavity_end_phase = draw.angle();
}

namespace {

/// The outline, with the flat foot below and the stump inside the head above.
std::vector<Vector2d> body_profile(const StatuetteParameters& p, const StatuetteFrame& frame) {
    const double rim = frame.outline.front().x(), lift = frame.outline.front().y();
    std::vector<Vector2d> profile{{0, 0}, {0.5 * (rim - lift), 0}, {0.85 * (rim - lift), 0}, {rim - lift, 0}};
    for (const double angle : {pi / 6, pi / 3})
        profile.emplace_back(rim - lift * (1 - std::sin(angle)), lift * (1 - std::cos(angle)));
    for (const Vector2d& point : frame.outline) profile.push_back(point);
    profile.emplace_back(frame.neck_radius, frame.joint_height + 0.04 * p.head_height);
    profile.emplace_back(frame.neck_radius, frame.joint_height + 0.15 * p.head_height);
    profile.emplace_back(0, frame.joint_height + 0.25 * p.head_height);
    return profile;
}

std::vector<Vector2d> cavity_profile(const StatuetteParameters& p, const StatuetteFrame& frame) {
    const double rim = frame.outline.front().x() - p.wall;
    std::vector<Vector2d> profile{{0, -0.06 * frame.joint_height}, {rim, -0.06 * frame.joint_height}};
    double last = 0;
    for (const Vector2d& point : frame.outline) {
        if (point.y() > 0.89 * frame.joint_height) break;
        profile.emplace_back(point.x() - p.wall, point.y());
        last = point.y();
    }
    profile.emplace_back(0, last + 0.06 * frame.joint_height);
    return profile;
}

}  // namespace

Arm::Arm(const StatuetteParameters& p, const StatuetteBody& body, double side)
    : side_(side), free_tip_(p.pose != StatuetteParameters::Pose::offering) {
    using Pose = StatuetteParameters::Pose;
    static const std::map<Pose, std::vector<Vector3d>> poses{
        {Pose::forward, {{0, 0, 0}, {0.10, 0.22, -0.22}, {0.45, 0.24, -0.32}, {0.85, 0.14, -0.20}}},
        {Pose::offering, {{0, 0, 0}, {0.08, 0.22, -0.26}, {0.42, 0.10, -0.38}, {0.74, -0.27, -0.30}}},
        {Pose::raised, {{0, 0, 0}, {0.08, 0.34, -0.04}, {0.12, 0.58, 0.20}, {0.12, 0.66, 0.56}}},
        {Pose::down, {{0, 0, 0}, {0.02, 0.24, -0.20}, {0.06, 0.34, -0.58}, {0.12, 0.34, -0.95}}}};
    const StatuetteFrame& frame = body.frame;
    const double height = 0.855 * frame.joint_height, thick = 0.40 * frame.tube_radius;
    const Vector2d centre = body.outside->centre(height);
    const Vector3d shoulder(centre.x(), centre.y() + side * 1.30 * frame.tube_radius, height);
    const auto beads_of = [&](double scale) {
        std::vector<Bead> arm_beads;
        const double thickness[] = {1.05, 0.95, 0.85, 0.85};
        std::size_t i = 0;
        for (const Vector3d& direction : poses.at(p.pose))
            arm_beads.push_back(
                {shoulder + scale * Vector3d(direction.x(), side * direction.y(), direction.z()), thick * thickness[i++]});
        return arm_beads;
    };
    // The length along the outside increases with the reach: bisection.
    double low = 0.2 * p.arm_length, high = 2 * p.arm_length;
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        beads = beads_of(middle);
        (outside_length() < p.arm_length ? low : high) = middle;
    }
}

/// Points along the outside, from the joint to the tip of the hand.
std::vector<Vector3d> Arm::outside(int pieces) const {
    std::vector<Vector3d> points;
    std::vector<double> radii;
    for (const Bead& bead : beads) points.push_back(bead.centre), radii.push_back(bead.radius);
    const std::vector<double> knots = chord_lengths(beads);
    const Spline<3> path(knots, points);
    std::vector<Vector3d> outside_points;
    for (int i = 0; i <= pieces; ++i) {
        const double t = path.length() * i / pieces;
        const auto state = path.at(t);
        const Vector3d along = state.first.normalized(), outward(0, 0.8 * side_, 0.6);
        const Vector3d normal = (outward - outward.dot(along) * along).normalized();
        std::size_t piece = 0;
        while (piece + 2 < knots.size() && knots[piece + 1] < t) ++piece;
        const double share = (t - knots[piece]) / (knots[piece + 1] - knots[piece]);
        outside_points.push_back(state.value + ((1 - share) * radii[piece] + share * radii[piece + 1]) * normal);
        if (i == pieces && free_tip_) outside_points.push_back(state.value + radii.back() * along);
    }
    return outside_points;
}

double Arm::outside_length() const {
    const std::vector<Vector3d> places = outside(60);
    double length = 0;
    for (std::size_t i = 1; i < places.size(); ++i) length += (places[i] - places[i - 1]).norm();
    return length;
}

namespace {

void add_head(SyntheticObject& object, const StatuetteParameters& p, const StatuetteBody& body, int head) {
    using Hat = StatuetteParameters::Hat;
    const double h = p.head_height, joint = body.frame.joint_height;
    const Vector2d c = body.outside->centre(joint);
    const auto at = [&](double x, double y, double z) { return Vector3d(c.x() + x * h, c.y() + y * h, joint + z * h); };
    // The head height is measured from the back of the neck, a neck radius off the axis, so that the top is less than h above
    // the joint.
    const double top = (p.height - joint) / h;
    const double skull_top = p.hat == Hat::none ? top : p.hat == Hat::cap ? top - 0.07 : 0.72;
    const double skull = 0.5 * (skull_top - 0.04);
    add_member(object, make_ellipsoid({at(0.02, 0, 0.04 + skull), Matrix3d::Identity()}, {0.33 * h, 0.29 * h, skull * h}), head,
               0.1 * h);
    const double eyes = 0.04 + 1.12 * skull;
    add_member(object, make_tube({{at(0.32, 0, eyes + 0.04), 0.045 * h}, {at(0.39, 0, eyes - 0.10), 0.075 * h}}), head, 0.08 * h);
    for (const double side : {1.0, -1.0}) {
        add_member(object,
                   make_ellipsoid({at(0.295, side * 0.125, eyes + 0.01), Matrix3d::Identity()}, {0.045 * h, 0.06 * h, 0.04 * h}),
                   head, 0.02 * h);
        add_member(object,
                   make_ellipsoid({at(0.0, side * 0.29, eyes - 0.03), Matrix3d::Identity()}, {0.07 * h, 0.05 * h, 0.10 * h}),
                   head, 0.04 * h);
    }
    if (p.beard)
        add_member(object, make_tube({{at(0.26, 0, eyes - 0.26), 0.09 * h}, {at(0.34, 0, eyes - 0.36), 0.055 * h}}), head,
                   0.1 * h);
    if (p.hat == Hat::none) return;
    const int hat = add_part(object, "hat", {90, 110, 150});
    // The profile ends on the axis at the topmost point.
    const std::vector<Vector2d> cone{
        {0, 0},         {0.30, 0.01}, {0.345, 0.05}, {0.31, 0.12}, {0.20, 0.55 * (top - 0.60)}, {0.10, 0.85 * (top - 0.60)},
        {0, top - 0.60}};
    const std::vector<Vector2d> cap{{0, 0}, {0.29, 0.02}, {0.365, 0.07}, {0.35, 0.14}, {0.24, 0.21}, {0, 0.24}};
    std::vector<Vector2d> profile = p.hat == Hat::cone ? cone : cap;
    const double rise = p.hat == Hat::cone ? 0.60 : top - 0.24;
    for (Vector2d& point : profile) point *= h;
    add_member(object, make_revolved({at(0, 0, rise), Matrix3d::Identity()}, profile), hat, 0.05 * h);
}

}  // namespace

std::unique_ptr<SyntheticObject> build_statuette(const StatuetteParameters& p, const StatuetteBody& body) {
    const StatuetteFrame& frame = body.frame;
    const bool offering = p.pose == StatuetteParameters::Pose::offering;
    auto object = start_object(option_text(p, "technique") + "-made statuette", "votive statuette",
                               "tubular body on a flared base, head, two arms", offering ? 1 : 0, 4000, 4);
    const int tube = add_part(*object, "body", {196, 140, 96}), base = add_part(*object, "base", {150, 104, 74});
    const int head = add_part(*object, "head", {214, 170, 130});
    const int right = add_part(*object, "right arm", {80, 140, 90}), left = add_part(*object, "left arm", {190, 70, 60});
    const std::vector<Vector2d> profile = body_profile(p, frame);
    object->members.push_back({make_warped(make_revolved({}, profile), body.outside),
                               0,
                               false,
                               {{chord_lengths(profile)[15], base}, {std::numeric_limits<double>::infinity(), tube}}});
    const double shoulders = 0.85 * frame.joint_height, r = frame.tube_radius;
    const Vector2d c = body.outside->centre(shoulders);
    add_member(*object, make_ellipsoid({{c.x(), c.y(), shoulders}, Matrix3d::Identity()}, {0.95 * r, 1.5 * r, 0.72 * r}), tube,
               0.6 * r);
    add_head(*object, p, body, head);
    for (const Arm& arm : body_arms(p, body)) add_member(*object, make_tube(arm.beads), arm.side() < 0 ? right : left, 0.2 * r);
    if (offering) {
        const auto arms = body_arms(p, body);
        const Vector3d between = 0.5 * (arms[0].beads.back().centre + arms[1].beads.back().centre);
        const double gap = (arms[0].beads.back().centre - arms[1].beads.back().centre).norm();
        const double wide = std::max(0.5 * gap, 0.45 * r);
        add_member(*object,
                   make_ellipsoid({between + Vector3d(0.2 * r, 0, 0.1 * r), Matrix3d::Identity()}, {wide, wide, 0.35 * r}),
                   add_part(*object, "offering", {220, 180, 70}), 0.1 * r);
    }
    if (p.wall > 0) {
        carve(*object, make_below(make_warped(make_revolved({}, cavity_profile(p, frame)), body.inside), frame.cavity_depth),
              add_part(*object, "inside", {120, 100, 90}), 0);
        object->thinnest = std::max(p.wall * (1 - 1.5 * p.wall_noise - p.off_centre), 0.3 * p.wall);
    }
    object->finish();
    return object;
}

std::array<Arm, 2> body_arms(const StatuetteParameters& p, const StatuetteBody& body) {
    return {Arm(p, body, -1), Arm(p, body, 1)};
}

void check_parameters(const StatuetteParameters& p) {
    check_options(p, "statuette");
    if (p.wall > 0 && p.wall * (1 + 3 * p.wall_noise + p.off_centre) > 0.7 * 0.65 * 0.5 * p.base_diameter)
        fail_usage(fmt::format("a wall of {} mm leaves no cavity in a base of {} mm", std::to_string(p.wall),
                               std::to_string(p.base_diameter)),
                   "use a thinner wall, a wider base, or 0 for a solid body");
    if (p.head_height > 0.4 * p.height || p.base_diameter > 0.6 * p.height || p.arm_length > p.height)
        fail_usage(fmt::format("the head, the base or the arm is too large for a statuette of {} mm", std::to_string(p.height)),
                   "keep the head below 0.4, the base below 0.6 and the arm below 1 of the height");
}

}  // namespace shapes

std::unique_ptr<const SyntheticObject> statuette_object(const StatuetteParameters& parameters) {
    shapes::check_parameters(parameters);
    return shapes::build_statuette(parameters, shapes::StatuetteBody(parameters));
}

void StatuetteParameters::declare_options(OptionList& list) {
    list("technique", technique, "technique of the body: wheel-made or hand-made", Choices{"wheel", "hand"});
    list("height", height, "height from the base to the topmost point", Range{100, 500}, "mm");
    list("base-diameter", base_diameter, "diameter of the base", Range{20, 200}, "mm");
    list("arm-length", arm_length, "length of an arm, from the joint along the outside to the end of the hand", Range{30, 250},
         "mm");
    list("head-height", head_height, "height of the head, from the joint at the back of the neck to the topmost point",
         Range{20, 150}, "mm");
    list("ovality", ovality, "ovality of the cross-sections of the body", Range{0, 0.15}, "share of its radius");
    list("ovality-drift", ovality_drift, "rotation of the direction of ovality over the height of the body", Range{0, 360},
         "degrees");
    list("finger-marks", finger_marks, "root mean square depth of finger marks", Range{0, 0.05}, "share of the radius");
    list("sway", sway, "root mean square offset of the centres of cross-sections from the axis", Range{0, 0.2},
         "share of the tube's radius");
    list("grooves", grooves, "height of throwing grooves", Range{0, 1}, "mm");
    list("wall", wall, "mean thickness of the wall; 0: the body is solid", Range{0, 12}, "mm");
    list("wall-noise", wall_noise, "root mean square variation of the wall thickness", Range{0, 0.25}, "share of the wall");
    list("off-centre", off_centre, "offset of the cavity from the axis of the body", Range{0, 0.4}, "share of the wall");
    list("cavity-seen", cavity_seen, "share of the depth of the cavity that is scanned", Range{0.1, 1});
    list("interior", interior, "end of the cavity in the mesh, where the scan ends: closed by a flat wall, or open",
         Choices{"closed", "open"});
    list("scan-noise", scan_noise, "scan noise: standard deviation of the vertex displacements along the normals", Range{0, 0.5},
         "mm");
    list("holes", holes, "number of patches that are missing in the scan", Range{0, 20});
    list("hole-radius", hole_radius, "radius of the patches that are missing in the scan", Range{1, 20}, "mm");
    list("pose", pose, "pose of the arms", Choices{"forward", "offering", "raised", "down"});
    list("hat", hat, "hat of the statuette", Choices{"cone", "cap", "none"});
    list("beard", beard, "add a beard: a piece of clay under the chin", Anything{});
    list("seed", seed, "random seed of phases, noise, holes and lattice", Range{0, 9007199254740992.0});
    list("vertices", vertices, "number of vertices of the mesh, before patches are removed", Range{4000, 5e6});
}

void PopulationOptions::declare_options(OptionList& list) {
    list("objects", objects, "number of statuettes, half of them wheel-made and half hand-made", Range{1, 100000});
    list("level", level, "difficulty: from 1 (clearly different techniques) to 5 (nearly identical techniques)", Range{1, 5});
    list("seed", seed, "random seed from which all objects are made", Range{0, 1e9});
    list("vertices", vertices, "number of vertices of each mesh", Range{4000, 5e6});
    list("scan-noise", scan_noise, "scan noise: standard deviation of the vertex displacements along the normals", Range{0, 0.5},
         "mm");
    list("interior", interior,
         "how the mesh of a hollow body ends where the scan of the cavity ends: closed by a flat wall, open, or mixed (some "
         "bodies each)",
         Choices{"mixed", "closed", "open"});
    list("cavity-seen", cavity_seen, "minimum share of the depth of a body's cavity that is scanned", Range{0.1, 1});
    list("holes", holes, "maximum number of holes in the mesh of a scan", Range{0, 20});
    list("size-spread", size_spread, "standard deviation over the statuettes of the logarithm of each size", Range{0, 0.15});
}

}  // namespace ostraka
